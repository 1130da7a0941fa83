#!/usr/bin/env python3
"""Writes the made seeds of fuzz/corpus: small valid files, and files whose headers contradict their contents. Run it
again after adding one; it writes the same files each time. The .glb files that need an encoder (Draco, meshopt), and
files that fuzzers have found, lie beside them."""
import base64
import gzip
import json
import pathlib
import struct
import zlib

CORPUS = pathlib.Path(__file__).parent / "corpus"


def write(name, data):
    path = CORPUS / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(data if isinstance(data, bytes) else data.encode())


# --- glTF

FLOAT, USHORT = 5126, 5123
TRIANGLE = struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0)


def glb(document, binary=b""):
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    binary += b"\0" * (-len(binary) % 4)
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text
    if binary:
        chunks += struct.pack("<II", len(binary), 0x004E4942) + binary
    return b"glTF" + struct.pack("<II", 2, 12 + len(chunks)) + chunks


def document(binary, primitive=None, **more):
    """A triangle in one node; `more` adds to it or replaces parts."""
    parts = {
        "asset": {"version": "2.0"},
        "buffers": [{"byteLength": len(binary)}],
        "bufferViews": [{"buffer": 0, "byteLength": len(binary)}],
        "accessors": [{"bufferView": 0, "componentType": FLOAT, "count": 3, "type": "VEC3"}],
        "meshes": [{"primitives": [primitive or {"attributes": {"POSITION": 0}}]}],
        "nodes": [{"mesh": 0}],
        "scenes": [{"nodes": [0]}],
        "scene": 0,
    }
    parts.update(more)
    return parts


def png(width, height, rows=None):
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    if rows is None:
        rows = (b"\0" + b"\xff\x80\x40\x7f" * width) * height
    head = struct.pack(">IIBBBBB", width, height, 8, 6, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b"")


