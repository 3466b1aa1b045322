// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/confined/xdmf/xdmf_steps.hpp"

#include <iterator>
#include <map>
#include <utility>

#include <fmt/core.h>

#include "io/files/escape.hpp"
#include "io/files/text_scanner.hpp"
#include "io/files/time_values.hpp"
#include "io/pieces/loaded.hpp"

namespace isotet::io::confined {
namespace {

constexpr int deepest_grid = 16;                     ///< collections in collections
constexpr std::size_t max_grids = 1000000;           ///< each as often as it is referred to
constexpr std::size_t max_grids_of_steps = 10000000; ///< those of all steps together

using Sequence = std::vector<XdmfStep>;

std::string name_of_grid(pugi::xml_node grid) { return grid.attribute("Name").as_string(); }

class StepSorter {
public:
    StepSorter(const std::string& path, const XdmfDocument& document, const XdmfData& data)
        : path_(path), document_(document), data_(data) {}

    Result<XdmfSteps> sort() {
        std::vector<pugi::xml_node> stated;
        for (const pugi::xml_node domain : document_.domains())
            for (const pugi::xml_node grid : document_.children(domain, "Grid")) stated.push_back(grid);
        Place place;
        if (stated.size() == 1) place.names_collections = Naming::inner;
        auto steps = beside_each_other(stated, place, Times::own);
        if (!steps) return steps.error();
        result_.steps = *std::move(steps);
        if (result_.grids.empty())
            return broken(path_, result_.left_out.empty()
                                     ? "its Domain has no grid"
                                     : "it has no grid that is read: " + result_.left_out.front().reason);
        return std::move(result_);
    }

private:
    enum class Naming { all, inner };
    /// of_all: what is around grids has a time, so theirs do not matter unless they have several.
    enum class Times { own, of_all };
    /// Where a grid is.
    struct Place {
        std::string before; ///< what its name begins with
        std::string series; ///< the name of the temporal collection whose steps it is one of
        int depth = 0;
        Naming names_collections = Naming::all; ///< inner: the collection itself is not worth a name
    };

    Result<Sequence> sequence_of(pugi::xml_node stated, const Place& place) {
        if (place.depth > deepest_grid)
            return broken(path_, fmt::format("grids are nested more than {} deep", deepest_grid));
        if (++visited_ > max_grids) return broken(path_, "its grids refer to each other without end");
        const pugi::xml_node grid = document_.resolve(stated);
        if (!grid) return broken(path_, fmt::format("grid \"{}\" refers to nothing", escaped(name_of_grid(stated))));
        const std::string_view type = grid.attribute("GridType").as_string("Uniform");
        if (same_word(type, "Uniform")) return uniform(grid, place);
        if (same_word(type, "Collection") && same_word(grid.attribute("CollectionType").as_string(), "Temporal"))
            return temporal(grid, place);
        if (same_word(type, "Collection") || same_word(type, "Tree")) {
            Place inside{place.before, {}, place.depth + 1, Naming::all};
            const std::string own = place.series.empty() ? name_of_grid(grid) : std::string();
            if (!own.empty() && place.names_collections == Naming::all) inside.before += own + "/";
            const auto time = time_of(grid);
            auto steps = beside_each_other(document_.children(grid, "Grid"), inside, time ? Times::of_all : Times::own);
            if (steps && time && steps->size() == 1) steps->front().time = time;
            return steps;
        }
        result_.left_out.push_back(
            {"grid", name_of_grid(grid),
             fmt::format("its type is \"{}\", but Uniform, Collection and Tree are read", escaped(type))});
        return Sequence();
    }

    Sequence uniform(pugi::xml_node grid, const Place& place) {
        const std::string name = place.series.empty() ? name_of_grid(grid) : place.series;
        result_.grids.push_back({grid, place.before + name});
        return {{time_of(grid), {static_cast<std::uint32_t>(result_.grids.size() - 1)}}};
    }

    /// Each child is a step, or several with times of their own.
    Result<Sequence> temporal(pugi::xml_node collection, const Place& place) {
        const std::vector<pugi::xml_node> children = document_.children(collection, "Grid");
        auto times = listed_times(collection, children.size());
        if (!times) return times.error();
        Sequence all;
        Place inside = place;
        inside.series = name_of_grid(collection);
        inside.names_collections = Naming::inner;
        ++inside.depth;
        for (std::size_t i = 0; i < children.size(); ++i) {
            auto steps = sequence_of(children[i], inside);
            if (!steps) return steps;
            if (steps->size() == 1 && !steps->front().time)
                steps->front().time = i < times->size() ? (*times)[i] : static_cast<double>(i);
            all.insert(all.end(), std::make_move_iterator(steps->begin()), std::make_move_iterator(steps->end()));
        }
        return all;
    }

