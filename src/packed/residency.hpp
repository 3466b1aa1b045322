// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Packed grids that lie in a file: what brings the parts that are worked on into memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <isotet/export.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>
#include <isotet/surface.hpp>

#include "packed/packed.hpp"

namespace isotet::core {

/// Keeps what was brought in memory while it lives.
struct Brought {
    std::size_t count = 0; ///< of the clusters, the first ones
    std::shared_ptr<const void> pins;
};

/// What of clusters is wanted.
enum class Parts : std::uint8_t {
    values, ///< own points: positions, user's numbers, values, gradients
    all,    ///< these, cells, links and group ranges; and the points that links name
};

/// Threads   safe from many threads
class ISOTET_API Residency {
public:
    virtual ~Residency();

    /// Brings parts of clusters, which ascend and may be repeated: of as many of the first ones as may be kept together, or of
    /// `all`. At least of one, and of all places of a number or none. With Parts::all, what the engines rely on has been checked
    /// for these clusters: indices within bounds, ranges that are those of the values, owners of seams that have a place
    /// wherever the seam is crossed.
    /// Errors   file, invalid_data: as the file; out_of_memory; cancelled
    enum class Amount : std::uint8_t { fitting, all };
    virtual Result<Brought> bring(std::span<const std::uint32_t> clusters, Parts parts, Amount amount,
                                  const Progress& progress) const = 0;

    /// The grid's boundary without fields, as boundary_of() gives it; nothing where the file does not have it.
    /// Errors   as bring()
    virtual Result<std::optional<Surface>> boundary() const = 0;
    /// The values of the field at its points, as unpack_field() gives them. The file has the boundary.
    virtual Result<Array> boundary_values() const = 0;

    /// Bytes of the file: read so far, and those of them in memory.
    struct Use {
        std::uint64_t read = 0, kept = 0;
    };
    virtual Use use() const = 0;

    /// The grid with all its arrays in memory, everything checked: what packing made.
    /// Errors   as bring(); out_of_memory with the amount
    virtual Result<std::shared_ptr<const Packed>> whole(const Progress& progress) const = 0;
};

/// The grid itself where all is in memory, else the whole of it.
ISOTET_API Result<std::shared_ptr<const Packed>> whole_of(const std::shared_ptr<const Packed>& packed,
                                                          const Progress& progress);

ISOTET_API std::vector<std::uint32_t> all_clusters(const Packed& packed);

/// Calls work(first, last), which returns a Result<void>, for ranges of `clusters`, one after another, that are in memory
/// meanwhile: one range of all where the grid is, and where all fit.
template <class Work>
Result<void> in_memory(const Packed& packed, std::span<const std::uint32_t> clusters, Parts parts,
                       const Progress& progress, const Work& work) {
    if (!packed.residency) return work(std::size_t{0}, clusters.size());
    for (std::size_t first = 0; first < clusters.size();) {
        const Result<Brought> brought =
            packed.residency->bring(clusters.subspan(first), parts, Residency::Amount::fitting, progress);
        if (!brought) return brought.error();
        if (Result<void> done = work(first, first + brought->count); !done) return done;
        first += brought->count;
    }
    return {};
}

} // namespace isotet::core
