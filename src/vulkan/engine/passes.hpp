// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The passes of an extraction, for a recorder: which kernel, how many workgroups, what each reads and writes.
// docs/inside/gpu.md draws them.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <isotet/extract.hpp>
#include <isotet/result.hpp>

#include "numbers/storage.hpp"
#include "vulkan/context.hpp"
#include "vulkan/engine/carried_fields.hpp"
#include "vulkan/engine/resident.hpp"
#include "vulkan/engine/surface_buffers.hpp"
#include "vulkan/recorder.hpp"

namespace isotet::vulkan {

/// What is extracted, and into what.
struct Task {
    core::StoredIsovalue<float> isovalue;
    Ties ties;
    SurfaceBuffers& surface;
    std::vector<std::shared_ptr<const CarriedField>> fields; ///< one for each of the surface's
};

class Passes {
public:
    /// Makes the kernels that surfaces with these parts need. `resident` is borrowed.
    static Result<Passes> make(Context& context, const Resident& resident, const SurfaceParts& parts);

    /// Makes the kernel for clusters with many active edges, which takes much shared memory and is hardly ever needed.
    Result<void> make_emit_many(Context& context);
    bool has_emit_many() const noexcept { return emit_many_; }

    /// Empties the head of the surface.
    void begin(Recorder& recorder, const Task& task) const;

    /// Tells the head of the surface about new arrays; what it says about the surface stays.
    void begin_again(Recorder& recorder, const Task& task) const;

    void select(Recorder& recorder, const Task& task) const;
    /// `batch`   pages with this number only; 0: all
    void count(Recorder& recorder, const Task& task, std::uint32_t batch = 0) const;
    void scan(Recorder& recorder, const Task& task) const;
    /// Leaves clusters with many active edges out without make_emit_many().
    void emit(Recorder& recorder, const Task& task, std::uint32_t batch = 0) const;

    /// Normals that need the whole surface, and fields; nothing where the parts have none.
    void finish(Recorder& recorder, const Task& task) const;

    /// Works out the ranges of all clusters on pages that are there, from their values. By itself: needs no task and no
    /// parts.
    static Result<void> ranges(Context& context, Recorder& recorder, const Resident& resident);

private:
    Passes(const Resident& resident, const SurfaceParts& parts) : resident_(resident), parts_(parts) {}
    void normals(Recorder& recorder, const Task& task) const;
    void fields(Recorder& recorder, const Task& task) const;
    Result<const Kernel*> emit_kernel(Context& context, bool many_edges) const;

    const Resident& resident_;
    SurfaceParts parts_;
    const Kernel *select_ = nullptr, *count_ = nullptr, *scan_ = nullptr, *emit_few_ = nullptr, *emit_many_ = nullptr;
    const Kernel *face_normals_ = nullptr, *lowest_triangles_ = nullptr, *missing_normals_ = nullptr,
                 *fields_ = nullptr;
};

} // namespace isotet::vulkan
