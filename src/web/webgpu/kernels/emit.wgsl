// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// emit.comp with many_edges for all clusters: windows of few_edges.
var<workgroup> points: array<u32, max_cluster_points>;
var<workgroup> edge_count: u32;
var<workgroup> edge_numbers: array<u32, few_edges>;
var<workgroup> seam_bits: array<atomic<u32>, few_edges / 32u>;
var<workgroup> seam_ranks: array<u32, few_edges / 32u>;
var<workgroup> triangle_bits: array<atomic<u32>, 3u * max_cluster_groups>;
var<workgroup> sums_before: array<u32, workgroup_size>;
var<workgroup> chunk_sums: array<u32, workgroup_size / 8u>;

var<private> window_begin: u32;
var<private> start_vertex: u32;
var<private> start_seam_vertex: u32;
var<private> start_triangle: u32;

fn bits_before(first: u32, bit: u32) -> u32 {
  var count = countOneBits(load(push.masks + first + bit / 32u) & ((1u << (bit % 32u)) - 1u));
  for (var word = 0u; word < bit / 32u; word++) { count += countOneBits(load(push.masks + first + word)); }
  return count;
}

fn composed(sign: u32, exponent: i32, significand: u32) -> f32 {
  return bitcast<f32>(sign | ((u32(exponent + 127) << 23u) + (significand - 0x800000u)));
}

// shared/arithmetic.glsl: a / b, rounded to nearest.
fn divide(a: f32, b: f32) -> f32 {
  let a_bits = bitcast<u32>(a);
  let b_bits = bitcast<u32>(b);
  let sign = (a_bits ^ b_bits) & 0x80000000u;
  var dividend = (a_bits & 0x7fffffu) | 0x800000u;
  let divisor = (b_bits & 0x7fffffu) | 0x800000u;
  var exponent = i32((a_bits >> 23u) & 0xffu) - i32((b_bits >> 23u) & 0xffu);
  if (dividend < divisor) {
    dividend <<= 1u;
    exponent--;
  }
  if ((a_bits & 0x7fffffffu) == 0u || exponent < -126) { return bitcast<f32>(sign); }
  var quotient = u32(f32(dividend) / f32(divisor) * 8388608.0);
  var remainder = i32((dividend << 23u) - quotient * divisor);
  for (var i = 0u; i < 16u; i++) {
    if (2 * remainder > i32(divisor)) {
      quotient++;
      remainder -= i32(divisor);
    } else if (-2 * remainder > i32(divisor)) {
      quotient--;
      remainder += i32(divisor);
    } else {
      break;
    }
  }
  return composed(sign, exponent, quotient);
}

const weight_floor = 2.3283064365386962890625e-10f; // 2^-32

fn edge_weight(below: f32, above_end: f32) -> f32 {
  let part = rounded(rounded(push.isovalue - below) + push.rest);
  let t = divide(part, rounded(above_end - below));
  return select(t, 0.0, t < weight_floor);
}

fn interpolate(a: f32, b: f32, t: f32) -> f32 {
  if (t == 1.0) { return b; }
  return a + rounded(t * rounded(b - a));
}

fn write_vertex(vertex: u32, below: u32, above_end: u32, t: f32) {
  let a = push.places + 3u * points[below];
  let b = push.places + 3u * points[above_end];
  for (var axis = 0u; axis < 3u; axis++) {
    positions[3u * vertex + axis] = interpolate(bitcast<f32>(page[a + axis]), bitcast<f32>(page[b + axis]), t);
  }
}

fn load_points(me: u32) {
  if (me >= local_points()) { return; }
  points[me] = page_point(me);
  classify(me, value_bits(points[me]));
}

fn triangles_in(place: u32, mask: u32) -> u32 {
  var sum = 0u;
  for (var bit = 0u; bit < 3u; bit++) { sum += countOneBits(atomicLoad(&triangle_bits[3u * place + bit]) & mask) << bit; }
  return sum;
}

fn cut_cells(me: u32, special: bool) {
  let hits = countOneBits(atomicLoad(&hit_groups));
  for (var place = me / group_size; place < hits; place += workgroup_size / group_size) {
    let lane = me % group_size;
    let cell = cut_cell(hit_group[place], lane, special);
    if (cell.triangles != 0u) {
      add_edges(cell);
      for (var bit = 0u; bit < 3u; bit++) {
        if (((cell.triangles >> bit) & 1u) != 0u) { atomicOr(&triangle_bits[3u * place + bit], 1u << lane); }
      }
    }
  }
}

fn edges_before_row(row: u32) -> u32 { return sums_before[row] & 0xfffu; }
fn triangles_before(place: u32) -> u32 { return atomicLoad(&edge_matrix[4u * (32u + place)]); }

