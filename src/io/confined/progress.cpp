// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/confined/progress.hpp"

#include <utility>

namespace isotet::io::confined {
namespace {

std::function<void(double)>& progress_listener() {
    static std::function<void(double)> listener;
    return listener;
}

} // namespace

void on_progress(std::function<void(double)> listener) { progress_listener() = std::move(listener); }

void report_progress(double fraction) {
    if (progress_listener()) progress_listener()(fraction);
}

} // namespace isotet::io::confined
