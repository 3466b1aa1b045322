// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "view/export/saved_surfaces.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <span>
#include <utility>

#include <fmt/format.h>

#include <isotet/isosurface_scene.hpp>
#include <isotet/isovalues.hpp>
#include <isotet/text.hpp>

#include "view/messages.hpp"
#include "view/export/page_file.hpp"
#include "view/page_words.hpp"
#include "view/export/saved_mesh.hpp"

namespace isotet::view {

namespace {

/// A mesh as it stands in the file, and what the page is told of it.
struct CodedSurface {
    std::size_t step = 0; ///< as the page counts them: those of the file that are shown
    double isovalue = 0;
    Json told;
    std::string base64;
};

/// Of isovalues that were not named, every `stride`-th stays.
bool stays(std::size_t index, std::size_t stride) { return (index + 1) % stride == 0; }

class SurfaceSaver {
public:
    SurfaceSaver(std::unique_ptr<GridView> view, const ViewerInput& input, const SavedSurfacesOptions& options,
                 const Run& run)
        : view_(std::move(view)), input_(input), options_(options), run_(run) {}

    Result<SavedSurfaces> save() {
        if (Result<void> charted = look_at_steps(); !charted) return charted.error();
        if (Result<void> chosen = choose_isovalues(); !chosen) return chosen.error();
        for (std::size_t step = 0; step < options_.steps.size(); ++step)
            if (Result<void> made = code_step(step); !made) return made.error();
        return fit();
    }

private:
    Result<void> look_at_steps();
    Result<void> choose_isovalues();
    Result<void> code_step(std::size_t step);
    void tell_hidden(std::span<const SurfacePoints> points);
    Result<void> code_boundary(std::size_t step, const ShowMessage& message, std::vector<std::string> known);
    Result<CodedSurface> coded(const FrameParts& parts, const FrameSurface& surface, std::size_t step);
    /// What of all that is in the file.
    struct Shown {
        std::vector<double> isovalues;
        std::vector<const CodedSurface*> surfaces, boundaries;
        std::uint64_t bytes = 0; ///< of both
    };
    Shown shown_with(std::size_t stride) const;
    Json saved_json(const Shown& shown) const;
    Result<std::string> document_of(const Shown& shown) const;
    SavedSurfaces report_of(const Shown& shown, std::string html) const;
    Result<SavedSurfaces> fit();
    bool boundary_is_first() const { return !input_.state.isosurfaces; }

