# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# usage: text.py EWA DATA
#
# Clouds of text as numpy.loadtxt reads them, and open3d where it is there: every coordinate the same double. What ewa
# writes, numpy reads back as the numbers of the file it came from.
import os
import subprocess
import sys
import tempfile

import numpy

try:
    import open3d
except ImportError:
    open3d = None

ewa, data = sys.argv[1:3]
files = {
    "simple.xyz": {},
    "bunnyData.pts": {"skiprows": 1},
    "bunny_8.pts": {"skiprows": 1},
    "autzen.pts": {"skiprows": 1},
    "test.pts": {"skiprows": 1},
    "point_cloud_sample1.pts": {"skiprows": 1},
    "point_cloud_sample2.pts": {"skiprows": 1},
    "utm17_1.txt": {"skiprows": 1, "delimiter": ","},
    "crlf_test.txt": {"skiprows": 1, "delimiter": ","},
    "quoted.txt": {"skiprows": 1, "delimiter": ","},
    "largescan.txt": {"skiprows": 1, "delimiter": ","},
}
failed = 0
with tempfile.TemporaryDirectory() as folder:
    for name, how in files.items():
        path = os.path.join(data, "clouds", "text", name)
        wanted = numpy.loadtxt(path, **how)
        problems = []
        for suffix, back in ((".xyz", {"comments": "//"}), (".csv", {"skiprows": 1, "delimiter": ","})):
            out = os.path.join(folder, "out" + suffix)
            subprocess.run([ewa, "convert", path, "-o", out, "--quiet"], check=True)
            got = numpy.loadtxt(out, **back)
            if wanted.shape != got.shape:
                problems.append(f"{suffix}: {got.shape} for {wanted.shape}")
            elif not numpy.array_equal(wanted[:, :3], got[:, :3]):
                problems.append(f"{suffix}: {numpy.abs(wanted[:, :3] - got[:, :3]).max()} off")
            # Colours stand before the intensity in what is written: as sets, the other columns are the same.
            elif not numpy.array_equal(numpy.sort(wanted[:, 3:], axis=1), numpy.sort(got[:, 3:], axis=1)):
                problems.append(f"{suffix}: other columns differ")
            if open3d and suffix == ".xyz":
                points = numpy.asarray(open3d.io.read_point_cloud(out, format="xyz").points)
                if not numpy.array_equal(points, wanted[:, :3]):
                    problems.append("open3d reads other points")
        failed += bool(problems)
        print(f"{name}: {len(wanted)} points", "; ".join(problems) or "equal")
sys.exit(failed > 0)
