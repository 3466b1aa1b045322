// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/jobs/slice_files.hpp>

#include "jobs/refuse.hpp"

namespace isotet::jobs {

namespace {

/// The same shape at another offset, or with another radius.
SliceShape moved_to(SliceShape shape, double at) {
    if (auto* plane = std::get_if<Plane>(&shape)) plane->offset = at;
    if (auto* sphere = std::get_if<Sphere>(&shape)) sphere->radius = at;
    if (auto* cylinder = std::get_if<Cylinder>(&shape)) cylinder->radius = at;
    return shape;
}

Result<void> check_shape(const SliceShape& shape) {
    const auto field = slice_field(Array::own(std::vector<float>(), 3), shape); // of no points: only a check
    if (!field) return field.error();
    return {};
}

Result<void> check_slice(const SliceJob& job) {
    if (!job.shape) return refusal("nothing says where to cut: `plane`, `along`, `sphere` or `cylinder` does");
    if (job.count > 0 && !std::holds_alternative<Plane>(*job.shape))
        return refusal("`count` is {}, but only planes `along` a direction are counted", job.count);
    const std::size_t places = job.at.size() + job.shares.size();
    if (job.count > 0 && places > 0) return refusal("`count` is {}, but {} places were given, too", job.count, places);
    const bool solids = job.solid && job.solid->kind == SolidChoice::Kind::between;
    if (solids && places > 0) return refusal("`solid` has its own two ends, but other places were given");
    if (auto ok = check_shape(*job.shape); !ok) return ok;
    for (const double at : job.at)
        if (auto ok = check_shape(moved_to(*job.shape, at)); !ok) return ok;
    return {};
}

} // namespace

Result<ExtractNumbers> slice_files(const SliceJob& job, Caller& caller) {
    if (auto ok = check_slice(job); !ok) return ok.error();
    ExtractJob extract = job;
    extract.field = {};
    extract.field.shape = job.shape;
    extract.snap = false;
    const bool between = job.solid && job.solid->kind == SolidChoice::Kind::between;
    extract.levels = between ? 0 : job.count;
    extract.isovalues = job.at;
    if (job.count == 0 && job.at.empty() && job.shares.empty() && !between) extract.isovalues = {slice_isovalue(*job.shape)};
    return extract_files(extract, caller);
}

} // namespace isotet::jobs
