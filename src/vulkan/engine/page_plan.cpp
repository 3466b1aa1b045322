// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "vulkan/engine/page_plan.hpp"

#include <algorithm>
#include <cstring>

#include "base/parallel.hpp"

namespace isotet::vulkan {

namespace {

using core::ClusterHeader;
using core::ClusterLinks;
using core::Packed;

std::uint32_t groups_of(const ClusterHeader& h) { return static_cast<std::uint32_t>(h.groups()); }

std::uint64_t own_bytes(const Packed& packed, const ClusterHeader& h) {
    const std::uint64_t words =
        h.own_points * (packed.gradients.empty() ? 4u : 5u) + h.words() + ClusterLinks::words(h) + h.neighbours;
    return 4 * words + 2 * groups_of(h);
}

/// Where the whole clusters of each page end.
std::vector<PlannedPage> cut(const Packed& packed, std::uint64_t page_bytes) {
    std::vector<PlannedPage> pages;
    std::uint64_t bytes = page_bytes;
    for (std::size_t c = 0; c < packed.clusters(); ++c) {
        const ClusterHeader& h = packed.headers[c];
        const std::uint64_t more = own_bytes(packed, h);
        if (bytes + more > page_bytes) {
            PlannedPage& page = pages.emplace_back();
            page.first_cluster = static_cast<std::uint32_t>(c);
            page.first_link = h.first_link;
            page.layout.first_point = static_cast<std::uint32_t>(h.first_point);
            page.first_word = h.first_word;
            page.layout.first_word = static_cast<std::uint32_t>(h.first_word);
            page.layout.first_group = h.first_group;
            bytes = 0;
        }
        bytes += more;
        PlannedPage& page = pages.back();
        ++page.clusters;
        page.link_words += static_cast<std::uint32_t>(ClusterLinks::words(h));
        page.neighbours += h.neighbours;
        page.cell_words += static_cast<std::uint32_t>(h.words());
        page.groups += groups_of(h);
        page.layout.own_points += h.own_points;
    }
    return pages;
}

/// Calls f(neighbour, its part of the ghost points) for every neighbour in another page.
template <class F>
void for_outside(const Packed& packed, const PlannedPage& page, F&& f) {
    for (std::uint32_t c = page.first_cluster; c < page.end_cluster(); ++c) {
        const ClusterLinks links = packed.cluster_links(c);
        std::size_t local = 0;
        for (const core::Neighbour& neighbour : links.neighbours) {
            if (neighbour.cluster < page.first_cluster)
                f(neighbour, links.ghost_points.subspan(local, neighbour.ghost_points));
            local += neighbour.ghost_points;
        }
    }
}

core::Buffer<std::uint32_t> find_halo(const Packed& packed, const PlannedPage& page) {
    std::vector<std::uint32_t> points;
    for_outside(packed, page, [&](const core::Neighbour& neighbour, std::span<const std::uint8_t> places) {
        const std::uint64_t first = packed.headers[neighbour.cluster].first_point;
        for (const std::uint8_t place : places) points.push_back(static_cast<std::uint32_t>(first + place));
    });
    std::sort(points.begin(), points.end());
    points.erase(std::unique(points.begin(), points.end()), points.end());
    core::Buffer<std::uint32_t> halo(points.size());
    std::copy(points.begin(), points.end(), halo.begin());
    return halo;
}

/// Arrays one after another.
void place_arrays(const Packed& packed, PlannedPage& page) {
    std::uint32_t words = 0;
    const auto place = [&](std::uint32_t& at, std::uint32_t count) {
        at = words;
        words += (count + 3) / 4 * 4;
    };
    place(page.layout.values, page.points());
    place(page.layout.positions, 3 * page.points());
    place(page.layout.gradients, packed.gradients.empty() ? 0 : page.points());
    place(page.layout.halo, static_cast<std::uint32_t>(page.halo.size()));
    place(page.layout.cells, page.cell_words);
    place(page.layout.group_ranges, (page.groups + 1) / 2);
    place(page.layout.links, page.link_words + page.neighbours);
    page.words = words;
}

/// The words of floats, to be copied.
const std::uint32_t* words_of(const core::SharedBuffer<float>& floats) {
    return reinterpret_cast<const std::uint32_t*>(floats.data());
}

/// A cluster's links, as the device wants them.
class LinkWriter {
public:
    LinkWriter(const Packed& packed, const PlannedPage& page) : packed_(packed), page_(page) {}

