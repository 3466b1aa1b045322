// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Which points of pieces are one depends on those that cells use. All are assumed to be used: the pass over the cells,
// which keeps the active ones, tells whether that is so, and is made again with what it found where it is not.
#include "io/pieces/join/join_active.hpp"

#include <algorithm>
#include <atomic>
#include <iterator>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>

#include "base/system/block.hpp"
#include "base/system/memory.hpp"
#include "base/parallel.hpp"
#include "grid/fixed_corners.hpp"
#include "io/files/first_error.hpp"
#include "io/pieces/active_filter.hpp"
#include "io/pieces/active_pass.hpp"
#include "io/pieces/boundary_pass.hpp"
#include "io/pieces/cell_field_means.hpp"
#include "io/pieces/cells_in_order.hpp"
#include "io/pieces/join/chosen_cells.hpp"
#include "io/pieces/join/field_digests.hpp"
#include "io/pieces/join/joined_fields.hpp"
#include "io/pieces/join/ordered_pieces.hpp"
#include "io/pieces/survey_unread.hpp"

namespace isotet::io {
namespace {

OrderedPieces in_order_of_file(std::vector<Piece> pieces) {
    OrderedPieces all;
    all.pieces = std::move(pieces);
    all.boxes.resize(all.size());
    for (const Piece& piece : all.pieces) {
        all.places.push_back(all.places.size());
        all.uses.emplace_back(piece.cell_count() == 0 ? piece.grid.points.tuples() : 0, PointUse::none);
    }
    return all;
}

/// Points and their fields only.
std::vector<Piece> points_of(const std::vector<Piece>& pieces) {
    std::vector<Piece> result;
    for (const Piece& piece : pieces) {
        Piece& points = result.emplace_back();
        points.grid.points = piece.grid.points;
        points.grid.point_fields = piece.grid.point_fields;
    }
    return result;
}

void free_points(std::vector<Piece>& pieces) {
    for (Piece& piece : pieces) {
        piece.grid.points = Array();
        piece.grid.point_fields.clear();
    }
}

/// Keeps active cells.
class ActiveTaker final : public CellTaker {
public:
    explicit ActiveTaker(ActiveCellFilter filter) : filter_(std::move(filter)) {}

    void take(std::uint64_t first, std::span<const std::uint8_t> types, const Array& corners) override {
        if (also_) also_->take(first, types, corners);
        if (chosen_) return chosen_->each_run(first, types, corners, [&](auto... some) { add(some...); });
        add(first, types, corners);
    }
    void add(std::uint64_t first, std::span<const std::uint8_t> types, const Array& corners) {
        if (!types.empty()) return filter_.add_cells(first, types, corners);
        filter_.add(first * corners_of_type_, corners);
    }
    void set_type(CellType type) { corners_of_type_ = core::fixed_corners_of(static_cast<std::uint8_t>(type)); }
    void set_also(CellTaker* other) { also_ = other; }
    void set_chosen(const ChosenCells* chosen) { chosen_ = chosen; }
    bool is_chosen() const { return chosen_ != nullptr; } ///< not all are

    ActiveCellFilter& filter() { return filter_; }

private:
    ActiveCellFilter filter_;
    std::uint64_t corners_of_type_ = 0;
    CellTaker* also_ = nullptr;           ///< gets all cells, too
    const ChosenCells* chosen_ = nullptr; ///< null: all are
};

/// Hands on all cells.
class AroundTaker final : public CellTaker {
public:
    explicit AroundTaker(CellsAround& around) : around_(around) {}

    void take(std::uint64_t, std::span<const std::uint8_t> types, const Array& corners) override {
        around_.add(types, corners);
    }

private:
    CellsAround& around_;
};

class ActiveJoin {
public:
    /// `counted`   gets the counts, where cells are counted; else null
    ActiveJoin(std::vector<Piece>& pieces, const ReadResult& begun, const ReadOptions& options,
               const Progress& progress, bool may_free, SurveyedGrid* counted = nullptr)
        : counted_(counted),
          begun_(begun),
          options_(options),
          progress_(progress),
          all_(in_order_of_file(std::move(pieces))),
          may_free_(may_free) {}

    Result<std::optional<ReadResult>> join() {
        if (!are_unread()) return std::optional<ReadResult>();
        if (!counted_ && all_.size() == 1 && all_.pieces[0].left_out.empty()) return take_one();
        if (!counted_ && has_shares_of_volume()) return std::optional<ReadResult>(); // of several pieces
        if (auto found = find_uses_with_ghosts(); !found) return found.error();
        std::optional<ReadResult> result;
        for (bool again = true; again && !needs_all_ && !freed_;) {
            again = false;
            auto tried = attempt(again);
            if (!tried) return tried.error();
            result = *std::move(tried);
        }
        return result;
    }

