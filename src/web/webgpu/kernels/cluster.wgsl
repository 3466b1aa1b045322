// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// shared/cluster.glsl: one cluster of the grid, by one workgroup.
var<private> cluster: Cluster;
var<private> own_points: u32;
var<private> ghost_points: u32;
var<private> own_seams: u32;
var<private> kind_counts: vec4u;
var<private> kind_ends: vec4u;
var<private> kind_words: vec4u;

fn open_cluster(number: u32) {
  cluster = clusters[number];
  own_points = cluster.points & 0xffffu;
  ghost_points = cluster.points >> 16u;
  kind_counts = vec4u(cluster.tets & 0xffffu, cluster.others & 1023u, (cluster.others >> 10u) & 1023u, cluster.others >> 20u);
  let half = group_size / 2u;
  let groups = vec4u((kind_counts.x + group_size - 1u) / group_size, (kind_counts.yzw + half - 1u) / half);
  kind_ends = vec4u(groups.x, groups.x + groups.y, groups.x + groups.y + groups.z, groups.x + groups.y + groups.z + groups.w);
  let wedges = kind_counts.x + 2u * kind_counts.y;
  kind_words = vec4u(0u, kind_counts.x, wedges, wedges + 2u * kind_counts.z);
  own_seams = cluster.seams & own_seams_bits;
}

fn local_points() -> u32 { return ghost_points + own_points; }
fn neighbour_count() -> u32 { return cluster.tets >> 16u; }
fn ghost_seams() -> u32 { return cluster.seams >> 16u; }
fn links_at() -> u32 { return push.links + cluster.first_link; }
fn seams_at() -> u32 { return links_at() + 3u * neighbour_count(); }
fn ghost_points_at() -> u32 { return 4u * seams_at() + 2u * (own_seams + ghost_seams()); }
fn seam_indices_at() -> u32 { return ghost_points_at() + ghost_points; }
fn index_bytes() -> u32 { return select(2u, 1u, (cluster.seams & wide_seams_flag) == 0u); }

fn page_byte(at: u32) -> u32 { return (page[at / 4u] >> (8u * (at % 4u))) & 0xffu; }

struct Neighbour { cluster: u32, first_point: u32 };

fn neighbour_of(k: u32, shift: u32) -> Neighbour {
  let begins_at = links_at() + 2u;
  var first = 0u;
  var end = neighbour_count();
  while (end - first > 1u) {
    let middle = (first + end) / 2u;
    let begin = (page[begins_at + 3u * middle] >> shift) & 0xffffu;
    if (begin <= k) { first = middle; } else { end = middle; }
  }
  let at = links_at() + 3u * first;
  return Neighbour(page[at], page[at + 1u]);
}

fn ghost_place(k: u32) -> u32 { return page_byte(ghost_points_at() + k); }

// The number in the page of local point k.
fn page_point(k: u32) -> u32 {
  if (k >= ghost_points) { return cluster.first_point + k - ghost_points; }
  return neighbour_of(k, 0u).first_point + ghost_place(k);
}

fn value_bits(point: u32) -> u32 { return page[push.values + point]; }
fn value_of(point: u32) -> f32 { return bitcast<f32>(value_bits(point)); }
fn cell_word(k: u32) -> u32 { return page[push.cells + cluster.first_word + k]; }

fn range_of_group(group: u32) -> u32 {
  let at = cluster.first_group + group;
  return (page[push.group_ranges + at / 2u] >> (16u * (at % 2u))) & 0xffffu;
}

fn own_seam(k: u32) -> vec2u {
  let pair = page[seams_at() + k / 2u] >> (16u * (k % 2u));
  return vec2u(pair & 0xffu, (pair >> 8u) & 0xffu);
}

fn ghost_seam(k: u32) -> vec3u {
  let at = seam_indices_at() + index_bytes() * k;
  var index = page_byte(at);
  if (index_bytes() == 2u) { index |= page_byte(at + 1u) << 8u; }
  return vec3u(own_seam(own_seams + k), index);
}
