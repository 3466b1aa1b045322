// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "view/steps.hpp"

#include <chrono>

namespace isotet::view {

StepReader::~StepReader() { stop(); }

void StepReader::stop() {
    if (!ahead_.valid()) return;
    cancel_ = true;
    ahead_.wait();
    ahead_ = {};
}

Result<Grid> StepReader::take(std::size_t step, const Run& run) {
    if (!ahead_.valid() || ahead_step_ != step) {
        stop();
        return read_(step, run);
    }
    while (ahead_.wait_for(std::chrono::milliseconds(2)) != std::future_status::ready)
        if (run.progress.cancelled()) return Error{ErrorCode::cancelled, "cancelled"};
    return ahead_.get();
}

void StepReader::read_ahead(std::size_t step) {
    if (ahead_.valid()) {
        if (ahead_step_ == step || ahead_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
        ahead_ = {};
    }
    cancel_ = false;
    ahead_step_ = step;
    ahead_ = std::async(std::launch::async, [this, step] { return read_(step, Run{threads_, {{}, &cancel_}}); });
}

} // namespace isotet::view
