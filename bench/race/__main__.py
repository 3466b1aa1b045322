# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""Races isotet against VTK: python3 bench/race --build FOLDER [--quick] ... (scripts/bench.sh builds first)."""

import argparse
import datetime
import os
import sys
from pathlib import Path

import machine
import report
from cases import file_case, made_cases, shipped_files
from contestants import Refused, entrants
from measure import Plan, Race
from summary import lines_of

ROOT = Path(__file__).resolve().parents[2]


def parse(arguments: list[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="bench.sh", description="Races isotet against VTK in one run.")
    parser.add_argument("--build", type=Path, required=True, help=argparse.SUPPRESS)
    parser.add_argument("--quick", action="store_true", help="regular grids to 30 million cells, others at 5 million")
    parser.add_argument("--threads", type=int, default=len(os.sched_getaffinity(0)), help="of every contestant (all)")
    parser.add_argument("--max-cells", type=float, default=110e6, help="leave larger made grids out (110e6)")
    parser.add_argument("--rounds", type=int, default=5, help="how often everything is measured (5)")
    parser.add_argument("--pack-rounds", type=int,
                        help="how often packing and what goes with it is measured (as --rounds; 3 with --quick)")
    parser.add_argument("--isovalues", type=int, choices=range(1, 6), help="surfaces a round (5; 3 with --quick)")
    parser.add_argument("--only", default="", metavar="TEXT[,TEXT]",
                        help="only made and shipped grids whose name holds one of the texts")
    parser.add_argument("--file", nargs=2, action="append", default=[], metavar=("PATH", "FIELD"),
                        help="race on this grid, too")
    parser.add_argument("--out", type=Path, help="folder of the results (FOLDER OF THE BUILD/results)")
    parser.add_argument("--publish", action="store_true", help="take the results over into docs/performance")
    parser.add_argument("--note", default="", help="a sentence about the circumstances, kept with the results")
    parser.add_argument("--wheel-python", type=Path, help="a Python that has the VTK wheel")
    parser.add_argument("--vtk-ids", choices=("int32", "int64"), default="int64",
                        help="type of VTK's point numbers (int64, its own and the faster one)")
    options = parser.parse_args(arguments)
    if options.isovalues is None:
        options.isovalues = 3 if options.quick else 5
    if options.pack_rounds is None:
        options.pack_rounds = min(3, options.rounds) if options.quick else options.rounds
    if options.threads < 1 or not 1 <= options.pack_rounds <= options.rounds:
        parser.error("threads and rounds are at least 1, and packing has no more rounds than the rest")
    return options


def say(text: str) -> None:
    print(text, flush=True)


def main(arguments: list[str]) -> int:
    options = parse(arguments)
    options.build = options.build.resolve()
    cases = made_cases(options.quick, options.max_cells) + shipped_files(ROOT)
    cases = [case for case in cases if any(text in case.name for text in options.only.split(","))]
    cases += [file_case(Path(path).resolve(), field) for path, field in options.file]
    found, absent = entrants(options.build, options.wheel_python, options.vtk_ids)
    for name, why in absent.items():
        print(f"absent: {name}: {why}")

    facts = {"date": datetime.date.today().isoformat(), "threads": options.threads, "rounds": options.rounds,
             "pack_rounds": options.pack_rounds, "isovalues": options.isovalues, "vtk_ids": options.vtk_ids,
             "note": options.note, "absent": absent,
             "machine": machine.facts(ROOT, options.build), "load_before": machine.load()}
    plan = Plan(options.threads, options.rounds, options.pack_rounds, options.isovalues)
    out = options.out or options.build / "results"
    results, failed = [], []
    for case in cases:
        try:
            results.append(Race(case, found, plan, say).run())
        except Refused as refused:
            failed.append(f"{case.name}: {refused}")
            print(f"  not measured: {refused}", file=sys.stderr)
            continue
        report.print_table(lines_of(results[-1]), case.name)
        for difference in results[-1].differences:
            print(f"  DIFFERENT SURFACE: {difference}", file=sys.stderr)
        # After every grid, so that a race cut short leaves what it has.
        report.write_all(out, results, facts | {"load_after": machine.load(), "not_measured": failed})
    if not results:
        return 1
    print(f"results: {out}")
    if options.publish:
        report.publish(out, ROOT / "docs/performance")
        print(f"published: {ROOT / 'docs/performance'}")
    return 1 if failed or any(result.differences for result in results) else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
