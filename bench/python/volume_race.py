#!/usr/bin/env python3
# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""Races isotet render --volume against VTK's projected tets, with the same camera, in rounds that alternate: medians of processor
and wall seconds of pictures of 800 x 600. Of isotet, one thread, without reading and packing; of VTK on software OpenGL, which
uses all threads, without the first picture.

Usage: volume_race.py [--program isotet] [--rounds N] [--cases projected,ramp,threads,dirac,shading] [--shrink N]

Needs numpy and vtk with software OpenGL. A grid of side 30 has 162,000 tets, 60 has 1,296,000, 94 has 4,983,504; --shrink divides
the sides, to try it.
"""

import argparse
import json
import os
import pathlib
import resource
import statistics
import subprocess
import tempfile
import time

import vtk

WIDTH, HEIGHT, LENGTH = 800, 600, 0.25
PEAKS = [(-0.78, 0), (-0.6, 0.9), (-0.42, 0), (0.48, 0), (0.66, 0.95), (0.84, 0)]
RAMP = [(-1.5, 0.02), (1.5, 0.3)]
ISOVALUE = 0.2
DIRECTION, UP, DISTANCE, ANGLE = (0.6, -0.48, 0.64), (-0.5, 0.4, 0.7684), 6.7, 30
CAMERA = "perspective:0,0,0:{}:{}:{}:{}".format(",".join(map(str, DIRECTION)), ",".join(map(str, UP)), DISTANCE, ANGLE)


class Isotet:
    """Pictures by the program. What reading and packing take is what a picture of 8 x 6 takes."""

    def __init__(self, program, folder, side, *words, threads=1):
        self.report = pathlib.Path(folder, "report.json")
        self.words = [program, "render", f"make:kuhn:{side}:gyroid", "-f", "gyroid", *words, "--plain", "--camera", CAMERA,
                      "--occlusion", "0", "--boundary", "0", "--threads", str(threads), "-o", str(pathlib.Path(folder, "p.png")),
                      "--json", str(self.report), "--quiet"]
        self.packing = statistics.median(self.run("8x6")[0] for _ in range(3))

    def run(self, size):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        subprocess.run([*self.words, "--size", size], check=True)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        seconds = json.loads(self.report.read_text())["seconds"]
        return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, seconds["extract"] + seconds["draw"]

    def __call__(self):
        processor, wall = self.run(f"{WIDTH}x{HEIGHT}")
        return processor - self.packing, wall


def opacity_words(opacity):
    return ["--volume", "--opacity=" + ",".join(f"{value}:{part}" for value, part in opacity), "--opacity-length", str(LENGTH)]


class VtkVolume:
    """One of VTK's mappers in a window that shows nothing; a turn of a millionth of a degree makes it draw again."""

    def __init__(self, mapper, grid_file, opacity):
        vtk.vtkSMPTools.Initialize(1)
        reader = vtk.vtkXMLUnstructuredGridReader()
        reader.SetFileName(grid_file)
        reader.Update()
        data = reader.GetOutput()
        data.GetPointData().SetActiveScalars("gyroid")
        mapper.SetInputData(data)
        colors, curve, looks = vtk.vtkColorTransferFunction(), vtk.vtkPiecewiseFunction(), vtk.vtkVolumeProperty()
        colors.AddRGBPoint(-1.5, 0.1, 0.2, 0.8)
        colors.AddRGBPoint(1.5, 0.9, 0.8, 0.1)
        for value, part in opacity:
            curve.AddPoint(value, part)
        looks.SetColor(colors)
        looks.SetScalarOpacity(curve)
        looks.SetScalarOpacityUnitDistance(LENGTH)
        looks.ShadeOff()
        actor, self.renderer, self.window = vtk.vtkVolume(), vtk.vtkRenderer(), vtk.vtkRenderWindow()
        actor.SetMapper(mapper)
        actor.SetProperty(looks)
        self.renderer.AddVolume(actor)
        self.window.SetOffScreenRendering(1)
        self.window.SetMultiSamples(0)
        self.window.SetSize(WIDTH, HEIGHT)
        self.window.SetDesiredUpdateRate(1e-6)
        self.window.AddRenderer(self.renderer)
        camera = self.renderer.GetActiveCamera()
        camera.SetFocalPoint(0, 0, 0)
        camera.SetPosition(*(DISTANCE * part for part in DIRECTION))
        camera.SetViewUp(*UP)
        camera.SetViewAngle(ANGLE)
        self.renderer.ResetCameraClippingRange()

        self()

    def __call__(self):
        wall, processor = time.perf_counter(), time.process_time()
        self.renderer.GetActiveCamera().Azimuth(1e-6)
        self.window.Render()
        return time.process_time() - processor, time.perf_counter() - wall


def race(ways, rounds):
    seconds = {name: [] for name in ways}
    for _ in range(rounds):
        for name, way in ways.items():
            seconds[name].append(way())
    print("processor s, wall s (least to most processor s)")
    first = None
    for name, all_rounds in seconds.items():
        processor, wall = zip(*all_rounds)
        median = statistics.median(processor)
        first = first or median
        print(f"{median:9.3f} {statistics.median(wall):9.3f}  ({min(processor):.3f} to {max(processor):.3f})  "
              f"{median / first:7.2f} x  {name}")


def main():
    arguments = argparse.ArgumentParser()
    arguments.add_argument("--program", default="build/test/release/apps/cli/isotet")
    arguments.add_argument("--rounds", type=int, default=5)
    arguments.add_argument("--shrink", type=int, default=1)
    arguments.add_argument("--cases", default="projected,ramp,threads,dirac,shading")
    given = arguments.parse_args()
    print(f"VTK {vtk.vtkVersion().GetVTKVersion()}, load {os.getloadavg()[0]:.1f}")
    with tempfile.TemporaryDirectory() as folder:

        def isotet(side, *words, threads=1):
            return Isotet(given.program, folder, side // given.shrink, *words, threads=threads)

        def rival(side, opacity):
            file = os.path.join(folder, f"{side}.vtu")
            if not os.path.exists(file):
                subprocess.run([given.program, "make", "kuhn", "--side", str(side // given.shrink), "--fields", "gyroid", "-o", file,
                                "--quiet"], check=True)
            return VtkVolume(vtk.vtkProjectedTetrahedraMapper(), file, opacity)

        peaks, ramp = opacity_words(PEAKS), opacity_words(RAMP)
        cases = {
            "projected": lambda: {"isotet, 1,296,000 tets, two peaks": isotet(60, *peaks),
                                  "VTK's projected tets": rival(60, PEAKS)},
            "ramp": lambda: {"isotet, 1,296,000 tets that all contribute": isotet(60, *ramp),
                             "VTK's projected tets": rival(60, RAMP)},
            "threads": lambda: {"1 thread, 1,296,000 tets": isotet(60, *peaks),
                                "2 threads": isotet(60, *peaks, threads=2)},
            "dirac": lambda: {"rays, 4,983,504 tets, one isovalue": isotet(94, "--dirac", str(ISOVALUE)),
                              "extracted and drawn": isotet(94, "-i", str(ISOVALUE))},
            "shading": lambda: {"1,296,000 tets": isotet(60, *peaks),
                                "lit by the gradient": isotet(60, *peaks, "--volume-shading")},
        }
        for name in given.cases.split(","):
            print(f"\n{name}: ", end="", flush=True)
            race(cases[name](), given.rounds)


main()
