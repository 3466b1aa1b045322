// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The C functions: each is one call of the public C++ ones.
#include <algorithm>
#include <atomic>
#include <cstring>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <isotet/contour.hpp>
#include <isotet/grid.hpp>
#include <isotet/isotet.h>
#include <isotet/read.hpp>
#include <isotet/surface.hpp>
#include <isotet/version.hpp>
#include <isotet/write.hpp>

#include "base/errors.hpp"
#include "base/guard.hpp"
#include "grid/cells.hpp"

namespace isotet {

namespace {

static_assert(static_cast<int>(ErrorCode::invalid_argument) + 1 == ISOTET_INVALID_ARGUMENT);
static_assert(static_cast<int>(ErrorCode::out_of_memory) + 1 == ISOTET_OUT_OF_MEMORY);
static_assert(static_cast<int>(ErrorCode::internal) + 1 == ISOTET_INTERNAL);
static_assert(static_cast<int>(ScalarType::int8) == ISOTET_INT8);
static_assert(static_cast<int>(ScalarType::float64) == ISOTET_FLOAT64);
static_assert(static_cast<int>(Normals::vertex) == ISOTET_VERTEX_NORMALS);

thread_local std::string last_error;

isotet_status failed(const Error& error) noexcept {
    try {
        last_error = error.message;
    } catch (...) {
        last_error.clear();
    }
    return static_cast<isotet_status>(static_cast<int>(error.code) + 1);
}

isotet_status status_of(const Result<void>& result) noexcept { return result ? ISOTET_OK : failed(result.error()); }

Error is_null(std::string_view what) { return invalid_argument(std::string(what) + " is NULL"); }

/// Takes the caller's memory over, whatever becomes of it.
Result<Array> array_of(const isotet_array* given, std::string_view what) {
    if (!given || given->rows == 0) {
        if (given && given->release) given->release(given->context);
        return Array();
    }
    std::shared_ptr<const void> owner;
    if (given->release) owner.reset(given->data, [given = *given](const void*) { given.release(given.context); });
    const std::uint64_t columns = std::max<std::uint64_t>(given->columns, 1);
    if (!given->data) return is_null(std::string(what) + ".data");
    if (given->type < ISOTET_INT8 || given->type > ISOTET_FLOAT64)
        return invalid_argument(std::string(what) + ".type is " + std::to_string(static_cast<int>(given->type)) +
                                ", but must be one of isotet_type");
    if (given->rows > std::numeric_limits<std::int64_t>::max() / 8 / columns)
        return invalid_argument(std::string(what) + " has " + std::to_string(given->rows) + " rows of " +
                                std::to_string(columns) + " columns, more than memory can hold");
    return Array(static_cast<ScalarType>(given->type), given->data, given->rows, columns, std::move(owner));
}

isotet_array handed_out(const Array& array) {
    return {array.data(), static_cast<isotet_type>(array.type()), array.tuples(), array.components(), nullptr, nullptr};
}

} // namespace

} // namespace isotet

struct isotet_grid {
    isotet::Grid grid;
};

struct isotet_surface {
    isotet::Surface surface;
};

struct isotet_session {
    std::optional<isotet::Contour> contour;
    isotet::ContourOptions options;
    int threads = 0;
    isotet_progress progress = nullptr;
    void* progress_context = nullptr;
    std::atomic<bool> cancelled{false};

    isotet::Run run() {
        isotet::Run run{threads, {}};
        cancelled.store(false, std::memory_order_relaxed);
        if (!progress) return run;
        run.progress.cancel = &cancelled;
        run.progress.report = [this](std::string_view step, double fraction) {
            const std::string word(step);
            if (progress(progress_context, word.c_str(), fraction) != 0)
                cancelled.store(true, std::memory_order_relaxed);
        };
        return run;
    }
};

