// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/foam/field_file.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <utility>

#include <fmt/core.h>

#include "io/files/index_file.hpp"
#include "io/files/text_scanner.hpp"

namespace isotet::io::foam {

namespace {

constexpr int max_nesting = 8, max_includes = 64;
constexpr std::string_view etc_folder = "<etc>/"; ///< in a name: of an OpenFOAM installation

std::string without_quotes(std::string_view word) {
    if (word.size() >= 2 && word.front() == '"' && word.back() == '"') word = word.substr(1, word.size() - 2);
    return std::string(word);
}

/// "$name", "${name}", "$:name" without what is around the name; empty where it is none of these.
std::string name_of_macro(std::string_view word) {
    if (!word.starts_with('$')) return {};
    word.remove_prefix(1);
    while (!word.empty() && (word.front() == ':' || word.front() == '.' || word.front() == '{')) word.remove_prefix(1);
    while (!word.empty() && word.back() == '}') word.remove_suffix(1);
    return std::string(word);
}

class FieldParser {
public:
    FieldParser(const CaseFiles& files, std::size_t most, bool allow_outside)
        : files_(files), most_(most), allow_outside_(allow_outside) {}

    Result<FieldFile> parse(const std::string& name) {
        auto text = files_.open(name);
        if (!text) return text.error();
        Scanner scanner(std::move(*text));
        auto header = scanner.header();
        if (!header) return header.error();
        field_.path = scanner.file().path;
        field_.header = *header;
        field_.components = components_of(header->type);
        if (field_.components == 0)
            return scanner.fail(
                fmt::format("has the class {}, which is no field of cells or points", in_quotes(header->type)));
        if (auto read = entries(scanner, Level::top, false, nullptr); !read) return read.error();
        if (!field_.inside) return scanner.fail("has no internalField");
        if (!has_boundary_ && header->type.starts_with("vol") && !header->type.ends_with("::Internal"))
            return scanner.fail("has no boundaryField");
        return std::move(field_);
    }

private:
    enum class Level { top, boundary, patch };

    /// The entries of a dictionary up to its '}', or of the whole file.
    Result<void> entries(Scanner& scanner, Level level, bool braces, PatchEntry* patch) {
        while (true) {
            if (scanner.at_end()) {
                if (!braces) return {};
                return scanner.fail(level == Level::patch ? "a patch of boundaryField has no '}'"
                                                          : "boundaryField has no '}'");
            }
            if (braces && scanner.take('}')) return {};
            const std::string key(scanner.token());
            Result<void> read;
            if (key.starts_with('#')) read = directive(scanner, key, level, patch);
            else if (key.starts_with('$')) scanner.take(';'); // entries copied from elsewhere: none that matter here
            else if (level == Level::top) read = top_entry(scanner, key);
            else if (level == Level::boundary) read = boundary_entry(scanner, key);
            else read = patch_entry(scanner, key, *patch);
            if (!read) return read;
        }
    }

    Result<void> top_entry(Scanner& scanner, const std::string& key) {
        const bool internal_only = field_.header.type.ends_with("::Internal");
        if (key == "boundaryField" && scanner.take('{')) {
            has_boundary_ = true;
            return entries(scanner, Level::boundary, true, nullptr);
        }
        if (key == "internalField" || (internal_only && key == "value")) {
            variables_.insert_or_assign("internalField", scanner);
            auto values = values_of(scanner, "internalField", 0);
            if (!values) return values.error();
            field_.inside = std::move(*values);
            return scanner.expect(';', "internalField");
        }
        if (key != "FoamFile") variables_.insert_or_assign(key, scanner);
        return scanner.skip_entry();
    }

    Result<void> boundary_entry(Scanner& scanner, const std::string& key) {
        if (!scanner.take('{')) return scanner.skip_entry();
        PatchEntry patch{without_quotes(key), {}, key.starts_with('"'), {}};
        if (auto read = entries(scanner, Level::patch, true, &patch); !read) return read;
        field_.patches.push_back(std::move(patch));
        return {};
    }

