// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// shared/cut.glsl: the cluster at one isovalue, which of its cells give triangles, and which edges these cross.
const above = 0u;
const tied = 4u;
const no_data = 8u;
var<workgroup> sides: array<atomic<u32>, 12>;
var<workgroup> edge_matrix: array<atomic<u32>, matrix_words>;
var<workgroup> hit_groups: atomic<u32>;
var<workgroup> hit_group: array<u32, max_cluster_groups>;
var<workgroup> at_hand: u32;

fn is_in(which: u32, point: u32) -> bool { return ((atomicLoad(&sides[which + point / 32u]) >> (point % 32u)) & 1u) != 0u; }

fn any_in(which: u32) -> bool {
  return (atomicLoad(&sides[which]) | atomicLoad(&sides[which + 1u]) | atomicLoad(&sides[which + 2u]) | atomicLoad(&sides[which + 3u])) != 0u;
}

fn classify(point: u32, bits: u32) {
  let bit = 1u << (point % 32u);
  if ((bits & 0x7fffffffu) > 0x7f800000u) {
    atomicOr(&sides[no_data + point / 32u], bit);
  } else if (bitcast<f32>(bits) >= push.isovalue) {
    atomicOr(&sides[above + point / 32u], bit);
    if (push.merge != 0u && bitcast<f32>(bits) == push.tied) { atomicOr(&sides[tied + point / 32u], bit); }
  }
}

fn described(group: u32) -> u32 {
  var kind = 0u;
  if (push.with_others != 0u) { kind = select(select(select(3u, 2u, group < kind_ends.z), 1u, group < kind_ends.y), 0u, group < kind_ends.x); }
  var first = 0u;
  var most = group_size;
  if (kind != 0u) {
    first = kind_ends[kind - 1u];
    most = group_size / 2u;
  }
  let cells = min(kind_counts[kind] - (group - first) * most, most);
  return (kind_words[kind] + group_size * (group - first)) | (cells << 16u) | (kind << 24u);
}

// shared/quantize.glsl
fn quantize(value: f32, range: vec2f) -> u32 {
  let width = range.y - range.x;
  if (!(width > 0.0) || !(value > range.x)) { return 0u; }
  let step = bitcast<f32>((261u - (bitcast<u32>(width) >> 23u)) << 23u);
  return u32(min(rounded(min(value, range.y) - range.x) * step, 255.0));
}

fn find_hit_groups(me: u32, range: vec2f) {
  var hit = false;
  if (me < kind_ends.w && range.x < push.isovalue) {
    let step = quantize(push.isovalue, range);
    let ends = range_of_group(me);
    hit = (ends & 0xffu) <= step && step <= (ends >> 8u);
  }
  if (hit) { atomicOr(&hit_groups, 1u << me); }
  workgroupBarrier();
  if (hit) { hit_group[countOneBits(atomicLoad(&hit_groups) & ((1u << me) - 1u))] = described(me); }
  workgroupBarrier();
}

struct Cell { kind: u32, word: u32, words: vec2u, above: u32, tied: u32, triangles: u32 };

fn corner_of(cell: Cell, k: u32) -> u32 { return (select(cell.words.y, cell.words.x, k < 4u) >> (8u * (k % 4u))) & 0xffu; }

fn corners_in(which: u32, cell: Cell, count: u32) -> u32 {
  var bits = 0u;
  for (var k = 0u; k < count; k++) { bits |= select(0u, 1u, is_in(which, corner_of(cell, k))) << k; }
  return bits;
}

fn case_of(cell: Cell) -> u32 {
  let at = select(select(hexahedron_cases_at, wedge_cases_at, cell.kind == 2u), pyramid_cases_at, cell.kind == 1u);
  return tables[at + cell.above];
}

fn polygon_count(cell: Cell) -> u32 {
  if (cell.kind == 0u) { return 1u; }
  return (case_of(cell) >> 16u) & 15u;
}

