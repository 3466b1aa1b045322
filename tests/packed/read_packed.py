# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
# Reads a packed file by docs/inside/packed-file.md alone, and prints what is in it: points, cells by type, sums over corners
# and values. Standard library only.
import struct
import sys
from array import array


def crc32c_table():
    table = []
    for byte in range(256):
        crc = byte
        for _ in range(8):
            crc = crc >> 1 ^ (0x82F63B78 if crc & 1 else 0)
        table.append(crc)
    return table


TABLE = crc32c_table()


def crc32c(data):
    crc = 0xFFFFFFFF
    for byte in data:
        crc = crc >> 8 ^ TABLE[(crc ^ byte) & 0xFF]
    return crc ^ 0xFFFFFFFF


def check(condition, what):
    if not condition:
        raise SystemExit(f"broken: {what}")


def align(at):
    return (at + 63) // 64 * 64


class Cursor:
    def __init__(self, data):
        self.data, self.at = data, 0

    def take(self, form):
        values = struct.unpack_from("<" + form, self.data, self.at)
        self.at += struct.calcsize("<" + form)
        return values if len(values) > 1 else values[0]


def read_directory(data):
    check(data[:8] == b"isotetP\n", "magic")
    check(struct.unpack_from("<HHII", data, 8) == (1, 2, 0x01020304, 4096), "version")
    check(crc32c(data[:20]) == struct.unpack_from("<I", data, 20)[0], "header")
    slots = []
    for at in (512, 1024):
        count, offset, size, end, directory_crc, slot_crc = struct.unpack_from("<QQQQII", data, at)
        if count and crc32c(data[at:at + 36]) == slot_crc:
            slots.append((count, offset, size, end, directory_crc))
    _, offset, size, end, directory_crc = max(slots)
    check(end == len(data), "end")
    directory = data[offset:offset + size]
    check(crc32c(directory) == directory_crc, "directory")
    return directory


def sections(directory):
    at = 0
    while at < len(directory):
        name = directory[at:at + 8].decode().rstrip()
        size = struct.unpack_from("<Q", directory, at + 8)[0]
        yield name, directory[at + 16:at + 16 + size]
        at += 16 + size


def read_grid(content):
    c = Cursor(content)
    grid = {}
    grid["real"], grid["points_type"], codec, grid["flags"] = c.take("BBHI")
    check(codec == 0, "codec")
    grid["counts"] = c.take("5Q")
    grid["user_points"], grid["user_cells"], grid["clusters_at"], grid["chunks_at"] = c.take("4Q")
    return grid


def read_field(content, chunks):
    c = Cursor(content)
    field = dict(zip(("step", "type", "unchanged", "gradients", "zero"), c.take("IBBBB")))
    field["time"], field["offset"], field["scale"], field["lower"], field["upper"] = c.take("5d")
    field["no_data"], _, _, field["ranges_at"], field["values_at"] = c.take("5Q")
    crcs = c.take(f"{2 * chunks}I")
    field["ranges_crc"], field["values_crc"] = crcs[0::2], crcs[1::2]
    field["name"] = content[c.at + 4:c.at + 4 + struct.unpack_from("<I", content, c.at)[0]].decode()
    return field


def check_cell_field(data, content, cells):
    c = Cursor(content)
    _, kind, components, _, at = c.take("IBBHQ")
    size = cells * components * (1, 1, 2, 2, 4, 4, 8, 8, 4, 8)[kind]
    for begin in range(at, at + size, 1 << 20):
        end = min(begin + (1 << 20), at + size)
        check(crc32c(data[begin:end]) == c.take("I"), "cell field")
    print(content[c.at + 4:c.at + 4 + c.take("I")].decode(), "of cells", components)


def check_moved_points(data, content, chunks, real, boundary_points):
    c = Cursor(content)
    step, boundary_crc = c.take("II")
    c.take("9d")
    _, _, at, boundary_at = c.take("4Q")
    for k, chunk in enumerate(chunks):
        size = 3 * real * chunk[1]
        read_piece(data, at, size, c.take("I"), f"moved points of chunk {k}")
        at += align(size)
    places = numbers("f" if real == 4 else "d",
                     read_piece(data, boundary_at, 3 * real * boundary_points, boundary_crc, "moved points of the boundary"))
    print("moved", step, sum(places))


def numbers(form, data):
    out = array(form)
    out.frombytes(data)
    if sys.byteorder == "big":
        out.byteswap()
    return out


def read_piece(data, at, size, crc, what):
    piece = data[at:at + size]
    check(crc32c(piece) == crc, what)
    return piece


def corners_of(record, words):
    """(VTK's type, local indices) of each cell of a cluster."""
    at = 0
    for kind, corners in enumerate((4, 5, 6, 8)):
        size = 4 if kind == 0 else 8
        for _ in range(record[2 + kind]):
            yield (10, 14, 13, 12)[kind], words[at:at + corners]
            at += size


def local_points(record, links, first_own, cluster):
    """Packed points of the local points of a cluster: ghost points first."""
    own, ghosts, neighbours, own_seams, seams = record[0], record[1], record[6], record[7], record[8]
    borrowed = iter(links[8 * neighbours + 2 * (own_seams + seams):][:ghosts])
    local = []
    for owner, counts in struct.iter_unpack("<II", links[:8 * neighbours]):
        for _ in range(counts & 0xFFFF):
            local.append(first_own[owner] + next(borrowed))
    local.extend(range(first_own[cluster], first_own[cluster] + own))
    return local


