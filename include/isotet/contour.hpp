// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <isotet/engine.hpp>
#include <isotet/export.hpp>
#include <isotet/extract.hpp>
#include <isotet/grid.hpp>
#include <isotet/linear_cells.hpp>
#include <isotet/pack.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>

namespace isotet {

// How surfaces are made: the rule that chooses a method, and what it is expected to take.

/// From a grid to its surfaces. Both give the same surfaces; the order of vertices and triangles differs.
enum class Method : std::uint8_t {
    direct,   ///< goes through all cells for each surface (extract.hpp)
    clusters, ///< packs the grid once (pack.hpp), then extracts from the clusters that an isovalue can cut
};

/// "direct", "clusters".
ISOTET_API std::string_view name_of(Method method) noexcept;

/// Packing pays from so many surfaces of one grid on, isovalues times fields: direct extraction takes longer than
/// packing and extracting from clusters (docs/inside/choice.md). With gradient normals, for which direct
/// extraction goes through all cells twice more, much earlier.
inline constexpr std::uint64_t surfaces_that_pay_for_packing = 32;
inline constexpr std::uint64_t surfaces_with_gradients_that_pay_for_packing = 4;

/// What was asked for, else by the rule. Always the same for the same arguments.
constexpr Method method_for(std::uint64_t surfaces, bool gradient_normals,
                            std::optional<Method> asked_for = {}) noexcept {
    const std::uint64_t pays =
        gradient_normals ? surfaces_with_gradients_that_pay_for_packing : surfaces_that_pay_for_packing;
    return asked_for.value_or(surfaces < pays ? Method::direct : Method::clusters);
}

/// A few of a grid's cells, to tell beforehand how large surfaces will be.
class ISOTET_API FieldSample {
public:
    static constexpr std::uint64_t max_cells = std::uint64_t{1} << 14;

    /// Looks at up to `max_cells` cells, spread evenly over their numbers: at all cells of a grid that has no more.
    /// Broken cells are passed over: reading and packing report them.
    ///
    /// `split_cells`   as PackOptions::split_cells
    /// Cost     a few milliseconds
    /// Errors   invalid_argument when the field does not fit the grid; invalid_data when the arrays of the grid do not
    ///          fit together; out_of_memory
    static Result<FieldSample> create(const Grid& grid, const PointField& field, bool split_cells = false);

    std::uint64_t points() const noexcept { return points_; } ///< of the grid
    /// Of the grid; exact where all cells are tets. Elsewhere as many as take the time and memory that its cells take.
    std::uint64_t tets() const noexcept { return tets_; }
    double lower() const noexcept { return lower_; } ///< of the values seen; lower > upper: none is finite
    double upper() const noexcept { return upper_; }

