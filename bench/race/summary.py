# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""From single measurements to one line a method and case."""

import math
from collections import defaultdict
from dataclasses import dataclass
from statistics import mean, median

from measure import CaseResult
from methods import BY_KEY, MERGED_RIVALS


@dataclass
class Line:
    """Seconds are those of one run; in a round of several isovalues, their mean."""

    case: str
    shape: str
    cells: int
    points: int
    method: str
    triangles: float | None
    best: float
    median: float
    worst: float
    must_move: float
    bandwidth: float  # bytes that must move, a second, at the median
    share: float  # of the copy bandwidth of the same case
    speedup_best: float | None  # against the faster merged rival, best against best
    speedup_median: float | None
    runs: int  # rounds in which it was measured

    @property
    def cells_per_second(self) -> float:
        return self.cells / self.median


def lines_of(result: CaseResult) -> list[Line]:
    rounds = defaultdict(lambda: defaultdict(list))
    for one in result.measurements:
        rounds[one.method][one.round].append(one)
    seconds = {method: [mean(one.seconds for one in runs) for runs in of_method.values()]
               for method, of_method in rounds.items()}
    rivals = [seconds[key] for key in MERGED_RIVALS if key in seconds]
    copy = median(result.copy_bandwidths)

    lines = []
    for method, times in seconds.items():
        runs = [one for of_round in rounds[method].values() for one in of_round]
        triangles = [one.triangles for one in runs if one.triangles is not None]
        must_move = mean(one.must_move for one in runs)
        bandwidth = must_move / median(times)
        comparable = rivals and triangles  # makes a surface
        lines.append(Line(
            result.case.name, result.case.shape, result.cells, result.points, method,
            mean(triangles) if triangles else None, min(times), median(times), max(times), must_move,
            bandwidth, bandwidth / copy,
            min(min(rival) for rival in rivals) / min(times) if comparable else None,
            min(median(rival) for rival in rivals) / median(times) if comparable else None, len(times)))
    order = list(BY_KEY)
    return sorted(lines, key=lambda line: order.index(line.method))


def growth_exponent(lines: list[Line], method: str, shape: str, from_cells: float) -> float | None:
    """Slope of log time against log cells, by least squares; 1 is in proportion to the grid, 2/3 to its surface."""
    chosen = [line for line in lines if line.method == method and line.shape == shape and line.cells >= from_cells]
    if len(chosen) < 2:
        return None
    x = [math.log(line.cells) for line in chosen]
    y = [math.log(line.best) for line in chosen]
    x_mean, y_mean = mean(x), mean(y)
    return (sum((a - x_mean) * (b - y_mean) for a, b in zip(x, y)) / sum((a - x_mean) ** 2 for a in x))
