// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Packed files that are cut short, changed, or have wrong numbers under right checksums: an error or the same answer, and
// no read out of bounds.
#include <cstring>
#include <filesystem>
#include <random>

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <isotet/boundary.hpp>
#include <isotet/check.hpp>
#include <isotet/packed_file.hpp>

#include "io/files/crc32c.hpp"
#include "io/packed/directory.hpp"
#include "packed/packed_samples.hpp"
#include "packed/right_checksums.hpp"

namespace isotet::test {
namespace {

/// Nothing, or the error of the first call that meets what is broken.
std::optional<Error> error_of(const Result<PackedGrid>& grid, const std::vector<double>& isovalues, bool gradients,
                              std::vector<std::string>* surfaces) {
    if (!grid) return grid.error();
    const auto boundary = boundary_of(*grid, {*grid});
    if (!boundary) return boundary.error();
    for (const std::uint32_t vertex : boundary->triangles.as<std::uint32_t>())
        EXPECT_LT(vertex, boundary->vertex_count());
    if (surfaces) surfaces->push_back(bytes_of(*boundary));
    ExtractOptions options = with_all(Ties::merge);
    if (!gradients) options.normals = Normals::none;
    for (const double isovalue : isovalues) {
        const auto out = extract(*grid, isovalue, options, {.threads = 1});
        if (!out) return out.error();
        const Array& triangles = out->surface.triangles;
        for (std::size_t i = 0; i < triangles.size(); ++i)
            EXPECT_LT(triangles.as<std::uint32_t>()[i], out->surface.vertex_count());
        if (surfaces) surfaces->push_back(bytes_of(out->surface));
    }
    return std::nullopt;
}

/// The same of all steps of a file, of what is between them, and of a slice.
std::optional<Error> error_of(const std::string& path, const std::vector<double>& isovalues,
                              std::vector<std::string>* surfaces = nullptr) {
    const auto file = PackedFile::open(path);
    if (!file) return file.error();
    for (std::size_t step = 0; step < file->info().steps; ++step)
        if (const auto error = error_of(file->grid("", step), isovalues, true, surfaces)) return error;
    if (file->info().steps < 2) return std::nullopt;
    if (const auto error = error_of(file->interpolated("", 0, 0.5), isovalues, false, surfaces)) return error;
    return error_of(file->sliced(Sphere{{0.1, 0, 0}, 0.7}, 1), {0.7}, false, surfaces);
}

PackedSample small_sample() {
    MixedOptions mixed;
    mixed.side = 3;
    mixed.no_data = 0.02;
    const NastyGrid nasty = mixed_grid(5, mixed);
    return {"small", pack(nasty.grid, nasty.field, packing_of_all(Precision::float32)).value(), {1, 2.5}};
}

/// A file of one step, and one of two with points that move.
std::vector<std::string> small_files(const PackedSample& sample, const TemporaryFolder& folder) {
    std::vector<std::string> files{content_of(saved(sample.packed, folder, 500))};
    const Array before = unpack(sample.packed).value().points;
    std::vector<double> points;
    for (std::size_t i = 0; i < before.size(); ++i) points.push_back(1.125 * before.at(i / 3, i % 3));
    Array moved = Array::own(points, 3);
    if (before.type() == ScalarType::float32) moved = Array::own(std::vector<float>(points.begin(), points.end()), 3);
    SavePackedOptions options;
    options.chunk_bytes = 500;
    PackedWriter writer = PackedWriter::create(sample.packed, folder.file("steps.isotet"), options).value();
    writer.add_step(sample.packed.with_points(moved).value(), std::nullopt).value();
    writer.commit().value();
    files.push_back(content_of(folder.file("steps.isotet")));
    return files;
}

TEST(BrokenPackedFile, CutShortAnywhereIsAnError) {
    const PackedSample sample = small_sample();
    const TemporaryFolder folder;
    for (const std::string& whole : small_files(sample, folder)) {
        for (std::size_t size = 0; size < whole.size(); size += size < 4'000 ? 97 : 5) {
            const std::string path = folder.write("cut.isotet", whole.substr(0, size));
            const auto file = PackedFile::open(path);
            ASSERT_FALSE(file) << size;
            EXPECT_TRUE(file.error().code == ErrorCode::invalid_data || file.error().code == ErrorCode::file);
        }
        const std::string more = folder.write("more.isotet", whole + "of a writer that did not finish");
        EXPECT_FALSE(error_of(more, sample.isovalues)) << "what is behind the end does not count";
    }
}

TEST(BrokenPackedFile, WithAnyByteChangedIsAnErrorOrTheSame) {
    const PackedSample sample = small_sample();
    const TemporaryFolder folder;
    for (const std::string& whole : small_files(sample, folder)) {
        std::vector<std::string> expected;
        ASSERT_FALSE(error_of(folder.write("whole.isotet", whole), sample.isovalues, &expected));
        std::size_t errors = 0;
        for (std::size_t at = 0; at < whole.size(); at += at < 24 || (at >= 500 && at < 560) ? 1 : 7) {
            std::string changed = whole;
            changed[at] = static_cast<char>(changed[at] ^ (1 << at % 8));
            const std::string path = folder.write("changed.isotet", changed);
            std::vector<std::string> surfaces;
            const auto error = error_of(path, sample.isovalues, &surfaces);
            errors += error.has_value();
            if (error) EXPECT_EQ(error->code, ErrorCode::invalid_data) << at << " " << error->message;
            else EXPECT_TRUE(surfaces == expected) << at;
        }
        EXPECT_GT(errors, (whole.size() - 4'096) / 7 * 3 / 4);
    }
}

TEST(BrokenPackedFile, WithWrongNumbersUnderRightChecksumsReadsNothingOutOfBounds) {
    const PackedSample sample = small_sample();
    const TemporaryFolder folder;
    for (const std::string& whole : small_files(sample, folder)) {
        ASSERT_TRUE(with_right_checksums(whole) == whole);
        const auto source = io::decode_packed_header(std::as_bytes(std::span(whole)), whole.size()).value();
        std::mt19937 random(7);
        std::size_t errors = 0, tries = 0;
        for (std::size_t at = io::packed_header_bytes; at < source.offset; at += 1 + random() % 9, ++tries) {
            std::string changed = whole;
            changed[at] = static_cast<char>(random() % 4 ? random() : 255);
            const std::string path = folder.write("wrong.isotet", with_right_checksums(changed));
            errors += error_of(path, sample.isovalues).has_value();
        }
        EXPECT_GT(errors, tries / 3);
    }
}

TEST(BrokenPackedFile, WithAWrongDirectoryUnderARightChecksumIsAnErrorOrReadable) {
    const PackedSample sample = small_sample();
    const TemporaryFolder folder;
    for (const std::string& whole : small_files(sample, folder)) {
        const auto slot = io::decode_packed_header(std::as_bytes(std::span(whole)), whole.size()).value();
        std::mt19937 random(9);
        for (std::size_t at = slot.offset; at < whole.size(); at += 1 + random() % 3) {
            std::string changed = whole;
            changed[at] = static_cast<char>(random() % 2 ? random() : 255);
            error_of(folder.write("wrong.isotet", with_right_directory_checksum(changed)), sample.isovalues);
        }
    }
}

TEST(BrokenPackedFile, SaysWhatIsWrong) {
    const PackedSample sample = small_sample();
    const TemporaryFolder folder;
    const std::string whole = content_of(saved(sample.packed, folder, 500));
    const auto message = [&](std::string content) {
        return PackedFile::open(folder.write("x", content)).error().message;
    };
    std::string newer = whole;
    newer[8] = 2;
    const std::uint32_t checksum = io::crc32c(std::as_bytes(std::span(newer)).first(20));
    std::memcpy(newer.data() + 20, &checksum, 4);
    EXPECT_EQ(message(newer), folder.file("x") + ": it has version 2.2 of the format, but this isotet reads 1.x");
    EXPECT_EQ(message("solid"), folder.file("x") + ": a packed file has at least 4096 bytes, but this one has 5");
    EXPECT_EQ(message(std::string(5'000, 'x')), folder.file("x") + ": it does not begin as packed files do");
    EXPECT_EQ(message(whole.substr(0, 5'000)),
              fmt::format("{}: it was cut short: 5000 bytes are there, but it had {}", folder.file("x"), whole.size()));
    std::string changed = whole;
    changed[4'100] ^= 1;
    const auto file = PackedFile::open(folder.write("x", changed)).value();
    EXPECT_EQ(file.check().error().message, folder.file("x") + ": chunk 0 is broken: its checksum differs");
}

TEST(BrokenPackedFile, CutShortWhileItIsOpenIsAnErrorOfThatCall) {
    const PackedSample sample = small_sample();
    const TemporaryFolder folder;
    const std::string path = saved(sample.packed, folder, 500), whole = content_of(path);
    const PackedGrid grid = PackedFile::open(path).value().grid().value();
    std::filesystem::resize_file(path, 5'000);
    const auto failed = extract(grid, 1);
    ASSERT_FALSE(failed);
    EXPECT_EQ(failed.error().code, ErrorCode::file);
    std::ofstream(path, std::ios::binary) << whole;
    EXPECT_TRUE(extract(grid, 1)) << "the grid is usable again";
}

} // namespace
} // namespace isotet::test
