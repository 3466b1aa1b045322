// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
var<workgroup> total_halves: array<atomic<u32>, 4>; // vertices lower, upper; triangles lower, upper
var<workgroup> before: array<atomic<u32>, 2>;
var<workgroup> items: array<vec2u, workgroup_size>;
var<workgroup> chunk_sums: array<vec2u, workgroup_size / 8u>;
var<workgroup> with_output: atomic<u32>;
var<workgroup> first_place: u32;
var<workgroup> in_segment: u32;

fn segment_count() -> u32 { return (push.cluster_count + segment_clusters - 1u) / segment_clusters; }
fn block_count() -> u32 { return (segment_count() + block_segments - 1u) / block_segments; }

fn wide_sum(lower: u32, upper: u32) -> vec2u {
  let low = lower + (upper << 16u);
  return vec2u(low, (upper >> 16u) + select(0u, 1u, low < lower));
}

fn add_halves(me: u32) {
  for (var block = me; block < block_count(); block += workgroup_size) {
    for (var i = 0u; i < 2u; i++) {
      let count = load(push.blocks + 2u * block + i);
      atomicAdd(&total_halves[2u * i], count & 0xffffu);
      atomicAdd(&total_halves[2u * i + 1u], count >> 16u);
    }
  }
}

fn write_totals() {
  let vertices = wide_sum(atomicLoad(&total_halves[0]), atomicLoad(&total_halves[1]));
  let corners = wide_sum(atomicLoad(&total_halves[2]), atomicLoad(&total_halves[3]));
  let fits = (vertices.y | corners.y) == 0u && vertices.x <= push.vertex_capacity && corners.x <= push.triangle_capacity;
  store(head_vertices, vertices.x);
  store(head_vertices + 1u, vertices.y);
  store(head_triangles, corners.x);
  store(head_triangles + 1u, corners.y);
  store(head_overflow, select(1u, 0u, fits));
  store(head_selected, load(selected_list));
}

fn sum_segments_before(me: u32, segment: u32) {
  let block = segment / block_segments;
  for (var i = 0u; i < 2u; i++) {
    var sum = 0u;
    for (var k = me; k < block; k += workgroup_size) { sum += load(push.blocks + 2u * k + i); }
    for (var k = block * block_segments + me; k < segment; k += workgroup_size) { sum += load(push.segments + 2u * k + i); }
    if (sum != 0u) { atomicAdd(&before[i], sum); }
  }
}

fn sum_before(me: u32, item: vec2u) -> vec2u {
  items[me] = item;
  workgroupBarrier();
  if (me < workgroup_size / 8u) {
    var sum = vec2u(0u);
    for (var i = 0u; i < 8u; i++) { sum += items[8u * me + i]; }
    chunk_sums[me] = sum;
  }
  workgroupBarrier();
  var sum = vec2u(0u);
  for (var i = 0u; i < me / 8u; i++) { sum += chunk_sums[i]; }
  for (var i = me / 8u * 8u; i < me; i++) { sum += items[i]; }
  return sum;
}

@compute @workgroup_size(workgroup_size)
fn main(@builtin(local_invocation_index) me: u32, @builtin(workgroup_id) group: vec3u, @builtin(num_workgroups) groups: vec3u) {
  let segment = group_index(group, groups);
  if (segment >= segment_count()) { return; }
  if (segment == 0u) {
    add_halves(me);
    workgroupBarrier();
    if (me == 0u) { write_totals(); }
  }
  if (me == 0u) { in_segment = load(push.segments + 2u * segment) | load(push.segments + 2u * segment + 1u); }
  if (workgroupUniformLoad(&in_segment) == 0u) { return; }
  sum_segments_before(me, segment);
  let number = segment * segment_clusters + me;
  var count = vec2u(0u);
  if (number < push.cluster_count) { count = vec2u(load(push.counts + 2u * number), load(push.counts + 2u * number + 1u)); }
  let item = vec2u(count.x & 0xffffu, count.y);
  let in_segment_before = sum_before(me, item); // its barriers complete `before`
  let has_output = (item.x | item.y) != 0u;
  var place = 0u;
  if (has_output) {
    let start = vec2u(atomicLoad(&before[0]), atomicLoad(&before[1])) + in_segment_before;
    store(push.starts + 3u * number, start.x);
    store(push.starts + 3u * number + 1u, start.x + (count.x >> 16u));
    store(push.starts + 3u * number + 2u, start.y);
    place = atomicAdd(&with_output, 1u);
  }
  workgroupBarrier();
  if (me == 0u && atomicLoad(&with_output) != 0u) { first_place = grow_list(emitted_list, atomicLoad(&with_output)); }
  workgroupBarrier();
  if (has_output) { store(push.emitted + first_place + place, number); }
}
