// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/vtk_xml/columns.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/errors.hpp"
#include "base/parallel.hpp"
#include "io/files/scalars.hpp"
#include "io/files/text_scanner.hpp"
#include "io/files/time_values.hpp"
#include "io/pieces/common_type.hpp"
#include "io/reader.hpp"
#include "io/vtk_xml/unread_values.hpp"
#include "io/vtk_xml/vtk_attributes.hpp"

namespace isotet::io::vtk_xml {
namespace {

const DataArray* find_array(const std::vector<DataArray>& arrays, std::string_view name) {
    const auto found = std::ranges::find(arrays, name, &DataArray::name);
    return found == arrays.end() ? nullptr : &*found;
}

const char* field_of(Association association) {
    return association == Association::point ? "point field" : "cell field";
}

/// An array of point data or cell data over all pieces.
struct Column {
    std::string name;
    ScalarType type = ScalarType::float32;
    std::size_t components = 1;
    std::vector<std::optional<DataArray>> parts; ///< one a piece; nothing where it is missing
    std::vector<std::optional<StoredArray>> stored;
};

/// What the pieces have together.
struct Columns {
    std::vector<Column> columns;
    std::vector<LeftOut> left_out;
    std::vector<std::string> notes;
    std::string global_ids, active;
};

/// Pieces that count: those with tuples; all where none has any.
std::vector<std::size_t> filled_pieces(const Layout& layout) {
    std::vector<std::size_t> filled;
    for (std::size_t piece = 0; piece < layout.tuples.size(); ++piece)
        if (layout.total == 0 || layout.tuples[piece] > 0) filled.push_back(piece);
    return filled;
}

/// Type and components of a column from its parts. False: the numbers of components differ, and `counts` are two of them.
bool unite_parts(Column& column, const Layout& layout, std::pair<std::size_t, std::size_t>& counts) {
    bool first = true, missing = false;
    for (const std::size_t piece : filled_pieces(layout)) {
        const auto& part = column.parts[piece];
        if (!part) {
            missing = true;
            continue;
        }
        column.type = first ? part->type : common_type(column.type, part->type);
        if (!first && column.components != part->components) {
            counts = {column.components, part->components};
            return false;
        }
        column.components = part->components;
        first = false;
    }
    if (missing) column.type = with_missing(column.type);
    return true;
}

std::string quoted_names(const std::vector<std::string>& names) {
    std::vector<std::string> quoted;
    for (const std::string& name : names) quoted.push_back(in_quotes(name));
    return fmt::format("{}", fmt::join(quoted, ", "));
}

void add_name(std::vector<std::string>& names, const std::string& name) {
    if (std::ranges::find(names, name) == names.end()) names.push_back(name);
}

/// One sentence for all fields that are in as many pieces.
void note_missing_parts(const std::vector<Column>& columns, Association association, const Layout& layout,
                        std::vector<std::string>& notes) {
    const auto filled = filled_pieces(layout);
    for (std::size_t count = 1; count < filled.size(); ++count) {
        std::vector<std::string> names;
        for (const Column& column : columns) {
            const auto there =
                std::ranges::count_if(filled, [&](std::size_t piece) { return column.parts[piece].has_value(); });
            if (static_cast<std::size_t>(there) == count) names.push_back(column.name);
        }
        if (names.empty()) continue;
        const bool one = names.size() == 1;
        notes.push_back(fmt::format("{}{} {} {} in {} of {} pieces only: NaN in the others", field_of(association),
                                    one ? "" : "s", quoted_names(names), one ? "is" : "are", count, filled.size()));
    }
}

/// The arrays of all pieces by name, as they are described.
Columns columns_of(const Document& document, Association association, const Layout& layout, std::size_t step) {
    const char* const element = association == Association::point ? "PointData" : "CellData";
    const auto pieces = pieces_of(document);
    Columns all;
    std::vector<std::string> unnamed, repeated;
    for (const std::size_t p : filled_pieces(layout)) {
        Section section = describe_section(document, pieces[p].child(element), step);
        if (all.global_ids.empty()) all.global_ids = section.global_ids;
        if (all.active.empty()) all.active = section.active;
        for (const std::string& name : section.unnamed) add_name(unnamed, name);
        for (const std::string& name : section.repeated) add_name(repeated, name);
        for (LeftOut& item : section.left_out) {
            item.what = field_of(association);
            const bool known = std::ranges::any_of(all.left_out, [&](const LeftOut& other) {
                return other.name == item.name && other.reason == item.reason;
            });
            if (!known) all.left_out.push_back(std::move(item));
        }
        for (DataArray& array : section.arrays) {
            auto column = std::ranges::find(all.columns, array.name, &Column::name);
            if (column == all.columns.end()) {
                all.columns.push_back({array.name, array.type, array.components, {}, {}});
                column = std::prev(all.columns.end());
                column->parts.resize(pieces.size());
            }
            column->parts[p] = std::move(array);
        }
    }
    for (const std::string& name : unnamed)
        all.notes.push_back(fmt::format("a {} without a name is called {}", field_of(association), in_quotes(name)));
    if (!repeated.empty())
        all.notes.push_back(fmt::format("{} {} {} there more than once: the first is read", field_of(association),
                                        quoted_names(repeated), repeated.size() == 1 ? "is" : "are"));
    std::erase_if(all.columns, [&](Column& column) {
        std::pair<std::size_t, std::size_t> counts;
        if (unite_parts(column, layout, counts)) return false;
        all.left_out.push_back({field_of(association), column.name,
                                fmt::format("it has {} component{} in one piece and {} in another", counts.first,
                                            counts.first == 1 ? "" : "s", counts.second)});
        return true;
    });
    note_missing_parts(all.columns, association, layout, all.notes);
    return all;
}

/// Ghost marks that decide which cells there are must be sound.
Result<void> check_ghosts(const Columns& columns) {
    for (const LeftOut& item : columns.left_out)
        if (is_ghost_array(item.name))
            return invalid_data(fmt::format("the array {}: {}", in_quotes(item.name), item.reason));
    return {};
}

/// The column of global numbers: the one marked so, or one of a well-known name. Null for a floating one.
const Column* global_ids(const Columns& columns, std::span<const std::string_view> names) {
    const auto find = [&](std::string_view name) -> const Column* {
        const auto found = std::ranges::find(columns.columns, name, &Column::name);
        return found == columns.columns.end() ? nullptr : &*found;
    };
    const Column* ids = columns.global_ids.empty() ? nullptr : find(columns.global_ids);
    for (const std::string_view name : names)
        if (!ids) ids = find(name);
    return ids && ids->components == 1 && !is_floating(ids->type) ? ids : nullptr;
}

/// Looks for the values in every piece.
Result<void> find_values(Document& document, const Layout& layout, const Progress& progress, Column& column) {
    column.stored.resize(column.parts.size());
    for (std::size_t piece = 0; piece < column.parts.size(); ++piece) {
        const auto& part = column.parts[piece];
        if (!part || layout.tuples[piece] == 0) continue;
        const std::uint64_t tuples = layout.tuples[piece];
        if (tuples > std::numeric_limits<std::uint64_t>::max() / part->components)
            return invalid_data(fmt::format("the array {} should have {} tuples", in_quotes(part->name), tuples));
        auto stored = StoredArray::find(document, *part, tuples * part->components, progress);
        if (!stored) return stored.error();
        column.stored[piece] = std::move(*stored);
    }
    return {};
}

/// The values of one piece in the type of the column. Sets `more` where others stand behind them.
Result<void> decode_as(const StoredArray& stored, ScalarType type, std::byte* to, bool& more) {
    if (stored.array().type == type) return stored.decode(to, &more);
    const auto values = filled_array(stored.array().type, static_cast<std::size_t>(stored.scalars()), 1,
                                     [&](std::byte* own) { return stored.decode(own, &more); });
    if (!values) return values.error();
    convert_scalars(*values, type, to);
    return {};
}

Result<Array> load_values(const Column& column, const Layout& layout, bool& more) {
    const std::size_t components = column.components, tuple = components * size_of(column.type);
    bool missing = false;
    for (std::size_t piece = 0; piece < column.stored.size(); ++piece)
        missing = missing || (!column.stored[piece] && layout.tuples[piece] > 0);
    return filled_array(column.type, static_cast<std::size_t>(layout.total), components,
                        [&](std::byte* to) -> Result<void> {
                            if (missing)
                                fill_missing(column.type, static_cast<std::size_t>(layout.total) * components, to);
                            for (std::size_t piece = 0; piece < column.stored.size(); ++piece) {
                                const auto bytes = static_cast<std::size_t>(layout.tuples[piece] * tuple);
                                if (column.stored[piece]) {
                                    core::Buffer<std::byte> apart(layout.place ? bytes : 0);
                                    std::byte* const own = layout.place ? apart.data() : to;
                                    if (auto done = decode_as(*column.stored[piece], column.type, own, more); !done)
                                        return done;
                                    if (layout.place) layout.place(piece, apart.data(), to, tuple);
                                }
                                if (!layout.place) to += bytes;
                            }
                            return {};
                        });
}

/// A column that is read, and what becomes of it.
struct Job {
    Column column;
    Association association;
    const Layout* layout;
    bool is_field = false, is_ghost = false, is_ids = false;
    bool has_more = false; ///< values than there are points or cells
    bool stays = false;    ///< in the file
    Array values;
    std::optional<Error> error;
};

/// A broken field that is not asked for by name is left out.
bool may_be_left_out(const Job& job, const Error& error, const ReadOptions& options) {
    const bool named =
        job.association == Association::point ? options.point_fields.has_value() : options.cell_fields.has_value();
    return error.code == ErrorCode::invalid_data && (job.is_field || !job.is_ghost) && !(job.is_field && named);
}

void add_jobs(const Document& document, Association association, const Layout& layout, const Wanted& wanted,
              std::vector<Job>& jobs) {
    const bool of_points = association == Association::point;
    Columns columns = columns_of(document, association, layout, wanted.step);
    const Column* const ids =
        !wanted.ids ? nullptr : global_ids(columns, of_points ? std::span(point_id_names) : std::span(cell_id_names));
    for (Column& column : columns.columns) {
        Job job{{}, association, &layout, false, false, &column == ids, false, false, {}, {}};
        job.is_ghost = is_ghost_array(column.name);
        job.is_field = !job.is_ghost && io::wanted(wanted.options, association, column.name);
        if (of_points) job.is_ghost = job.is_ghost && wanted.box;
        else job.is_ghost = job.is_ghost || column.name == ghost_rank_name;
        if (!job.is_field && !job.is_ids && !job.is_ghost) continue;
        job.column = std::move(column);
        jobs.push_back(std::move(job));
    }
}

/// Finite values of a text that are infinite as float32, the type of their array.
std::uint64_t count_too_large(Document& document, const Job& job, const Progress& progress) {
    const bool from_text = std::ranges::any_of(
        job.column.stored, [](const auto& part) { return part && part->array().form == DataArray::Form::ascii; });
    if (!from_text || job.column.type != ScalarType::float32) return 0;
    const auto is_infinite = [](float value) { return std::isinf(value); };
    if (std::ranges::none_of(job.values.as<float>(), is_infinite)) return 0;
    std::uint64_t count = 0;
    for (std::size_t piece = 0; piece < job.column.stored.size(); ++piece) {
        const auto& stored = job.column.stored[piece];
        if (!stored || stored->array().form != DataArray::Form::ascii) continue;
        DataArray wide = stored->array();
        wide.type = ScalarType::float64;
        const auto values = load_array(document, wide, job.layout->tuples[piece], progress);
        if (!values) continue;
        for (const double value : values->as<double>())
            if (std::isfinite(value) && std::isinf(to_float(value))) ++count;
    }
    return count;
}

/// Puts what was read to its place in the piece.
void give(Job& job, const Wanted& wanted, Piece& piece) {
    const bool of_points = job.association == Association::point;
    if (job.is_ids) (of_points ? piece.point_ids : piece.cell_ids) = job.values;
    if (job.is_ghost && of_points) mark_around_hidden(job.values, job.column.name, *wanted.box, piece.left_out);
    else if (job.is_ghost) mark_left_out(job.values, job.column.name, piece.left_out);
    if (job.is_field)
        (of_points ? piece.grid.point_fields : piece.grid.cell_fields).push_back({job.column.name, job.values});
}

/// Where the array can be read in parts, of every piece.
bool may_stay(const Job& job) {
    return job.association == Association::cell && job.is_field && !job.is_ids && !job.is_ghost &&
           std::ranges::all_of(job.column.stored, [](const auto& part) { return !part || part->has_tuples(); });
}

/// A cell field of each piece, read or not.
void give_later(const Job& job, const Wanted& wanted, LaterFields& later) {
    const Column& column = job.column;
    const std::size_t tuple = column.components * size_of(column.type);
    const std::byte* values = static_cast<const std::byte*>(job.values.data());
    for (std::size_t piece = 0; piece < later.of_pieces.size(); ++piece) {
        const auto tuples = static_cast<std::size_t>(job.layout->tuples[piece]);
        UnreadField field{column.name, column.type, column.components};
        if (job.stays) {
            std::optional<ArrayInFile> stored;
            if (column.stored[piece]) stored.emplace(wanted.path, later.document, *column.stored[piece]);
            field.values = std::make_shared<const UnreadValues>(field, tuples, std::move(stored));
        } else {
            field.values = std::make_shared<const FieldInMemory>(
                Array(column.type, values, tuples, column.components, job.values.owner().lock()));
            values += tuples * tuple;
        }
        later.of_pieces[piece].push_back(std::move(field));
    }
}

} // namespace

namespace {

/// GEOS: the rank that owns a ghost cell; below 0 for the cells of the piece. A piece without such has another meaning.
void mark_by_rank(const Array& ranks, std::vector<std::uint8_t>& left_out) {
    ranks.visit([&](auto values) {
        if (ranks.components() != 1 ||
            std::ranges::none_of(values, [](auto rank) { return static_cast<double>(rank) < 0; }))
            return;
        for (std::size_t cell = 0; cell < left_out.size(); ++cell)
            if (static_cast<double>(values[cell]) >= 0) left_out[cell] = 1;
    });
}

} // namespace

void mark_left_out(const Array& marks, std::string_view name, std::vector<std::uint8_t>& left_out) {
    left_out.resize(marks.tuples(), 0);
    const bool levels = name == "vtkGhostLevels";
    if (name == ghost_rank_name) mark_by_rank(marks, left_out);
    else
        marks.visit([&](auto values) {
            core::parallel_each(left_out.size(), std::size_t{1} << 16, [&](std::size_t cell) {
                const auto value = static_cast<double>(values[cell * marks.components()]);
                const int mark = value > 0 && value < 0x1p31 ? static_cast<int>(value) : 0;
                if (levels ? mark > 0 : (mark & cell_is_out) != 0) left_out[cell] = 1;
            });
        });
    if (std::ranges::none_of(left_out, [](std::uint8_t out) { return out != 0; })) left_out.clear();
}

bool is_ghost_array(std::string_view name) { return name == "vtkGhostType" || name == "vtkGhostLevels"; }

bool is_of_step(const pugi::xml_node& element, std::size_t step) {
    const pugi::xml_attribute steps = element.attribute("TimeStep");
    if (!steps) return true;
    TextScanner scanner(steps.value());
    for (std::size_t number = 0; scanner.number(number);)
        if (number == step) return true;
    return false;
}

std::vector<pugi::xml_node> pieces_of(const Document& document) {
    std::vector<pugi::xml_node> pieces;
    for (const auto& piece : document.primary().children("Piece")) pieces.push_back(piece);
    if (pieces.empty()) pieces.push_back(document.primary());
    return pieces;
}

Section describe_section(const Document& document, const pugi::xml_node& element, std::size_t step) {
    Section section;
    section.global_ids = element.attribute("GlobalIds").value();
    const pugi::xml_attribute scalars = element.attribute("Scalars");
    section.active = scalars ? scalars.value() : element.attribute("Vectors").value();
    const auto is_named = [&](const std::string& name) { return find_array(section.arrays, name) != nullptr; };
    for (const auto& child : element.children()) {
        if (child.type() != pugi::node_element || !is_of_step(child, step)) continue;
        if (std::string_view(child.name()) == "InformationKey") continue;
        const std::string name = child.attribute("Name").value();
        auto array = describe_array(document, child);
        if (!array) {
            section.left_out.push_back({{}, name, reason_of(array.error(), name)});
            continue;
        }
        if (!*array) {
            section.left_out.push_back({{}, name, "it holds text, not numbers"});
            continue;
        }
        DataArray& described = **array;
        if (name.empty()) {
            described.name = "unnamed";
            for (std::size_t number = 2; is_named(described.name); ++number)
                described.name = fmt::format("unnamed_{}", number);
            section.unnamed.push_back(described.name);
        }
        if (is_named(described.name)) section.repeated.push_back(described.name);
        else section.arrays.push_back(std::move(described));
    }
    return section;
}

Result<void> read_time(Document& document, const pugi::xml_node& parent, const Progress& progress, Loaded& loaded) {
    for (const auto& element : parent.child("FieldData").children()) {
        if (std::string_view(element.attribute("Name").value()) != "TimeValue" || !loaded.info.times.empty()) continue;
        const auto array = describe_array(document, element);
        if (!array || !*array) continue;
        const auto time = load_array(document, **array, 1, progress);
        if (time) loaded.info.times.push_back(time_values(*time).front());
        else if (time.error().code != ErrorCode::invalid_data) return time.error();
        else loaded.notes.push_back("the time of the file cannot be read: " + time.error().message);
    }
    return {};
}

Result<void> announce_fields(Document& document, const Layouts& layouts, const ReadOptions& options,
                             const Progress& progress, Loaded& loaded) {
    FileInfo& info = loaded.info;
    // Steps are numbered; what their times are, the file does not say.
    TextScanner times(document.primary().attribute("TimeValues").value());
    while (!times.word().empty()) info.times.push_back(static_cast<double>(info.times.size()));
    if (auto read = read_time(document, document.primary(), progress, loaded); !read) return read;
    const auto step = choose_step(info, options);
    if (!step) return step.error();
    loaded.step = *step;
    for (const auto& [layout, association] :
         {std::pair(&layouts.points, Association::point), std::pair(&layouts.cells, Association::cell)}) {
        Columns columns = columns_of(document, association, *layout, *step);
        if (association == Association::cell || document.type != "UnstructuredGrid")
            if (auto sound = check_ghosts(columns); !sound) return sound;
        for (const Column& column : columns.columns)
            if (!is_ghost_array(column.name))
                announce(info,
                         {column.name, association, column.type, column.components, column.name == columns.active});
        for (LeftOut& item : columns.left_out) leave_out(info, std::move(item));
        std::ranges::move(columns.notes, std::back_inserter(loaded.notes));
    }
    return {};
}

Result<Array> load_points(Document& document, const std::vector<pugi::xml_node>& pieces, const Layout& layout,
                          std::size_t step, const Progress& progress) {
    if (layout.total == 0) return Array(ScalarType::float32, nullptr, 0, 3, nullptr);
    Column column;
    column.parts.resize(pieces.size());
    for (std::size_t piece = 0; piece < pieces.size(); ++piece) {
        if (layout.tuples[piece] == 0) continue;
        std::vector<DataArray> found;
        for (const auto& element : pieces[piece].child("Points").children()) {
            if (element.type() != pugi::node_element || !is_of_step(element, step)) continue;
            auto array = describe_array(document, element);
            if (!array) return array.error();
            if (*array) found.push_back(std::move(**array));
        }
        if (found.size() != 1)
            return invalid_data(fmt::format("a piece of {} points has {} arrays of points, not one",
                                            layout.tuples[piece], found.size()));
        if (found.front().components != 3)
            return invalid_data(fmt::format("the points have {} components, not 3", found.front().components));
        column.parts[piece] = std::move(found.front());
    }
    std::pair<std::size_t, std::size_t> counts;
    unite_parts(column, layout, counts);
    column.type = with_missing(column.type); // integers become float64
    if (auto found = find_values(document, layout, progress, column); !found) return found.error();
    bool more = false;
    auto values = load_values(column, layout, more);
    if (more) document.longer.emplace_back("points");
    return values;
}

Result<void> load_fields(Document& document, const Layouts& layouts, const Wanted& wanted, const Progress& progress,
                         Loaded& loaded, Piece& piece, LaterFields* later) {
    if (later) later->of_pieces.resize(layouts.cells.tuples.size());
    std::vector<Job> jobs;
    add_jobs(document, Association::point, layouts.points, wanted, jobs);
    add_jobs(document, Association::cell, layouts.cells, wanted, jobs);
    for (Job& job : jobs)
        if (auto found = find_values(document, *job.layout, progress, job.column); !found) job.error = found.error();
    for (Job& job : jobs) job.stays = later && !job.error && may_stay(job);
    core::parallel_each(jobs.size(), 1, [&](std::size_t i) {
        if (jobs[i].error || jobs[i].stays) return;
        auto values = load_values(jobs[i].column, *jobs[i].layout, jobs[i].has_more);
        if (values) jobs[i].values = std::move(*values);
        else jobs[i].error = values.error();
    });
    for (Job& job : jobs) {
        if (!job.error) {
            if (const auto count = job.is_field && !job.stays ? count_too_large(document, job, progress) : 0; count > 0)
                loaded.notes.push_back(
                    fmt::format("{} value{} of {} {} beyond float32, the type of the array: infinite", count,
                                count == 1 ? "" : "s", in_quotes(job.column.name), count == 1 ? "is" : "are"));
            for (const auto& part : job.column.stored) job.has_more |= job.stays && part && part->has_more();
            if (job.has_more) document.longer.push_back(in_quotes(job.column.name));
            if (later && job.is_field && job.association == Association::cell) {
                give_later(job, wanted, *later);
                job.is_field = false;
            }
            give(job, wanted, piece);
            continue;
        }
        if (!may_be_left_out(job, *job.error, wanted.options)) return *job.error;
        leave_out(loaded.info, {field_of(job.association), job.column.name, reason_of(*job.error, job.column.name)});
    }
    return {};
}

} // namespace isotet::io::vtk_xml