def main(path):
    data = open(path, "rb").read()
    grid, chunks, fields, moved = None, None, [], []
    for name, content in sections(read_directory(data)):
        if name == "GRID":
            grid = read_grid(content)
        elif name == "CHUNKS":
            chunks = list(struct.iter_unpack("<8I", content))
        elif name == "POINTS":
            moved.append(content)
        elif name in ("FIELD", "MFIELD"):
            check((name == "MFIELD") == bool(moved and struct.unpack_from("<I", moved[0])[0] <= struct.unpack_from("<I", content)[0]),
                  "a field's name where points have moved")
            fields.append(read_field(content, len(chunks)))
        elif name == "CELLFLD":
            check_cell_field(data, content, grid["user_cells"])
        elif name == "BOUNDARY":
            boundary = struct.unpack_from("<3QI", content)
        elif name == "BVALUES":
            boundary_values = list(struct.iter_unpack("<QII", content))
            check(len(boundary_values) == len(fields), "values at the boundary")
    field = fields[0]
    check(tuple(sum(chunk[k] for chunk in chunks) for k in range(5)) == grid["counts"], "counts")
    real, real_form = grid["real"], "f" if grid["real"] == 4 else "d"
    id_size = 8 if grid["flags"] & 1 else 4
    cell_size = 0 if not grid["flags"] & 2 else 8 if grid["flags"] & 4 else 4
    rank_size = 8 if grid["flags"] & 8 else 0

    ids, values, records, first_own, links_of, words_of = [], [], [], [], [], []
    at, clusters_at, values_at, ranges_at = grid["chunks_at"], grid["clusters_at"], field["values_at"], field["ranges_at"]
    for k, (clusters, points, words, links, groups, clusters_crc, points_crc, topology_crc) in enumerate(chunks):
        size = points * (3 * real + id_size + rank_size)
        piece = read_piece(data, at, size, points_crc, f"points of chunk {k}")
        ids.extend(numbers("Q" if id_size == 8 else "I", piece[3 * real * points:][:id_size * points]))
        at += align(size)
        size = words * (4 + cell_size) + 4 * links
        piece = read_piece(data, at, size, topology_crc, f"topology of chunk {k}")
        cells, links_bytes = piece[:4 * words], piece[4 * words:4 * (words + links)]
        at += align(size)
        size = points * (real + (4 if field["gradients"] else 0)) + 2 * groups
        piece = read_piece(data, values_at, size, field["values_crc"][k], f"values of chunk {k}")
        values.extend(numbers(real_form, piece[:real * points]))
        values_at += align(size)
        size = clusters * (2 * real + 1)
        read_piece(data, ranges_at, size, field["ranges_crc"][k], f"ranges of chunk {k}")
        ranges_at += size
        piece = read_piece(data, clusters_at, 20 * clusters, clusters_crc, f"clusters of chunk {k}")
        clusters_at += len(piece)
        for record in struct.iter_unpack("<10H", piece):
            first_own.append(first_own[-1] + records[-1][0] if records else 0)
            records.append(record)
            _, ghosts, tets, pyramids, wedges, hexahedra, neighbours, own_seams, seams, wide = record
            size = 4 * (tets + 2 * (pyramids + wedges + hexahedra))
            words_of.append(cells[:size])
            cells = cells[size:]
            size = 8 * neighbours + (2 * (own_seams + seams) + ghosts + (1 + wide) * seams + 3) // 4 * 4
            links_of.append(links_bytes[:size])
            links_bytes = links_bytes[size:]

    by_type, corner_sum, value_sum = {}, 0, 0.0
    for c, record in enumerate(records):
        local = local_points(record, links_of[c], first_own, c)
        for kind, corners in corners_of(record, words_of[c]):
            by_type[kind] = by_type.get(kind, 0) + 1
            for corner in corners:
                corner_sum += ids[local[corner]] + 1
                value = values[local[corner]] / field["scale"] + field["offset"]
                if value == value:
                    value_sum += value
    print(grid["user_points"], "points")
    for kind in sorted(by_type):
        print(f"{kind}: {by_type[kind]}")
    print("sums", corner_sum, repr(value_sum))

    for content in moved:
        check_moved_points(data, content, chunks, real, boundary[0])
    points, triangles, at, crc = boundary
    wide = grid["counts"][1] >= 1 << 32
    size = points * ((8 if wide else 4) + 3 * real) + 12 * triangles
    piece = read_piece(data, at, size, crc, "boundary")
    packed = numbers("Q" if wide else "I", piece[:(8 if wide else 4) * points])
    places = numbers(real_form, piece[(8 if wide else 4) * points:len(piece) - 12 * triangles])
    corners = numbers("I", piece[len(piece) - 12 * triangles:])
    area = 0.0
    for i in range(0, len(corners), 3):
        a, b, c = (places[3 * corner:3 * corner + 3] for corner in corners[i:i + 3])
        u, v = [q - p for p, q in zip(a, b)], [q - p for p, q in zip(a, c)]
        area += sum((u[k - 2] * v[k - 1] - u[k - 1] * v[k - 2]) ** 2 for k in range(3)) ** 0.5 / 2
    at, crc, _ = boundary_values[0]
    there = numbers(real_form, read_piece(data, at, points * real, crc, "values at the boundary"))
    check(all(a == values[p] or a != a for a, p in zip(there, packed)), "values at the boundary")
    print("boundary", points, triangles, area, sum(a / field["scale"] + field["offset"] for a in there if a == a))


main(sys.argv[1])
