// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/first_view.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include <isotet/fields.hpp>
#include <isotet/grid.hpp>

#include "grid/cells.hpp"
#include "fields/cell_corners_sample.hpp"
#include "fields/name_kind.hpp"
#include "fields/sampled_values.hpp"
#include "fields/sampled_view.hpp"
#include "grid/values/scalar_of.hpp"
#include "grid/patches.hpp"

namespace isotet {

namespace {

/// Where it comes among the candidates: what is marked, then quantities, then the rest, then tensors; points before cells.
struct Place {
    bool unmarked = true;
    int rank = 0;
    Association association = Association::point;
    friend auto operator<=>(const Place&, const Place&) = default;
};

struct PlacedCandidate {
    Place place;
    FirstCandidate candidate;
};

constexpr int rank_of_plain_names = 1000, rank_of_tensors = 2000;

std::optional<PlacedCandidate> placed(const std::string& name, const std::vector<std::string>& arrays,
                                      std::size_t components, Association association, bool marked) {
    const core::RankedName ranked = core::rank_name(name, components);
    if (ranked.kind == core::NameKind::bookkeeping || ranked.kind == core::NameKind::region) return std::nullopt;
    const bool plain = ranked.kind == core::NameKind::plain, tensor = components > 3;
    PlacedCandidate found;
    found.place = {!marked,
                   marked   ? 0
                   : tensor ? rank_of_tensors
                   : plain  ? rank_of_plain_names
                            : ranked.rank,
                   association};
    found.candidate = {components > 1 ? name + ":mag" : name, association, arrays,
                       marked   ? FirstReason::marked
                       : tensor ? FirstReason::only
                       : plain  ? FirstReason::variation
                                : FirstReason::name};
    return found;
}

/// What a look at some of its values tells of a field.
struct Judged {
    bool varies = false;
    bool whole = false;     ///< whole numbers
    bool few = false;       ///< so few different integers that they number parts
    bool counts_up = false; ///< numbers points or cells one after another
    bool rough = false;
    double variation = 0;
};

const Field* field_called(const std::vector<Field>& fields, const std::string& name) {
    const auto found = std::ranges::find(fields, name, &Field::name);
    return found == fields.end() ? nullptr : &*found;
}

/// The array that a candidate stands for; nothing where the grid does not hold it.
std::optional<Array> array_of(const Grid& grid, const FirstCandidate& candidate) {
    const auto& fields = candidate.association == Association::point ? grid.point_fields : grid.cell_fields;
    if (candidate.arrays.size() == 1) {
        const Field* field = field_called(fields, candidate.arrays[0]);
        return field ? std::optional(field->values) : std::nullopt;
    }
    for (const std::string& part : candidate.arrays)
        if (!field_called(fields, part)) return std::nullopt;
    Result<Field> gathered = gather_components(fields, candidate.name, candidate.arrays);
    return gathered ? std::optional(gathered->values) : std::nullopt;
}

/// Where values are 1, 2, 3 and so on, or 0, 1, 2.
bool counts_up(const Array& values) {
    if (values.components() != 1 || values.tuples() < 3) return false;
    const double first = values.at(0);
    for (const std::size_t place : {std::size_t{1}, values.tuples() / 2, values.tuples() - 1})
        if (values.at(place) != first + static_cast<double>(place)) return false;
    return true;
}

/// Of at most a sample: sorted.
bool has_few_values(std::vector<double> values) {
    constexpr std::ptrdiff_t most_parts = 64;
    std::ranges::sort(values);
    return std::unique(values.begin(), values.end()) - values.begin() <= most_parts;
}

bool has_two_values(const std::vector<double>& sample) {
    constexpr double largest_value = 1e100, least_share = 1e-7;
    if (sample.empty()) return false;
    const auto [low, high] = std::ranges::minmax(sample);
    const double size = std::max(std::abs(low), std::abs(high));
    return size <= largest_value && high - low > least_share * size;
}

/// A point field whose twin, the cell field of the same name, does not vary.
bool varies_at_walls_alone(const Grid& grid, const FirstCandidate& candidate) {
    if (candidate.association != Association::point || candidate.arrays.size() != 1) return false;
    const Field* twin = field_called(grid.cell_fields, candidate.arrays[0]);
    if (!twin || twin->values.empty()) return false;
    const core::SampledValues sample = core::sample_values(twin->values);
    return !sample.values.empty() && !has_two_values(sample.values);
}

class Judge {
public:
    explicit Judge(const Grid& grid, std::span<const std::uint64_t> sampled = {}) : grid_(grid), sampled_(sampled) {}

