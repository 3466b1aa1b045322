# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""Writes the samples of formats that data/ lacks: a box of 3 x 3 x 3 cells with a field on points and one on cells.

    python3 tests/corruption/make_samples.py tests/corruption/samples

Needs VTK's Python package, which writes VTK's own formats: 9.4 or later for VTKHDF; and h5py. Polyhedra in
other formats are written by make_polyhedral_samples.cpp; blocks.vtm, times.vtm.series and xdmf/*.xdmf are text that names these files.
"""
import os
import struct
import sys

import h5py
import numpy
import vtk

SIDE = 3


def image():
    grid = vtk.vtkImageData()
    grid.SetDimensions(SIDE + 1, SIDE + 1, SIDE + 1)
    add_fields(grid)
    return grid


def add_fields(grid):
    for count, data, name in [(grid.GetNumberOfPoints(), grid.GetPointData(), 'p'),
                              (grid.GetNumberOfCells(), grid.GetCellData(), 'c')]:
        values = vtk.vtkDoubleArray() if name == 'p' else vtk.vtkFloatArray()
        values.SetName(name)
        for i in range(count):
            values.InsertNextValue((i * 7 % 11) / 10)
        data.AddArray(values)


def rectilinear():
    grid = vtk.vtkRectilinearGrid()
    grid.SetDimensions(SIDE + 1, SIDE + 1, SIDE + 1)
    for axis in 'XYZ':
        ticks = vtk.vtkFloatArray()
        for i in range(SIDE + 1):
            ticks.InsertNextValue(i * i)
        getattr(grid, f'Set{axis}Coordinates')(ticks)
    add_fields(grid)
    return grid


def structured():
    grid = vtk.vtkStructuredGrid()
    grid.SetDimensions(SIDE + 1, SIDE + 1, SIDE + 1)
    points = vtk.vtkPoints()
    for k in range(SIDE + 1):
        for j in range(SIDE + 1):
            for i in range(SIDE + 1):
                points.InsertNextPoint(i + 0.1 * j, j, k)
    grid.SetPoints(points)
    add_fields(grid)
    return grid


def unstructured(tets):
    if tets:
        triangulate = vtk.vtkDataSetTriangleFilter()
        triangulate.SetInputData(image())
        triangulate.Update()
        return triangulate.GetOutput()
    append = vtk.vtkAppendFilter()
    append.AddInputData(image())
    append.Update()
    return append.GetOutput()


def write_xml(writer, grid, path, mode, compressor=None, encode=True):
    writer.SetInputData(grid)
    writer.SetFileName(path)
    getattr(writer, f'SetDataModeTo{mode}')()
    if compressor:
        getattr(writer, f'SetCompressorTypeTo{compressor}')()
    else:
        writer.SetCompressorTypeToNone()
    if mode == 'Appended':
        writer.SetEncodeAppendedData(encode)
    if writer.Write() != 1:
        raise RuntimeError(path)


def write_ensight(folder):
    """Gold, C binary: one part of hexahedra."""
    points, cells = box()
    text = lambda words: words.encode().ljust(80)
    ints = lambda *numbers: struct.pack(f'<{len(numbers)}i', *numbers)
    floats = lambda numbers: struct.pack(f'<{len(numbers)}f', *numbers)
    values = lambda count: floats([(i * 7 % 11) / 10 for i in range(count)])
    part = text('part') + ints(1)
    files = {
        'box.geo': text('C Binary') + text('a box') + text('') + text('node id assign') + text('element id assign') + part +
                   text('box') + text('coordinates') + ints(len(points)) +
                   b''.join(floats([point[axis] for point in points]) for axis in range(3)) +
                   text('hexa8') + ints(len(cells)) + b''.join(ints(*cell) for cell in cells),
        'box.p': text('p') + part + text('coordinates') + values(len(points)),
        'box.c': text('c') + part + text('hexa8') + values(len(cells)),
        'box.case': case_file('ensight gold', 'box'),
    }
    write_files(folder, files)


def box():
    """Points, and corners of the hexahedra from 1 on."""
    n = SIDE + 1
    points = [(i, j, k) for k in range(n) for j in range(n) for i in range(n)]
    number = lambda i, j, k: 1 + i + n * (j + n * k)
    corners = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
    return points, [[number(i + a, j + b, k + c) for a, b, c in corners]
                    for k in range(SIDE) for j in range(SIDE) for i in range(SIDE)]


def write_files(folder, files):
    for name, content in files.items():
        with open(os.path.join(folder, name), 'wb') as file:
            file.write(content)


def case_file(kind, stem, sets='', sections=''):
    return (f'FORMAT\ntype: {kind}\n\nGEOMETRY\nmodel: {sets}{stem}.geo\n\nVARIABLE\nscalar per node: {sets}p {stem}.p\n'
            f'scalar per element: {sets}c {stem}.c\n{sections}').encode()


def write_ensight_6(folder):
    """As text, and as C binary with the other byte order and numbers of nodes and elements."""
    points, cells = box()
    values = lambda count: [(i * 7 % 11) / 10 for i in range(count)]
    row = lambda numbers: ''.join(f'{number:8}' for number in numbers) + '\n'
    columns = lambda numbers: ''.join(''.join(f'{number:12.5e}' for number in numbers[i:i + 6]) + '\n'
                                      for i in range(0, len(numbers), 6))
    text = {
        'six_text.geo': 'a box\nas text\nnode id assign\nelement id off\ncoordinates\n' + row([len(points)]) +
                        ''.join(columns(point) for point in points) + 'part 1\nbox\nhexa8\n' + row([len(cells)]) +
                        ''.join(row(cell) for cell in cells),
        'six_text.p': 'p\n' + columns(values(len(points))),
        'six_text.c': 'c\npart 1\nhexa8\n' + columns(values(len(cells))),
    }
    write_files(folder, {name: content.encode() for name, content in text.items()})
    line = lambda words: words.encode().ljust(80, b'\0')
    ints = lambda numbers: struct.pack(f'>{len(numbers)}i', *numbers)
    floats = lambda numbers: struct.pack(f'>{len(numbers)}f', *numbers)
    first = 1000
    write_files(folder, {
        'six.geo': b''.join(map(line, ['C Binary', 'a box', '', 'node id given', 'element id given', 'coordinates'])) +
                   ints([len(points)]) + ints(range(first + 1, first + 1 + len(points))) +
                   floats([x for point in points for x in point]) + line('part 1') + line('box') + line('hexa8') +
                   ints([len(cells)]) + ints(range(1, 1 + len(cells))) +
                   b''.join(ints([first + corner for corner in cell]) for cell in cells),
        'six.p': line('p') + floats(values(len(points))),
        'six.c': line('c') + line('part 1') + line('hexa8') + floats(values(len(cells))),
        'six.case': case_file('ensight', 'six'),
        'six_text.case': case_file('ensight', 'six_text'),
    })


def write_ensight_steps(folder):
    """Gold, C binary: three time steps in each file, the last one with undefined values."""
    points, cells = box()
    line = lambda words: words.encode().ljust(80)
    ints = lambda *numbers: struct.pack(f'<{len(numbers)}i', *numbers)
    floats = lambda numbers: struct.pack(f'<{len(numbers)}f', *numbers)
    values = lambda count, step: [(i * 7 % 11) / 10 + step for i in range(count)]
    steps = lambda content: b''.join(line('BEGIN TIME STEP') + content(step) + line('END TIME STEP') for step in range(3))
    part = line('part') + ints(1)
    geometry = lambda step: (line('a box') + line('') + line('node id off') + line('element id off') + part + line('box') +
                             line('coordinates') + ints(len(points)) +
                             b''.join(floats([point[axis] + step for point in points]) for axis in range(3)) +
                             line('hexa8') + ints(len(cells)) + b''.join(ints(*cell) for cell in cells))
    kind = lambda step, name: line(name + ' undef') + floats([2.5]) if step == 2 else line(name)
    write_files(folder, {
        'steps.geo': line('C Binary') + steps(geometry),
        'steps.p': steps(lambda step: line('p') + part + kind(step, 'coordinates') + floats(values(len(points), step))),
        'steps.c': steps(lambda step: line('c') + part + kind(step, 'hexa8') + floats(values(len(cells), step))),
        'steps.case': case_file('ensight gold', 'steps', '1 1 ',
                                '\nTIME\ntime set: 1\nnumber of steps: 3\ntime values: 0 1 2\n\nFILE\nfile set: 1\n'
                                'number of steps: 3\n'),
    })


HEX_FACES = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]  # corners by bits


def polyhedra():
    """Points and, for each cell, its faces: the box of cubes, one of which is cut off at a corner."""
    n = SIDE + 1
    points = [(i, j, k) for k in range(n) for j in range(n) for i in range(n)]
    cells = []
    for k in range(SIDE):
        for j in range(SIDE):
            for i in range(SIDE):
                corner = [i + a + n * (j + b + n * (k + c)) for c in (0, 1) for b in (0, 1) for a in (0, 1)]
                cells.append([[corner[at] for at in face] for face in HEX_FACES])
    first = len(points)
    points += [(0.5, 0, 0), (0, 0.5, 0), (0, 0, 0.5)]
    cut = {1: first, n: first + 1, n * n: first + 2}
    faces = []
    for face in cells[0]:
        if 0 not in face:
            faces.append(face)
            continue
        at = face.index(0)
        faces.append([cut[face[at - 1]], cut[face[(at + 1) % 4]], *face[at + 1:], *face[:at]])
    cells[0] = faces + [[first, first + 1, first + 2]]
    return points, cells


def vtk_polyhedra(first, end):
    points, cells = polyhedra()
    grid = vtk.vtkUnstructuredGrid()
    places = vtk.vtkPoints()
    for point in points:
        places.InsertNextPoint(point)
    grid.SetPoints(places)
    for cell in cells[first:end]:
        stream = vtk.vtkIdList()
        for number in [len(cell)] + [number for face in cell for number in [len(face), *face]]:
            stream.InsertNextId(number)
        grid.InsertNextCell(vtk.VTK_POLYHEDRON, stream)
    add_fields(grid)
    return grid


def write_vtkhdf_polyhedra(path):
    parts = vtk.vtkPartitionedDataSet()
    half = SIDE ** 3 // 2
    for i, (first, end) in enumerate([(0, half), (half, SIDE ** 3)]):
        parts.SetPartition(i, vtk_polyhedra(first, end))
    writer = vtk.vtkHDFWriter()
    writer.SetInputData(parts)
    writer.SetFileName(path)
    writer.SetChunkSize(64)
    writer.SetCompressionLevel(0)
    if writer.Write() != 1:
        raise RuntimeError(path)


def foam(folder, path, kind, location, body):
    path = os.path.join(folder, path)
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, 'w', encoding='ascii') as file:
        file.write(f'FoamFile\n{{\n    version 2.0;\n    format ascii;\n    class {kind};\n    location "{location}";\n'
                   f'    object {os.path.basename(path)};\n}}\n{body}\n')


def foam_list(items):
    return f'{len(items)}\n(\n' + '\n'.join(items) + '\n)'


def write_openfoam(folder):
    n = SIDE
    point = lambda i, j, k: i + (n + 1) * (j + (n + 1) * k)
    cell = lambda i, j, k: i + n * (j + n * k)
    inner, outer = [], []
    for k in range(n):
        for j in range(n):
            for i in range(n):
                for axis in range(3):
                    ends = [(i, j, k), (i + (axis == 0), j + (axis == 1), k + (axis == 2))]
                    u, v = [tuple(int(b == a) for b in range(3)) for a in ((axis + 1) % 3, (axis + 2) % 3)]
                    for side, at in enumerate(ends):
                        if side == 0 and at[axis] > 0:
                            continue  # the lower cell has it
                        steps = [(0, 0), (1, 0), (1, 1), (0, 1)]
                        corners = [point(*[at[d] + a * u[d] + b * v[d] for d in range(3)]) for a, b in steps]
                        face = '4(' + ' '.join(map(str, corners if side else corners[::-1])) + ')'
                        other = (i + (axis == 0), j + (axis == 1), k + (axis == 2))
                        if side and other[axis] < n:
                            inner.append((cell(i, j, k), cell(*other), face))
                        else:
                            outer.append((cell(i, j, k), face))
    inner.sort()
    mesh = 'constant/polyMesh'
    places = [f'({i} {j} {k})' for k in range(n + 1) for j in range(n + 1) for i in range(n + 1)]
    foam(folder, f'{mesh}/points', 'vectorField', mesh, foam_list(places))
    foam(folder, f'{mesh}/faces', 'faceList', mesh, foam_list([f for _, _, f in inner] + [f for _, f in outer]))
    foam(folder, f'{mesh}/owner', 'labelList', mesh, foam_list([str(o) for o, _, _ in inner] + [str(o) for o, _ in outer]))
    foam(folder, f'{mesh}/neighbour', 'labelList', mesh, foam_list([str(o) for _, o, _ in inner]))
    foam(folder, f'{mesh}/boundary', 'polyBoundaryMesh', mesh,
         f'1\n(\n    walls\n    {{\n        type wall;\n        nFaces {len(outer)};\n        startFace {len(inner)};\n    }}\n)')
    values = [str((i * 7 % 11) / 10) for i in range(n ** 3)]
    foam(folder, '0/p', 'volScalarField', '0',
         'dimensions [0 2 -2 0 0 0 0];\ninternalField nonuniform List<scalar> ' + foam_list(values) +
         ';\nboundaryField\n{\n    walls\n    {\n        type fixedValue;\n        value uniform 0.5;\n    }\n}')
    foam(folder, 'system/controlDict', 'dictionary', 'system', 'startTime 0;\nendTime 0;')
    open(os.path.join(folder, 'case.foam'), 'w', encoding='ascii').close()


def write_corner_points(folder):
    """Layers with a fault: corners as 2 n x 2 n x 2 n depths."""
    n = SIDE
    numbers = lambda items: ' '.join(f'{item:g}' for item in items) + ' /\n'
    pillars = [number for j in range(n + 1) for i in range(n + 1) for number in (i, j, 10, i + 0.5, j, 20)]
    depths = [11 + (k + 1) // 2 + (0.25 if i // 2 == n - 1 else 0)
              for k in range(2 * n) for j in range(2 * n) for i in range(2 * n)]
    values = [(i * 7 % 11) / 10 for i in range(n ** 3)]
    files = {
        'faulted.grdecl': f'-- made\nSPECGRID\n {n} {n} {n} 1 F /\nCOORD\n' + numbers(pillars) + 'INCLUDE\n zcorn.inc /\n' +
                          f'ACTNUM\n {n ** 3 - 1}*1 0 /\nPORO\n' + numbers(values) + f'SATNUM\n {n ** 3}*2 /\n',
        'zcorn.inc': 'ZCORN\n' + numbers(depths),
    }
    for name, content in files.items():
        with open(os.path.join(folder, name), 'w', encoding='ascii') as file:
            file.write(content)


def write_xdmf_series(path):
    """What xdmf/series.xdmf names: two tets, a field with three steps, a function of degree 1."""
    with h5py.File(path, 'w', libver=('earliest', 'v108')) as file:
        file['Mesh/mesh/topology'] = numpy.array([[0, 1, 2, 3], [0, 2, 1, 4]])
        file['Mesh/mesh/geometry'] = numpy.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [0, 0, -1]], float)
        file.create_dataset('u', data=numpy.arange(15.0).reshape(3, 5), chunks=(1, 5), compression='gzip')
        file['f/cell_dofs'] = numpy.arange(8).reshape(8, 1)
        file['f/vector'] = numpy.array([1, 2, 3, 4, 1.5, 3, 2, 5]).reshape(8, 1)
        file['f/x_cell_dofs'] = numpy.array([[0], [4], [8]])
        file['f/cells'] = numpy.array([[0], [1]])


def write_legacy_polyhedra(path, version, binary):
    writer = vtk.vtkUnstructuredGridWriter()
    writer.SetInputData(vtk_polyhedra(0, SIDE ** 3))
    writer.SetFileName(path)
    writer.SetFileVersion(version)
    writer.SetFileType(vtk.VTK_BINARY if binary else vtk.VTK_ASCII)
    if writer.Write() != 1:
        raise RuntimeError(path)


def write_gmsh(path, binary):
    """4.1 binary or 4.0 ascii, in two partitions, with values at nodes, in elements and at nodes of elements."""
    points, cells = box()
    out = []
    put = lambda code, *values: out.append(struct.pack(f'<{len(values)}{code}', *values) if binary else
                                           ''.join(f'{value} ' for value in values).encode())
    text = lambda words: out.append(words.encode())
    ints = lambda *values: put('i', *values)
    counts = lambda *values: put('q', *values)
    tags = counts if binary else ints
    reals = lambda *values: put('d', *values)
    line = lambda: None if binary else text('\n')
    block = lambda dimension, entity: ints(dimension, entity) if binary else ints(entity, dimension)
    text(f'$MeshFormat\n{"4.1 1" if binary else "4 0"} 8\n')
    if binary:
        ints(1)
    text('\n$EndMeshFormat\n$PhysicalNames\n1\n3 8 "box"\n$EndPhysicalNames\n$Entities\n')
    counts(0, 0, 0, 1)
    ints(1)
    reals(0, 0, 0, SIDE, SIDE, SIDE)
    counts(1)
    ints(8)
    counts(0)
    text('\n$EndEntities\n$PartitionedEntities\n')
    counts(2, 1)
    ints(9, 1)
    counts(0, 0, 0, 2)
    for volume in (5, 6):
        ints(volume, 3, 1)
        counts(1)
        ints(volume - 4)
        reals(0, 0, 0, SIDE, SIDE, SIDE)
        counts(1)
        ints(8)
        counts(0)
    text('\n$EndPartitionedEntities\n$Nodes\n')
    counts(1, len(points), *((1, len(points)) if binary else ()))
    block(3, 5)
    ints(0)
    counts(len(points))
    if binary:
        counts(*range(1, len(points) + 1))
    for number, point in enumerate(points):
        if not binary:
            ints(number + 1)
        reals(*point)
    text('\n$EndNodes\n$Elements\n')
    half = len(cells) // 2
    counts(2, len(cells), *((1, len(cells)) if binary else ()))
    line()
    for volume, first, end in ((5, 0, half), (6, half, len(cells))):
        block(3, volume)
        ints(5)
        counts(end - first)
        line()
        for number in range(first, end):
            tags(number + 1, *cells[number])
            line()
    text('\n$EndElements\n')
    for kind, count in (('NodeData', len(points)), ('ElementData', len(cells)), ('ElementNodeData', len(cells))):
        text(f'${kind}\n1\n"{kind}"\n1\n0\n3\n0\n1\n{count}\n')
        for number in range(1, count + 1):
            ints(number, *((8,) if kind == 'ElementNodeData' else ()))
            reals(*[(number * 7 % 11 + i) / 10 for i in range(8 if kind == 'ElementNodeData' else 1)])
        text(f'\n$End{kind}\n')
    with open(path, 'wb') as file:
        file.write(b''.join(out))


def write_medit(folder):
    points, cells = box()
    line = lambda items: ' '.join(f'{item:g}' for item in items) + '\n'
    write_files(folder, {
        'cells.mesh': ('MeshVersionFormatted 2\nDimension 3\n' + f'Vertices\n{len(points)}\n' +
                       ''.join(line([*point, 0]) for point in points) + f'Hexahedra\n{len(cells)}\n' +
                       ''.join(line([*cell, 1]) for cell in cells) + 'End\n').encode(),
        'cells.sol': ('MeshVersionFormatted 2\nDimension 3\n' + f'SolAtVertices\n{len(points)}\n1 1\n' +
                      ''.join(line([i * 7 % 11]) for i in range(len(points))) + f'SolAtHexahedra\n{len(cells)}\n2 1 2\n' +
                      ''.join(line([i * 7 % 11, i, 0, 1]) for i in range(len(cells))) + 'End\n').encode(),
    })


def write_med(path):
    """As code_aster writes results: tets, hexahedra and polyhedra; two steps, a profile, integers, values at integration
    points and at the nodes of each cell; groups."""
    points, cells = box()
    cubes = [[cell[at] for at in (0, 3, 2, 1, 4, 7, 6, 5)] for cell in cells[:13]]
    six = [(0, 1, 2, 6), (0, 2, 3, 6), (0, 3, 7, 6), (0, 7, 4, 6), (0, 4, 5, 6), (0, 5, 1, 6)]
    tets = [[cell[at] for at in (a, c, b, d)] for cell in cells[13:20] for a, b, c, d in six]
    faces = [[cell[at] for at in face] for cell in cells[20:]
             for face in ((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7))]
    column = lambda rows: numpy.array(rows).flatten(order='F')
    numbers = lambda rows: column(rows).astype('i4')
    with h5py.File(path, 'w', libver=('v108', 'v110')) as file:
        def group(name, **attributes):
            made = file.create_group(name)
            for key, value in attributes.items():
                made.attrs[key] = numpy.bytes_(value) if isinstance(value, str) else value
            return made

        def step(name, number, time):
            return group(f'{name}/{number:020}{number:020}', NDT=number, NOR=number, PDT=float(time), RDT=-1, ROR=-1).name

        def values(place, content, points=1, profile='MED_NO_PROFILE_INTERNAL'):
            group(place, PFL=profile, GAU='')
            group(f'{place}/{profile}', NGA=points, NBR=1, GAU='')['CO'] = content

        group('INFOS_GENERALES', MAJ=4, MIN=1, REL=0)
        group('ENS_MAA/box', DIM=3, ESP=3, TYP=0, REP=0, NXT=-1, NXI=-1)
        mesh = step('ENS_MAA/box', -1, 0)
        group(f'{mesh}/NOE')['COO'] = column(points).astype('f8')
        for kind, rows in (('HE8', cubes), ('TE4', tets), ('TR3', [tet[:3] for tet in tets[:4]])):
            part = group(f'{mesh}/MAI/{kind}')
            part['NOD'] = numbers(rows)
            part['NOD'].attrs['NBR'] = len(rows)
            part['FAM'] = numpy.array([-1 - i % 3 for i in range(len(rows))], 'i4')
        part = group(f'{mesh}/MAI/POE')
        part['NOD'] = numpy.array(faces, 'i4').flatten()
        part['INN'] = numpy.arange(1, 4 * len(faces) + 2, 4, 'i4')
        part['IFN'] = numpy.arange(1, len(faces) + 2, 6, 'i4')
        for number, names in ((-1, ['steel']), (-2, ['steel', 'inside'])):
            family = group(f'FAS/box/ELEME/FAM_{number}', NUM=number)
            letters = group(f'{family.name}/GRO', NBR=len(names)).create_dataset(
                'NOM', (len(names),), numpy.dtype(('i1', (80,))))
            letters[...] = [list(name.encode().ljust(80, b'\0')) for name in names]
        group('PROFILS/half', NBR=20)['PFL'] = numpy.arange(1, 41, 2, 'i4')
        for name, components, kind in (('DEPL', 3, 6), ('TEMP', 1, 6), ('MARK', 1, 24), ('SIEF', 6, 6), ('ELNO', 1, 6)):
            group(f'CHA/{name}', MAI='box', NCO=components, TYP=kind, NOM=''.join(
                ('SI' + end).ljust(16) for end in 'XX YY ZZ XY XZ YZ'.split()) if name == 'SIEF' else '')
            for number in (1, 2):
                at = step(f'CHA/{name}', number, number / 4)
                made = lambda count: (numpy.arange(count * components) * 7 % 11 / 10 + number).astype('f8')
                if name == 'DEPL':
                    values(f'{at}/NOE', made(len(points)))
                elif name == 'TEMP':
                    values(f'{at}/NOE', made(20), profile='half')
                elif name == 'ELNO':
                    values(f'{at}/NOE.TE4', made(4 * len(tets)), 4)
                elif name == 'SIEF':
                    values(f'{at}/MAI.HE8', made(8 * len(cubes)), 8)
                else:
                    for kind, rows in (('HE8', cubes), ('TE4', tets), ('POE', faces[::6])):
                        values(f'{at}/MAI.{kind}', numpy.arange(len(rows), dtype='i4'))


def main():
    folder = sys.argv[1]
    os.makedirs(folder, exist_ok=True)
    at = lambda name: os.path.join(folder, name)
    write_xml(vtk.vtkXMLImageDataWriter(), image(), at('raw.vti'), 'Appended', encode=False)
    write_xml(vtk.vtkXMLRectilinearGridWriter(), rectilinear(), at('inline.vtr'), 'Binary')
    write_xml(vtk.vtkXMLStructuredGridWriter(), structured(), at('inline_zlib.vts'), 'Binary', 'ZLib')
    write_xml(vtk.vtkXMLUnstructuredGridWriter(), unstructured(True), at('inline.vtu'), 'Binary')
    write_xml(vtk.vtkXMLUnstructuredGridWriter(), unstructured(True), at('appended.vtu'), 'Appended')
    write_xml(vtk.vtkXMLUnstructuredGridWriter(), unstructured(False), at('appended_lz4.vtu'), 'Appended', 'LZ4')
    os.makedirs(at('polyhedra'), exist_ok=True)
    write_vtkhdf_polyhedra(at('polyhedra/partitions.vtkhdf'))
    os.makedirs(at('xdmf'), exist_ok=True)
    write_xdmf_series(at('xdmf/series.h5'))
    os.makedirs(at('ensight'), exist_ok=True)
    write_ensight(at('ensight'))
    write_ensight_6(at('ensight'))
    write_ensight_steps(at('ensight'))
    write_openfoam(at('openfoam'))
    os.makedirs(at('corner_points'), exist_ok=True)
    write_corner_points(at('corner_points'))
    os.makedirs(at('meshes'), exist_ok=True)
    write_legacy_polyhedra(at('meshes/polyhedra_42.vtk'), 42, False)
    write_legacy_polyhedra(at('meshes/polyhedra_51.vtk'), 51, True)
    write_gmsh(at('meshes/partitioned_v40.msh'), False)
    write_gmsh(at('meshes/partitioned_v41.msh'), True)
    write_medit(at('meshes'))
    os.makedirs(at('med'), exist_ok=True)
    write_med(at('med/results.med'))


if __name__ == '__main__':
    main()
