// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// isotet::TetStore and isotet::TetSurface.
#include <utility>

#include <isotet/draw_tets.hpp>

#include "base/carry_out.hpp"
#include "base/errors.hpp"
#include "base/guard.hpp"
#include "packed/residency.hpp"
#include "render/device/chosen_tets.hpp"

namespace isotet {

TetSurface::TetSurface(std::unique_ptr<render::ChosenTets> tets) : tets_(std::move(tets)) {}
TetSurface::TetSurface(TetSurface&&) noexcept = default;
TetSurface& TetSurface::operator=(TetSurface&&) noexcept = default;
TetSurface::~TetSurface() = default;
double TetSurface::isovalue() const noexcept { return tets_ ? tets_->isovalue() : 0; }
std::uint64_t TetSurface::tets() const noexcept { return tets_ ? tets_->tets() : 0; }
std::uint64_t TetSurface::sent_bytes() const noexcept { return tets_ ? tets_->sent_bytes() : 0; }
std::uint64_t TetSurface::bytes_per_picture() const noexcept { return tets_ ? tets_->bytes_per_picture() : 0; }

Result<std::vector<std::array<std::array<double, 3>, 3>>> TetSurface::triangles() const {
    return core::guarded("finding the triangles of tets", [&]() -> decltype(triangles()) {
        if (!tets_) return moved_from("the surface of tets");
        return tets_->triangles();
    });
}

TetStore::TetStore(std::shared_ptr<render::TetPages> pages) : pages_(std::move(pages)) {}
TetStore::TetStore(TetStore&&) noexcept = default;
TetStore& TetStore::operator=(TetStore&&) noexcept = default;
TetStore::~TetStore() = default;

const TetStoreReport& TetStore::report() const noexcept {
    static const TetStoreReport none;
    return pages_ ? pages_->report : none;
}

Result<TetStore> TetStore::upload(const Device& device, const PackedGrid& packed, DrawMethod method,
                                  const TetStoreOptions& options, const Run& run) {
    return core::carry_out("uploading tets", run, [&](const Progress& progress) -> Result<TetStore> {
        const auto whole = core::whole_of(packed.shared_data(), progress);
        if (!whole) return whole.error();
        Result<std::shared_ptr<render::TetPages>> pages =
            render::TetPages::upload(device.context(), **whole, method, options, progress);
        if (!pages) return pages.error();
        return TetStore(*std::move(pages));
    });
}

Result<TetSurface> TetStore::at(double isovalue) {
    return core::guarded("choosing tets", [&]() -> Result<TetSurface> {
        if (!pages_) return moved_from("the store of tets");
        auto chosen = render::ChosenTets::choose(pages_, isovalue, {});
        if (!chosen) return chosen.error();
        return TetSurface(*std::move(chosen));
    });
}

Result<TetSurface> TetStore::at(double isovalue, std::span<const std::uint32_t> tets) {
    return core::guarded("choosing tets", [&]() -> Result<TetSurface> {
        if (!pages_) return moved_from("the store of tets");
        auto chosen = render::ChosenTets::choose(pages_, isovalue, tets);
        if (!chosen) return chosen.error();
        return TetSurface(*std::move(chosen));
    });
}

} // namespace isotet
