// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/confined/med/med_mesh.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <limits>
#include <optional>
#include <utility>

#include <fmt/core.h>

#include "base/parallel.hpp"
#include "io/files/escape.hpp"
#include "io/pieces/join/shared_faces.hpp"
#include "io/pieces/uniform_cells.hpp"

namespace isotet::io::confined {
namespace {

constexpr std::size_t cells_at_once = std::size_t{1} << 14;
constexpr std::size_t most_nodes = 32; ///< of a cell of a type

/// What says how many cells there are: one more offset, or the nodes of them.
std::string counted_in(const MedElement& element, const std::string& group) {
    const char* const name = element.nodes > 0 ? "NOD" : element.vtk_type == med_polyhedron_type ? "IFN" : "INN";
    return fmt::format("{}/{}", group, name);
}

/// Of any number that a file may hold.
std::int64_t one_less(std::int64_t number) { return static_cast<std::int64_t>(static_cast<std::uint64_t>(number) - 1); }

/// Numbers of the file, from 1, as numbers from 0.
Result<std::vector<std::int64_t>> from_zero(const MedFile& file, const std::string& data_set) {
    const auto shape = file.shape(data_set);
    if (!shape) return file.wrong(fmt::format("\"{}\" is not there", escaped(data_set)));
    const auto values = file.numbers(data_set, shape->rows);
    if (!values) return values.error();
    if (is_floating(values->type())) return file.wrong(fmt::format("\"{}\" holds no integers", escaped(data_set)));
    std::vector<std::int64_t> numbers(values->size());
    values->visit([&](auto from) {
        for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = one_less(static_cast<std::int64_t>(from[i]));
    });
    return numbers;
}

/// MED stores the first nodes of all cells, then the second ones, and so on.
void interlace(const Array& stored, std::uint64_t cells, std::size_t nodes, std::int64_t* to) {
    stored.visit([&](auto from) {
        core::parallel_ranges(cells, cells_at_once, [&](std::size_t begin, std::size_t end) {
            for (std::size_t node = 0; node < nodes; ++node)
                for (std::size_t cell = begin; cell < end; ++cell)
                    to[cell * nodes + node] = one_less(static_cast<std::int64_t>(from[node * cells + cell]));
        });
    });
}

/// The place of the first number that is no point, if there is one.
std::optional<std::size_t> first_outside(const std::vector<std::int64_t>& nodes, std::uint64_t points) {
    std::atomic<std::size_t> first = nodes.size();
    core::parallel_ranges(nodes.size(), std::size_t{1} << 16, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            if (static_cast<std::uint64_t>(nodes[i]) < points) continue;
            std::size_t known = first;
            while (i < known && !first.compare_exchange_weak(known, i)) {}
            return;
        }
    });
    return first == nodes.size() ? std::nullopt : std::optional<std::size_t>(first);
}

/// The same of a block of all numbers, `first` of which come before, in VTK's order. False: some are no points.
template <class Index>
bool interlace_block(std::uint64_t first, const Array& block, const MedCellRun& run, std::uint64_t points, Index* to) {
    const std::size_t width = run.element->nodes;
    std::array<std::size_t, most_nodes> places{};
    for (std::size_t i = 0; i < width; ++i) places[run.element->order[i]] = i;
    return block.visit([&](auto from) {
        bool sound = true;
        std::uint64_t node = first / run.count, cell = first % run.count;
        for (std::size_t i = 0; i < from.size(); ++node, cell = 0) {
            Index* const out = to + places[node];
            for (; cell < run.count && i < from.size(); ++cell, ++i) {
                const std::int64_t point = one_less(static_cast<std::int64_t>(from[i]));
                sound = sound && static_cast<std::uint64_t>(point) < points;
                out[cell * width] = static_cast<Index>(point);
            }
        }
        return sound;
    });
}

} // namespace

MedCells cells_to_read(const MedFile& file) {
    for (const std::string& mesh : file.groups("/ENS_MAA"))
        for (const MedStep& step : med_steps(file, "/ENS_MAA/" + mesh))
            for (const std::string& type : file.groups(step.group + "/MAI"))
                if (const MedElement* const solid = med_element(type, MedCells::with_a_volume)) {
                    const auto shape = file.shape(counted_in(*solid, step.group + "/MAI/" + type));
                    if (!shape || shape->rows > (solid->nodes > 0 ? 0u : 1u)) return MedCells::with_a_volume;
                }
    return MedCells::flat;
}

