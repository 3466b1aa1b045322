// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The program isotet.
#include <new>

#include <fmt/format.h>

#include "output/console.hpp"
#include "exit_code.hpp"
#include "program.hpp"
#include "output/signals.hpp"
#include "output/standard_streams.hpp"

int main(int argc, char** argv) {
    using namespace isotet;
    cli::open_missing_streams();
    cli::install_signal_handlers();
    try {
        return static_cast<int>(cli::run_program({argv, argv + argc}));
    } catch (const std::bad_alloc&) {
        cli::say_error("out of memory: the machine has less free than was needed");
        return static_cast<int>(cli::ExitCode::machine);
    } catch (const std::exception& fault) {
        cli::say_error(fmt::format("a bug of isotet, please report it: {}", fault.what()));
        return static_cast<int>(cli::ExitCode::fault);
    }
}
