// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What view/web/link/webgpu.js calls, of every module.
#include "card.hpp"
#include "web/page.hpp"

namespace isotet::web {

bool say_wanted() {
    const std::optional<view::Json> wanted = card().wanted();
    if (wanted) say_text(view::text_of({{"card", *wanted}}));
    return wanted.has_value();
}

} // namespace isotet::web

extern "C" {

/// Says {"kernels": ...}.
__attribute__((export_name("card_kernels"))) void isotet_card_kernels() {
    using namespace isotet;
    web::say_text(view::text_of({{"kernels", web::card_kernels()}}));
}

__attribute__((export_name("card_on"))) void isotet_card_on(double binding_bytes, std::uint32_t groups_per_axis) {
    isotet::web::card().turn_on(static_cast<std::uint64_t>(binding_bytes), groups_per_axis);
}

__attribute__((export_name("card_off"))) void isotet_card_off() { isotet::web::card().turn_off(); }

/// The surface that is wanted is too large for the card.
__attribute__((export_name("card_leave"))) void isotet_card_leave() { isotet::web::card().leave(); }

/// Says {"room": ...}: where the surface that was wanted goes; null: there is no memory.
__attribute__((export_name("card_room"))) void isotet_card_room(std::uint32_t vertices, std::uint32_t triangles,
                                                                std::uint32_t tied_points, std::uint32_t selected) {
    using namespace isotet;
    web::say_text(view::text_of({{"room", web::card().room_for(vertices, triangles, tied_points, selected)}}));
}

/// Says {"card": ...} until nothing more is wanted, then {"tested": ""} or what is wrong.
__attribute__((export_name("card_test"))) void isotet_card_test() {
    using namespace isotet;
    const web::Card::Asking asking(web::card());
    const Result<void> tested = web::test_card();
    if (!web::say_wanted()) web::say_text(view::text_of({{"tested", tested ? "" : tested.error().message}}));
}

/// Extracts at this part of the range of the last grid. Says {"card": ...}, then {"measured": {...} or null}.
__attribute__((export_name("card_measure"))) void isotet_card_measure(double part, std::uint32_t by_card) {
    using namespace isotet;
    const view::Json measured = web::card().measure(part, by_card != 0);
    if (!web::say_wanted()) web::say_text(view::text_of({{"measured", measured}}));
}
}
