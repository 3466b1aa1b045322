#!/usr/bin/env bash
# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
# cluster.sh MPIRUN PVBATCH SCRIPT FOLDER: the example for clusters, on four ranks and on one.
set -euo pipefail
mpirun=$1 pvbatch=$2 script=$3
mkdir -p "$4"
cd "$4"
"$pvbatch" "$script" make grid.vtu
"$mpirun" -np 4 --oversubscribe "$pvbatch" "$script" contour grid.vtu RTData 150 surface.pvtp
"$pvbatch" "$script" contour grid.vtu RTData 150 alone.pvtp
"$pvbatch" "$script" compare surface.pvtp alone.pvtp
echo ok
