// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Grids in the browser: a server, and the files that it shows.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>

#include <isotet/result.hpp>

#include "view/viewer_options.hpp"

namespace isotet::view {

/// 128 random bits as 32 hexadecimal digits. Errors   system
Result<std::string> random_token();

class Viewer {
public:
    /// Opens the port; nothing is read yet. Errors   system
    static Result<std::unique_ptr<Viewer>> open(ViewerOptions options);
    ~Viewer();

    /// "http://127.0.0.1:PORT/#TOKEN", with two files "http://127.0.0.1:PORT/beside.html?second#TOKEN"; with a Unix socket
    /// of localhost, and the port that it is forwarded to
    std::string address() const;
    std::uint16_t port() const noexcept;
    const std::string& token() const noexcept;

    /// Serves pages, reads the files and packs them meanwhile, until `stop`, or until the last page is gone for long.
    ///
    /// Errors   of reading where no file could be read; a page was told, if one came
    Result<void> run(const std::atomic<bool>& stop);

    /// Why run() ended: a sentence, or empty where it was told to.
    const std::string& reason() const noexcept;

private:
    struct Data;
    explicit Viewer(std::unique_ptr<Data> data);
    std::unique_ptr<Data> data_;
};

} // namespace isotet::view
