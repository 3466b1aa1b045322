// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/foam/cell_zones.hpp"

#include <algorithm>
#include <utility>

#include <fmt/core.h>

#include "io/files/text_scanner.hpp"
#include "io/foam/scanner.hpp"
#include "io/pieces/loaded.hpp"

namespace isotet::io::foam {

namespace {

Result<CellZone> read_zone(Scanner& scanner, std::span<const std::string> wanted) {
    CellZone zone;
    zone.name = scanner.token();
    if (auto begins = scanner.expect('{', "a zone of cells"); !begins) return begins.error();
    while (!scanner.take('}')) {
        const std::string_view key = scanner.token();
        if (key.empty()) return scanner.fail(fmt::format("the zone {} has no '}}'", in_quotes(zone.name)));
        if (key != "cellLabels") {
            if (auto skipped = scanner.skip_entry(); !skipped) return skipped.error();
            continue;
        }
        if (scanner.peek() == 'L') static_cast<void>(scanner.token()); // List<label>
        const std::string what = fmt::format("the cells of the zone {}", in_quotes(zone.name));
        if (std::ranges::find(wanted, zone.name) == wanted.end()) {
            const auto count = scanner.skip_labels(what);
            if (!count) return count.error();
            zone.count = *count;
        } else {
            auto cells = scanner.labels(what, 0);
            if (!cells) return cells.error();
            if (std::ranges::find(*cells, -1) != cells->end()) return scanner.fail(what + ": one is -1");
            zone.cells = std::move(*cells);
            zone.count = zone.cells.size();
        }
        if (auto end = scanner.expect(';', "the cells of a zone"); !end) return end.error();
    }
    return zone;
}

Result<void> read_zones(const CaseFiles& files, const std::string& name, std::span<const std::string> wanted,
                        std::vector<CellZone>& zones) {
    auto text = files.open(name);
    if (!text) return text.error();
    Scanner scanner(std::move(*text));
    if (auto header = scanner.header(); !header) return header.error();
    const auto count = scanner.count("the zones of cells");
    if (!count) return count.error();
    if (*count == 0 && scanner.peek() != '(') return {};
    if (auto begins = scanner.expect('(', "the zones of cells"); !begins) return begins;
    for (std::uint64_t i = 0; i < *count; ++i) {
        auto zone = read_zone(scanner, wanted);
        if (!zone) return zone.error();
        zones.push_back(std::move(*zone));
    }
    return scanner.expect(')', "the zones of cells");
}

bool has_all(const std::vector<CellZone>& zones, std::span<const std::string> wanted) {
    return std::ranges::all_of(wanted, [&](const std::string& name) {
        return std::ranges::find(zones, name, &CellZone::name) != zones.end();
    });
}

} // namespace

CellZones read_cell_zones(const CaseFiles& files, const std::string& folder, std::span<const std::string> wanted) {
    CellZones out;
    const std::string name = folder + "/cellZones";
    if (!files.has(name)) return out;
    if (auto read = read_zones(files, name, wanted, out.zones); !read) out.fault = read.error();
    return out;
}

Result<std::vector<std::uint8_t>> cells_outside(std::span<const std::string> zones, const CaseFiles& files,
                                                const std::vector<MeshPlace>& places, const WholeMesh& whole) {
    std::vector<std::uint8_t> outside(whole.mesh.cells, 1);
    for (std::size_t p = 0; p < places.size(); ++p) {
        const Part& part = whole.parts[p];
        const auto found = read_cell_zones(files, places[p].faces, zones);
        if (found.fault && !has_all(found.zones, zones)) return *found.fault;
        for (const CellZone& zone : found.zones)
            for (const std::int32_t cell : zone.cells) {
                const auto own = static_cast<std::size_t>(cell);
                if (own >= part.cells)
                    return broken(files.path_of(places[p].faces + "/cellZones"),
                                  fmt::format("the zone {} has cell {}, but there are {} cells", in_quotes(zone.name),
                                              cell, part.cells));
                outside[part.cell_numbers.empty() ? own : static_cast<std::size_t>(part.cell_numbers[own])] = 0;
            }
    }
    return outside;
}

} // namespace isotet::io::foam
