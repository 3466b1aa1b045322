// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "readers/medit_sample.hpp"

#include <fmt/format.h>

#include "readers/sample_bytes.hpp"

namespace isotet::test {

namespace {

/// Sections of text or binary files; of binary ones the position of the next is filled in when it comes.
class MeditWriter {
public:
    explicit MeditWriter(const MeditVariant& variant) : variant_(variant), bytes_(variant.swapped) {
        if (text()) bytes_.text("# a comment\nMeshVersionFormatted 2\n");
        else bytes_.number(std::int32_t{1}).number(std::int32_t{variant.version});
    }

    MeditWriter& section(const char* name, std::int32_t keyword) {
        if (text()) {
            bytes_.text(fmt::format("\n{}\n", name));
            return *this;
        }
        close();
        bytes_.number(keyword);
        next_ = bytes_.str().size();
        variant_.version >= 3 ? bytes_.number(std::int64_t{0}) : bytes_.number(std::int32_t{0});
        return *this;
    }
    MeditWriter& integer(int value) {
        if (text()) return word(fmt::format("{}", value));
        variant_.version == 4 ? bytes_.number(std::int64_t{value}) : bytes_.number(std::int32_t{value});
        return *this;
    }
    MeditWriter& small(int value) {
        if (text()) return word(fmt::format("{}", value));
        bytes_.number(std::int32_t{value});
        return *this;
    }
    MeditWriter& real(double value) {
        if (text()) return word(fmt::format("{}", value));
        variant_.version == 1 ? bytes_.number(static_cast<float>(value)) : bytes_.number(value);
        return *this;
    }
    std::string finish() {
        if (text()) return bytes_.text("\nEnd\n").str();
        close();
        bytes_.number(std::int32_t{54});
        variant_.version >= 3 ? bytes_.number(std::int64_t{0}) : bytes_.number(std::int32_t{0});
        return bytes_.str();
    }

private:
    bool text() const { return variant_.version == 0; }
    MeditWriter& word(const std::string& word) {
        bytes_.text(word + " ");
        return *this;
    }
    void close() {
        if (next_ == 0) return;
        const std::size_t here = bytes_.str().size();
        if (variant_.version >= 3) bytes_.replace(next_, static_cast<std::int64_t>(here));
        else bytes_.replace(next_, static_cast<std::int32_t>(here));
    }

    MeditVariant variant_;
    SampleBytes bytes_;
    std::size_t next_ = 0;
};

} // namespace

std::string name_of(const MeditVariant& variant) {
    if (variant.version == 0) return "text";
    return fmt::format("binary_{}{}", variant.version, variant.swapped ? "_swapped" : "");
}

std::vector<MeditVariant> medit_variants() {
    std::vector<MeditVariant> variants{{0, false}};
    for (const int version : {1, 2, 3, 4}) {
        for (const bool swapped : {false, true}) variants.push_back({version, swapped});
    }
    return variants;
}

std::string medit_sample(const MeditVariant& variant) {
    MeditWriter out(variant);
    out.section("Dimension", 3).small(3);
    out.section("Vertices", 4).integer(9);
    for (int i = 0; i < 9; ++i) {
        for (int axis = 0; axis < 3; ++axis) out.real(cube_points[static_cast<std::size_t>(3 * i + axis)]);
        out.integer(10 + i);
    }
    out.section("Corners", 13).integer(2).integer(1).integer(2);
    struct Kind {
        const char* name;
        std::int32_t keyword;
    };
    constexpr Kind kinds[] = {{"Triangles", 6}, {"Tetrahedra", 8}, {"Hexahedra", 10}, {"Prisms", 9}, {"Pyramids", 49}};
    for (std::size_t c = 0; c < 5; ++c) {
        out.section(kinds[c].name, kinds[c].keyword).integer(1);
        for (const int corner : cube_cells[c]) out.integer(corner + 1);
        out.integer(static_cast<int>(c) + 1);
    }
    return out.finish();
}

std::string medit_solution_sample(const MeditVariant& variant) {
    MeditWriter out(variant);
    out.section("Dimension", 3).small(3);
    out.section("SolAtVertices", 62).integer(9).small(3).small(1).small(2).small(3);
    for (int n = 0; n < 9; ++n) {
        out.real(n).real(n).real(n + 0.25).real(n + 0.5);
        for (int c = 0; c < 6; ++c) out.real(n + c);
    }
    return out.finish();
}

std::string medit_cell_solution_sample(const MeditVariant& variant) {
    MeditWriter out(variant);
    out.section("Dimension", 3).small(3);
    out.section("SolAtTriangles", 64).integer(1).small(1).small(1).real(9);
    out.section("SolAtVertices", 62).integer(9).small(1).small(1);
    for (int n = 0; n < 9; ++n) out.real(7);
    struct Kind {
        const char* name;
        std::int32_t keyword;
        int cell;
    };
    constexpr Kind kinds[] = {
        {"SolAtPyramids", 26, 4}, {"SolAtTetrahedra", 66, 1}, {"SolAtPrisms", 67, 3}, {"SolAtHexahedra", 68, 2}};
    for (const Kind& kind : kinds) {
        out.section(kind.name, kind.keyword).integer(1).small(2).small(1).small(2);
        out.real(kind.cell).real(kind.cell).real(kind.cell + 0.25).real(kind.cell + 0.5);
    }
    return out.finish();
}

} // namespace isotet::test
