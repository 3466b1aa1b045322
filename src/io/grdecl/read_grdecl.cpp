// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/grdecl/read_grdecl.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <fmt/ranges.h>

#include "base/system/memory.hpp"
#include "base/parallel.hpp"
#include "io/files/escape.hpp"
#include "io/files/index_file.hpp"
#include "io/files/kept_files.hpp"
#include "io/files/text_scanner.hpp"
#include "io/files/whole_file.hpp"
#include "io/grdecl/corner_points.hpp"
#include "io/grdecl/values.hpp"
#include "io/pieces/loaded.hpp"

namespace isotet::io {

namespace {

using grdecl::Deck;
using grdecl::DeckText;
using grdecl::MapAxes;
using grdecl::Record;

/// Lists that make the grid; all others are properties.
bool is_geometry(std::string_view keyword) {
    constexpr std::array<std::string_view, 8> names{"SPECGRID", "DIMENS",  "COORD",    "ZCORN",
                                                    "ACTNUM",   "MAPAXES", "GRIDUNIT", "MAPUNITS"};
    return std::ranges::find(names, keyword) != names.end();
}

/// Numbers of regions are whole.
bool is_region(std::string_view keyword) { return keyword.ends_with("NUM"); }

/// What a deck says, list by list: of a keyword that stands there twice, the last.
class CornerPointDeck {
public:
    static Result<CornerPointDeck> open(const DeckText& text, const grdecl::OpenIncluded& open,
                                        const Progress& progress) {
        auto deck = grdecl::read_deck(text, open, progress);
        if (!deck) return deck.error();
        CornerPointDeck self(progress);
        self.path_ = text.path;
        self.operations_ = std::move(deck->operations);
        for (Record& record : deck->records) {
            std::string keyword = record.keyword;
            const auto known = self.records_.find(keyword);
            if (known == self.records_.end()) self.order_.push_back(keyword);
            self.records_.insert_or_assign(std::move(keyword), std::move(record));
        }
        if (auto read = self.read_size(); !read) return read.error();
        if (auto found = self.find_properties(); !found) return found.error();
        return self;
    }

    FileInfo info() const {
        FileInfo info;
        info.format = "grdecl";
        for (const std::string& name : properties_)
            info.fields.push_back(
                {name, Association::cell, is_region(name) ? ScalarType::int32 : ScalarType::float64, 1});
        return info;
    }

    Result<ReadResult> read(const ReadOptions& options) const {
        ReadResult result;
        result.info = info();
        auto geometry = read_geometry();
        if (!geometry) return geometry.error();
        const bool mapped = geometry->axes.has_value();
        auto made = grdecl::make_hexahedra(std::move(*geometry), progress_);
        if (!made) return in_file(made.error());
        Grid& grid = result.grid;
        for (const std::string& name : properties_) {
            if (!wanted(options, Association::cell, name)) continue;
            auto values = read_property(name, made->cells);
            if (!values) return values.error();
            grid.cell_fields.push_back({name, std::move(*values)});
        }
        grid.points = Array::own(std::move(made->points), 3);
        grid.cells.connectivity = Array::own(std::move(made->corners));
        grid.cells.uniform_type = CellType::hexahedron;
        add_notes(*made, mapped, result.notes);
        return result;
    }

private:
    explicit CornerPointDeck(const Progress& progress) : progress_(progress) {}

    Error in_file(const Error& error) const {
        return {error.code,
                error.code == ErrorCode::invalid_data ? escaped(path_) + ": " + error.message : error.message};
    }

    const Record* find(const std::string& keyword) const {
        const auto found = records_.find(keyword);
        return found == records_.end() ? nullptr : &found->second;
    }

    Result<void> read_size() {
        const Record* record = find("SPECGRID");
        if (!record) record = find("DIMENS");
        if (!record) return broken(path_, "has neither SPECGRID nor DIMENS, so it is no corner-point grid");
        TextScanner scanner(record->body);
        for (std::uint64_t& count : cells_)
            if (!scanner.number(count) || count == 0)
                return record->fail(fmt::format("begins with {}, but three numbers of cells, at least 1, are the rule",
                                                in_quotes(record->body.substr(0, 30))));
        std::uint64_t reservoirs = 1;
        if (!scanner.at_end() && !scanner.number(reservoirs)) scanner.word(); // a default, "1*"
        const std::string_view kind = scanner.word();
        if (reservoirs > 1) return record->fail(fmt::format("has {} reservoirs, but isotet takes 1", reservoirs));
        if (kind == "T") return record->fail("is a grid in cylindrical coordinates, which isotet does not take");
        constexpr double most = std::numeric_limits<std::uint32_t>::max();
        if (static_cast<double>(cells_[0]) * static_cast<double>(cells_[1]) * static_cast<double>(cells_[2]) > most)
            return record->fail(fmt::format("has {} cells, but isotet takes 2^32 - 1 of a corner-point grid at most",
                                            fmt::join(cells_, " x ")));
        return {};
    }

    std::uint64_t cell_count() const { return cells_[0] * cells_[1] * cells_[2]; }