// shared/sums.glsl
fn find_sums_before(me: u32, item: u32) {
  sums_before[me] = item;
  workgroupBarrier();
  if (me < workgroup_size / 8u) {
    var sum = 0u;
    for (var i = 0u; i < 8u; i++) {
      let next = sum + sums_before[8u * me + i];
      sums_before[8u * me + i] = sum;
      sum = next;
    }
    chunk_sums[me] = sum;
  }
  workgroupBarrier();
  var before = 0u;
  for (var i = 0u; i < me / 8u; i++) { before += chunk_sums[i]; }
  sums_before[me] += before;
}

fn rank_edges(me: u32) {
  let one = countOneBits(atomicLoad(&edge_matrix[4u * me]));
  let two = one + countOneBits(atomicLoad(&edge_matrix[4u * me + 1u]));
  let three = two + countOneBits(atomicLoad(&edge_matrix[4u * me + 2u]));
  var sum = three + countOneBits(atomicLoad(&edge_matrix[4u * me + 3u]));
  if (me < max_cluster_groups) { sum += triangles_in(me, 0xffffffffu) << 16u; }
  find_sums_before(me, sum);
  let before = sums_before[me];
  if (me < max_cluster_groups) { atomicStore(&edge_matrix[4u * (32u + me)], before >> 16u); }
  if (me == workgroup_size - 1u) { edge_count = (before + sum) & 0xffffu; }
  sums_before[me] = (before & 0xfffu) | (three << 12u) | (two << 19u) | (one << 26u);
}

// Where a rank lies in the window; few_edges or more: outside.
fn in_window(rank: u32) -> u32 { return rank - window_begin; }

fn list_edges(me: u32) {
  if (me < few_edges / 32u) { atomicStore(&seam_bits[me], 0u); }
  var rank = edges_before_row(me);
  for (var i = me / 32u; i < 4u; i++) {
    for (var bits = atomicLoad(&edge_matrix[4u * me + i]); bits != 0u; bits &= bits - 1u) {
      let place = in_window(rank);
      rank++;
      if (place < few_edges) { edge_numbers[place] = me + ((32u * i + countTrailingZeros(bits)) << 8u); }
    }
  }
}

fn rank_of(edge: vec2u) -> u32 {
  let row = sums_before[edge.x];
  let word = edge.y / 32u;
  var in_words = 0u;
  if (word != 0u) { in_words = (row >> (33u - 7u * word)) & 127u; }
  return (row & 0xfffu) + in_words + countOneBits(atomicLoad(&edge_matrix[4u * edge.x + word]) & ((1u << (edge.y % 32u)) - 1u));
}

fn tied_at(point: u32) -> u32 { return 4u * (64u + point % 64u) + point / 64u; }
fn tied_number(point: u32) -> u32 { return atomicLoad(&edge_matrix[tied_at(point)]); }

fn is_masked(bit: u32) -> bool { return ((load(push.masks + cluster.first_mask + bit / 32u) >> (bit % 32u)) & 1u) != 0u; }

fn number_tied(me: u32) {
  if (me >= local_points() || !is_in(tied, me)) { return; }
  if (me >= ghost_points) {
    atomicStore(&edge_matrix[tied_at(me)], start_vertex + bits_before(cluster.first_mask, me - ghost_points));
    return;
  }
  let owner = neighbour_of(me, 0u).cluster;
  atomicStore(&edge_matrix[tied_at(me)], load(push.starts + 3u * owner) + bits_before(clusters[owner].first_mask, ghost_place(me)));
}

fn own_seam_number(k: u32) -> u32 { return start_seam_vertex + bits_before(cluster.first_mask + tied_words, k); }

fn set_seam_number(place: u32, number: u32) {
  edge_numbers[place] = number;
  atomicOr(&seam_bits[place / 32u], 1u << (place % 32u));
}

fn number_seams(me: u32) {
  for (var k = me; k < own_seams; k += workgroup_size) {
    let edge = own_seam(k);
    if (!is_crossed(edge)) { continue; }
    let place = in_window(rank_of(edge));
    if (place < few_edges) { set_seam_number(place, own_seam_number(k)); }
  }
  for (var k = me; k < ghost_seams(); k += workgroup_size) {
    let seam = ghost_seam(k);
    if (!is_crossed(seam.xy)) { continue; }
    let place = in_window(rank_of(seam.xy));
    if (place >= few_edges) { continue; }
    let owner = neighbour_of(k, 16u).cluster;
    set_seam_number(place, load(push.starts + 3u * owner + 1u) + bits_before(clusters[owner].first_mask + tied_words, seam.z));
  }
}

fn rank_seams(me: u32, seams_before_window: u32) {
  if (me >= few_edges / 32u) { return; }
  var rank = seams_before_window;
  for (var word = 0u; word < me; word++) { rank += countOneBits(atomicLoad(&seam_bits[word])); }
  seam_ranks[me] = rank;
}