MedMesh::MedMesh(const MedFile& file, const std::string& name, MedCells kind) : file_(file), name_(name), kind_(kind) {
    const std::string group = "/ENS_MAA/" + name;
    steps_ = med_steps(file, group);
    const auto dimension = file.integer(group, "ESP");
    if (file.integer(group, "TYP").value_or(0) != 0) problem_ = "it is a structured mesh, which is not read";
    else if (file.integer(group, "REP").value_or(0) != 0) problem_ = "its coordinates are not Cartesian";
    else if (dimension < 1 || dimension > 3)
        problem_ = fmt::format("it is a mesh in {} dimensions", dimension.value_or(0));
    else if (steps_.empty()) problem_ = "it has no points and cells";
    else axes_ = static_cast<std::uint64_t>(*dimension);
}

Result<MedCellRun> MedMesh::run_of(const MedElement& element, const std::string& group) const {
    MedCellRun run{&element, group, 0, 0};
    const bool offsets = element.nodes == 0;
    const std::string data_set = counted_in(element, group);
    const auto shape = file_.shape(data_set);
    if (!shape || shape->columns != 1 || is_floating(shape->type))
        return file_.wrong(fmt::format("\"{}\" is no list of integers", escaped(data_set)));
    if (offsets && shape->rows == 0) return file_.wrong(fmt::format("\"{}\" is empty", escaped(data_set)));
    run.count = offsets ? shape->rows - 1 : shape->rows / element.nodes;
    if (!offsets && run.count * element.nodes != shape->rows)
        return file_.wrong(fmt::format("\"{}\" has {} numbers, but cells of {} have {} nodes each", escaped(data_set),
                                       shape->rows, element.name, element.nodes));
    const auto stated = file_.integer(data_set, "NBR");
    if (!offsets && stated && static_cast<std::uint64_t>(*stated) != run.count)
        return file_.wrong(
            fmt::format("\"{}\" has the nodes of {} cells, but states {}", escaped(data_set), run.count, *stated));
    return run;
}

Result<MedMeshPlace> MedMesh::place_at(std::int64_t number, std::int64_t iteration) const {
    const auto same = [&](const MedStep& step) { return step.number == number && step.iteration == iteration; };
    auto last = std::ranges::find_if(steps_, same);
    if (last == steps_.end()) last = steps_.begin();
    MedMeshPlace place;
    std::string cells;
    for (auto step = steps_.begin(); step != std::next(last); ++step) {
        if (file_.has(step->group + "/NOE/COO")) place.coordinates = step->group + "/NOE/COO";
        if (!file_.groups(step->group + "/MAI").empty()) cells = step->group + "/MAI";
    }
    place.elements = cells;
    const auto shape = file_.shape(place.coordinates);
    if (!shape || shape->columns != 1 || !is_floating(shape->type) || shape->rows % axes_ != 0)
        return file_.wrong(fmt::format("mesh \"{}\" has no table of coordinates", escaped(name_)));
    place.points = shape->rows / axes_;
    for (const std::string& type : file_.groups(cells)) {
        const MedElement* const element = med_element(type, kind_);
        if (!element) continue;
        auto run = run_of(*element, cells + "/" + type);
        if (!run) return run.error();
        run->first = place.cells;
        place.cells += run->count;
        if (run->count > 0) place.runs.push_back(*std::move(run));
    }
    return place;
}

Result<Array> MedMesh::points(const MedMeshPlace& place) const {
    const auto stored = file_.numbers(place.coordinates, place.points * axes_);
    if (!stored) return stored;
    std::vector<double> points(3 * place.points);
    stored->visit([&](auto from) {
        core::parallel_ranges(place.points, cells_at_once, [&](std::size_t begin, std::size_t end) {
            for (std::size_t axis = 0; axis < axes_; ++axis)
                for (std::size_t i = begin; i < end; ++i)
                    points[3 * i + axis] = static_cast<double>(from[axis * place.points + i]);
        });
    });
    return Array::own(std::move(points), 3);
}

Result<std::vector<std::int64_t>> MedMesh::nodes_of(const MedCellRun& run, std::uint64_t points) const {
    const std::size_t width = run.element->nodes;
    const auto stored = file_.numbers(run.group + "/NOD", run.count * width);
    if (!stored) return stored.error();
    std::vector<std::int64_t> nodes(stored->size());
    interlace(*stored, run.count, width, nodes.data());
    if (const auto at = first_outside(nodes, points))
        return file_.wrong(fmt::format("mesh \"{}\": cell {} of {} has node {}, but the nodes are 1 to {}",
                                       escaped(name_), *at / width, run.element->name, nodes[*at] + 1, points));
    return nodes;
}

