// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// VTK's readers tell their errors through a window class that prints. This one listens.
#include <algorithm>
#include <cstdio>
#include <mutex>

#include <vtkAlgorithm.h>
#include <vtkCallbackCommand.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkOutputWindow.h>

#include "io/confined/progress.hpp"
#include "io/confined/vtk_log.hpp"
#include "io/files/escape.hpp"

namespace isotet::io::confined {
namespace {

struct Collected {
    std::mutex mutex;
    std::optional<std::string> error;
};

Collected& collected() {
    static Collected state;
    return state;
}

/// "0x55d0c8" in a sentence, the same sentence with "0x...": where something lay in memory helps no one.
std::string without_addresses(std::string text) {
    for (std::size_t at = 0; (at = text.find("0x", at)) != std::string::npos; at += 5) {
        const std::size_t end = std::min(text.find_first_not_of("0123456789abcdefABCDEF", at + 2), text.size());
        if (end - at >= 6) text.replace(at + 2, end - at - 2, "...");
    }
    return text;
}

/// "ERROR: In /build/x.cxx, line 12\nvtkClass (0x55): sentence\n\n" becomes "sentence".
std::string sentence_of(std::string_view text) {
    if (const auto address = text.find("): "); address != std::string_view::npos) text.remove_prefix(address + 3);
    else if (const auto line = text.find('\n');
             line != std::string_view::npos && text.substr(0, 20).find(": In ") != std::string_view::npos)
        text.remove_prefix(line + 1);
    return without_addresses(escaped(text));
}

class Listener : public vtkOutputWindow {
public:
    vtkTypeMacro(Listener, vtkOutputWindow) static Listener* New() { VTK_STANDARD_NEW_BODY(Listener); }

    void DisplayText(const char* text) override {
        if (text) std::fprintf(stderr, "%s\n", sentence_of(text).c_str());
    }
    void DisplayErrorText(const char* text) override {
        if (text) keep(text);
        DisplayText(text);
    }
    /// What readers say through the generic macro ("Error reading binary data!") is often all they say.
    void DisplayGenericWarningText(const char* text) override {
        if (text && std::string_view(text).find("Error") != std::string_view::npos) keep(text);
        DisplayText(text);
    }
    void DisplayWarningText(const char* text) override { DisplayText(text); }

private:
    static void keep(const char* text) {
        const std::scoped_lock lock(collected().mutex);
        if (!collected().error) collected().error = sentence_of(text);
    }
};

} // namespace

void collect_vtk_messages() {
    vtkNew<Listener> listener;
    vtkOutputWindow::SetInstance(listener);
}

std::optional<std::string> take_vtk_error() {
    const std::scoped_lock lock(collected().mutex);
    return std::exchange(collected().error, std::nullopt);
}

void follow_progress(vtkAlgorithm* algorithm) {
    vtkNew<vtkCallbackCommand> command;
    command->SetCallback([](vtkObject* caller, unsigned long, void*, void*) {
        report_progress(static_cast<vtkAlgorithm*>(caller)->GetProgress());
    });
    algorithm->AddObserver(vtkCommand::ProgressEvent, command);
}

} // namespace isotet::io::confined