    std::unique_ptr<GridView> view_;
    const ViewerInput& input_;
    const SavedSurfacesOptions& options_;
    const Run& run_;
    Json charts_ = Json::array(), spectra_ = Json::array();
    ValueRange range_{0, -1}; ///< of the field in all steps
    double first_ = 0;        ///< to begin with
    std::vector<double> isovalues_;
    std::vector<CodedSurface> surfaces_, boundaries_;
    bool simplified_ = false;
};

/// Charts of the steps, and the range of the field in them.
Result<void> SurfaceSaver::look_at_steps() {
    const std::string& field = input_.state.field;
    for (std::size_t step = 0; step < options_.steps.size(); ++step) {
        const Result<Chart> chart = view_->chart(field, options_.steps[step], run_);
        if (!chart) return chart.error();
        charts_.push_back(*parse_json(chart_text({field}, step, *chart)));
        if (!(chart->lower <= chart->upper)) continue;
        if (range_.lower > range_.upper) {
            range_ = {chart->lower, chart->upper};
            first_ = chart->first;
        } else range_ = {std::min(range_.lower, chart->lower), std::max(range_.upper, chart->upper)};
    }
    if (options_.steps.size() > 1) return {};
    const Result<ContourSpectrum> spectrum = view_->spectrum(field, options_.steps.front(), run_);
    if (!spectrum && spectrum.error().code == ErrorCode::cancelled) return spectrum.error();
    if (spectrum) spectra_.push_back(*parse_json(spectrum_text({field}, 0, *spectrum)));
    return {};
}

Result<void> SurfaceSaver::choose_isovalues() {
    isovalues_ = options_.isovalues;
    if (isovalues_.empty()) {
        const ValueRange range = options_.range.value_or(range_);
        if (!(range.lower < range.upper))
            return Error{ErrorCode::invalid_argument,
                         fmt::format("no isovalue lies inside the range of '{}', {} to {}: name some",
                                     input_.state.field, range.lower, range.upper)};
        isovalues_ = evenly_spaced_levels(range.lower, range.upper, options_.count, LevelRounding::short_decimals);
    }
    std::ranges::sort(isovalues_);
    isovalues_.erase(std::ranges::unique(isovalues_).begin(), isovalues_.end());
    return {};
}

Result<CodedSurface> SurfaceSaver::coded(const FrameParts& parts, const FrameSurface& surface, std::size_t step) {
    const Result<std::string> packed = deflated(columns_of(*surface.mesh));
    if (!packed) return packed.error();
    CodedSurface out{step, surface.isovalue, {}, base64_of(*packed)};
    Json mesh = told_of(*surface.mesh);
    mesh["bytes"] = packed->size();
    out.told = {{"step", step},
                {"isovalue", surface.isovalue},
                {"triangles", surface.triangles},
                {"color", color_text(surface.color)},
                {"mesh", std::move(mesh)},
                {"notes", Json::array()}};
    const FrameFacts& facts = parts.facts;
    for (const std::string& note : facts.notes) out.told["notes"].push_back(page_words(note));
    if (facts.range) out.told["range"] = {facts.range->lower, facts.range->upper};
    if (facts.field_bound) out.told["field_bound"] = *facts.field_bound;
    if (facts.scale) out.told["scale"] = scale_json(*facts.scale, facts.classes);
    return out;
}

Result<void> SurfaceSaver::code_step(std::size_t step) {
    ShowMessage message;
    message.state = input_.state;
    message.state.step = options_.steps[step];
    message.state.boundary = 0;
    message.state.isosurfaces = true;
    if (boundary_is_first() && message.state.color_by == message.state.field)
        message.state.color_by.clear(); // it says nothing on them
    message.refined = options_.refine.has_value();
    std::vector<std::string> known;
    std::vector<SurfacePoints> points;
    for (std::size_t i = 0; i < isovalues_.size(); ++i) {
        message.state.isovalues = {isovalues_[i]};
        const Result<FrameParts> parts = view_->frame_parts(message, {}, run_);
        if (!parts) return parts.error();
        Result<CodedSurface> surface = coded(*parts, parts->surfaces.front(), step);
        if (!surface) return surface.error();
        simplified_ |= parts->facts.preview;
        surfaces_.push_back(*std::move(surface));
        points.push_back(some_points_of(*parts->surfaces.front().mesh));
        known = parts->keys;
        run_.progress("extract", static_cast<double>(i + 1) / static_cast<double>(isovalues_.size()));
    }
    tell_hidden(points);
    return code_boundary(step, message, std::move(known));
}

/// Of the surfaces of the last step: which isovalues' surfaces each of them hides.
void SurfaceSaver::tell_hidden(std::span<const SurfacePoints> points) {
    const std::vector<std::vector<std::size_t>> hidden = hidden_by(points);
    CodedSurface* const surfaces = surfaces_.data() + surfaces_.size() - points.size();
    for (std::size_t i = 0; i < points.size(); ++i) {
        Json isovalues = Json::array();
        for (const std::size_t other : hidden[i]) isovalues.push_back(isovalues_[other]);
        surfaces[i].told["hides"] = std::move(isovalues);
    }
}

/// Of a frame that has the last surface already.
Result<void> SurfaceSaver::code_boundary(std::size_t step, const ShowMessage& message, std::vector<std::string> known) {
    ShowMessage with_boundary = message;
    with_boundary.state.boundary = 1;
    if (boundary_is_first()) {
        with_boundary.state.isosurfaces = false;
        with_boundary.state.color_by = input_.state.color_by;
    }
    const Result<FrameParts> parts = view_->frame_parts(with_boundary, known, run_);
    if (!parts) return parts.error();
    for (const FrameSurface& surface : parts->surfaces) {
        if (surface.kind != "boundary" || !surface.mesh) continue;
        Result<CodedSurface> boundary = coded(*parts, surface, step);
        if (!boundary) return boundary.error();
        if (boundaries_.empty() || boundaries_.back().base64 != boundary->base64)
            boundaries_.push_back(*std::move(boundary)); // else that of the step before goes on
    }
    return {};
}

/// Fields and colours that the page can choose: those of the surfaces.
void keep_saved_fields(Json& grid, const ViewState& state) {
    Json fields = Json::array(), colors = Json::array();
    for (const Json& field : grid["fields"]) {
        if (field["name"] == state.field) fields.push_back(field);
        if (field["name"] == state.color_by) colors.push_back(field["name"]);
    }
    grid["fields"] = std::move(fields);
    grid["colors"] = std::move(colors);
}

/// As the page looks for them: each with the name of its element.
Json named_parts(const std::vector<const CodedSurface*>& surfaces, std::string_view name) {
    Json list = Json::array();
    for (const CodedSurface* one : surfaces) {
        Json told = one->told;
        told["part"] = fmt::format("{}-{}", name, list.size());
        list.push_back(std::move(told));
    }
    return list;
}

Json SurfaceSaver::saved_json(const Shown& shown) const {
    ViewerInput input;
    input.state = input_.state;
    const double wanted = input_.state.isovalues.empty() ? first_ : input_.state.isovalues.front();
    input.state.isovalues = {
        *std::ranges::min_element(shown.isovalues, {}, [&](double value) { return std::abs(value - wanted); })};
    input.state.step.reset();
    if (boundary_is_first() && shown.boundaries.empty()) {
        input.state.isosurfaces = true;
        input.state.boundary = default_boundary_opacity;
        input.state.colored_boundary = false;
    }
    input.notes = input_.notes;
    if (options_.steps.size() > 1) {
        input.state.step = 0;
        for (const std::size_t step : options_.steps)
            input.times.push_back(step < input_.times.size() ? input_.times[step] : static_cast<double>(step));
    }
    Json grid = grid_json(*view_, options_.file, input);
    keep_saved_fields(grid, input_.state);
    grid["refines"] = false;
    grid["saved"] = "surfaces";
    grid["values"] = shown.isovalues;
    Json saved;
    saved["welcome"] = welcome_json(options_.file, options_.version, "");
    saved["grid"] = std::move(grid);
    saved["charts"] = charts_;
    saved["spectra"] = spectra_;
    saved["surfaces"] = named_parts(shown.surfaces, "surface");
    saved["boundaries"] = named_parts(shown.boundaries, "boundary");
    return saved;
}

/// The boundary is left out where it takes more than a quarter of what there is room for; three quarters where it is what
/// is seen first.
SurfaceSaver::Shown SurfaceSaver::shown_with(std::size_t stride) const {
    Shown shown;
    for (std::size_t i = 0; i < isovalues_.size(); ++i)
        if (stays(i, stride)) shown.isovalues.push_back(isovalues_[i]);
    for (std::size_t i = 0; i < surfaces_.size(); ++i) {
        if (!stays(i % isovalues_.size(), stride)) continue;
        shown.surfaces.push_back(&surfaces_[i]);
        shown.bytes += surfaces_[i].base64.size();
    }
    std::uint64_t boundary_bytes = 0;
    for (const CodedSurface& one : boundaries_) boundary_bytes += one.base64.size();
    if (boundary_bytes > options_.max_bytes / 4 * (boundary_is_first() ? 3 : 1)) return shown;
    for (const CodedSurface& one : boundaries_) shown.boundaries.push_back(&one);
    shown.bytes += boundary_bytes;
    return shown;
}

Result<std::string> SurfaceSaver::document_of(const Shown& shown) const {
    std::vector<PagePart> parts;
    for (std::size_t i = 0; i < shown.surfaces.size(); ++i)
        parts.push_back({fmt::format("surface-{}", i), shown.surfaces[i]->base64});
    for (std::size_t i = 0; i < shown.boundaries.size(); ++i)
        parts.push_back({fmt::format("boundary-{}", i), shown.boundaries[i]->base64});
    return page_document(fmt::format("{} – isotet", options_.file), saved_json(shown), parts);
}

SavedSurfaces SurfaceSaver::report_of(const Shown& shown, std::string html) const {
    SavedSurfaces out;
    out.html = std::move(html);
    out.isovalues = shown.isovalues;
    out.left_out = isovalues_.size() - shown.isovalues.size();
    out.boundary = !shown.boundaries.empty();
    out.data_bytes = shown.bytes;
    for (const CodedSurface* one : shown.surfaces) out.triangles += one->told["triangles"].get<std::uint64_t>();
    if (out.left_out > 0)
        out.notes.push_back(fmt::format("{} of {} isovalues are in the file: all of them would make it larger than {} "
                                        "(`max_size`)",
                                        out.isovalues.size(), isovalues_.size(), format_bytes(options_.max_bytes)));
    if (!out.boundary && !boundaries_.empty())
        out.notes.push_back(
            fmt::format("the boundary of the grid is left out: it would take more than {} of `max_size`",
                        boundary_is_first() ? "three quarters" : "a quarter"));
    if (simplified_)
        out.notes.push_back(fmt::format("surfaces with more than {} triangles are simplified", options_.max_triangles));
    return out;
}

Result<SavedSurfaces> SurfaceSaver::fit() {
    const std::size_t most = options_.isovalues.empty() ? isovalues_.size() : 1;
    std::uint64_t least = 0; ///< bytes that the smallest file would have
    for (std::size_t stride = 1; stride <= most; ++stride) {
        const Shown shown = shown_with(stride);
        least = shown.bytes;
        if (shown.bytes > options_.max_bytes) continue;
        Result<std::string> html = document_of(shown);
        if (!html) return html.error();
        least = html->size();
        if (html->size() <= options_.max_bytes) return report_of(shown, *std::move(html));
    }
    return Error{ErrorCode::invalid_argument,
                 fmt::format("the file would have {} with {}, but may have {} (`max_size`)", format_bytes(least),
                             most > 1 || isovalues_.size() == 1 ? "one isovalue" : "the isovalues that were named",
                             format_bytes(options_.max_bytes))};
}

} // namespace

Result<SavedSurfaces> save_surfaces(ViewerInput input, const ReadStep& read_step, const SavedSurfacesOptions& options,
                                    const Run& run) {
    GridViewOptions view_options;
    view_options.threads = run.threads;
    view_options.max_triangles = options.max_triangles;
    view_options.step = options.steps.front();
    view_options.steps = std::max<std::size_t>(1, input.times.size());
    view_options.refine = options.refine;
    view_options.regions = input.regions;
    view_options.read_step = read_step;
    Result<std::unique_ptr<GridView>> view = GridView::create(std::move(input.grid), view_options);
    if (!view) return view.error();
    if (Result<void> found = (*view)->find_boundary(run); !found && found.error().code == ErrorCode::cancelled)
        return found.error();
    return SurfaceSaver(*std::move(view), input, options, run).save();
}

} // namespace isotet::view
