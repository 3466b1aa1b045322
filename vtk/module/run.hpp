// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <thread>

#include <isotet/progress.hpp>

class vtkAlgorithm;

namespace isotet_vtk {

/// How an execution of a filter runs: threads, VTK's progress and abort. Observers are called by the thread that executes the
/// filter only: they may be Python.
class AlgorithmRun {
public:
    /// `threads`  0: VTK_SMP_MAX_THREADS of the environment, else all
    AlgorithmRun(vtkAlgorithm* algorithm, int threads);
    AlgorithmRun(const AlgorithmRun&) = delete;
    AlgorithmRun& operator=(const AlgorithmRun&) = delete;

    const isotet::Run& run() const { return run_; }
    bool cancelled() const { return cancel_; }

private:
    void report(double fraction);

    vtkAlgorithm* algorithm_;
    std::thread::id thread_ = std::this_thread::get_id();
    std::atomic<bool> cancel_{false};
    isotet::Run run_;
};

} // namespace isotet_vtk
