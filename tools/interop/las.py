#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Holds ewa's LAS and LAZ to laspy's, value by value, for all point formats: files of laspy (with lazrs and
with laszip) read by ewa, and files of ewa read by laspy with both.

Usage: las.py EWA [FOLDER WITH LAS AND LAZ FILES]
Needs laspy, lazrs, laszip, numpy.
"""
import pathlib
import subprocess
import sys
import tempfile

import laspy
import numpy as np

BACKENDS = {"lazrs": laspy.LazBackend.Lazrs, "laszip": laspy.LazBackend.Laszip}
TYPES = {"char": "i1", "uchar": "u1", "short": "i2", "ushort": "u2", "int": "i4", "uint": "u4", "float": "f4",
         "double": "f8"}
# Names of ewa and of laspy where they differ; the flags are "class flags" in newer formats.
NAMES = {"number_of_returns": "number_of_returns", "wave_packet_descriptor": "wavepacket_index",
         "wave_packet_offset": "wavepacket_offset", "wave_packet_size": "wavepacket_size",
         "wave_return_location": "return_point_wave_location", "wave_x_t": "x_t", "wave_y_t": "y_t",
         "wave_z_t": "z_t"}


def read_ply(path):
    """Returns the columns of a binary PLY file by name."""
    data = path.read_bytes()
    head, body = data.split(b"end_header\n", 1)
    count, fields, ours = 0, [], False
    for line in head.decode().splitlines():
        words = line.split()
        if words[0] == "element":
            ours = words[1] == "vertex"
            count = int(words[2]) if ours else count
        elif words[0] == "property" and ours:
            fields.append((words[2], "<" + TYPES[words[1]]))
    return np.frombuffer(body, dtype=fields, count=count)


def ewa(program, *words):
    subprocess.run([program, *map(str, words)], check=True, stdout=subprocess.DEVNULL)


def require(holds, what):
    if not holds:
        sys.exit(f"does not hold: {what}")


def equal(a, b):
    a, b = np.asarray(a, dtype="f8"), np.asarray(b, dtype="f8")
    return a.shape == b.shape and bool(np.all((a == b) | (np.isnan(a) & np.isnan(b))))


def compare_read(las, ply, what):
    """Values that ewa read to what laspy read."""
    require(len(ply) == len(las.points), f"{what}: {len(ply)} points of {len(las.points)}")
    names = set(ply.dtype.names)
    for axis, whole in zip("xyz", (las.X, las.Y, las.Z)):
        index = "xyz".index(axis)
        world = whole * las.header.scales[index] + las.header.offsets[index]
        step = las.header.scales[index]
        require(np.all(np.rint((ply[axis] - las.header.offsets[index]) / step) == whole) and
                np.allclose(ply[axis], world, rtol=1e-15, atol=step * 1e-3), f"{what}: {axis}")
    for name in ("intensity", "return_number", "number_of_returns", "scan_direction_flag", "edge_of_flight_line",
                 "classification", "synthetic", "key_point", "withheld", "overlap", "scanner_channel", "user_data",
                 "point_source_id", "gps_time", "nir", *NAMES):
        theirs = NAMES.get(name, name)
        there = theirs in set(las.point_format.dimension_names)
        require(there == (name in names), f"{what}: {name}: {there}, {name in names}")
        if there:
            require(equal(ply[name], las[theirs]), f"{what}: {name}")
    if las.point_format.id >= 6:
        require(equal(ply["scan_angle"], (las.scan_angle * 0.006).astype("f4")), f"{what}: scan_angle")
    else:
        require(equal(ply["scan_angle"], las.scan_angle_rank), f"{what}: scan_angle")
    if "red" in set(las.point_format.dimension_names):
        colors = np.stack([las.red, las.green, las.blue], axis=1)
        if not colors.any():
            require("red" not in names, f"{what}: colours that are all 0")
        else:
            ours = np.stack([ply["red"], ply["green"], ply["blue"]], axis=1)
            if ours.dtype == np.uint8 and colors.max() > 255:
                colors = colors // 257
            require(equal(ours, colors), f"{what}: colours")
    for dimension in las.point_format.extra_dimensions:
        if dimension.name == "ExtraBytes":
            continue
        values = np.asarray(las[dimension.name])
        if values.ndim == 1 and dimension.name in names:
            require(equal(ply[dimension.name], values), f"{what}: {dimension.name}")


def compare_files(a, b, what):
    """Two files as laspy reads them."""
    require(len(a.points) == len(b.points), f"{what}: points")
    for axis in "XYZ":
        require(equal(a[axis], b[axis]), f"{what}: {axis}")
    require(equal(a.header.scales, b.header.scales) and equal(a.header.offsets, b.header.offsets), f"{what}: grid")
    theirs = set(b.point_format.dimension_names)
    for name in a.point_format.dimension_names:
        if name in ("X", "Y", "Z", "ExtraBytes"):
            continue
        other = {v: k for k, v in NAMES.items()}.get(name, name)
        other = name if name in theirs else other
        first = np.asarray(a[name])
        if other not in theirs:
            if name == "scan_angle_rank":
                require(equal(first, np.rint(b["scan_angle"] * 0.006)), f"{what}: {name}")
            elif name in ("red", "green", "blue"):
                require(not first.any(), f"{what}: {name} is lost")
            else:
                require(False, f"{what}: {name} is lost")
            continue
        second = np.asarray(b[other])
        if name in ("red", "green", "blue") and not equal(first, second):
            require(equal(first.astype("u4") * 257, second), f"{what}: {name}")
        else:
            require(equal(first, second), f"{what}: {name}")
    require(equal(a.header.mins, [b.x.min(), b.y.min(), b.z.min()]) or
            np.allclose(b.header.mins, [b.x.min(), b.y.min(), b.z.min()]), f"{what}: bounds")


def make(point_format, count, random):
    """A file with every dimension set."""
    header = laspy.LasHeader(point_format=point_format, version="1.4" if point_format >= 6 else
                             "1.3" if point_format in (4, 5) else "1.2")
    header.scales, header.offsets = [0.001, 0.01, 0.0001], [432000.0, 5200000.0, 0.0]
    kinds = ("u1", "i1", "u2", "i2", "u4", "i4", "f4", "f8")
    header.add_extra_dims([laspy.ExtraBytesParams(name=f"extra {kind}", type=kind) for kind in kinds])
    las = laspy.LasData(header)
    walk = random.integers(-300, 300, (3, count)).cumsum(axis=1)
    las.X, las.Y, las.Z = walk
    for name in las.point_format.dimension_names:
        if name in "XYZ":
            continue
        dtype = las[name].dtype
        bits = las.point_format.dimension_by_name(name).num_bits
        if dtype.kind == "f":
            las[name] = (3e5 + np.arange(count) * 0.01 + random.random(count)).astype(dtype)
        elif name == "scan_angle_rank":
            las[name] = random.integers(-90, 91, count)
        elif name == "return_number" and point_format < 6:
            las[name] = random.integers(1, 6, count)
        elif name == "number_of_returns" and point_format < 6:
            las[name] = random.integers(1, 6, count)
        else:
            unsigned = dtype.kind == "u" or bits < 8
            high = 1 << min(bits - (0 if unsigned else 1), 40)
            las[name] = random.integers(0 if unsigned else -high, high, count).astype(dtype)
    return las


def round_trip(program, source, folder, what):
    las = laspy.read(source)
    ply = folder / "read.ply"
    ewa(program, "convert", source, "-o", ply)
    compare_read(las, read_ply(ply), f"{what} read")
    for suffix in ("las", "laz"):
        path = folder / f"written.{suffix}"
        ewa(program, "convert", source, "-o", path)
        for name, backend in BACKENDS.items() if suffix == "laz" else [("", None)]:
            back = laspy.read(path, laz_backend=backend) if backend else laspy.read(path)
            compare_files(las, back, f"{what} written as {suffix} {name}")


def main():
    program = sys.argv[1]
    random = np.random.default_rng(7)
    done = 0
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        for point_format in range(11):
            for count in (1, 1000, 120000):
                las = make(point_format, count, random)
                plain = folder / "made.las"
                las.write(plain)
                round_trip(program, plain, folder, f"format {point_format}, {count} points")
                for name, backend in BACKENDS.items():
                    if name == "lazrs" and point_format in (4, 5):
                        continue  # a version of wave packets of its own, which LASzip refuses, too
                    packed = folder / "made.laz"
                    las.write(packed, laz_backend=backend)
                    ply = folder / "read.ply"
                    ewa(program, "convert", packed, "-o", ply)
                    compare_read(laspy.read(packed), read_ply(ply), f"format {point_format}, {count} points, {name}")
                done += 1
        if len(sys.argv) > 2:
            data = pathlib.Path(sys.argv[2])
            for source in sorted(data.rglob("*.la[sz]")):
                if source.stat().st_size > 229:
                    round_trip(program, source, folder, str(source.relative_to(data)))
                    done += 1
    print(f"las: {done} files the same in ewa and laspy {laspy.__version__}")


if __name__ == "__main__":
    main()
