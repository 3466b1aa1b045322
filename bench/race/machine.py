# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""Where a race was run: without this no number is published."""

import os
import platform
import re
import subprocess
from pathlib import Path


def _text(path: str) -> str:
    try:
        return Path(path).read_text(errors="replace")
    except OSError:
        return ""


def _first(pattern: str, text: str) -> str:
    found = re.search(pattern, text, re.MULTILINE)
    return found.group(1).strip() if found else "unknown"


def _output(*command: str) -> str:
    try:
        return subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()
    except (OSError, subprocess.CalledProcessError):
        return ""


def load() -> float:
    """Processes that run or want to, over the last minute."""
    return os.getloadavg()[0]


def facts(root: Path, build: Path) -> dict:
    cpu = _text("/proc/cpuinfo")
    flags = set(_first(r"^flags\s*:(.*)$", cpu).split())
    cache = _text(str(build / "CMakeCache.txt"))
    compiler = _first(r"^CMAKE_CXX_COMPILER:\w+=(.*)$", cache)
    simd = [name for name, flag in (("AVX-512", "avx512f"), ("AVX2", "avx2"), ("NEON", "asimd")) if flag in flags]
    return {
        "processor": _first(r"^model name\s*:(.*)$", cpu),
        "processors": len(os.sched_getaffinity(0)),
        "simd": simd[0] if simd else "baseline",
        "virtual_machine": _output("systemd-detect-virt", "--vm") or ("yes" if "hypervisor" in flags else "no"),
        "memory_bytes": 1024 * int(_first(r"^MemTotal:\s*(\d+)", _text("/proc/meminfo")) or 0),
        "huge_pages": _first(r"\[(\w+)\]", _text("/sys/kernel/mm/transparent_hugepage/enabled")),
        "system": _first(r'^PRETTY_NAME="(.*)"$', _text("/etc/os-release")),
        "kernel": platform.release(),
        "compiler": _output(compiler, "--version").split("\n")[0],
        "build_type": _first(r"^CMAKE_BUILD_TYPE:\w+=(.*)$", cache),
        "commit": _output("git", "-C", str(root), "rev-parse", "--short=12", "HEAD") or "unknown",
        "changed_since_commit": bool(_output("git", "-C", str(root), "status", "--porcelain", "--",
                                             "src", "include", "bench", "cmake")),
    }