Result<void> MedMesh::add_polyhedra(const MedMeshPlace& place, Cells& cells) const {
    const auto run =
        std::ranges::find(place.runs, med_polyhedron_type, [](const MedCellRun& one) { return one.element->vtk_type; });
    if (run == place.runs.end()) return {};
    auto points = from_zero(file_, run->group + "/NOD");
    if (!points) return points.error();
    if (const auto at = first_outside(*points, place.points))
        return file_.wrong(fmt::format("mesh \"{}\": a face has node {}, but the nodes are 1 to {}", escaped(name_),
                                       (*points)[*at] + 1, place.points));
    auto face_offsets = from_zero(file_, run->group + "/INN");
    if (!face_offsets) return face_offsets.error();
    const auto own_offsets = from_zero(file_, run->group + "/IFN");
    if (!own_offsets) return own_offsets.error();
    std::vector<std::int64_t> faces(face_offsets->empty() ? 0 : face_offsets->size() - 1);
    for (std::size_t face = 0; face < faces.size(); ++face) faces[face] = static_cast<std::int64_t>(face);
    std::vector<std::int64_t> cell_offsets(run->first, own_offsets->front());
    cell_offsets.insert(cell_offsets.end(), own_offsets->begin(), own_offsets->end());
    cell_offsets.resize(place.cells + 1, own_offsets->back());
    const SharedFaces shared{Array::own(*std::move(points)), Array::own(*std::move(face_offsets)),
                             Array::own(std::move(faces)), Array::own(std::move(cell_offsets))};
    if (auto done = write_out_faces(shared, cells); !done) return file_.wrong(done.error().message);
    if (auto done = list_points_of_faces(place.points, cells); !done) return file_.wrong(done.error().message);
    return {};
}

/// The nodes of one polygon after those of another; from 0.
Result<std::vector<std::int64_t>> MedMesh::polygon_nodes(const MedCellRun& run, std::uint64_t points) const {
    auto nodes = from_zero(file_, run.group + "/NOD");
    if (!nodes) return nodes;
    if (const auto at = first_outside(*nodes, points))
        return file_.wrong(fmt::format("mesh \"{}\": a polygon has node {}, but the nodes are 1 to {}", escaped(name_),
                                       (*nodes)[*at] + 1, points));
    return nodes;
}

Result<void> MedMesh::add_polygon_offsets(const MedCellRun& run, std::vector<std::int64_t>& offsets) const {
    const auto own = from_zero(file_, run.group + "/INN");
    if (!own) return own.error();
    const auto nodes = file_.shape(run.group + "/NOD");
    if (own->front() != 0 || !std::ranges::is_sorted(*own) || !nodes ||
        static_cast<std::uint64_t>(own->back()) != nodes->rows)
        return file_.wrong(fmt::format("\"{}/INN\" does not rise from 1 to one more than the nodes of the polygons",
                                       escaped(run.group)));
    const std::int64_t before = offsets.back();
    for (std::size_t i = 1; i < own->size(); ++i) offsets.push_back(before + (*own)[i]);
    return {};
}

template <class Index>
Result<void> MedMesh::read_corners(const MedCellRun& run, std::uint64_t points, Index* to) const {
    std::atomic<bool> sound = true;
    const auto done = file_.each_block(run.group + "/NOD", run.count * run.element->nodes,
                                       [&](std::uint64_t first, const Array& block) {
                                           if (!interlace_block(first, block, run, points, to)) sound = false;
                                       });
    if (!done || sound) return done;
    const auto nodes = nodes_of(run, points); // says which
    return nodes ? Result<void>() : nodes.error();
}

template <class Index>
Result<Array> MedMesh::connectivity(const MedMeshPlace& place) const {
    std::vector<Index> all;
    std::uint64_t count = 0;
    for (const MedCellRun& run : place.runs) count += run.count * run.element->nodes;
    all.reserve(count);
    for (const MedCellRun& run : place.runs) {
        if (run.element->vtk_type == med_polyhedron_type) continue;
        if (run.element->nodes > 0) {
            const std::size_t before = all.size();
            all.resize(before + run.count * run.element->nodes);
            if (auto read = read_corners(run, place.points, all.data() + before); !read) return read.error();
            continue;
        }
        const auto nodes = polygon_nodes(run, place.points);
        if (!nodes) return nodes.error();
        for (const std::int64_t node : *nodes) all.push_back(static_cast<Index>(node));
    }
    return Array::own(std::move(all));
}

