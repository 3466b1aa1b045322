// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/foam/scanner.hpp"

#include <algorithm>
#include <atomic>
#include <charconv>
#include <cstring>
#include <limits>
#include <optional>

#include <fmt/core.h>

#include "base/parallel.hpp"
#include "io/pieces/loaded.hpp"

namespace isotet::io::foam {

namespace {

bool stands_alone(char c) { return std::string_view("(){}[];").find(c) != std::string_view::npos; }

/// "LSB;label=32;scalar=64"
void apply_arch(std::string_view arch, Header& header) {
    if (arch.find("label=64") != std::string_view::npos) header.label_bytes = 8;
    if (arch.find("scalar=32") != std::string_view::npos) {
        header.scalar_bytes = 4;
        header.single = true;
    }
}

template <class Number>
Number from_bytes(const char* bytes) {
    Number value;
    std::memcpy(&value, bytes, sizeof value);
    return value;
}

/// A whole number of the file; nothing where it cannot be one of a point, face or cell.
std::optional<std::int32_t> label_of(std::int64_t value) {
    if (value < -1 || value > std::numeric_limits<std::int32_t>::max()) return std::nullopt;
    return static_cast<std::int32_t>(value);
}

template <class Number>
std::vector<Number> joined(const std::vector<std::vector<Number>>& parts) {
    std::size_t size = 0;
    for (const auto& part : parts) size += part.size();
    std::vector<Number> out;
    out.reserve(size);
    for (const auto& part : parts) out.insert(out.end(), part.begin(), part.end());
    return out;
}

Faces with_few_begins(Faces faces) {
    faces.drop_regular_begins();
    return faces;
}

Faces joined(const std::vector<Faces>& parts) {
    std::size_t faces = 0, points = 0;
    for (const Faces& part : parts) {
        faces += part.count();
        points += part.points.size();
    }
    Faces out;
    out.begins.reserve(faces + 1);
    out.points.reserve(points);
    for (const Faces& part : parts) {
        for (std::size_t face = 0; face < part.count(); ++face)
            out.begins.push_back(out.points.size() + part.begin(face + 1));
        out.points.insert(out.points.end(), part.points.begin(), part.points.end());
    }
    return out;
}

} // namespace

std::size_t components_of(std::string_view type) {
    if (type.ends_with("::Internal")) type.remove_suffix(10);
    for (const std::string_view begin : {"vol", "point"})
        if (type.starts_with(begin) && type.ends_with("Field")) {
            type.remove_prefix(begin.size());
            type.remove_suffix(5);
        }
    struct Kind {
        std::string_view name;
        std::size_t components;
    };
    static constexpr Kind kinds[] = {{"scalar", 1},     {"vector", 3}, {"sphericalTensor", 1}, {"symmTensor", 6},
                                     {"tensor", 9},     {"Scalar", 1}, {"Vector", 3},          {"SphericalTensor", 1},
                                     {"SymmTensor", 6}, {"Tensor", 9}};
    for (const Kind& kind : kinds)
        if (type == kind.name) return kind.components;
    return 0;
}

Error Scanner::fail(std::string_view what) const {
    const std::size_t at = std::min(at_, text_.size());
    const auto line = 1 + std::ranges::count(text_.substr(0, std::min<std::size_t>(at, 1 << 20)), '\n');
    const std::string place =
        at <= (1 << 20) && !header_.binary ? fmt::format("line {}", line) : fmt::format("byte {}", at);
    if (at == text_.size()) return broken(file_.path, fmt::format("{}, at {}, where the file ends", what, place));
    return broken(file_.path, fmt::format("{}, at {} ({})", what, place, in_quotes(text_.substr(at, 20))));
}

void Scanner::skip_space() {
    while (at_ < text_.size()) {
        if (is_space(text_[at_])) ++at_;
        else if (text_[at_] != '/') return;
        else if (text_.substr(at_, 2) == "//") at_ = std::min(text_.find('\n', at_), text_.size());
        else if (text_.substr(at_, 2) == "/*") {
            const std::size_t end = text_.find("*/", at_ + 2);
            at_ = end == std::string_view::npos ? text_.size() : end + 2;
        } else return;
    }
}

bool Scanner::at_end() {
    skip_space();
    return at_ == text_.size();
}

char Scanner::peek() {
    skip_space();
    return at_ == text_.size() ? '\0' : text_[at_];
}

bool Scanner::take(char c) {
    if (peek() != c || at_end()) return false;
    ++at_;
    return true;
}

Result<void> Scanner::expect(char c, std::string_view what) {
    if (take(c)) return {};
    return fail(fmt::format("{} lacks its '{}'", what, c));
}

std::string_view Scanner::token() {
    skip_space();
    const std::size_t first = at_;
    if (at_ == text_.size()) return {};
    if (text_.substr(at_, 2) == "#{") { // code, which is not run
        const std::size_t end = text_.find("#}", at_);
        at_ = end == std::string_view::npos ? text_.size() : end + 2;
    } else if (text_[at_] == '"') {
        for (++at_; at_ < text_.size() && text_[at_] != '"'; ++at_)
            if (text_[at_] == '\\') ++at_;
        at_ = std::min(at_ + 1, text_.size());
    } else if (stands_alone(text_[at_])) {
        ++at_;
    } else {
        while (at_ < text_.size() && !is_space(text_[at_]) && !stands_alone(text_[at_]) && text_[at_] != '"') ++at_;
    }
    return text_.substr(first, at_ - first);
}

bool Scanner::is_foam() const {
    Scanner copy = *this;
    copy.at_ = 0;
    return copy.token() == "FoamFile";
}

Result<Header> Scanner::header() {
    auto read = any_header();
    if (read && read->type == "decomposedBlockData")
        return fail("is of the collated format, which is read in folders processorsN only");
    return read;
}

Result<Header> Scanner::any_header() {
    header_ = {};
    if (token() != "FoamFile" || !take('{')) return fail("is no file of OpenFOAM: it does not begin with FoamFile { }");
    while (!take('}')) {
        const std::string_view key = token();
        if (key.empty()) return fail("has a header without its '}'");
        if (peek() == '{') { // "meta", of version 2206 and later
            if (auto skipped = skip_entry(); !skipped) return skipped.error();
            continue;
        }
        std::string_view value = peek() == ';' ? std::string_view() : token();
        if (key == "format") {
            if (value != "ascii" && value != "binary")
                return fail(fmt::format("has the format {}, but ascii and binary are read", in_quotes(value)));
            header_.binary = value == "binary";
        } else if (key == "class") header_.type = value;
        else if (key == "arch") {
            if (value.find("MSB") != std::string_view::npos) return fail("is big-endian (arch), which is not read");
            apply_arch(value, header_);
        }
        while (peek() != ';' && !at_end()) {
            if (token() == "}") return fail("has a header entry without ';'");
        }
        if (!take(';')) return fail("has a header entry without ';'");
    }
    return header_;
}

bool Scanner::skip_binary_list(std::string_view type) {
    std::size_t bytes = header_.scalar_bytes * components_of(type);
    if (type == "label") bytes = header_.label_bytes;
    if (bytes == 0) return true; // written as text
    std::int64_t count = 0;
    if (!number(count) || count < 0) return false;
    if (count == 0 || peek() != '(') return true;
    if (static_cast<std::uint64_t>(count) > (text_.size() - at_) / bytes) return false;
    at_ += 1 + static_cast<std::size_t>(count) * bytes;
    return at_ < text_.size() && text_[at_++] == ')';
}

Result<void> Scanner::skip_entry() {
    std::size_t depth = 0;
    while (true) {
        const std::string_view word = token();
        if (word.empty()) return fail("has an entry without its end");
        if (word == ";" && depth == 0) return {};
        if (word == "(" || word == "{" || word == "[") ++depth;
        else if (word == ")" || word == "}" || word == "]") {
            if (depth-- == 0) return fail("has an entry without ';'");
            if (depth == 0 && word == "}") {
                take(';');
                return {};
            }
        } else if (header_.binary && word.starts_with("List<") && word.ends_with('>')) {
            if (!skip_binary_list(word.substr(5, word.size() - 6))) return fail("has a binary list that is cut short");
        }
    }
}

bool Scanner::number(double& value) {
    skip_space();
    const char* first = text_.data() + at_;
    const char* end = text_.data() + text_.size();
    if (first != end && *first == '+') ++first;
    const auto [rest, error] = std::from_chars(first, end, value);
    if (error == std::errc::invalid_argument) return false;
    const auto length = static_cast<std::size_t>(rest - text_.data()) - at_;
    if (error == std::errc::result_out_of_range && !parse_number(text_.substr(at_, length), value)) return false;
    at_ += length;
    return at_ == text_.size() || is_space(text_[at_]) || stands_alone(text_[at_]) || text_[at_] == '/';
}

bool Scanner::number(std::int64_t& value) {
    skip_space();
    const auto [rest, error] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
    if (error != std::errc{}) return false;
    at_ = static_cast<std::size_t>(rest - text_.data());
    return at_ == text_.size() || is_space(text_[at_]) || stands_alone(text_[at_]) || text_[at_] == '/';
}

Result<std::uint64_t> Scanner::count(std::string_view what) {
    std::int64_t value = 0;
    if (!number(value) || value < 0) return fail(fmt::format("{}: no count of it", what));
    return static_cast<std::uint64_t>(value);
}

Result<std::string_view> Scanner::bytes(std::string_view what) {
    const auto size = count(what);
    if (!size) return size.error();
    if (*size == 0 && peek() != '(') return std::string_view();
    if (auto begun = expect('(', what); !begun) return begun.error();
    if (*size > text_.size() - at_)
        return fail(fmt::format("{} states {} bytes, but {} are left", what, *size, text_.size() - at_));
    const std::string_view found = text_.substr(at_, static_cast<std::size_t>(*size));
    at_ += found.size();
    if (auto ended = expect(')', what); !ended) return ended.error();
    return found;
}

std::string_view Scanner::bytes_begun() {
    std::int64_t size = 0;
    if (!number(size) || size < 0 || !take('(')) return {};
    return text_.substr(at_, static_cast<std::size_t>(size));
}

/// The items of a long list in text, parsed side by side: read_one(scanner, part) for each. Behind an `end_of_item` the next
/// one may begin. Nothing, and the cursor as before, where the list must be read in order, which then tells what is wrong: when
/// it is short or broken, or a comment was taken for items.
template <class Part, class ReadOne>
std::optional<std::vector<Part>> Scanner::parts_of_list(std::uint64_t items, char end_of_item,
                                                        const ReadOne& read_one) {
    constexpr std::size_t part_bytes = std::size_t{1} << 19;
    const std::size_t parts = (text_.size() - at_) / part_bytes; // what stands behind the list, too
    if (header_.binary || parts < 2 || items < 2) return std::nullopt;
    std::vector<std::size_t> begins{at_};
    for (std::size_t part = 1; part < parts; ++part) {
        const std::size_t end = text_.find(end_of_item, std::max(at_ + part * part_bytes, begins.back()));
        begins.push_back(end == std::string_view::npos ? text_.size() : end + 1);
    }
    begins.push_back(text_.size());
    struct Outcome {
        std::uint64_t items = 0;
        bool sound = false;
        std::size_t list_end = 0; ///< 0: not in this part
    };
    std::vector<Part> found(parts);
    std::vector<Outcome> outcomes(parts);
    std::atomic<std::size_t> last = parts; ///< the part with the end of the list
    core::parallel_each(parts, 1, [&](std::size_t part) {
        if (part > last.load(std::memory_order_relaxed)) return;
        Scanner scanner = *this;
        scanner.text_ = text_.substr(0, begins[part + 1]);
        scanner.at_ = begins[part];
        Outcome& outcome = outcomes[part];
        while (!scanner.at_end() && scanner.peek() != ')') {
            if (!read_one(scanner, found[part])) return;
            ++outcome.items;
        }
        outcome.sound = true;
        if (scanner.at_end()) return;
        outcome.list_end = scanner.at_;
        for (std::size_t known = last; part < known && !last.compare_exchange_weak(known, part);) {}
    });
    std::uint64_t count = 0;
    for (std::size_t part = 0; part < parts; ++part) {
        const Outcome& outcome = outcomes[part];
        count += outcome.items;
        if (!outcome.sound || count > items) return std::nullopt;
        if (outcome.list_end == 0) continue;
        if (count != items) return std::nullopt;
        at_ = outcome.list_end + 1;
        found.resize(part + 1);
        return found;
    }
    return std::nullopt;
}

/// `read(bytes, count)`   count items as bytes; with null: one item as text, from the cursor on
/// `read_parts(items)`    the same for all items of a text; true where it has read them and the end of the list
template <class Read, class ReadParts>
Result<void> Scanner::list(std::string_view what, std::size_t item_bytes, std::size_t repeated, const Read& read,
                           const ReadParts& read_parts) {
    std::uint64_t items = 0;
    const bool counted = peek() != '(';
    if (counted) {
        const auto stated = count(what);
        if (!stated) return stated.error();
        items = *stated;
    }
    const auto short_of = [&](std::uint64_t done) {
        return fail(fmt::format("{}: {} of {} are there", what, done, counted ? fmt::format("{}", items) : "them"));
    };
    if (items == 0 && counted && peek() != '(') return {};
    if (counted && !header_.binary && take('{')) {
        if (items > repeated)
            return fail(fmt::format("{}: {} times one value, but there are {} places", what, items, repeated));
        if (!read(nullptr, items)) return fail(fmt::format("{}: no value to repeat", what));
        return expect('}', what);
    }
    if (!take('(')) return short_of(0);
    if (header_.binary && counted) {
        if (items > (text_.size() - at_) / item_bytes) {
            const std::uint64_t there = (text_.size() - at_) / item_bytes;
            at_ = text_.size();
            return short_of(there);
        }
        if (!read(text_.data() + at_, items)) return fail(fmt::format("{}: a number is not below 2^31", what));
        at_ += static_cast<std::size_t>(items) * item_bytes;
        if (at_ >= text_.size() || text_[at_] != ')')
            return fail(
                fmt::format("{}: no ')' behind {} items of {} bytes: cut short, or other sizes than the header's "
                            "arch states",
                            what, items, item_bytes));
        ++at_;
        return {};
    }
    if (counted && items > (text_.size() - at_ + 1) / 2) return short_of((text_.size() - at_ + 1) / 2);
    if (counted && read_parts(items)) return {};
    std::uint64_t done = 0;
    for (; counted ? done < items : peek() != ')'; ++done)
        if (!read(nullptr, 1)) return short_of(done);
    return expect(')', what);
}

Result<std::vector<std::int32_t>> Scanner::labels(std::string_view what, std::size_t repeated) {
    std::vector<std::int32_t> out;
    const auto in_order = [&](const char* bytes, std::uint64_t items) {
        std::int64_t value = 0;
        if (!bytes) {
            const std::size_t before = at_;
            const auto label = number(value) ? label_of(value) : std::nullopt;
            if (!label) at_ = before;
            else out.insert(out.end(), static_cast<std::size_t>(items), *label);
            return label.has_value();
        }
        out.resize(static_cast<std::size_t>(items));
        for (std::size_t i = 0; i < out.size(); ++i) {
            value = header_.label_bytes == 8 ? from_bytes<std::int64_t>(bytes + 8 * i)
                                             : from_bytes<std::int32_t>(bytes + 4 * i);
            const auto label = label_of(value);
            if (!label) return false;
            out[i] = *label;
        }
        return true;
    };
    const auto in_parts = [&](std::uint64_t items) {
        const auto parts = parts_of_list<std::vector<std::int32_t>>(items, '\n', [](Scanner& scanner, auto& part) {
            std::int64_t value = 0;
            const auto label = scanner.number(value) ? label_of(value) : std::nullopt;
            if (label) part.push_back(*label);
            return label.has_value();
        });
        if (parts) out = joined(*parts);
        return parts.has_value();
    };
    const auto done = list(what, header_.label_bytes, repeated, in_order, in_parts);
    if (!done) return done.error();
    return out;
}

Result<std::uint64_t> Scanner::skip_labels(std::string_view what) {
    if (header_.binary || peek() == '(') { // without a count numbers must be counted
        const auto numbers = labels(what, 0);
        if (!numbers) return numbers.error();
        return std::uint64_t{numbers->size()};
    }
    const auto stated = count(what);
    if (!stated) return stated.error();
    if (*stated == 0 && peek() != '(') return *stated;
    if (auto begins = expect('(', what); !begins) return begins.error();
    at_ = std::min(text_.find(')', at_), text_.size());
    if (auto ends = expect(')', what); !ends) return ends.error();
    return *stated;
}

bool Scanner::tuple_here(std::size_t components, std::vector<double>& to) {
    const std::size_t before = at_;
    const bool parentheses = components > 1 || peek() == '(';
    bool sound = !parentheses || take('(');
    double value = 0;
    for (std::size_t k = 0; k < components && sound; ++k)
        if ((sound = number(value))) to.push_back(value);
    sound = sound && (!parentheses || take(')'));
    if (!sound) at_ = before;
    return sound;
}

Result<std::vector<double>> Scanner::tuple(std::size_t components, std::string_view what) {
    std::vector<double> out;
    if (!tuple_here(components, out)) return fail(fmt::format("{}: {} numbers are wanted", what, components));
    return out;
}

Result<std::vector<double>> Scanner::tuples(std::size_t components, std::string_view what, std::size_t repeated) {
    std::vector<double> out;
    const std::size_t bytes_of_one = header_.scalar_bytes * components;
    const auto in_order = [&](const char* bytes, std::uint64_t items) {
        if (!bytes) {
            if (!tuple_here(components, out)) return false;
            for (std::uint64_t i = 1; i < items; ++i)
                for (std::size_t k = 0; k < components; ++k) out.push_back(out[k]);
            if (items == 0) out.clear();
            return true;
        }
        out.resize(static_cast<std::size_t>(items) * components);
        if (out.empty()) return true;
        if (header_.scalar_bytes == 8) std::memcpy(out.data(), bytes, out.size() * 8);
        else
            for (std::size_t i = 0; i < out.size(); ++i) out[i] = from_bytes<float>(bytes + 4 * i);
        return true;
    };
    const auto in_parts = [&](std::uint64_t items) {
        const auto parts =
            parts_of_list<std::vector<double>>(items, components > 1 ? ')' : '\n', [&](Scanner& scanner, auto& part) {
                return scanner.tuple_here(components, part);
            });
        if (parts) out = joined(*parts);
        return parts.has_value();
    };
    const auto done = list(what, bytes_of_one, repeated, in_order, in_parts);
    if (!done) return done.error();
    return out;
}

Result<void> Scanner::face_here(Faces& faces) {
    if (header_.binary) {
        auto points = labels("the points of a face", 0);
        if (!points) return points.error();
        faces.points.insert(faces.points.end(), points->begin(), points->end());
    } else {
        std::int64_t size = 0, point = 0;
        const std::size_t before = at_;
        bool sound = number(size) && size >= 0 && take('(');
        for (std::int64_t k = 0; k < size && sound; ++k) {
            sound = number(point) && label_of(point);
            if (sound) faces.points.push_back(*label_of(point));
        }
        if (!sound || !take(')')) {
            at_ = before;
            return fail(fmt::format("the points of face {} are broken or missing", faces.count()));
        }
    }
    faces.begins.push_back(faces.points.size());
    return {};
}

void Faces::drop_regular_begins() {
    if (begins.size() < 2 || begins[1] == 0) return;
    const std::uint64_t first = begins[1];
    for (std::size_t face = 0; face < begins.size(); ++face)
        if (begins[face] != face * first) return;
    each = first;
    begins = std::vector<std::uint64_t>(); // {} would keep the memory
}

Result<Faces> Scanner::compact_faces() {
    auto begins = labels("where faces begin", 0);
    if (!begins) return begins.error();
    Faces out;
    const std::size_t count = begins->empty() ? 0 : begins->size() - 1;
    const bool rise = !begins->empty() && begins->front() == 0 && std::ranges::is_sorted(*begins);
    if (rise) {
        out.begins.assign(begins->begin(), begins->end());
        begins->clear();
        begins->shrink_to_fit();
        out.drop_regular_begins();
    }
    auto points = labels("the points of faces", 0);
    if (!points) return points.error();
    out.points = std::move(*points);
    if (count == 0 && !rise && out.points.empty()) return Faces{};
    if (!rise || (out.each > 0 ? count * out.each : out.begins.back()) != out.points.size())
        return fail(
            fmt::format("the beginnings of {} faces do not rise from 0 to their {} points", count, out.points.size()));
    return out;
}

Result<Faces> Scanner::faces() {
    if (header_.type == "faceCompactList") return compact_faces();
    const auto stated = count("the faces");
    if (!stated) return stated.error();
    Faces out;
    if (*stated == 0 && peek() != '(') return out;
    if (!take('(') || *stated > (text_.size() - at_) / 3)
        return fail(fmt::format("the faces: {} are stated, but there is no room for them", *stated));
    if (auto parts = parts_of_list<Faces>(
            *stated, ')', [](Scanner& scanner, Faces& part) { return static_cast<bool>(scanner.face_here(part)); }))
        return with_few_begins(joined(*parts));
    out.begins.reserve(static_cast<std::size_t>(*stated) + 1);
    for (std::uint64_t face = 0; face < *stated; ++face)
        if (auto read = face_here(out); !read) return read.error();
    if (auto end = expect(')', "the faces"); !end) return end.error();
    return with_few_begins(std::move(out));
}

} // namespace isotet::io::foam
