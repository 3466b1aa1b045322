// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "readers/gmsh_sample.hpp"

#include <fmt/format.h>

#include "readers/sample_bytes.hpp"

namespace isotet::test {

namespace {

constexpr int gmsh_types[] = {2, 4, 5, 6, 7};

/// Writes integers, numbers (of nodes and elements) and reals as the variant asks for.
class GmshWriter {
public:
    explicit GmshWriter(const GmshVariant& variant) : variant_(variant), bytes_(variant.swapped) {}

    GmshWriter& text(std::string_view text) {
        bytes_.text(text);
        return *this;
    }
    GmshWriter& integer(int value) { return write(value, std::int32_t{value}); }
    GmshWriter& number(int value) {
        return variant_.version_4 ? write(value, std::int64_t{value}) : write(value, std::int32_t{value});
    }
    GmshWriter& real(double value) { return write(value, value); }
    /// Ends a line of an ascii file.
    GmshWriter& line() { return variant_.binary ? *this : text("\n"); }
    /// A count that is text in binary files, too.
    GmshWriter& count_line(int count) { return text(fmt::format("{}\n", count)); }

    std::string str() const { return bytes_.str(); }

private:
    template <class Value, class Raw>
    GmshWriter& write(Value value, Raw raw) {
        if (variant_.binary) bytes_.number(raw);
        else bytes_.text(fmt::format("{} ", value));
        return *this;
    }

