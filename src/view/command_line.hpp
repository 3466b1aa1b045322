// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A state as a command line that gives the same, and back.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <isotet/result.hpp>

#include "view/state.hpp"

namespace isotet::view {

/// The words of `isotet render FILE ...`, and of `isotet extract FILE ...`, which has what a surface is made of alone.
/// `reading`   options that say how the file is read, such as {"--step", "3"}; they stand behind FILE
std::vector<std::string> render_words(const ViewState& state, const std::string& file,
                                      const std::vector<std::string>& reading = {});
std::vector<std::string> extract_words(const ViewState& state, const std::string& file,
                                       const std::vector<std::string>& reading = {});
/// The same for all time steps, a file each.
std::vector<std::string> extract_all_words(ViewState state, const std::string& file,
                                           const std::vector<std::string>& reading = {});

/// Words as a shell takes them, quoted where they must be.
std::string shell_text(const std::vector<std::string>& words);

/// The words of a text by the rules of a shell: blanks, '...', "..." and \. Nothing is expanded.
/// Errors   invalid_argument when a quotation does not end
Result<std::vector<std::string>> shell_words(std::string_view text);

/// Where a command line looks from that has no --camera.
///
/// `camera`   its direction, its upper side and its projection; the page makes it see all
/// `up`       "z", "-y" and so on
struct PastedLook {
    Camera camera;
    std::string up;
    double zoom = 1;
};

/// What a page takes of a command line.
struct PastedCommand {
    ViewState state;
    std::string file;                  ///< that it names; empty: none
    std::optional<PastedLook> look;    ///< nothing: a camera in `state`, or none is said
    std::vector<std::string> left_out; ///< options that change what is seen and that the page lacks, with their values
};

/// A command line for render, extract, view or slice, or options alone. Slices come without isosurfaces where no isovalue is
/// given, as isotet render draws them.
/// `reading`   options that the page's file is read with: they are not left out
///
/// Errors   invalid_argument: another program; an option of the page without its value, or with a wrong one
Result<PastedCommand> state_of_command(std::string_view text, const std::vector<std::string>& reading = {});

} // namespace isotet::view
