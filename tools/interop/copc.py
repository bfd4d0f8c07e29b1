#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Holds COPC files to laspy's reader: header and info record, every node of the hierarchy by its level, and the points of
all nodes, which must be those that laspy and ewa read from the file as LAZ.

Usage: copc.py EWA [FOLDER OR FILES...]
Folders are searched for *.copc.laz. EWA may be "-": then laspy is held to itself alone, which is how files of the writer are
tried that no command makes (build/release/measure/measure_copc FILE POINTS writes one).
Needs laspy, lazrs, numpy; copclib where there is one.
"""
import pathlib
import sys
import tempfile

import laspy
import numpy as np

from las import ewa, read_ply, require

try:
    import copclib
except ImportError:  # it has no wheels for every Python
    copclib = None


def rows(points):
    """The records as they are, in an order that does not depend on where they came from."""
    array = np.ascontiguousarray(points.array)
    return np.sort(array.view(np.dtype((np.void, array.dtype.itemsize))).ravel().view(f"S{array.dtype.itemsize}"))


def count_levels(reader):
    """Points of each level, as the hierarchy leads from cube to cube."""
    counts, level = [], 0
    while sum(counts) < reader.header.point_count and level < 31:
        counts.append(len(reader.query(level=level)))
        level += 1
    return counts


def count_inside(las, box, margin):
    inside = np.ones(len(las.points), bool)
    for k, axis in enumerate("xyz"):
        numbers = np.asarray(las[axis])
        inside &= (numbers >= box.mins[k] - margin[k]) & (numbers <= box.maxs[k] + margin[k])
    return np.count_nonzero(inside)


def check(path, program):
    whole = laspy.read(path)
    with laspy.CopcReader.open(str(path)) as reader:
        info = reader.copc_info
        points = reader.query()
        levels = count_levels(reader)
        box = laspy.copc.Bounds(mins=reader.header.mins, maxs=(reader.header.mins + reader.header.maxs) / 2)
        part = reader.query(bounds=box)
        half = np.asarray(info.center) + info.halfsize
    require(len(points) == len(whole.points) == whole.header.point_count, f"{path.name}: points of all nodes")
    require(sum(levels) == len(points), f"{path.name}: points of all levels, {levels}")
    require(np.array_equal(rows(points), rows(whole.points)), f"{path.name}: the same records by nodes")
    for axis in "xyz":
        require(np.all(np.asarray(whole[axis]) <= half["xyz".index(axis)] + 1e-3), f"{path.name}: points within the root")
    # laspy rounds the box to steps of the coordinates.
    minimum, maximum = (count_inside(whole, box, by * whole.header.scales) for by in (-1, 1))
    require(minimum <= len(part) <= maximum, f"{path.name}: points of a box, {len(part)} of {minimum} to {maximum}")
    if program != "-":
        with tempfile.TemporaryDirectory() as folder:
            ply = pathlib.Path(folder) / "out.ply"
            ewa(program, "convert", path, "-o", ply)
            table = read_ply(ply)
            require(len(table) == len(points), f"{path.name}: points that ewa reads")
            require(np.array_equal(np.sort(table["intensity"]), np.sort(np.asarray(whole.intensity))),
                    f"{path.name}: intensities that ewa reads")
        check_made(path, program)
    if copclib:
        check_copclib(path, len(points))
    print(f"{path.name}: {len(points)} points, levels {levels}, {list(whole.point_format.extra_dimension_names)}")


def check_copclib(path, point_count):
    """copclib refuses files without the bit of well-known text. (Its own boxes of nodes are those of the header's bounds, not of
    the info record's cube, so it finds no points by place in cubes that are larger than the bounds.)"""
    reader = copclib.FileReader(str(path))
    found = sum(len(reader.GetPoints(node)) for node in reader.GetAllNodes())
    require(found == reader.copc_config.las_header.point_count == point_count, f"{path.name}: points of copclib's nodes, {found}")


def check_made(path, program):
    """What ewa makes of the points, and of them without a coordinate system, is what others read."""
    with tempfile.TemporaryDirectory() as folder:
        ply, made = pathlib.Path(folder) / "points.ply", pathlib.Path(folder) / "made.copc.laz"
        ewa(program, "convert", path, "-o", ply)
        for source in (path, ply):
            ewa(program, "lod", source, "-o", made)
            with laspy.CopcReader.open(str(made)) as reader:
                count = len(reader.query())
                require(count == reader.header.point_count, f"{path.name}: points of what is made of {source.suffix}")
                require(reader.header.global_encoding.wkt, f"{path.name}: the bit of well-known text, from {source.suffix}")
            if copclib:
                check_copclib(made, count)


def main():
    program = sys.argv[1]
    paths = []
    for name in sys.argv[2:]:
        path = pathlib.Path(name)
        paths += sorted(path.rglob("*.copc.laz")) if path.is_dir() else [path]
    if not paths:
        print("skipped: no *.copc.laz")
    for path in paths:
        check(path, program)


if __name__ == "__main__":
    main()
