# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""What a race leaves: CSV, JSON, charts, a table on the terminal, and the tables of docs/performance."""

import csv
import dataclasses
import json
from pathlib import Path
from statistics import median

from charts import short_time, write_charts
from measure import CaseResult, Measurement
from methods import BY_KEY
from summary import Line, growth_exponent, lines_of

BEGIN, END = "<!-- measured: begin -->", "<!-- measured: end -->"


def write_all(folder: Path, results: list[CaseResult], facts: dict) -> list[Line]:
    folder.mkdir(parents=True, exist_ok=True)
    lines = [line for result in results for line in lines_of(result)]
    write_csv(folder / "measurements.csv", [one for result in results for one in result.measurements], Measurement)
    write_csv(folder / "summary.csv", lines, Line)
    run = facts | {"cases": [facts_of(result) for result in results]}
    (folder / "run.json").write_text(json.dumps(run, indent=1) + "\n")
    write_charts(folder, results, lines, conditions(facts))
    (folder / "tables.md").write_text(tables(results, lines, facts))
    return lines


def write_csv(path: Path, rows: list, kind: type) -> None:
    with path.open("w", newline="") as file:
        writer = csv.DictWriter(file, [field.name for field in dataclasses.fields(kind)], lineterminator="\n")
        writer.writeheader()
        writer.writerows(dataclasses.asdict(row) for row in rows)


def facts_of(result: CaseResult) -> dict:
    return {"name": result.case.name, "field": result.case.field, "isovalues": result.isovalues, "cells": result.cells,
            "points": result.points, "copy_bytes_per_second": result.copy_bandwidths, "packed": result.packed,
            "peak_bytes": result.peaks, "rivals": result.rivals, "surfaces_compared": result.compared,
            "differences": result.differences, "refused": result.refused}


def conditions(facts: dict) -> str:
    machine = facts["machine"]
    return (f"{machine['processor']}, {facts['threads']} threads, {machine['simd']}, commit {machine['commit']}, "
            f"{facts['rounds']} rounds")


def print_table(lines: list[Line], case: str) -> None:
    header = [("best", 9), ("median", 9), ("worst", 9), ("triangles", 10), ("Mcell/s", 8), ("share", 6), ("faster", 7)]
    print(" " * 52, *(f"{name:>{width}}" for name, width in header))
    for line in lines:
        if line.case != case:
            continue
        triangles = f"{line.triangles:,.0f}" if line.triangles is not None else ""
        faster = f"{line.speedup_best:.1f} x" if line.speedup_best is not None else ""
        print(f"  {BY_KEY[line.method].label:<50} {short_time(line.best):>9} {short_time(line.median):>9} "
              f"{short_time(line.worst):>9} {triangles:>10} {line.cells_per_second / 1e6:>8.1f} {100 * line.share:>5.0f}% "
              f"{faster:>7}", flush=True)


def table(header: list[str], rows: list[list[str]]) -> str:
    """The first column is text, all others are numbers."""
    out = ["| " + " | ".join(header) + " |", "|---" + "|---:" * (len(header) - 1) + "|"]
    return "\n".join(out + ["| " + " | ".join(row) + " |" for row in rows]) + "\n"


def tables(results: list[CaseResult], lines: list[Line], facts: dict) -> str:
    parts = [conditions_table(results, facts),
             "### One surface\n", speed_table(results, lines), exponents(lines),
             "### Packing and memory\n", packing_table(results, lines)]
    return "\n".join(part for part in parts if part)