    /// None where they were freed.
    std::vector<Piece> pieces() && {
        if (freed_) return {};
        all_.arrange(all_.order_of_file());
        return std::move(all_.pieces);
    }

private:
    bool are_unread() {
        std::optional<std::uint8_t> type;
        for (const Piece& piece : all_.pieces) {
            if (piece.cell_count() == 0) continue;
            if (counted_ && !may_be_counted(piece, options_)) return false;
            if (!piece.unread || !check_shape(points_as_piece(piece))) return false;
            if (!counted_ && !piece.grid.cell_fields.empty()) return false;
            if (!piece.left_out.empty() && piece.left_out.size() != piece.cell_count()) return false;
            const CellPlaces& places = piece.unread->places();
            typed_ = typed_ || !places.are_uniform() || (type && *type != places.type(0));
            type = places.type(0);
        }
        if (type && !typed_) type_ = static_cast<CellType>(*type);
        return type.has_value();
    }

    /// Whether it must be known which cells were kept.
    bool wants_numbers() const {
        return chooses() || options_.active_cells->options.extract.source_cells ||
               std::ranges::any_of(all_.pieces, [](const Piece& piece) { return !piece.unread_fields.empty(); });
    }

    bool chooses() const { return !counted_ && !options_.active_cells->conditions.empty(); }

    /// False where all cells are needed.
    Result<bool> find_chosen() {
        if (!chooses() || chosen_) return true;
        const ReadActiveCells& asked = *options_.active_cells;
        if (asked.bounds || asked.boundary || asked.choose || !asked.shares.empty()) return false;
        auto found = ChosenCells::find(all_, asked.conditions, first_cells(), type_);
        if (!found) return found.error();
        if (*found) chosen_.emplace(**std::move(found));
        return chosen_.has_value();
    }

    /// What the cells go by for; null where all are needed.
    std::unique_ptr<CellTaker> make_taker(const Grid& grid) {
        if (counted_) return CellCounter::make(grid.points, type_, kept_cells());
        isovalues_ = share_isovalues_;
        auto filter = active_filter(grid, averaged_, type_, kept_cells(), options_, wants_numbers(), isovalues_);
        if (!filter) return nullptr;
        auto taker = std::make_unique<ActiveTaker>(*std::move(filter));
        if (type_) taker->set_type(*type_);
        if (chosen_ && !chosen_->are_all()) taker->set_chosen(&*chosen_);
        return taker;
    }

    /// Nothing where all cells are needed.
    /// `pass_again`   as with_cells() takes it
    template <class PassAgain>
    Result<std::optional<ReadResult>> finished(CellTaker& taker, ReadResult result, const PassAgain& pass_again) {
        if (!counted_) return with_cells(static_cast<ActiveTaker&>(taker).filter(), std::move(result), pass_again);
        SurveyedGrid counted;
        if (!static_cast<CellCounter&>(taker).finish(counted, progress_)) return std::optional<ReadResult>();
        std::vector<std::uint64_t> kept;
        for (const Piece& piece : all_.pieces) kept.push_back(kept_cells_of(piece));
        auto fields = join_cell_fields(all_.pieces, first_cells(), kept, kept_cells(), result, progress_);
        if (!fields) return fields.error();
        result.grid.cell_fields = *std::move(fields);
        result.grid.cells = std::move(counted.read.grid.cells);
        counted_->report = std::move(counted.report);
        counted_->sampled = std::move(counted.sampled);
        return std::optional(std::move(result));
    }

    static Piece points_as_piece(const Piece& piece) {
        Piece points;
        points.grid.points = piece.grid.points;
        points.grid.point_fields = piece.grid.point_fields;
        points.point_ids = piece.point_ids;
        return points;
    }