    /// Triangles of an isovalue's surface, estimated. Of a surface that cuts few cells the estimate is rough: from t
    /// active tets in the sample it is wrong by about a part of 1 / sqrt(t).
    double triangles(double isovalue) const noexcept;

private:
    struct Range {
        double lower, upper, triangles;
    };
    class Looker;
    std::vector<Range> cells_seen_; ///< with data at all corners and different values
    double cells_each_ = 0;         ///< of the grid, for each one looked at
    std::uint64_t points_ = 0, tets_ = 0;
    double lower_ = 0, upper_ = -1;
};

/// What is to be made of one grid.
struct Workload {
    std::uint64_t points = 0, tets = 0;
    double surfaces = 1;           ///< isovalues times fields
    bool gradients = false;        ///< gradient normals are asked for
    bool find_range = false;       ///< isovalues follow the range of the field, which direct extraction looks for first
    double triangles = 0;          ///< of a surface, on the average
    double triangles_together = 0; ///< of the surfaces that are in memory at the same time, at most
};

/// What a method is expected to take, without reading and writing files.
struct Estimate {
    double seconds = 0;      ///< on two threads of an ordinary machine: tells minutes from seconds
    std::uint64_t bytes = 0; ///< needed beyond the grid, at the peak; rather too many than too few. Memory that is free
                             ///< is used beyond that, to keep blocks for later: up to 1/64 of the machine's
};

/// `workload`   numbers that are finite and not negative
ISOTET_API Estimate estimate(Method method, const Workload& workload) noexcept;

// A session: a grid, a field and a way to answer isovalues. What a command, a slider, a pipeline filter and a time
// series share.

struct ContourInput;

/// What is known of a grid that is a part of another.
struct GridPart {
    /// Set where cells are missing that an ActiveCellFilter did not keep (active_cells.hpp) for the expected isovalues: gives
    /// `grid`, `cell_fields` and `part` of the input with all cells, and is called when something needs them. What else the
    /// input has stays: it is of points, of which none are missing.
    std::function<Result<ContourInput>(const Run& run)> whole = {};
    Array cell_numbers = {}; ///< of the cells in the other grid, uint64: for source cells. Empty: they are the same
    bool has_cells_around = false; ///< of the missing cells there are those that gradient normals need
};

/// What is contoured, and what surfaces carry. Arrays are shared; borrowed ones must live until the next set().
struct ContourInput {
    Grid grid;                         ///< its own fields are not looked at
    PointField field;                  ///< to contour
    std::vector<Field> point_fields;   ///< carried onto surfaces, as ExtractOptions::point_fields
    std::vector<Field> cell_fields;    ///< as ExtractOptions::cell_fields
    std::optional<GridPart> part = {}; ///< `cell_fields` are of the cells that are there
    /// In place of `grid` and `field`: a packed grid, of a PackedFile say. Surfaces come from its clusters as they are: the
    /// options must not ask for what was not packed.
    std::optional<PackedGrid> packed = {};
    std::vector<PackedGrid> packed_fields = {}; ///< carried, as ExtractOptions::packed_fields; of `packed` only

