// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include <isotet/export.hpp>
#include <isotet/picture.hpp>
#include <isotet/result.hpp>

namespace isotet {

/// Pictures one after another in one file, for ever: animated WebP, which browsers and slides show. The file is there
/// when finish() has written it; without that nothing is written. Moving is cheap.
class ISOTET_API Animation {
public:
    /// `path`                 ends in .webp
    /// `pictures_per_second`  above 0, at most 100
    /// Errors   invalid_argument
    static Result<Animation> create(const std::string& path, double pictures_per_second);

    Animation(Animation&&) noexcept;
    Animation& operator=(Animation&&) noexcept;
    ~Animation();

    /// Appends a picture; all have the size of the first. It is compressed with losses that are hard to see.
    ///
    /// Cost     what the compressed pictures take stays in memory until finish()
    /// Errors   invalid_argument when it has no pixels, more than 16383 in a row or column, or another size;
    ///          out_of_memory
    Result<void> add(const Picture& picture);

    /// Writes the file, beside and renamed as all files. Returns its bytes. Nothing can be added afterwards.
    ///
    /// Guarantees   the same bytes for the same pictures (and version of libwebp)
    /// Errors       invalid_argument when there is no picture; file, cannot_write as write_picture()
    Result<std::uint64_t> finish();

private:
    struct Encoder;
    explicit Animation(std::unique_ptr<Encoder> encoder);
    std::unique_ptr<Encoder> encoder_;
};

} // namespace isotet