namespace isotet {

namespace {

std::vector<Field>& fields_of(Grid& grid, bool of_cells) { return of_cells ? grid.cell_fields : grid.point_fields; }
const std::vector<Field>& fields_of(const Grid& grid, bool of_cells) {
    return of_cells ? grid.cell_fields : grid.point_fields;
}

Result<ContourInput> input_of(const isotet_grid* grid, const char* field, const char* const* carried,
                              std::uint64_t carried_count, const Run& run) {
    if (!grid) return is_null("grid");
    if (carried_count > 0 && !carried) return is_null("carried");
    std::vector<std::string> names;
    for (std::uint64_t i = 0; i < carried_count; ++i) {
        if (!carried[i]) return is_null("carried[" + std::to_string(i) + "]");
        names.emplace_back(carried[i]);
    }
    return contour_input(grid->grid, field ? field : "", names, run);
}

/// What the caller's struct knows of the options.
Result<isotet_options> known_options(const isotet_options* given) {
    isotet_options options;
    isotet_default_options(&options);
    if (!given) return options;
    if (given->size < sizeof(std::size_t) + sizeof(int) || given->size > 4096)
        return invalid_argument("options.size is " + std::to_string(given->size) +
                                ", but must be sizeof(isotet_options)");
    std::memcpy(&options, given, std::min(given->size, sizeof(options)));
    if (options.normals < ISOTET_NO_NORMALS || options.normals > ISOTET_VERTEX_NORMALS)
        return invalid_argument("options.normals is " + std::to_string(static_cast<int>(options.normals)) +
                                ", but must be one of isotet_normals");
    return options;
}

Result<void> create_session(const isotet_grid* grid, const char* field, const char* const* carried,
                            std::uint64_t carried_count, const isotet_options* given, isotet_session** session) {
    if (!session) return is_null("session");
    const auto options = known_options(given);
    if (!options) return options.error();
    auto made = std::make_unique<isotet_session>();
    made->threads = options->threads;
    made->progress = options->progress;
    made->progress_context = options->progress_context;
    made->options.surfaces = options->surfaces;
    made->options.normals = static_cast<Normals>(options->normals);
    made->options.precision = options->float64 ? Precision::float64 : Precision::float32;
    made->options.edge_ends = options->edge_ends != 0;
    made->options.source_cells = options->source_cells != 0;
    made->options.split_cells = options->split_cells != 0;
    const Run run = made->run();
    auto input = input_of(grid, field, carried, carried_count, run);
    if (!input) return input.error();
    auto contour = Contour::create(*std::move(input), made->options, run);
    if (!contour) return contour.error();
    made->contour.emplace(*std::move(contour));
    *session = made.release();
    return {};
}

Result<void> extract_surfaces(isotet_session* session, const double* isovalues, std::uint64_t count,
                              isotet_surface** surfaces) {
    if (!session) return is_null("session");
    if (count > 0 && (!isovalues || !surfaces)) return is_null(isovalues ? "surfaces" : "isovalues");
    auto result = session->contour->extract({isovalues, count}, session->run());
    if (!result) return result.error();
    std::vector<std::unique_ptr<isotet_surface>> made;
    for (Extraction& extraction : result->surfaces)
        made.push_back(std::make_unique<isotet_surface>(std::move(extraction.surface)));
    for (std::size_t i = 0; i < made.size(); ++i) surfaces[i] = made[i].release();
    return {};
}

Result<void> create_grid(const isotet_array* points, const isotet_array* connectivity, const isotet_array* offsets,
                         const isotet_array* types, std::uint8_t cell_type, isotet_grid** grid) {
    auto made = std::make_unique<isotet_grid>();
    Result<void> wrong;
    const auto take = [&](const isotet_array* given, std::string_view what, Array& array) {
        auto taken = array_of(given, what);
        if (taken) array = *std::move(taken);
        else if (wrong) wrong = taken.error();
    };
    take(points, "points", made->grid.points);
    take(connectivity, "connectivity", made->grid.cells.connectivity);
    take(offsets, "offsets", made->grid.cells.offsets);
    take(types, "types", made->grid.cells.types);
    if (!wrong) return wrong;
    if (!grid) return is_null("grid");
    made->grid.cells.uniform_type = static_cast<CellType>(cell_type);
    if (const auto cells = core::CellReader::open(made->grid); !cells) return cells.error();
    *grid = made.release();
    return {};
}

} // namespace

} // namespace isotet

using namespace isotet;

const char* isotet_version(void) { return ISOTET_VERSION; }

const char* isotet_last_error(void) { return last_error.c_str(); }

isotet_status isotet_grid_read(const char* path, uint64_t step, int threads, isotet_grid** grid) {
    return status_of(core::guarded("reading the grid", [&]() -> Result<void> {
        if (!path || !grid) return is_null(path ? "grid" : "path");
        ReadOptions options;
        if (step != ISOTET_FIRST_STEP) options.step = step;
        auto result = read(path, options, {threads, {}});
        if (!result) return result.error();
        *grid = new isotet_grid{std::move(result->grid)};
        return {};
    }));
}

isotet_status isotet_grid_create(const isotet_array* points, const isotet_array* connectivity,
                                 const isotet_array* offsets, const isotet_array* types, uint8_t cell_type,
                                 isotet_grid** grid) {
    return status_of(core::guarded("making the grid",
                                   [&] { return create_grid(points, connectivity, offsets, types, cell_type, grid); }));
}

isotet_status isotet_grid_add_field(isotet_grid* grid, const char* name, int of_cells, const isotet_array* values) {
    return status_of(core::guarded("adding a field", [&]() -> Result<void> {
        auto array = array_of(values, "values");
        if (!array) return array.error();
        if (!grid || !name || !values) return is_null(!grid ? "grid" : !name ? "name" : "values");
        const std::size_t rows = of_cells ? grid->grid.cells.count() : grid->grid.points.tuples();
        if (array->tuples() != rows)
            return invalid_argument("the field '" + std::string(name) + "' has " + std::to_string(array->tuples()) +
                                    " rows, but the grid has " + std::to_string(rows) +
                                    (of_cells ? " cells" : " points"));
        std::vector<Field>& fields = fields_of(grid->grid, of_cells != 0);
        const auto old = std::ranges::find(fields, std::string_view(name), &Field::name);
        if (old != fields.end()) old->values = *std::move(array);
        else fields.push_back({name, *std::move(array)});
        return {};
    }));
}