    /// Lists of the length of the grid are its properties; long ones of another length are told.
    Result<void> find_properties() {
        constexpr std::uint64_t long_list = 64;
        for (const std::string& keyword : order_) {
            if (is_geometry(keyword)) continue;
            const auto count = grdecl::count_values(records_.at(keyword), progress_);
            if (!count) return count.error();
            if (*count == cell_count()) properties_.push_back(keyword);
            else if (*count >= long_list) other_lists_.push_back(fmt::format("{} ({})", escaped(keyword), *count));
        }
        return {};
    }

    /// A list of a known length.
    Result<std::vector<double>> read_list(const std::string& keyword, std::uint64_t expected, double unset) const {
        const Record* record = find(keyword);
        if (!record) {
            const char* const hint =
                find("DX") || find("DXV") ? ": grids of DX, DY, DZ and TOPS are not corner-point grids" : "";
            return broken(path_, fmt::format("has no {}{}", keyword, hint));
        }
        const auto count = grdecl::count_values(*record, progress_);
        if (!count) return count.error();
        if (*count != expected)
            return record->fail(fmt::format("has {} numbers, but {} x {} x {} cells need {}", *count, cells_[0],
                                            cells_[1], cells_[2], expected));
        if (auto fits = core::require_memory(keyword, 8 * expected); !fits) return fits.error();
        std::vector<double> values(expected);
        if (auto read = grdecl::read_values(*record, unset, values, progress_); !read) return read.error();
        return values;
    }

    Result<grdecl::CornerPoints> read_geometry() const {
        grdecl::CornerPoints grid;
        grid.cells = cells_;
        constexpr double none = std::numeric_limits<double>::quiet_NaN(); // a default is an error here
        auto pillars = read_list("COORD", 6 * (cells_[0] + 1) * (cells_[1] + 1), none);
        if (!pillars) return pillars.error();
        grid.pillars = std::move(*pillars);
        auto depths = read_list("ZCORN", 8 * cell_count(), none);
        if (!depths) return depths.error();
        grid.depths = std::move(*depths);
        grid.active.assign(cell_count(), 1);
        if (find("ACTNUM")) {
            const auto active = read_list("ACTNUM", cell_count(), 1);
            if (!active) return active.error();
            std::ranges::transform(*active, grid.active.begin(), [](double number) { return number != 0 ? 1 : 0; });
        }
        auto axes = read_axes();
        if (!axes) return axes.error();
        grid.axes = *axes;
        return grid;
    }

    /// The first word of a record, without quotation marks, in capitals.
    std::string unit(const char* keyword) const {
        const Record* record = find(keyword);
        std::string word(record ? TextScanner(record->body).word() : "");
        std::erase_if(word, [](char c) { return c == '\'' || c == '"'; });
        return word;
    }

    bool has_other_units() const {
        return find("GRIDUNIT") && find("MAPUNITS") && unit("GRIDUNIT") != unit("MAPUNITS");
    }

    /// How the grid lies on the map; nothing where it is given on the map already, or nothing is said.
    Result<std::optional<MapAxes>> read_axes() const {
        const Record* record = find("MAPAXES");
        const Record* units = find("GRIDUNIT");
        const bool on_map = units && units->body.find("MAP") != std::string_view::npos;
        if (!record || on_map || has_other_units()) return std::optional<MapAxes>();
        const auto count = grdecl::count_values(*record, progress_);
        if (!count) return count.error();
        if (*count != 6) return record->fail(fmt::format("has {} numbers, but 6 are the rule", *count));
        std::array<double, 6> p{};
        if (auto read = grdecl::read_values(*record, 0, p, progress_); !read) return read.error();
        MapAxes axes{{p[2], p[3]}, {p[4] - p[2], p[5] - p[3]}, {p[0] - p[2], p[1] - p[3]}};
        for (auto* axis : {&axes.x, &axes.y}) {
            // Not hypot(): its digits, and the C library that it asks for, differ between machines.
            const double length = std::sqrt((*axis)[0] * (*axis)[0] + (*axis)[1] * (*axis)[1]);
            if (!(length > 0) || !std::isfinite(length))
                return record->fail("has an axis whose length is zero or not finite");
            for (double& part : *axis) part /= length;
        }
        return std::optional(axes);
    }

    Result<Array> read_property(const std::string& name, const std::vector<std::uint64_t>& cells) const {
        const bool region = is_region(name);
        const auto all = read_list(name, cell_count(), region ? 1 : std::numeric_limits<double>::quiet_NaN());
        if (!all) return all.error();
        if (!region) return Array::own(of_cells<double>(*all, cells));
        constexpr double most = std::numeric_limits<std::int32_t>::max();
        const auto odd = std::ranges::find_if(
            *all, [](double value) { return !(std::abs(value) <= most) || value != std::trunc(value); });
        if (odd != all->end())
            return find(name)->fail(fmt::format("has {}, but regions have whole numbers below 2^31", *odd));
        return Array::own(of_cells<std::int32_t>(*all, cells));
    }

