// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// isotet._isotet: the library, call by call. What users see is in isotet/*.py.
#include <nanobind/nanobind.h>

#include <isotet/version.hpp>

#include "call.hpp"
#include "parts.hpp"

NB_MODULE(_isotet, module) {
    using namespace isotet::python;
    nanobind::set_leak_warnings(false); // VTK keeps filters until the very end of the process
    module.attr("__version__") = ISOTET_VERSION;
    prepare_calls(module);
    add_grids(module);
    add_surfaces(module);
    add_pieces(module);
    add_pictures(module);
    add_contours(module);
    add_linear(module);
    add_packed_files(module);
}
