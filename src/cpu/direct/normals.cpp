// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "cpu/direct/normals.hpp"

#include <algorithm>
#include <atomic>

#include "base/bits.hpp"
#include "base/parallel.hpp"
#include "grid/values/incidence.hpp"
#include "numbers/arithmetic.hpp"
#include "numbers/sum_of_terms.hpp"
#include "numbers/tet_gradient.hpp"

namespace isotet::cpu::direct {

namespace {

constexpr std::size_t grain = 1 << 13;

/// The ends of edges, numbered by ascending point.
class EndPoints {
public:
    EndPoints(std::size_t points, std::span<const std::int64_t> ends)
        : bits_(core::words_of_bits(points), 0), before_(bits_.size() + 1, 0) {
        core::parallel_each(ends.size(), grain, [&](std::size_t i) {
            const auto point = static_cast<std::size_t>(ends[i]);
            std::atomic_ref<std::uint64_t>(bits_[point / 64])
                .fetch_or(std::uint64_t{1} << point % 64, std::memory_order_relaxed);
        });
        for (std::size_t word = 0; word < bits_.size(); ++word)
            before_[word + 1] = before_[word] + static_cast<std::uint64_t>(std::popcount(bits_[word]));
    }
    bool has(std::uint64_t point) const { return core::test_bit(bits_.data(), point); }
    std::uint64_t number(std::uint64_t point) const {
        const std::uint64_t below = (std::uint64_t{1} << point % 64) - 1;
        return before_[point / 64] + static_cast<std::uint64_t>(std::popcount(bits_[point / 64] & below));
    }
    std::uint64_t count() const { return before_.back(); }
    /// Calls f(number, point) for each, in parallel.
    template <class F>
    void for_all(const F& f) const {
        core::parallel_each(bits_.size(), grain / 64, [&](std::size_t word) {
            std::uint64_t number = before_[word];
            core::for_bits(&bits_[word], 1, [&](std::size_t bit) { f(number++, 64 * word + bit); });
        });
    }

private:
    std::vector<std::uint64_t> bits_, before_;
};

template <class Real>
class GradientSummer {
public:
    GradientSummer(const VertexSource<Real>& source, const Sides& sides, bool mostly_negative, const EndPoints& ends)
        : source_(source),
          cells_(source.input().cells),
          sides_(sides),
          orienter_(source.input().grid.points, mostly_negative),
          ends_(ends) {}

    /// The codes of all ends.
    template <class Index>
    core::Buffer<std::uint32_t> codes() {
        core::Incidence<Index> cells_around(ends_.count(), cells_.count(), [&](std::size_t cell, const auto& body) {
            for (const core::Tet& tet : cells_.tets(cell)) {
                if (!is_valid(tet)) continue;
                for (const std::uint64_t point : tet)
                    if (ends_.has(point)) body(ends_.number(point));
            }
        });
        core::Buffer<std::uint32_t> codes(ends_.count());
        ends_.for_all([&](std::uint64_t number, std::uint64_t point) {
            const std::span<Index> around = cells_around.of(number);
            std::sort(around.begin(), around.end());
            core::Point sum{};
            std::vector<core::Point> terms; // of a piece
            const auto add = [&](const core::Point& gradient) {
                if (source_.input().frame) return terms.push_back(gradient);
                for (std::size_t axis = 0; axis < 3; ++axis) sum[axis] += gradient[axis];
            };
            for (std::size_t i = 0; i < around.size(); ++i)
                if (i == 0 || around[i] != around[i - 1]) add_cell(around[i], point, add); // once, with all its pieces
            codes[number] = core::encode_normal(source_.input().frame ? core::sum_of_terms(terms) : sum);
        });
        return codes;
    }
    bool saw_flat() const { return saw_flat_; }

private:
    bool is_valid(const core::Tet& tet) const {
        return std::none_of(tet.begin(), tet.end(), [&](std::uint64_t point) { return sides_[point] & side::no_data; });
    }

    template <class Add>
    void add_cell(std::size_t cell, std::uint64_t point, const Add& add) {
        const core::CellTets pieces = cells_.tets(cell);
        core::Orienter::Counts counts;
        for (int piece = 0; piece < pieces.count; ++piece) {
            const core::Tet& tet = pieces.tets[static_cast<std::size_t>(piece)];
            if (std::find(tet.begin(), tet.end(), point) == tet.end() || !is_valid(tet)) continue;
            const core::Tet stored = orienter_.stored(cells_.type(cell), pieces, static_cast<unsigned>(piece), counts);
            std::array<core::Point, 4> corners;
            std::array<double, 4> values;
            for (std::size_t k = 0; k < 4; ++k) {
                const auto position = source_.position(stored[k]);
                corners[k] = {position[0], position[1], position[2]};
                values[k] = source_.value(stored[k]);
            }
            add(core::six_volumes_times_gradient(corners, values));
        }
        if (counts.flat) saw_flat_.store(true, std::memory_order_relaxed);
    }

    const VertexSource<Real>& source_;
    const core::CellReader& cells_;
    const Sides& sides_;
    core::Orienter orienter_;
    const EndPoints& ends_;
    std::atomic<bool> saw_flat_{false};
};

} // namespace

template <class Real>
Result<Array> gradient_normals(const VertexSource<Real>& source, const Sides& sides, std::optional<bool> most,
                               const std::function<bool()>& ask_for_most, const ops::RawSurface& surface,
                               const core::ArraySlot& slot, const Progress& progress) {
    const auto cancelled = [] { return Error{ErrorCode::cancelled, "extraction was cancelled"}; };
    const auto ends = surface.ends.as<std::int64_t>();
    const auto weights = surface.weights.as<Real>();
    const EndPoints points(source.input().grid.points.tuples(), ends);
    if (progress.cancelled()) return cancelled();
    core::Buffer<std::uint32_t> codes;
    bool saw_flat = false;
    const auto add_up = [&](bool mostly_negative) {
        codes.release();
        GradientSummer<Real> summer(source, sides, mostly_negative, points);
        codes = source.input().cells.count() < std::uint64_t{1} << 32 ? summer.template codes<std::uint32_t>()
                                                                      : summer.template codes<std::uint64_t>();
        saw_flat = summer.saw_flat();
    };
    add_up(most.value_or(false));
    if (saw_flat && !most && ask_for_most()) add_up(true);
    if (progress.cancelled()) return cancelled();
    core::SharedBuffer<float> normals = slot.make<float>(weights.size(), 3);
    core::parallel_each(weights.size(), grain, [&](std::size_t v) {
        const auto code = [&](std::size_t end) {
            return codes[points.number(static_cast<std::uint64_t>(ends[2 * v + end]))];
        };
        const auto normal = core::vertex_normal(code(0), code(1), weights[v]);
        for (std::size_t axis = 0; axis < 3; ++axis) normals.data()[3 * v + axis] = static_cast<float>(normal[axis]);
    });
    return std::move(normals).to_array(3);
}

template Result<Array> gradient_normals<float>(const VertexSource<float>&, const Sides&, std::optional<bool>,
                                               const std::function<bool()>&, const ops::RawSurface&,
                                               const core::ArraySlot&, const Progress&);
template Result<Array> gradient_normals<double>(const VertexSource<double>&, const Sides&, std::optional<bool>,
                                                const std::function<bool()>&, const ops::RawSurface&,
                                                const core::ArraySlot&, const Progress&);

} // namespace isotet::cpu::direct