uint64_t isotet_grid_cells(const isotet_grid* grid) { return grid ? grid->grid.cells.count() : 0; }

void isotet_grid_points(const isotet_grid* grid, isotet_array* points) {
    if (points) *points = handed_out(grid ? grid->grid.points : Array());
}

uint64_t isotet_grid_fields(const isotet_grid* grid, int of_cells) {
    return grid ? fields_of(grid->grid, of_cells != 0).size() : 0;
}

const char* isotet_grid_field_name(const isotet_grid* grid, int of_cells, uint64_t number) {
    if (number >= isotet_grid_fields(grid, of_cells)) return nullptr;
    return fields_of(grid->grid, of_cells != 0)[number].name.c_str();
}

void isotet_grid_free(isotet_grid* grid) { delete grid; }

void isotet_default_options(isotet_options* options) {
    if (!options) return;
    *options = {};
    options->size = sizeof(isotet_options);
}

isotet_status isotet_session_create(const isotet_grid* grid, const char* field, const char* const* carried,
                                    uint64_t carried_count, const isotet_options* options, isotet_session** session) {
    return status_of(core::guarded(
        "making the session", [&] { return create_session(grid, field, carried, carried_count, options, session); }));
}

isotet_status isotet_session_set(isotet_session* session, const isotet_grid* grid, const char* field,
                                 const char* const* carried, uint64_t carried_count) {
    return status_of(core::guarded("setting the session", [&]() -> Result<void> {
        if (!session) return is_null("session");
        const Run run = session->run();
        auto input = input_of(grid, field, carried, carried_count, run);
        if (!input) return input.error();
        const auto update = session->contour->set(*std::move(input), run);
        if (!update) return update.error();
        return {};
    }));
}

isotet_status isotet_session_range(isotet_session* session, double* lower, double* upper) {
    return status_of(core::guarded("finding the range", [&]() -> Result<void> {
        if (!session || !lower || !upper) return is_null(!session ? "session" : !lower ? "lower" : "upper");
        const auto field = session->contour->field(session->run());
        if (!field) return field.error();
        *lower = field->lower;
        *upper = field->upper;
        return {};
    }));
}

isotet_status isotet_session_extract(isotet_session* session, const double* isovalues, uint64_t count,
                                     isotet_surface** surfaces) {
    return status_of(
        core::guarded("extracting", [&] { return extract_surfaces(session, isovalues, count, surfaces); }));
}

void isotet_session_free(isotet_session* session) { delete session; }

isotet_status isotet_surface_array(const isotet_surface* surface, isotet_surface_part part, isotet_array* array) {
    return status_of(core::guarded("handing out an array", [&]() -> Result<void> {
        if (!surface || !array) return is_null(surface ? "array" : "surface");
        const Surface& of = surface->surface;
        switch (part) {
        case ISOTET_POSITIONS: *array = handed_out(of.positions); return {};
        case ISOTET_TRIANGLES: *array = handed_out(of.triangles); return {};
        case ISOTET_NORMALS: *array = handed_out(of.normals); return {};
        case ISOTET_EDGE_ENDS: *array = handed_out(of.edge_ends); return {};
        case ISOTET_EDGE_WEIGHTS: *array = handed_out(of.edge_weights); return {};
        case ISOTET_SOURCE_CELLS: *array = handed_out(of.source_cells); return {};
        }
        return invalid_argument("part is " + std::to_string(static_cast<int>(part)) +
                                ", but must be one of isotet_surface_part");
    }));
}

isotet_status isotet_surface_field(const isotet_surface* surface, const char* name, isotet_array* values) {
    return status_of(core::guarded("handing out a field", [&]() -> Result<void> {
        if (!surface || !name || !values) return is_null(!surface ? "surface" : !name ? "name" : "values");
        for (const auto* fields : {&surface->surface.point_fields, &surface->surface.cell_fields})
            for (const Field& field : *fields)
                if (field.name == name) {
                    *values = handed_out(field.values);
                    return {};
                }
        return invalid_argument("the surface carries no field '" + std::string(name) + "'");
    }));
}

double isotet_surface_area(const isotet_surface* surface) { return surface ? area(surface->surface) : 0; }

isotet_status isotet_surface_write(const isotet_surface* surface, const char* path) {
    return status_of(core::guarded("writing the surface", [&]() -> Result<void> {
        if (!surface || !path) return is_null(surface ? "path" : "surface");
        const auto written = write_surface(surface->surface, path);
        if (!written) return written.error();
        return {};
    }));
}

void isotet_surface_free(isotet_surface* surface) { delete surface; }