def write_gltf():
    write("gltf/triangle.glb", glb(document(TRIANGLE), TRIANGLE))
    inside = document(TRIANGLE)
    inside["buffers"][0]["uri"] = "data:application/octet-stream;base64," + base64.b64encode(TRIANGLE).decode()
    write("gltf/triangle.gltf", json.dumps(inside))
    for mode in range(7):
        write(f"gltf/mode_{mode}.glb", glb(document(TRIANGLE, {"attributes": {"POSITION": 0}, "mode": mode}), TRIANGLE))

    outside = document(TRIANGLE)
    for name, uri in (("missing", "missing.bin"), ("leaves", "../../etc/hosts"), ("remote", "https://example.org/a.bin")):
        outside["buffers"][0]["uri"] = uri
        write(f"gltf/uri_{name}.gltf", json.dumps(outside))

    # Few bytes that ask for much: counts without data, copies of copies.
    empty = {"componentType": FLOAT, "count": 1 << 28, "type": "VEC3"}
    write("gltf/count_without_data.glb", glb(document(TRIANGLE, accessors=[empty])))
    some = {"componentType": FLOAT, "count": 3000, "type": "VEC3"}
    morph = {"primitives": [{"attributes": {"POSITION": 0}, "targets": [{"POSITION": 0}], "mode": 0}], "weights": [1]}
    write("gltf/many_morphed_nodes.glb",
          glb(document(TRIANGLE, accessors=[some], meshes=[morph], nodes=[{"mesh": 0}] * 300, scenes=[{"nodes": list(range(300))}])))
    instances = {"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": 1}}}
    write("gltf/many_instances.glb",
          glb(document(TRIANGLE, accessors=[some, {"componentType": FLOAT, "count": 10_000_000, "type": "VEC3"}],
                       nodes=[{"mesh": 0, "extensions": instances}], extensionsUsed=["EXT_mesh_gpu_instancing"],
                       extensionsRequired=["EXT_mesh_gpu_instancing"])))
    write("gltf/big_picture.glb", picture_scene(png(16384, 16384, b"\0" * 64)))
    write("gltf/picture.glb", picture_scene(png(4, 4)))
    write("gltf/picture_damaged.glb", picture_scene(png(4, 4)[:60]))

    write("gltf/nodes_in_a_circle.glb", glb(document(TRIANGLE, nodes=[{"mesh": 0, "children": [1]}, {"children": [0]}]), TRIANGLE))
    chain = [{"children": [i + 1]} for i in range(200)] + [{"mesh": 0}]
    write("gltf/deep_nodes.glb", glb(document(TRIANGLE, nodes=chain), TRIANGLE))
    write("gltf/deep_json.gltf", "[" * 4000)
    write("gltf/deep_extras.gltf", json.dumps(document(TRIANGLE))[:-1] + ',"extras":' + '{"a":' * 500 + "1" + "}" * 501)

    for name, numbers in (("nan", [float("nan")] * 9), ("infinity", [float("inf"), 0, 0, 1, 0, 0, 0, 1, 0]),
                          ("far", [1e17, 0, 0, 1e17, 1, 0, 1e17, 0, 1]), ("denormal", [1e-40] * 9)):
        binary = struct.pack("<9f", *numbers)
        write(f"gltf/positions_{name}.glb", glb(document(binary), binary))

    # Lies about where things are.
    beyond = [{"bufferView": 0, "byteOffset": 8, "componentType": FLOAT, "count": 3, "type": "VEC3"}]
    write("gltf/accessor_past_its_view.glb", glb(document(TRIANGLE, accessors=beyond), TRIANGLE))
    wraps = [{"bufferView": 0, "byteOffset": (1 << 53) - 4, "componentType": FLOAT, "count": 3, "type": "VEC3"}]
    write("gltf/accessor_offset_huge.glb", glb(document(TRIANGLE, accessors=wraps), TRIANGLE))
    long_view = [{"buffer": 0, "byteOffset": 4, "byteLength": 1 << 40, "byteStride": 252}]
    write("gltf/view_past_its_buffer.glb", glb(document(TRIANGLE, bufferViews=long_view), TRIANGLE))
    write("gltf/buffer_too_long.glb", glb(document(TRIANGLE, buffers=[{"byteLength": 1 << 33}]), TRIANGLE))
    write("gltf/indices_past_the_end.glb", indexed([0, 1, 900]))
    write("gltf/indices.glb", indexed([0, 1, 2]))
    write("gltf/sparse_past_the_end.glb", sparse(7))
    write("gltf/sparse.glb", sparse(2))
    whole = glb(document(TRIANGLE), TRIANGLE)
    write("gltf/cut_short.glb", whole[:-20])
    write("gltf/chunk_too_long.glb", whole[:12] + struct.pack("<I", 0xFFFFFFF0) + whole[16:])
    write("gltf/only_a_header.glb", whole[:12])
    write("gltf/animated.glb", animated())