    /// A piece alone is the grid, if no cell is left out.
    Result<std::optional<ReadResult>> take_one() {
        const Piece& piece = all_.pieces[0];
        const CellPlaces& places = piece.unread->places();
        ReadResult result = begun_;
        result.grid.points = piece.grid.points;
        result.grid.point_fields = piece.grid.point_fields;
        const auto may_choose = find_chosen();
        if (!may_choose) return may_choose.error();
        if (!*may_choose) return std::optional<ReadResult>();
        if (chosen_ && !chosen_->are_all()) {
            chosen_->note_points(piece.grid.points.tuples());
            if (auto passed = pass_whole(*piece.unread, *chosen_); !passed) return passed.error();
            if (!chosen_->leave_values(result.grid)) return std::optional<ReadResult>();
        }
        if (const auto averaged = average(result.grid.points, nullptr); !averaged) return averaged.error();
        else if (!*averaged) return std::optional<ReadResult>();
        result.field = averaged_;
        if (const auto found = find_shares(result.grid, &piece); !found) return found.error();
        else if (!*found) return std::optional<ReadResult>();
        auto taker = make_taker(result.grid);
        if (!taker) return std::optional<ReadResult>();
        auto& active = static_cast<ActiveTaker&>(*taker);
        ActiveCellFilter* const filter = &active.filter();
        const bool cuts = !type_ || active.is_chosen(); // into whole cells
        WholeCells whole(places, [&](std::uint64_t first, std::uint64_t count, const Array& corners) {
            active.take(first, type_ ? std::span<const std::uint8_t>() : places.types(first, count), corners);
        });
        if (options_.active_cells->bounds) used_.assign(piece.grid.points.tuples(), PointUse::none);
        std::optional<BoundaryPass> boundary;
        if (StreamedBoundary* const found = boundary_to_find()) {
            if (auto enough = BoundaryPass::check_memory(piece.grid.points); !enough) return enough.error();
            boundary.emplace(*found, piece.grid.points, *piece.unread);
        }
        bool is_first = true;
        do {
            const auto done = piece.unread->each_block([&](std::uint64_t first, const Array& corners) {
                if (progress_.cancelled()) return;
                cuts ? whole.add(first, corners) : filter->add(first, corners);
                if (is_first && !used_.empty()) mark_corners(corners);
                if (is_first && boundary) boundary->add(first, corners);
            });
            if (!done) return done.error();
            if (progress_.cancelled()) return Error{ErrorCode::cancelled, "looking for active cells was cancelled"};
            whole.finish();
            is_first = false;
        } while (filter->next_round());
        if (boundary) {
            const auto found = boundary->finish(progress_);
            if (!found) return found.error();
            if (!*found) return std::optional<ReadResult>();
        }
        result.cells_in_file = places.cells();
        return with_cells(*filter, std::move(result), [&](CellsAround& around) -> Result<void> {
            WholeCells cells(places, [&](std::uint64_t first, std::uint64_t count, const Array& corners) {
                const std::vector<std::uint8_t> alike(type_ ? count : 0, places.type(first));
                around.add(type_ ? std::span(alike) : places.types(first, count), corners);
            });
            const auto add = [&](std::uint64_t first, const Array& corners) { cells.add(first, corners); };
            if (auto passed = piece.unread->each_block(add); !passed) return passed;
            cells.finish();
            return {};
        });
    }

    /// Averages the field, where it is one of cells. False where all are needed.
    /// `numbers`   of the points of several pieces
    Result<bool> average(const Array& points, const PointNumbers* numbers) {
        if (counted_ || !options_.active_cells->averages) return true;
        if (chooses()) return false;
        std::vector<NumberedPiece> pieces;
        for (const std::size_t p : all_.order_of_file())
            if (all_.pieces[p].cell_count() > 0)
                pieces.push_back(
                    {&all_.pieces[p], numbers ? &numbers->pieces[p] : nullptr, numbers ? points_[p] : points.tuples()});
        auto means = means_of_cells(pieces, points, options_.active_cells->field, progress_);
        if (!means) return means.error();
        averaged_ = *std::move(means);
        return averaged_.has_value();
    }

    /// The one that is asked for, or one that tells that no points hang, on which averages and volumes depend; else null.
    StreamedBoundary* boundary_to_find() {
        if (counted_) return nullptr;
        if (options_.active_cells->boundary) return options_.active_cells->boundary.get();
        return averaged_ || has_shares_of_volume() ? &boundary_ : nullptr;
    }

    bool has_shares_of_volume() const {
        return std::ranges::any_of(options_.active_cells->shares,
                                   [](const IsovalueShare& share) { return share.of == IsovalueShare::Of::volume; });
    }

    /// Finds the isovalues of shares, where there are some. False where all cells are needed.
    /// `alone`   the only piece, or null
    Result<bool> find_shares(const Grid& grid, const Piece* alone) {
        const ReadActiveCells& asked = *options_.active_cells;
        share_isovalues_.clear();
        if (counted_ || asked.shares.empty()) return true;
        if (has_shares_of_volume() && (!alone || may_coincide(grid.points, alone->cell_count()))) return false;
        const auto field = active_field(grid, asked, averaged_);
        if (!field) return false;
        const auto all = alone ? cells_in_turn(*alone->unread, grid.points) : CellsInTurn();
        auto found = isovalues_at(grid.points, all, *field, asked.shares, {.progress = {nullptr, progress_.cancel}});
        if (!found && (found.error().code == ErrorCode::cancelled || found.error().code == ErrorCode::out_of_memory))
            return found.error();
        if (!found) return false; // reading all cells tells what is wrong
        share_isovalues_ = *std::move(found);
        return true;
    }

