// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Step by step the kernels of src/vulkan/kernels, whose comments hold here: by places in buffers in place of addresses, and of a
// grid that is one page. Before this file stand the constants of layout.h, the cases of tets, Cluster and Push (kernels.cpp).
@group(0) @binding(0) var<uniform> push: Push;
@group(0) @binding(1) var<storage, read> page: array<u32>;
@group(0) @binding(2) var<storage, read> clusters: array<Cluster>;
@group(0) @binding(3) var<storage, read> ranges: array<vec2f>; // lower, upper
@group(0) @binding(4) var<storage, read> tables: array<u32>;   // cases of cells; a bit a cluster: a point has no data
@group(0) @binding(5) var<storage, read_write> state: array<atomic<u32>>;
@group(0) @binding(6) var<storage, read_write> positions: array<f32>;
@group(0) @binding(7) var<storage, read_write> triangles: array<u32>;

// Words of the state; JavaScript empties all of them first.
const selected_list = 0u; // count, groups of an indirect dispatch
const emitted_list = 4u;
const head_vertices = 8u; // lower and upper half
const head_triangles = 10u;
const head_overflow = 12u;
const head_selected = 13u;
const head_tied = 14u;

const workgroup_size = 128u;
const no_cluster = 0xffffffffu;

fn group_index(id: vec3u, count: vec3u) -> u32 { return (id.z * count.y + id.y) * count.x + id.x; }

fn load(at: u32) -> u32 { return atomicLoad(&state[at]); }
fn store(at: u32, value: u32) { atomicStore(&state[at], value); }

// Makes room for more items of a list; returns the place of the first.
fn grow_list(list: u32, items: u32) -> u32 {
  let place = atomicAdd(&state[list], items);
  let last = place + items - 1u;
  let axis = push.groups_per_axis;
  atomicMax(&state[list + 1u], min(last, axis - 1u) + 1u);
  atomicMax(&state[list + 2u], min(last / axis, axis - 1u) + 1u);
  atomicMax(&state[list + 3u], last / axis / axis + 1u);
  return place;
}

// What was rounded: no compiler sees that it stays the same, so none makes a product and a sum one operation.
fn rounded(x: f32) -> f32 { return bitcast<f32>(bitcast<u32>(x) ^ push.zero); }
