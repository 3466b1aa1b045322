# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""From file to surfaces: isotet against VTK, page cache warm, in alternating rounds. Prints a table in Markdown.

Writing is not counted: VTK's side does not write. Of reading the bytes of the file a second are told, and their share of the
copy bandwidth where isotet_bench is there to measure it.

    python3 bench/race/file_to_surface.py --isotet build/demo/apps/cli/isotet --side 100 --vtk-python /usr/bin/python3
"""
import argparse
import json
import pathlib
import statistics
import subprocess
import tempfile

FIELD, ISOVALUE = "gyroid", 0.1
LOWEST, HIGHEST = -1.2, 1.2  # of several isovalues
KINDS = {"raw": "raw.vtu", "lz4": "lz4.vtu", "zlib": "zlib.vtu", "base64 zlib": "base64.vtu", "legacy": "legacy.vtk",
         "vtkhdf": "vtkhdf.hdf"}


def isovalues_of(options):
    count = options.surfaces
    values = [ISOVALUE] if count == 1 else [LOWEST + (HIGHEST - LOWEST) * i / (count - 1) for i in range(count)]
    return ",".join(f"{value:.6g}" for value in values)


def isotet_seconds(options, path, folder):
    """Seconds of reading, packing, extracting and writing, and all triangles."""
    numbers = folder / "numbers.json"
    out = ["-o", folder / "surface.vtp"] if options.surfaces == 1 else []
    subprocess.run([options.isotet, "extract", path, *out, "-f", FIELD, "--isovalue=" + isovalues_of(options), "--json", numbers, "-q",
                    "-j", str(options.threads)], check=True)
    found = json.loads(numbers.read_text())
    surfaces = found["surfaces"]
    total = lambda step: sum(surface["seconds"][step] for surface in surfaces)
    return (found["seconds"]["read"], found["seconds"]["pack"], total("extract"), total("write"),
            sum(surface["triangles"] for surface in surfaces))


def vtk_seconds(options, path, python):
    """Seconds of reading and contouring, and all triangles."""
    rival = pathlib.Path(__file__).with_name("vtk_file_rival.py")
    said = subprocess.run([python, "-B", rival, path, "--field", FIELD, "--isovalues=" + isovalues_of(options), "--threads",
                           str(options.threads)], check=True, capture_output=True, text=True).stdout.split()
    return float(said[0]), float(said[1]), int(said[2])


def copy_bandwidth(options):
    """Bytes a second, read and written; nothing without isotet_bench."""
    bench = options.bench or pathlib.Path(options.isotet).resolve().parents[2] / "bench/isotet_bench"
    if not bench.exists():
        return None
    said = subprocess.run([bench], input=f"copy\t{options.threads}\n", check=True, capture_output=True, text=True).stdout
    return json.loads(said)["bytes_per_second"]


def spread(times):
    return f"{statistics.median(times):.2f} ({min(times):.2f} to {max(times):.2f})"


def row(kind, path, ours, theirs, bandwidth):
    """Medians of steps; of the sums that are compared also the lowest and the highest."""
    read, pack, extract, write = (statistics.median(part) for part in list(zip(*ours))[:4])
    rival = min(theirs.values(), key=lambda found: statistics.median(sum(times[:2]) for times in found))
    rival_read, rival_contour = (statistics.median(part) for part in list(zip(*rival))[:2])
    own_sums, rival_sums = [sum(times[:3]) for times in ours], [sum(times[:2]) for times in rival]
    size = path.stat().st_size
    share = f", {100 * size / read / bandwidth:.0f} %" if bandwidth else ""
    faster = statistics.median(rival_sums) / statistics.median(own_sums)
    return (f"| {kind} | {size / 1e6:.0f} | {rival_read:.2f} | {rival_contour:.2f} | {spread(rival_sums)} | {read:.2f} "
            f"({size / read / 1e9:.1f} GB/s{share}) | {pack:.2f} | {extract:.2f} | {spread(own_sums)} | {write:.2f} | {faster:.1f} |")


def make_files(options, folder):
    made = folder / "made.vtu"
    subprocess.run([options.isotet, "make", "kuhn", "--side", str(options.side), "--fields", FIELD, "-o", made, "-q"], check=True)
    rival = pathlib.Path(__file__).with_name("vtk_file_rival.py")
    command = [options.vtk_python[0], "-B", rival, made]
    for kind in options.only or KINDS:
        command += ["--convert", kind, folder / KINDS[kind]]
    subprocess.run(command, check=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--isotet", required=True)
    parser.add_argument("--vtk-python", nargs="+", default=["/usr/bin/python3"], help="interpreters with VTK: the faster one counts")
    parser.add_argument("--side", type=int, default=100, help="cubes along an edge, six tets each")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--surfaces", type=int, default=1, help="isovalues, one surface each; several are not written")
    parser.add_argument("--only", action="append", choices=KINDS, help="this kind of file; may be repeated")
    parser.add_argument("--bench", type=pathlib.Path, help="isotet_bench (that of the build of --isotet)")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        make_files(options, folder)
        bandwidth = copy_bandwidth(options)
        print(f"{6 * options.side ** 3:,} tets, {options.surfaces} surface(s), {options.threads} threads, medians of {options.rounds} "
              f"rounds, seconds; copy bandwidth {f'{bandwidth / 1e9:.1f} GB/s' if bandwidth else 'not measured'}\n")
        print("| file | MB | VTK: read | contour | both | isotet: read | pack | extract | all three | write | times as fast |\n"
              "|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|")
        for kind in options.only or KINDS:
            path = folder / KINDS[kind]
            path.read_bytes()  # into the page cache
            ours, theirs = [], {python: [] for python in options.vtk_python}
            for _ in range(options.rounds):
                ours.append(isotet_seconds(options, path, folder))
                for python, found in theirs.items():
                    found.append(vtk_seconds(options, path, python))
            print(row(kind, path, ours, theirs, bandwidth), flush=True)


main()
