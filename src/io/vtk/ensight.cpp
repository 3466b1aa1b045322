// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// EnSight Gold and 6, ascii and binary: a case file names the files of geometry and variables; parts are pieces.
#include <vtkEnSight6BinaryReader.h>
#include <vtkGenericEnSightReader.h>
#include <vtkNew.h>

#include "io/own/text_scanner.hpp"
#include "io/own/index_file.hpp"
#include "io/vtk/ensight_check.hpp"
#include "io/vtk/loaders.hpp"
#include "io/vtk/mapped_file.hpp"
#include "io/vtk/vtk_load.hpp"

namespace isotet::io::vtk {
namespace {

/// "model: 1 file.geo", "scalar per node: 1 pressure file.p**": the last word of the line is a file name, where a star
/// stands for a digit of the step.
Result<void> check_names(const std::string& path, bool allow_outside) {
    auto file = MappedFile::open(path);
    if (!file) return file.error();
    TextScanner scanner(file->text());
    while (!scanner.at_end()) {
        std::string_view line = scanner.line();
        const bool names_file = line.starts_with("model:") || line.starts_with("measured:") ||
                                line.starts_with("match:") || line.starts_with("boundary:") ||
                                line.starts_with("rigid_body:") || line.find(" per ") != std::string_view::npos;
        if (!names_file || line.starts_with("constant per case")) continue;
        while (!line.empty() && is_space(line.back())) line.remove_suffix(1);
        for (std::string_view last = line.substr(line.find(':') + 1);
             !last.empty();) { // every word of it, so none is missed
            const auto begin = last.find_first_not_of(" \t\"");
            if (begin == std::string_view::npos) break;
            const auto end = std::min(last.find_first_of(" \t\"", begin), last.size());
            if (auto allowed = check_name(path, last.substr(begin, end - begin), allow_outside); !allowed)
                return allowed;
            last.remove_prefix(end);
        }
    }
    return {};
}

Result<Loaded> load_by(vtkGenericEnSightReader& reader, const std::string& path, const ReadOptions& options,
                       Depth depth) {
    reader.SetCaseFileName(path.c_str());
    reader.ReadAllVariablesOff();
    return load_with(
        reader, path, options, depth,
        [&](const ReadOptions& chosen, FileInfo& info) { choose_arrays_by_name(reader, chosen, info); }, "part");
}

} // namespace

Result<Loaded> load_ensight(const std::string& path, const ReadOptions& options, Depth depth) {
    if (auto allowed = check_names(path, options.allow_outside); !allowed) return allowed.error();
    const auto checked = check_ensight(path, options.step.value_or(0));
    if (!checked) return checked.error();
    if (!*checked) return load_by(*vtkNew<vtkGenericEnSightReader>(), path, options, depth);
    vtkNew<vtkEnSight6BinaryReader> reader;
    reader->SetByteOrder((*checked)->is_big_endian ? vtkGenericEnSightReader::FILE_BIG_ENDIAN
                                                   : vtkGenericEnSightReader::FILE_LITTLE_ENDIAN);
    return load_by(*reader, path, options, depth);
}

} // namespace isotet::io::vtk