    bool lacks_cells() const noexcept { return part && part->whole; }
};

struct ContourOptions {
    /// Nothing: by the rule of method_for() for `surfaces`; where packing then finds too little memory, direct
    /// extraction if that fits, with a note. Some engines take clusters only.
    std::optional<Method> method = {};
    /// How many surfaces will be asked for, over all fields and time steps. 0: not known; then those that have been
    /// asked for are counted, and the grid is packed when the rule says so.
    std::uint64_t surfaces = 0;
    std::shared_ptr<const Engine> engine = cpu_engine(); ///< or vulkan_engine(), device.hpp
    bool engine_required = false; ///< what the engine cannot do is an error; else the CPU does it, with a note
    Precision precision = Precision::float32;
    Ties ties = Ties::merge;
    Normals normals = Normals::none;
    bool edge_ends = false;
    bool source_cells = false;
    bool split_cells = false;        ///< as PackOptions::split_cells
    std::optional<Frame> frame = {}; ///< as PackOptions::frame; for another field or time step, set() takes another
    /// Quadratic cells are refined in extract(), for its isovalues and the field at hand, so that the tolerance holds for
    /// each surface; RefineOptions::isovalues are those that come first, and are refined for together. Nothing: they are
    /// split at their nodes, once for all isovalues, fields and steps, and a note gives the bound.
    std::optional<RefineOptions> refine = {};
    /// extract() puts vertices to where the quadratic field of curved cells has the isovalue on their edges, which may be
    /// curved themselves, and point fields with them. Gradient normals stay those of the tets. Grids without curved cells
    /// have no such edges. Costs edge ends and source cells for a while.
    bool exact_vertices = false;
    /// Isovalues that will be asked for first: where they are extracted directly, only the polyhedra that they meet are made
    /// linear, unless something needs the others (gradients, edge ends, a frame, integers, values that are scaled when they
    /// are stored). The surfaces are the same. Another isovalue makes all linear.
    std::vector<double> expected_isovalues = {};
    /// What is packed has gradients and the cells of tets, so that normals and cell fields that are asked for later do not
    /// pack again: 4 bytes a point and 4 a tet.
    bool pack_all = false;
    /// Contour::prepare() packs beside calls of other threads, which extract directly until it is done: the first surface
    /// comes at once, the same triangles in the order of direct extraction. Another grid is extracted directly, too, until
    /// prepare() packs it. For engines that extract directly and keep no grid, `method` not set.
    bool extract_while_packing = false;
    /// As ExtractOptions::sink. What is not as the engine made it (source cells of cells that were made linear, vertices that were
    /// moved) is copied there.
    std::shared_ptr<SurfaceSink> sink = {};
};

/// What set() had to do.
enum class ContourUpdate : std::uint8_t {
    nothing, ///< grid and field are the ones from before
    field,   ///< the same cells and points: only values were stored, or are read
    points,  ///< the same cells: points moved, and values were stored
    grid,    ///< another grid: what was packed is gone
};

/// The surfaces of one call, and how they came about.
struct ContourResult {
    std::vector<Extraction> surfaces; ///< in the order of the isovalues
    Method method = Method::direct;
    std::string_view engine; ///< Engine::name() of the one that extracted the last surface
    FieldReport field;
    std::uint64_t cells_left_out = 0; ///< cells of types that are not contoured
    std::uint64_t coarse_tets = 0;    ///< of direct extraction, as DirectExtraction::coarse_tets
    double pack_seconds = 0;    ///< making cells linear, packing, or storing another field or points, and uploading,
                                ///< since the extraction before; 0 where nothing was to be done
    double extract_seconds = 0; ///< downloading included
    DeviceWork work;            ///< on the device, of the last surface
    std::uint64_t file_bytes_read = 0; ///< of a packed file, by this call
    std::uint64_t file_bytes_kept = 0; ///< of a packed file, in memory after it
    std::vector<std::string> notes;    ///< sentences for the user
    RefinementReport refinement;       ///< of the grid that was extracted from; without curved cells nothing is counted
};

/// Answers isovalues for one grid at a time, and keeps what may be kept when the grid or the field changes.
///
/// Polyhedra are made linear cells first (linearize()): fields are continued for derived points, source_cells are the
/// user's, and edge ends from the number of the user's points on are derived points, which linear_grid() tells. packed() and
/// use_grid() have the linear cells. The same cells keep their derived points when fields, steps or points change.
///
/// Quadratic cells likewise; with ContourOptions::refine each call of extract() for isovalues that it is not refined for
/// refines again, after another field or step too. Then prepare() has nothing to do, packed() has what the last extract()
/// packed, and use_grid() and predict() know the isovalues in RefineOptions only.
///
/// Guarantees   the same calls give the same bytes, on every machine, for any thread count and on every engine, except
///              where a note says that another method was taken for want of memory
/// Threads      extract() of many threads at once where nothing is to be packed and no device is used, else one call at
///              a time: calls wait for each other, but see ContourOptions::extract_while_packing. A call is stopped
///              through its own Run::progress; a slider cancels the call for a stale isovalue and makes the next
class ISOTET_API Contour {
public:
    /// True where a session with these options has use for GridPart::whole: surfaces of the expected isovalues,
    /// extracted directly by the CPU, without what needs all cells.
    static bool can_do_with_active_cells(const ContourOptions& options);

    /// Checks that the field fits the grid, and makes linear cells of others; nothing is packed yet.
    ///
    /// Errors   invalid_argument when a field does not fit the grid, options contradict each other, or they ask for more than
    ///          ContourInput::packed has; invalid_data when
    ///          the arrays of the grid do not fit together; cancelled
    static Result<Contour> create(ContourInput input, const ContourOptions& options = {}, const Run& run = {});

    /// Whether cells of this type, a number of VTK's, are contoured as they are (polyhedra with their faces). Others are split
    /// first (quadratic ones, linear_cells.hpp), or left out, and counted in ContourResult::cells_left_out.
    static bool contours(std::uint8_t vtk_type) noexcept;

