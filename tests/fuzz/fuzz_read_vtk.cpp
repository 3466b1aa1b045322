// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Any bytes, read as each of VTK's formats.
#include <array>

#include "fuzz/read_input.hpp"
#include "io/pieces/join/join.hpp"
#include "io/vtk_legacy/read_legacy_vtk.hpp"
#include "io/vtk_xml/load.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace isotet;
    const io::ByteSource source(test::as_text(data, size));
    const auto head = test::as_text(data, size < 4096 ? size : 4096);
    const auto load = [&](io::Depth depth) {
        if (head.starts_with("# vtk")) return io::load_legacy(source, {}, depth, {});
        const std::string type(io::vtk_xml::type_of(head));
        return io::vtk_xml::load(source, type.empty() ? "UnstructuredGrid" : type, {}, depth, true, {});
    };
    auto loaded = load(io::Depth::arrays);
    const Result<ReadResult> result = loaded ? io::join(std::move(*loaded), {}) : Result<ReadResult>(loaded.error());
    if (!result) {
        if (result.error().message.empty() || result.error().code == ErrorCode::internal) std::abort();
        return 0;
    }
    // Arrays may still name points that are not there: isotet::read() checks that. They must be in memory that is ours.
    const auto cells = core::CellReader::open(result->grid);
    if (cells) (void)core::check_cells(result->grid, *cells, {});
    for (const auto* const fields : {&result->grid.point_fields, &result->grid.cell_fields})
        for (const Field& field : *fields) {
            volatile double sum = 0;
            for (std::size_t i = 0; i < field.values.tuples(); ++i) sum = sum + field.values.at(i);
        }
    const auto described = load(io::Depth::description);
    if (!described || described->info.fields.size() != result->info.fields.size()) std::abort();
    return 0;
}
