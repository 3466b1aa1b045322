// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "jobs/extract_plan.hpp"

#include <algorithm>
#include <filesystem>
#include <set>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include <isotet/fields.hpp>
#include <isotet/grid_file.hpp>
#include <isotet/jobs/first_choice.hpp>
#include <isotet/jobs/number_text.hpp>
#include <isotet/isovalues.hpp>
#include <isotet/linear_cells.hpp>
#include <isotet/write.hpp>

#include "jobs/refuse.hpp"
#include "jobs/touched_region.hpp"

namespace isotet::jobs {

namespace {

/// What the format of OUT can hold.
struct Holds {
    bool fields = true, cell_fields = true;
    bool edge_ends = true; ///< and source cells
};

Result<Holds> holds(const ExtractJob& job) {
    if (job.out.empty()) return Holds{false, false, true};
    const Result<Format> format = format_for_writing(job.out, Writes::surface, job.compression);
    if (!format) return format.error();
    const bool vtk = format->name == "vtp" || format->name == "vtk";
    for (const auto& [asked, option] :
         {std::pair{job.contour.edge_ends, "`edge_ends`"}, {job.contour.source_cells, "`source_cells`"}}) {
        if (asked && !vtk) {
            return refusal("{} was asked for, but {} holds no such array: .vtp and .vtk do", option, format->name);
        }
    }
    if (job.reduce && (job.contour.edge_ends || job.contour.source_cells))
        return refusal("`reduce` was asked for, which leaves no `edge_ends` and `source_cells`: they belong to the "
                       "triangles of an isosurface as it is cut");
    const bool colored = vtk || format->name == "glb" || format->name == "ply" || format->name == "usda";
    if (!job.colors.by.empty() && !colored)
        return refusal("`color_by` was asked for, but {} holds no colours: .glb, .ply, .usda, .vtp and .vtk do",
                       format->name);
    const bool shape_only = format->name == "stl" || format->name == "obj" || format->name == "3mf";
    return Holds{!shape_only, vtk || format->name == "ply", vtk};
}

/// --with, or all point fields that the format can hold; nothing means all.
Result<std::optional<CarriedFields>> plan_carried(const ExtractJob& job, const GridSource& source,
                                                  bool format_holds_fields) {
    if (!job.with && format_holds_fields) return std::optional<CarriedFields>{};
    Result<CarriedFields> carried = choose_carried(source, job.with.value_or(std::vector<std::string>{}));
    if (!carried) return carried.error();
    return std::optional<CarriedFields>{*std::move(carried)};
}

/// What colours are computed from; nothing where a field has the name, which surfaces carry or not.
std::optional<FoundField> plan_color(const ExtractJob& job, const GridSource& source) {
    if (job.colors.by.empty()) return std::nullopt;
    Result<FoundField> found = choose_field(source, {job.colors.by, false});
    if (!found || !found->is_expression) return std::nullopt; // what the surface does not have is told when it is there
    return *std::move(found);
}

FieldsToRead fields_to_read(const ExtractPlan& plan) {
    FieldsToRead read;
    read.cell = plan.field.cell;
    if (plan.color) add_names(*read.cell, plan.color->cell);
    if (!plan.carried) return read; // all point fields
    read.point = plan.field.point;
    if (plan.color) add_names(*read.point, plan.color->point);
    add_names(*read.point, plan.carried->point);
    add_names(*read.cell, plan.carried->cell);
    for (const FoundField& component : plan.carried->components) {
        add_names(*read.point, component.point);
        add_names(*read.cell, component.cell);
    }
    return read;
}

/// Whether values at points follow from cells around them.
bool looks_around(const FoundField& field) { return !field.cell.empty() || field.neighbours; }

std::optional<ReadActiveCells> plan_active_cells(const ExtractJob& job, const ExtractPlan& plan) {
    const bool looks_around_others = (plan.color && looks_around(*plan.color)) ||
                                     (plan.carried && std::ranges::any_of(plan.carried->components, looks_around));
    const bool chosen = job.isovalues.empty() || !job.shares.empty(); // by the values
    const std::size_t named = job.isovalues.size() + job.shares.size();
    const std::size_t count = named > 0 ? named : std::max<std::uint64_t>(job.levels, 1);
    ContourOptions options = plan.contour;
    if (chosen) options.expected_isovalues.resize(count);
    const bool averages = is_averaged_while_read(plan.field, job.field);
    const bool needs_all = (looks_around(plan.field) && !averages) || job.snap ||
                           (chosen && (plan.steps.size() > 1 || !job.grid.cells.empty())) || job.piece || job.solid ||
                           job.volumes || job.grid.merge_points;
    if (needs_all || looks_around_others) return std::nullopt;
    std::optional<ReadActiveCells> active = active_cells_for(plan.field.name, options);
    if (!active) return active;
    active->shape = job.field.shape;
    active->averages = averages;
    active->isovalues = {};
    if (named > 0) active->isovalues = job.isovalues;
    else active->choose = RangeLevels{.count = count, .whole_range = true};
    active->shares = job.shares;
    return active;
}

/// `steps`   how many of them
ContourOptions contour_options_of(const ExtractJob& job, std::size_t steps) {
    ContourOptions options = job.contour;
    if (job.engine == EngineChoice::reference) options.engine = reference_engine();
    options.ties = job.keep_degenerate ? Ties::keep : Ties::merge;
    const std::size_t named = job.isovalues.size() + job.shares.size();
    const std::size_t isovalues = named == 0 ? std::max<std::uint64_t>(job.levels, 1) : named;
    options.surfaces = isovalues * steps;
    if (!job.snap && !job.solid && job.shares.empty()) options.expected_isovalues = job.isovalues;
    return options;
}

bool names_isovalues(const ExtractJob& job) { return !job.isovalues.empty() || !job.shares.empty() || job.levels > 0; }

bool uses_device(const ExtractJob& job) {
    return job.engine == EngineChoice::vulkan || (!job.device.name.empty() && job.device.name != "none");
}

/// What does not go together with solids.
Result<void> check_solid(const ExtractJob& job) {
    if (!job.solid) return {};
    for (const auto& [asked, option] : {std::pair{job.contour.exact_vertices, "`exact_vertices`"},
                                        {job.keep_degenerate, "`keep_degenerate`"},
                                        {job.contour.normals == Normals::gradient, "`normals` gradient"},
                                        {uses_device(job), "a device"}})
        if (asked) return refusal("`solid` was asked for, which does not go with {}", option);
    if (job.solid->kind == SolidChoice::Kind::between && names_isovalues(job))
        return refusal("`solid` has its own two isovalues, but others were given");
    return {};
}

} // namespace

Error with_cheaper_plan(Error error, const ExtractJob& job, const ExtractPlan& plan) {
    if (error.code != ErrorCode::out_of_memory || plan.active_cells) return error;
    ExtractPlan cheaper = plan;
    const auto try_it = [&](std::string_view way) {
        if (!plan_active_cells(job, cheaper)) return false;
        error.message += fmt::format("; {}, only cells that an isovalue cuts are kept", way);
        return true;
    };
    std::vector<double>& isovalues = cheaper.contour.expected_isovalues;
    const auto some = std::max<std::size_t>((surfaces_that_pay_for_packing - 1) / plan.steps.size(), 1);
    if (isovalues.size() > some) isovalues.resize(some);
    cheaper.contour.surfaces = isovalues.size() * plan.steps.size();
    if (try_it(fmt::format("of up to {} isovalues at a time", some))) return error;
    if (cheaper.carried) cheaper.carried->components.clear();
    if (try_it("without expressions of cell fields and derivatives, which `with` leaves out,")) return error;
    cheaper.contour.normals = Normals::none;
    try_it("without `normals` gradient");
    return error;
}

bool is_animated(const OutputNames& names) { return names.fixed() && ending_of(names.pattern()) == ".glb"; }

Result<void> check_names(const ExtractJob& job, const ExtractPlan& plan, const FileInfo& info) {
    if (plan.names.none()) return {};
    if (plan.steps.size() > 1 && !plan.names.by_step() && !is_animated(plan.names))
        return refusal("`all_steps` has {} time steps, but OUT, '{}', has neither {{step}} nor {{time}}: there is "
                       "one file for each step",
                       plan.steps.size(), job.out);
    if (!plan.names.by_time()) return {};
    std::set<double> times;
    for (const std::size_t step : plan.steps) {
        const std::optional<double> time = time_of(info, step);
        if (!time)
            return refusal("OUT, '{}', has {{time}}, but the grid knows no time; {{step}} is its number", job.out);
        if (!times.insert(*time).second)
            return refusal("several time steps have the time {}, but each needs a file of its own: {{step}} in "
                           "OUT tells them apart",
                           shortest(*time));
    }
    return {};
}

Result<std::string> plan_collection(const ExtractJob& job, const ExtractPlan& plan, Caller& caller) {
    const std::string ending = ending_of(job.out);
    if (plan.steps.size() < 2 || (ending != ".vtp" && ending != ".vtu" && ending != ".usda")) return std::string();
    std::string collection = plan.names.collection();
    if (ending == ".usda") collection.replace(collection.size() - 4, 4, ending);
    if (same_file(collection, job.grid.file)) {
        caller.note(fmt::format("no collection of the series is written: '{}' is the input", collection));
        return std::string();
    }
    std::error_code ignored;
    if (std::filesystem::exists(collection, ignored) && !is_written_collection(collection)) {
        caller.note(fmt::format("no collection of the series is written: '{}' is there already, and not of isotet",
                                collection));
        return std::string();
    }
    std::vector<std::string> inputs = job.grid.other_inputs;
    inputs.push_back(job.grid.file);
    if (auto paths = check_output_paths(inputs, with_others(job, collection)); !paths) return paths.error();
    return collection;
}

namespace {

/// Whether active cells will do, as far as is known before the field is.
bool streams(const ExtractJob& job, const GridSource& source) {
    if (uses_device(job)) return false;
    ExtractPlan plan;
    plan.steps.resize(job.all_steps ? std::max<std::size_t>(source.info().times.size(), 1) : 1);
    plan.contour = contour_options_of(job, plan.steps.size());
    return plan_active_cells(job, plan).has_value();
}

} // namespace

Result<void> choose_first_of(ExtractJob& job, GridSource& source, ExtractPlan& plan, Caller& caller) {
    ChoiceWish wish{job.all_steps ? Steps::all : Steps::one, job.field, job.with.value_or(std::vector<std::string>())};
    wish.needs_view = !job.field.shape;
    const std::vector<FieldInfo>& fields = source.info().fields;
    std::string asked; // the only field: whatever it is, its values are asked for
    if (job.field.name.empty() && !job.field.shape && fields.size() == 1 && names_isovalues(job)) {
        const std::vector<FirstCandidate> candidates = first_candidates(fields);
        asked = candidates.empty() ? fields[0].name : candidates[0].name;
    }
    if (!asked.empty() && source.info().times.size() < 2) { // later steps may have others
        job.field.name = asked;
        wish.field = job.field;
    }
    wish.only_field_will_do = true;
    wish.streams = streams(job, source);
    if (!job.with && plan.holds_fields) wish.also.point.reset();
    const Result<FirstChoice> choice = choose_first(source, job.grid, wish, caller, caller.run());
    if (!choice) return choice.error();
    plan.steps = choice->steps;
    if (!job.field.name.empty() || job.field.shape || fields.empty()) return {};
    const bool contours = !choice->view.field.empty() && choice->view.draw != FirstDraw::regions_on_boundary;
    if (!asked.empty() && !contours) {
        job.field.name = asked;
        return {};
    }
    if (choice->view.field.empty())
        return Error{ErrorCode::invalid_data,
                     fmt::format("no field was named, and {} does not vary, numbers something, or has more than 3 "
                                 "components: `field` names one, or x, y, z for a coordinate",
                                 fields.size() == 1 ? fmt::format("the only one, '{}',", fields[0].name)
                                                    : fmt::format("each of the {} fields", fields.size()))};
    if (choice->view.draw == FirstDraw::regions_on_boundary)
        return refusal("no field was named, and only numbers of regions vary, such as '{}': `field` names one to "
                       "contour",
                       choice->view.field);
    job.field.name = choice->view.field;
    if (fields.size() > 1) caller.note(note_of_field(choice->view));
    return {};
}

Result<void> choose_fields_of_steps(const ExtractJob& job, GridSource& source, ExtractPlan& plan, Caller& caller) {
    const bool several = plan.steps.size() > 1, named = !job.field.name.empty();
    if (several && !named)
        if (auto looked = source.look_at_steps(plan.steps, caller); !looked) return looked;
    auto chosen = choose_fields(job, source, plan);
    if (chosen || !several || !named || chosen.error().code != ErrorCode::invalid_argument) return chosen;
    if (auto looked = source.look_at_steps(plan.steps, caller); !looked) return looked;
    return choose_fields(job, source, plan);
}

SolidRange range_for(const SolidChoice& choice, double isovalue) {
    switch (choice.kind) {
    case SolidChoice::Kind::above: return SolidRange::above(isovalue);
    case SolidChoice::Kind::below: return SolidRange::below(isovalue);
    case SolidChoice::Kind::between: break;
    }
    return choice.range;
}

Result<void> choose_fields(const ExtractJob& job, const GridSource& source, ExtractPlan& plan) {
    Result<FoundField> field = choose_field(source, job.field);
    if (!field) return field.error();
    auto carried = plan_carried(job, source, plan.out_holds_fields);
    if (!carried) return carried.error();
    plan.field = *std::move(field);
    plan.carried = *std::move(carried);
    plan.color = plan_color(job, source);
    Result<std::optional<Region>> touched = find_touched(job, source);
    if (!touched) return touched.error();
    plan.touched = *std::move(touched);
    plan.read = fields_to_read(plan);
    if (plan.touched && job.keep->region != "boundary") add_names(*plan.read.cell, {plan.touched->field});
    const bool all_cell_fields = (job.field.shape || job.solid) && !plan.carried && plan.out_holds_cell_fields;
    if (all_cell_fields && !source.names(Association::cell).empty()) plan.read.cell.reset();
    return {};
}

Result<ExtractPlan> plan_extract(ExtractJob& job, GridSource& source, Caller& caller) {
    ExtractPlan plan;
    if (Result<void> solid = check_solid(job); !solid) return solid.error();
    plan.names = OutputNames(job.out);
    const Result<Holds> format = holds(job);
    if (!format) return format.error();
    plan.holds_fields = format->fields;

    plan.steps.assign(job.all_steps ? std::max<std::size_t>(source.info().times.size(), 1) : 1, 0);
    for (std::size_t i = 0; i < plan.steps.size(); ++i) plan.steps[i] = i;
    if (Result<void> names = check_names(job, plan, source.info()); !names) return names.error();
    Result<std::string> collection = plan_collection(job, plan, caller);
    if (!collection) return collection.error();
    plan.collection = *std::move(collection);

    if (Result<void> chosen = choose_first_of(job, source, plan, caller); !chosen) return chosen.error();
    if (job.piece && job.field.own_centres) return refusal("`piece` takes `centre` mean only");
    plan.out_holds_fields = format->fields;
    plan.out_holds_cell_fields = format->cell_fields;
    if (auto chosen = choose_fields_of_steps(job, source, plan, caller); !chosen) return chosen.error();

    if (job.piece && plan.field.neighbours)
        return refusal("`piece` was asked for, but '{}' has derivatives, which follow from all cells around a point",
                       plan.field.name);

    plan.contour = contour_options_of(job, plan.steps.size());
    plan.active_cells = plan_active_cells(job, plan);
    return plan;
}

Result<std::vector<double>> choose_isovalues(const ExtractJob& job, const std::vector<double>& shares,
                                             const Array& field, const FieldReport& packed, const FillValues& fill,
                                             Caller& caller) {
    std::vector<double> isovalues = job.isovalues;
    isovalues.insert(isovalues.end(), shares.begin(), shares.end());
    if (isovalues.empty()) {
        if (!(packed.lower <= packed.upper)) {
            return Error{
                ErrorCode::invalid_data,
                fmt::format("field '{}' has no finite value at the points of the tets: without an isovalue there "
                            "is nothing to choose one from",
                            packed.name)};
        }
        const ValueRange range = fill.numbers.empty() ? ValueRange{packed.lower, packed.upper} : fill.others;
        isovalues = evenly_spaced_levels(range.lower, range.upper, std::max<std::uint64_t>(job.levels, 1));
        if (job.levels == 0) {
            caller.note(fmt::format("no isovalue was given: {}, the middle of the range {}, was taken",
                                    shortest(isovalues.front()), rounded_range(range.lower, range.upper)));
        }
    }
    std::vector<double> distinct;
    std::set<double> seen;
    for (double value : isovalues) {
        if (job.snap) value = snap(field, value);
        if (value == 0) value = 0; // -0 equals +0, and is called 0
        if (seen.insert(value).second) {
            distinct.push_back(value);
        } else if (!job.isovalues.empty()) { // levels of a constant field are all the same, too
            caller.note(fmt::format("the isovalue {} was given more than once: it is extracted once", shortest(value)));
        }
    }
    return distinct;
}

bool is_carried(const ExtractPlan& plan, const std::string& cell_field) {
    if (!plan.carried) return !plan.read.cell;
    return std::ranges::find(plan.carried->cell, cell_field) != plan.carried->cell.end();
}

namespace {

bool is_among(const std::vector<Field>& fields, const std::string& name) {
    return std::ranges::find(fields, name, &Field::name) != fields.end();
}

} // namespace

bool has_arrays_of(const FoundField& field, const Grid& grid) {
    const auto is_read = [&](const std::string& name) {
        return is_among(grid.point_fields, name) || is_among(grid.cell_fields, name);
    };
    if (field.is_expression)
        return std::ranges::all_of(field.point, is_read) && std::ranges::all_of(field.cell, is_read);
    const bool coordinate = field.point.empty() && field.cell.empty();
    return coordinate || (!field.point.empty() && is_among(grid.point_fields, field.point.front())) ||
           (!field.cell.empty() && is_among(grid.cell_fields, field.cell.front()));
}

namespace {

/// Adds a component of a point field, or an expression, where the step has what it is made of.
Result<void> add_component(const FoundField& component, const Grid& grid, const Run& run, std::vector<Field>& fields) {
    const auto is_there = [&](const std::string& name) { return is_among(grid.point_fields, name); };
    if (component.is_expression ? !has_arrays_of(component, grid) : !std::ranges::all_of(component.point, is_there))
        return {};
    if (component.point.size() > 1 && !component.is_expression && !component.name.ends_with(":mag")) {
        Result<Field> whole = gather_components(grid.point_fields, component.name, component.point);
        if (!whole) return whole.error();
        fields.push_back(*std::move(whole));
        return {};
    }
    const Result<PointField> found = find_field(grid, component.name, {}, run);
    if (!found) return found.error();
    fields.push_back({component.name, found->values});
    return {};
}

} // namespace

Result<StepFields> carried_fields(const ExtractPlan& plan, const Grid& grid, const Run& run) {
    StepFields fields;
    const auto has = [](const std::vector<std::string>& names, const Field& field) {
        return std::ranges::find(names, field.name) != names.end();
    };
    for (const Field& field : grid.point_fields)
        if (!plan.carried || has(plan.carried->point, field)) fields.point.push_back(field);
    for (const Field& field : grid.cell_fields) {
        const bool is_touched = plan.touched && field.name == plan.touched->field;
        const bool is_wanted = plan.carried ? has(plan.carried->cell, field) : !plan.read.cell;
        if (is_wanted || is_touched) fields.cell.push_back(field);
    }
    std::vector<FoundField> computed = plan.carried ? plan.carried->components : std::vector<FoundField>();
    if (plan.color && std::ranges::find(computed, plan.color->name, &FoundField::name) == computed.end())
        computed.push_back(*plan.color);
    for (const FoundField& component : computed)
        if (auto added = add_component(component, grid, run, fields.point); !added) return added.error();
    return fields;
}

Estimate predict(const ExtractJob& job, const ExtractPlan& plan, const FieldSample& sample, double kept,
                 std::size_t together) {
    const std::uint64_t others = std::max<std::uint64_t>({job.levels, job.shares.size(), 1});
    const std::vector<double> levels = evenly_spaced_levels(sample.lower(), sample.upper(), others);
    const std::vector<double>& isovalues = job.isovalues.empty() ? levels : job.isovalues;
    double all = 0;
    Workload work;
    for (std::size_t i = 0; i < isovalues.size(); i += together) {
        double pass = 0;
        for (std::size_t k = i; k < std::min(i + together, isovalues.size()); ++k)
            pass += sample.triangles(isovalues[k]);
        all += pass;
        work.triangles_together = std::max(work.triangles_together, pass);
    }
    work.points = sample.points();
    work.tets = static_cast<std::uint64_t>(static_cast<double>(sample.tets()) / (kept > 0 ? kept : 1));
    work.surfaces = static_cast<double>(isovalues.size() * plan.steps.size());
    work.gradients = job.contour.normals == Normals::gradient;
    work.find_range = !names_isovalues(job) || job.levels > 0;
    work.triangles = all / static_cast<double>(isovalues.size());
    return estimate(method_for(isovalues.size() * plan.steps.size(), work.gradients, job.contour.method), work);
}

std::vector<std::string> with_others(const ExtractJob& job, const std::string& output) {
    std::vector<std::string> outputs{output};
    outputs.insert(outputs.end(), job.other_outputs.begin(), job.other_outputs.end());
    if (!job.parts_table.empty()) outputs.push_back(job.parts_table);
    return outputs;
}

} // namespace isotet::jobs
