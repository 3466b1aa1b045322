// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Time steps of which only active cells are kept, the next one read while a step is worked on.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include <isotet/jobs/grid_source.hpp>
#include <isotet/read.hpp>
#include <isotet/result.hpp>

#include "base/threads/read_ahead.hpp"

namespace isotet::jobs {

/// Memory    of the step that was read last, and of the one that is read ahead
/// Threads   one call at a time
class StreamedSteps {
public:
    /// GridSource::read_active(). What a step that was read ahead has to tell, errors too, is told here.
    Result<ReadResult> read(const GridSource& source, const FieldsToRead& fields, std::size_t step,
                            const ReadActiveCells& active, Caller& caller);

    /// Begins to read a step as the last one was read; not where that had one thread, or where all of its cells were needed.
    void read_ahead(std::size_t step);

    /// The source has changed, and nothing that was read ahead is wanted.
    void forget() { steps_.reset(); }

private:
    struct Told {
        Result<ReadResult> read;
        struct Sentence {
            std::string text;
            bool is_note;
        };
        std::vector<Sentence> said;
    };
    class Held;

    std::unique_ptr<core::ReadAhead<Told>> steps_;
    FieldsToRead fields_; ///< of the steps
    ReadActiveCells active_;
    bool goes_on_ = false; ///< the last one was streamed, and there are threads
};

} // namespace isotet::jobs
