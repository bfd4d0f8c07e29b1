# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""--max-memory holds for every kind of file: what unpacks to much, what says that it is much, and what is much. The peak of resident
memory is at most the limit and 64 MiB, besides the input, which is mapped: its pages are the system's."""

import base64
import io
import json
import lzma
import os
import struct
import zipfile
import zlib

from hostile import check, done, main, run

MIB = 1 << 20
SLACK_MIB = 64
LIMITS_MIB = (64, 256)


def write(path, data):
    with open(path, "wb") as file:
        file.write(data)


def size_of(path):
    if os.path.isdir(path):
        return sum(size_of(os.path.join(path, name)) for name in os.listdir(path))
    return os.path.getsize(path)


def held(words, inputs, limits=LIMITS_MIB):
    """Runs a command by each limit; returns those by which it was done."""
    passed, wrong = [], []
    for limit in limits:
        result = run(*words, "--max-memory", f"{limit}M", timeout_s=120)
        text = f"{' '.join(words)}, {limit} MiB"
        if result.status not in (0, 1) or (result.status == 1 and not result.err.strip().startswith("ewa: ")):
            wrong.append(f"{text}: status {result.status}: {result.err[-200:]}")
        allowed = limit + SLACK_MIB + sum(size_of(name) for name in inputs) / MIB
        if result.peak_bytes > allowed * MIB:
            wrong.append(f"{text}: {result.peak_bytes / MIB:.0f} MiB of {allowed:.0f}: {result.err.strip()[-150:]}")
        if result.status == 0:
            passed.append(limit)
    check(not wrong, "\n  ".join(wrong))
    return passed


def webp(side):
    """A lossless picture of one colour, whose codes take no bits."""
    bits, count = 0, 0
    for value, size in ((side - 1, 14), (side - 1, 14), (1, 1), (0, 3), (0, 3), *((1, 4),) * 5):
        bits |= value << count
        count += size
    data = b"\x2f" + bits.to_bytes(23, "little")
    return b"RIFF" + struct.pack("<I", 12 + len(data)) + b"WEBPVP8L" + struct.pack("<I", len(data)) + data


def chunk(name, data):
    return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))


def zeros(count, window=15):
    packer = zlib.compressobj(9, zlib.DEFLATED, window)
    block = bytes(MIB)
    data = b"".join(packer.compress(block) for _ in range(count // MIB))
    return data + packer.compress(bytes(count % MIB)) + packer.flush()


def png(side, bits, color):
    samples = {0: 1, 2: 3, 6: 4}[color]
    row_bytes = 1 + (side * bits * samples + 7) // 8
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", side, side, bits, color, 0, 0, 0)) +
            chunk(b"IDAT", zeros(row_bytes * side)) + chunk(b"IEND", b""))


def sog(path, count, side, deflated=False):
    """Pictures of one colour, and what goes with them."""
    names = ["means_l.webp", "means_u.webp", "scales.webp", "quats.webp", "sh0.webp"]
    table = [0.01 * i for i in range(256)]
    meta = {"version": 2, "count": count, "means": {"mins": [0, 0, 0], "maxs": [1, 1, 1], "files": names[:2]},
            "scales": {"codebook": table, "files": names[2:3]}, "quats": {"files": names[3:4]},
            "sh0": {"codebook": table, "files": names[4:]}}
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED if deflated else zipfile.ZIP_STORED) as archive:
        archive.writestr("meta.json", json.dumps(meta))
        for name in names:
            archive.writestr(name, bytes(400 * MIB) if deflated and name == names[0] else webp(side or 2))


def gltf_with_picture(picture):
    view = struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0)
    return json.dumps({
        "asset": {"version": "2.0"}, "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "material": i} for i in range(len(picture))]}],
        "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": i}}} for i in range(len(picture))],
        "textures": [{"source": i} for i in range(len(picture))],
        "images": [{"uri": "data:image/webp;base64," + base64.b64encode(data).decode()} for data in picture],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": kind} for kind in ("VEC3", "VEC2")],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "buffers": [{"byteLength": 36, "uri": "data:;base64," + base64.b64encode(view).decode()}]}).encode()


