# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Odd files, names, folders and outputs: a message and status 1 or 2, or the work done; never a signal, never half a file."""

import json
import os
import struct
import threading
import zlib

from hostile import check, done, listing, main, refused, run

POINT = (b"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nend_header\n"
         b"0 0 0\n1 0 0\n0 1 0\n")


def write(path, data):
    with open(path, "wb") as file:
        file.write(data)


def odd_names():
    """Any bytes but / and zero are a name; JSON is JSON whatever they are."""
    for name in (b"caf\xe9.ply", b"new\nline.ply", b"-dash.ply", b"\xff\xfe.ply", b"\xed\xa0\x80.ply", "schön 日本.ply".encode(),
                 b'quote".ply', b"%d%s%n.ply", b"a" * 250 + b".ply"):
        write(name, POINT)
        path = b"./" + name
        result = done("info", "--json", os.fsdecode(path))
        json.loads(result.out.decode("utf-8"))
        done("convert", os.fsdecode(path), "-o", "out.xyz")
        done("convert", "out.xyz", "-o", os.fsdecode(b"./out-" + name[:200] + b".ply"))


def empty_and_short():
    """Beginnings of every format, and nothing at all, under every suffix."""
    for suffix in ("ply las laz pcd e57 xyz pts ptx csv obj stl off gltf glb splat spz ksplat sog nrrd nii mha vtk json copc.laz"
                   ).split():
        for data in (b"", b"\0", b"ply\n", b"LASF" + bytes(400), b"glTF" + bytes(40), b"PK\3\4" + bytes(40), b"\x1f\x8b\x08" + bytes(30),
                     b"{" * 2000, b"[" * 2000, b"\xff" * 300):
            write("in." + suffix, data)
            result = run("info", "in." + suffix)
            check(result.status in (0, 1, 2), f"{suffix} {data[:8]}: status {result.status}: {result.err[-200:]}")


def deep_nesting():
    """A million brackets are no stack overflow."""
    for name, data in (("a.gltf", b'{"a":' * 1000000), ("b.json", b"[" * 1000000), ("c.gltf", b'{"asset":{"version":"2.0"},"x":' + b"[" * 500000),
                       ("d.ply", b"ply\n" + b"comment x\n" * 500000)):
        write(name, data)
        refused("info", name)


def zip_bomb():
    """A gzip of zeros is not unpacked to find out that it is nothing."""
    deflated = zlib.compressobj(9, zlib.DEFLATED, 31)
    block = bytes(1 << 20)
    data = b"".join(deflated.compress(block) for _ in range(300)) + deflated.flush()
    write("bomb.spz", data)
    result = refused("info", "bomb.spz")
    check(result.peak_bytes < 1 << 30, f"{result.peak_bytes >> 20} MB for {len(data) >> 10} KB")


def devices_and_folders():
    """Devices are read and written as what they are; a folder is none."""
    write("a.ply", POINT)
    os.mkdir("folder.ply")
    refused("info", "folder.ply")
    refused("info", "/dev/null")
    refused("convert", "a.ply", "-o", "folder.ply")
    refused("convert", "a.ply", "-o", "none/out.ply")
    refused("convert", "a.ply", "-o", "/dev/full")
    check(os.path.exists("/dev/full"), "replaced a device")


def links():
    """A link is written through; one that leads nowhere is refused and stays."""
    write("a.ply", POINT)
    write("real.ply", b"old")
    os.symlink("real.ply", "link.ply")
    done("convert", "a.ply", "-o", "link.ply")
    check(os.path.islink("link.ply") and os.path.getsize("real.ply") > 100, "the link was replaced")
    os.symlink("nowhere.ply", "dangling.ply")
    os.symlink("loop.ply", "loop.ply")
    for name in ("dangling.ply", "loop.ply"):
        refused("convert", "a.ply", "-o", name)
        check(os.path.islink(name), f"{name} was replaced")
    refused("generate", "sphere", "-o", "dangling.ply")
    refused("lod", "a.ply", "-o", "out.copc.laz", "--stats", "dangling.ply")
    os.remove("out.copc.laz") if os.path.exists("out.copc.laz") else None
    refused("render", "a.ply", "-o", "dangling.ply")
    check(not os.path.exists("nowhere.ply"), "a file where a link chose")


def comma_locale():
    """Numbers have points in every language."""
    write("a.ply", POINT)
    plain = done("convert", "a.ply", "--translate", "0.5,0.25,0", "-o", "one.xyz", env={"LC_ALL": "C"})
    done("convert", "a.ply", "--translate", "0.5,0.25,0", "-o", "two.xyz", env={"LC_ALL": "de_DE.UTF-8", "LANG": "de_DE.UTF-8"})
    with open("one.xyz", "rb") as one, open("two.xyz", "rb") as two:
        check(one.read() == two.read() and plain.status == 0, "another language, other numbers")


def two_writers():
    """Of two that write one output, one wins, whole."""
    done("generate", "sphere", "-n", "50000", "-o", "a.ply")
    done("generate", "sphere", "-n", "60000", "-o", "b.ply")
    for _ in range(4):
        writers = [threading.Thread(target=done, args=("convert", name, "-o", "out.laz")) for name in ("a.ply", "b.ply")]
        for writer in writers:
            writer.start()
        for writer in writers:
            writer.join()
        done("info", "out.laz")
    done("convert", "a.ply", "-o", "a.ply")
    done("info", "a.ply")
    check(sorted(listing(".")) == ["a.ply", "b.ply", "out.laz"], f"left {sorted(listing('.'))}")


def scales():
    """Needles and 35 decades of scale in small meshes are drawn in seconds, or refused."""
    triangle = struct.Struct("<12fH")
    spike, decades = b"", b""
    for i in range(200):
        x, scale = i / 200, 10 ** (-17 + 35 * i / 200)
        spike += triangle.pack(0, 0, 0, x, 0, 0, x + 0.01, 0, 1, 1e33 if i == 50 else x, 1, 0, 0)
        decades += triangle.pack(0, 0, 0, scale, 0, 0, 0, scale, 0, 0, 0, scale, 0)
    for name, triangles in (("spike.stl", spike), ("decades.stl", decades)):
        write(name, bytes(80) + struct.pack("<I", 200) + triangles)
        result = run("render", name, "-o", "out.png", "--size", "640x480", timeout_s=30)
        check(result.status in (0, 1), f"{name}: status {result.status}")


if __name__ == "__main__":
    main([odd_names, empty_and_short, deep_nesting, zip_bomb, devices_and_folders, links, comma_locale, two_writers, scales])
