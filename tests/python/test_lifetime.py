# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""Memory, signals, threads."""

import gc
import os
import signal
import subprocess
import sys
import threading
import time
import weakref

import numpy as np
import pytest

import isotet
from conftest import same


def copies(grid):
    return np.array(grid.points), np.array(grid.cells), np.array(grid.fields["sphere"])


def resident_bytes() -> int:
    with open("/proc/self/statm") as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")


def test_arrays_are_let_go_of_after_a_call(sphere):
    arrays = copies(sphere)
    references = [weakref.ref(array) for array in arrays]
    surface = isotet.contour(*arrays, 0.5, fields={"v": arrays[2]})
    packed = isotet.pack(*arrays)
    del arrays
    assert [reference() for reference in references] == [None] * 3
    assert same(packed.contour(0.5), isotet.pack(*copies(sphere)).contour(0.5))
    assert len(surface.fields["v"]) == len(surface.points)


def test_arrays_live_as_long_as_what_needs_them(sphere):
    points, cells, values = copies(sphere)
    references = [weakref.ref(array) for array in (points, cells, values)]
    grid = isotet.Grid(points, cells, fields={"v": values})
    wanted = grid.contour(0.5)
    del points, cells, values
    gc.collect()
    assert same(grid.contour(0.5), wanted)
    session = isotet.Contour(grid, surfaces=1)
    del grid
    assert same(session.contour(0.5), wanted)
    del session
    assert [reference() for reference in references] == [None] * 3


def test_a_packed_session_needs_no_grid(sphere):
    points, cells, values = copies(sphere)
    references = [weakref.ref(points), weakref.ref(cells)]
    session = isotet.Contour(isotet.Grid(points, cells), values, method="clusters")
    session.prepare()
    del points, cells
    assert [reference() for reference in references] == [None] * 2
    assert len(session.contour(0.5).triangles) > 0


def test_arrays_live_on_without_their_surface(sphere):
    surface = sphere.contour(0.5, "sphere")
    reference = weakref.ref(surface)
    points, triangles, carried = surface.points, surface.triangles, surface.fields["gyroid"]
    sums = points.sum(), triangles.sum(), carried.sum()
    del surface
    assert reference() is None
    filler = [sphere.contour(0.5, "sphere") for _ in range(100)]
    assert (points.sum(), triangles.sum(), carried.sum()) == sums
    del filler
    view = sphere.points[10:20]
    wanted = view.copy()
    del sphere
    gc.collect()
    assert np.array_equal(view, wanted)


def test_everything_can_be_referred_to_weakly(sphere):
    packed = isotet.pack(sphere, values="sphere")
    for thing in (sphere, packed, packed.contour(0.5), isotet.Contour(sphere, "sphere")):
        assert weakref.ref(thing)() is thing


def test_ten_thousand_calls_leave_nothing_behind(sphere):
    points, cells, values = copies(sphere)
    packed = isotet.pack(points, cells, values)
    session = isotet.Contour(isotet.Grid(points, cells), values)

    def one():
        surface = isotet.contour(points, cells, values, 0.5, fields={"v": values}, threads=1)
        _ = surface.points, surface.triangles, surface.fields, surface.area
        packed.contour([0.4, 0.5], threads=1).points  # noqa: B018
        session.set(isotet.Grid(points, cells), values)
        session.contour(0.4, threads=1)
        with pytest.raises(ValueError):
            isotet.contour(points, cells, values[:3], 0.5)

    def calls(count):
        for _ in range(count):
            one()
        gc.collect()
        return len(gc.get_objects()), resident_bytes(), [sys.getrefcount(array) for array in (points, cells, values)]

    calls(200)
    objects, memory, references = calls(500)
    later = calls(2000)  # five calls each
    assert later[0] <= objects + 50
    assert later[1] <= memory + (8 << 20)
    assert later[2] == references


def test_progress_is_told_in_order():
    told = []
    grid = isotet.make("kuhn", 24, ["sphere"])
    isotet.pack(grid, progress=lambda step, fraction: told.append((step, fraction)))
    assert told
    assert {step for step, _ in told} == {"pack"}
    fractions = [fraction for _, fraction in told]
    assert fractions == sorted(fractions)
    assert 0 <= fractions[0] and fractions[-1] <= 1


@pytest.mark.parametrize("use", [lambda session: session.contour(0.4), lambda session: session.prepare(), lambda session: session.range,
                                 lambda session: session.nbytes, repr])  # fmt: skip
@pytest.mark.parametrize("in_main_thread", [True, False])
def test_a_progress_function_that_uses_its_session_is_an_error(use, in_main_thread):
    session = isotet.Contour(isotet.make("kuhn", 20, ["sphere"]), "sphere", surfaces=100)
    other = isotet.make("kuhn", 6, ["sphere"])
    failures = []

    def contour():
        try:
            session.contour(0.5, progress=lambda *_: (other.contour(0.5), use(session)))
        except RuntimeError as error:
            failures.append(str(error))

    thread = threading.Thread(target=contour)
    if in_main_thread:
        contour()
    else:
        thread.start()
        thread.join()
    assert failures == ["a progress function uses the session that it is called by, which is at work: use it after the call"]
    assert len(session.contour(0.5).triangles) > 0


