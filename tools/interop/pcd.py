# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# usage: pcd.py EWA DATA
#
# PCD files that ewa turns into PLY hold what pypcd4 reads of them, and so do the PCD files that ewa makes of them,
# binary and ascii. Points without a place are left out by ewa.
import glob
import os
import subprocess
import sys
import tempfile

import numpy
import plyfile
import pypcd4

ewa, data = sys.argv[1:3]
failed = 0


def read(path):
    """The fields of a PCD file by their names in small letters, without points that have no place."""
    cloud = pypcd4.PointCloud.from_path(path)
    fields = {name.lower(): cloud.pc_data[name].ravel() for name in cloud.fields if name != "_"}
    finite = numpy.isfinite(fields["x"]) & numpy.isfinite(fields["y"]) & numpy.isfinite(fields["z"])
    return {name: values[finite] for name, values in fields.items()}


def colors(fields):
    """Red, green and blue of packed colours."""
    packed = fields.get("rgb", fields.get("rgba"))
    if packed is None:
        return None
    bits = numpy.ascontiguousarray(packed).view("u4") if packed.dtype.itemsize == 4 else packed.astype("u4")
    return numpy.stack([bits >> 16 & 255, bits >> 8 & 255, bits & 255], 1)


with tempfile.TemporaryDirectory() as folder:
    for path in sorted(glob.glob(os.path.join(data, "clouds", "pcd", "*.pcd"))):
        name = os.path.basename(path)
        if name == "utm17_comma.pcd":  # pypcd4 parts numbers by blanks only
            continue
        try:
            wanted = read(path)
        except ValueError as error:
            print(f"{name}: not read by pypcd4: {str(error).splitlines()[0]}")
            continue
        out = os.path.join(folder, "out.ply")
        subprocess.run([ewa, "convert", path, "-o", out, "--quiet"], check=True)
        vertex = plyfile.PlyData.read(out)["vertex"]
        found = {p.name: vertex[p.name] for p in vertex.properties}
        problems = [c for c in "xyz" if not numpy.array_equal(found[c].astype(wanted[c].dtype), wanted[c])]
        packed = colors(wanted)
        if packed is not None and not numpy.array_equal(packed, numpy.stack([found[c] for c in ("red", "green", "blue")], 1)):
            problems.append("colours")
        for theirs, ours in (("normal_x", "nx"), ("normal_y", "ny"), ("normal_z", "nz"), ("curvature", "curvature"),
                             ("intensity", "intensity"), ("gpstime", "gps_time"), ("classification", "classification")):
            if theirs in wanted and not numpy.array_equal(found[ours], wanted[theirs], equal_nan=True):
                problems.append(ours)
        for encoding in ([], ["--ascii"]):
            again = os.path.join(folder, "out.pcd")
            subprocess.run([ewa, "convert", path, "-o", again, "--quiet", *encoding], check=True)
            back = read(again)
            if any(not numpy.array_equal(back[c].astype(wanted[c].dtype), wanted[c]) for c in "xyz"):
                problems.append(f"{encoding}: positions")
            if packed is not None and not numpy.array_equal(colors(back), packed):
                problems.append(f"{encoding}: colours")
        failed += bool(problems)
        print(f"{name}: {len(wanted['x'])} points", "; ".join(problems) or "equal")
sys.exit(failed > 0)
