// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Compiles every pipeline for three families of AMD's, without a card, and prints what the compiler makes of them.
//
// usage: isotet_gpu_kernels [all] [DRIVER]    all: a line for every set of constants, not the heaviest of each kernel
#include <algorithm>
#include <cstdio>
#include <map>
#include <string>
#include <string_view>

#include "bench/kernels/null_device.hpp"

namespace {

using namespace isotet::bench;

constexpr const char* families[] = {"navi31", "navi21", "vega10"};

struct Row {
    std::string name, variant;
    Figures figures[3];
};

/// Keeps the row that holds the fewest waves, then the one with the most instructions.
bool is_heavier(const Row& a, const Row& b) {
    if (a.figures[0].waves != b.figures[0].waves) return a.figures[0].waves < b.figures[0].waves;
    return a.figures[0].instructions > b.figures[0].instructions;
}

void print(const Row& row) {
    const auto number = [](std::uint64_t value) { return static_cast<unsigned long long>(value); };
    std::printf("| %s%s%s |", row.name.c_str(), row.variant.empty() ? "" : ": ", row.variant.c_str());
    for (const Figures& f : row.figures) {
        if (!f.code) {
            std::printf(" - | - |");
            continue;
        }
        std::printf(" %llu, %llu, %llu | **%llu** |", number(f.vector_registers), number(f.shared_bytes),
                    number(f.spilled_scalars + f.spilled_vectors), number(f.waves));
    }
    const Figures& f = row.figures[0];
    std::printf(" %llu | %llu | %llu |\n", number(f.instructions), number(f.latency), number(f.inverse_throughput));
}

int run(bool all, const std::string& driver) {
    const std::vector<Pipeline> pipelines = all_pipelines();
    std::vector<Row> rows;
    std::map<std::pair<std::size_t, std::size_t>, std::size_t> places; // of a stage of a pipeline
    for (std::size_t family = 0; family < std::size(families); ++family) {
        const auto device = NullDevice::open(driver, families[family]);
        if (!device) return std::fprintf(stderr, "%s\n", device.error().message.c_str()), 1;
        for (std::size_t i = 0; i < pipelines.size(); ++i) {
            if (!(*device)->takes(pipelines[i])) continue;
            const auto figures = (*device)->compile(pipelines[i]);
            if (!figures) return std::fprintf(stderr, "%s\n", figures.error().message.c_str()), 1;
            for (std::size_t stage = 0; stage < figures->size(); ++stage) {
                const auto [place, fresh] = places.try_emplace({i, stage}, rows.size());
                if (fresh) rows.push_back({(*figures)[stage].code->name, pipelines[i].variant, {}});
                rows[place->second].figures[family] = (*figures)[stage];
            }
        }
    }
    std::printf("| kernel: constants |");
    for (const char* family : families) std::printf(" %s: registers, shared B, spills | waves |", family);
    std::printf(" instructions | latency | cycles a wave |\n|---|---|---:|---|---:|---|---:|---:|---:|---:|\n");
    std::vector<std::string> done;
    for (const Row& row : rows) {
        if (all) {
            print(row);
            continue;
        }
        if (std::ranges::find(done, row.name) != done.end()) continue;
        done.push_back(row.name);
        const Row* heaviest = &row;
        for (const Row& other : rows)
            if (other.name == row.name && is_heavier(other, *heaviest)) heaviest = &other;
        print(*heaviest);
    }
    return 0;
}

} // namespace

int main(int count, char** arguments) {
    const bool all = count > 1 && std::string_view(arguments[1]) == "all";
    const int used = all ? 2 : 1;
    if (count > used) return run(all, arguments[used]);
    const auto driver = driver_beside_software_device();
    if (!driver) return std::fprintf(stderr, "%s\n", driver.error().message.c_str()), 1;
    return run(all, *driver);
}