def test_an_exception_of_the_progress_function_stops_the_call():
    grid = isotet.make("kuhn", 24, ["sphere"])
    told = []

    def stop(step, fraction):
        told.append(fraction)
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        isotet.pack(grid, progress=stop)
    assert len(told) == 1
    assert len(isotet.pack(grid)) == len(grid)


def stopped_by(number: int, progress_sleeps: float = 0.3) -> list[float]:
    """A signal in the middle of packing; the fractions done that were told."""
    grid = isotet.make("kuhn", 32, ["sphere"])
    told = []

    def interrupt(_, fraction):
        told.append(fraction)
        if len(told) == 1:
            os.kill(os.getpid(), number)
            time.sleep(progress_sleeps)  # lets the main thread see it

    isotet.pack(grid, progress=interrupt)
    return told


def test_ctrl_c_stops_a_call(sphere):
    before = threading.active_count()
    with pytest.raises(KeyboardInterrupt):
        stopped_by(signal.SIGINT)
    assert len(sphere.contour(0.5, "sphere").triangles) > 0
    assert threading.active_count() == before


def seconds_of(call) -> float:
    begin = time.perf_counter()
    call()
    return time.perf_counter() - begin


@pytest.mark.parametrize("what", ["read", "pack", "contour", "reduce", "3mf", "make"])
def test_ctrl_c_stops_a_call_soon(what, tmp_path):
    grid = isotet.make("kuhn", 64, ["gyroid"])
    if what == "read":
        grid.write(tmp_path / "grid.vtu")
    surface = grid.contour(0.1, "gyroid")
    call = {
        "read": lambda: isotet.read(tmp_path / "grid.vtu"),
        "pack": lambda: isotet.pack(grid, threads=1),
        "contour": lambda: grid.contour([i / 10 for i in range(-9, 10)], "gyroid", threads=1),
        "reduce": lambda: surface.reduce(0.9, threads=1),
        "3mf": lambda: surface.write(tmp_path / "surface.3mf"),
        "make": lambda: isotet.make("octree-tets", 48, []),
    }[what]
    whole = seconds_of(call)
    late = []
    for part in (0.15, 0.3, 0.45, 0.6):
        timer = threading.Timer(part * whole, os.kill, (os.getpid(), signal.SIGINT))
        begin = time.perf_counter()
        timer.start()
        try:
            call()
            timer.join()  # this time it was faster
        except KeyboardInterrupt:
            late.append(time.perf_counter() - begin - part * whole)
    assert late and sum(late) < len(late) * (0.1 + 0.2 * whole), (late, whole)


def test_handlers_of_other_signals_run_meanwhile():
    seen = []
    old = signal.signal(signal.SIGUSR1, lambda *_: seen.append(isotet.make("kuhn", 2, ["sphere"]).contour(0.5)))
    try:
        told = stopped_by(signal.SIGUSR1)
    finally:
        signal.signal(signal.SIGUSR1, old)
    assert len(seen) == 1 and len(seen[0].triangles) > 0, "a handler may call isotet, too"
    assert len(told) > 1, "and nothing is stopped"


def test_threads_at_once(sphere):
    packed = isotet.pack(sphere, values="sphere")
    session = isotet.Contour(sphere, "sphere", surfaces=1000, fields=[])
    wanted = packed.contour(0.5)
    failed = []

    def work():
        try:
            for _ in range(50):
                assert same(packed.contour(0.5), wanted)
                assert same(session.contour(0.5), wanted)
                session.set(isotet.Grid(np.array(sphere.points), sphere.cells), np.array(sphere.fields["sphere"]))
        except BaseException as error:  # noqa: BLE001
            failed.append(error)

    threads = [threading.Thread(target=work) for _ in range(4)]
    for thread in threads:
        thread.start()
    work()
    for thread in threads:
        thread.join()
    assert failed == []


def run_python(code: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-W", "ignore::DeprecationWarning", "-c", code]  # of fork, since 3.12
    return subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)


def test_the_end_of_the_interpreter_is_quiet():
    done = run_python(
        "import isotet, numpy\n"
        "g = isotet.make('kuhn', 8, ['sphere'])\n"
        "p = numpy.array(g.points); s = isotet.Contour(isotet.Grid(p, g.cells), g.fields['sphere'])\n"
        "keep = [g, p, s, s.contour(0.5), s.contour(0.5).points]; keep.append(keep)\n"
        "import sys; sys.keep = keep\n"
    )
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")


def test_a_forked_process_can_contour():
    done = run_python(
        "import os, isotet\n"
        "g = isotet.make('kuhn', 4, ['sphere']); n = len(g.contour(0.5, threads=1).triangles)\n"
        "child = os.fork()\n"
        "if child == 0: os._exit(0 if len(g.contour(0.5, threads=1).triangles) == n else 1)\n"
        "assert os.waitpid(child, 0)[1] == 0\n"
    )
    assert (done.returncode, done.stderr) == (0, "")


def test_importing_isotet_imports_numpy_and_nothing_heavy():
    done = run_python(
        "import sys, isotet\n"
        "print([name for name in ('vtkmodules', 'pyvista', 'trimesh', 'meshio', 'IPython', 'matplotlib') if name in sys.modules])"
    )
    assert done.stdout.strip() == "[]"