    void write(std::uint32_t cluster, std::uint32_t* out) const {
        const ClusterHeader& h = packed_.headers[cluster];
        const ClusterLinks links = packed_.cluster_links(cluster);
        std::uint8_t places[core::max_cluster_points];
        std::copy(links.ghost_points.begin(), links.ghost_points.end(), places);
        std::uint32_t point = 0, seam = 0;
        for (const core::Neighbour& neighbour : links.neighbours) {
            const layout::Neighbour entry{neighbour.cluster, first_point(neighbour, places + point),
                                          point + (seam << 16)};
            std::memcpy(out, &entry, sizeof entry);
            out += sizeof entry / 4;
            point += neighbour.ghost_points;
            seam += neighbour.ghost_seams;
        }
        // What stands behind is as it is here, but for the places of the ghost points.
        const std::size_t before = 2u * h.neighbours, seams = sizeof(core::SeamEdge) * (h.own_seams + h.ghost_seams);
        std::copy_n(packed_.links.data() + h.first_link + before, ClusterLinks::words(h) - before, out);
        std::memcpy(reinterpret_cast<std::byte*>(out) + seams, places, h.ghost_points);
    }

private:
    /// Page-local; turns places among the neighbour's own points into places in its part of the halo where it is
    /// elsewhere.
    std::uint32_t first_point(const core::Neighbour& neighbour, std::uint8_t* places) const {
        const std::uint64_t first = packed_.headers[neighbour.cluster].first_point;
        if (neighbour.cluster >= page_.first_cluster)
            return static_cast<std::uint32_t>(first - page_.layout.first_point);
        const auto begin = std::lower_bound(page_.halo.begin(), page_.halo.end(), first);
        for (std::size_t k = 0; k < neighbour.ghost_points; ++k)
            places[k] = static_cast<std::uint8_t>(std::lower_bound(begin, page_.halo.end(), first + places[k]) - begin);
        return page_.layout.own_points + static_cast<std::uint32_t>(begin - page_.halo.begin());
    }

    const Packed& packed_;
    const PlannedPage& page_;
};

} // namespace

std::vector<PlannedPage> plan_pages(const Packed& packed, std::uint64_t page_bytes) {
    std::vector<PlannedPage> pages = cut(packed, std::min(page_bytes, max_page_bytes));
    core::parallel_each(pages.size(), 1, [&](std::size_t i) {
        pages[i].halo = find_halo(packed, pages[i]);
        place_arrays(packed, pages[i]);
    });
    return pages;
}

void place_clusters(const Packed& packed, const PlannedPage& page, std::uint32_t page_number, layout::Cluster* out) {
    std::uint32_t link = 0;
    for (std::uint32_t i = 0; i < page.clusters; ++i) {
        const ClusterHeader& h = packed.headers[page.first_cluster + i];
        out[i] = {};
        out[i].page = page_number;
        out[i].first_point = static_cast<std::uint32_t>(h.first_point - page.layout.first_point);
        out[i].first_word = static_cast<std::uint32_t>(h.first_word - page.first_word);
        out[i].first_group = h.first_group - page.layout.first_group;
        out[i].first_link = link;
        out[i].points = h.own_points | std::uint32_t{h.ghost_points} << 16;
        out[i].tets = static_cast<std::uint32_t>(h.tets()) | std::uint32_t{h.neighbours} << 16;
        out[i].others = h.cells[1] | std::uint32_t{h.cells[2]} << 10 | std::uint32_t{h.cells[3]} << 20;
        out[i].seams = h.own_seams | (h.wide_seams ? layout::wide_seams_flag : 0) | std::uint32_t{h.ghost_seams} << 16;
        link += static_cast<std::uint32_t>(ClusterLinks::words(h)) + h.neighbours;
    }
}

std::uint64_t mask_words_of(const ClusterHeader& h) { return layout::tied_words + (h.own_seams + 31u) / 32; }

void number_masks(const Packed& packed, layout::Cluster* clusters) {
    std::uint64_t mask = 0;
    for (std::size_t c = 0; c < packed.clusters(); ++c) {
        clusters[c].first_mask = static_cast<std::uint32_t>(mask);
        mask += mask_words_of(packed.headers[c]);
    }
}

void fill_page(const Packed& packed, const PlannedPage& page, const layout::Cluster* clusters, std::uint32_t* out) {
    const layout::Page& at = page.layout;
    fill_points(words_of(packed.as<float>().values), 1, page, out + at.values);
    fill_points(words_of(packed.as<float>().positions), 3, page, out + at.positions);
    if (!packed.gradients.empty()) fill_points(packed.gradients.data(), 1, page, out + at.gradients);
    std::copy(page.halo.begin(), page.halo.end(), out + at.halo);
    std::memcpy(out + at.cells, packed.cells.data() + page.first_word, sizeof(core::StoredTet) * page.cell_words);
    std::memcpy(out + at.group_ranges, packed.group_ranges.data() + at.first_group,
                sizeof(core::GroupRange) * page.groups);
    const LinkWriter links(packed, page);
    core::parallel_each(page.clusters, 64, [&](std::size_t i) {
        links.write(page.first_cluster + static_cast<std::uint32_t>(i), out + at.links + clusters[i].first_link);
    });
}

void fill_points(const std::uint32_t* from, std::size_t components, const PlannedPage& page, std::uint32_t* out) {
    out = std::copy_n(from + components * page.layout.first_point, components * page.layout.own_points, out);
    for (const std::uint32_t point : page.halo) out = std::copy_n(from + components * point, components, out);
}

} // namespace isotet::vulkan