    /// Hands whole cells of a piece alone to a taker.
    Result<void> pass_whole(const CellSource& cells, CellTaker& taker) {
        const CellPlaces& places = cells.places();
        WholeCells whole(places, [&](std::uint64_t first, std::uint64_t count, const Array& corners) {
            taker.take(first, type_ ? std::span<const std::uint8_t>() : places.types(first, count), corners);
        });
        const auto passed = cells.each_block([&](std::uint64_t first, const Array& corners) {
            if (!progress_.cancelled()) whole.add(first, corners);
        });
        if (!passed) return passed;
        if (progress_.cancelled()) return Error{ErrorCode::cancelled, "choosing cells was cancelled"};
        whole.finish();
        return {};
    }

    /// Nothing where cells are broken, which is told when all are there, or may have hanging points.
    /// `pass_again`   hands all cells to a CellsAround
    template <class PassAgain>
    Result<std::optional<ReadResult>> with_cells(ActiveCellFilter& filter, ReadResult result,
                                                 const PassAgain& pass_again) {
        auto cells = filter.finish();
        if (!cells && cells.error().code != ErrorCode::invalid_data) return cells.error();
        if (!cells || (chosen_ && cells->count() == 0)) return std::optional<ReadResult>();
        result.grid.cells = *std::move(cells);
        result.share_isovalues = share_isovalues_;
        const Result<bool> hang = may_have_hanging_points(result.grid, pass_again);
        if (!hang && hang.error().code != ErrorCode::invalid_data) return hang.error();
        if (!hang || *hang) return std::optional<ReadResult>();
        if (wants_numbers()) {
            const Array all = filter.numbers(); // empty where there is no cell
            const auto numbers = all.empty() ? std::span<const std::uint64_t>() : all.as<std::uint64_t>();
            if (chosen_) result.chosen_cells = chosen_->count();
            auto read = read_fields(numbers, result);
            if (!read) return read.error();
            if (!*read) return std::optional<ReadResult>();
            result.grid.cell_fields = **std::move(read);
            if (options_.active_cells->options.extract.source_cells) result.cell_numbers = numbers_in_grid(numbers);
        }
        const auto colored = read_for_colors(result);
        if (!colored) return colored.error();
        if (!*colored) return std::optional<ReadResult>();
        if (!used_.empty()) {
            const Box box = box_of(result.grid.points, used_);
            result.bounds = {box.lower[0], box.lower[1], box.lower[2], box.upper[0], box.upper[1], box.upper[2]};
        }
        return std::optional(std::move(result));
    }

    /// Values at the boundary, and digests of all, where they are wanted. False where all cells are needed.
    Result<bool> read_for_colors(ReadResult& result) {
        const ReadActiveCells& asked = *options_.active_cells;
        if (asked.boundary && asked.boundary->wants_cells) {
            StreamedBoundary& boundary = *asked.boundary;
            ReadResult told;
            told.info = result.info;
            auto fields = read_fields(boundary.numbers, told);
            if (!fields) return fields.error();
            if (!*fields) return false;
            boundary.cells.points = result.grid.points;
            boundary.cells.cell_fields = **std::move(fields);
        }
        if (!asked.digests) return true;
        if (!dropped_.empty()) return false;
        auto digests = digests_of(all_, result.grid.cell_fields, progress_);
        if (!digests) return digests.error();
        if (!*digests) return false;
        result.digests = **std::move(digests);
        return true;
    }

    /// Numbers as join() has them: of a piece alone those in its file, else without the cells that are left out.
    Array numbers_in_grid(std::span<const std::uint64_t> numbers) {
        const std::vector<std::uint64_t> first = first_cells();
        std::vector<std::uint64_t> result;
        result.reserve(numbers.size());
        std::ranges::sort(dropped_);
        std::uint64_t kept_before = 0, dropped = 0; // cells of earlier pieces; repeated ones so far
        for (const std::size_t p : all_.order_of_file()) {
            const std::vector<std::uint8_t>& out = all_.pieces[p].left_out;
            std::uint64_t seen = 0, kept = 0;
            for (; result.size() < numbers.size(); result.push_back(kept_before + kept - dropped)) {
                const std::uint64_t number = numbers[result.size()], cell = number - first[p];
                if (cell >= all_.pieces[p].cell_count()) break;
                if (out.empty() || all_.size() == 1) kept = cell;
                else
                    for (; seen < cell; ++seen) kept += out[seen] == 0 ? 1 : 0;
                while (dropped < dropped_.size() && dropped_[dropped] < number) ++dropped;
            }
            kept_before += kept_cells_of(all_.pieces[p]);
        }
        return Array::own(std::move(result));
    }

