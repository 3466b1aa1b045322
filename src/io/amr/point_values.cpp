// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/amr/point_values.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "base/buffer.hpp"
#include "base/parallel.hpp"
#include "grid/values/running_mean.hpp"
#include "io/amr/shared_points.hpp"

namespace isotet::io::amr {
namespace {

constexpr std::size_t values_per_part = 1 << 14;

const Array* field_called(const std::vector<Field>& fields, const std::string& name) {
    const auto found = std::ranges::find(fields, name, &Field::name);
    return found == fields.end() ? nullptr : &found->values;
}

/// A cell field of all boxes.
struct CellField {
    std::string name;
    std::size_t components = 1;
    bool is_single = true;              ///< of float32
    std::vector<const Array*> by_box{}; ///< null where a box does not have it
};

/// Fields that have the same number of components wherever they are, and no point field of their name.
std::vector<CellField> fields_of(const std::vector<Piece>& pieces) {
    std::vector<CellField> out;
    for (const Piece& piece : pieces)
        for (const Field& field : piece.grid.cell_fields)
            if (std::ranges::find(out, field.name, &CellField::name) == out.end())
                out.push_back({field.name, field.values.components()});
    for (CellField& field : out)
        for (const Piece& piece : pieces) {
            const Array* const values = field.by_box.emplace_back(field_called(piece.grid.cell_fields, field.name));
            if (values && values->components() != field.components) field.components = 0;
            if (values && values->type() != ScalarType::float32) field.is_single = false;
            if (field_called(piece.grid.point_fields, field.name)) field.components = 0;
        }
    std::erase_if(out, [](const CellField& field) { return field.components == 0; });
    return out;
}

/// In proportion to one over the length of a level's cells.
std::vector<double> weights_of(const Lattice& lattice) {
    std::vector<double> out;
    for (std::size_t level = 0; level < lattice.levels(); ++level) {
        std::int64_t length = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) length += lattice.steps(level, axis);
        out.push_back(3 / static_cast<double>(length));
    }
    return out;
}

class PointValues {
public:
    PointValues(const Hierarchy& hierarchy, const Lattice& lattice, const std::vector<Marks>& marks)
        : points_(hierarchy, lattice, marks), hanging_(points_.hanging()), weights_(weights_of(lattice)) {}

    /// All components of each shared point.
    core::Buffer<double> of(const CellField& field) {
        core::Buffer<double> out(points_.count() * field.components);
        core::parallel_each(points_.count(), values_per_part, [&](std::size_t point) {
            for (std::size_t c = 0; c < field.components; ++c)
                out[point * field.components + c] = mean(field, point, c);
        });
        for (const HangingPlace& at : hanging_)
            for (std::size_t c = 0; c < field.components; ++c) {
                const auto value = [&](std::size_t corner) { return out[at.of[corner] * field.components + c]; };
                double sum = value(0);
                for (std::size_t i = 1; i < at.corners; ++i) sum += at.weights[i] * (value(i) - value(0));
                out[at.point * field.components + c] = sum;
            }
        return out;
    }

    /// Those of the points of a box; NaN where no shown cell has one.
    template <class T>
    Array in_box(std::size_t box, const core::Buffer<double>& values, std::size_t components) const {
        const PlacedBox& placed = points_.boxes()[box];
        core::Buffer<T> out(placed.box.points() * components);
        core::parallel_each(placed.box.points(), values_per_part, [&](std::size_t at) {
            const std::uint64_t point = points_.at(placed.first_point + at);
            for (std::size_t c = 0; c < components; ++c)
                out[at * components + c] = point == SharedPoints::none ? std::numeric_limits<T>::quiet_NaN()
                                                                       : static_cast<T>(values[point * components + c]);
        });
        return std::move(out).to_array(components);
    }

private:
    double mean(const CellField& field, std::uint64_t point, std::size_t component) {
        core::RunningMean mean;
        for (const std::uint64_t cell : points_.cells_of(point)) {
            const std::size_t box = points_.box_number_of(cell);
            const PlacedBox& placed = points_.boxes()[box];
            if (!field.by_box[box]) continue;
            const double value = field.by_box[box]->at(cell - placed.first_cell, component);
            if (!std::isnan(value)) mean.add(value, weights_[placed.level]);
        }
        return mean.weights > 0 ? mean.mean : std::numeric_limits<double>::quiet_NaN();
    }

    SharedPoints points_;
    std::vector<HangingPlace> hanging_;
    std::vector<double> weights_; ///< by level
};

} // namespace

Result<void> add_point_values(const Hierarchy& hierarchy, const Lattice& lattice, const std::vector<Marks>& marks,
                              std::vector<Piece>& pieces, const Progress& progress) {
    const std::vector<CellField> fields = fields_of(pieces);
    if (fields.empty()) return {};
    PointValues at_points(hierarchy, lattice, marks);
    for (const CellField& field : fields) {
        if (progress.cancelled()) return Error{ErrorCode::cancelled, "reading was cancelled"};
        const core::Buffer<double> values = at_points.of(field);
        for (std::size_t box = 0; box < pieces.size(); ++box)
            pieces[box].grid.point_fields.push_back(
                {field.name, field.is_single ? at_points.in_box<float>(box, values, field.components)
                                             : at_points.in_box<double>(box, values, field.components)});
    }
    return {};
}

} // namespace isotet::io::amr
