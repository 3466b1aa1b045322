// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Races versions of the engine's kernels against each other: on a device, by turns, each surface compared with the CPU engine's;
// and as AMD's compiler sees them.
//
// usage: isotet_kernel_race DEVICE ROUNDS SHAPE SIDE CONTESTANT...
//     CONTESTANT   - for the kernels as built, or kernel=module.spv, several separated by commas:
//                  glslc -O0 --target-env=vulkan1.2 -I src/vulkan/kernels -o module.spv emit.comp
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <isotet/fields.hpp>
#include <isotet/device.hpp>
#include <isotet/extract.hpp>
#include <isotet/make.hpp>

#include "all_shaders.hpp"
#include "bench/kernels/null_device.hpp"
#include "vulkan/context.hpp"
#include "vulkan/devices/float_controls.hpp"

namespace {

using namespace isotet;
using Words = std::vector<std::uint32_t>;

struct Contestant {
    std::string text;
    std::map<std::string, Words> modules; ///< by kernel, in place of the built ones
    std::shared_ptr<vulkan::Context> context;
    std::optional<DeviceGrid> grid;
    DeviceSurface surface;
    std::map<std::string, std::vector<double>> seconds; ///< by pass
    bool same = true;
};

Words read_module(const std::string& file) {
    std::ifstream in(file, std::ios::binary | std::ios::ate);
    Words words(in ? static_cast<std::size_t>(in.tellg()) / 4 : 0);
    in.seekg(0).read(reinterpret_cast<char*>(words.data()), static_cast<std::streamsize>(words.size() * 4));
    if (words.empty()) std::fprintf(stderr, "cannot read %s\n", file.c_str()), std::exit(2);
    return words;
}

Contestant contestant_of(const std::string& text) {
    Contestant made;
    made.text = text;
    for (std::size_t at = 0; text != "-" && at < text.size();) {
        const std::size_t end = std::min(text.find(',', at), text.size()), equals = text.find('=', at);
        if (equals >= end) std::fprintf(stderr, "%s is not kernel=module.spv\n", text.c_str()), std::exit(2);
        made.modules[text.substr(at, equals - at)] = read_module(text.substr(equals + 1, end - equals - 1));
        at = end + 1;
    }
    return made;
}

// The hook of the driver has no pointer of its own: the contestant whose kernels are being made, and the driver's function.
const Contestant* making = nullptr;
PFN_vkCreateShaderModule make_module = nullptr;

VkResult VKAPI_CALL make_replaced(VkDevice device, const VkShaderModuleCreateInfo* info,
                                  const VkAllocationCallbacks* allocator, VkShaderModule* module) {
    const Words given(info->pCode, info->pCode + info->codeSize / 4);
    for (const auto& [name, words] : making->modules)
        for (const vulkan::ShaderCode* code : vulkan::all_shaders::every)
            for (unsigned bits = 0; name == code->name && bits < 4; ++bits) {
                const vulkan::FloatControls controls{(bits & 1) != 0, (bits & 2) != 0};
                if (vulkan::with_float_controls(code->words, controls) != given) continue;
                const Words replaced = vulkan::with_float_controls(words, controls);
                VkShaderModuleCreateInfo changed = *info;
                changed.codeSize = replaced.size() * 4;
                changed.pCode = replaced.data();
                return make_module(device, &changed, allocator, module);
            }
    return make_module(device, info, allocator, module);
}

bool same_bytes(const Array& a, const Array& b) {
    return a.bytes() == b.bytes() && (a.bytes() == 0 || std::memcmp(a.data(), b.data(), a.bytes()) == 0);
}

bool same_as_cpu(Contestant& one, const PackedGrid& packed, double isovalue) {
    const Extraction found = one.grid->download(one.surface).value(), right = extract(packed, isovalue).value();
    return same_bytes(found.surface.triangles, right.surface.triangles) &&
           same_bytes(found.surface.positions, right.surface.positions);
}

void open(Contestant& one, const std::string& device, const PackedGrid& packed, const std::vector<double>& isovalues) {
    vulkan::Settings settings;
    settings.cache_folder = "";
    settings.alter_functions = [](vulkan::DeviceFunctions& functions) {
        make_module = functions.vkCreateShaderModule;
        functions.vkCreateShaderModule = &make_replaced;
    };
    making = &one;
    one.context = vulkan::Context::open({device, 0}, settings).value();
    one.grid = DeviceGrid::upload(Device(one.context), packed).value();
    for (const double isovalue : isovalues) { // kernels are made, arrays grow; at 0 there are ties
        one.grid->extract(isovalue, one.surface).value();
        one.same = one.same && same_as_cpu(one, packed, isovalue);
    }
}

void race(std::vector<Contestant>& all, const std::vector<double>& isovalues, int rounds) {
    for (int round = 0; round < rounds; ++round)
        for (const double isovalue : isovalues)
            for (Contestant& one : all) {
                making = &one;
                one.grid->extract(isovalue, one.surface).value();
                for (const DevicePass& pass : one.grid->work().passes) one.seconds[pass.name].push_back(pass.seconds);
            }
}

void print_times(Contestant& one) {
    std::printf("%s: %s\n", one.text.c_str(), one.same ? "the CPU's bytes" : "OTHER BYTES");
    for (auto& [pass, seconds] : one.seconds) {
        if (!pass.starts_with("emit") && pass != "count") continue;
        std::sort(seconds.begin(), seconds.end());
        std::printf("    %-16s ms: least %.3f, quarter %.3f, median %.3f\n", pass.c_str(), 1e3 * seconds.front(),
                    1e3 * seconds[seconds.size() / 4], 1e3 * seconds[seconds.size() / 2]);
    }
}

/// Waves of each set of constants of count and emit that bench/kernels/vendors.py tells apart.
void print_figures(const std::vector<Contestant>& all) {
    const auto driver = bench::driver_beside_software_device();
    if (!driver) return;
    for (const char* family : {"navi31", "navi21", "vega10"}) {
        const auto device = bench::NullDevice::open(*driver, family).value();
        for (const Contestant& one : all)
            for (bench::Pipeline pipeline : bench::all_pipelines()) {
                const bool is_least = pipeline.variant.find("ends") == std::string::npos;
                if (pipeline.name != "emit" && pipeline.name != "count") continue;
                if (pipeline.variant.find("ources") != std::string::npos && is_least) continue;
                if (pipeline.variant.find("normals") != std::string::npos && is_least) continue;
                const auto found = one.modules.find(pipeline.name);
                if (found == one.modules.end() && one.text != "-") continue;
                vulkan::ShaderCode code = *pipeline.stages[0].code;
                if (found != one.modules.end()) code.words = found->second;
                pipeline.stages[0].code = &code;
                const bench::Figures f = device->compile(pipeline).value().front();
                const auto number = [](std::uint64_t value) { return static_cast<unsigned long long>(value); };
                std::printf("%s %s %s (%s): registers %llu, shared %llu, spills %llu, waves %llu, instructions %llu, "
                            "latency %llu, cycles %llu\n",
                            family, one.text.c_str(), pipeline.name.c_str(), pipeline.variant.c_str(),
                            number(f.vector_registers), number(f.shared_bytes),
                            number(f.spilled_scalars + f.spilled_vectors + f.scratch_bytes), number(f.waves),
                            number(f.instructions), number(f.latency), number(f.inverse_throughput));
            }
    }
}

} // namespace

int main(int count, char** words) {
    if (count < 6) return std::fprintf(stderr, "usage: isotet_kernel_race DEVICE ROUNDS SHAPE SIDE CONTESTANT...\n"), 2;
    const int rounds = std::atoi(words[2]);
    std::vector<Contestant> all;
    for (int i = 5; i < count; ++i) all.push_back(contestant_of(words[i]));
    if (rounds == 0) return print_figures(all), 0;
    const Grid grid =
        make_grid({.shape = words[3], .side = static_cast<std::uint64_t>(std::atoi(words[4])), .fields = {"gyroid"}})
            .value();
    const PackedGrid packed = pack(grid, find_field(grid, "gyroid").value()).value();
    const std::vector<double> isovalues{0.0, 0.1};
    for (Contestant& one : all) open(one, words[1], packed, isovalues);
    race(all, isovalues, rounds);
    for (Contestant& one : all) print_times(one);
    return 0;
}
