// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "jobs/pictures/picture_files.hpp"

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <isotet/jobs/number_text.hpp>
#include <isotet/jobs/output_names.hpp>
#include <isotet/picture.hpp>

#include "jobs/refuse.hpp"

namespace isotet::jobs {

namespace {

constexpr std::string_view number_mark = "{frame}";
constexpr double max_frames = 100'000;

} // namespace

Result<std::size_t> count_frames(const DrawJob& job, std::size_t steps) {
    if (job.orbit > 0) return static_cast<std::size_t>(job.orbit);
    if (job.sweep.empty()) return steps;
    if (job.sweep.size() != 3)
        return refusal("`sweep` takes three numbers, not {}: the first isovalue, the last one, and how many, such "
                       "as 0,1,50",
                       job.sweep.size());
    const double count = job.sweep[2];
    if (count < 2 || count > max_frames || count != std::floor(count))
        return refusal("`sweep` ends with {}, but there must be 2 to {} isovalues", shortest(count),
                       shortest(max_frames));
    return static_cast<std::size_t>(count);
}

Result<std::vector<Frame>> frames_of(const DrawJob& job, const DrawInput& input, std::size_t steps) {
    const Result<std::size_t> count = count_frames(job, steps);
    if (!count) return count.error();
    std::vector<Frame> frames(*count, {input.isovalues, 0, 0});
    for (std::size_t i = 0; i < frames.size(); ++i) {
        if (job.orbit > 0) frames[i].azimuth = 360 * static_cast<double>(i) / static_cast<double>(frames.size());
        if (steps > 1) frames[i].step = i;
        if (job.sweep.empty()) continue;
        const double part = static_cast<double>(i) / static_cast<double>(frames.size() - 1);
        frames[i].isovalues = {(1 - part) * input.sweep[0] + part * input.sweep[1]};
    }
    return frames;
}

Result<PictureFiles> PictureFiles::open(const std::string& out, std::size_t pictures, bool is_series,
                                        double pictures_per_second) {
    if (auto known = check_placeholders(out, {std::string(number_mark)}); !known) return known.error();
    PictureFiles files(out, pictures);
    const bool numbered = out.find(number_mark) != std::string::npos;
    if (pictures == 1 && is_series && out.ends_with(".png")) return files; // with a number or without
    if (pictures == 1 && !is_series) {
        if (!out.ends_with(".png"))
            return refusal("the name of the output is '{}', but it must end in .png, or in .webp for several pictures",
                           out);
        if (numbered)
            return refusal("the name of the output is '{}', but there is one picture: only those of `sweep`, `orbit` "
                           "or `all_steps` "
                           "have numbers",
                           out);
        return files;
    }
    if (out.ends_with(".webp") && !numbered) {
        Result<Animation> animation = Animation::create(out, pictures_per_second);
        if (!animation) return animation.error();
        files.animation_ = *std::move(animation);
        return files;
    }
    if (out.ends_with(".png") && numbered) return files;
    return refusal("the name of the output is '{}', but {} pictures need one that ends in .webp, or that holds {} "
                   "and ends in .png (of these, ffmpeg makes films)",
                   out, pictures, number_mark);
}

std::string PictureFiles::name(std::size_t picture) const {
    std::string name = out_;
    const std::size_t at = name.find(number_mark);
    if (at == std::string::npos) return name;
    const std::size_t digits = std::to_string(pictures_).size();
    return name.replace(at, number_mark.size(), fmt::format("{:0{}}", picture + 1, digits));
}

std::vector<std::string> PictureFiles::names() const {
    std::vector<std::string> names{name(0)};
    for (std::size_t i = 1; i < pictures_ && !animation_; ++i) names.push_back(name(i));
    return names;
}

std::string PictureFiles::film_command(double pictures_per_second) const {
    const std::size_t at = out_.find(number_mark);
    if (at == std::string::npos) return {};
    std::string pattern = out_;
    pattern.replace(at, number_mark.size(), fmt::format("%0{}d", std::to_string(pictures_).size()));
    return fmt::format("ffmpeg -framerate {} -i '{}' -pix_fmt yuv420p film.mp4", shortest(pictures_per_second),
                       pattern);
}

Result<void> PictureFiles::add(const Picture& picture) {
    if (animation_) return animation_->add(picture);
    const Result<std::uint64_t> written = write_picture(picture, name(added_++));
    if (!written) return written.error();
    bytes_ += *written;
    return {};
}

Result<void> PictureFiles::finish() {
    if (!animation_) return {};
    const Result<std::uint64_t> written = animation_->finish();
    if (!written) return written.error();
    bytes_ = *written;
    return {};
}

Result<void> PictureWriter::add(std::shared_ptr<const Picture> picture) {
    if (!beside_) return files_.add(*picture);
    if (Result<void> done = wait(); !done) return done;
    writing_ = std::async(std::launch::async, [this, picture = std::move(picture)] { return files_.add(*picture); });
    return {};
}

Result<void> PictureWriter::finish() {
    if (Result<void> done = wait(); !done) return done;
    return files_.finish();
}

Result<void> PictureWriter::wait() { return writing_.valid() ? writing_.get() : Result<void>(); }

} // namespace isotet::jobs