    /// Cell fields of cells with these numbers, with notes in `result`. Nothing where one cannot be read.
    Result<std::optional<std::vector<Field>>> read_fields(std::span<const std::uint64_t> numbers, ReadResult& result) {
        const std::optional<std::vector<Field>> nothing;
        const std::vector<std::uint64_t> first = first_cells();
        std::vector<std::vector<std::uint64_t>> cells(all_.size()); // by piece, in it
        std::vector<std::uint64_t> place(all_.size()), kept(all_.size());
        std::uint64_t next = 0;
        for (const std::size_t p : all_.order_of_file()) {
            const std::uint64_t count = all_.pieces[p].cell_count();
            kept[p] = kept_cells_of(all_.pieces[p]);
            for (place[p] = next; next < numbers.size() && numbers[next] - first[p] < count; ++next)
                cells[p].push_back(numbers[next] - first[p]);
        }
        std::vector<Piece> pieces(all_.size());
        FirstError failed;
        core::parallel_each(all_.size(), 1, [&](std::size_t p) {
            for (const UnreadField& field : all_.pieces[p].unread_fields) {
                if (failed) return;
                auto values = cells[p].empty() ? Array(field.type, nullptr, 0, field.components, nullptr)
                                               : field.values->read(cells[p]);
                if (!values) return failed.add(p, values.error());
                pieces[p].grid.cell_fields.push_back({field.name, *std::move(values)});
            }
        });
        if (const auto done = failed.result(); !done)
            return done.error().code == ErrorCode::invalid_data ? Result<std::optional<std::vector<Field>>>(nothing)
                                                                : done.error();
        auto fields = join_cell_fields(pieces, place, kept, numbers.size(), result, progress_);
        if (!fields) return fields.error();
        return std::optional(*std::move(fields));
    }

    template <class PassAgain>
    Result<bool> may_have_hanging_points(const Grid& active, const PassAgain& pass_again) const {
        const Run run{.progress = {nullptr, progress_.cancel}};
        const ReadActiveCells& asked = *options_.active_cells;
        const Result<PointField> field = active_field(active, asked, averaged_);
        if (!field) return field.error();
        Result<CellsAround> around = CellsAround::of(active, *field, isovalues_, run);
        if (!around) return around.error();
        if (around->are_needed())
            if (Result<void> done = pass_again(*around); !done) return done.error();
        return around->may_have_hanging_points(run);
    }

    void mark(std::uint64_t point) {
        if (point < used_.size()) std::atomic_ref(used_[point]).store(PointUse::kept, std::memory_order_relaxed);
    }
    void mark_corners(const Array& corners) {
        corners.visit([&]<class Index>(std::span<const Index> points) {
            if constexpr (std::is_integral_v<Index>)
                for (const Index point : points) mark(core::widened(point));
        });
    }
    void mark_used(const std::vector<PointUse>& use, const PieceNumbers& numbers) {
        for (std::size_t i = 0; i < use.size(); ++i)
            if (use[i] == PointUse::kept) mark(numbers(i));
    }

    /// Where ghost cells are left out, points that only they have are, too.
    Result<void> find_uses_with_ghosts() {
        if (all_.size() == 1) return {};
        FirstError failed;
        core::parallel_each(all_.size(), 1, [&](std::size_t p) {
            const Piece& piece = all_.pieces[p];
            if (piece.left_out.empty() || !piece.unread || failed) return;
            ActivePass::Target target;
            target.points = piece.grid.points.tuples();
            ActivePass pass(piece, {}, target);
            const auto add = [&](std::uint64_t first, const Array& corners) { pass.add(first, corners); };
            if (auto done = piece.unread->each_block(add); !done) return failed.add(p, done.error());
            if (!pass.finish()) needs_all_ = true; // what is broken is told when all cells are there
            all_.uses[p] = pass.use();
        });
        return failed.result();
    }

