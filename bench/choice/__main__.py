# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""How good the automatic choice of `isotet extract` is: ten cases, each by every fixed choice and by the automatic one,
alternating; the best of a few rounds of each. Prints a table in Markdown.

    python3 bench/choice --program build/release/apps/cli/isotet [--rounds N] [--threads N]
"""

import argparse
import json
import subprocess
import sys

# A grid, and how many isovalues are asked for. Stated before anything was measured: small and large grids, regular and
# shuffled, tets and other cells, few and many surfaces; three stand near where packing begins to pay.
CASES = [
    ("make:kuhn:17:sphere", 1),
    ("make:kuhn:17:sphere", 300),
    ("make:kuhn:59:gyroid", 1),
    ("make:kuhn:59:gyroid", 40),
    ("make:kuhn:59:gyroid", 300),
    ("make:shuffled:59:gyroid", 10),
    ("make:hex:70:torus", 60),
    ("make:mixed:60:sphere", 5),
    ("make:kuhn:94:gyroid", 20),
    ("make:kuhn:94:gyroid", 120),
]
FIXED = ("brute", "clusters")
GOOD = 1.2


def run(program, threads, grid, levels, method):
    command = [program, "extract", grid, "--levels", str(levels), "--method", method, "--device", "none", "-j", str(threads), "--json", "-"]
    return json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)


def measure(program, threads, rounds, grid, levels):
    """The shortest time of every choice, and the report of the fastest automatic run."""
    best = {}
    for _ in range(rounds):
        for method in (*FIXED, "auto"):
            report = run(program, threads, grid, levels, method)
            if method not in best or seconds(report) < seconds(best[method]):
                best[method] = report
    return best


def seconds(report):
    return report["choice"]["measured"]["seconds"]


def row(grid, levels, best):
    fastest = min(seconds(best[method]) for method in FIXED)
    auto = best["auto"]["choice"]
    ratio = seconds(best["auto"]) / fastest
    cells = [grid.removeprefix("make:"), f"{best['auto']['cells']:,}", str(levels)]
    cells += [f"{1e3 * seconds(best[method]):.0f}" for method in FIXED]
    cells += [best["auto"]["method"], f"{1e3 * seconds(best['auto']):.0f}", f"{ratio:.2f}", f"{1e3 * auto['predicted']['seconds']:.0f}"]
    cells += [f"{auto['predicted']['bytes'] / 1e6:.0f}", f"{auto['measured']['bytes'] / 1e6:.0f}", auto["speeds"]]
    return ratio, "| " + " | ".join(cells) + " |"


def main():
    options = argparse.ArgumentParser(prog="bench/choice", description=__doc__.split("\n\n")[0])
    options.add_argument("--program", required=True)
    options.add_argument("--rounds", type=int, default=5)
    options.add_argument("--threads", type=int, default=0)
    given = options.parse_args()
    print("| grid | cells | surfaces | brute, ms | clusters, ms | chosen | took, ms | of the best | predicted, ms | predicted, MB | took, MB | speeds |")
    print("|---|---:|---:|---:|---:|---|---:|---:|---:|---:|---:|---|")
    ratios = []
    for grid, levels in CASES:
        ratio, line = row(grid, levels, measure(given.program, given.threads, given.rounds, grid, levels))
        ratios.append(ratio)
        print(line, flush=True)
    print(f"\n{sum(ratio <= GOOD for ratio in ratios)} of {len(ratios)} within 20 % of the best fixed choice")


if __name__ == "__main__":
    sys.exit(main())
