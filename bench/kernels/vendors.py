# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""Tables in Markdown of what bench/kernels/vendors.sh has compiled: a row a kernel, a column a device.

    python bench/kernels/vendors.py FOLDER [all] [--against FOLDER]

all: a row for every set of constants, not only those of SHOWN and the longest of other kernels.
--against: also how the estimated cycles have changed from another run; ends with 1 where they are more than 2 % worse.
"""

import argparse
import pathlib
import re
import sys

TITLES = {
    "skl": "Intel Gen9", "dg2": "Arc DG2", "bmg": "Arc BMG (Xe2)", "a660": "Adreno 660", "a740": "Adreno 740",
    "ampere": "NVK Ampere", "g610": "Mali G610", "navi31": "AMD navi31", "vega10": "AMD vega10",
}
WORSE = 1.02

# Of a kernel with constants that are told apart; of the others the row with the most instructions on the first device.
SHOWN = {
    "count": ["tets", "native cells"],
    "emit": ["tets", "tets, normals", "native cells", "native cells, ends, normals, sources", "tets, many edges",
             "native cells, ends, normals, sources, many edges"],
}


def intel(s):
    """SIMD width, live registers, instructions, thousands of cycles; spills where there are any."""
    spills = s["Spill Count"] + s["Fill Count"]
    text = f"{s['subgroup']:.0f}, {s['Max live registers']:.0f}, {s['Instruction Count']:.0f}, {s['Cycle Count'] / 1e3:.0f}"
    return text + (f", **{spills:.0f} spills**" if spills else "")


def adreno(s):
    """Registers of 4 words, waves a core, instructions, estimated stalls."""
    spills = s["STP Count"] + s["LDP Count"]
    text = (f"{s['Registers used']:.0f}, {s['Max Waves Per Core']:.0f}, {s['Instruction Count']:.0f}, "
            f"{adreno_stalls(s):.0f}")
    return text + (f", **{spills:.0f} spills**" if spills else "")


def adreno_stalls(s):
    return s["Estimated cycles stalled on SS"] + s["Estimated cycles stalled on SY"]


def nvk(s):
    """Registers, warps of 48 that a multiprocessor holds of them, bytes of local memory, instructions."""
    registers = s["Number of GPRs"]
    warps = min(48, int(65536 // (32 * (-(-registers // 8) * 8))) // 4 * 4)  # workgroups have four
    return f"{registers:.0f}, {warps}, {s['SLM Size']:.0f}, {s['Instruction count']:.0f}"


def mali(s):
    """Spills:fills, cycles of loads and stores, of arithmetic, instructions."""
    arithmetic = max(s["fma"], s["cvt"], s["sfu"])
    return f"{s['spills']:.0f}:{s['fills']:.0f}, {s['ls']:.0f}, {arithmetic:.0f}, {s['inst']:.0f}"


def amd(s):
    """Waves a SIMD, instructions, cycles a wave."""
    spills = s["Spilled SGPRs"] + s["Spilled VGPRs"] + s["Scratch size"]
    text = f"{s['Subgroups per SIMD']:.0f}, {s['Instructions']:.0f}, {s['Inverse Throughput']:.0f}"
    return text + (f", **{spills:.0f} spills**" if spills else "")


# Of each vendor: what stands in its cells, and what its compiler estimates as the cycles of one invocation.
VENDORS = {
    "intel": (intel, lambda s: s["Cycle Count"] / s["subgroup"]),
    "adreno": (adreno, lambda s: s["Instruction Count"] + adreno_stalls(s)),
    "nvk": (nvk, lambda s: s["Instruction count"]),
    "mali": (mali, lambda s: s["cycles"]),
    "amd": (amd, lambda s: s["Inverse Throughput"]),
}
VENDOR_OF = {"skl": "intel", "dg2": "intel", "bmg": "intel", "a660": "adreno", "a740": "adreno", "ampere": "nvk",
             "g610": "mali", "navi31": "amd", "vega10": "amd"}


def mali_figures(line):
    """Arm's driver writes a line of its own for each stage: "1919 inst, 146.000000 cycles, ..., 1:15 spills:fills"."""
    found = {name: float(value) for value, name in re.findall(r"([\d.]+) (\w+)", line)}
    spills = re.search(r"(\d+):(\d+) spills:fills", line)
    found["spills"], found["fills"] = (float(spills[1]), float(spills[2])) if spills else (0.0, 0.0)
    return found


def read(path):
    """Figures by (kernel, constants). Of several sizes of subgroups, the largest."""
    rows, variant, noted = {}, "", []
    for line in path.read_text(errors="replace").splitlines():
        parts = line.split("\t")
        if parts[0] == "pipeline":
            variant, noted = parts[2], []
        elif line.startswith("SHADER-DB:"):
            noted.append(mali_figures(line))
        elif parts[0] == "stage":
            figures = {name: float(value) for name, value in (part.split("=") for part in parts[3:])}
            figures["subgroup"] = float(parts[2])
            if noted:
                figures.update(noted.pop(0))
            rows[parts[1], variant] = figures
    return rows


def shown_rows(first, every):
    if every:
        return list(first)
    rows = []
    for kernel in dict.fromkeys(kernel for kernel, _ in first):
        variants = SHOWN.get(kernel)
        if not variants:
            same = [key for key in first if key[0] == kernel]
            variants = [max(same, key=lambda key: VENDORS["amd"][1](first[key]))[1]]
        rows += [(kernel, variant) for variant in variants]
    return rows


def print_table(devices, every):
    for vendor, (cell, _) in VENDORS.items():
        names = ", ".join(TITLES[device] for device in devices if VENDOR_OF[device] == vendor)
        if names:
            print(f"- {names}: {cell.__doc__}")
    print("\n| kernel: constants |" + "".join(f" {TITLES[device]} |" for device in devices))
    print("|---|" + "---|" * len(devices))
    for key in shown_rows(devices.get("navi31") or next(iter(devices.values())), every):
        cells = [VENDORS[VENDOR_OF[device]][0](rows[key]) if key in rows else "-" for device, rows in devices.items()]
        print(f"| {key[0]}{': ' if key[1] else ''}{key[1]} | " + " | ".join(cells) + " |")


def print_changes(devices, before):
    """Least and largest change of the estimated cycles; the kernels that are worse."""
    worse = 0
    for device, rows in devices.items():
        cycles = VENDORS[VENDOR_OF[device]][1]
        ratios = {key: cycles(rows[key]) / cycles(before[device][key]) for key in rows
                  if key in before.get(device, {}) and cycles(before[device][key]) > 0}
        if not ratios:
            continue
        print(f"- {TITLES[device]}: cycles {min(ratios.values()) - 1:+.1%} to {max(ratios.values()) - 1:+.1%}")
        for (kernel, variant), ratio in ratios.items():
            if ratio > WORSE:
                worse += 1
                print(f"    - {kernel}: {variant} {ratio - 1:+.1%}")
    return worse


def read_all(folder):
    found = {device: folder / f"{device}.txt" for device in TITLES}
    return {device: read(path) for device, path in found.items() if path.exists()}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("rows", nargs="?", choices=["all"])
    parser.add_argument("--against", type=pathlib.Path)
    options = parser.parse_args()
    devices = read_all(options.folder)
    if not any(devices.values()):
        sys.exit(f"{options.folder}: no results; bench/kernels/vendors.sh makes them")
    print_table(devices, options.rows == "all")
    if options.against:
        print()
        return print_changes(devices, read_all(options.against)) > 0
    return 0


if __name__ == "__main__":
    sys.exit(main())
