// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "readers/foam_sample.hpp"

#include <algorithm>
#include <cstring>
#include <set>

#include <fmt/format.h>

namespace isotet::test {

namespace {

using Place = std::array<int, 3>;

struct Leaf {
    Place at;
    int size;
};

/// Corners of a square of `size`, wound by the right hand around the direction.
std::vector<Place> square(Place low, int axis, bool upward, int size) {
    const auto u = static_cast<std::size_t>((axis + 1) % 3), v = static_cast<std::size_t>((axis + 2) % 3);
    std::vector<Place> corners(4, low);
    corners[1][u] += size;
    corners[2][u] += size;
    corners[2][v] += size;
    corners[3][v] += size;
    if (!upward) std::reverse(corners.begin() + 1, corners.end());
    return corners;
}

class BoxMaker {
public:
    BoxMaker(int side, const std::function<bool(int, int, int)>& refined) : side_(side), refined_(refined) {
        for (int z = 0; z < side; ++z)
            for (int y = 0; y < side; ++y)
                for (int x = 0; x < side; ++x) {
                    if (!refined(x, y, z)) leaves_.push_back({{2 * x, 2 * y, 2 * z}, 2});
                    for (int k = 0; k < 8 && refined(x, y, z); ++k)
                        leaves_.push_back({{2 * x + (k & 1), 2 * y + (k >> 1 & 1), 2 * z + (k >> 2)}, 1});
                }
        for (const Leaf& leaf : leaves_)
            for (int k = 0; k < 8; ++k)
                corners_.insert({leaf.at[0] + leaf.size * (k & 1), leaf.at[1] + leaf.size * (k >> 1 & 1),
                                 leaf.at[2] + leaf.size * (k >> 2)});
    }

    FoamBox make() {
        for (std::size_t cell = 0; cell < leaves_.size(); ++cell) add_cell(cell);
        FoamBox box;
        for (const Leaf& leaf : leaves_) {
            std::array<double, 3> centre;
            for (std::size_t k = 0; k < 3; ++k) centre[k] = (leaf.at[k] + leaf.size / 2.0) / 2;
            box.centres.push_back(centre);
        }
        std::map<Place, std::int64_t> numbers;
        for (const Place& place : corners_) {
            numbers[place] = static_cast<std::int64_t>(box.points.size());
            box.points.push_back({place[0] / 2.0, place[1] / 2.0, place[2] / 2.0});
        }
        std::vector<Face> faces;
        for (auto& [key, face] : faces_) faces.push_back(face);
        const auto rank = [](const Face& face) { return face.neighbour >= 0 ? 0 : face.heated ? 1 : 2; };
        std::ranges::sort(faces, [&](const Face& a, const Face& b) {
            return std::tuple(rank(a), a.owner, a.neighbour, a.loop) <
                   std::tuple(rank(b), b.owner, b.neighbour, b.loop);
        });
        box.patches = {{"heated", "wall", 0, 0}, {"sides", "patch", 0, 0}};
        for (const Face& face : faces) {
            std::vector<std::int64_t> loop;
            for (const Place& place : face.loop) loop.push_back(numbers.at(place));
            if (rank(face) > 0) {
                FoamBox::Patch& patch = box.patches[static_cast<std::size_t>(rank(face) - 1)];
                if (patch.count++ == 0) patch.first = box.faces.size();
            }
            box.faces.push_back(std::move(loop));
            box.owner.push_back(face.owner);
            box.neighbour.push_back(face.neighbour);
        }
        return box;
    }

private:
    struct Face {
        std::vector<Place> loop;
        std::int64_t owner = 0, neighbour = -1;
        bool heated = false;
    };

    void add_cell(std::size_t cell) {
        const Leaf& leaf = leaves_[cell];
        for (int axis = 0; axis < 3; ++axis)
            for (const bool upward : {false, true}) {
                Place low = leaf.at, beyond = leaf.at;
                const auto a = static_cast<std::size_t>(axis);
                if (upward) low[a] += leaf.size;
                beyond[a] += upward ? leaf.size : -1;
                const bool outside = beyond[a] < 0 || beyond[a] >= 2 * side_;
                const bool split = leaf.size == 2 && !outside && refined_(beyond[0] / 2, beyond[1] / 2, beyond[2] / 2);
                for (int k = 0; k < (split ? 4 : 1); ++k) {
                    Place corner = low;
                    corner[static_cast<std::size_t>((axis + 1) % 3)] += k & 1;
                    corner[static_cast<std::size_t>((axis + 2) % 3)] += k >> 1;
                    add_face(square(corner, axis, upward, split ? 1 : leaf.size), static_cast<std::int64_t>(cell),
                             axis == 2 && !upward && outside);
                }
            }
    }