    /// Nothing where all cells are needed, or where uses are not as assumed: then `again`, with those that were found.
    Result<std::optional<ReadResult>> attempt(bool& again) {
        ReadResult result = begun_;
        note_left_out(all_.pieces, result.notes);
        all_.arrange(all_.order_of_file());
        for (std::size_t p = 0; p < all_.size(); ++p) all_.boxes[p] = box_of(all_.pieces[p].grid.points, all_.uses[p]);
        const auto joined = number_points(all_, options_, result.notes, progress_);
        if (!joined) return joined.error();
        if (joined->numbers.count > ActivePass::max_points || has_twins(*joined)) needs_all_ = true;
        if (needs_all_) return std::optional<ReadResult>();
        for (Piece& piece : all_.pieces)
            if (may_free_ && all_.size() > 1) piece.point_ids = Array();
        if (auto enough = core::require_memory("joining the points of pieces", bytes_of_points()); !enough)
            return enough.error();
        const std::size_t notes = result.notes.size(), left_out = result.info.left_out.size();
        points_.clear();
        for (const Piece& piece : all_.pieces) points_.push_back(piece.grid.points.tuples());
        if (auto done = join_points_of(*joined, result); !done) return done.error();
        std::vector<std::string> of_fields(result.notes.begin() + static_cast<std::ptrdiff_t>(notes),
                                           result.notes.end());
        result.notes.resize(notes);
        const auto first_left_out = result.info.left_out.begin() + static_cast<std::ptrdiff_t>(left_out);
        const std::vector<LeftOut> fields_left_out(first_left_out, result.info.left_out.end());
        result.info.left_out.resize(left_out);

        if (auto done = leave_chosen(*joined, result.grid, again); !done) return done.error();
        if (needs_all_ || again) return std::optional<ReadResult>();
        if (const auto averaged = average(result.grid.points, &joined->numbers); !averaged) return averaged.error();
        else if (!*averaged) needs_all_ = true;
        if (needs_all_) return std::optional<ReadResult>();
        result.field = averaged_;
        if (const auto found = find_shares(result.grid, nullptr); !found) return found.error();
        else if (!*found) needs_all_ = true;
        auto taker = needs_all_ ? nullptr : make_taker(result.grid);
        if (!taker) needs_all_ = true;
        if (needs_all_) return std::optional<ReadResult>();
        if (options_.active_cells->bounds) used_.assign(joined->numbers.count, PointUse::none);
        std::optional<core::BoundarySearch> search;
        std::optional<BoundaryTaker> for_boundary;
        if (boundary_to_find()) {
            if (auto enough = BoundaryPass::check_memory(result.grid.points); !enough) return enough.error();
            begin_search(search, result.grid.points);
            for_boundary.emplace(*search, type_, BoundaryTaker::Round::add);
            static_cast<ActiveTaker&>(*taker).set_also(&*for_boundary);
        }
        std::vector<ActivePass::Target> targets = targets_for(*taker);
        SharedHashes hashes;
        for (ActivePass::Target& target : targets) target.hashes = &hashes;
        if (auto done = pass_all(joined->numbers, targets, again); !done) return done.error();
        if (needs_all_ || again) return std::optional<ReadResult>();
        const auto marks = hashes.repeated(cell_counts());
        if (!marks) return marks.error();
        RepeatedCells repeated;
        SharedCells shared;
        const auto share = [&] {
            for (std::size_t p = 0; p < all_.size() && !marks->empty(); ++p)
                targets[p].shared = &shared, targets[p].repeated = (*marks)[p];
        };
        dropped_.clear();
        if (!marks->empty()) { // cells were kept that may be those of other pieces
            if (counted_ || chosen_ || averaged_) needs_all_ = true;
            if (needs_all_) return std::optional<ReadResult>();
            taker.reset(); // its memory is needed again
            taker = make_taker(result.grid);
            if (search) {
                for_boundary.reset();
                begin_search(search, result.grid.points);
                for_boundary.emplace(*search, type_, BoundaryTaker::Round::add);
                static_cast<ActiveTaker&>(*taker).set_also(&*for_boundary);
            }
            targets = targets_for(*taker);
            share();
            do {
                dropped_.clear();
                if (auto done = pass_all(joined->numbers, targets, again); !done) return done.error();
                if (needs_all_ || again) return std::optional<ReadResult>();
                repeated = shared.settle(*taker, typed_, dropped_);
            } while (goes_another_round(*taker));
        }
        if (goes_another_round(*taker)) {
            for (ActivePass::Target& target : targets) target.hashes = nullptr;
            if (auto done = pass_all(joined->numbers, targets, again); !done) return done.error();
            if (needs_all_ || again) return std::optional<ReadResult>();
        }
        if (search) {
            BoundaryTaker keeper(*search, type_, BoundaryTaker::Round::keep);
            targets = targets_for(keeper);
            share();
            needs_all_ = !search->look();
            if (!needs_all_)
                if (auto done = pass_all(joined->numbers, targets, again); !done) return done.error();
            if (needs_all_) return std::optional<ReadResult>();
            std::vector<std::uint64_t> told;
            shared.settle(keeper, typed_, told);
            const auto found = find_boundary(result.grid.points, *search);
            if (!found) return found.error();
            if (!*found) return std::optional<ReadResult>();
        }
        note_repeated(repeated, all_.pieces, result.notes);
        result.cells_in_file = kept_cells() - repeated.left_out;
        auto found = finished(*taker, std::move(result), [&](CellsAround& around) {
            AroundTaker all(around);
            for (ActivePass::Target& target : targets) target = {.taker = &all, .typed = true, .points = target.points};
            return pass_all(joined->numbers, targets, again);
        });
        if (!found || !*found) return found;
        for (const LeftOut& item : fields_left_out) leave_out((*found)->info, item); // behind those of cells
        std::ranges::move(of_fields, std::back_inserter((*found)->notes));
        return found;
    }

    void begin_search(std::optional<core::BoundarySearch>& search, const Array& points) {
        search.emplace(points);
        if (boundary_to_find()->wants_cells) search->keep_numbers();
    }

