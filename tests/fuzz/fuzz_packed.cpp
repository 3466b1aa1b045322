// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A packed file with bytes changed anywhere under right checksums: an error with a sentence, or surfaces of vertices that are
// there.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include <sys/mman.h>
#include <unistd.h>

#include <isotet/extract.hpp>
#include <isotet/make.hpp>
#include <isotet/boundary.hpp>
#include <isotet/packed_file.hpp>
#include <isotet/slice.hpp>

#include "packed/right_checksums.hpp"

namespace {

using namespace isotet;

/// A file in memory.
class MemoryFile {
public:
    MemoryFile() : number_(::memfd_create("packed", 0)) {}
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;
    ~MemoryFile() { ::close(number_); }

    std::string path() const { return "/proc/self/fd/" + std::to_string(number_); }
    void write(const std::string& content) const {
        if (::pwrite(number_, content.data(), content.size(), 0) != static_cast<ssize_t>(content.size())) std::abort();
    }

private:
    int number_;
};

/// Small chunks of all kinds of cells, with everything that is kept on request.
std::string sample_file() {
    MakeOptions make;
    make.shape = "mixed";
    make.side = 3;
    make.fields = {"integer"};
    const Grid grid = make_grid(make).value();
    PackOptions options;
    options.source_cells = options.gradients = true;
    const PackedGrid packed =
        pack(grid, {"integer", grid.point_fields[0].values, false, {}}, options).value();
    const std::string path = "/tmp/isotet-fuzz-" + std::to_string(::getpid()) + ".isotet";
    SavePackedOptions saving;
    saving.chunk_bytes = 500;
    std::vector<float> far(grid.points.as<float>().begin(), grid.points.as<float>().end());
    for (float& x : far) x *= 1.25F;
    PackedWriter writer = PackedWriter::create(packed, path, saving).value();
    writer.add_step(packed.with_points(Array::own(std::move(far), 3)).value(), 1.0).value();
    writer.commit().value();
    std::string content;
    FILE* const file = std::fopen(path.c_str(), "rb");
    for (int byte; (byte = std::fgetc(file)) != EOF;) content += static_cast<char>(byte);
    std::fclose(file);
    ::unlink(path.c_str());
    return content;
}

void expect_sentence(const Error& error) {
    if (error.message.empty() || error.code == ErrorCode::internal) std::abort();
}

void extract_from(const Result<PackedGrid>& grid, bool gradients) {
    if (!grid) return expect_sentence(grid.error());
    const auto boundary = boundary_of(*grid, {*grid});
    if (!boundary) return expect_sentence(boundary.error());
    for (const std::uint32_t vertex : boundary->triangles.as<std::uint32_t>())
        if (vertex >= boundary->vertex_count()) std::abort();
    ExtractOptions options;
    if (gradients) options.normals = Normals::gradient;
    options.edge_ends = options.source_cells = true;
    for (const double isovalue : {0.0, 1.5}) {
        const auto out = extract(*grid, isovalue, options, {.threads = 1});
        if (!out) return expect_sentence(out.error());
        for (const std::uint32_t vertex : out->surface.triangles.as<std::uint32_t>())
            if (vertex >= out->surface.vertex_count()) std::abort();
    }
}

void extract_from(const std::string& path) {
    const auto file = PackedFile::open(path);
    if (!file) return expect_sentence(file.error());
    if (const auto checked = file->check(); !checked) expect_sentence(checked.error());
    for (std::size_t step = 0; step < 2; ++step) extract_from(file->grid("", step), true);
    extract_from(file->interpolated("", 0, 0.5), false);
    extract_from(file->sliced(Plane{{1, 2, 3}, 0}, 1), false);
}

} // namespace

/// Three bytes a change: where (16 bits), and what.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const std::string sample = sample_file();
    static const std::uint64_t directory =
        io::decode_packed_header(std::as_bytes(std::span(sample)), sample.size()).value().offset;
    if (size < 1) return 0;
    const bool in_directory = data[0] % 4 == 0;
    const std::uint64_t first = in_directory ? directory : io::packed_header_bytes;
    const std::uint64_t length = (in_directory ? sample.size() : directory) - first;
    std::string changed = sample;
    for (std::size_t i = 1; i + 2 < size; i += 3)
        changed[first + (data[i] + 256u * data[i + 1]) % length] = static_cast<char>(data[i + 2]);
    const MemoryFile file;
    file.write(in_directory ? test::with_right_directory_checksum(changed) : test::with_right_checksums(changed));
    extract_from(file.path());
    return 0;
}