fn polygon_of(cell: Cell, i: u32) -> u32 {
  if (cell.kind == 0u) { return tet_cases[cell.above]; }
  return tables[(case_of(cell) & 0xffffu) + i];
}

fn triangles_of(polygon: u32) -> u32 { return polygon >> 24u; }

fn polygon_edge(polygon: u32, k: u32) -> vec2u {
  let edge = (polygon >> (6u * k)) & 63u;
  return vec2u(edge & 7u, edge >> 3u);
}

fn is_tied(cell: Cell, corner: u32) -> bool { return ((cell.tied >> corner) & 1u) != 0u; }

fn vertex_key(cell: Cell, polygon: u32, k: u32) -> u32 {
  let ends = polygon_edge(polygon, k);
  let a = corner_of(cell, ends.x);
  let b = corner_of(cell, ends.y);
  if (is_tied(cell, ends.x)) { return max_cluster_points * a + a; }
  return max_cluster_points * min(a, b) + max(a, b);
}

fn is_kept(cell: Cell, polygon: u32, t: u32) -> bool {
  let a = vertex_key(cell, polygon, 0u);
  let b = vertex_key(cell, polygon, 1u + t);
  let c = vertex_key(cell, polygon, 2u + t);
  return a != b && b != c && c != a;
}

fn cut_cell(group: u32, lane: u32, special: bool) -> Cell {
  var cell = Cell(4u, 0u, vec2u(0u), 0u, 0u, 0u);
  if (lane >= ((group >> 16u) & 0xffu)) { return cell; }
  cell.kind = group >> 24u;
  let is_tet = cell.kind == 0u;
  let corners = select(select(cell.kind + 4u, 8u, cell.kind == 3u), 4u, is_tet);
  cell.word = (group & 0xffffu) + select(2u * lane, lane, is_tet);
  cell.words.x = cell_word(cell.word);
  if (!is_tet) { cell.words.y = cell_word(cell.word + 1u); }
  cell.above = corners_in(above, cell, corners);
  if (special && corners_in(no_data, cell, corners) != 0u) { return cell; }
  if (is_tet) { cell.triangles = triangles_of(tet_cases[cell.above]); } else { cell.triangles = case_of(cell) >> 20u; }
  if (special && cell.triangles != 0u) {
    cell.tied = corners_in(tied, cell, corners);
    if (cell.tied == 0u) { return cell; }
    cell.triangles = 0u;
    for (var i = 0u; i < polygon_count(cell); i++) {
      let polygon = polygon_of(cell, i);
      for (var t = 0u; t < triangles_of(polygon); t++) { cell.triangles += select(0u, 1u, is_kept(cell, polygon, t)); }
    }
  }
  return cell;
}

fn matrix_word(edge: vec2u) -> u32 { return 4u * edge.x + edge.y / 32u; }

fn ascending(a: u32, b: u32) -> vec2u { return vec2u(min(a, b), max(a, b)); }

fn add_edges(cell: Cell) {
  for (var i = 0u; i < polygon_count(cell); i++) {
    let polygon = polygon_of(cell, i);
    for (var k = 0u; k < 4u; k++) {
      let ends = polygon_edge(polygon, k);
      if (is_tied(cell, ends.x)) { continue; }
      let edge = ascending(corner_of(cell, ends.x), corner_of(cell, ends.y));
      atomicOr(&edge_matrix[matrix_word(edge)], 1u << (edge.y % 32u));
    }
  }
}

fn is_crossed(edge: vec2u) -> bool { return ((atomicLoad(&edge_matrix[matrix_word(edge)]) >> (edge.y % 32u)) & 1u) != 0u; }

// The cluster that stands at this place of a list; no_cluster behind its end. The same in all invocations.
fn listed(me: u32, place: u32, list: u32, clusters_at: u32) -> u32 {
  if (me == 0u) {
    at_hand = no_cluster;
    if (place < load(list) && load(head_overflow) == 0u) { at_hand = load(clusters_at + place); }
  }
  return workgroupUniformLoad(&at_hand);
}