    Result<Sequence> beside_each_other(const std::vector<pugi::xml_node>& stated, const Place& place, Times times) {
        Place inside = place;
        ++inside.depth;
        std::vector<Sequence> sequences;
        bool has_times = false, has_series = false;
        for (const pugi::xml_node grid : stated) {
            auto steps = sequence_of(grid, inside);
            if (!steps) return steps;
            if (steps->empty()) continue;
            has_times = has_times || steps->front().time;
            has_series = has_series || steps->size() > 1;
            sequences.push_back(*std::move(steps));
        }
        if (sequences.size() == 1) return std::move(sequences.front());
        return has_times && (times == Times::own || has_series) ? by_time(sequences) : at_once(sequences);
    }

    Result<Sequence> at_once(const std::vector<Sequence>& sequences) {
        Sequence all(sequences.empty() ? 0 : 1);
        for (const Sequence& sequence : sequences)
            for (const XdmfStep& step : sequence)
                all.front().grids.insert(all.front().grids.end(), step.grids.begin(), step.grids.end());
        return all;
    }

    /// The times of all, ascending. What is without a time is there at each; of equal times in one sequence the last
    /// counts, as where a run was begun again.
    Result<Sequence> by_time(const std::vector<Sequence>& sequences) {
        std::map<double, std::map<std::size_t, const XdmfStep*>> times;
        for (std::size_t s = 0; s < sequences.size(); ++s)
            for (const XdmfStep& step : sequences[s])
                if (step.time) times[*step.time][s] = &step;
        Sequence all;
        std::size_t grids = 0;
        for (const auto& [time, timed] : times) {
            XdmfStep& step = all.emplace_back();
            step.time = time;
            for (std::size_t s = 0; s < sequences.size(); ++s) {
                const auto found = timed.find(s);
                const bool always = !sequences[s].front().time;
                if (!always && found == timed.end()) continue;
                const XdmfStep& part = always ? sequences[s].front() : *found->second;
                step.grids.insert(step.grids.end(), part.grids.begin(), part.grids.end());
            }
            grids += step.grids.size();
            if (grids > max_grids_of_steps)
                return broken(path_, fmt::format("its steps have more than {} grids", max_grids_of_steps));
        }
        return all;
    }

    /// A grid's own time.
    std::optional<double> time_of(pugi::xml_node grid) const {
        double value = 0;
        const pugi::xml_node time = document_.child(grid, "Time");
        if (!time) return std::nullopt;
        TextScanner text(time.attribute("Value").as_string());
        if (text.number(value) && text.at_end()) return value;
        if (const std::string_view type = kind_of(time); !type.empty() && !same_word(type, "Single"))
            return std::nullopt;
        const auto numbers = numbers_of(time);
        return numbers && numbers->size() == 1 ? std::optional(numbers->front()) : std::nullopt;
    }
    static std::string_view kind_of(pugi::xml_node time) {
        return time.attribute("TimeType") ? time.attribute("TimeType").as_string() : time.attribute("Type").as_string();
    }

    Result<std::vector<double>> numbers_of(pugi::xml_node time) const {
        if (const pugi::xml_node item = document_.child(time, "DataItem")) {
            const auto read = data_.read(item, Depth::arrays);
            if (!read) return read.error();
            // Without a Precision text stands for float32, but means what it says.
            auto text = numbers_in(text_of(document_.resolve(item)));
            return text.size() == read->values.size() ? std::move(text) : time_values(read->values);
        }
        return numbers_in(text_of(time));
    }
    static std::vector<double> numbers_in(const std::string& text) {
        std::vector<double> values;
        TextScanner scanner(text);
        for (double value = 0; scanner.number(value);) values.push_back(value);
        return values;
    }

    /// The times that a temporal collection lists for its grids: List, HyperSlab (start, step, count), Range (first, last).
    Result<std::vector<double>> listed_times(pugi::xml_node collection, std::size_t count) const {
        const pugi::xml_node time = document_.child(collection, "Time");
        if (!time) return std::vector<double>();
        auto stated = numbers_of(time);
        if (!stated) return stated;
        const bool regular = same_word(kind_of(time), "HyperSlab") && stated->size() == 3;
        const bool range = same_word(kind_of(time), "Range") && stated->size() == 2;
        if (!regular && !range) return stated;
        const double start = (*stated)[0];
        const double step = regular     ? (*stated)[1]
                            : count > 1 ? ((*stated)[1] - start) / static_cast<double>(count - 1)
                                        : 0;
        std::vector<double> times(count);
        for (std::size_t i = 0; i < count; ++i) times[i] = start + static_cast<double>(i) * step;
        return times;
    }

    const std::string& path_;
    const XdmfDocument& document_;
    const XdmfData& data_;
    XdmfSteps result_;
    std::size_t visited_ = 0;
};

} // namespace

Result<XdmfSteps> sort_by_time(const std::string& path, const XdmfDocument& document, const XdmfData& data) {
    return StepSorter(path, document, data).sort();
}

} // namespace isotet::io::confined
