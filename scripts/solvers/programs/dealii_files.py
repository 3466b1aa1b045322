# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
# debian: libdeal.ii-dev cmake g++
# files: *.vtu *.vtk *.inp *.msh
# isotet: --merge-points 1e-6
"""deal.II: functions of degree 1 to 3 on a cube and a ball with hanging nodes; its source takes a minute to compile."""
import pathlib
import subprocess

SOURCE = pathlib.Path(__file__).with_suffix(".cc")
BUILD = pathlib.Path("../program").resolve()  # stays for the next run
PROJECT = f"""cmake_minimum_required(VERSION 3.18)
find_package(deal.II 9.4 REQUIRED)
deal_ii_initialize_cached_variables()
project(dealii_files CXX)
add_executable(dealii_files {SOURCE})
deal_ii_setup_target(dealii_files RELEASE)
target_compile_options(dealii_files PRIVATE -O0 -w)
"""

BUILD.mkdir(exist_ok=True)
(BUILD / "CMakeLists.txt").write_text(PROJECT)
for command in (["cmake", "-S", BUILD, "-B", BUILD / "build", "-DCMAKE_BUILD_TYPE=Release"],
                ["cmake", "--build", BUILD / "build"], [BUILD / "build/dealii_files"]):
    subprocess.run(command, check=True)
