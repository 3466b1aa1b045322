// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "api/engines.hpp"

#include "base/errors.hpp"

namespace isotet {

namespace {

using api::ExtractDirect;
using api::ExtractPacked;

/// A handle on the grid is all that the CPU needs.
class GridInMemory final : public EngineGrid {
public:
    GridInMemory(const PackedGrid& grid, ExtractPacked by) : packed_(grid), extract_(by) {}

    const PackedGrid& packed() const noexcept override { return packed_; }

    Result<void> set_field(const PointField& field, const Run& run) override {
        return take(packed_.with_field(field, run));
    }
    Result<void> set_points(const Array& points, const Run& run) override {
        return take(packed_.with_points(points, run));
    }
    Result<std::vector<Extraction>> extract(std::span<const double> isovalues, const ExtractOptions& options,
                                            const Run& run) override {
        return extract_(packed_, isovalues, options, run);
    }

private:
    Result<void> take(Result<PackedGrid> changed) {
        if (!changed) return std::move(changed).error();
        packed_ = *changed;
        return {};
    }

    PackedGrid packed_;
    ExtractPacked extract_;
};

class EngineInMemory final : public Engine {
public:
    EngineInMemory(std::string_view name, ExtractPacked packed, ExtractDirect direct)
        : name_(name), extract_(packed), extract_direct_(direct) {}

    std::string_view name() const noexcept override { return name_; }
    bool is_stateless() const noexcept override { return true; }
    Result<std::unique_ptr<EngineGrid>> create_grid(const PackedGrid& packed, const Run&) const override {
        return std::unique_ptr<EngineGrid>(std::make_unique<GridInMemory>(packed, extract_));
    }
    bool extracts_directly() const noexcept override { return true; }
    Result<DirectExtraction> extract_direct(const Grid& grid, const PointField& field,
                                            std::span<const double> isovalues, const DirectOptions& options,
                                            const Run& run) const override {
        return extract_direct_(grid, field, isovalues, options, run);
    }

private:
    std::string_view name_;
    ExtractPacked extract_;
    ExtractDirect extract_direct_;
};

} // namespace

Result<DirectExtraction> Engine::extract_direct(const Grid&, const PointField&, std::span<const double>,
                                                const DirectOptions&, const Run&) const {
    return Error{ErrorCode::internal, "the " + std::string(name()) + " engine extracts from packed grids only"};
}

std::shared_ptr<const Engine> api::engine_in_memory(std::string_view name, ExtractPacked packed, ExtractDirect direct) {
    return std::make_shared<const EngineInMemory>(name, packed, direct);
}

std::shared_ptr<const Engine> cpu_engine() {
    using enum api::Kernels;
    static const auto engine = api::engine_in_memory("cpu", api::extract_by<cpu>, api::extract_direct_by<cpu>);
    return engine;
}

std::shared_ptr<const Engine> reference_engine() {
    using enum api::Kernels;
    static const auto engine =
        api::engine_in_memory("reference", api::extract_by<reference>, api::extract_direct_by<reference>);
    return engine;
}

} // namespace isotet