def obj_with_pictures(path, count, side):
    """A triangle for each of some pictures of one colour, in files."""
    faces = "".join(f"usemtl m{i}\nf 1/1 2/2 3/3\n" for i in range(count))
    write(path, f"mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\n{faces}".encode())
    write("m.mtl", "".join(f"newmtl m{i}\nmap_Kd p{i}.webp\n" for i in range(count)).encode())
    for i in range(count):
        write(f"p{i}.webp", webp(side + i))


def las(count):
    """A header that says how many points there are, and one of them."""
    head = bytearray(375 + 30)
    head[0:4] = b"LASF"
    head[24:26] = b"\1\4"
    struct.pack_into("<HII", head, 94, 375, 375, 0)
    head[104] = 6
    struct.pack_into("<H", head, 105, 30)
    struct.pack_into("<6d", head, 131, 0.01, 0.01, 0.01, 0, 0, 0)
    struct.pack_into("<Q", head, 247, count)
    return bytes(head)


def ept(points):
    os.makedirs("tree/ept-hierarchy")
    os.makedirs("tree/ept-data")
    dims = [{"name": name, "type": "float", "size": 8} for name in "XYZ"]
    with open("tree/ept.json", "w") as file:
        json.dump({"version": "1.1.0", "dataType": "binary", "hierarchyType": "json", "points": 1, "span": 128,
                   "bounds": [0, 0, 0, 1, 1, 1], "boundsConforming": [0, 0, 0, 1, 1, 1], "schema": dims}, file)
    with open("tree/ept-hierarchy/0-0-0-0.json", "w") as file:
        file.write('{"0-0-0-0":1' + "".join(f',"20-{i}-0-0":1' for i in range(points)) + "}")
    write("tree/ept-data/0-0-0-0.bin", struct.pack("<3d", 0.5, 0.5, 0.5))


def vtk_xml(path, compressor, pack, blocks, block_bytes):
    """Points of zeros, packed in blocks."""
    one = pack(bytes(block_bytes))
    head = struct.pack(f"<{3 + blocks}Q", blocks, block_bytes, 0, *[len(one)] * blocks)
    text = (f'<VTKFile type="PolyData" version="1.0" byte_order="LittleEndian" header_type="UInt64" compressor="{compressor}"><PolyData>'
            f'<Piece NumberOfPoints="{blocks * block_bytes // 12}"><Points><DataArray type="Float32" NumberOfComponents="3" format="binary">')
    write(path, text.encode() + base64.b64encode(head) + base64.b64encode(one * blocks) + b"</DataArray></Points></Piece></PolyData></VTKFile>")


def exr(path, side, compression):
    """The header of a picture of three halves, and no pixels of it."""
    def attribute(name, kind, data):
        return name + b"\0" + kind + b"\0" + struct.pack("<i", len(data)) + data
    channels = b"".join(name + b"\0" + struct.pack("<iBBBBii", 1, 0, 0, 0, 0, 1, 1) for name in (b"B", b"G", b"R")) + b"\0"
    window = struct.pack("<4i", 0, 0, side - 1, side - 1)
    write(path, b"\x76\x2f\x31\x01\2\0\0\0" + attribute(b"channels", b"chlist", channels) +
          attribute(b"compression", b"compression", bytes([compression])) + attribute(b"dataWindow", b"box2i", window) +
          attribute(b"displayWindow", b"box2i", window) + attribute(b"lineOrder", b"lineOrder", b"\0") +
          attribute(b"pixelAspectRatio", b"float", struct.pack("<f", 1)) + attribute(b"screenWindowCenter", b"v2f", bytes(8)) +
          attribute(b"screenWindowWidth", b"float", struct.pack("<f", 1)) + b"\0" + bytes(8000))


