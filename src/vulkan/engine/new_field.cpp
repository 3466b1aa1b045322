// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Another field, or other points, for a grid that is on the device already: only what changed goes up.
#include "packed/set_field.hpp"
#include "vulkan/engine/grid_on_device.hpp"

namespace isotet::vulkan {

/// On the device for pages that are there, on the processor for the others; both know all of them afterwards.
Result<void> GridOnDevice::find_ranges(core::Packed& packed, WorkDone& done) {
    for (std::uint32_t i = 0; i < cache_->plan().size(); ++i) {
        const PlannedPage& page = cache_->plan()[i];
        if (!cache_->is_loaded(i)) core::store_ranges<float>(packed, page.first_cluster, page.end_cluster(), {});
    }
    auto told = complete() ? resident_.upload_tables(*context_, packed) : resident_.upload_ranges(*context_, packed);
    if (!told) return told;
    if (auto ok = cache_->upload_table(); !ok) return ok;
    Recorder recorder(*context_);
    if (auto ok = Passes::ranges(*context_, recorder, resident_); !ok) return ok;
    if (auto ok = run(recorder, done); !ok) return ok;
    if (auto ok = resident_.download_ranges(*context_, packed); !ok) return ok;
    return cache_->download_group_ranges(packed);
}

Result<WorkDone> GridOnDevice::set_field(std::shared_ptr<core::Packed> packed, const Progress& progress) {
    WorkDone done;
    const std::uint64_t up = context_->staging().uploaded(), down = context_->staging().downloaded();
    torn_ = true;
    cache_->set_packed(packed);
    if (packed->clusters() > 0) {
        if (auto ok = cache_->upload_values(progress); !ok) return ok.error();
        if (!packed->gradients.empty())
            if (auto ok = cache_->upload_gradients(progress); !ok) return ok.error();
        if (auto ok = find_ranges(*packed, done); !ok) return ok.error();
        cache_->find_ranges();
    }
    torn_ = false;
    done.uploaded = context_->staging().uploaded() - up;
    done.downloaded = context_->staging().downloaded() - down;
    return done;
}

Result<WorkDone> GridOnDevice::set_points(std::shared_ptr<const core::Packed> packed, const Progress& progress) {
    WorkDone done;
    const std::uint64_t up = context_->staging().uploaded();
    torn_ = true;
    cache_->set_packed(std::move(packed));
    if (auto ok = cache_->upload_positions(progress); !ok) return ok.error();
    if (!cache_->packed()->gradients.empty())
        if (auto ok = cache_->upload_gradients(progress); !ok) return ok.error();
    torn_ = false;
    done.uploaded = context_->staging().uploaded() - up;
    return done;
}

} // namespace isotet::vulkan
