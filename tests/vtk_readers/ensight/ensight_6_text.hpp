// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Files of EnSight 6 for tests.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "vtk_readers/gold_text.hpp"

namespace isotet::test {

/// A file of EnSight 6 that grows at its end.
class Ensight6Text {
public:
    explicit Ensight6Text(GoldForm form, bool geometry = false) : form_(form) {
        if (geometry && form == GoldForm::fortran) line("Fortran Binary");
        else if (geometry && form != GoldForm::ascii) line("C Binary");
    }
    Ensight6Text& line(std::string text) {
        if (form_ == GoldForm::ascii) text_ += text + "\n";
        else record(text + std::string(80 - text.size(), '\0'));
        return *this;
    }
    Ensight6Text& integers(const std::vector<std::vector<std::int32_t>>& rows) {
        std::string bytes;
        for (const auto& row : rows) {
            for (const std::int32_t value : row)
                bytes += form_ == GoldForm::ascii ? fmt::format("{:8}", value) : raw(value);
            if (form_ == GoldForm::ascii) bytes += '\n';
        }
        record(bytes);
        return *this;
    }
    Ensight6Text& integer(std::int32_t value) { return integers({{value}}); }
    Ensight6Text& floats(const std::vector<float>& values) {
        std::string bytes;
        for (std::size_t i = 0; i < values.size(); ++i) {
            bytes += form_ == GoldForm::ascii ? fmt::format("{:12.5e}", values[i]) : raw(values[i]);
            if (form_ == GoldForm::ascii && ((i + 1) % 6 == 0 || i + 1 == values.size())) bytes += '\n';
        }
        record(bytes);
        return *this;
    }
    /// Nodes with numbers where there are any: in front of each in text, before all in binary files.
    Ensight6Text& nodes(const std::vector<std::int32_t>& numbers, const std::vector<float>& xyz) {
        if (form_ != GoldForm::ascii && !numbers.empty()) integers({numbers});
        if (form_ != GoldForm::ascii) return floats(xyz);
        for (std::size_t i = 0; i < xyz.size() / 3; ++i) {
            if (!numbers.empty()) text_ += fmt::format("{:8}", numbers[i]);
            text_ += fmt::format("{:12.5e}{:12.5e}{:12.5e}\n", xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]);
        }
        return *this;
    }
    const std::string& text() const { return text_; }

private:
    template <class T>
    std::string raw(T value) const {
        const std::string bytes(reinterpret_cast<const char*>(&value), sizeof(T));
        return form_ == GoldForm::c_swapped ? std::string(bytes.rbegin(), bytes.rend()) : bytes;
    }
    void record(const std::string& bytes) {
        const std::string mark = raw(static_cast<std::uint32_t>(bytes.size()));
        text_ += form_ == GoldForm::fortran ? mark + bytes + mark : bytes;
    }

    GoldForm form_;
    std::string text_;
};

/// A box of 2 x 2 x 2 cubes: four as part 1; three, one as two wedges, as part 2. Each step is moved by 10 in x.
struct Ensight6Box {
    GoldForm form = GoldForm::ascii;
    bool node_ids = false, element_ids = false;
    std::int32_t parts[2] = {1, 2};

    std::int32_t node(int i, int j, int k) const { return 1 + i + 3 * j + 9 * k + (node_ids ? 100 : 0); }

    Ensight6Text& put_geometry(Ensight6Text& file, int step = 0) const {
        file.line("a box").line("of two parts").line(node_ids ? "node id given" : "node id assign");
        file.line(element_ids ? "element id given" : "element id off").line("coordinates").integer(27);
        std::vector<std::int32_t> numbers;
        std::vector<float> xyz;
        for (int i = 0; i < 27; ++i) {
            if (node_ids) numbers.push_back(101 + i);
            for (const int x : {i % 3 + 10 * step, i / 3 % 3, i / 9}) xyz.push_back(static_cast<float>(x));
        }
        file.nodes(numbers, xyz);
        std::int32_t element = 50;
        const auto put = [&](const std::vector<std::vector<std::int32_t>>& rows) {
            file.integer(static_cast<std::int32_t>(rows.size()));
            std::vector<std::int32_t> ids;
            auto with_ids = rows;
            for (auto& row : with_ids) {
                ids.push_back(element++);
                if (element_ids && form == GoldForm::ascii) row.insert(row.begin(), ids.back());
            }
            if (element_ids && form != GoldForm::ascii) file.integers({ids});
            file.integers(with_ids);
        };
        const auto cube = [&](int i, int j, int k) {
            std::vector<std::int32_t> corners;
            for (const int z : {k, k + 1})
                corners.insert(corners.end(),
                               {node(i, j, z), node(i + 1, j, z), node(i + 1, j + 1, z), node(i, j + 1, z)});
            return corners;
        };
        file.line(fmt::format("part {}", parts[0])).line("low");
        file.line("hexa8");
        put({cube(0, 0, 0), cube(1, 0, 0), cube(0, 1, 0), cube(1, 1, 0)});
        file.line(fmt::format("part {}", parts[1])).line("high");
        file.line("hexa8");
        put({cube(0, 0, 1), cube(1, 0, 1), cube(0, 1, 1)});
        const auto last = cube(1, 1, 1);
        file.line("penta6");
        put({{last[0], last[1], last[2], last[4], last[5], last[6]},
             {last[0], last[2], last[3], last[4], last[6], last[7]}});
        return file;
    }
    /// 1, 2, 3 ... , and 1000 more in each step.
    static std::vector<float> values(std::size_t count, int step, std::size_t first = 0) {
        std::vector<float> all;
        for (std::size_t i = 0; i < count; ++i)
            all.push_back(static_cast<float>(first + i + 1) + 1000.0F * static_cast<float>(step));
        return all;
    }
    static Ensight6Text& put_nodes(Ensight6Text& file, std::size_t components, int step = 0) {
        return file.line("of nodes").floats(values(27 * components, step));
    }
    Ensight6Text& put_elements(Ensight6Text& file, std::size_t components, int step = 0) const {
        file.line("of elements").line(fmt::format("part {}", parts[0])).line("hexa8");
        file.floats(values(4 * components, step)).line(fmt::format("part {}", parts[1])).line("hexa8");
        file.floats(values(3 * components, step, 4 * components)).line("penta6");
        return file.floats(values(2 * components, step, 7 * components));
    }
};

} // namespace isotet::test
