// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/pieces/active_pass.hpp"

#include <algorithm>
#include <bit>
#include <iterator>
#include <set>
#include <tuple>
#include <type_traits>
#include <utility>

#include "base/system/memory.hpp"
#include "base/parallel.hpp"
#include "grid/fixed_corners.hpp"
#include "numbers/point_hash.hpp"

namespace isotet::io {
namespace {

constexpr std::size_t cells_per_send = std::size_t{1} << 10;
/// Of an entry of numbers_: other pieces have the point, too; a cell has it.
constexpr std::uint32_t shared_bit = std::uint32_t{1} << 31, used_bit = std::uint32_t{1} << 30;
constexpr std::uint32_t number_bits = used_bit - 1;

/// Up to the next power of two, so that a masked number that is no point has an entry, too.
core::Buffer<std::uint32_t> numbers_of_points(const PieceNumbers& numbers, std::uint64_t points) {
    core::Buffer<std::uint32_t> result(std::bit_ceil(points));
    numbers.each_run(0, points, [&](std::uint64_t point, std::uint64_t count, std::uint64_t number) {
        for (std::uint64_t i = 0; i < count; ++i)
            result[point + i] = static_cast<std::uint32_t>(number + i) & number_bits;
    });
    numbers.each_shared([&](std::uint64_t point) { result[point] |= shared_bit; });
    std::fill(result.begin() + points, result.end(), used_bit);
    return result;
}

core::Buffer<std::uint8_t> no_marks(std::uint64_t points) {
    core::Buffer<std::uint8_t> marks(points);
    std::ranges::fill(marks, std::uint8_t{0});
    return marks;
}

/// The same for cells with the same corners, whatever their order.
std::uint64_t hash_of(std::uint8_t type, std::span<const std::int32_t> corners) {
    std::uint64_t hash = kind_for_repetition(type);
    for (const std::int32_t corner : corners)
        hash += core::folded_product(static_cast<std::uint32_t>(corner) ^ 0xA0761D6478BD642FU, 0xE7037ED1A0B428DBU);
    return core::mixed(hash);
}

} // namespace

void SharedHashes::add(std::vector<core::Keyed> cells) {
    const std::lock_guard lock(mutex_);
    parts_.push_back(std::move(cells));
}

Result<std::vector<std::vector<std::uint8_t>>> SharedHashes::repeated(std::span<const std::uint64_t> counts) {
    std::size_t count = 0;
    for (const auto& part : parts_) count += part.size();
    if (auto enough = core::require_memory("comparing cells of pieces", 2 * sizeof(core::Keyed) * count); !enough)
        return enough.error();
    core::Buffer<core::Keyed> cells(count), scratch(count);
    core::Keyed* next = cells.begin();
    for (const auto& part : parts_) next = std::copy(part.begin(), part.end(), next);
    parts_ = {};
    core::radix_sort({cells.data(), count}, {scratch.data(), count});
    std::vector<std::uint64_t> places{0};
    for (const std::uint64_t cells_of_piece : counts) places.push_back(places.back() + cells_of_piece);
    std::vector<std::vector<std::uint8_t>> marks;
    const auto mark = [&](std::uint64_t place) {
        const auto piece = static_cast<std::size_t>(std::ranges::upper_bound(places, place) - places.begin() - 1);
        marks.resize(counts.size());
        marks[piece].resize(counts[piece]);
        marks[piece][place - places[piece]] = 1;
    };
    for (std::size_t i = 1; i < count; ++i) {
        if (cells[i].key != cells[i - 1].key) continue;
        mark(cells[i - 1].number);
        mark(cells[i].number);
    }
    return marks;
}

void SharedCells::add(const std::vector<Cell>& cells) {
    const std::lock_guard lock(mutex_);
    cells_.insert(cells_.end(), cells.begin(), cells.end());
}

RepeatedCells SharedCells::settle(CellTaker& taker, bool typed, std::vector<std::uint64_t>& dropped) {
    const auto key = [](const Cell& cell) { return std::tuple(kind_for_repetition(cell.type), cell.ascending); };
    std::ranges::sort(cells_, {}, [&](const Cell& cell) { return std::tuple(key(cell), cell.piece, cell.in_piece); });
    RepeatedCells repeated;
    std::set<std::size_t> in;
    const Cell* first = nullptr; // of those with the same corners
    for (const Cell& cell : cells_) {
        if (!first || key(*first) != key(cell)) first = &cell;
        if (first->piece != cell.piece) {
            ++repeated.left_out;
            dropped.push_back(cell.number);
            in.insert({first->piece, cell.piece});
            continue;
        }
        const std::size_t corners = core::fixed_corners_of(cell.type);
        const Array numbers(ScalarType::int32, cell.corners.data(), corners, 1, nullptr);
        taker.take(cell.number, std::span(&cell.type, typed ? 1 : 0), numbers);
    }
    repeated.pieces.assign(in.begin(), in.end());
    cells_ = {};
    return repeated;
}

ActivePass::ActivePass(const Piece& piece, const PieceNumbers& numbers, const Target& target)
    : piece_(piece),
      target_(target),
      places_(piece.unread->places()),
      points_(target.points),
      whole_(places_, [this](std::uint64_t first, std::uint64_t cells, const Array& corners) {
          corners.visit([&](auto values) {
              using Index = std::remove_const_t<typename decltype(values)::element_type>;
              if constexpr (std::is_integral_v<Index> && sizeof(Index) >= 4) pass_block(first, cells, values.data());
              else broken_ = true;
          });
      }) {
    if (target.taker) numbers_ = numbers_of_points(numbers, points_);
    else kept_ = no_marks(points_), left_out_ = no_marks(points_);
}

void ActivePass::add(std::uint64_t first, const Array& corners) { whole_.add(first, corners); }

bool ActivePass::finish() {
    whole_.finish();
    return !broken_;
}

std::vector<PointUse> ActivePass::use() const {
    std::vector<PointUse> use(points_, PointUse::none);
    for (std::uint64_t i = 0; i < points_; ++i)
        if (target_.taker ? (numbers_[i] & used_bit) != 0 : kept_[i] != 0) use[i] = PointUse::kept;
        else if (!target_.taker && left_out_[i] != 0) use[i] = PointUse::left_out;
    return use;
}

bool ActivePass::uses_all_points() const {
    const auto is_used = [](std::uint32_t number) { return (number & used_bit) != 0; };
    return std::all_of(numbers_.begin(), numbers_.begin() + points_, is_used);
}

template <class Index>
void ActivePass::pass_block(std::uint64_t first_cell, std::uint64_t cells, const Index* corners) {
    const auto each = [&](const auto& corners_of) { pass(first_cell, cells, corners, corners_of); };
    if (!places_.are_uniform())
        return each([&](std::uint64_t cell) { return core::fixed_corners_of(places_.type(cell)); });
    switch (core::fixed_corners_of(places_.type(0))) {
    case 4: return each([](std::uint64_t) { return std::uint64_t{4}; });
    case 5: return each([](std::uint64_t) { return std::uint64_t{5}; });
    case 6: return each([](std::uint64_t) { return std::uint64_t{6}; });
    default: return each([](std::uint64_t) { return std::uint64_t{8}; });
    }
}

void ActivePass::see(std::span<const std::uint64_t> points) {
    for (const std::uint64_t point : points) {
        const std::atomic_ref entry(numbers_[point]);
        entry.store(entry.load(std::memory_order_relaxed) | used_bit, std::memory_order_relaxed);
    }
}

template <class Index>
void ActivePass::mark(std::uint64_t cell, std::span<const Index> corners) {
    core::Buffer<std::uint8_t>& marks = is_left_out(cell) ? left_out_ : kept_;
    for (const Index corner : corners)
        std::atomic_ref(marks[static_cast<std::size_t>(corner)]).store(1, std::memory_order_relaxed);
}

/// Without a taker: only who uses which points.
template <class Index, class CornersOf>
void ActivePass::mark_all(std::uint64_t first_cell, std::uint64_t cells, const Index* corners,
                          const CornersOf& corners_of) {
    for (std::uint64_t cell = first_cell; cell < first_cell + cells; ++cell) {
        const std::span<const Index> own(corners, corners_of(cell));
        if (std::ranges::any_of(own, [&](Index corner) { return core::widened(corner) >= points_; })) broken_ = true;
        if (broken_.load(std::memory_order_relaxed)) return;
        mark(cell, own);
        corners += own.size();
    }
}

template <class Index, class CornersOf>
void ActivePass::pass(std::uint64_t first_cell, std::uint64_t cells, const Index* corners,
                      const CornersOf& corners_of) {
    if (!target_.taker) return mark_all(first_cell, cells, corners, corners_of);
    std::array<std::int32_t, 8 * cells_per_send> numbered;
    std::array<std::uint8_t, cells_per_send> types;
    std::vector<core::Keyed> hashes;
    std::vector<SharedCells::Cell> shared;
    std::uint64_t first = first_cell; // of those in `numbered`
    std::size_t filled = 0, count = 0;
    const auto send_them = [&] {
        if (count > 0) send(first, std::span(types).first(count), std::span(numbered).first(filled));
        filled = count = 0;
    };
    const std::uint64_t mask = numbers_.size() - 1, points = points_;
    std::uint32_t* const numbers = numbers_.data();
    const bool typed = target_.typed, has_left_out = !piece_.left_out.empty();
    bool broken = false;
    for (std::uint64_t cell = first_cell, n = 0; cell < first_cell + cells; ++cell, corners += n) {
        n = corners_of(cell);
        if (has_left_out && is_left_out(cell)) {
            for (std::size_t k = 0; k < n; ++k) broken |= core::widened(corners[k]) >= points;
            if (target_.kept_before.empty()) send_them(); // it has a number: those behind it do not follow those before
            continue;
        }
        std::uint32_t all = shared_bit | used_bit;
        std::array<std::uint64_t, 8> own;
        for (std::size_t k = 0; k < n; ++k) {
            const std::uint64_t point = core::widened(corners[k]);
            broken |= point >= points;
            own[k] = point & mask;
            const std::uint32_t number = std::atomic_ref(numbers[own[k]]).load(std::memory_order_relaxed);
            all &= number;
            numbered[filled + k] = static_cast<std::int32_t>(number & number_bits);
        }
        if ((all & used_bit) == 0) see(std::span(own).first(n));
        if ((all & shared_bit) != 0) {
            const std::span<const std::int32_t> here = std::span(numbered).subspan(filled, n);
            if (target_.hashes) hashes.push_back({hash_of(places_.type(cell), here), target_.place + cell});
            if (!target_.repeated.empty() && target_.repeated[cell] != 0) {
                shared.push_back(shared_cell(cell, here));
                send_them(); // later ones are sent after it, so they are not sent together with earlier ones
                continue;
            }
        }
        if (count == 0) first = cell;
        if (typed) types[count] = places_.type(cell);
        filled += n;
        if (++count == cells_per_send) send_them();
    }
    send_them();
    if (broken) broken_ = true;
    if (!hashes.empty()) target_.hashes->add(std::move(hashes));
    if (!shared.empty()) target_.shared->add(shared);
}

void ActivePass::send(std::uint64_t first_cell, std::span<const std::uint8_t> types,
                      std::span<const std::int32_t> corners) const {
    const Array numbers(ScalarType::int32, corners.data(), corners.size(), 1, nullptr);
    target_.taker->take(number_of(first_cell), target_.typed ? types : types.first(0), numbers);
}

/// Of a cell that is kept, in the joined grid.
std::uint64_t ActivePass::number_of(std::uint64_t cell) const {
    if (target_.kept_before.empty()) return target_.first + cell;
    const std::uint64_t block = cell / block_of_kept;
    const auto begin = piece_.left_out.begin();
    return target_.first + target_.kept_before[block] +
           static_cast<std::uint64_t>(std::count(begin + static_cast<std::ptrdiff_t>(block * block_of_kept),
                                                 begin + static_cast<std::ptrdiff_t>(cell), std::uint8_t{0}));
}

SharedCells::Cell ActivePass::shared_cell(std::uint64_t cell, std::span<const std::int32_t> corners) const {
    SharedCells::Cell shared{{}, {}, places_.type(cell), target_.piece, cell, number_of(cell)};
    shared.corners.fill(-1);
    std::ranges::copy(corners, shared.corners.begin());
    shared.ascending = shared.corners;
    std::sort(shared.ascending.begin(), shared.ascending.begin() + static_cast<std::ptrdiff_t>(corners.size()));
    return shared;
}

} // namespace isotet::io