Result<Cells> MedMesh::cells(const MedMeshPlace& place) const {
    Cells cells;
    const bool narrow = place.points <= std::numeric_limits<std::int32_t>::max();
    auto nodes = narrow ? connectivity<std::int32_t>(place) : connectivity<std::int64_t>(place);
    if (!nodes) return nodes.error();
    cells.connectivity = *std::move(nodes);
    if (place.runs.size() == 1 && vtk_xml::corners_of_uniform(place.runs.front().element->vtk_type)) {
        cells.uniform_type = static_cast<CellType>(place.runs.front().element->vtk_type);
        return cells;
    }
    std::vector<std::int64_t> offsets{0};
    std::vector<std::uint8_t> types;
    for (const MedCellRun& run : place.runs) {
        types.insert(types.end(), run.count, run.element->vtk_type);
        if (run.element->nodes == 0 && run.element->vtk_type != med_polyhedron_type) {
            if (auto done = add_polygon_offsets(run, offsets); !done) return done.error();
            continue;
        }
        for (std::uint64_t i = 0; i < run.count; ++i) offsets.push_back(offsets.back() + run.element->nodes);
    }
    cells.offsets = Array::own(std::move(offsets));
    cells.types = Array::own(std::move(types));
    if (auto done = add_polyhedra(place, cells); !done) return done.error();
    vtk_xml::simplify(cells);
    return cells;
}

Result<void> MedMesh::add_faces(const std::string& group, std::uint32_t nodes, std::uint64_t points,
                                const std::map<std::int64_t, std::vector<std::string>>& groups,
                                core::PatchList& numbers, core::PatchList& list) const {
    const auto shape = file_.shape(group + "/NOD");
    if (!shape || !file_.has(group + "/FAM") || shape->columns != 1 || is_floating(shape->type) ||
        shape->rows % nodes != 0)
        return {};
    const MedElement element{"", nodes, 0, {}};
    const auto corners = nodes_of({&element, group, 0, shape->rows / nodes}, points);
    if (!corners) return corners.error();
    const auto families = file_.numbers(group + "/FAM", shape->rows / nodes);
    if (!families) return families.error();
    for (std::size_t face = 0; face < families->size(); ++face) {
        const auto in = groups.find(static_cast<std::int64_t>(families->at(face)));
        if (in == groups.end() || in->second.empty()) continue;
        const std::int64_t number = numbers.number_of(in->second.front());
        list.name(number, in->second.front());
        for (std::uint32_t k = 0; k < nodes; ++k) list.point((*corners)[face * nodes + k]);
        list.end_face(number);
    }
    return {};
}

Result<void> MedMesh::add_patches(const MedMeshPlace& place, core::PatchList& numbers, core::PatchList& list) const {
    const auto groups = groups_of_families();
    for (const std::string& type : file_.groups(place.elements))
        if (const std::uint32_t nodes = nodes_of_med_face(type))
            if (auto added = add_faces(place.elements + "/" + type, nodes, place.points, groups, numbers, list); !added)
                return added;
    return {};
}

bool MedMesh::has_families(const MedMeshPlace& place) const {
    return std::ranges::any_of(place.runs, [&](const MedCellRun& run) { return file_.has(run.group + "/FAM"); });
}

Result<std::vector<std::int64_t>> MedMesh::families(const MedMeshPlace& place) const {
    std::vector<std::int64_t> families(place.cells);
    for (const MedCellRun& run : place.runs) {
        if (!file_.has(run.group + "/FAM")) continue;
        const auto numbers = file_.numbers(run.group + "/FAM", run.count);
        if (!numbers) return numbers.error();
        if (is_floating(numbers->type()))
            return file_.wrong(fmt::format("\"{}/FAM\" holds no integers", escaped(run.group)));
        numbers->visit([&](auto from) {
            for (std::size_t i = 0; i < from.size(); ++i) families[run.first + i] = static_cast<std::int64_t>(from[i]);
        });
    }
    return families;
}

std::map<std::int64_t, std::vector<std::string>> MedMesh::groups_of_families() const {
    std::map<std::int64_t, std::vector<std::string>> result;
    const std::string all = "/FAS/" + name_ + "/ELEME";
    for (const std::string& family : file_.groups(all)) {
        const std::string group = all + "/" + family;
        const auto number = file_.integer(group, "NUM");
        if (number) result[*number] = file_.texts(group + "/GRO/NOM");
    }
    return result;
}

} // namespace isotet::io::confined
