// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "kept_speeds.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <isotet/version.hpp>

#include "build_facts.hpp"
#include "core/cache_folder.hpp"
#include "json_output.hpp"
#include "text_file.hpp"
#include "thread_count.hpp"

namespace isotet::cli {

namespace {

constexpr std::size_t most_bytes = 1 << 20;
/// Systems, clocks and neighbours change: after that long figures are measured again.
constexpr std::chrono::hours oldest = std::chrono::days(90);
constexpr const char* when = "measured"; ///< seconds since 1970

std::int64_t seconds_since_1970() {
    return std::chrono::duration_cast<std::chrono::seconds>(std::chrono::system_clock::now().time_since_epoch())
        .count();
}

/// A time that is still to come tells nothing either: the clock was set.
bool is_fresh(const Json& entry) {
    if (!entry.is_object() || !entry.contains(when) || !entry[when].is_number_integer()) return false;
    const auto measured = entry[when].get<std::int64_t>();
    const std::int64_t now = seconds_since_1970();
    return measured <= now && measured >= now - std::chrono::seconds(oldest).count();
}

std::filesystem::path file_of_speeds() {
    const std::filesystem::path folder = core::cache_folder();
    return folder.empty() ? folder : folder / "speeds.json";
}

/// Another build may be faster or slower: its figures are not read.
constexpr std::string_view build = ISOTET_VERSION " " ISOTET_COMMIT " " ISOTET_BUILD_TYPE " " ISOTET_SANITIZERS;

/// The file as it should be; an empty one of this build otherwise.
Json read_file() {
    const Json empty = {{"build", build}, {"speeds", Json::object()}};
    const std::filesystem::path path = file_of_speeds();
    std::error_code failed;
    if (path.empty() || std::filesystem::file_size(path, failed) > most_bytes || failed) return empty;
    std::ifstream file(path);
    Json kept = Json::parse(file, nullptr, false);
    const bool whole = kept.is_object() && kept.contains("build") && kept["build"].is_string() &&
                       kept.contains("speeds") && kept["speeds"].is_object();
    return whole && kept["build"].get<std::string>() == build ? kept : empty;
}

using Numbers = std::vector<std::pair<const char*, double*>>;

Numbers numbers_of(Speeds& speeds) {
    return {{"pack_call", &speeds.pack_call},
            {"pack_tet", &speeds.pack_tet},
            {"pack_gradient_tet", &speeds.pack_gradient_tet},
            {"brute_call", &speeds.brute_call},
            {"brute_tet", &speeds.brute_tet},
            {"brute_triangle", &speeds.brute_triangle},
            {"brute_gradient_tet", &speeds.brute_gradient_tet},
            {"clusters_call", &speeds.clusters_call},
            {"clusters_tet", &speeds.clusters_tet},
            {"clusters_triangle", &speeds.clusters_triangle}};
}

Numbers numbers_of(DeviceSpeeds& speeds) {
    return {{"upload_tet", &speeds.upload_tet},
            {"call", &speeds.call},
            {"tet", &speeds.tet},
            {"triangle", &speeds.triangle}};
}

template <class AnySpeeds>
std::optional<AnySpeeds> find(const std::string& key) {
    const Json kept = read_file()["speeds"];
    if (!kept.contains(key) || !is_fresh(kept[key])) return {};
    AnySpeeds speeds;
    for (const auto& [name, number] : numbers_of(speeds)) {
        if (!kept[key].contains(name) || !kept[key][name].is_number()) return {};
        *number = kept[key][name].template get<double>();
        if (!std::isfinite(*number) || *number < 0) return {};
    }
    const bool any = std::ranges::any_of(numbers_of(speeds), [](const auto& named) { return *named.second > 0; });
    return any ? std::optional(speeds) : std::nullopt;
}

template <class AnySpeeds>
void add(const std::string& key, AnySpeeds speeds) {
    const std::filesystem::path path = file_of_speeds();
    if (path.empty()) return;
    Json kept = read_file();
    Json entry = {{when, seconds_since_1970()}};
    for (const auto& [name, number] : numbers_of(speeds)) entry[name] = *number;
    kept["speeds"][key] = std::move(entry);
    std::error_code failed;
    std::filesystem::create_directories(path.parent_path(), failed);
    (void)write_text_file(path.string(), kept.dump(2, ' ', false, Json::error_handler_t::replace) + "\n", {});
}

} // namespace

std::optional<Speeds> kept_speeds(const std::string& key) { return find<Speeds>(key); }
std::optional<DeviceSpeeds> kept_device_speeds(const std::string& key) { return find<DeviceSpeeds>(key); }

void keep(const std::string& key, const Speeds& speeds) { add(key, speeds); }
void keep(const std::string& key, const DeviceSpeeds& speeds) { add(key, speeds); }

std::string processor_name(std::istream& cpuinfo) {
    const auto trimmed = [](std::string_view text) {
        const std::size_t begin = text.find_first_not_of(" \t"), end = text.find_last_not_of(" \t");
        return begin == text.npos ? std::string() : std::string(text.substr(begin, end - begin + 1));
    };
    std::vector<std::string> kinds; // each once: some machines have fast processors and slow ones
    std::string implementer;
    for (std::string line; std::getline(cpuinfo, line);) {
        const std::size_t colon = line.find(':');
        if (colon == line.npos) continue;
        const std::string key = trimmed(std::string_view(line).substr(0, colon)),
                          value = trimmed(std::string_view(line).substr(colon + 1));
        if (key == "CPU implementer") implementer = value;
        std::string kind;
        if (key == "model name" || key == "cpu" || key == "uarch") kind = value; // of x86, POWER, RISC-V
        else if (key == "CPU part") kind = fmt::format("ARM {}/{}", implementer, value);
        if (!kind.empty() && std::ranges::find(kinds, kind) == kinds.end()) kinds.push_back(kind);
    }
    if (kinds.empty()) return "a processor";
    return fmt::format("{}", fmt::join(kinds, " and "));
}

std::string processor_key(int threads) {
    std::ifstream cpuinfo("/proc/cpuinfo");
    return json_text(fmt::format("{}, {} threads", processor_name(cpuinfo), thread_count(threads))).get<std::string>();
}

std::string device_key(const DeviceInfo& info, int threads) {
    return json_text(fmt::format("{}, {}, beside {} threads", info.name, info.driver, thread_count(threads)))
        .get<std::string>();
}

} // namespace isotet::cli
