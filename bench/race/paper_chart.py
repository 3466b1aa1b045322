# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""Draws Figure 4 of Buatois, Caumon and Levy (2006) from `isotet bench --paper --json`.

    python3 bench/race/paper_chart.py paper.json paper.svg
"""

import json
import sys
from pathlib import Path

import svg

COLORS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000", "#7f7f7f", "#8c564b", "#999933"]
# As far as the text of the paper has numbers: GPU(R) on a card of 256 MB.
IN_THE_PAPER = svg.Series("GPU(R) in the paper, 2006", "#555555", [(1e5, 6.7e6), (6e5, 6.7e6), (1e6, 4e6)], dashed=True)
IN_PAPER_WORDS = {"registers": "registers, GPU(R)", "textures": "textures, GPU(T)"}


def series_of(rows: list[dict]) -> list[svg.Series]:
    points: dict[str, list[tuple[float, float]]] = {}
    for row in rows:
        if row["missing"]:
            continue
        name = IN_PAPER_WORDS.get(row["method"], row["method"])
        if row["index"] not in (None, "none"):
            name += f" + {row['index']}"
        points.setdefault(name, []).append((row["tets"], row["tets_per_second"]))
    return [svg.Series(name, COLORS[i % len(COLORS)], line, dashed=i >= len(COLORS))
            for i, (name, line) in enumerate(points.items())]


def main() -> None:
    source, target = map(Path, sys.argv[1:3])
    report = json.loads(source.read_text())
    device = report["device"]["name"] if report["device"] else "no device"
    label = "{:g}".format
    target.write_text(svg.log_log("Isovalue to picture, as Figure 4 of the paper", f"{device}; {report['threads']} threads",
                                  "tets of the grid", "tets a second", series_of(report["rows"]) + [IN_THE_PAPER],
                                  label, label))


if __name__ == "__main__":
    main()