    /// Finds the chosen cells, and leaves values at their points. Sets needs_all_ where all are needed.
    Result<void> leave_chosen(const JoinedNumbers& joined, Grid& grid, bool& again) {
        const auto found = find_chosen();
        if (!found) return found.error();
        if (!*found) needs_all_ = true;
        if (needs_all_ || !chosen_ || chosen_->are_all()) return {};
        chosen_->note_points(joined.numbers.count);
        if (auto done = pass_all(joined.numbers, targets_for(*chosen_), again); !done) return done;
        if (!needs_all_ && !again && !chosen_->leave_values(grid)) needs_all_ = true;
        return {};
    }

    /// Whether the taker needs all cells once more.
    bool goes_another_round(CellTaker& taker) const {
        if (counted_) return false;
        auto& active = static_cast<ActiveTaker&>(taker);
        active.set_also(nullptr);
        return active.filter().next_round();
    }

    /// False where all cells are needed.
    Result<bool> find_boundary(const Array& points, core::BoundarySearch& search) {
        StreamedBoundary& boundary = *boundary_to_find();
        boundary.print = {};
        return take_boundary(std::move(search), points, boundary, progress_);
    }

    /// Whether pieces have the same points, so that only their cells could tell which comes first.
    bool has_twins(const JoinedNumbers& joined) const {
        for (std::size_t p = 1; p < all_.size() && !joined.seams.joined.empty(); ++p)
            if (all_.boxes[p] == all_.boxes[p - 1] &&
                compare_bytes(all_.pieces[p].grid.points, all_.pieces[p - 1].grid.points) == 0)
                return true;
        return false;
    }

    /// Of the joined points, their fields and what is noted of each.
    std::uint64_t bytes_of_points() const {
        const std::uint64_t of_filter = options_.active_cells->isovalues.size() == 1 ? 1 : 3;
        std::uint64_t bytes = 0;
        for (const Piece& piece : all_.pieces) {
            bytes += piece.grid.points.bytes() + piece.grid.points.tuples() * of_filter;
            for (const Field& field : piece.grid.point_fields) bytes += field.values.bytes();
        }
        return bytes;
    }

    Result<void> join_points_of(const JoinedNumbers& joined, ReadResult& result) {
        if (all_.size() == 1) {
            result.grid.points = all_.pieces[0].grid.points;
            result.grid.point_fields = all_.pieces[0].grid.point_fields;
            return {};
        }
        std::vector<Piece> pieces = points_of(all_.pieces);
        freed_ = may_free_;
        if (freed_) free_points(all_.pieces); // those of `pieces` are freed as they are joined
        auto fields = join_point_fields(pieces, joined.numbers, joined.seams.joined, result, progress_);
        if (!fields) return fields.error();
        result.grid.point_fields = *std::move(fields);
        auto points = join_points(pieces, joined.numbers);
        if (!points) return points.error();
        result.grid.points = *std::move(points);
        pieces.clear();
        if (freed_) core::drop_kept_blocks(); // many small ones that nothing else fits into
        return {};
    }

    /// By piece: the number of its first cell, such that the first cell that stays has number 0. Where cells are counted,
    /// those that are left out have none.
    std::vector<std::uint64_t> first_cells() const {
        std::vector<std::uint64_t> first(all_.size());
        std::uint64_t next = 0, origin = 0;
        bool found = counted_ != nullptr;
        for (const std::size_t p : all_.order_of_file()) {
            const Piece& piece = all_.pieces[p];
            first[p] = next;
            if (!found && piece.cell_count() > 0) {
                const auto stays = std::ranges::find(piece.left_out, std::uint8_t{0});
                found = piece.left_out.empty() || stays != piece.left_out.end();
                origin = next + static_cast<std::uint64_t>(stays - piece.left_out.begin());
            }
            next += counted_ ? kept_cells_of(piece) : piece.cell_count();
        }
        for (std::uint64_t& number : first) number -= origin; // wraps for cells that are left out
        return first;
    }

    static std::uint64_t kept_cells_of(const Piece& piece) {
        return piece.cell_count() - (piece.left_out.size() -
                                     static_cast<std::uint64_t>(std::ranges::count(piece.left_out, std::uint8_t{0})));
    }
    std::uint64_t kept_cells() const {
        std::uint64_t count = 0;
        for (const Piece& piece : all_.pieces) count += kept_cells_of(piece);
        return count;
    }

