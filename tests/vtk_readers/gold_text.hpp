// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Files of EnSight Gold for tests.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace isotet::test {

enum class GoldForm { ascii, c, c_swapped, fortran };

/// A file of EnSight Gold that grows at its end.
class GoldText {
public:
    explicit GoldText(GoldForm form, bool geometry = false) : form_(form) {
        if (geometry && form == GoldForm::fortran) line("Fortran Binary");
        else if (geometry && form != GoldForm::ascii) line("C Binary");
    }
    GoldText& line(std::string text) {
        if (form_ == GoldForm::ascii) text_ += text + "\n";
        else {
            text.resize(80, ' ');
            record(text);
        }
        return *this;
    }
    /// `row`   so many stand in a line
    GoldText& integers(const std::vector<std::int32_t>& values, std::size_t row = 1) { return add(values, row); }
    /// One after another in binary files, else a line each.
    GoldText& rows(const std::vector<std::vector<std::int32_t>>& values) {
        std::vector<std::int32_t> all;
        for (const auto& row : values) {
            if (form_ == GoldForm::ascii) add(row, row.size());
            all.insert(all.end(), row.begin(), row.end());
        }
        return form_ == GoldForm::ascii ? *this : add(all, 1);
    }
    GoldText& floats(const std::vector<float>& values) { return add(values, 1); }
    const std::string& text() const { return text_; }

private:
    template <class T>
    GoldText& add(const std::vector<T>& values, std::size_t row) {
        std::string bytes;
        for (std::size_t i = 0; i < values.size(); ++i) {
            if (form_ == GoldForm::ascii) {
                text_ += fmt::format("{}{}", values[i], (i + 1) % row == 0 ? '\n' : ' ');
                continue;
            }
            const std::string raw(reinterpret_cast<const char*>(&values[i]), sizeof(T));
            bytes += form_ == GoldForm::c_swapped ? std::string(raw.rbegin(), raw.rend()) : raw;
        }
        if (form_ != GoldForm::ascii) record(bytes);
        return *this;
    }
    void record(const std::string& bytes) {
        const auto size = static_cast<std::uint32_t>(bytes.size());
        const std::string mark(reinterpret_cast<const char*>(&size), sizeof size);
        text_ += form_ == GoldForm::fortran ? mark + bytes + mark : bytes;
    }

    GoldForm form_;
    std::string text_;
};

} // namespace isotet::test
