// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What --version prints: which build this is, and of what.
#include <CLI/Version.hpp>
#include <fmt/format.h>

#include <isotet/read.hpp>
#include <isotet/version.hpp>

#include "build_facts.hpp"
#include "commands.hpp"
#include "output/report.hpp"

namespace isotet::cli {

namespace {

#if defined(__clang__)
constexpr const char* compiler = "clang " __clang_version__;
#else
constexpr const char* compiler = "g++ " __VERSION__;
#endif

} // namespace

std::string version_text() {
    Table table = facts();
    const std::string commit = ISOTET_COMMIT;
    table.row({"isotet", ISOTET_VERSION});
    table.row({"commit", commit.empty() ? "unknown" : commit});
    table.row({"compiler", fmt::format("{}, {} build{}", compiler, ISOTET_BUILD_TYPE,
                                       *ISOTET_SANITIZERS ? ", sanitizers " ISOTET_SANITIZERS : "")});
    const ReaderConfinement confined = reader_confinement();
    constexpr const char* lacking = "not confined: the kernel lacks it";
    table.row({"isotet-reader",
               ISOTET_READER ? fmt::format("files {} (Landlock), calls {} (seccomp)",
                                           confined.files ? "confined" : lacking, confined.calls ? "confined" : lacking)
                             : "off (-DISOTET_IO=OFF)"});
    table.row({"Vulkan", ISOTET_VULKAN ? "on, opened at run time" : "off (-DISOTET_VULKAN=OFF)"});
    table.row({"libraries", fmt::format("oneTBB {}, fmt {}.{}.{}, CLI11 {}, nlohmann_json {}", ISOTET_TBB_VERSION,
                                        FMT_VERSION / 10000, FMT_VERSION / 100 % 100, FMT_VERSION % 100, CLI11_VERSION,
                                        ISOTET_JSON_VERSION)});
    return table.text();
}

} // namespace isotet::cli
