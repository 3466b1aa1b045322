// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The formats, one function each. They run in the reader process only.
#pragma once

#include "io/vtk/loaded.hpp"

namespace isotet::io::vtk {

Result<Loaded> load_vtu(const std::string& path, const ReadOptions& options, Depth depth);
Result<Loaded> load_vti(const std::string& path, const ReadOptions& options, Depth depth);
Result<Loaded> load_vtr(const std::string& path, const ReadOptions& options, Depth depth);
Result<Loaded> load_vts(const std::string& path, const ReadOptions& options, Depth depth);
Result<Loaded> load_pvtu(const std::string& path, const ReadOptions& options, Depth depth);
Result<Loaded> load_pvd(const std::string& path, const ReadOptions& options, Depth depth);
Result<Loaded> load_legacy(const std::string& path, const ReadOptions& options, Depth depth);
Result<Loaded> load_exodus(const std::string& path, const ReadOptions& options, Depth depth);
Result<Loaded> load_cgns(const std::string& path, const ReadOptions& options, Depth depth);
Result<Loaded> load_vtkhdf(const std::string& path, const ReadOptions& options, Depth depth);
Result<Loaded> load_ensight(const std::string& path, const ReadOptions& options, Depth depth);
Result<Loaded> load_openfoam(const std::string& path, const ReadOptions& options, Depth depth);
Result<Loaded> load_ucd(const std::string& path, const ReadOptions& options, Depth depth);
Result<Loaded> load_xdmf(const std::string& path, const ReadOptions& options, Depth depth);

/// Surfaces that need VTK: VTP of any encoding, legacy polygon data.
Result<SurfaceFile> load_surface(const std::string& path);

} // namespace isotet::io::vtk