def streamed_sog(path, nodes):
    """A tree of many leaves that are all of one file."""
    leaf = '{"bound":{"min":[0,0,0],"max":[1,1,1]},"lods":{"0":{"file":0,"offset":0,"count":1}}}'
    write(path, ('{"lodLevels":1,"filenames":["0/meta.json"],"tree":{"bound":{"min":[0,0,0],"max":[1,1,1]},"children":[' +
                 ",".join([leaf] * nodes) + "]}}").encode())


def photographs(path, count):
    """Many photographs of Metashape, of one sensor."""
    one = '<camera id="{0}" sensor_id="0" label="a{0}"><transform>1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1</transform></camera>'
    write(path, ('<document version="1.5"><chunk><sensors><sensor id="0" type="frame"><resolution width="10" height="10"/>'
                 '<calibration class="adjusted"><f>10</f></calibration></sensor></sensors><cameras>' +
                 "".join(one.format(i) for i in range(count)) + "</cameras></chunk></document>").encode())


def bombs():
    """Small files that are much in memory, or say so."""
    write("a.webp", webp(16383))
    write("bits.png", png(30000, 1, 0))
    write("deep.png", png(9000, 16, 6))
    write("half.jpg", jpeg_head(30000))
    sog("few.sog", 3, 16383)
    sog("many.sog", 16383 * 16383, 16383)
    sog("packed.sog", 3, 0, deflated=True)
    write("one.gltf", gltf_with_picture([webp(16383)]))
    write("twenty.gltf", gltf_with_picture([webp(3000 + i) for i in range(20)]))
    write("zeros.spz", zeros(300 * MIB, 31))
    write("said.spz", zlib_gzip(struct.pack("<IIIBBBB", 0x5053474e, 2, 30000000, 3, 12, 0, 0) + bytes(16)))
    write("tree.gltf", b'{"asset":{"version":"2.0"},"extras":[' + b"1," * 8000000 + b"1]}")
    write("strings.gltf", b'{"asset":{"version":"2.0"},"extras":[' + b'"",' * 5000000 + b"1]}")
    write("path.json", b'{"camera_path":[' + b"{}," * 5000000 + b"{}]}")
    write("scene.json", b'{"ewa_scene":1,"items":[' + b"{}," * 3000000 + b"{}]}")
    write("huge.nrrd", b"NRRD0004\ntype: uint8\ndimension: 3\nsizes: 1000 1000 400\nencoding: gzip\n\n" + zeros(400 * 1000 * 1000, 31))
    write("said.las", las(4000000000))
    write("said.ply", b"ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\nproperty float x\nproperty float y\n"
                      b"property float z\nend_header\n" + bytes(36))
    write("said.pcd", b"VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 100000000\nHEIGHT 1\nPOINTS 100000000\n"
                      b"DATA binary_compressed\n" + struct.pack("<II", 8, 1200000000) + bytes(8))
    write("wide.xyz", b"0 0 0\n" * 10 + b"1 " * 3000000)
    write("lines.obj", b"v 0 0 0\n" * 3 + b"f 1 2 3\n" * 1500000)
    write("corners.obj", b"v 0 0 0\n" * 3 + b"f" + b" 1 2 3" * 1000000)
    ept(1000000)
    vtk_xml("zlib.vtp", "vtkZLibDataCompressor", lambda data: zlib.compress(data, 9), 100, 12 * MIB)
    vtk_xml("lzma.vtp", "vtkLZMADataCompressor", lzma.compress, 100, 12 * MIB)
    for name, compression in (("scanlines.exr", 0), ("zip.exr", 3), ("dwa.exr", 8)):
        exr(name, 30000, compression)
    streamed_sog("lod-meta.json", 500000)
    photographs("cameras.xml", 400000)
    write("corner.ply", b"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nend_header\n"
                        b"0 0 0\n1 0 0\n0 1 0\n")
    wrong = []
    for words, name in [(["texture", name, "-o", "out.png", "--size", "16x16"], name) for name in
                        ("a.webp", "bits.png", "deep.png", "half.jpg", "scanlines.exr", "zip.exr", "dwa.exr")] + [
            (["info", name], name) for name in ("few.sog", "many.sog", "packed.sog", "zeros.spz", "said.spz", "tree.gltf",
                                                "strings.gltf", "said.las", "said.ply", "said.pcd", "wide.xyz", "lines.obj",
                                                "corners.obj", "tree", "huge.nrrd", "zlib.vtp", "lzma.vtp", "lod-meta.json")] + [
            (["sample", "one.gltf", "-n", "20", "-o", "out.ply"], "one.gltf"),
            (["sample", "twenty.gltf", "-n", "20", "-o", "out.ply"], "twenty.gltf"),
            (["convert", "said.las", "-o", "out.ply"], "said.las"), (["convert", "tree", "-o", "out.ply"], "tree"),
            (["convert", "many.sog", "-o", "out.ply"], "many.sog"), (["volume", "huge.nrrd", "-o", "out.png", "--size", "64x64"], "huge.nrrd"),
            (["render", "scene.json", "-o", "out.png", "--size", "64x64"], "scene.json"),
            (["render", "said.ply", "--camera", "path.json", "-o", "out.png", "--size", "64x64"], "path.json"),
            (["render", "corner.ply", "--camera", "cameras.xml", "-o", "out.png", "--size", "64x64"], "cameras.xml")]:
        try:
            held(words, [name])
        except Exception as failure:
            wrong.append(str(failure))
    check(not wrong, "\n  ".join(wrong))


