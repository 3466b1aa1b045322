# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""One program whose files are tried: what it needs, and the files that it writes.

programs/NAME.py writes files into the current folder. Comments at its beginning say what it needs:

    # pip: PACKAGE==VERSION ...       into a virtual environment of its own
    # debian: PACKAGE ...             by apt-get; without pip the script runs in Debian's Python
    # files: GLOB ...                 what is compared; files that others name need not be
    # isotet: OPTION ...              for all of them
"""
import dataclasses
import pathlib
import re
import subprocess
import sys


class NotToBeHad(Exception):
    pass


@dataclasses.dataclass
class Program:
    script: pathlib.Path
    folder: pathlib.Path
    pip: list[str]
    debian: list[str]
    files: list[str]
    options: list[str]

    @classmethod
    def at(cls, script, build):
        said = dict(re.findall(r"^# (pip|debian|files|isotet): (.*)$", script.read_text(), re.M))
        words = [said.get(key, "").split() for key in ("pip", "debian", "files", "isotet")]
        return cls(script, build / script.stem, *words)

    @property
    def name(self):
        return self.script.stem

    def install(self):
        if self.debian:
            install_from_debian(self.debian, self.folder)
        if self.pip:
            install_from_index(self.pip, self.folder)

    def write_files(self):
        """The files, all anew."""
        written = self.folder / "files"
        subprocess.run(["rm", "-rf", str(written)], check=True)
        written.mkdir(parents=True)
        python = str(self.folder / "venv/bin/python") if self.pip else "/usr/bin/python3"
        logged([python, "-B", str(self.script)], self.folder / "run.log", written, 900)
        return sorted({path for pattern in self.files for path in written.glob(pattern)})


def logged(command, log, folder, seconds):
    """Runs the command; the end of its log is told where it fails."""
    with open(log, "w", encoding="utf-8") as out:
        try:
            status = subprocess.run(command, stdin=subprocess.DEVNULL, stdout=out, stderr=subprocess.STDOUT, cwd=folder,
                                    timeout=seconds, check=False).returncode
        except subprocess.TimeoutExpired:
            status = f"still running after {seconds} s"
        except OSError as error:
            status = error
    if status:
        end = log.read_text(encoding="utf-8", errors="replace").strip().splitlines()[-3:]
        raise NotToBeHad(f"{pathlib.Path(command[0]).name}: {status}: {' / '.join(end)} ({log})")


def install_from_debian(packages, folder):
    state = subprocess.run(["dpkg-query", "-W", "-f", "${db:Status-Status}\n", *packages], capture_output=True,
                           text=True, check=False)
    if state.stdout.split() == ["installed"] * len(packages):
        return
    folder.mkdir(parents=True, exist_ok=True)
    logged(["apt-get", "-y", "-q", "--no-install-recommends", "--no-upgrade", "install", *packages],
           folder / "debian.log", folder, 1800)


def install_from_index(packages, folder):
    """Again only where other packages are asked for."""
    asked = folder / "venv/asked.txt"
    if asked.is_file() and asked.read_text().split() == packages:
        return
    subprocess.run(["rm", "-rf", str(folder / "venv")], check=True)
    folder.mkdir(parents=True, exist_ok=True)
    python = "/usr/bin/python3" if sys.prefix != sys.base_prefix else sys.executable
    logged([python, "-m", "venv", "venv"], folder / "venv.log", folder, 300)
    logged([str(folder / "venv/bin/python"), "-m", "pip", "--disable-pip-version-check", "--no-input", "install",
            "--quiet", *packages], folder / "pip.log", folder, 1800)
    asked.write_text("\n".join(packages))