def conditions_table(results: list[CaseResult], facts: dict) -> str:
    machine = facts["machine"]
    copies = [value for result in results for value in result.copy_bandwidths]
    rivals = {}
    for result in results:
        for name, rival in result.rivals.items():
            rivals[name] = f"VTK {rival['version']}, {rival['backend']}, {rival['threads']} threads"
    rows = [["circumstances", facts["note"]]] if facts["note"] else []
    rows += [
        ["machine", f"{machine['processor']}, {machine['processors']} processors, {machine['simd']}, "
                    f"{machine['memory_bytes'] / 1e9:.0f} GB, virtual machine: {machine['virtual_machine']}, "
                    f"huge pages: {machine['huge_pages']}"],
        ["system", f"{machine['system']}, {machine['compiler']}, {machine['build_type']}"],
        ["commit", machine["commit"] + (" and changes" if machine["changed_since_commit"] else "")],
        ["date", facts["date"]],
        ["threads", str(facts["threads"])],
        ["rounds", f"{facts['rounds']}, of {facts['isovalues']} isovalues each; packing and what goes with it in "
                   f"{facts['pack_rounds']} of them"],
        ["copy bandwidth, read and written", f"{median(copies) / 1e9:.1f} GB/s (median of the run; "
                                             f"{min(copies) / 1e9:.1f} to {max(copies) / 1e9:.1f})"],
        ["processes wanting to run, at start and end", f"{facts['load_before']:.1f}, {facts['load_after']:.1f}"],
        ["rivals", "; ".join(rivals.values()) or "none"],
        ["absent", "; ".join(f"{name}: {why}" for name, why in facts["absent"].items()) or "none"],
        ["welded surfaces compared with VTK's", f"{sum(r.compared for r in results)}, with other counts: "
                                                f"{sum(len(r.differences) for r in results)}"],
    ]
    return "| | |\n|---|---|\n" + "".join(f"| {name} | {value} |\n" for name, value in rows)


def by_method(lines: list[Line], case: str) -> dict[str, Line]:
    return {line.method: line for line in lines if line.case == case}


def middle(line: Line | None) -> str:
    return short_time(line.median) if line else ""


def times_faster(line: Line) -> str:
    return f"{line.speedup_median:.1f} x" if line.speedup_median else ""


def speed_table(results: list[CaseResult], lines: list[Line]) -> str:
    rows = []
    for result in results:
        of = by_method(lines, result.case.name)
        ours, once = of["clusters"], of["once"]
        shown = ("clusters", "clusters_avx2", "clusters_portable", "once", "vtk_merged", "wheel_merged")
        rows.append([result.case.name, f"{result.cells:,}", f"{ours.triangles:,.0f}", *(middle(of.get(key)) for key in shown),
                     times_faster(ours), times_faster(once)])
    return table(["grid", "cells", "triangles", "isotet, packed before", "with AVX2 only", "portable code only",
                  "from arrays", "VTK merged", "VTK wheel, merged", "faster: packed", "faster: from arrays"], rows)


def exponents(lines: list[Line]) -> str:
    said = []
    for shape in sorted({line.shape for line in lines} - {"file"}):
        for key in ("clusters", "vtk_merged"):
            slope = growth_exponent(lines, key, shape, 0.9e6)
            if slope is not None:
                said.append(f"{BY_KEY[key].label}, {shape}: {slope:.2f}")
    if not said:
        return ""
    return f"Time grows with the number of cells, from 1 million on, to the power of: {'; '.join(said)}.\n"


def packing_table(results: list[CaseResult], lines: list[Line]) -> str:
    """Of grids so large that their peaks are not the process's own."""
    rows = []
    for result in results:
        if result.cells < 900_000:
            continue
        of = by_method(lines, result.case.name)
        pack = result.packed["pack"]
        peak = {key: f"{value / result.cells:.1f}" for key, value in result.peaks.items()}
        rows.append([result.case.name, middle(of["pack"]), middle(of["new_field"]), f"{pack['bytes'] / pack['cells']:.2f}",
                     *(peak.get(key, "") for key in ("pack", "once", "clusters", "vtk_merged", "wheel_merged"))])
    return ("Memory in bytes a cell; peaks beyond the input, in a process of its own.\n\n" +
            table(["grid", "pack", "new field", "packed grid", "peak: pack", "from arrays", "packed before", "VTK merged",
                   "VTK wheel"], rows))


def publish(results_folder: Path, docs: Path) -> None:
    """Takes the files of a race over into docs/performance, the tables between the marks of its README.md."""
    for path in sorted(results_folder.iterdir()):
        if path.suffix in (".csv", ".svg", ".json"):
            (docs / path.name).write_bytes(path.read_bytes())
    readme = docs / "README.md"
    text = readme.read_text()
    head, _, rest = text.partition(BEGIN)
    _, mark, tail = rest.partition(END)
    if not mark:
        raise SystemExit(f"{readme} has no '{BEGIN}' and '{END}' to write between")
    readme.write_text(f"{head}{BEGIN}\n\n{(results_folder / 'tables.md').read_text()}\n{END}{tail}")
