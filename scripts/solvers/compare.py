# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""Compares what isotet reads of one file, and one surface of it, with VTK."""
import json
import math
import multiprocessing
import subprocess

import with_vtk

# Where the cells are tets both have the same triangles but for rounding; faces of others are cut along other diagonals.
NAMES = {10: "tetrahedron", 11: "voxel", 12: "hexahedron", 13: "wedge", 14: "pyramid", 15: "pentagonal prism",
         16: "hexagonal prism", 24: "quadratic tetrahedron", 25: "quadratic hexahedron", 26: "quadratic wedge",
         27: "quadratic pyramid", 29: "triquadratic hexahedron", 32: "biquadratic quadratic wedge",
         33: "biquadratic quadratic hexahedron", 37: "triquadratic pyramid", 42: "polyhedron",
         71: "Lagrange tetrahedron", 72: "Lagrange hexahedron", 73: "Lagrange wedge", 74: "Lagrange pyramid"}
AREA_OF_TETS, AREA_OF_LINEAR_CELLS, AREA_OF_OTHERS = 2e-5, 0.01, 0.1
RANGE = 1e-5


class Isotet:
    def __init__(self, program, file, scratch, options):
        self.program, self.file, self.scratch, self.options = program, file, scratch, options

    def run(self, command, *arguments):
        """The answer, or the error's text."""
        done = subprocess.run([self.program, command, *map(str, arguments), *self.options, "--json", "-"], timeout=300,
                              capture_output=True, text=True, check=False)
        if done.returncode and not done.stdout.strip():
            return None, done.stderr.strip().splitlines()[-1] if done.stderr.strip() else f"status {done.returncode}"
        return json.loads(done.stdout), None

    def info(self, step):
        return self.run("info", self.file, "--step", step)

    def surface(self, step, field, isovalue):
        out = self.scratch / "surface.vtp"
        found, problem = self.run("extract", self.file, out, "--step", step, "-f", field, f"-i={isovalue!r}",
                                  "--edge-ends", "--precision", "double", "--tolerance", "nodes")
        if problem:
            return None, None, problem
        checked, problem = self.run("check", out, "--grid", self.file, "-f", field, "--step", step)
        if not problem and not checked["sound"]:
            problem = "check: the surface is not sound"
        return found["surfaces"][0]["area"], found["notes"], problem


def near(one, other, scale):
    return math.isclose(one, other, rel_tol=RANGE, abs_tol=RANGE * scale) or (math.isnan(one) and math.isnan(other))


def same_range(mine, its, scale, of_more):
    """Where surfaces are among the cells, isotet's range is that of all of them."""
    if of_more and mine[0] <= its[0] and mine[1] >= its[1]:
        return True
    return near(mine[0], its[0], scale) and near(mine[1], its[1], scale)


def compare_cells(info, grid):
    wanted = {}
    for cell_type, count in with_vtk.counts_by_type(grid).items():
        wanted[NAMES.get(cell_type, str(cell_type))] = count
    seen = {name: count for name, count in info["cells_by_type"].items() if name in NAMES.values()}
    if seen != wanted:
        yield f"cells: {seen}, VTK {wanted}"
    joined = any("joined" in note or "merged" in note for note in info["notes"])
    is_curved = info["curved"] is not None  # tets of a split need not use the node in the middle of a cell
    if not joined and not is_curved and info["points"] - info["unused_points"] != used_points(grid):
        yield f"points: {info['points'] - info['unused_points']}, VTK {used_points(grid)}"


def used_points(grid):
    used = set()
    cells = grid.GetCells()
    return len(set(with_vtk.vtk_to_numpy(cells.GetConnectivityArray()).tolist())) if cells else len(used)


def compare_fields(info, grid):
    seen = {(field["association"], field["name"]): field for field in info["fields"]}
    for (association, name), ranges in with_vtk.fields(grid).items():
        field = seen.get((association, name))
        told = f"{association} field {name!r}"
        if field is None:
            said = " (said)" if any(name in note for note in info["notes"]) else ""
            yield f"{told} is missing{said}"
            continue
        if field["components"] != len(ranges):
            yield f"{told}: {field['components']} components, VTK {len(ranges)}"
            continue
        for component, (mine, its) in enumerate(zip(field["range"], ranges)):
            scale = max(abs(value) for value in its)
            if mine is None or not same_range(mine, its, scale, info["cells_left_out"] > 0):
                yield f"{told}, component {component}: {mine}, VTK {list(its)}"


