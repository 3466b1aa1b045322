# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""How good the automatic choice of `isotet extract` is: ten cases, each by every fixed choice and by the automatic one,
alternating; the best of a few rounds of each. Prints a table in Markdown.

    python3 bench/choice --program build/release/apps/cli/isotet [--rounds N] [--threads N]
"""

import argparse
import json
import subprocess
import sys

# A grid, how many isovalues are asked for, and which normals: small and large grids, regular and shuffled, tets and other
# cells, few and many surfaces; three stand near where packing begins to pay.
CASES = [
    ("make:kuhn:17:sphere", 1, "none"),
    ("make:kuhn:17:sphere", 300, "none"),
    ("make:kuhn:59:gyroid", 1, "none"),
    ("make:kuhn:59:gyroid", 40, "none"),
    ("make:kuhn:59:gyroid", 300, "none"),
    ("make:kuhn:59:gyroid", 10, "gradient"),
    ("make:shuffled:59:gyroid", 10, "none"),
    ("make:hex:70:torus", 60, "none"),
    ("make:kuhn:94:gyroid", 20, "none"),
    ("make:kuhn:94:gyroid", 120, "none"),
]
FIXED = ("direct", "clusters")
GOOD = 1.2


def run(program, threads, case, method):
    grid, levels, normals = case
    command = [program, "extract", grid, "--levels", str(levels), "--normals", normals, "--method", method]
    command += ["-j", str(threads), "--json", "-"]
    return json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)


def measure(program, threads, rounds, case):
    """The shortest time of every choice, and the report of the fastest automatic run."""
    best = {}
    for _ in range(rounds):
        for method in (*FIXED, "auto"):
            report = run(program, threads, case, method)
            if method not in best or seconds(report) < seconds(best[method]):
                best[method] = report
    return best


def seconds(report):
    return report["measured"]["seconds"]


def row(case, best):
    fastest = min(seconds(best[method]) for method in FIXED)
    auto = best["auto"]
    ratio = seconds(best["auto"]) / fastest
    grid, levels, normals = case
    cells = [grid.removeprefix("make:"), f"{best['auto']['cells']:,}", f"{levels}, {normals} normals"]
    cells += [f"{1e3 * seconds(best[method]):.0f}" for method in FIXED]
    cells += [best["auto"]["method"], f"{1e3 * seconds(best['auto']):.0f}", f"{ratio:.2f}", f"{1e3 * auto['predicted']['seconds']:.0f}"]
    taken = auto["measured"]["bytes"]
    cells += [f"{auto['predicted']['bytes'] / 1e6:.0f}", "" if taken is None else f"{taken / 1e6:.0f}"]
    return ratio, "| " + " | ".join(cells) + " |"


def main():
    options = argparse.ArgumentParser(prog="bench/choice", description=__doc__.split("\n\n")[0])
    options.add_argument("--program", required=True)
    options.add_argument("--rounds", type=int, default=5)
    options.add_argument("--threads", type=int, default=0)
    given = options.parse_args()
    print("| grid | cells | surfaces | direct, ms | clusters, ms | chosen | took, ms | of the best | predicted, ms "
          "| predicted, MB | took, MB |")
    print("|---|---:|---|---:|---:|---|---:|---:|---:|---:|---:|")
    ratios = []
    for case in CASES:
        ratio, line = row(case, measure(given.program, given.threads, given.rounds, case))
        ratios.append(ratio)
        print(line, flush=True)
    print(f"\n{sum(ratio <= GOOD for ratio in ratios)} of {len(ratios)} within 20 % of the best fixed choice")


if __name__ == "__main__":
    sys.exit(main())
