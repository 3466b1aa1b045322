# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""What a race leaves: CSV, JSON, charts, a table on the terminal, and the tables of docs/performance."""

import csv
import dataclasses
import json
from pathlib import Path
from statistics import median

from charts import short_time, write_charts
from measure import CaseResult, Measurement
from methods import BY_KEY, MEASURED_FOR_MEMORY
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
             "### One surface after another\n", speed_table(results, lines), exponents(lines),
             "### On processors that can do less\n", levels_table(results, lines),
             "### Packing, new fields, and everything once\n", steps_table(results, lines),
             "### What normals and attributes cost\n", attributes_table(results, lines),
             "### Memory\n", memory_table(results)]
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


def three(line: Line | None) -> str:
    if line is None:
        return ""
    if line.runs == 1:
        return f"{short_time(line.best)} (1 run)"
    return f"{short_time(line.best)} / {short_time(line.median)} / {short_time(line.worst)}"


def speed_table(results: list[CaseResult], lines: list[Line]) -> str:
    rows = []
    for result in results:
        of = by_method(lines, result.case.name)
        ours = of["clusters"]
        rivals = [three(of.get(key)) for key in ("vtk_merged", "wheel_merged", "vtk_span_space")]
        rows.append([result.case.name, f"{result.cells:,}", f"{ours.triangles:,.0f}", three(ours), *rivals, times_faster(ours)])
    return table(["grid", "cells", "triangles", "isotet, packed before", "VTK merged", "VTK wheel, merged",
                  "VTK merged, span space", "faster than the faster merged VTK (best, median)"], rows)


def times_faster(line: Line | None) -> str:
    return f"{line.speedup_best:.1f} x, {line.speedup_median:.1f} x" if line and line.speedup_best else ""


def levels_table(results: list[CaseResult], lines: list[Line]) -> str:
    rows = []
    for result in results:
        of = by_method(lines, result.case.name)
        columns = [(three(of.get(key)), times_faster(of.get(key))) for key in ("clusters_avx2", "clusters_portable")]
        rows.append([result.case.name, *(text for column in columns for text in column)])
    than = "faster than the faster merged VTK (best, median)"
    return ("isotet, packed before, as it would be without AVX-512, and without AVX2 too.\n\n" +
            table(["grid", "with AVX2 only", than, "portable code only", than], rows))


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


def steps_table(results: list[CaseResult], lines: list[Line]) -> str:
    rows = []
    for result in results:
        of = by_method(lines, result.case.name)
        pack, new_field, once = of["pack"], of["new_field"], of["once"]
        rows.append([result.case.name, three(pack), f"{pack.cells_per_second / 1e6:.1f}", three(new_field),
                     f"{new_field.cells_per_second / 1e6:.0f}", three(once),
                     f"{once.speedup_best:.2f} x, {once.speedup_median:.2f} x" if once.speedup_best else "",
                     three(of.get("vtk_tree"))])
    return table(["grid", "pack", "million cells a second", "new field", "million cells a second",
                  "one surface from arrays, nothing kept", "against the faster merged VTK (best, median)",
                  "VTK span space and one surface"], rows)


def cost(of: dict[str, Line], method: str, without: str) -> str:
    if method not in of:
        return ""
    seconds = of[method].best - of[without].best
    return short_time(seconds) if seconds > 0 else "lost in noise"


def attributes_table(results: list[CaseResult], lines: list[Line]) -> str:
    rows = []
    for result in results:
        of = by_method(lines, result.case.name)
        added = [cost(of, key, "clusters")
                 for key in ("face_normals", "gradient_normals", "point_field", "source_cells")]
        theirs = [cost(of, key, "vtk_merged") for key in ("vtk_normals", "vtk_attributes")]
        rows.append([result.case.name, short_time(of["clusters"].best), *added, cost(of, "pack_full", "pack"), *theirs])
    return "Best time with it, less best time without.\n\n" + table(
        ["grid", "surface alone", "+ face normals", "+ gradient normals", "+ one point field", "+ source cells",
         "packing: + gradients and source cells", "VTK merged: + normals", "VTK merged: + one point field"], rows)


def memory_table(results: list[CaseResult]) -> str:
    rows = []
    for result in results:
        pack, full = result.packed["pack"], result.packed["pack_full"]
        peak = {key: f"{value / result.cells:.1f}" for key, value in result.peaks.items()}
        rows.append([result.case.name, f"{result.cells / result.points:.2f}", f"{pack['bytes'] / pack['cells']:.2f}",
                     f"{full['source_bytes'] / full['cells']:.2f}", f"{full['gradient_bytes'] / full['cells']:.2f}",
                     *(peak.get(key, "") for key in MEASURED_FOR_MEMORY)])
    return "Bytes a cell. Peaks: beyond the input, in a process of its own.\n\n" + table(
        ["grid", "cells a point", "packed grid", "source cells", "gradients", "peak: pack", "peak: one surface from arrays",
         "peak: one surface, packed before", "peak: VTK merged", "peak: VTK span space", "peak: VTK wheel"], rows)


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
