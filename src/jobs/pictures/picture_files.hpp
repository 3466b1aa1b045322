// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The pictures of one job: one, or with `sweep` and `orbit` many; and the files that they go to.
#pragma once

#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <isotet/picture.hpp>
#include <isotet/jobs/draw_files.hpp>

namespace isotet::jobs {

/// One of the pictures.
struct Frame {
    std::vector<double> isovalues;
    double azimuth = 0;   ///< degrees to the right of `view`
    std::size_t step = 0; ///< of those that are drawn
};

/// With `sweep` a picture for each isovalue, with `orbit` one from each side, else one for each step.
/// Errors   invalid_argument when `sweep` does not make sense
Result<std::vector<Frame>> frames_of(const DrawJob& job, const DrawInput& input, std::size_t steps);

/// How many those will be.
Result<std::size_t> count_frames(const DrawJob& job, std::size_t steps);

/// OUT: a PNG file; numbered ones, where it holds {frame}; or one animated WebP file.
class PictureFiles {
public:
    /// `is_series`   there may be several, though there is one this time
    /// Errors   invalid_argument when the name does not fit the number of pictures
    static Result<PictureFiles> open(const std::string& out, std::size_t pictures, bool is_series,
                                     double pictures_per_second);

    const std::string& out() const noexcept { return out_; }
    std::vector<std::string> names() const; ///< of all files

    /// The command of FFmpeg that makes a film of numbered files; empty where there are none.
    std::string film_command(double pictures_per_second) const;

    Result<void> add(const Picture& picture);
    Result<void> finish();
    std::uint64_t bytes() const noexcept { return bytes_; } ///< of all files that are written

private:
    PictureFiles(std::string out, std::size_t pictures) : out_(std::move(out)), pictures_(pictures) {}
    std::string name(std::size_t picture) const;

    std::string out_;
    std::size_t pictures_, added_ = 0;
    std::optional<Animation> animation_;
    std::uint64_t bytes_ = 0;
};

/// Writes a picture while the next one is drawn: on a thread of its own, one at a time, in the order in which they come.
class PictureWriter {
public:
    /// `beside`   false: add() writes, and there is no other thread
    PictureWriter(PictureFiles& files, bool beside) : files_(files), beside_(beside) {}

    /// Waits for the one before. Errors   as PictureFiles::add(), of that one or of this one
    Result<void> add(std::shared_ptr<const Picture> picture);
    /// Waits for the last one, and finishes the files.
    Result<void> finish();

private:
    Result<void> wait();

    PictureFiles& files_;
    bool beside_;
    std::future<Result<void>> writing_; ///< waits when it goes
};

} // namespace isotet::jobs
