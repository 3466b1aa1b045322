#!/usr/bin/env bash
# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
# cluster.sh MPIRUN PVBATCH SCRIPT FOLDER: the example for clusters, on four ranks and on one.
set -euo pipefail
mpirun=$1 pvbatch=$2 script=$3
mkdir -p "$4"
cd "$4"
# In pieces: with Debian's libexpat since 2.5.0-1+deb12u2, ParaView 5.11 loses what it deals out of a single file.
"$mpirun" -np 4 --oversubscribe "$pvbatch" "$script" make grid.pvtu
"$mpirun" -np 4 --oversubscribe "$pvbatch" "$script" contour grid.pvtu RTData 150 surface.pvtp
"$pvbatch" "$script" contour grid.pvtu RTData 150 alone.pvtp
"$pvbatch" "$script" compare surface.pvtp alone.pvtp
echo ok