    Result<void> patch_entry(Scanner& scanner, const std::string& key, PatchEntry& patch) {
        if (key == "type") patch.type = scanner.token();
        if (key == "value") {
            Scanner at_value = scanner;
            auto values = values_of(scanner, fmt::format("the value of patch {}", in_quotes(patch.key)), 0);
            Result<void> read = values ? scanner.expect(';', "value") : values.error();
            if (read) {
                patch.value = std::move(*values);
                return {};
            }
            if (read.error().code != ErrorCode::invalid_data) return read;
            field_.faults.insert(read.error().message);
            scanner = std::move(at_value);
        }
        return scanner.skip_entry();
    }

    /// uniform X, nonuniform List<T> N(...), or $name.
    Result<Values> values_of(Scanner& scanner, const std::string& what, int nesting) {
        const std::string word(scanner.token());
        if (const std::string name = name_of_macro(word); !name.empty()) {
            const auto variable = variables_.find(name);
            if (variable == variables_.end() || nesting == max_nesting)
                return scanner.fail(fmt::format("{}: {} is not defined in this file", what, in_quotes(word)));
            Scanner there = variable->second;
            return values_of(there, what, nesting + 1);
        }
        if (word == "uniform") {
            auto tuple = uniform_tuple(scanner, what, 0);
            if (!tuple) return tuple.error();
            return Values{true, std::move(*tuple)};
        }
        if (word.starts_with('#')) return not_run(scanner, word);
        if (word != "nonuniform")
            return scanner.fail(fmt::format("{}: uniform or nonuniform is wanted, not {}", what, in_quotes(word)));
        Scanner ahead = scanner;
        if (const std::string_view type = ahead.token(); type.starts_with("List<")) {
            if (components_of(type.substr(5, type.size() - 6)) != field_.components)
                return scanner.fail(
                    fmt::format("{}: {} in a field of class {}", what, in_quotes(type), field_.header.type));
            scanner = ahead;
        }
        auto tuples = scanner.tuples(field_.components, what, most_);
        if (!tuples) return tuples.error();
        return Values{false, std::move(*tuples)};
    }

    Result<std::vector<double>> uniform_tuple(Scanner& scanner, const std::string& what, int nesting) {
        Scanner ahead = scanner;
        const std::string word(ahead.token());
        if (word.starts_with('#')) return not_run(scanner, word);
        const std::string name = name_of_macro(word);
        if (name.empty()) return scanner.tuple(field_.components, what);
        const auto variable = variables_.find(name);
        if (variable == variables_.end() || nesting == max_nesting)
            return scanner.fail(fmt::format("{}: {} is not defined in this file", what, in_quotes(word)));
        scanner = ahead;
        Scanner there = variable->second;
        return uniform_tuple(there, what, nesting + 1);
    }

    Error not_run(const Scanner& scanner, const std::string& word) const {
        return scanner.fail(
            fmt::format("has {}, which would have to be computed: nothing in a file is run", in_quotes(word)));
    }

    Result<void> directive(Scanner& scanner, const std::string& word, Level level, PatchEntry* patch) {
        if (word == "#inputMode" || word == "#default" || word == "#remove") {
            static_cast<void>(scanner.token());
            return {};
        }
        if (word == "#includeEtc" || word == "#sincludeEtc")
            return include_etc(scanner, without_quotes(scanner.token()), level);
        const bool if_present = word == "#includeIfPresent" || word == "#sinclude";
        if (word != "#include" && !if_present) return not_run(scanner, word);
        const std::string name = without_quotes(scanner.token());
        if (name.starts_with(etc_folder)) return include_etc(scanner, name.substr(etc_folder.size()), level);
        return include(scanner, name, if_present, level, patch);
    }

