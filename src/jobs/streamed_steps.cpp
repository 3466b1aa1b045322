// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "jobs/streamed_steps.hpp"

#include <mutex>
#include <utility>

namespace isotet::jobs {

/// Keeps what it is told.
class StreamedSteps::Held final : public Caller {
public:
    explicit Held(const Run& run) { run_ = run; }

    void note(const std::string& sentence) override { add({sentence, true}); }
    void detail(const std::string& sentence) override { add({sentence, false}); }
    std::vector<Told::Sentence> take() { return std::move(said_); }

private:
    void add(Told::Sentence sentence) {
        const std::lock_guard lock(mutex_);
        said_.push_back(std::move(sentence));
    }

    std::mutex mutex_;
    std::vector<Told::Sentence> said_;
};

Result<ReadResult> StreamedSteps::read(const GridSource& source, const FieldsToRead& fields, std::size_t step,
                                       const ReadActiveCells& active, Caller& caller) {
    if (!steps_ || fields != fields_ || active.field != active_.field || active.isovalues != active_.isovalues) {
        fields_ = fields;
        active_ = active;
        const auto read_it = [source, fields, active](std::size_t which, const Run& run) -> Result<Told> {
            Held held(run);
            Result<ReadResult> read = source.read_active(fields, which, active, held);
            return Told{std::move(read), held.take()};
        };
        steps_ = std::make_unique<core::ReadAhead<Told>>(read_it, caller.run().threads);
    }
    Result<Told> told = steps_->take(step, caller.run());
    if (!told) return told.error();
    for (const Told::Sentence& sentence : told->said)
        sentence.is_note ? caller.note(sentence.text) : caller.detail(sentence.text);
    goes_on_ = told->read && told->read->cells_in_file && caller.run().threads != 1;
    return std::move(told->read);
}

void StreamedSteps::read_ahead(std::size_t step) {
    if (steps_ && goes_on_) steps_->read_ahead(step);
}

} // namespace isotet::jobs
