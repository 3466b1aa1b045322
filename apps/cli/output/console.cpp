// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "output/console.hpp"

#include <algorithm>

#include "output/signals.hpp"
#include "output/standard_streams.hpp"
#include "output/text.hpp"

namespace isotet::cli {

Console::Console(const CommonOptions& options)
    : quiet_(options.quiet),
      verbose_(options.verbose),
      table_(!options.quiet && options.json != "-"),
      bar_(!options.quiet && stderr_is_terminal()) {
    run_.threads = options.threads;
    run_.progress.report = [this](std::string_view step, double fraction) { bar_.show(step, fraction); };
    run_.progress.cancel = &stop_requested;
}

void Console::note(const std::string& told) {
    const std::string sentence = with_options(told);
    const std::lock_guard lock(mutex_);
    if (sentence.empty() || std::find(noted_.begin(), noted_.end(), sentence) != noted_.end()) return;
    noted_.push_back(sentence);
    if (quiet_) return;
    bar_.clear();
    write_to_stderr("isotet: note: " + printable(sentence) + "\n");
}

void Console::detail(const std::string& sentence) {
    if (!verbose_) return;
    const std::lock_guard lock(mutex_);
    bar_.clear();
    write_to_stderr("isotet: " + printable(with_options(sentence)) + "\n");
}

Result<void> Console::print(std::string_view text) {
    bar_.clear();
    return table_ ? write_to_stdout(text) : Result<void>{};
}

void say_error(std::string_view message) { write_to_stderr("isotet: " + printable(with_options(message)) + "\n"); }

} // namespace isotet::cli
