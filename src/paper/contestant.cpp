// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "paper/contestant.hpp"

#include <span>
#include <utility>

#include <isotet/device.hpp>
#include <isotet/draw_tets.hpp>
#include <isotet/extract.hpp>
#include <isotet/paper/search.hpp>

namespace isotet::measure {

namespace {

/// Makes a surface on the CPU; where there is a device it is uploaded.
class OnCpu : public Contestant {
public:
    Result<DrawnSurface> make(Bed& bed, double isovalue, BenchTimes& times, BenchOutcome& outcome) override {
        const Stopwatch extracting;
        const Result<Extraction> extraction = extract_surface(bed, isovalue);
        if (!extraction) return extraction.error();
        DrawnSurface drawn;
        outcome.triangles = extraction->surface.triangle_count();
        if (bed.device) {
            Result<DeviceMesh> mesh = DeviceMesh::upload(*bed.device, extraction->surface);
            if (!mesh) return mesh.error();
            mesh_ = *std::move(mesh);
            drawn.mesh = &*mesh_;
            outcome.sent_bytes = 12 * (mesh_->vertex_count() + mesh_->triangle_count());
        }
        times.extract = extracting.seconds();
        return drawn;
    }

private:
    virtual Result<Extraction> extract_surface(Bed& bed, double isovalue) = 0;

    std::optional<DeviceMesh> mesh_;
};

class Direct final : public OnCpu {
public:
    Result<BenchCosts> prepare(Bed&) override { return BenchCosts{}; }

private:
    Result<Extraction> extract_surface(Bed& bed, double isovalue) override {
        Result<DirectExtraction> direct =
            extract_direct(bed.grid, bed.field, std::span(&isovalue, 1), {.split_cells = true}, bed.run);
        if (!direct) return direct.error();
        return std::move(direct->surfaces.front());
    }
};

class Clusters final : public OnCpu {
public:
    Result<BenchCosts> prepare(Bed& bed) override {
        if (Result<void> packed = bed.pack(); !packed) return packed.error();
        return BenchCosts{bed.pack_seconds, bed.packed->report().bytes, 0, 0};
    }

private:
    Result<Extraction> extract_surface(Bed& bed, double isovalue) override {
        return extract(*bed.packed, isovalue, {}, bed.run);
    }
};

class ClustersOnDevice final : public Contestant {
public:
    Result<BenchCosts> prepare(Bed& bed) override {
        if (Result<void> packed = bed.pack(); !packed) return packed.error();
        const Stopwatch uploading;
        Result<DeviceGrid> grid = DeviceGrid::upload(*bed.device, *bed.packed, {}, bed.run);
        if (!grid) return grid.error();
        grid_ = *std::move(grid);
        return BenchCosts{bed.pack_seconds + uploading.seconds(), bed.packed->report().bytes, grid_->device_bytes(), 0};
    }

    Result<DrawnSurface> make(Bed& bed, double isovalue, BenchTimes& times, BenchOutcome& outcome) override {
        const Stopwatch extracting;
        if (Result<void> done = grid_->extract(isovalue, surface_, {}, bed.run); !done) return done.error();
        times.extract = extracting.seconds();
        outcome.triangles = surface_.triangle_count();
        outcome.sent_bytes = grid_->work().uploaded_bytes;
        DrawnSurface drawn;
        drawn.surface = &surface_;
        return drawn;
    }

private:
    std::optional<DeviceGrid> grid_;
    DeviceSurface surface_;
};

/// The paper's: the vertex shader cuts tets, all of them or those that a search index finds.
class InTheVertexShader final : public Contestant {
public:
    InTheVertexShader(DrawMethod method, SearchIndex index) : method_(method), index_(index) {}

    Result<BenchCosts> prepare(Bed& bed) override {
        if (Result<void> packed = bed.pack(); !packed) return packed.error();
        const Stopwatch preparing;
        Result<TetStore> store = TetStore::upload(*bed.device, *bed.packed, method_, {}, bed.run);
        if (!store) return store.error();
        store_ = *std::move(store);
        BenchCosts costs;
        if (index_ != SearchIndex::none) {
            Result<TetIndex> tets = TetIndex::create(*bed.packed, index_, bed.run);
            if (!tets) return tets.error();
            tets_ = *std::move(tets);
            costs.host_bytes = tets_->report().table_bytes + tets_->report().index_bytes;
        }
        costs.prepare_seconds = bed.pack_seconds + preparing.seconds();
        costs.device_bytes = store_->report().device_bytes;
        costs.crossing_bytes = store_->report().host_bytes;
        costs.host_bytes += costs.crossing_bytes;
        return costs;
    }

    Result<DrawnSurface> make(Bed&, double isovalue, BenchTimes& times, BenchOutcome& outcome) override {
        const Stopwatch searching;
        std::optional<std::span<const std::uint32_t>> found;
        if (tets_) {
            const auto list = tets_->find(isovalue);
            if (!list) return list.error();
            found = *list;
            times.search = searching.seconds();
        }
        const Stopwatch sending;
        Result<TetSurface> surface = found ? store_->at(isovalue, *found) : store_->at(isovalue);
        if (!surface) return surface.error();
        surface_ = *std::move(surface);
        times.extract = sending.seconds();
        outcome.tets_looked_at = surface_->tets();
        outcome.sent_bytes = surface_->sent_bytes();
        DrawnSurface drawn;
        drawn.tets = &*surface_;
        return drawn;
    }

private:
    DrawMethod method_;
    SearchIndex index_;
    std::optional<TetStore> store_;
    std::optional<TetIndex> tets_;
    std::optional<TetSurface> surface_;
};

} // namespace

Result<void> Bed::pack() {
    if (packed) return {};
    const Stopwatch packing;
    Result<PackedGrid> made = isotet::pack(grid, field, {.split_cells = true}, run);
    if (!made) return made.error();
    packed = *std::move(made);
    pack_seconds = packing.seconds();
    return {};
}

std::unique_ptr<Contestant> make_contestant(const BenchPair& pair) {
    if (const std::optional<DrawMethod> method = draw_method_of(pair.method))
        return std::make_unique<InTheVertexShader>(*method, pair.index);
    if (pair.method == BenchMethod::direct) return std::make_unique<Direct>();
    if (pair.method == BenchMethod::clusters) return std::make_unique<Clusters>();
    return std::make_unique<ClustersOnDevice>();
}

} // namespace isotet::measure
