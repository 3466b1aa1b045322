// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
var<workgroup> own_seam_bits: array<atomic<u32>, max_cluster_seams / 32u>;
var<workgroup> used_tied: array<atomic<u32>, tied_words>;
var<workgroup> tied_points: atomic<u32>;
var<workgroup> edge_sum: atomic<u32>;
var<workgroup> seam_sum: atomic<u32>;
var<workgroup> triangle_sum: atomic<u32>;
var<workgroup> fresh_sum: atomic<u32>;

fn add_to_counts(number: u32, vertices: u32, at_points: u32, corners: u32) {
  let segment = number / segment_clusters;
  let block = segment / block_segments;
  if (vertices != 0u) {
    atomicAdd(&state[push.counts + 2u * number], vertices + (at_points << 16u));
    atomicAdd(&state[push.segments + 2u * segment], vertices);
    atomicAdd(&state[push.blocks + 2u * block], vertices);
  }
  if (corners != 0u) {
    atomicAdd(&state[push.counts + 2u * number + 1u], corners);
    atomicAdd(&state[push.segments + 2u * segment + 1u], corners);
    atomicAdd(&state[push.blocks + 2u * block + 1u], corners);
  }
}

fn has_no_data(number: u32) -> bool { return ((tables[push.clusters_without_data + number / 32u] >> (number % 32u)) & 1u) != 0u; }

fn tell_owner(owner: u32, bit: u32, at_point: u32) {
  let value = 1u << (bit % 32u);
  let before = atomicOr(&state[push.masks + clusters[owner].first_mask + bit / 32u], value);
  if ((before & value) == 0u) { add_to_counts(owner, 1u, at_point, 0u); }
}

fn load_points(me: u32) {
  if (me >= local_points()) { return; }
  let bits = value_bits(page_point(me));
  classify(me, bits);
  let is_number = (bits & 0x7fffffffu) <= 0x7f800000u;
  if (me >= ghost_points && is_number && bitcast<f32>(bits) == push.tied) { atomicAdd(&tied_points, 1u); }
}

fn use_tied(cell: Cell) {
  for (var i = 0u; i < polygon_count(cell); i++) {
    let polygon = polygon_of(cell, i);
    for (var t = 0u; t < triangles_of(polygon); t++) {
      if (!is_kept(cell, polygon, t)) { continue; }
      for (var k = 0u; k < 3u; k++) {
        let end = polygon_edge(polygon, select(k + t, 0u, k == 0u)).x;
        let point = corner_of(cell, end);
        if (is_tied(cell, end)) { atomicOr(&used_tied[point / 32u], 1u << (point % 32u)); }
      }
    }
  }
}

fn cut_cells(me: u32, special: bool) {
  let hits = countOneBits(atomicLoad(&hit_groups));
  var sum = 0u;
  for (var place = me / group_size; place < hits; place += workgroup_size / group_size) {
    let cell = cut_cell(hit_group[place], me % group_size, special);
    if (cell.triangles != 0u) {
      sum += cell.triangles;
      add_edges(cell);
      if (cell.tied != 0u) { use_tied(cell); }
    }
  }
  if (sum != 0u) { atomicAdd(&triangle_sum, sum); }
}

fn count_edges(me: u32) {
  var edges = 0u;
  for (var i = 0u; i < 4u; i++) { edges += countOneBits(atomicLoad(&edge_matrix[4u * me + i])); }
  if (edges != 0u) { atomicAdd(&edge_sum, edges); }
}

fn find_seams(me: u32) {
  var found = 0u;
  for (var k = me; k < own_seams; k += workgroup_size) {
    if (is_crossed(own_seam(k))) {
      atomicOr(&own_seam_bits[k / 32u], 1u << (k % 32u));
      found++;
    }
  }
  for (var k = me; k < ghost_seams(); k += workgroup_size) {
    let seam = ghost_seam(k);
    if (!is_crossed(seam.xy)) { continue; }
    found++;
    if (push.any_no_data == 0u) { continue; }
    let owner = neighbour_of(k, 16u).cluster;
    if (has_no_data(owner)) { tell_owner(owner, 32u * tied_words + seam.z, 0u); }
  }
  if (found != 0u) { atomicAdd(&seam_sum, found); }
}

fn write_own_seams(me: u32, number: u32) {
  let others_write = push.any_no_data != 0u && has_no_data(number);
  var fresh = 0u;
  for (var word = me; word < (own_seams + 31u) / 32u; word += workgroup_size) {
    let bits = atomicLoad(&own_seam_bits[word]);
    let at = push.masks + cluster.first_mask + tied_words + word;
    var known = 0u;
    if (others_write) { known = atomicOr(&state[at], bits); } else { store(at, bits); }
    fresh += countOneBits(bits & ~known);
  }
  if (fresh != 0u) { atomicAdd(&fresh_sum, fresh); }
}

fn tell_tied(me: u32, number: u32) {
  if (me >= local_points() || ((atomicLoad(&used_tied[me / 32u]) >> (me % 32u)) & 1u) == 0u) { return; }
  if (me >= ghost_points) {
    tell_owner(number, me - ghost_points, 1u);
  } else {
    tell_owner(neighbour_of(me, 0u).cluster, ghost_place(me), 1u);
  }
}

@compute @workgroup_size(workgroup_size)
fn main(@builtin(local_invocation_index) me: u32, @builtin(workgroup_id) group: vec3u, @builtin(num_workgroups) groups: vec3u) {
  let number = listed(me, group_index(group, groups), selected_list, push.selected);
  if (number == no_cluster) { return; }
  open_cluster(number);
  load_points(me);
  workgroupBarrier();
  let special = any_in(tied) || any_in(no_data);
  find_hit_groups(me, ranges[number]);
  cut_cells(me, special);
  workgroupBarrier();
  count_edges(me);
  find_seams(me);
  workgroupBarrier();
  write_own_seams(me, number);
  if (special) { tell_tied(me, number); }
  workgroupBarrier();
  if (me != 0u) { return; }
  add_to_counts(number, atomicLoad(&edge_sum) - atomicLoad(&seam_sum) + atomicLoad(&fresh_sum), 0u, atomicLoad(&triangle_sum));
  let ties = atomicLoad(&tied_points);
  if (ties != 0u) { atomicAdd(&state[head_tied], ties); }
}
