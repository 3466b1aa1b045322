// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <functional>

#include "io/foam/field_file.hpp"

namespace isotet::io::foam {

namespace {

/// Backtracking with a limit on steps: std::regex recurses as deep as a file likes.
class PatchPattern {
public:
    PatchPattern(std::string_view pattern, std::string_view name) : pattern_(pattern), name_(name) {}

    bool fits() {
        return sequence(0, pattern_.size(), 0, [&](std::size_t at) { return at == name_.size(); });
    }

private:
    using Rest = std::function<bool(std::size_t)>;
    static constexpr std::size_t none = std::string_view::npos;

    /// Pieces of [begin, end) between '|' outside of parentheses, one of which must fit.
    bool sequence(std::size_t begin, std::size_t end, std::size_t at, const Rest& rest) {
        if (++steps_ > 20000 || ++depth_ > 500) return false;
        std::size_t depth = 0, first = begin;
        bool found = false;
        for (std::size_t i = begin; i <= end && !found; ++i) {
            const char c = i < end ? pattern_[i] : '|';
            if (c == '(') ++depth;
            if (c == ')' && depth > 0) --depth;
            if (i == end || (c == '|' && depth == 0)) {
                found = items(first, i, at, rest);
                first = i + 1;
            }
        }
        --depth_;
        return found;
    }

    bool items(std::size_t begin, std::size_t end, std::size_t at, const Rest& rest) {
        if (++steps_ > 20000 || depth_ > 500) return false;
        if (begin >= end) return rest(at);
        const std::size_t atom = atom_end(begin, end);
        if (atom == none) return false;
        const char repeat = atom < end ? pattern_[atom] : '\0';
        const bool repeats = repeat == '*' || repeat == '+' || repeat == '?';
        const Rest next = [&, after = atom + repeats](std::size_t here) { return items(after, end, here, rest); };
        if (!repeats) return one(begin, atom, at, next);
        if (repeat != '+' && next(at)) return true;
        return some(begin, atom, at, repeat == '?', next);
    }

    bool some(std::size_t begin, std::size_t end, std::size_t at, bool once, const Rest& next) {
        if (++steps_ > 20000 || ++depth_ > 500) return false;
        const bool found = one(begin, end, at, [&](std::size_t here) {
            return next(here) || (!once && here > at && some(begin, end, here, false, next));
        });
        --depth_;
        return found;
    }

    std::size_t atom_end(std::size_t begin, std::size_t end) const {
        if (pattern_[begin] == '\\') return begin + 1 < end ? begin + 2 : none;
        if (pattern_[begin] == '[') {
            const std::size_t close = pattern_.find(']', begin + 1);
            return close < end ? close + 1 : none;
        }
        if (pattern_[begin] != '(') return begin + 1;
        std::size_t depth = 0;
        for (std::size_t i = begin; i < end; ++i) {
            if (pattern_[i] == '(') ++depth;
            if (pattern_[i] == ')' && --depth == 0) return i + 1;
        }
        return none;
    }

    bool one(std::size_t begin, std::size_t end, std::size_t at, const Rest& next) {
        if (pattern_[begin] == '(') return sequence(begin + 1, end - 1, at, next);
        if (at == name_.size()) return false;
        const char c = name_[at];
        bool same = pattern_[begin] == '.' || pattern_[begin] == c;
        if (pattern_[begin] == '\\') same = pattern_[begin + 1] == c;
        if (pattern_[begin] == '[') same = in_class(pattern_.substr(begin + 1, end - begin - 2), c);
        return same && next(at + 1);
    }

    static bool in_class(std::string_view set, char c) {
        const bool inverted = set.starts_with('^');
        if (inverted) set.remove_prefix(1);
        bool found = false;
        for (std::size_t i = 0; i < set.size(); ++i) {
            if (i + 2 < set.size() && set[i + 1] == '-') {
                found = found || (set[i] <= c && c <= set[i + 2]);
                i += 2;
            } else found = found || set[i] == c;
        }
        return found != inverted;
    }

    std::string_view pattern_, name_;
    std::size_t steps_ = 0, depth_ = 0;
};

} // namespace

bool fits_pattern(std::string_view pattern, std::string_view name) { return PatchPattern(pattern, name).fits(); }

} // namespace isotet::io::foam