    Judged judge(const Array& values, Association association) {
        Judged judged;
        const core::SampledValues sample = core::sample_values(values);
        judged.varies = has_two_values(sample.values) && has_values_in_cells(values, association);
        if (!judged.varies) return judged;
        judged.whole = core::holds_whole_numbers(values, sample);
        const bool may_number = !is_floating(values.type()) || association == Association::cell;
        judged.few = judged.whole && may_number && has_few_values(sample.values);
        judged.counts_up = judged.whole && counts_up(values);
        judged.variation = core::variation_of(sample);
        judged.rough = is_rough(values, association);
        return judged;
    }

    bool is_one_cell_thick() { return cells().is_one_cell_thick(); }

    /// False once a field had no value in the cells of a sample.
    bool is_sure() const { return is_sure_; }

private:
    /// Whether a cell with a volume has a value; all are looked at where those of the sample have none.
    bool has_values_in_cells(const Array& values, Association association) {
        if (cells().has_values(values, association)) return true;
        is_sure_ = is_sure_ && sampled_.empty();
        if (!sampled_.empty()) return true;
        const auto all = core::CellReader::open(grid_);
        if (!all) return true;
        const core::Scalar scalar{0, values.components() > 1};
        const auto has_value = [&](std::uint64_t item) {
            return item < values.tuples() && std::isfinite(core::scalar_at(values, scalar, item));
        };
        for (std::size_t cell = 0; cell < all->count(); ++cell) {
            if (!core::has_a_volume(all->type(cell))) continue;
            if (association == Association::cell) {
                if (has_value(cell)) return true;
                continue;
            }
            const std::uint64_t first = all->first(cell), end = first + all->corners(cell);
            for (std::uint64_t i = first; i < end && i < all->connectivity_size(); ++i)
                if (has_value(all->corner(i))) return true;
        }
        return false;
    }

    const core::CellCornersSample& cells() {
        if (!cells_) cells_.emplace(grid_, sampled_);
        return *cells_;
    }

    bool is_rough(const Array& values, Association association) {
        // Noise has 1, a front one cell wide 0.6, random porosity with a range of some cells more than 0.5.
        constexpr double times_linear = 4;
        const double noise = association == Association::point ? 0.8 : 0.5;
        const double roughness = cells().roughness(values, association);
        return roughness > noise && roughness > times_linear * cells().roughness_of_linear_fields();
    }

