# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""Three pictures of each file beside each other: isotet's, ParaView's, PyVista's. Run by beside.sh."""

import glob
import json
import os
import subprocess
import sys
from pathlib import Path

from PIL import Image, ImageDraw

ROOT = Path(__file__).resolve().parents[2]
HERE = Path(__file__).resolve().parent
SIZE = 800, 600
NONE = "-"  # pvbatch takes no empty arguments

FILES = [
    "data/vtu/artery_flow_tet_wedge.vtu",
    "data/vtu/wall_distance_point.vtu",
    "data/vtu/stokes_channel_tets.vtu",
    "data/vtu/patch_antenna_efield.vtu",
    "data/vtu/two_phase_box_tets_dup_points.vtu",
    "data/vtu/quadratic_tets_96.vtu",
    "data/vtu/dealii_refined_ball.vtu",
    "data/vtu/mfem_levels_hex.vtu",
    "data/vtk/lox_post_pressure.vtk",
    "data/exodus/tension_tets_stress_3steps.e",
    "data/exodus/mixed_blocks_hdf5.exo",
    "data/cgns/wall_distance_hdf5.cgns",
    "make:kuhn:--side:48:--fields:gyroid",
    "make:hex:--side:40:--fields:sphere",
    "make:octree-bent:--side:12:--fields:sphere",
]


def program(*arguments: str) -> str:
    done = subprocess.run([os.environ["ISOTET_PROGRAM"], *arguments], capture_output=True, text=True)
    if done.returncode != 0:
        raise RuntimeError(f"isotet {' '.join(arguments)}: {done.stderr.strip()}")
    return done.stdout


def file_for_vtk(name: str, folder: Path) -> Path:
    """The file itself; of a made grid, the file that `isotet make` writes."""
    if not name.startswith("make:"):
        return Path(name).resolve()
    made = folder / (name[5:].replace("--", "").replace(":", "_") + ".vtu")
    if not made.exists():
        kind, *options = name[5:].split(":")
        program("make", kind, "-o", str(made), *options)
    return made


def rival(command: list[str], environment: dict[str, str], picture: Path) -> str | None:
    """Draws `picture`, or tells why there is none. The environment is of the program, not of the X server beside it."""
    settings = [f"{name}={value}" for name, value in environment.items()]
    for _ in range(3):  # pvbatch now and then ends by a signal before it draws
        done = subprocess.run(["xvfb-run", "-a", "env", *settings, *command], capture_output=True, text=True, timeout=600)
        if picture.exists():
            return None
    lines = (done.stderr or done.stdout or f"ended with {done.returncode}").strip().splitlines()
    return lines[-1] if lines else f"ended with {done.returncode}"


def drawn(picture: Path, reason: str | None) -> Image.Image:
    if reason is None:
        return Image.open(picture).convert("RGB").resize(SIZE)
    empty = Image.new("RGB", SIZE, "white")
    ImageDraw.Draw(empty).text((20, SIZE[1] // 2), f"no picture: {reason[:110]}", fill="black")
    return empty


def beside(name: str, folder: Path) -> Path:
    file = file_for_vtk(name, folder)
    label = file.stem
    pictures = {who: folder / f"{label}.{who}.png" for who in ("isotet", "paraview", "pyvista")}
    for picture in pictures.values():
        picture.unlink(missing_ok=True)

    size = f"{SIZE[0]}x{SIZE[1]}"
    report = folder / f"{label}.json"
    program("render", str(file), "-o", str(pictures["isotet"]), "--size", size, "--json", str(report), "--quiet")
    said = json.loads(report.read_text())
    field = said["field"] or NONE
    time = NONE if said["time"] is None else str(said["time"])

    paraview = os.environ["PARAVIEW"]
    libraries = glob.glob(f"{paraview}/lib/*-linux-gnu")[0]
    reasons = {
        "isotet": None,
        "paraview": rival(
            [f"{paraview}/bin/pvbatch", str(HERE / "with_paraview.py"), str(file), field, time,
             str(pictures["paraview"])],
            {"LD_LIBRARY_PATH": libraries, "PYTHONPATH": f"{paraview}/lib/python3/dist-packages"},
            pictures["paraview"]),
        "pyvista": rival(
            [sys.executable, "-B", str(HERE / "with_pyvista.py"), str(file), field, time,
             str(pictures["pyvista"])],
            {}, pictures["pyvista"]),
    }
    row = Image.new("RGB", (3 * SIZE[0], SIZE[1] + 30), "white")
    for column, who in enumerate(pictures):
        row.paste(drawn(pictures[who], reasons[who]), (column * SIZE[0], 30))
        ImageDraw.Draw(row).text((column * SIZE[0] + 10, 8), f"{who}: {file.name}, {field}", fill="black")
    path = folder / f"{label}.png"
    row.save(path)
    told = "; ".join(f"{who}: {reason}" for who, reason in reasons.items() if reason)
    print(f"{name}: {'no field' if field == NONE else field}{'. ' + told if told else ''}", flush=True)
    return path


def main() -> None:
    folder = Path(sys.argv[1])
    names = sys.argv[2:]
    if not names:
        os.chdir(ROOT)
        names = FILES
    rows = [Image.open(beside(name, folder)) for name in names]
    width, height = rows[0].size
    sheet = Image.new("RGB", (width // 2, height // 2 * len(rows)), "white")
    for index, row in enumerate(rows):
        sheet.paste(row.resize((width // 2, height // 2)), (0, index * (height // 2)))
    sheet.save(folder / "all.png")
    print(f"{len(rows)} files: {folder}, all on all.png")


main()