def jpeg_head(side):
    """The beginning of a progressive picture, which a decoder keeps all coefficients for."""
    quant = b"\xff\xdb" + struct.pack(">HB", 67, 0) + bytes([1] * 64)
    frame = b"\xff\xc2" + struct.pack(">HBHHB", 17, 8, side, side, 3) + b"\1\x11\0\2\x11\0\3\x11\0"
    table = b"\xff\xc4" + struct.pack(">HB", 20, 0) + bytes([1] + [0] * 15) + b"\0"
    scan = b"\xff\xda" + struct.pack(">HB", 12, 3) + b"\1\0\2\0\3\0" + b"\0\0\0"
    return b"\xff\xd8" + quant + frame + table + scan + bytes(64) + b"\xff\xd9"


def zlib_gzip(data):
    packer = zlib.compressobj(9, zlib.DEFLATED, 31)
    return packer.compress(data) + packer.flush()


def grid(path, side):
    """An OBJ of side x side corners."""
    text = io.StringIO()
    for y in range(side):
        for x in range(side):
            text.write(f"v {x} {y} {x * y % 7}\n")
    for y in range(side - 1):
        for x in range(side - 1):
            first = y * side + x + 1
            text.write(f"f {first} {first + 1} {first + side + 1} {first + side}\n")
    write(path, text.getvalue().encode())