    /// By piece with left-out cells, where cells are counted: as ActivePass::Target::kept_before.
    void count_kept() {
        kept_before_.resize(all_.size());
        for (std::size_t p = 0; counted_ && p < all_.size(); ++p) {
            const std::vector<std::uint8_t>& out = all_.pieces[p].left_out;
            std::uint64_t sum = 0;
            kept_before_[p].clear();
            for (std::size_t begin = 0; begin < out.size(); begin += ActivePass::block_of_kept) {
                kept_before_[p].push_back(sum);
                const std::size_t end = std::min<std::size_t>(begin + ActivePass::block_of_kept, out.size());
                sum += static_cast<std::uint64_t>(std::count(out.begin() + static_cast<std::ptrdiff_t>(begin),
                                                             out.begin() + static_cast<std::ptrdiff_t>(end),
                                                             std::uint8_t{0}));
            }
        }
    }

    std::vector<std::uint64_t> cell_counts() const {
        std::vector<std::uint64_t> counts;
        for (const Piece& piece : all_.pieces) counts.push_back(piece.cell_count());
        return counts;
    }

    std::vector<ActivePass::Target> targets_for(CellTaker& taker) {
        std::vector<ActivePass::Target> targets(all_.size());
        count_kept();
        const std::vector<std::uint64_t> first = first_cells();
        std::uint64_t place = 0;
        for (std::size_t p = 0; p < all_.size(); ++p) {
            targets[p] = {&taker, typed_, first[p], static_cast<std::uint32_t>(p)};
            targets[p].place = std::exchange(place, place + all_.pieces[p].cell_count());
            targets[p].points = points_[p];
            targets[p].kept_before = kept_before_[p];
        }
        return targets;
    }

    /// `targets`   by piece
    Result<void> pass_all(const PointNumbers& numbers, const std::vector<ActivePass::Target>& targets, bool& again) {
        std::vector<std::vector<PointUse>> found(all_.size());
        std::atomic<std::size_t> done_pieces = 0;
        FirstError failed;
        core::parallel_each(all_.size(), 1, [&](std::size_t p) {
            const Piece& piece = all_.pieces[p];
            if (!piece.unread || failed || needs_all_) return;
            const bool assumed = all_.size() > 1 && all_.uses[p].empty();
            ActivePass pass(piece, numbers.pieces[p], targets[p]);
            const auto add = [&](std::uint64_t place, const Array& corners) {
                if (!progress_.cancelled()) pass.add(place, corners);
            };
            if (auto done = piece.unread->each_block(add); !done) return failed.add(p, done.error());
            if (progress_.cancelled())
                return failed.add(p, {ErrorCode::cancelled, "looking for active cells was cancelled"});
            progress_("join pieces", 0.7 + 0.3 * static_cast<double>(++done_pieces) / static_cast<double>(all_.size()));
            if (!pass.finish()) needs_all_ = true;
            else if (assumed && !pass.uses_all_points()) found[p] = pass.use();
            if (!used_.empty()) mark_used(pass.use(), numbers.pieces[p]);
        });
        if (auto done = failed.result(); !done) return done;
        for (std::size_t p = 0; p < all_.size() && !needs_all_; ++p) {
            if (found[p].empty()) continue;
            all_.uses[p] = std::move(found[p]);
            again = true;
        }
        return {};
    }

    SurveyedGrid* counted_;
    const ReadResult& begun_;
    const ReadOptions& options_;
    const Progress& progress_;
    OrderedPieces all_;
    bool may_free_, freed_ = false;     ///< points and fields of the pieces
    bool typed_ = false;                ///< not all cells are of one type
    std::optional<CellType> type_;      ///< of all
    std::vector<std::uint64_t> points_; ///< of each piece
    std::vector<std::vector<std::uint64_t>> kept_before_;
    std::optional<ChosenCells> chosen_; ///< where some are
    std::vector<double> isovalues_;     ///< for which cells are kept
    std::vector<double> share_isovalues_;
    StreamedBoundary boundary_;          ///< where none is asked for
    std::optional<PointField> averaged_; ///< that cells are active of
    std::vector<PointUse> used_;         ///< of the joined points, where their bounds are asked for
    std::vector<std::uint64_t> dropped_; ///< numbers of cells that earlier pieces have
    std::atomic<bool> needs_all_ = false;
};

} // namespace

Result<std::optional<ReadResult>> join_counted(std::vector<Piece>& pieces, const ReadResult& begun,
                                               const ReadOptions& options, const Progress& progress,
                                               SurveyedGrid& counted) {
    ActiveJoin joining(pieces, begun, options, progress, false, &counted);
    auto result = joining.join();
    pieces = std::move(joining).pieces();
    return result;
}

Result<std::optional<ReadResult>> join_active(std::vector<Piece>& pieces, const ReadResult& begun,
                                              const ReadOptions& options, const Progress& progress, bool may_free) {
    ActiveJoin joining(pieces, begun, options, progress, may_free);
    auto result = joining.join();
    const auto& boundary = options.active_cells->boundary;
    if (boundary && !(result && *result)) boundary->is_there = false;
    pieces = std::move(joining).pieces();
    return result;
}

} // namespace isotet::io
