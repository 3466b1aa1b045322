// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// One file of a viewer: its grid, the worker that makes frames of it, and what its pages are told.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "view/server/download.hpp"
#include "view/grid_view.hpp"
#include "view/messages.hpp"
#include "view/export/save.hpp"
#include "view/server/server.hpp"
#include "view/viewer_options.hpp"
#include "view/server/worker.hpp"

namespace isotet::view {

/// Threads   one call at a time, but failed()
class ViewedFile {
public:
    /// Begins to read and pack it. All three must outlive it.
    /// `other`   the name of the file that is shown beside it, or empty
    ViewedFile(const ViewerFile& file, const ViewerOptions& options, std::string other, Server& server);
    ViewedFile(const ViewedFile&) = delete;
    ViewedFile& operator=(const ViewedFile&) = delete;
    ~ViewedFile(); ///< cancels reading and packing

    void add_page(ConnectionNumber page);
    void remove_page(ConnectionNumber page);
    /// Of a page that was added.
    void answer(ConnectionNumber from, PageMessage message);
    /// Tells its pages what is new.
    void tick();

    struct Failure {
        Error error;
        double at = 0;     ///< in seconds of now_seconds(); once it was told: when it was told first
        bool told = false; ///< to a page
    };
    std::optional<Failure> failure() const;

private:
    void read_and_pack();
    void tell_progress(std::string_view step, double fraction);
    void set_grid(const ViewerInput& input);
    void set_failure(const Error& error);
    void save(ConnectionNumber from, const SaveRequest& request);
    void download(ConnectionNumber from, const SaveRequest& request);
    void told_failure();

    const ViewerFile& file_;
    const ViewerOptions& options_;
    std::string other_;
    Server& server_;
    std::vector<ConnectionNumber> pages_;

    mutable std::mutex news_mutex_; ///< of what the reading thread tells
    std::string progress_;
    bool news_ = false;
    std::string grid_text_; ///< once it is read
    bool grid_is_new_ = false;
    std::optional<Failure> failure_;

    std::unique_ptr<GridView> view_;
    std::optional<Worker> worker_;
    Downloads downloads_;
    std::optional<Saver> saver_;      ///< with ViewerOptions::out
    ConnectionNumber saving_for_ = 0; ///< whose file is written, or was last
    std::atomic<bool> stop_{false};   ///< of reading and packing
    std::thread reader_;
};

double now_seconds();

} // namespace isotet::view
