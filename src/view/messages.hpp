// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What a page and the server say to each other: text in JSON, and frames with surfaces in bytes.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <isotet/isovalues.hpp>
#include <isotet/result.hpp>
#include <isotet/scene.hpp>
#include <isotet/surface.hpp>

#include "view/chart.hpp"
#include "view/command_line.hpp"
#include "view/server/encode.hpp"
#include "view/json.hpp"
#include "view/mesh.hpp"
#include "view/pick.hpp"
#include "view/export/save.hpp"
#include "view/state.hpp"

namespace isotet::view {

/// {"do": "hello", "token": ...}: the first message of a page.
struct HelloMessage {
    std::string token;
};

/// {"do": "refine", ...}: the same once more with curved cells refined, when nothing else is to be done.
/// {"do": "show", "number": n, "state": ..., "moving": true, "most": N, "next": N, "picture": [w, h]}: what the page wants to see. `number` grows.
struct ShowMessage {
    std::uint64_t number = 0;
    ViewState state;
    bool moving = false; ///< a preview will do
    bool refined = false;
    std::optional<std::uint64_t>
        most; ///< triangles of a surface that the page draws in time; nothing: the server's limit
    std::optional<std::uint64_t> next;                   ///< the step that will be wanted next: read ahead
    std::optional<std::array<std::uint32_t, 2>> picture; ///< width and height: the server draws
};

/// {"do": "shown", "number": n}: the page has drawn frame n.
struct ShownMessage {
    std::uint64_t number = 0;
};

/// {"do": "chart", "field": name, "step": n, "cells": [...]}
struct ChartMessage {
    std::string field;
    std::optional<std::uint64_t> step = {}; ///< nothing: the one that was read last
    std::vector<std::string> cells = {};    ///< as ViewState::cells
};

/// {"do": "spectrum", "field": name, "step": n, "cells": [...]}: area and volume against the isovalue, when nothing else is to be done.
struct SpectrumMessage {
    std::string field;
    std::optional<std::uint64_t> step = {}; ///< as ChartMessage::step
    std::vector<std::string> cells = {};    ///< as ViewState::cells
};

/// {"do": "command", "state": ...}: the state as command lines.
struct CommandMessage {
    ViewState state;
};

/// {"do": "paste", "text": ...}: the state of a command line.
struct PasteMessage {
    std::string text;
};

/// {"do": "pick", "state": ..., "slice": n, "point": [x, y, z]}: the values at the point of a surface that is nearest.
/// {"do": "pick", "state": ..., "point": [x, y, z], "ray": [x, y, z]}: where the ray from the point meets a surface first.
/// "boundary": true is of the grid's boundary instead of an isosurface; of a ray, of the boundary, too.
struct PickMessage {
    ViewState state;                  ///< the first isovalue is that of the surface
    std::optional<std::size_t> slice; ///< which of the slices, instead of the isosurface
    bool boundary = false;            ///< the grid's boundary
    std::array<double, 3> point{};
    std::optional<std::array<double, 3>> ray = {}; ///< from the point; of all surfaces and slices of the state
    bool parts = false;                            ///< the number of the surface's part goes with the values
};

/// {"do": "parts", "state": ..., "refined": true}: the connected parts of the first surface, when nothing else is to be done.
struct PartsMessage {
    ViewState state;      ///< with an isovalue
    bool refined = false; ///< curved cells are, as ShowMessage::refined
};

/// {"do": "share", "field": name, "step": n, "of": "volume" or "points", "percent": p, "cells": [...]}: the isovalue
/// of a share.
struct ShareMessage {
    std::string field;
    std::optional<std::uint64_t> step = {}; ///< as ChartMessage::step
    IsovalueShare share = {};
    std::vector<std::string> cells = {}; ///< as ViewState::cells
};

/// {"do": "save", "kind": ..., "name": ..., "state": ..., "width": w, "height": h, "from": a, "to": b, "pictures": n,
///  "download": true}
struct SaveMessage {
    SaveRequest request;
    bool download = false; ///< the page takes the file, by PartMessage; else it goes into the folder of --out
};

/// {"do": "part"}: the next part of the file that the page downloads.
struct PartMessage {};

using PageMessage = std::variant<HelloMessage, ShowMessage, ShownMessage, ChartMessage, CommandMessage, PasteMessage,
                                 PickMessage, SaveMessage, SpectrumMessage, PartMessage, PartsMessage, ShareMessage>;

/// Any bytes from a page. Errors   invalid_argument
Result<PageMessage> parse_page_message(std::string_view text);

/// One surface of a frame. With `mesh` null the page has it from a frame before.
struct FrameSurface {
    std::string key; ///< the same for the same mesh
    double isovalue = 0;
    Color color; ///< that isotet render would give it
    const Mesh* mesh = nullptr;
    std::uint64_t triangles = 0;       ///< of the surface, also where the mesh is a preview
    double opacity = 1;                ///< that isotet render would give it
    std::string_view kind = "surface"; ///< or "slice", "boundary": shaded by faces
};

/// What a page is told about a frame.
struct FrameFacts {
    std::uint64_t number = 0; ///< of the ShowMessage
    bool preview = false;     ///< of at least one of the meshes
    std::string method;       ///< "direct" or "clusters"
    double extract_seconds = 0, mesh_seconds = 0, wait_seconds = 0;
    std::optional<ColorScale> scale;       ///< of values on the surfaces
    std::vector<std::string> classes = {}; ///< names of ColorScale::classes
    std::vector<std::string> notes;
    std::uint64_t step = 0;
    std::string field = {};                     ///< that is contoured
    std::optional<ValueRange> range = {};       ///< of its values in this step, where the file has several
    std::optional<double> field_bound = {};     ///< of the refined cells; nothing: none was refined
    std::optional<EncodedPicture> picture = {}; ///< instead of meshes
    std::vector<OpacityPoint> opacity = {};     ///< of the volume in the picture
    double opacity_length = 0;                  ///< of a volume: what that opacity is of
};

/// A frame in bytes: "isof", the bytes of its head (uint32), the head (JSON), then from the next multiple of 8 on the blocks
/// that the head tells of.
std::string frame_bytes(const FrameFacts& facts, const std::vector<FrameSurface>& surfaces);

/// "isod", then bytes of a file; nothing but that at its end.
std::string part_bytes(std::string_view bytes);

std::string progress_text(std::string_view step, double fraction);
std::string refusal_text(std::uint64_t number, std::string_view sentence);
std::string error_text(std::string_view about, std::string_view sentence);
std::string picked_text(const Picked& picked);
/// `of_other_file`   the command line names another one than the page shows
std::string pasted_text(const PastedCommand& pasted, bool of_other_file);
/// With the cells that it was asked of: these may have changed meanwhile.
std::string chart_text(const ChartMessage& asked, std::size_t step, const Chart& chart);
/// The largest ones one by one, at most 500.
std::string parts_text(const PartsMessage& message, std::size_t step, const std::vector<SurfacePart>& parts,
                       const std::vector<std::uint64_t>& kept);
std::string share_text(const ShareMessage& message, std::size_t step, double isovalue);
std::string spectrum_text(const SpectrumMessage& asked, std::size_t step, const ContourSpectrum& spectrum);

/// The scale of a frame's colours, as pages take it.
Json scale_json(const ColorScale& scale, const std::vector<std::string>& classes);

/// "#rrggbb"
std::string color_text(const Color& color);

} // namespace isotet::view
