"""read_voxels.py FILE EXPECTED [COLOR_TOLERANCE]

Reads a voxel file with readers that know nothing of Cairn (NumPy, OpenVDB; for .binvox and .vox, which no library here
reads, from the formats' specifications), and compares it with EXPECTED:

    x y z            voxels of the grid
    x y z size       origin, voxel size
    i j k r g b nx ny nz    one line a voxel: linear colour, normal; the last six may be missing

Prints what differs, and exits 1; exits 77 when the reader is not installed.
"""

import struct
import sys


def fail(message):
    print(message)
    sys.exit(1)


class Grid:
    def __init__(self, resolution, origin, size):
        self.resolution, self.origin, self.size = resolution, origin, size

    def voxel_at(self, world):
        """The voxel with this centre, which must be right to a millionth of the grid."""
        voxel = []
        for axis in range(3):
            at = (world[axis] - self.origin[axis]) / self.size - 0.5
            if abs(at - round(at)) > 1e-6 * max(self.resolution):
                fail(f"no voxel has its centre at {world}: {at} along axis {axis}")
            voxel.append(round(at))
        return tuple(voxel)


def read_expected(path):
    with open(path) as lines:
        resolution = tuple(int(word) for word in next(lines).split())
        numbers = [float(word) for word in next(lines).split()]
        voxels = {}
        for line in lines:
            words = line.split()
            voxels[tuple(int(word) for word in words[:3])] = [float(word) for word in words[3:]]
    return Grid(resolution, numbers[:3], numbers[3]), voxels


def srgb(linear):
    encoded = 12.92 * linear if linear <= 0.0031308 else 1.055 * linear ** (1 / 2.4) - 0.055
    return 255 * encoded


def read_npy(path, grid):
    import numpy

    voxels = numpy.load(path, mmap_mode="r")
    if voxels.dtype != numpy.uint8 or voxels.shape != grid.resolution or not voxels.flags.c_contiguous:
        fail(f"dtype {voxels.dtype}, shape {voxels.shape}, C order {voxels.flags.c_contiguous}")
    if voxels.max(initial=0) > 1:
        fail("values above 1")
    return {tuple(int(i) for i in voxel): [] for voxel in numpy.argwhere(voxels)}


def read_binvox(path, grid):
    with open(path, "rb") as file:
        if file.readline() != b"#binvox 1\n":
            fail("the first line is not #binvox 1")
        header = {}
        for line in iter(file.readline, b"data\n"):
            words = line.split()
            header[words[0]] = [float(word) for word in words[1:]]
        data = file.read()
    dim = [int(d) for d in header[b"dim"]]
    if dim != [dim[0]] * 3:
        fail(f"not a cube: {dim}")
    dim, scale, translate = dim[0], header[b"scale"][0], header[b"translate"]
    voxels, index = {}, 0
    for value, count in zip(data[::2], data[1::2]):
        if value > 1 or count == 0:
            fail(f"a run of {count} times {value}")
        for i in range(index, index + count) if value else ():
            # y runs fastest, then z, then x.
            place = i // (dim * dim), i % dim, i // dim % dim
            world = [translate[axis] + scale * (place[axis] + 0.5) / dim for axis in range(3)]
            voxels[grid.voxel_at(world)] = []
        index += count
    if index != dim**3 or len(data) % 2:
        fail(f"{index} voxels of {dim}^3")
    return voxels


def read_vdb(path, grid):
    import pyopenvdb

    grids = {g.name: g for g in pyopenvdb.readAll(path)[0]}
    density = grids["density"]
    if density.background != 0 or density.gridClass != "fog volume" or density.transform.voxelSize()[0] != grid.size:
        fail(f"density: {density.background} {density.gridClass} {density.transform.voxelSize()}")
    voxels = {}

    def visit(values, found):
        for item in values.iterOnValues():
            for x in range(item.min[0], item.max[0] + 1):
                for y in range(item.min[1], item.max[1] + 1):
                    for z in range(item.min[2], item.max[2] + 1):
                        found(grid.voxel_at(values.transform.indexToWorld((x, y, z))), item.value)

    def occupy(voxel, value):
        if value != 1.0:
            fail(f"density {value} at {voxel}")
        voxels[voxel] = []

    visit(density, occupy)
    if density.activeVoxelCount() != len(voxels):
        fail("a voxel lies twice")
    for name in ("Cd", "N"):
        if name in grids:
            visit(grids[name], lambda voxel, value: voxels[voxel].extend(value))
    return voxels


class VoxReader:
    def __init__(self, data):
        self.data, self.at = data, 0

    def bytes(self, count):
        self.at += count
        return self.data[self.at - count : self.at]

    def int(self):
        return struct.unpack("<i", self.bytes(4))[0]

    def text(self):
        return self.bytes(self.int()).decode()

    def dict(self):
        return {self.text(): self.text() for _ in range(self.int())}


