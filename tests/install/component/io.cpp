// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A surface to a file and back; VTK is neither linked nor loaded.
#include <dlfcn.h>

#include <isotet/read.hpp>
#include <isotet/write.hpp>

int main() {
    isotet::Surface surface;
    surface.positions = isotet::Array::own(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0}, 3);
    surface.triangles = isotet::Array::own(std::vector<std::uint32_t>{0, 1, 2}, 3);
    if (!isotet::write_surface(surface, "one.ply")) return 1;
    const auto read = isotet::read_surface("one.ply");
    const bool vtk = ::dlsym(RTLD_DEFAULT, "H5open") || ::dlsym(RTLD_DEFAULT, "vtkGetDataArrayTypeMin");
    return read && read->surface.triangle_count() == 1 && !vtk ? 0 : 1;
}
