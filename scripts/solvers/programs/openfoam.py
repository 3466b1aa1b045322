# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
# debian: openfoam
# files: */*.foam */VTK/*.series */VTK/*_2.vtm */VTK/*.vtk */EnSight/*.case
"""OpenFOAM: heat in a refined box (polyhedra) and around a ball (snappyHexMesh), text, binary, packed, decomposed, in
regions; foamToVTK and -Ensight."""
import os
import pathlib
import shutil
import subprocess

HEADER = "FoamFile {{ version 2.0; format ascii; class {}; object {}; }}\n"
SYSTEM = {
    "blockMeshDict": "scale 1; vertices ((0 0 0) (1 0 0) (1 1 0) (0 1 0) (0 0 1) (1 0 1) (1 1 1) (0 1 1)); edges (); "
                     "blocks (hex (0 1 2 3 4 5 6 7) (5 5 5) simpleGrading (1 2 1)); mergePatchPairs (); boundary ("
                     "hot { type patch; faces ((0 4 7 3)); } cold { type patch; faces ((1 2 6 5)); } "
                     "sides { type wall; faces ((0 1 5 4) (3 7 6 2) (0 3 2 1) (4 5 6 7)); });",
    "topoSetDict": "actions ({ name c0; type cellSet; action new; source sphereToCell; "
                   "centre (0.5 0.5 0.5); radius 0.3; } "
                   "{ name left; type cellSet; action new; source boxToCell; box (0 0 0) (0.5 1 1); } "
                   "{ name left; type cellZoneSet; action new; source setToCellZone; set left; } "
                   "{ name right; type cellSet; action new; source boxToCell; box (0.5 0 0) (1 1 1); } "
                   "{ name right; type cellZoneSet; action new; source setToCellZone; set right; });",
    "decomposeParDict": "numberOfSubdomains 3; method simple; simpleCoeffs { n (3 1 1); delta 0.001; }",
    "fvSchemes": "ddtSchemes { default Euler; } gradSchemes { default Gauss linear; } divSchemes { default none; } "
                 "laplacianSchemes { default Gauss linear limited 0.33; } interpolationSchemes { default linear; } "
                 "snGradSchemes { default limited 0.33; }",
    "fvSolution": "solvers { T { solver PCG; preconditioner DIC; tolerance 1e-8; relTol 0; } } "
                  "SIMPLE { nNonOrthogonalCorrectors 1; }"}
CONTROL = "application laplacianFoam; startFrom startTime; startTime 0; stopAt endTime; endTime 0.2; deltaT 0.05; " \
          "writeControl timeStep; writeInterval 2; writeFormat {}; writePrecision 10; writeCompression {}; " \
          "timeFormat general; timePrecision 6; runTimeModifiable no;"
FIELD = "dimensions [0 0 0 1 0 0 0]; internalField uniform 0; " \
        "boundaryField { hot { type fixedValue; value uniform 1; } cold { type fixedValue; value uniform 0; } " \
        "sides { type zeroGradient; } \".*\" { type zeroGradient; } }"
SNAPPED = """castellatedMesh true; snap true; addLayers true;
geometry { ball { type searchableSphere; centre (0.55 0.52 0.5); radius 0.28; } }
castellatedMeshControls { maxLocalCells 100000; maxGlobalCells 200000; minRefinementCells 0; nCellsBetweenLevels 1;
    features (); refinementSurfaces { ball { level (1 2); } } resolveFeatureAngle 30; refinementRegions {}
    locationInMesh (0.03 0.04 0.03); allowFreeStandingZoneFaces true; }
snapControls { nSmoothPatch 3; tolerance 2; nSolveIter 30; nRelaxIter 5; }
addLayersControls { relativeSizes true; layers { ball { nSurfaceLayers 2; } } expansionRatio 1.2;
    finalLayerThickness 0.4; minThickness 0.1; nGrow 0; featureAngle 60; nRelaxIter 3; nSmoothSurfaceNormals 1;
    nSmoothNormals 3; nSmoothThickness 10; maxFaceThicknessRatio 0.5; maxThicknessToMedialRatio 0.3;
    minMedianAxisAngle 90; nBufferCellsNoExtrude 0; nLayerIter 50; }
meshQualityControls { maxNonOrtho 65; maxBoundarySkewness 20; maxInternalSkewness 4; maxConcave 80; minVol 1e-13;
    minTetQuality 1e-15; minArea -1; minTwist 0.02; minDeterminant 0.001; minFaceWeight 0.05; minVolRatio 0.01;
    minTriangleTwist -1; nSmoothScale 4; errorReduction 0.75; }
mergeTolerance 1e-6;"""
ENVIRONMENT = {**os.environ, "WM_PROJECT_DIR": "/usr/share/openfoam", "OMPI_ALLOW_RUN_AS_ROOT": "1",
               "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}


def run(case, *command):
    print(case, *command, flush=True)
    done = subprocess.run(command, cwd=case, env=ENVIRONMENT, capture_output=True, text=True, check=False)
    if done.returncode:
        print(done.stdout[-800:], done.stderr[-800:], flush=True)
    return done.returncode == 0


def write(case, file, text, kind="dictionary"):
    path = pathlib.Path(case, file)
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(HEADER.format(kind, path.name) + text + "\n")


def set_up(case, form="ascii", packed="off", refined=True, snapped=False):
    for name, text in SYSTEM.items():
        write(case, f"system/{name}", text)
    write(case, "system/controlDict", CONTROL.format(form, packed))
    write(case, "constant/transportProperties", "DT 0.1;")
    write(case, "0/T", FIELD, "volScalarField")
    pathlib.Path(case, "ball.foam" if snapped else "box.foam" if refined else "halves.foam").write_text("")
    run(case, "blockMesh")
    run(case, "topoSet")
    if refined:
        run(case, "refineHexMesh", "-overwrite", "c0")
    if snapped:
        write(case, "system/snappyHexMeshDict", SNAPPED)
        run(case, "snappyHexMesh", "-overwrite")


set_up("text")
run("text", "laplacianFoam")
for name, form, packed in (("packed", "ascii", "on"), ("binary", "binary", "off"), ("packed_binary", "binary", "on")):
    set_up(name, form, packed)
    run(name, "laplacianFoam")
set_up("snapped", snapped=True, refined=False)
run("snapped", "laplacianFoam")
set_up("parallel")
run("parallel", "decomposePar")
run("parallel", "mpirun", "--oversubscribe", "-n", "3", "laplacianFoam", "-parallel")
shutil.copytree("text", "legacy")
run("text", "foamToVTK")
run("text", "foamToEnsight")
run("legacy", "foamToVTK", "-legacy", "-no-boundary")
shutil.copytree("binary", "ascii_vtk", ignore=shutil.ignore_patterns("VTK", "EnSight"))
run("ascii_vtk", "foamToVTK", "-ascii", "-no-boundary", "-poly-decomp")
set_up("regions", refined=False)
run("regions", "splitMeshRegions", "-cellZones", "-overwrite")
for region in ("left", "right"):
    write("regions", f"0/{region}/T", FIELD, "volScalarField")
