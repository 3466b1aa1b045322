# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""The charts of docs/performance, made of the lines of a summary."""

from pathlib import Path

import svg
from measure import CaseResult
from methods import BY_KEY
from summary import Line

# Colours that people with any kind of colour vision tell apart (Okabe, Ito 2008).
STYLE = {
    "clusters": dict(color="#0072b2", heavy=True),
    "once": dict(color="#0072b2", dashed=True),
    "pack": dict(color="#56b4e9", dashed=True),
    "vtk_merged": dict(color="#d55e00", heavy=True),
    "vtk_unmerged": dict(color="#d55e00", dashed=True),
    "vtk_span_space": dict(color="#e69f00"),
    "vtk_contour_grid": dict(color="#555555"),
    "wheel_merged": dict(color="#cc79a7"),
    "wheel_span_space": dict(color="#cc79a7", dashed=True),
}
SHORT = {
    "clusters": "isotet, packed before", "once": "isotet, from arrays", "pack": "isotet, pack",
    "vtk_merged": "VTK merged", "vtk_unmerged": "VTK not merged", "vtk_span_space": "VTK, span space",
    "vtk_contour_grid": "VTK contour grid, serial", "wheel_merged": "VTK wheel",
    "wheel_span_space": "VTK wheel, span space",
}


def short_count(value: float) -> str:
    for factor, ending in ((1e9, " G"), (1e6, " M"), (1e3, " k")):
        if value >= factor:
            return f"{value / factor:g}{ending}"
    return f"{value:g}"


def short_time(seconds: float) -> str:
    for factor, unit in ((1, "s"), (1e-3, "ms"), (1e-6, "µs")):
        if seconds >= factor * 0.999:
            return f"{seconds / factor:.3g} {unit}"
    return f"{seconds:g} s"


def write_charts(folder: Path, results: list[CaseResult], lines: list[Line], conditions: str) -> list[str]:
    written = []
    for shape in sorted({line.shape for line in lines} - {"file"}):
        of_shape = [line for line in lines if line.shape == shape]
        if len({line.cells for line in of_shape}) > 1:
            written.append(f"time_{shape}.svg")
            (folder / written[-1]).write_text(time_chart(shape, of_shape, conditions))
    for name, bars, title, unit in (
            ("memory.svg", memory_bars(results), "Bytes a cell", "B"),
            ("bandwidth.svg", bandwidth_bars(results, lines), "Share of the copy bandwidth", "%")):
        if bars:
            (folder / name).write_text(svg.bars(title, conditions, bars, unit))
            written.append(name)
    return written


def time_chart(shape: str, lines: list[Line], conditions: str) -> str:
    series = [svg.Series(SHORT[key], points=[(line.cells, line.median) for line in lines if line.method == key], **style)
              for key, style in STYLE.items()]
    return svg.log_log(f"One surface: time against size, grid '{shape}'", conditions, "cells", "median time",
                       series, short_count, short_time)


def memory_bars(results: list[CaseResult]) -> list[svg.Bar]:
    bars = []
    for result in largest_of_each_shape(results):
        group = f"{result.case.name}, {result.cells / result.points:.2f} cells a point"
        kept = result.packed["pack"]["bytes"] / result.packed["pack"]["cells"]
        bars.append(svg.Bar(group, "isotet, packed grid (stays)", kept, STYLE["clusters"]["color"]))
        for key, label in (("pack", "isotet, packing (peak)"), ("once", "isotet, one surface from arrays (peak)"),
                           ("clusters", "isotet, one surface (peak)"),
                           ("vtk_merged", "VTK merged, one surface (peak)"), ("vtk_tree", "VTK, span space (peak)"),
                           ("wheel_merged", "VTK wheel, one surface (peak)")):
            if key in result.peaks:
                color = STYLE.get(key, STYLE["vtk_span_space"])["color"]
                bars.append(svg.Bar(group, label, result.peaks[key] / result.cells, color))
    return bars


def bandwidth_bars(results: list[CaseResult], lines: list[Line]) -> list[svg.Bar]:
    shown = {result.case.name for result in largest_of_each_shape(results)}
    keys = ("clusters", "new_field", "pack", "once", "vtk_merged", "vtk_unmerged", "vtk_contour_grid", "wheel_merged")
    return [svg.Bar(line.case, BY_KEY[line.method].label, 100 * line.share,
                    STYLE.get(line.method, STYLE["clusters"])["color"])
            for line in lines if line.case in shown and line.method in keys]


def largest_of_each_shape(results: list[CaseResult]) -> list[CaseResult]:
    largest: dict[str, CaseResult] = {}
    for result in results:
        shape = result.case.shape
        if shape != "file" and (shape not in largest or largest[shape].cells < result.cells):
            largest[shape] = result
    return list(largest.values())