    void add_face(const std::vector<Place>& corners, std::int64_t cell, bool heated) {
        Face face;
        for (std::size_t k = 0; k < 4; ++k) {
            face.loop.push_back(corners[k]);
            Place middle;
            for (std::size_t i = 0; i < 3; ++i) middle[i] = (corners[k][i] + corners[(k + 1) % 4][i]) / 2;
            if (middle != corners[k] && middle != corners[(k + 1) % 4] && corners_.contains(middle))
                face.loop.push_back(middle);
        }
        face.owner = cell;
        face.heated = heated;
        std::vector<Place> key = face.loop;
        std::ranges::sort(key);
        const auto [place, is_new] = faces_.try_emplace(key, face);
        if (!is_new) place->second.neighbour = cell; // later cells have higher numbers
    }

    int side_;
    const std::function<bool(int, int, int)>& refined_;
    std::vector<Leaf> leaves_;
    std::set<Place> corners_;
    std::map<std::vector<Place>, Face> faces_;
};

std::string label_bytes(std::int64_t value, const FoamStyle& style) {
    std::string out(static_cast<std::size_t>(style.label) / 8, '\0');
    const auto narrow = static_cast<std::int32_t>(value);
    if (style.label == 64) std::memcpy(out.data(), &value, 8);
    else std::memcpy(out.data(), &narrow, 4);
    return out;
}

std::string scalar_bytes(double value, const FoamStyle& style) {
    std::string out(static_cast<std::size_t>(style.scalar) / 8, '\0');
    const auto narrow = static_cast<float>(value);
    if (style.scalar == 64) std::memcpy(out.data(), &value, 8);
    else std::memcpy(out.data(), &narrow, 4);
    return out;
}

std::string label_list(const std::vector<std::int64_t>& values, const FoamStyle& style) {
    if (values.empty()) return "0()";
    std::string out = fmt::format("{}\n(", values.size());
    for (const std::int64_t value : values)
        out += style.binary ? label_bytes(value, style) : fmt::format("{}\n", value);
    return out + ")\n";
}

std::string tuple_list(const std::vector<std::vector<double>>& tuples, const FoamStyle& style) {
    if (tuples.empty()) return "0()";
    std::string out = fmt::format("{}\n(", tuples.size());
    for (const std::vector<double>& tuple : tuples) {
        if (style.binary)
            for (const double value : tuple) out += scalar_bytes(value, style);
        else if (tuple.size() == 1) out += fmt::format("{}\n", tuple[0]);
        else out += fmt::format("({})\n", fmt::join(tuple, " "));
    }
    return out + ")\n";
}

std::string face_list(const std::vector<std::vector<std::int64_t>>& faces, const FoamStyle& style) {
    std::string out = fmt::format("{}\n(\n", faces.size());
    if (!style.binary) {
        for (const auto& face : faces) out += fmt::format("{}({})\n", face.size(), fmt::join(face, " "));
        return out + ")\n";
    }
    std::vector<std::int64_t> begins{0}, corners;
    for (const auto& face : faces) {
        corners.insert(corners.end(), face.begin(), face.end());
        begins.push_back(static_cast<std::int64_t>(corners.size()));
    }
    return label_list(begins, style) + label_list(corners, style);
}

std::vector<double> tuple_at(double value, std::size_t components) {
    std::vector<double> tuple;
    for (std::size_t k = 0; k < components; ++k) tuple.push_back(value * static_cast<double>(k + 1));
    return tuple;
}

std::string field_body(const FoamBox& box, const FoamFunction& f, std::size_t components, const FoamStyle& style) {
    const std::string list = components == 1 ? "nonuniform List<scalar> " : "nonuniform List<vector> ";
    std::vector<std::vector<double>> inside;
    for (const auto& centre : box.centres) inside.push_back(tuple_at(f(centre), components));
    std::string body = "dimensions [0 0 0 1 0 0 0];\ninternalField " + list + tuple_list(inside, style) + ";\n";
    body += "boundaryField\n{\n";
    for (const FoamBox::Patch& patch : box.patches) {
        std::vector<std::vector<double>> values;
        for (std::size_t i = 0; i < patch.count; ++i)
            values.push_back(tuple_at(f(box.centre_of_face(patch.first + i)), components));
        const bool wall = patch.name == "heated", processor = patch.type == "processor";
        body += fmt::format("    {}\n    {{\n        type {};\n", patch.name,
                            wall        ? "fixedValue"
                            : processor ? "processor"
                                        : "zeroGradient");
        if (wall || processor) body += "        value " + list + tuple_list(values, style) + ";\n";
        body += "    }\n";
    }
    return body + "}\n";
}

} // namespace

std::array<double, 3> FoamBox::centre_of_face(std::size_t face) const {
    std::array<double, 3> low = points[static_cast<std::size_t>(faces[face][0])], high = low;
    for (const std::int64_t point : faces[face])
        for (std::size_t k = 0; k < 3; ++k) {
            low[k] = std::min(low[k], points[static_cast<std::size_t>(point)][k]);
            high[k] = std::max(high[k], points[static_cast<std::size_t>(point)][k]);
        }
    return {(low[0] + high[0]) / 2, (low[1] + high[1]) / 2, (low[2] + high[2]) / 2};
}

FoamBox foam_box(int side, const std::function<bool(int, int, int)>& refined) { return BoxMaker(side, refined).make(); }

FoamBox part_of(const FoamBox& whole, const std::vector<int>& processor_of, int processor) {
    FoamBox part;
    std::vector<std::int64_t> cells(whole.centres.size(), -1), points(whole.points.size(), -1);
    for (std::size_t cell = 0; cell < whole.centres.size(); ++cell) {
        if (processor_of[cell] != processor) continue;
        cells[cell] = static_cast<std::int64_t>(part.centres.size());
        part.centres.push_back(whole.centres[cell]);
        part.cell_numbers.push_back(static_cast<std::int64_t>(cell));
    }
    const auto own_cell = [&](std::int64_t cell) { return cell < 0 ? -1 : cells[static_cast<std::size_t>(cell)]; };
    const auto add = [&](std::size_t face) {
        std::vector<std::int64_t> loop = whole.faces[face];
        std::int64_t owner = own_cell(whole.owner[face]), neighbour = own_cell(whole.neighbour[face]);
        if (owner < 0) {
            std::ranges::reverse(loop);
            std::swap(owner, neighbour);
        }
        for (std::int64_t& point : loop) {
            std::int64_t& own = points[static_cast<std::size_t>(point)];
            if (own < 0) {
                own = static_cast<std::int64_t>(part.points.size());
                part.points.push_back(whole.points[static_cast<std::size_t>(point)]);
                part.point_numbers.push_back(point);
            }
            point = own;
        }
        part.faces.push_back(loop);
        part.owner.push_back(owner);
        part.neighbour.push_back(neighbour);
    };
    std::map<int, std::vector<std::size_t>> between;
    for (std::size_t face = 0; face < whole.faces.size(); ++face) {
        if (whole.neighbour[face] < 0) continue;
        const int a = processor_of[static_cast<std::size_t>(whole.owner[face])],
                  b = processor_of[static_cast<std::size_t>(whole.neighbour[face])];
        if (a == processor && b == processor) add(face);
        else if (a == processor || b == processor) between[a == processor ? b : a].push_back(face);
    }
    for (const FoamBox::Zone& zone : whole.zones) {
        FoamBox::Zone& own = part.zones.emplace_back(zone.name);
        for (const std::int64_t cell : zone.cells)
            if (own_cell(cell) >= 0) own.cells.push_back(own_cell(cell));
    }
    for (const FoamBox::Patch& patch : whole.patches) {
        const std::size_t first = part.faces.size();
        for (std::size_t face = patch.first; face < patch.first + patch.count; ++face)
            if (own_cell(whole.owner[face]) >= 0) add(face);
        part.patches.push_back({patch.name, patch.type, first, part.faces.size() - first});
    }
    for (const auto& [other, faces] : between) {
        const std::size_t first = part.faces.size();
        for (const std::size_t face : faces) add(face);
        part.patches.push_back({fmt::format("procBoundary{}to{}", processor, other), "processor", first, faces.size()});
    }
    return part;
}

std::string foam_file(const std::string& type, const std::string& name, const FoamStyle& style,
                      const std::string& body) {
    return fmt::format("/* made for a test */\nFoamFile\n{{\n    version 2.0;\n    format {};\n    arch "
                       "\"LSB;label={};scalar={}\";\n    class {};\n    object {};\n}}\n// * * //\n\n{}",
                       style.binary ? "binary" : "ascii", style.label, style.scalar, type, name, body);
}

void add_mesh(FoamFiles& files, const std::string& prefix, const FoamBox& box, const FoamStyle& style) {
    const std::string folder = prefix + "constant/polyMesh/";
    std::vector<std::vector<double>> points;
    for (const auto& point : box.points) points.push_back({point.begin(), point.end()});
    files[folder + "points"] = foam_file("vectorField", "points", style, tuple_list(points, style));
    files[folder + "faces"] =
        foam_file(style.binary ? "faceCompactList" : "faceList", "faces", style, face_list(box.faces, style));
    files[folder + "owner"] = foam_file("labelList", "owner", style, label_list(box.owner, style));
    std::vector<std::int64_t> neighbour;
    for (const std::int64_t cell : box.neighbour)
        if (cell >= 0) neighbour.push_back(cell);
    files[folder + "neighbour"] = foam_file("labelList", "neighbour", style, label_list(neighbour, style));
    std::string boundary = fmt::format("{}\n(\n", box.patches.size());
    for (const FoamBox::Patch& patch : box.patches)
        boundary +=
            fmt::format("    {}\n    {{\n        type {};\n        inGroups 1({});\n        nFaces {};\n        "
                        "startFace {};\n    }}\n",
                        patch.name, patch.type, patch.type, patch.count, patch.first);
    FoamStyle text = style;
    text.binary = false;
    files[folder + "boundary"] = foam_file("polyBoundaryMesh", "boundary", text, boundary + ")\n");
    std::string zones = fmt::format("{}\n(\n", box.zones.size());
    for (const FoamBox::Zone& zone : box.zones)
        zones += fmt::format("{}\n{{\n    type cellZone;\n    cellLabels List<label> {};\n}}\n", zone.name,
                             label_list(zone.cells, style));
    if (!box.zones.empty()) files[folder + "cellZones"] = foam_file("regIOobject", "cellZones", style, zones + ")\n");
    if (box.point_numbers.empty() || !style.addressing) return;
    files[folder + "pointProcAddressing"] =
        foam_file("labelList", "pointProcAddressing", style, label_list(box.point_numbers, style));
    files[folder + "cellProcAddressing"] =
        foam_file("labelList", "cellProcAddressing", style, label_list(box.cell_numbers, style));
}

void add_fields(FoamFiles& files, const std::string& time_folder, const FoamBox& box, const FoamFunction& f,
                const FoamStyle& style) {
    files[time_folder + "T"] = foam_file("volScalarField", "T", style, field_body(box, f, 1, style));
    files[time_folder + "U"] = foam_file("volVectorField", "U", style, field_body(box, f, 3, style));
}

FoamFiles foam_case(const FoamBox& box, const FoamFunction& f, const FoamStyle& style, int processors) {
    FoamFiles files;
    files["system/controlDict"] = foam_file("dictionary", "controlDict", {}, "application none;\n");
    const auto add = [&](const std::string& prefix, const FoamBox& part) {
        add_mesh(files, prefix, part, style);
        add_fields(files, prefix + "0/", part, [](const auto&) { return 1.0; }, style);
        add_fields(files, prefix + "0.5/", part, f, style);
    };
    if (processors == 0) add("", box);
    std::vector<int> processor_of;
    for (const auto& centre : box.centres)
        processor_of.push_back(static_cast<int>(7 * centre[0] + 3 * centre[1] + 5 * centre[2]) %
                               std::max(processors, 1));
    for (int p = 0; p < processors; ++p) add(fmt::format("processor{}/", p), part_of(box, processor_of, p));
    return files;
}

FoamFiles collated(const FoamFiles& files, const std::vector<int>& groups, bool grouped) {
    const int total = std::accumulate(groups.begin(), groups.end(), 0);
    FoamFiles result;
    const std::string any = "processor0/";
    int first = 0;
    for (const int count : groups) {
        std::string folder = "processors" + std::to_string(total);
        if (grouped) folder += "_" + std::to_string(first) + "-" + std::to_string(first + count - 1);
        for (const auto& [name, content] : files) {
            if (!name.starts_with("processor")) result[name] = content;
            if (!name.starts_with(any)) continue;
            const std::string rest = name.substr(any.size() - 1);
            std::string text = "FoamFile\n{\n    version 2.0;\n    format binary;\n    class decomposedBlockData;\n"
                               "    object " +
                               rest.substr(rest.rfind('/') + 1) + ";\n}\n// * * * //\n";
            for (int i = 0; i < count; ++i) {
                std::string block = files.at("processor" + std::to_string(first + i) + rest);
                if (i > 0) block.erase(0, block.find('}') + 1);
                text += "\n// Processor" + std::to_string(i) + "\n\n" + std::to_string(block.size()) + "\n(" + block +
                        ")\n";
            }
            result[folder + rest] = text;
        }
        first += count;
    }
    return result;
}

} // namespace isotet::test
