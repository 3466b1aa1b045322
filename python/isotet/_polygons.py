# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""Triangles of one cell joined to polygons."""

from __future__ import annotations

import numpy as np


def polygons_of(triangles: np.ndarray, cells: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The polygons along whose edges the triangles of each cell end: corners one after another, where those of each polygon
    begin, and a triangle of each polygon, ascending.

    The triangles of a cell stay as they are where they do not make up discs without vertices inside.
    """
    groups = np.unique(cells, return_inverse=True)[1].astype(np.int64)
    broken = _broken_groups(triangles, groups)
    if broken.any():
        apart = broken[groups]
        groups[apart] = len(broken) + np.flatnonzero(apart)
    starts, ends, of = _boundary(triangles, groups)[:3]
    label, following = _loops(starts, ends, groups[of // 3])
    first = np.flatnonzero(label == np.arange(len(label)))
    sizes = np.bincount(label, minlength=len(label))[first]
    offsets = np.concatenate([[0], np.cumsum(sizes)])
    corners = np.empty(len(label), np.int64)
    at, edge = np.arange(len(first)), first
    for step in range(int(sizes.max(initial=0))):
        corners[offsets[at] + step] = starts[edge]
        goes_on = sizes[at] > step + 1
        at, edge = at[goes_on], following[edge[goes_on]]
    return corners, offsets, of[first] // 3


def _boundary(triangles: np.ndarray, groups: np.ndarray):
    """Directed edges that another triangle of the group does not have the other way: both ends, and the place of each among
    all edges; and the groups with an edge of more than two triangles, or two that run the same way."""
    starts = triangles.reshape(-1).astype(np.int64)
    ends = triangles[:, [1, 2, 0]].reshape(-1).astype(np.int64)
    group = np.repeat(groups, 3)
    order = np.lexsort((np.maximum(starts, ends), np.minimum(starts, ends), group))
    low, high = np.minimum(starts, ends)[order], np.maximum(starts, ends)[order]
    same = (np.diff(low) == 0) & (np.diff(high) == 0) & (np.diff(group[order]) == 0)
    alike = same & (starts[order][1:] == starts[order][:-1])
    crowded = same[1:] & same[:-1]
    bad = np.concatenate([group[order][1:][alike], group[order][2:][crowded]])
    inner = np.zeros(len(starts), bool)
    inner[order[1:][same]] = inner[order[:-1][same]] = True
    of = np.flatnonzero(~inner)
    return starts[of], ends[of], of, bad


def _loops(starts: np.ndarray, ends: np.ndarray, group: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """For each edge the lowest one of its loop, and the next one. Each vertex begins and ends one edge of a group."""
    following = np.empty(len(starts), np.int64)
    following[np.lexsort((ends, group))] = np.lexsort((starts, group))
    label, jump = np.arange(len(starts)), following
    while True:
        lower = np.minimum(label, label[jump])
        if np.array_equal(lower, label) and np.array_equal(lower, lower[following]):
            return lower, following
        label, jump = lower, jump[jump]


def _broken_groups(triangles: np.ndarray, groups: np.ndarray) -> np.ndarray:
    count = int(groups.max(initial=-1)) + 1
    broken = np.zeros(count, bool)
    starts, ends, of, bad = _boundary(triangles, groups)
    broken[bad] = True
    group = groups[of // 3]
    order = np.lexsort((starts, group))
    twice = (np.diff(starts[order]) == 0) & (np.diff(group[order]) == 0)
    broken[group[order][1:][twice]] = True
    sound = ~broken[group]
    label, _ = _loops(starts[sound], ends[sound], group[sound])
    loops = np.bincount(group[sound][label == np.arange(len(label))], minlength=count)
    edges = np.bincount(group, minlength=count)
    return broken | (np.bincount(groups, minlength=count) != edges - 2 * loops)