def read_vox(path, grid):
    with open(path, "rb") as file:
        reader = VoxReader(file.read())
    if reader.bytes(4) != b"VOX " or reader.int() != 150 or reader.bytes(4) != b"MAIN" or reader.int() != 0:
        fail("not a .vox file of version 150")
    if reader.int() != len(reader.data) - 20:
        fail("MAIN is not all of the file")
    sizes, models, nodes, palette = [], [], {}, None
    while reader.at < len(reader.data):
        kind, size, children = reader.bytes(4), reader.int(), reader.int()
        end = reader.at + size
        if children:
            fail(f"{kind} has children")
        if kind == b"SIZE":
            sizes.append((reader.int(), reader.int(), reader.int()))
        elif kind == b"XYZI":
            models.append([tuple(reader.bytes(4)) for _ in range(reader.int())])
        elif kind == b"RGBA":
            palette = [tuple(reader.bytes(4)) for _ in range(256)]
        elif kind == b"nTRN":
            node, attributes, child = reader.int(), reader.dict(), reader.int()
            reader.int(), reader.int()
            frames = [reader.dict() for _ in range(reader.int())]
            nodes[node] = ("T", child, frames, attributes)
        elif kind == b"nGRP":
            node, _ = reader.int(), reader.dict()
            nodes[node] = ("G", [reader.int() for _ in range(reader.int())])
        elif kind == b"nSHP":
            node, _ = reader.int(), reader.dict()
            nodes[node] = ("S", [(reader.int(), reader.dict())[0] for _ in range(reader.int())])
        else:
            fail(f"chunk {kind}")
        if reader.at != end:
            fail(f"{kind} is {size} bytes long, and ends at {reader.at - end + size}")
    name = nodes[0][3]["_name"].replace(",", "").split()
    dims, origin, size = [int(n) for n in name[1:4]], [float(n) for n in name[5:8]], float(name[9])
    if tuple(dims) != grid.resolution:
        fail(f"{dims} voxels")
    voxels = {}

    def place(number, offset):
        node = nodes[number]
        if node[0] == "T":
            moved = [int(n) for n in node[2][0].get("_t", "0 0 0").split()]
            place(node[1], [offset[axis] + moved[axis] for axis in range(3)])
        elif node[0] == "G":
            for child in node[1]:
                place(child, offset)
        else:
            (model,) = node[1]
            side = sizes[model]
            if max(side) > 256:
                fail(f"a model of {side}")
            for x, y, z, index in models[model]:
                if x >= side[0] or y >= side[1] or z >= side[2] or index == 0:
                    fail(f"voxel {x, y, z} of colour {index} in a model of {side}")
                # The anchor of a model is its middle, rounded down.
                v = [(x, y, z)[axis] - side[axis] // 2 + offset[axis] for axis in range(3)]
                # z is up there, y here.
                sunk = dims[1] // 2 if dims[1] > 1000 else 0
                i, j, k = v[0] + dims[0] // 2, v[2] + sunk, dims[2] - 1 - (v[1] + dims[2] // 2)
                world = [origin[axis] + size * ((i, j, k)[axis] + 0.5) for axis in range(3)]
                voxel = grid.voxel_at(world)
                if voxel in voxels:
                    fail(f"voxel {voxel} lies twice")
                # Colour i of the chunk is number i + 1.
                voxels[voxel] = [float(c) for c in palette[index - 1][:3]]

    place(0, [0, 0, 0])
    return voxels


def read_goxel_text(path, grid):
    """What Goxel exports of a .vox: the places of the editor's scene, colours as RRGGBB."""
    voxels = {}
    with open(path) as lines:
        for line in lines:
            if line.startswith("#"):
                continue
            x, y, z, color = line.split()
            i, j, k = (int(x) + grid.resolution[0] // 2, int(z), grid.resolution[2] - 1 - int(y) - grid.resolution[2] // 2)
            voxels[i, j, k] = [float(c) for c in bytes.fromhex(color)]
    return voxels


READERS = {"txt": read_goxel_text, "npy": read_npy, "binvox": read_binvox, "vdb": read_vdb, "vox": read_vox}


def compare(found, expected, tolerance):
    missing, extra = expected.keys() - found.keys(), found.keys() - expected.keys()
    if missing or extra:
        fail(f"{len(missing)} missing {sorted(missing)[:5]}, {len(extra)} extra {sorted(extra)[:5]} of {len(expected)}")
    worst = 0.0
    for voxel, values in found.items():
        wanted = expected[voxel]
        if len(values) == 3:  # the palette's 8 bits, sRGB; light grey where no colour is known
            wanted = [srgb(c) for c in wanted[:3]] or [200, 200, 200]
        if values and len(values) != len(wanted):
            fail(f"{len(values)} values at {voxel}, not {len(wanted)}")
        worst = max([worst] + [abs(a - b) for a, b in zip(values, wanted)])
    if worst > tolerance:
        fail(f"values are up to {worst} off")
    print(f"{len(found)} voxels, values up to {worst} off")


def main():
    path, expected_path = sys.argv[1:3]
    tolerance = float(sys.argv[3]) if len(sys.argv) > 3 else 0.0
    grid, expected = read_expected(expected_path)
    try:
        found = READERS[path.rsplit(".", 1)[1]](path, grid)
    except ModuleNotFoundError as error:
        print(error)
        sys.exit(77)
    compare(found, expected, tolerance)


main()
