# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""One case of the race: all methods by turns on the same arrays, round after round."""

import shutil
import tempfile
import time
from contextlib import ExitStack
from dataclasses import dataclass, field
from pathlib import Path

from cases import Case
from contestants import Contestant, Entrant, Refused
from methods import BY_KEY, MEASURED_FOR_MEMORY, METHODS, PREPARATIONS, Method, command_of

PAUSE = 0.01  # seconds before each command, in which the threads of the last contestant go to sleep


@dataclass
class Measurement:
    case: str
    shape: str
    cells: int
    points: int
    method: str
    round: int
    isovalue: float | None
    seconds: float
    vertices: int | None
    triangles: int | None
    must_move: int


@dataclass
class CaseResult:
    case: Case
    cells: int = 0
    points: int = 0
    isovalues: list[float] = field(default_factory=list)
    measurements: list[Measurement] = field(default_factory=list)
    copy_bandwidths: list[float] = field(default_factory=list)  # one a round
    packed: dict = field(default_factory=dict)  # what packing replied
    peaks: dict[str, int] = field(default_factory=dict)  # method -> bytes
    rivals: dict[str, dict] = field(default_factory=dict)  # contestant -> version, backend, threads
    differences: list[str] = field(default_factory=list)  # surfaces that are not those of VTK, merged
    compared: int = 0
    refused: list[str] = field(default_factory=list)


@dataclass(frozen=True)
class Plan:
    threads: int
    rounds: int
    pack_rounds: int  # the first ones, in which what runs once a round is measured
    isovalues: int


class Race:
    def __init__(self, case: Case, entrants: list[Entrant], plan: Plan, say):
        self.result = CaseResult(case)
        self.entrants, self.plan, self.threads, self.say = entrants, plan, plan.threads, say
        self.tied: dict[float, int] = {}  # isovalue -> tied points
        self.level = ""  # SIMD that isotet finds

    def run(self) -> CaseResult:
        with ExitStack() as stack:
            home = arrays_home(self.result.case)
            folder = Path(stack.enter_context(tempfile.TemporaryDirectory(prefix="isotet_bench_", dir=home)))
            self.make_arrays(folder)
            with ExitStack() as running:
                contestants = {entrant.name: running.enter_context(entrant.start_with(folder, self.threads))
                               for entrant in self.entrants}
                self.result.rivals = {name: one.facts for name, one in contestants.items() if "version" in one.facts}
                self.level = contestants["isotet"].facts["level"]
                methods = [method for method in METHODS if self.takes_part(method)]
                self.prepare(contestants, methods)
                for number in range(self.plan.rounds):
                    self.run_round(number, contestants, methods)
            self.compare_surfaces()
            for key, before in MEASURED_FOR_MEMORY.items():
                self.measure_peak(folder, BY_KEY[key], before)
        return self.result

    def takes_part(self, method: Method) -> bool:
        here = any(entrant.name == method.contestant for entrant in self.entrants)
        able = method.levels is None or self.level in method.levels
        return here and able and (method.max_cells is None or self.result.cells <= method.max_cells)

    def middle(self) -> float:
        return self.result.isovalues[len(self.result.isovalues) // 2]

    def make_arrays(self, folder: Path) -> None:
        case = self.result.case
        with self.entrants[0].start() as maker:
            facts = maker.ask("arrays", case.source, case.field, case.variant, folder, self.threads)
        self.result.cells, self.result.points = facts["cells"], facts["points"]
        self.result.isovalues = case.choose_isovalues(facts["lower"], facts["upper"], self.plan.isovalues)
        self.say(f"{case.name}: {self.result.cells:,} cells, {self.result.points:,} points")

    def prepare(self, contestants: dict[str, Contestant], methods: list[Method]) -> None:
        """Packs, builds trees, and runs every method once before anything counts."""
        for key in PREPARATIONS:
            if BY_KEY[key] in methods:
                reply = contestants[BY_KEY[key].contestant].ask(*command_of(BY_KEY[key], self.middle()))
                if key.startswith("pack"):
                    self.result.packed[key] = reply
        for method in methods:
            if method.per_isovalue:
                contestants[method.contestant].ask(*command_of(method, self.middle()))

    def run_round(self, number: int, contestants: dict[str, Contestant], methods: list[Method]) -> None:
        self.result.copy_bandwidths.append(contestants["isotet"].ask("copy", self.threads)["bytes_per_second"])
        every = [method for method in methods if method.per_isovalue]
        for place, isovalue in enumerate(self.result.isovalues):
            first = (number + place) % len(every)  # so that no method always follows the same one
            for method in every[first:] + every[:first]:
                self.measure(number, contestants, method, isovalue)
        if number >= self.plan.pack_rounds:
            return
        for method in methods:
            if not method.per_isovalue:
                self.measure(number, contestants, method, self.middle())

    def measure(self, number: int, contestants: dict[str, Contestant], method: Method, isovalue: float) -> None:
        time.sleep(PAUSE)
        reply = contestants[method.contestant].ask(*command_of(method, isovalue))
        uses_isovalue = any("{isovalue}" in word for word in method.command)
        self.result.measurements.append(Measurement(
            self.result.case.name, self.result.case.shape, self.result.cells, self.result.points, method.key, number,
            isovalue if uses_isovalue else None, reply["seconds"], reply.get("vertices"), reply.get("triangles"),
            reply["must_move"]))
        if method.key == "clusters":
            self.tied[isovalue] = reply["tied_points"]

    def compare_surfaces(self) -> None:
        """Without ties isotet's surface has the counts of VTK's merged one; every isovalue is looked at. VTK does not know what
        no data is, and makes triangles of it."""
        if self.result.packed["pack"]["repeated_tets"] or self.result.case.variant == "no_data":
            return
        first = [one for one in self.result.measurements if one.round == 0]
        counts = {(one.method, one.isovalue): (one.vertices, one.triangles) for one in first}
        for isovalue in self.result.isovalues:
            if self.tied[isovalue] or ("vtk_merged", isovalue) not in counts:
                continue
            self.result.compared += 1
            theirs = counts["vtk_merged", isovalue]
            for method in ("clusters", "once"):
                ours = counts[method, isovalue]
                if ours != theirs:
                    self.result.differences.append(
                        f"{self.result.case.name}, isovalue {isovalue}: {BY_KEY[method].label} has {ours[0]} vertices "
                        f"and {ours[1]} triangles, VTK merged {theirs[0]} and {theirs[1]}")

    def measure_peak(self, folder: Path, method: Method, before: tuple[str, ...]) -> None:
        if not self.takes_part(method):
            return
        entrant = next(one for one in self.entrants if one.name == method.contestant)
        try:
            with entrant.start_with(folder, self.threads) as contestant:
                for key in before:
                    contestant.ask(*command_of(BY_KEY[key], self.middle()))
                reply = contestant.ask("peak", *command_of(method, self.middle()))
                self.result.peaks[method.key] = reply["peak_bytes"]
        except Refused as refused:
            self.result.refused.append(str(refused))


def arrays_home(case: Case) -> str | None:
    """Memory, where it has room for the arrays (at most 24 bytes a cell) three times over; else the usual folder."""
    memory = Path("/dev/shm")
    if memory.is_dir() and shutil.disk_usage(memory).free > 3 * 24 * case.about_cells:
        return str(memory)
    return None