    Contour(Contour&&) noexcept;
    Contour& operator=(Contour&&) noexcept;
    ~Contour();

    /// Another grid, field or time step. What is the same as before is found out: by the memory and owner of arrays,
    /// else by their contents, and is not packed again. An array that was changed in place needs another owner.
    ///
    /// Cost     at most one pass over the arrays, at the speed of memory, and what the next extract() packs
    /// Errors   as create(); the session is then as before
    Result<ContourUpdate> set(ContourInput input, const Run& run = {});

    /// The same with other options. The grid is packed again where it was packed in another precision, or without the
    /// gradients or the cells' numbers that the options need.
    Result<ContourUpdate> set(ContourInput input, const ContourOptions& options, const Run& run = {});

    /// Surfaces of isovalues, in their order: all in one pass by the CPU engine, one after another on a device.
    ///
    /// Errors   as pack(), extract() and extract_direct(); of a required device: as DeviceGrid. The session stays usable
    Result<ContourResult> extract(std::span<const double> isovalues, const Run& run = {});
    Result<ContourResult> extract(double isovalue, const Run& run = {});

    /// Calls `work` with the grid that the engine keeps, packed and up to date, and with what surfaces of the session
    /// have, while no other call of the session runs.
    /// For engines with more to offer than surfaces in memory: extract_on_device(), say.
    ///
    /// `surfaces`   how many will be asked for
    /// Errors   as pack(); of the engine; invalid_argument when the engine keeps no grid, or was given up; those of
    ///          `work`
    Result<void> use_grid(std::size_t surfaces,
                          const std::function<Result<void>(EngineGrid&, const ExtractOptions&)>& work,
                          const Run& run = {});

    /// Packs now what the first extract() would pack; nothing where surfaces are extracted directly. With
    /// ContourOptions::extract_while_packing whatever the rule says, and what the session has when it is done: what set() has
    /// changed meanwhile is packed after.
    /// Errors   as pack(); the session goes on as before
    Result<void> prepare(const Run& run = {});

    /// The next call with so many isovalues extracts by this method, memory permitting.
    Method method(std::size_t isovalues = 1) const;

    /// What a surface is expected to be and take, before it is asked for.
    struct Prediction {
        double triangles = 0;
        Estimate estimate;
    };
    Result<Prediction> predict(double isovalue) const;

    /// What predictions are made of: a sample of the cells that the session has, of curved ones between their corners; none of
    /// ContourInput::packed.
    /// Errors   out_of_memory
    Result<FieldSample> sample() const;

    /// The range of the field, as extraction sees it. Cost   a pass over the grid where nothing is packed, once a field
    /// Errors   as extract()
    Result<FieldReport> field(const Run& run = {});

    /// The packed grid; nothing where surfaces are extracted directly, or before the first of them.
    std::optional<PackedGrid> packed() const;

    /// The linear cells that were made of the grid; null where all its cells are linear.
    std::shared_ptr<const LinearGrid> linear_grid() const;

    /// Engine::name() of the one that extracts next: "cpu" after a device failed and the CPU took over.
    std::string_view engine() const;

private:
    struct Data;
    explicit Contour(std::unique_ptr<Data> data);
    std::unique_ptr<Data> data_;
};

/// One isosurface, of which nothing is kept: for more than one make a Contour.
///
/// `points`   3 components;  `cells`   as Grid::cells;  `values`   a scalar for each point
/// Errors     as Contour::create() and Contour::extract()
ISOTET_API Result<Surface> contour(const Array& points, const Cells& cells, const Array& values, double isovalue,
                                   const Run& run = {});

/// The grid with the field of a name that find_field() takes, and what surfaces are to carry: fields of points, then of
/// cells, then what else find_field() takes.
///
/// Errors   as find_field()
ISOTET_API Result<ContourInput> contour_input(const Grid& grid, const std::string& field,
                                              const std::vector<std::string>& carried = {}, const Run& run = {});

} // namespace isotet
