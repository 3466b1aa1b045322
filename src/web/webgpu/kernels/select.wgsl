// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
var<workgroup> found: atomic<u32>;
var<workgroup> first_place: u32;

@compute @workgroup_size(workgroup_size)
fn main(@builtin(local_invocation_index) me: u32, @builtin(workgroup_id) group: vec3u, @builtin(num_workgroups) groups: vec3u) {
  let segment = group_index(group, groups);
  if (segment * segment_clusters >= push.cluster_count) { return; }
  if (me == 0u) {
    let block = segment / block_segments;
    for (var i = 0u; i < 2u; i++) {
      store(push.segments + 2u * segment + i, 0u);
      if (segment % block_segments == 0u) { store(push.blocks + 2u * block + i, 0u); }
    }
  }
  let number = segment * segment_clusters + me;
  var selected = false;
  if (number < push.cluster_count) {
    let range = ranges[number];
    selected = range.x <= push.isovalue && push.isovalue <= range.y;
    store(push.counts + 2u * number, 0u);
    store(push.counts + 2u * number + 1u, 0u);
  }
  var place = 0u;
  if (selected) { place = atomicAdd(&found, 1u); }
  workgroupBarrier();
  if (me == 0u && atomicLoad(&found) != 0u) { first_place = grow_list(selected_list, atomicLoad(&found)); }
  workgroupBarrier();
  if (!selected) { return; }
  store(push.selected + first_place + place, number);
  let words = tied_words + ((clusters[number].seams & own_seams_bits) + 31u) / 32u;
  for (var word = 0u; word < words; word++) { store(push.masks + clusters[number].first_mask + word, 0u); }
}
