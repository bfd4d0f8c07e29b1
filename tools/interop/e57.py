# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# usage: e57.py EWA DATA
#
# E57 files that ewa turns into PLY hold what pye57 (libE57Format) reads of them, and files that pye57 writes with poses
# are read as they were meant. Points that the file says are invalid are left out by ewa.
import glob
import os
import subprocess
import sys
import tempfile

import numpy
import plyfile
import pye57

ewa, data = sys.argv[1:3]
failed = 0


def compare(name, path, folder):
    """Compares all scans of a file; returns how many comparisons failed."""
    out = os.path.join(folder, "out.ply")
    subprocess.run([ewa, "convert", path, "-o", out, "--quiet"], check=True)
    vertex = plyfile.PlyData.read(out)["vertex"]
    places, values = [], {"red": [], "green": [], "blue": [], "intensity": []}
    e57 = pye57.E57(path)
    for index in range(e57.scan_count):
        header, raw = e57.get_header(index), e57.read_scan_raw(index, ignore_unsupported_fields=True)
        if "cartesianX" in raw:
            place = numpy.stack([raw["cartesian" + c].astype("f8") for c in "XYZ"], 1)
            keep = raw.get("cartesianInvalidState", numpy.zeros(len(place))) == 0
        else:
            r, a, e = (raw["spherical" + c] for c in ("Range", "Azimuth", "Elevation"))
            place = numpy.stack([r * numpy.cos(e) * numpy.cos(a), r * numpy.cos(e) * numpy.sin(a), r * numpy.sin(e)], 1)
            keep = raw.get("sphericalInvalidState", numpy.zeros(len(place))) == 0
        if header.has_pose():
            place = place @ header.rotation_matrix.T + header.translation
        places.append(place[keep])
        for ours, theirs in (("red", "colorRed"), ("green", "colorGreen"), ("blue", "colorBlue"), ("intensity", "intensity")):
            if theirs in raw:
                values[ours].append(raw[theirs][keep])
    wanted, got = numpy.concatenate(places), numpy.stack([vertex[c] for c in "xyz"], 1)
    problems = []
    if wanted.shape != got.shape:
        problems.append(f"{len(got)} points instead of {len(wanted)}")
    elif not numpy.allclose(wanted, got, rtol=1e-15, atol=1e-9):
        problems.append(f"positions: {numpy.abs(wanted - got).max()} off")
    else:
        for ours, theirs in values.items():
            if theirs and not numpy.allclose(vertex[ours], numpy.concatenate(theirs), rtol=1e-7, atol=0):
                problems.append(ours)
    print(f"{name}: {len(wanted)} points", "; ".join(problems) or "equal")
    return bool(problems)


with tempfile.TemporaryDirectory() as folder:
    for path in sorted(glob.glob(os.path.join(data, "clouds", "e57", "*.e57"))):
        if os.path.basename(path) != "empty_pc.e57":
            failed += compare(os.path.basename(path), path, folder)
    random = numpy.random.default_rng(1)
    path = os.path.join(folder, "made.e57")
    made = pye57.E57(path, mode="w")
    for scan in range(3):
        count = 70000 + scan
        fields = {"cartesian" + c: random.normal(0, 50, count) for c in "XYZ"}
        fields["intensity"] = random.random(count).astype("f4")
        for color in ("Red", "Green", "Blue"):
            fields["color" + color] = random.integers(0, 256, count).astype("u1")
        turn = random.normal(0, 1, 4)
        made.write_scan_raw(fields, name=f"scan {scan}", rotation=turn / numpy.linalg.norm(turn),
                            translation=numpy.array([500000.25 + scan, 5400000.5, 100 * scan]))
    made.close()
    failed += compare("three scans with poses", path, folder)
sys.exit(failed > 0)