    template <class To>
    static std::vector<To> of_cells(const std::vector<double>& all, const std::vector<std::uint64_t>& cells) {
        std::vector<To> out(cells.size());
        core::parallel_each(cells.size(), 1U << 16U, [&](std::size_t i) { out[i] = static_cast<To>(all[cells[i]]); });
        return out;
    }

    void add_notes(const grdecl::Hexahedra& made, bool mapped, std::vector<std::string>& notes) const {
        notes.emplace_back("z is minus the depth in the file, so that up is positive");
        if (mapped) notes.emplace_back("x and y are those of the map, by MAPAXES");
        if (has_other_units() && find("MAPAXES"))
            notes.emplace_back("the grid's unit is not that of the map, so MAPAXES is not applied");
        const std::uint64_t inactive = cell_count() - made.cells.size() - made.flat;
        if (inactive > 0) notes.push_back(fmt::format("inactive cells are left out (ACTNUM): {}", inactive));
        if (made.flat > 0) notes.push_back(fmt::format("cells without height are left out: {}", made.flat));
        if (!other_lists_.empty())
            notes.push_back(fmt::format("lists that are not as long as the grid has cells ({}) are left out: {}",
                                        cell_count(), fmt::join(other_lists_, ", ")));
        if (!operations_.empty())
            notes.push_back(fmt::format("keywords that change lists, or refine cells, are not carried out: {}",
                                        fmt::join(operations_, ", ")));
    }

    const Progress& progress_;
    std::string path_;
    std::map<std::string, Record> records_;
    std::vector<std::string> order_, properties_, other_lists_;
    std::set<std::string> operations_;
    std::array<std::uint64_t, 3> cells_{};
};

/// Files as they lie on disk; included ones below the folder of the first.
class DeckFiles {
public:
    DeckFiles(std::string path, const ReadOptions& options, const Progress& progress)
        : path_(std::move(path)), options_(options), progress_(progress) {}

    Result<DeckText> open() { return open_file(path_); }
    grdecl::OpenIncluded included() {
        return [this](std::string_view name) -> Result<DeckText> {
            const auto file = named_file(path_, name, options_.allow_outside);
            return file ? open_file(*file) : file.error();
        };
    }
    const std::vector<std::string>& opened() const { return opened_; }

private:
    Result<DeckText> open_file(const std::string& path) {
        auto whole = look_into_file(path, options_, progress_);
        if (!whole) return whole.error();
        if (std::ranges::find(opened_, path) == opened_.end()) opened_.push_back(path);
        auto owner = std::make_shared<const WholeFile>(std::move(*whole));
        return DeckText{path, owner, without_byte_order_mark(owner->text())};
    }

    std::string path_;
    const ReadOptions& options_;
    const Progress& progress_;
    std::vector<std::string> opened_;
};

Result<FileInfo> inspect_grdecl_file(const std::string& path, const ReadOptions& options, const Progress& progress) {
    DeckFiles files(path, options, progress);
    const auto text = files.open();
    if (!text) return text.error();
    auto info = inspect_grdecl(*text, files.included(), progress);
    if (info) info->files = files.opened();
    return info;
}

Result<ReadResult> read_grdecl_file(const std::string& path, const ReadOptions& options, const Progress& progress) {
    DeckFiles files(path, options, progress);
    const auto text = files.open();
    if (!text) return text.error();
    auto result = parse_grdecl(*text, files.included(), options, progress);
    if (result) result->info.files = files.opened();
    return result;
}

/// By a line that is one of the keywords of grids.
int recognizes_grdecl(std::string_view head, std::string_view extension) {
    bool content = false;
    while (!head.empty() && !content) {
        const std::string_view line = head.substr(0, head.find('\n'));
        const std::string_view word = TextScanner(line).word();
        content = word == "SPECGRID" || word == "ZCORN" || word == "COORD" || word == "RUNSPEC" || word == "MAPAXES";
        head.remove_prefix(std::min(line.size() + 1, head.size()));
    }
    return content ? 2 : extension == ".grdecl" ? 1 : 0;
}

} // namespace

Result<FileInfo> inspect_grdecl(const DeckText& text, const grdecl::OpenIncluded& open, const Progress& progress) {
    const auto deck = CornerPointDeck::open(text, open, progress);
    if (!deck) return deck.error();
    return deck->info();
}

Result<ReadResult> parse_grdecl(const DeckText& text, const grdecl::OpenIncluded& open, const ReadOptions& options,
                                const Progress& progress) {
    const auto deck = CornerPointDeck::open(text, open, progress);
    if (!deck) return deck.error();
    return deck->read(options);
}

GridReader grdecl_reader() {
    GridReader reader;
    reader.format.name = "grdecl";
    reader.format.title = "corner-point grid (GRDECL)";
    reader.format.extensions = {".grdecl"};
    reader.format.reads_grid = true;
    reader.recognizes = recognizes_grdecl;
    reader.inspect = inspect_grdecl_file;
    reader.read = read_grdecl_file;
    return reader;
}

} // namespace isotet::io