def compare_times(info, steps):
    if info["times"] == steps.times or (not info["times"] and steps.times == [0.0]):
        return
    if len(info["times"]) != len(steps.times) or not all(map(lambda a, b: near(a, b, 0), info["times"], steps.times)):
        yield f"times: {info['times']}, VTK {steps.times}"


def field_to_contour(info):
    """A point field of one component that varies, or else a coordinate; and a value that few points have."""
    for field in info["fields"]:
        if field["association"] == "point" and field["components"] == 1 and field["type"].startswith("float"):
            lower, upper = field["range"][0] or (0, 0)
            if upper - lower > 1e-6 * max(abs(lower), abs(upper)):
                return field["name"], lower + 0.4142 * (upper - lower)
    lower, upper = info["bounds"]["lower"][0], info["bounds"]["upper"][0]
    return "x", lower + 0.4142 * (upper - lower)


def tolerance_of_area(info):
    names = set(info["cells_by_type"]) & set(NAMES.values())
    if names <= {"tetrahedron"}:
        return AREA_OF_TETS
    linear = {"tetrahedron", "voxel", "hexahedron", "wedge", "pyramid"}
    return AREA_OF_LINEAR_CELLS if names <= linear else AREA_OF_OTHERS


def compare_step(isotet, steps, step, result):
    info, problem = isotet.info(step)
    if problem:
        result["differences"].append(f"step {step}: {problem}")
        return
    result.update(format=info["format"], steps=max(1, len(info["times"])), cells=info["cells"], points=info["points"],
                  fields=len(info["fields"]))
    result["notes"] += info["notes"]
    found = []
    field, isovalue = field_to_contour(info)
    area, notes, problem = isotet.surface(step, field, isovalue)
    if problem:
        found.append(f"surface of {field!r} at {isovalue!r}: {problem}")
    its_area = None
    if steps:
        grid = steps.grid(step)
        found += [*compare_times(info, steps), *compare_cells(info, grid), *compare_fields(info, grid)]
        if area is not None:
            its_area = with_vtk.area_of_isosurface(grid, field, isovalue)
            if abs(area - its_area) > tolerance_of_area(info) * max(area, its_area):
                found.append(f"area of {field!r} at {isovalue!r}: {area:.9g}, VTK {its_area:.9g}")
    result["surfaces"].append({"step": step, "field": field, "isovalue": isovalue, "area": area, "vtk": its_area})
    result["notes"] += notes or []
    result["differences"] += [f"step {step}: {difference}" for difference in found]


def compare_file(program, file, scratch, options):
    """{"format", "steps", "cells", "points", "fields", "surfaces": [...], "differences": [...], "notes": [...]}"""
    isotet = Isotet(program, file, scratch, options)
    result = {"surfaces": [], "differences": [], "notes": []}
    first, problem = isotet.info(0)
    if problem:
        result["differences"].append(problem)
    else:
        steps = with_vtk.Steps(file) if with_vtk.can_read(file) else None
        for step in sorted({0, max(0, len(first["times"]) - 1)}):
            compare_step(isotet, steps, step, result)
    result["notes"] = list(dict.fromkeys(result["notes"]))
    return result


def compare_safely(program, file, scratch, options):
    """In a process of its own: VTK's readers end the process on some files."""
    answers, answer = multiprocessing.Pipe(duplex=False)

    def run():
        try:
            answer.send(compare_file(program, file, scratch, options))
        except Exception as problem:  # whatever it is, it is told
            answer.send({"surfaces": [], "notes": [], "differences": [f"not compared: {problem!r}"]})

    process = multiprocessing.get_context("fork").Process(target=run)
    process.start()
    answer.close()
    try:
        result = answers.recv()
    except EOFError:
        result = {"surfaces": [], "notes": [], "differences": ["not compared: VTK's reader ended the process"]}
    process.join()
    return result