    /// Files of an installation are not read. On patches they give types without values; elsewhere they may define
    /// values.
    Result<void> include_etc(const Scanner& scanner, const std::string& name, Level level) {
        if (level == Level::top && !allow_outside_)
            return scanner.fail(
                fmt::format("includes {} of an OpenFOAM installation outside of boundaryField, where it "
                            "may define values: it is not read, and skipped only with `allow_outside`",
                            in_quotes(name)));
        field_.has_constraint_types |= level == Level::boundary && name.ends_with("setConstraintTypes");
        if (field_.unread.size() < max_includes) field_.unread.insert(name);
        return {};
    }

    Result<void> include(Scanner& scanner, const std::string& named, bool if_present, Level level, PatchEntry* patch) {
        namespace fs = std::filesystem;
        if (named.find('$') != std::string::npos || named.find('<') != std::string::npos)
            return scanner.fail(
                fmt::format("includes {}, a name with variables, which are not known here", in_quotes(named)));
        const std::string name = (fs::path(scanner.file().name).parent_path() / named).lexically_normal().string();
        if (named.empty() || (!allow_outside_ && (fs::path(named).is_absolute() || name.starts_with(".."))))
            return scanner.fail(fmt::format("includes {}: only files below the case's folder are read, unless "
                                            "`allow_outside` is given",
                                            in_quotes(named)));
        if (if_present && !files_.has(name)) return {};
        if (++includes_ > max_includes || nesting_ == max_nesting)
            return scanner.fail(
                fmt::format("includes more than {} files, or {} in one another", max_includes, max_nesting));
        auto text = files_.open(name);
        if (!text) return text.error();
        Scanner included(std::move(*text));
        if (included.is_foam()) {
            if (auto header = included.header(); !header) return header.error();
        }
        included.use(field_.header);
        ++nesting_;
        auto read = entries(included, level, false, patch);
        --nesting_;
        return read;
    }

    const CaseFiles& files_;
    std::size_t most_;
    bool allow_outside_;
    FieldFile field_;
    bool has_boundary_ = false;
    std::map<std::string, Scanner> variables_; ///< each behind its name
    int includes_ = 0, nesting_ = 0;
};

bool has_no_values(std::string_view type) {
    return type == "empty" || type == "wedge" || type == "zeroGradient" || type.starts_with("processor") ||
           type.starts_with("cyclic");
}

/// Patches whose type decides what a field is on them, so that caseDicts/setConstraintTypes has an entry for each.
bool is_constraint(std::string_view type) {
    return type == "empty" || type == "wedge" || type == "internal" || type == "overset" ||
           type.starts_with("symmetry") || type.starts_with("processor") || type.starts_with("cyclic") ||
           type.starts_with("nonConformal") || type == "nonuniformTransformCyclic";
}

/// By name, else by a group, else by the last pattern. The entries of caseDicts/setConstraintTypes are of groups.
const PatchEntry* entry_of(const FieldFile& field, const Patch& patch) {
    const PatchEntry *named = nullptr, *grouped = nullptr, *fitting = nullptr;
    for (const PatchEntry& entry : field.patches) {
        if (entry.key == patch.name) named = &entry;
        else if (std::ranges::find(patch.groups, entry.key) != patch.groups.end()) grouped = &entry;
        else if (entry.pattern && fits_pattern(entry.key, patch.name)) fitting = &entry;
    }
    if (named || grouped) return named ? named : grouped;
    return field.has_constraint_types && is_constraint(patch.type) ? nullptr : fitting;
}

} // namespace

Result<FieldFile> read_field_file(const CaseFiles& files, const std::string& name, std::size_t most,
                                  bool allow_outside) {
    return FieldParser(files, most, allow_outside).parse(name);
}

std::optional<Values> known_values(const FieldFile& field, const Patch& patch) {
    const PatchEntry* entry = entry_of(field, patch);
    if (!entry || has_no_values(patch.type) || has_no_values(entry->type)) return std::nullopt;
    if (entry->type == "noSlip") return Values{true, std::vector<double>(field.components, 0)};
    return entry->value;
}

} // namespace isotet::io::foam
