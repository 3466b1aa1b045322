// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Packs made grids and extracts surfaces: extract_made FOLDER GRID FIELD ISOVALUE... writes FOLDER/0, FOLDER/1 and so on, positions
// and then triangles of each isovalue as they lie in memory.
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>

#include <isotet/fields.hpp>
#include <isotet/contour.hpp>
#include <isotet/make.hpp>

namespace {

using namespace isotet;

Result<void> extract_all(const std::string& folder, const char* spec, const char* name, int count, char** isovalues) {
    const Result<MakeOptions> options = parse_make(spec);
    if (!options) return options.error();
    const Result<Grid> grid = make_grid(*options);
    if (!grid) return grid.error();
    const Result<PointField> field = find_field(*grid, name);
    if (!field) return field.error();
    ContourOptions contour_options;
    contour_options.method = Method::clusters;
    Result<Contour> contour = Contour::create({*grid, *field, {}, {}}, contour_options);
    if (!contour) return contour.error();
    for (int i = 0; i < count; ++i) {
        const Result<ContourResult> made = contour->extract(std::strtod(isovalues[i], nullptr));
        if (!made) return made.error();
        const Surface& surface = made->surfaces.front().surface;
        std::ofstream file(folder + "/" + std::to_string(i), std::ios::binary);
        for (const Array* array : {&surface.positions, &surface.triangles})
            file.write(static_cast<const char*>(array->data()), static_cast<std::streamsize>(array->bytes()));
        if (!file) return Error{ErrorCode::cannot_write, folder};
        std::printf("%zu vertices, %zu triangles\n", surface.vertex_count(), surface.triangle_count());
    }
    return {};
}

} // namespace

int main(int count, char** words) {
    if (count < 5) return std::puts("usage: extract_made FOLDER GRID FIELD ISOVALUE..."), 2;
    const Result<void> done = extract_all(words[1], words[2], words[3], count - 4, words + 4);
    if (!done) return std::puts(done.error().message.c_str()), 1;
}
