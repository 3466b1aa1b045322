// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Every truncation of a small file of each kind, and every byte of it changed: an error, or a grid that is consistent.
#include <algorithm>
#include <functional>

#include <gtest/gtest.h>

#include "io/gmsh/read_gmsh.hpp"
#include "io/gocad/read_gocad.hpp"
#include "io/grdecl/read_grdecl.hpp"
#include "io/medit/read_medit.hpp"
#include "io/tetgen/read_tetgen.hpp"
#include "readers/gmsh_sample.hpp"
#include "readers/gocad_sample.hpp"
#include "readers/grdecl_sample.hpp"
#include "readers/medit_sample.hpp"
#include "readers/sample_bytes.hpp"

namespace isotet::test {
namespace {

const std::string tetgen_nodes = "4 3 1 1\n1 0 0 0 1.5 0\n2 1 0 0 2.5 1\n3 0 1 0 3.5 1\n4 0 0 1 4.5 1\n";
const std::string tetgen_tets = "2 4 1\n1 1 2 3 4 0.5\n2 4 3 2 1 0.25\n";

/// A file that breaks, and how to read it.
struct Sample {
    std::string name;
    std::string bytes;
    std::function<Result<ReadResult>(std::string_view)> parse;
};

std::vector<Sample> samples() {
    std::vector<Sample> all;
    for (const GmshVariant& variant : gmsh_variants()) {
        all.push_back({"gmsh_" + name_of(variant), gmsh_sample(variant),
                       [](std::string_view bytes) { return io::parse_gmsh(bytes, {}, {}); }});
    }
    for (const MeditVariant& variant : medit_variants()) {
        all.push_back({"medit_" + name_of(variant), medit_sample(variant),
                       [](std::string_view bytes) { return io::parse_medit(bytes, std::nullopt, {}, {}); }});
        all.push_back(
            {"medit_solution_" + name_of(variant), medit_solution_sample(variant),
             [mesh = medit_sample(variant)](std::string_view bytes) { return io::parse_medit(mesh, bytes, {}, {}); }});
    }
    all.push_back({"tetgen_node", tetgen_nodes,
                   [](std::string_view bytes) { return io::parse_tetgen(bytes, tetgen_tets, {}, {}); }});
    all.push_back({"tetgen_ele", tetgen_tets,
                   [](std::string_view bytes) { return io::parse_tetgen(tetgen_nodes, bytes, {}, {}); }});
    all.push_back({"gocad", gocad_sample, [](std::string_view bytes) { return io::parse_gocad(bytes, {}, {}); }});
    all.push_back({"grdecl", grdecl_sample(), [](std::string_view bytes) {
                       const auto nothing = [](std::string_view) { return Error{ErrorCode::file, "is not there"}; };
                       return io::parse_grdecl({"deck", nullptr, bytes}, nothing, {}, {});
                   }});
    return all;
}

void PrintTo(const Sample& sample, std::ostream* out) { *out << sample.name; }

bool same_bits(const Array& a, const Array& b) {
    return a.type() == b.type() && a.size() == b.size() && std::memcmp(a.data(), b.data(), a.bytes()) == 0;
}

/// Every field of `part` is one of `whole`, bit for bit.
bool is_part_of(const std::vector<Field>& part, const std::vector<Field>& whole) {
    return std::all_of(part.begin(), part.end(), [&](const Field& field) {
        const Field* same = find(whole, field.name);
        return same && same_bits(field.values, same->values);
    });
}

bool says_no_end(const ReadResult& result) {
    return std::ranges::any_of(result.notes,
                               [](const std::string& note) { return note.find("has no END") != std::string::npos; });
}

class BrokenFile : public testing::TestWithParam<Sample> {};

// A cut between two sections leaves a file that is whole, and so may lack fields; what is there must be right.
TEST_P(BrokenFile, CutShortAnywhereIsAnErrorOrTheSameGridOrNoted) {
    const Sample& sample = GetParam();
    const ReadResult whole = sample.parse(sample.bytes).value();
    for (std::size_t length = 0; length < sample.bytes.size(); ++length) {
        // A copy of just this length, so that a sanitizer sees every read beyond.
        const std::vector<char> cut(sample.bytes.begin(), sample.bytes.begin() + static_cast<std::ptrdiff_t>(length));
        const auto result = sample.parse({cut.data(), cut.size()});
        if (!result || result->notes.size() > whole.notes.size() || says_no_end(*result)) continue;
        const Grid &a = result->grid, &b = whole.grid;
        ASSERT_TRUE(same_bits(a.points, b.points)) << "cut to " << length << " bytes";
        ASSERT_TRUE(same_bits(a.cells.connectivity, b.cells.connectivity)) << "cut to " << length << " bytes";
        ASSERT_TRUE(is_part_of(a.point_fields, b.point_fields) || result->info.times != whole.info.times)
            << "cut to " << length << " bytes";
        ASSERT_TRUE(is_part_of(a.cell_fields, b.cell_fields)) << "cut to " << length << " bytes";
    }
}

TEST_P(BrokenFile, WithAnyByteChangedIsAnErrorOrAGridOfConsistentArrays) {
    const Sample& sample = GetParam();
    for (std::size_t at = 0; at < sample.bytes.size(); ++at) {
        for (const char value : {'\0', '\xff', '\x80', '-', '9', '1', ' ', '\n', '$', '.'}) {
            std::string changed = sample.bytes;
            changed[at] = value;
            const auto result = sample.parse(changed);
            if (!result) {
                ASSERT_FALSE(result.error().message.empty());
                ASSERT_NE(result.error().code, ErrorCode::internal) << result.error().message;
                continue;
            }
            // A changed coordinate may be infinite, and check() says so; what must never happen is a read outside.
            (void)check(result->grid);
            for (const Field& field : result->grid.point_fields)
                ASSERT_EQ(field.values.tuples(), result->grid.points.tuples());
            for (const Field& field : result->grid.cell_fields)
                ASSERT_EQ(field.values.tuples(), result->grid.cells.count());
        }
    }
}

INSTANTIATE_TEST_SUITE_P(OfEachKind, BrokenFile, testing::ValuesIn(samples()),
                         [](const auto& sample) { return sample.param.name; });

} // namespace
} // namespace isotet::test