    GmshVariant variant_;
    SampleBytes bytes_;
};

int node_number(const GmshVariant& variant, int index) {
    return variant.sparse ? 900 - 100 * (index / 2) + 7 * (index % 2) : index + 1;
}

void write_nodes_2(GmshWriter& out, const GmshVariant& variant) {
    const char* name = variant.parametric ? "ParametricNodes" : "Nodes";
    out.text(fmt::format("${}\n", name)).count_line(9);
    for (int i = 0; i < 9; ++i) {
        out.number(node_number(variant, i));
        for (int axis = 0; axis < 3; ++axis) out.real(cube_points[static_cast<std::size_t>(3 * i + axis)]);
        if (variant.parametric) {
            const int dimension = i % 4;
            out.integer(dimension).integer(1);
            for (int p = 0; p < (dimension < 3 ? dimension : 0); ++p) out.real(0.5);
        }
        out.line();
    }
    out.text(fmt::format("{}$End{}\n", variant.binary ? "\n" : "", name));
}

void write_elements_2(GmshWriter& out, const GmshVariant& variant) {
    out.text("$Elements\n").count_line(5);
    for (int e = 0; e < 5; ++e) {
        const int type = gmsh_types[e];
        if (variant.binary) out.integer(type).integer(1).integer(2).number(e + 1);
        else out.number(e + 1).integer(type).integer(2);
        out.integer(e == 0 ? 7 : 8).integer(e == 0 ? 3 : 4);
        for (const int corner : cube_cells[static_cast<std::size_t>(e)]) out.number(node_number(variant, corner));
        out.line();
    }
    out.text(variant.binary ? "\n$EndElements\n" : "$EndElements\n");
}

void write_entities_4(GmshWriter& out, const GmshVariant& variant) {
    out.text("$Entities\n");
    out.number(1).number(1).number(1).number(1).line();
    out.integer(1).real(0).real(0).real(0).number(0).line();
    const auto box = [&](int number) {
        out.integer(number);
        for (int i = 0; i < 6; ++i) out.real(i / 3);
    };
    box(2);
    out.number(0).number(2).integer(1).integer(-1).line();
    box(3);
    out.number(2).integer(7).integer(70).number(1).integer(2).line();
    box(4);
    out.number(1).integer(8).number(1).integer(-3).line();
    out.text(variant.binary ? "\n$EndEntities\n" : "$EndEntities\n");
}

void write_nodes_4(GmshWriter& out, const GmshVariant& variant) {
    out.text("$Nodes\n");
    out.number(2).number(9).number(1).number(907).line();
    for (int block = 0; block < 2; ++block) {
        const int first = block == 0 ? 0 : 4, last = block == 0 ? 4 : 9, dimension = block + 2;
        out.integer(dimension).integer(dimension + 1).integer(variant.parametric ? 1 : 0).number(last - first).line();
        for (int i = first; i < last; ++i) out.number(node_number(variant, i)).line();
        for (int i = first; i < last; ++i) {
            for (int axis = 0; axis < 3; ++axis) out.real(cube_points[static_cast<std::size_t>(3 * i + axis)]);
            for (int p = 0; variant.parametric && p < dimension; ++p) out.real(0.5);
            out.line();
        }
    }
    out.text(variant.binary ? "\n$EndNodes\n" : "$EndNodes\n");
}

void write_elements_4(GmshWriter& out, const GmshVariant& variant) {
    out.text("$Elements\n");
    out.number(5).number(5).number(1).number(5).line();
    for (int e = 0; e < 5; ++e) {
        out.integer(e == 0 ? 2 : 3).integer(e == 0 ? 3 : 4).integer(gmsh_types[e]).number(1).line();
        out.number(e + 1);
        for (const int corner : cube_cells[static_cast<std::size_t>(e)]) out.number(node_number(variant, corner));
        out.line();
    }
    out.text(variant.binary ? "\n$EndElements\n" : "$EndElements\n");
}

void open_data(GmshWriter& out, const char* section, const char* name, double time, int step, int components,
               int count) {
    out.text(fmt::format("${}\n1\n\"{}\"\n1\n{}\n3\n{}\n{}\n{}\n", section, name, time, step, components, count));
}

void write_data(GmshWriter& out, const GmshVariant& variant) {
    const auto close = [&](const char* section) {
        out.text(fmt::format("{}$End{}\n", variant.binary ? "\n" : "", section));
    };
    for (int step = 0; step < 2; ++step) {
        open_data(out, "NodeData", "temperature", 1.5 * step, step, 1, 9);
        for (int i = 0; i < 9; ++i) out.integer(node_number(variant, i)).real(10.0 * (step + 1) * (i + 1)).line();
        close("NodeData");
    }
    open_data(out, "NodeData", "flow", 0, 0, 3, 2);
    for (int i = 0; i < 2; ++i) out.integer(node_number(variant, i)).real(i).real(i + 0.5).real(-i).line();
    close("NodeData");
    open_data(out, "ElementData", "porosity", 0, 0, 1, 4);
    for (int e = 5; e > 1; --e) out.integer(e).real(e / 10.0).line();
    close("ElementData");
}

} // namespace

std::string name_of(const GmshVariant& variant) {
    return fmt::format("{}_{}{}{}{}", variant.version_4 ? "v41" : "v22", variant.binary ? "binary" : "ascii",
                       variant.swapped ? "_swapped" : "", variant.sparse ? "_sparse" : "",
                       variant.parametric ? "_parametric" : "");
}

std::vector<GmshVariant> gmsh_variants() {
    std::vector<GmshVariant> variants;
    for (const bool version_4 : {false, true}) {
        for (const auto& [binary, swapped] : {std::pair(false, false), std::pair(true, false), std::pair(true, true)}) {
            for (const bool sparse : {false, true}) {
                for (const bool parametric : {false, true}) {
                    variants.push_back({version_4, binary, swapped, sparse, parametric});
                }
            }
        }
    }
    return variants;
}

std::string gmsh_sample(const GmshVariant& variant) {
    GmshWriter out(variant);
    out.text(fmt::format("$MeshFormat\n{} {} 8\n", variant.version_4 ? "4.1" : "2.2", variant.binary ? 1 : 0));
    if (variant.binary) out.integer(1).text("\n");
    out.text("$EndMeshFormat\n$PhysicalNames\n1\n3 8 \"a $ in a name\"\n$EndPhysicalNames\n");
    if (variant.version_4) write_entities_4(out, variant);
    variant.version_4 ? write_nodes_4(out, variant) : write_nodes_2(out, variant);
    variant.version_4 ? write_elements_4(out, variant) : write_elements_2(out, variant);
    out.text("$Periodic\n0\n$EndPeriodic\n");
    write_data(out, variant);
    return out.str();
}

} // namespace isotet::test
