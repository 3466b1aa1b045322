// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Files that a page asks for: command lines of this program, run as a process of their own, that write below one folder.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include <isotet/result.hpp>

#include "view/state.hpp"

namespace isotet::view {

enum class SaveKind : std::uint8_t {
    picture, ///< of the state, .png
    surface, ///< its isosurfaces, in a format that isotet extract writes
    sweep,   ///< pictures at isovalues from `from` to `to`, .webp
    turn,    ///< pictures once around, .webp
    steps,   ///< pictures of all time steps, .webp
    above,   ///< the part of the grid where the field is at least the isovalue, as a closed surface
    below,   ///< the part where it is less
    series   ///< isosurfaces of all time steps, .glb
};

/// "picture", "surface" and so on.
std::optional<SaveKind> parse_save_kind(std::string_view name);

struct SaveRequest {
    SaveKind kind = SaveKind::picture;
    std::string name; ///< of a file in the folder, without a path
    ViewState state;
    std::uint32_t width = 1200, height = 900; ///< pixels, 1 to 8192 each; of pictures
    double from = 0, to = 0;                  ///< of a sweep
    std::uint32_t pictures = 48;              ///< of a sweep or a turn, 2 to 1000
};

/// Whether a name is one file of a folder: letters, digits, blank, '.', '_', '-', '+' and '=', at most 100, not a dot first.
bool is_file_name(std::string_view name);

/// The command line of isotet that writes the file into `folder`.
///
/// Errors   invalid_argument: a name that is none or has the wrong ending, a size or number out of range
Result<std::vector<std::string>> save_words(const SaveRequest& request, const std::string& folder,
                                            const std::string& file, const std::vector<std::string>& reading);

/// Runs command lines one after another, one at a time. Files are written in a folder of their own below the one named, and
/// moved out of it when they are whole: nothing that came meanwhile is replaced, and no link is followed.
///
/// Threads   one call at a time
class Saver {
public:
    /// `program`   that runs command lines, this one as a rule
    /// `folder`    where files go
    Saver(std::string program, std::string folder) : program_(std::move(program)), folder_(std::move(folder)) {}
    Saver(const Saver&) = delete;
    Saver& operator=(const Saver&) = delete;
    ~Saver(); ///< ends what is going on

    const std::string& folder() const noexcept { return folder_; }

    /// Begins to write a file; `done` is called by a thread of its own, with the path or an error.
    /// `words`   a command line whose last word is the file's path
    /// Errors    invalid_argument when the file exists already, or another one is being written
    Result<void> start(std::vector<std::string> words, const std::string& name,
                       std::function<void(Result<std::string>)> done);

    /// Ends what is going on, soon: it is then an error.
    void stop() noexcept { stop_ = true; }
    bool busy() const noexcept { return busy_; }

private:
    Result<std::string> write(std::vector<std::string> words, const std::string& name) const;

    std::string program_, folder_;
    std::thread thread_;
    std::atomic<bool> busy_{false}, stop_{false};
};

} // namespace isotet::view
