// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "fields/name_kind.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <string>
#include <vector>

namespace isotet::core {

namespace {

using Words = std::span<const std::string_view>;

bool is_upper(char c) { return c >= 'A' && c <= 'Z'; }
bool is_lower(char c) { return c >= 'a' && c <= 'z'; }
bool is_letter(char c) { return is_upper(c) || is_lower(c); }

/// "vtkOriginalCellIds" is "vtk", "original", "cell", "ids"; "GLOBAL_IDS" is "global", "ids"; numbers are left out.
std::vector<std::string> words_of(std::string_view name) {
    std::vector<std::string> words;
    for (std::size_t i = 0; i < name.size(); ++i) {
        const char c = name[i], before = i > 0 ? name[i - 1] : ' ', after = i + 1 < name.size() ? name[i + 1] : ' ';
        if (!is_letter(c)) continue;
        const bool begins = !is_letter(before) || (is_upper(c) && (is_lower(before) || is_lower(after)));
        const bool is_plural = is_upper(c) && is_upper(before) && after == 's' && i + 2 == name.size(); // "IDs"
        if (begins && !is_plural) words.emplace_back();
        words.back() += is_upper(c) ? static_cast<char>(c - 'A' + 'a') : c;
    }
    return words;
}

bool is_any(std::string_view word, Words list) { return std::ranges::find(list, word) != list.end(); }

bool has_any(const std::vector<std::string>& words, Words list) {
    return std::ranges::any_of(words, [&](const std::string& word) { return is_any(word, list); });
}

bool holds_any(std::string_view joined, Words parts) {
    return std::ranges::any_of(parts,
                               [&](std::string_view part) { return joined.find(part) != std::string_view::npos; });
}

constexpr std::array<std::string_view, 60> bookkeeping_words{
    "id",         "ids",      "idx",     "index",   "indices", "num",       "number",     "numbers",     "rank",
    "ranks",      "owner",    "owners",  "proc",    "procs",   "processor", "processors", "process",     "partition",
    "partitions", "weight",   "weights", "center",  "centers", "centre",    "centres",    "centroid",    "centroids",
    "size",       "sizes",    "err",     "error",   "errors",  "residual",  "residuals",  "original",    "ghost",
    "ghosts",     "mask",     "normal",  "normals", "coord",   "coords",    "coordinate", "coordinates", "aux",
    "quality",    "jacobian", "count",   "volume",  "volumes", "vol",       "area",       "areas",       "order",
    "level",      "dof",      "dofs",    "nodeset", "sideset", "estimator"};
constexpr std::array<std::string_view, 8> bookkeeping_parts{"barycent", "centroid",    "globalid", "elementid",
                                                            "cellid",   "vtkoriginal", "nodeid",   "pointid"};
constexpr std::array<std::string_view, 46> region_words{
    "block",     "blocks",      "blockid",   "material",  "materials", "mat",       "matid",        "region",
    "regions",   "zone",        "zones",     "domain",    "domains",   "subdomain", "entity",       "entities",
    "attribute", "attributes",  "tag",       "tags",      "part",      "parts",     "group",        "groups",
    "physical",  "geometrical", "marker",    "markers",   "label",     "labels",    "facies",       "layer",
    "layers",    "rock",        "lithology", "formation", "cluster",   "segment",   "segmentation", "reference",
    "ref",       "fipnum",      "satnum",    "tvolume",   "actnum",    "boundary"};
/// What is derived from a quantity comes after it.
constexpr std::array<std::string_view, 17> derived_words{
    "dt",  "grad", "gradient", "rate",    "rms",      "prime", "variance",  "var",   "std",
    "old", "flux", "initial",  "residue", "relative", "delta", "tolerance", "bounds"};

/// How a quantity is called: the name as it is, one of its words, or a part of it.
struct Quantity {
    std::vector<std::string_view> names, words, parts;
    std::size_t components = 0; ///< of `names`: only fields of so many; 0: any
};

const std::vector<Quantity>& quantities() {
    static const std::vector<Quantity> list = {
        {{"phi", "psi", "lset", "Sw", "So", "Sg", "SWAT", "SOIL", "SGAS"},
         {"alpha", "vof", "saturation", "sdf"},
         {"volumefraction", "volfrac", "phasefraction", "levelset", "saturat", "signeddistance"}},
        {{"T", "TEMP", "NDTEMP", "Temp"}, {"temp", "temperature"}, {"temperature"}},
        {{"c", "C"}, {"conc", "diffused", "species", "salinity"}, {"concentration", "massfraction", "molefraction"}},
        {{"U", "V", "v", "VEL"}, {}, {}, 3},
        {{}, {"vel", "velo", "velocity", "speed", "umag", "vmag"}, {"velocity"}},
        {{"p", "P", "p_rgh", "PRES", "PRESSURE"}, {"pres", "press", "pressure", "head"}, {"pressure"}},
        {{"Vm", "V"}, {"voltage", "potential", "vm"}, {"potential", "electricfield", "magneticfield"}},
        {{"E", "B", "H", "D"}, {"efield", "bfield", "hfield"}, {}, 3},
        {{}, {"mises", "vonmises", "vmis"}, {"vonmises", "equivalentstress"}},
        {{"u", "U", "DISP"}, {}, {}, 3},
        {{}, {"disp", "displ", "displacement", "displacements"}, {"displacement"}},
        {{"S"}, {"stress", "stresses", "sigma"}, {"stress"}},
        {{"rho", "RHO"}, {"density", "rho"}, {"density"}},
        {{"k", "nut", "omega", "epsilon", "Q", "Ma", "u", "f", "sol", "PORO", "PERMX", "h"},
         {"energy",   "enthalpy", "mach", "vorticity",    "helicity",  "strain",  "damage",
          "plastic",  "porosity", "poro", "permeability", "intensity", "dose",    "solution",
          "distance", "dist",     "sol",  "scalar",       "scalars",   "momentum"},
         {"enthalpy", "vorticity", "porosity", "permeab", "walldistance", "momentum"}}};
    return list;
}

bool is_called(const Quantity& quantity, std::string_view name, const std::vector<std::string>& words,
               std::string_view joined, std::size_t components) {
    const bool fits = quantity.components == 0 || quantity.components == components;
    return (fits && is_any(name, quantity.names)) || has_any(words, quantity.words) ||
           holds_any(joined, quantity.parts);
}

/// "T" of "T [K]", "p(Pa)" and "U [m/s]".
std::string_view without_unit(std::string_view name) {
    const char last = name.empty() ? ' ' : name.back();
    const std::size_t bracket = last == ']' ? name.rfind('[') : last == ')' ? name.rfind('(') : std::string_view::npos;
    if (bracket == std::string_view::npos) return name;
    const std::size_t end = name.find_last_not_of(' ', bracket == 0 ? 0 : bracket - 1);
    return bracket == 0 || end == std::string_view::npos ? name : name.substr(0, end + 1);
}

/// "S_aq" and "S_w": saturations.
bool is_short_saturation(std::string_view name) {
    return name.size() > 2 && name.size() <= 4 && (name[0] == 'S' || name[0] == 's') && name[1] == '_' &&
           std::all_of(name.begin() + 2, name.end(), is_letter);
}

} // namespace

RankedName rank_name(std::string_view stored, std::size_t components) {
    const std::string_view name = without_unit(stored);
    const std::vector<std::string> words = words_of(name);
    std::string joined;
    for (const std::string& word : words) joined += word;
    const std::vector<Quantity>& list = quantities();
    const bool fraction = holds_any(joined, std::array<std::string_view, 2>{"fraction", "levelset"});
    if (!fraction && has_any(words, region_words)) return {NameKind::region};
    const bool is_number = has_any(words, std::array<std::string_view, 2>{"mach", "courant"}); // that has a name
    if (!fraction && !is_number && (has_any(words, bookkeeping_words) || holds_any(joined, bookkeeping_parts)))
        return {NameKind::bookkeeping};
    if (has_any(words, derived_words)) return {NameKind::plain};
    if (is_short_saturation(name)) return {NameKind::quantity, 0};
    for (std::size_t rank = 0; rank < list.size(); ++rank)
        if (is_called(list[rank], name, words, joined, components)) return {NameKind::quantity, static_cast<int>(rank)};
    return {};
}

} // namespace isotet::core
