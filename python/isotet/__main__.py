# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""`python -m isotet` runs the program isotet, which wheels do not hold: the one in PATH."""

import os
import shutil
import sys


def main() -> None:
    program = shutil.which("isotet")
    if program is None:
        sys.exit("isotet: the program is not in PATH: a wheel holds the library only, docs/install.md has the program")
    os.execv(program, [program, *sys.argv[1:]])


if __name__ == "__main__":
    main()