def picture_scene(picture):
    uv = struct.pack("<6f", 0, 0, 1, 0, 0, 1)
    binary = TRIANGLE + uv + picture
    material = {"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}, "alphaMode": "MASK", "alphaCutoff": 0.5}
    views = [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 24},
             {"buffer": 0, "byteOffset": 60, "byteLength": len(picture)}]
    return glb(document(binary, {"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "material": 0}, bufferViews=views,
                        accessors=[{"bufferView": 0, "componentType": FLOAT, "count": 3, "type": "VEC3"},
                                   {"bufferView": 1, "componentType": FLOAT, "count": 3, "type": "VEC2"}],
                        images=[{"bufferView": 2, "mimeType": "image/png"}], textures=[{"source": 0}],
                        materials=[material]), binary)


def indexed(indices):
    binary = TRIANGLE + struct.pack("<3H", *indices) + b"\0\0"
    return glb(document(binary, {"attributes": {"POSITION": 0}, "indices": 1},
                        bufferViews=[{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 6}],
                        accessors=[{"bufferView": 0, "componentType": FLOAT, "count": 3, "type": "VEC3"},
                                   {"bufferView": 1, "componentType": USHORT, "count": 3, "type": "SCALAR"}]), binary)


def sparse(index):
    binary = TRIANGLE + struct.pack("<HH3f", index, 0, 5, 5, 5)
    changes = {"count": 1, "indices": {"bufferView": 1, "componentType": USHORT}, "values": {"bufferView": 2}}
    return glb(document(binary,
                        bufferViews=[{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 2},
                                     {"buffer": 0, "byteOffset": 40, "byteLength": 12}],
                        accessors=[{"bufferView": 0, "componentType": FLOAT, "count": 3, "type": "VEC3", "sparse": changes}]),
               binary)


def animated():
    times, turns = struct.pack("<2f", 0, 1), struct.pack("<8f", 0, 0, 0, 1, 0, 0.7071, 0, 0.7071)
    binary = TRIANGLE + times + turns
    return glb(document(binary,
                        bufferViews=[{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 8},
                                     {"buffer": 0, "byteOffset": 44, "byteLength": 32}],
                        accessors=[{"bufferView": 0, "componentType": FLOAT, "count": 3, "type": "VEC3"},
                                   {"bufferView": 1, "componentType": FLOAT, "count": 2, "type": "SCALAR", "min": [0], "max": [1]},
                                   {"bufferView": 2, "componentType": FLOAT, "count": 2, "type": "VEC4"}],
                        animations=[{"samplers": [{"input": 1, "output": 2}],
                                     "channels": [{"sampler": 0, "target": {"node": 0, "path": "rotation"}}]}]), binary)


# --- volumes: the first byte says which of .mha, .mhd, .nii and .nii.gz the rest is

MHA, MHD, NII, NII_GZ = b"0", b"1", b"2", b"3"


def metaimage(data=bytes(range(8)), **fields):
    lines = {"ObjectType": "Image", "NDims": "3", "DimSize": "2 2 2", "ElementSpacing": "1 1 1",
             "ElementType": "MET_UCHAR", "ElementDataFile": "LOCAL"}
    lines.update(fields)
    last = lines.pop("ElementDataFile")
    lines["ElementDataFile"] = last
    return "".join(f"{key} = {value}\n" for key, value in lines.items()).encode() + data


def nifti(size=(2, 2, 2), kind=2, data=bytes(range(8)), offset=352.0, order="<"):
    head = bytearray(348)
    struct.pack_into(order + "i", head, 0, 348)
    struct.pack_into(order + "8h", head, 40, 3, *size, 1, 1, 1, 1)
    struct.pack_into(order + "h", head, 70, kind)
    struct.pack_into(order + "4f", head, 76, 1, 1, 1, 1)
    struct.pack_into(order + "f", head, 108, offset)
    head[344:348] = b"n+1\0"
    return bytes(head) + b"\0" * 4 + data


def write_volumes():
    write("volume/raw.mha", MHA + metaimage())
    packed = zlib.compress(bytes(range(8)))
    write("volume/packed.mha", MHA + metaimage(packed, CompressedData="True", CompressedDataSize=str(len(packed))))
    write("volume/packed_bomb.mha", MHA + metaimage(zlib.compress(bytes(1 << 20), 9), CompressedData="True", DimSize="2000 2000 2000"))
    write("volume/anisotropic.mha", MHA + metaimage(ElementSpacing="32000 32000 1"))
    write("volume/size_wraps.mha", MHA + metaimage(DimSize="4294967296 4294967296 4294967296"))
    write("volume/size_negative.mha", MHA + metaimage(DimSize="-2 2 2"))
    write("volume/too_short.mha", MHA + metaimage(DimSize="20 20 20"))
    write("volume/nan.mha", MHA + metaimage(struct.pack("<8d", *[float("nan")] * 7, 1e308), ElementType="MET_DOUBLE"))
    write("volume/turned.mha", MHA + metaimage(TransformMatrix="0 1 0 0 0 1 1 0 0", Offset="1 -2 1e300"))
    write("volume/flat_axes.mha", MHA + metaimage(TransformMatrix="0 0 0 0 0 0 0 0 0"))
    write("volume/no_header.mha", MHA)
    for name, there in (("dot", "."), ("itself", "volume.mhd"), ("missing", "missing.raw"), ("list", "LIST"), ("pattern", "a%03d.raw 0 9 1")):
        write(f"volume/data_{name}.mhd", MHD + metaimage(b"", ElementDataFile=there))
    write("volume/bytes.nii", NII + nifti())
    write("volume/floats.nii", NII + nifti(kind=16, data=struct.pack("<8f", *range(8))))
    write("volume/big_endian.nii", NII + nifti(kind=4, data=struct.pack(">8h", *range(8)), order=">"))
    write("volume/huge.nii", NII + nifti(size=(32767, 32767, 32767), kind=64))
    write("volume/offset_nan.nii", NII + nifti(offset=float("nan")))
    write("volume/offset_huge.nii", NII + nifti(offset=3e38))
    write("volume/empty_axis.nii", NII + nifti(size=(0, 2, 2)))
    write("volume/kind_unknown.nii", NII + nifti(kind=1536))
    write("volume/cut_short.nii", NII + nifti()[:200])
    pack = lambda data: gzip.compress(data, 9, mtime=0)
    write("volume/bytes.nii.gz", NII_GZ + pack(nifti()))
    write("volume/two_members.nii.gz", NII_GZ + pack(nifti()[:300]) + pack(nifti()[300:]))
    write("volume/cut_short.nii.gz", NII_GZ + pack(nifti())[:-9])
    write("volume/bomb.nii.gz", NII_GZ + pack(nifti(size=(256, 256, 64), data=bytes(256 * 256 * 64))))


# --- words

def write_words():
    uris = {
        "plain": "ear.bin", "folder": "parts/ear.bin", "percent": "my%20ear.bin", "percent_cut": "ear%2", "percent_zero": "ear%00.bin",
        "percent_dots": "%2e%2e/%2e%2e/etc/passwd", "dots": "a/../../b", "dots_inside": "a/../b", "backslash": "..\\..\\b",
        "absolute": "/etc/passwd", "scheme": "file:///etc/passwd", "drive": "C:\\ear.bin", "remote": "https://example.org/a.bin",
        "query": "ear.bin?a=b#c", "empty": "", "dot": ".", "utf8": "öhr.bin", "broken_utf8": b"\xff\xfe.bin",
        "data_base64": "data:application/octet-stream;base64,AAECAwQ=", "data_unpadded": "data:;base64,AAECAwQ",
        "data_percent": "data:text/plain,a%20b%", "data_broken": "data:;base64,A===A", "data_bare": "data:", "data_no_comma": "data:;base64",
    }
    for name, text in uris.items():
        write(f"uri/{name}", text)
    lines = {
        "render": "render builtin:knot --size 640x480 --shadow soft --light 1,2,3,0.5 -o a.png",
        "render_camera": "render a.glb --camera 1,2,3,0,0,0,45 --pixel-error 0.5 --show levels --brick-pool 64M",
        "voxelize": "voxelize a.glb -r 64,32,16 --bounds 0,0,0,1,1,1 --fill solid -o a.vdb",
        "voxelize_twice": "voxelize a.glb -r 64 --voxel-size 0.1", "check": "check builtin:tree -r 128 --json - --quiet",
        "shadow": "shadow builtin:cornell --method pyramid --compare embree --size 64x48", "info": "info a.gltf --trust-paths --time 1e400",
        "view": "view builtin:knot --frames 3 --log", "export": "export builtin:needles -o a.glb",
        "bench": "bench voxelize --resolutions 64,128 --runs 3 --scene knot", "help": "render --help", "version": "--version",
        "no_verb": "--json", "unknown": "paint a.glb", "numbers": "render a.glb --size 99999999999999999999x1 --time nan --zoom -1",
        "twice": "render a.glb --size 1x1 --size 2x2", "equals": "render a.glb --size=8x8 --shadow=", "rest": "render -- --size",
        "volume": "render a.mha --transfer 0:1,1,1:0;1:1,0,0:2 --copies 3", "fractal": "render builtin:fractal --zoom 200",
        "empty": "",
    }
    for name, text in lines.items():
        write(f"options/{name}", text.replace(" ", "\n"))
    transfers = {
        "name": "bone", "points": "0:1,1,1:0;1:1,0.5,0.25:2", "one_point": "0.5:1,1,1:1", "unordered": "1:0,0,0:1;0:1,1,1:0",
        "equal": "0.5:1,1,1:0;0.5:1,1,1:9", "negative": "0:1,1,1:-1", "infinite": "0:1,1,1:inf;1:nan,1,1:1e308", "cut": "0:1,1:",
        "colons": ":::::", "empty": "", "separators": ";;;", "huge": "0:1,1,1:1e308;1e-320:1,1,1:1e-320", "many": ";".join(
            f"{i / 400}:1,1,1:{i}" for i in range(400)),
    }
    for name, text in transfers.items():
        write(f"transfer/{name}", text)


write_gltf()
write_volumes()
write_words()