def large_files():
    """Ordinary files that need more than the limit are refused; by a limit that they fit in, they are read."""
    done("generate", "terrain", "-n", "1500000", "-o", "a.ply")
    for suffix in ("laz", "pcd", "xyz", "copc.laz"):
        done("lod" if suffix == "copc.laz" else "convert", "a.ply", "-o", "a." + suffix)
    done("generate", "ball", "--dims", "300,300,300", "-o", "a.nrrd")
    write("a.png", png(7000, 8, 2))
    grid("a.obj", 500)
    write("g.splat", b"".join(struct.pack("<6f8B", i % 1000, i // 1000, 0, 0.1, 0.1, 0.1, 200, 100, 50, 255, 128, 0, 0, 255)
                              for i in range(1000000)))
    wrong = []
    for words, name, enough in [
            (["info", "a.ply"], "a.ply", True), (["convert", "a.ply", "-o", "out.laz"], "a.ply", True),
            (["convert", "a.laz", "-o", "out.ply"], "a.laz", True), (["convert", "a.pcd", "-o", "out.ply"], "a.pcd", True),
            (["convert", "a.xyz", "-o", "out.ply"], "a.xyz", True), (["convert", "a.copc.laz", "-o", "out.ply"], "a.copc.laz", True),
            (["convert", "a.laz", "--voxel", "0.01", "-o", "out.ply"], "a.laz", False),
            (["convert", "a.laz", "--min-distance", "0.01", "-o", "out.ply"], "a.laz", False),
            (["surfels", "a.laz", "-o", "out.ply"], "a.laz", False), (["features", "a.laz", "-o", "out.ply"], "a.laz", False),
            (["render", "a.laz", "-o", "out.png", "--size", "640x480"], "a.laz", False),
            (["render", "a.copc.laz", "-o", "out.png", "--size", "640x480"], "a.copc.laz", False),
            (["lod", "a.laz", "-o", "out.copc.laz"], "a.laz", False),
            (["volume", "a.nrrd", "-o", "out.png", "--size", "640x480"], "a.nrrd", True),
            (["info", "a.nrrd"], "a.nrrd", True),
            (["texture", "a.png", "-o", "out.png", "--size", "64x64"], "a.png", False),
            (["sample", "a.obj", "-n", "500000", "-o", "out.ply"], "a.obj", False),
            (["render", "a.obj", "-o", "out.png", "--size", "640x480"], "a.obj", False),
            (["info", "g.splat"], "g.splat", False), (["render", "g.splat", "-o", "out.png", "--size", "640x480"], "g.splat", False),
            (["convert", "g.splat", "-o", "out.ply"], "g.splat", False)]:
        try:
            passed = held(words, [name])
            check(not enough or passed, f"{' '.join(words)}: refused by {LIMITS_MIB[-1]} MiB")
        except Exception as failure:
            wrong.append(str(failure))
    check(not wrong, "\n  ".join(wrong))


def defaults():
    """Without a limit small files unpack to 1 GiB at most, whatever the machine has."""
    write("a.webp", webp(16383))
    sog("few.sog", 3, 16383)
    sog("many.sog", 16383 * 16383, 16383)
    sog("packed.sog", 3, 0, deflated=True)
    write("twenty.gltf", gltf_with_picture([webp(3000 + i) for i in range(20)]))
    obj_with_pictures("twenty.obj", 20, 3000)
    write("tree.gltf", b'{"asset":{"version":"2.0"},"extras":[' + b"1," * 28000000 + b"1]}")
    wrong = []
    for words in (["texture", "a.webp", "-o", "out.png", "--size", "16x16"], ["info", "few.sog"], ["info", "many.sog"],
                  ["info", "packed.sog"], ["sample", "twenty.gltf", "-n", "20", "-o", "out.ply"], ["info", "twenty.obj"],
                  ["sample", "twenty.obj", "-n", "20", "-o", "out.ply"], ["info", "tree.gltf"]):
        result = run(*words)
        # Pictures of a mesh are so much together. While points get colours, smaller copies are held too: 16/3 bytes for each
        # pixel, which has 12.
        allowed = 1024 * 13 / 9 if words[1].startswith("twenty") else 1024
        if result.peak_bytes > (allowed + SLACK_MIB) * MIB + size_of(words[1]):
            wrong.append(f"{' '.join(words)}: {result.peak_bytes / MIB:.0f} MiB")
        if words[1].startswith("twenty"):
            # The first are there, the others are left out with a warning.
            check(result.status == 0 and "do not explain" in result.err, f"{' '.join(words)}: {result.status}: {result.err[-300:]}")
    check(not wrong, "\n  ".join(wrong))


if __name__ == "__main__":
    main([bombs, large_files, defaults])