fn write_vertices(me: u32, first_inner: u32, special: bool) {
  let edges = min(edge_count - window_begin, few_edges);
  let items = edges + select(0u, own_seams + select(0u, own_points, special), window_begin == 0u);
  for (var item = me; item < items; item += workgroup_size) {
    var is_own = false;
    var number = 0u;
    var ends = vec2u(0u);
    if (item < edges) {
      let bits = atomicLoad(&seam_bits[item / 32u]);
      let bit = 1u << (item % 32u);
      is_own = (bits & bit) == 0u;
      if (is_own) {
        number = first_inner + window_begin + item - (seam_ranks[item / 32u] + countOneBits(bits & (bit - 1u)));
        ends = vec2u(edge_numbers[item] & 0xffu, edge_numbers[item] >> 8u);
        edge_numbers[item] = number;
      }
    } else if (item < edges + own_seams) {
      let k = item - edges;
      is_own = is_masked(32u * tied_words + k);
      if (is_own) {
        number = own_seam_number(k);
        ends = own_seam(k);
      }
    } else {
      let place = item - edges - own_seams;
      is_own = is_masked(place);
      if (is_own) {
        ends = vec2u(ghost_points + place);
        number = tied_number(ends.x);
      }
    }
    if (is_own) {
      var t = 0.0;
      if (ends.x != ends.y) {
        if (is_in(above, ends.x)) { ends = ends.yx; }
        t = edge_weight(value_of(points[ends.x]), value_of(points[ends.y]));
      }
      write_vertex(number, ends.x, ends.y, t);
    }
  }
}

const outside = 0xffffffffu;

fn number_of(cell: Cell, polygon: u32, k: u32) -> u32 {
  let ends = polygon_edge(polygon, k);
  let a = corner_of(cell, ends.x);
  if (is_tied(cell, ends.x)) { return tied_number(a); }
  let place = in_window(rank_of(ascending(a, corner_of(cell, ends.y))));
  if (place >= few_edges) { return outside; }
  return edge_numbers[place];
}

fn write_triangles_of(cell: Cell, place: u32, lane: u32) {
  var at = start_triangle + triangles_before(place) + triangles_in(place, (1u << lane) - 1u);
  for (var i = 0u; i < polygon_count(cell); i++) {
    let polygon = polygon_of(cell, i);
    let numbers = vec4u(number_of(cell, polygon, 0u), number_of(cell, polygon, 1u), number_of(cell, polygon, 2u), number_of(cell, polygon, 3u));
    for (var t = 0u; t < triangles_of(polygon); t++) {
      if (!is_kept(cell, polygon, t)) { continue; }
      let corners = vec3u(numbers.x, select(numbers.zw, numbers.yz, t == 0u));
      for (var k = 0u; k < 3u; k++) {
        if (corners[k] != outside) { triangles[3u * at + k] = corners[k]; }
      }
      at++;
    }
  }
}

fn write_triangles(me: u32, special: bool) {
  let hits = countOneBits(atomicLoad(&hit_groups));
  for (var place = me / group_size; place < hits; place += workgroup_size / group_size) {
    let lane = me % group_size;
    if (triangles_in(place, 1u << lane) != 0u) { write_triangles_of(cut_cell(hit_group[place], lane, special), place, lane); }
  }
}

@compute @workgroup_size(workgroup_size)
fn main(@builtin(local_invocation_index) me: u32, @builtin(workgroup_id) group: vec3u, @builtin(num_workgroups) groups: vec3u) {
  let number = listed(me, group_index(group, groups), emitted_list, push.emitted);
  if (number == no_cluster) { return; }
  open_cluster(number);
  load_points(me);
  workgroupBarrier();
  let special = any_in(tied) || any_in(no_data);
  find_hit_groups(me, ranges[number]);
  cut_cells(me, special);
  workgroupBarrier();
  rank_edges(me);
  let edges = workgroupUniformLoad(&edge_count);
  start_vertex = load(push.starts + 3u * number);
  start_seam_vertex = load(push.starts + 3u * number + 1u);
  start_triangle = load(push.starts + 3u * number + 2u);
  let first_inner = own_seam_number(own_seams);
  var seams_before_window = 0u;
  for (var begin = 0u; begin == 0u || begin < edges; begin += few_edges) {
    window_begin = begin;
    list_edges(me);
    workgroupBarrier();
    if (special && begin == 0u) { number_tied(me); }
    number_seams(me);
    workgroupBarrier();
    rank_seams(me, seams_before_window);
    workgroupBarrier();
    write_vertices(me, first_inner, special);
    workgroupBarrier();
    write_triangles(me, special);
    let last = few_edges / 32u - 1u;
    seams_before_window = seam_ranks[last] + countOneBits(atomicLoad(&seam_bits[last]));
    workgroupBarrier();
  }
}
