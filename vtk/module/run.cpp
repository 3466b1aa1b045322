// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "run.hpp"

#include <cstdlib>

#include <vtkAlgorithm.h>
#include <vtkVersionMacros.h>

namespace isotet_vtk {

namespace {

bool is_aborted(vtkAlgorithm* algorithm) {
#if VTK_MAJOR_VERSION > 9 || (VTK_MAJOR_VERSION == 9 && VTK_MINOR_VERSION >= 3)
    return algorithm->CheckAbort();
#else
    return algorithm->GetAbortExecute() != 0;
#endif
}

int threads_of_environment() {
    const char* const most = std::getenv("VTK_SMP_MAX_THREADS");
    const int threads = most ? std::atoi(most) : 0;
    return threads > 0 ? threads : 0;
}

} // namespace

AlgorithmRun::AlgorithmRun(vtkAlgorithm* algorithm, int threads) : algorithm_(algorithm) {
    run_.threads = threads > 0 ? threads : threads_of_environment();
    run_.progress.cancel = &cancel_;
    run_.progress.report = [this](std::string_view, double fraction) { report(fraction); };
}

void AlgorithmRun::report(double fraction) {
    if (std::this_thread::get_id() != thread_) return;
    algorithm_->UpdateProgress(fraction);
    if (is_aborted(algorithm_)) cancel_ = true;
}

} // namespace isotet_vtk
