// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A grid that a page looks at: its messages are answered as a server does it, by one thread.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <isotet/result.hpp>

#include "view/grid_view.hpp"
#include "view/json.hpp"
#include "view/messages.hpp"
#include "view/state.hpp"

namespace isotet::web {

/// What `isotet export` or the page says of a grid: {"file": name, "version": ..., "state": ..., "notes": [...],
/// "files": [path, ...]}, all but the state optional.
struct Told {
    std::string file;      ///< its name
    std::string version;   ///< of isotet
    view::ViewState state; ///< shown first
    std::vector<std::string> notes;
    std::vector<std::string> files; ///< to read: the grid, and others that are a time step each

    /// Errors   as view::state_of()
    static Result<Told> parse(std::string_view text);
};

class Looker {
public:
    Looker(std::unique_ptr<view::GridView> view, std::vector<double> times)
        : view_(std::move(view)), times_(std::move(times)) {}

    /// Tells the page what the grid is.
    void say_grid(const Told& told) const;

    void answer(view::PageMessage message);
    view::GridView& view() { return *view_; }

private:
    void show(const view::ShowMessage& message);

    std::unique_ptr<view::GridView> view_;
    std::vector<double> times_; ///< of its steps
    std::vector<std::string> known_;
};

} // namespace isotet::web