    const Grid& grid_;
    std::span<const std::uint64_t> sampled_;
    std::optional<core::CellCornersSample> cells_;
    bool is_sure_ = true;
};

FirstView view_of(const FirstCandidate& candidate, FirstDraw draw, FirstReason reason) {
    return {draw, candidate.name, candidate.association, reason, false};
}

/// Whether whole numbers with a name that says nothing number something.
bool is_numbering(const FirstCandidate& candidate, const Judged& judged) {
    return candidate.reason == FirstReason::variation && judged.whole &&
           (judged.few || judged.counts_up || candidate.association == Association::cell);
}

/// Fields of numbers of regions and materials; what else has few whole numbers comes after them.
FirstView regions_of(const Grid& grid, const std::vector<FieldInfo>& fields, Judge& judge) {
    for (const core::NameKind kind : {core::NameKind::region, core::NameKind::plain})
        for (const Association association : {Association::cell, Association::point})
            for (const FieldInfo& field : fields) {
                if (field.association != association || core::rank_name(field.name, 1).kind != kind) continue;
                const auto values = array_of(grid, {field.name, association, {field.name}, {}});
                if (!values || values->components() != 1) continue;
                const Judged judged = judge.judge(*values, association);
                if (judged.varies && judged.whole && judged.few && !judged.counts_up)
                    return {FirstDraw::regions_on_boundary, field.name, association, FirstReason::only, false};
            }
    return {};
}

/// A region's name with values that are no whole numbers: a field like others.
void add_named_as_regions(const std::vector<FieldInfo>& fields, std::vector<FirstCandidate>& candidates) {
    for (const FieldInfo& field : fields)
        if (field.components == 1 && is_floating(field.type) &&
            core::rank_name(field.name, 1).kind == core::NameKind::region)
            candidates.push_back({field.name, field.association, {field.name}, FirstReason::variation});
}

} // namespace

std::string_view text_of(FirstReason reason) noexcept {
    switch (reason) {
    case FirstReason::marked: return "the file marks it";
    case FirstReason::name: return "its name";
    case FirstReason::variation: return "it varies most";
    case FirstReason::only: return "nothing better varies";
    case FirstReason::nothing: break;
    }
    return "no field varies that would be contoured";
}

std::vector<FirstCandidate> first_candidates(const std::vector<FieldInfo>& fields) {
    std::vector<PlacedCandidate> found;
    const auto add = [&](std::optional<PlacedCandidate> one) {
        if (one) found.push_back(*std::move(one));
    };
    for (const Association association : {Association::point, Association::cell}) {
        std::vector<std::string> scalars, parts;
        for (const FieldInfo& field : fields)
            if (field.association == association && field.components == 1) scalars.push_back(field.name);
        for (const ComponentGroup& group : component_groups(scalars)) {
            parts.insert(parts.end(), group.parts.begin(), group.parts.end());
            add(placed(group.name, group.parts, group.parts.size(), association, false));
        }
        for (const FieldInfo& field : fields) {
            const bool is_part = std::ranges::find(parts, field.name) != parts.end();
            const bool is_one = field.components <= 3 || field.components == 6 || field.components == 9;
            if (field.association != association || !is_one || (is_part && !field.active)) continue;
            add(placed(field.name, {field.name}, field.components, association, field.active));
        }
    }
    std::ranges::stable_sort(found, {}, &PlacedCandidate::place);
    std::vector<FirstCandidate> candidates;
    for (PlacedCandidate& one : found) candidates.push_back(std::move(one.candidate));
    return candidates;
}

std::vector<FieldInfo> describe_fields(const Grid& grid) {
    std::vector<FieldInfo> infos;
    for (const auto& [fields, association] :
         {std::pair{&grid.point_fields, Association::point}, {&grid.cell_fields, Association::cell}})
        for (const Field& field : *fields)
            infos.push_back({field.name, association, field.values.type(), field.values.components()});
    return infos;
}

namespace {

FirstView chosen_view(const Grid& grid, const std::vector<FieldInfo>& fields, bool flat, Judge& judge) {
    std::vector<FirstCandidate> candidates = first_candidates(fields);
    add_named_as_regions(fields, candidates);
    const FirstDraw surfaces =
        flat || judge.is_one_cell_thick() ? FirstDraw::field_on_boundary : FirstDraw::isosurfaces;
    const FirstCandidate* best = nullptr;
    const FirstCandidate* rough = nullptr;
    const FirstCandidate* at_walls = nullptr;
    double most = 0;
    for (const FirstCandidate& candidate : candidates) {
        const bool named = candidate.reason != FirstReason::variation;
        if (candidate.reason == FirstReason::only && (best || rough || at_walls)) break; // a tensor
        if (rough && rough->reason != FirstReason::variation && !named) break;
        const auto values = array_of(grid, candidate);
        if (!values) continue;
        const Judged judged = judge.judge(*values, candidate.association);
        if (!judged.varies || is_numbering(candidate, judged)) continue;
        if (varies_at_walls_alone(grid, candidate)) {
            if (!at_walls) at_walls = &candidate;
            continue;
        }
        if (judged.rough) {
            if (!rough) rough = &candidate;
            continue;
        }
        if (named) return view_of(candidate, surfaces, candidate.reason);
        if (judged.variation <= most) continue;
        best = &candidate;
        most = judged.variation;
    }
    if (best) return view_of(*best, surfaces, FirstReason::variation);
    if (rough) {
        FirstView view = view_of(*rough, FirstDraw::field_on_boundary, rough->reason);
        view.rough = true;
        return view;
    }
    if (at_walls) {
        FirstView view = view_of(*at_walls, surfaces, at_walls->reason);
        view.walls = true;
        return view;
    }
    return regions_of(grid, fields, judge);
}

/// Whether a cell has an inside that isosurfaces could be in.
bool has_cells_to_cut(const Cells& cells) {
    if (cells.types.type() != ScalarType::uint8 || cells.types.empty())
        return core::has_a_volume(static_cast<std::uint8_t>(cells.uniform_type));
    return std::ranges::any_of(cells.types.as<std::uint8_t>(), core::has_a_volume);
}

} // namespace

FirstView first_view(const Grid& grid, const std::vector<FieldInfo>& fields) {
    return core::first_view_of_sample(grid, fields, {});
}

FirstView core::first_view_of_sample(const Grid& grid, const std::vector<FieldInfo>& fields,
                                     std::span<const std::uint64_t> numbers, bool* is_sure) {
    const bool flat = has_only_flat_cells(grid.cells);
    const bool empty = !flat && !has_cells_to_cut(grid.cells);
    Judge judge(grid, numbers);
    FirstView view = empty ? FirstView() : chosen_view(grid, fields, flat, judge);
    view.empty = empty;
    view.flat = flat;
    if (is_sure) *is_sure = judge.is_sure();
    return view;
}

bool field_varies(const Grid& grid, std::string_view name) {
    return core::field_varies_in_sample(grid, name, {}).value_or(true);
}

std::optional<bool> core::field_varies_in_sample(const Grid& grid, std::string_view name,
                                                 std::span<const std::uint64_t> numbers) {
    const Result<PointField> field = find_field(grid, name);
    if (!field) return false;
    Judge judge(grid, numbers);
    const bool varies = judge.judge(field->values, Association::point).varies;
    if (!judge.is_sure()) return std::nullopt;
    if (!varies) return false;
    const std::string array(field_called(grid.point_fields, std::string(name)) ? name
                                                                               : name.substr(0, name.rfind(':')));
    return !varies_at_walls_alone(grid, {array, Association::point, {array}, {}});
}

} // namespace isotet
