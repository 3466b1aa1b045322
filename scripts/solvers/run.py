# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""Runs simulation programs and compares what isotet reads of their files with VTK (scripts/solvers.sh)."""
import argparse
import fnmatch
import json
import math
import pathlib
import sys

from compare import compare_safely
from program import NotToBeHad, Program

HERE = pathlib.Path(__file__).resolve().parent


def known_differences():
    """[(program, file, beginning of the difference, reason)]: patterns as of the shell."""
    for line in (HERE / "known.txt").read_text(encoding="utf-8").splitlines():
        if line.strip() and not line.startswith("#"):
            yield tuple(word.strip() for word in line.split("|"))


def reason_for(known, program, file, difference):
    for its_program, its_file, pattern, reason in known:
        if fnmatch.fnmatchcase(program, its_program) and fnmatch.fnmatchcase(file, its_file) and \
                fnmatch.fnmatchcase(difference, pattern):
            return reason
    return None


def compare_siblings(results, file):
    """Files of one name hold the same: where VTK cannot read one, those before it tell what is right."""
    for surface in results[file]["surfaces"]:
        for sibling in results:
            if sibling == file or sibling.name.split(".")[0] != file.name.split(".")[0]:
                continue
            for its in results[sibling]["surfaces"]:
                if same_surface(surface, its) and not math.isclose(surface["area"], its["area"], rel_tol=0.01):
                    results[file]["differences"].append(
                        f"area {surface['area']:.9g}, of {sibling.name} {its['area']:.9g}")
                    return


def same_surface(one, other):
    same = one["field"] == other["field"] and one["step"] == other["step"]
    there = one["area"] is not None and other["area"] is not None
    return same and there and math.isclose(one["isovalue"], other["isovalue"], rel_tol=1e-5)


def show(program, file, result, known):
    """How many differences have no reason."""
    surfaces = ", ".join(f"{s['field']}: {s['area']:.6g}" + (f" ({s['vtk']:.6g})" if s["vtk"] is not None else "")
                         for s in result["surfaces"] if s["area"] is not None)
    print(f"{program.name:14} {str(file.relative_to(program.folder / 'files')):34} {result.get('format', '-'):9}"
          f"{result.get('steps', '-'):>4}{result.get('cells', '-'):>8}{result.get('points', '-'):>8}"
          f"{result.get('fields', '-'):>4}  {surfaces}", flush=True)
    unknown = 0
    for difference in result["differences"]:
        reason = reason_for(known, program.name, file.name, difference)
        unknown += reason is None
        print(f"    {'known' if reason else 'DIFFERS'}: {difference}" + (f" [{reason}]" if reason else ""))
    return unknown


def try_program(program, arguments, known):
    """Differences without a reason; -1 where it is not to be had."""
    try:
        program.install()
        files = program.write_files()
    except NotToBeHad as problem:
        print(f"{program.name:14} not to be had: {problem}")
        return -1
    if not files:
        print(f"{program.name:14} DIFFERS: wrote no file")
        return 1
    unknown, scratch = 0, program.folder / "scratch"
    scratch.mkdir(exist_ok=True)
    results = {}
    for file in files:
        results[file] = compare_safely(arguments.isotet, file, scratch, program.options)
        compare_siblings(results, file)
        unknown += show(program, file, results[file], known)
    (program.folder / "results.json").write_text(
        json.dumps({file.name: result for file, result in results.items()}, indent=1))
    return unknown


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--isotet", required=True, help="the program isotet")
    parser.add_argument("--build", required=True, type=pathlib.Path, help="where programs are installed and run")
    parser.add_argument("--list", action="store_true", help="only names the programs")
    parser.add_argument("names", nargs="*", help="some programs (all)")
    arguments = parser.parse_args()
    scripts = sorted((HERE / "programs").glob("*.py"))
    unheard_of = set(arguments.names) - {script.stem for script in scripts}
    if unheard_of:
        parser.error(f"no programs: {', '.join(sorted(unheard_of))}; there are {', '.join(s.stem for s in scripts)}")
    programs = [Program.at(script, arguments.build) for script in scripts
                if not arguments.names or script.stem in arguments.names]
    if arguments.list:
        for program in programs:
            print(f"{program.name:14} {' '.join(program.pip + program.debian)}")
        return 0
    known = list(known_differences())
    print(f"{'program':14} {'file':34} {'format':9}{'steps':>4}{'cells':>8}{'points':>8}{'fields':>4}  areas (VTK's)")
    counts = {program.name: try_program(program, arguments, known) for program in programs}
    absent = [name for name, count in counts.items() if count < 0]
    differing = [name for name, count in counts.items() if count > 0]
    print(f"\n{len(counts) - len(absent)} programs were run, {len(absent)} not to be had"
          f"{': ' if absent else ''}{', '.join(absent)}; {len(differing)} with differences"
          f"{': ' if differing else ''}{', '.join(differing)}")
    return 1 if differing else 0


if __name__ == "__main__":
    sys.exit(main())
