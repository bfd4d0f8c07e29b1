# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# usage: ply.py EWA DATA
#
# LAS files that ewa turns into PLY, read by plyfile, hold what laspy reads of them: every coordinate to the last bit
# of the nearest double, intensities, classes, times.
import os
import subprocess
import sys
import tempfile

import laspy
import numpy
import plyfile

ewa, data = sys.argv[1:3]
names = {"intensity": "intensity", "classification": "classification", "gps_time": "gps_time", "user_data": "user_data",
         "point_source_id": "point_source_id", "return_number": "return_number"}
failed = 0
with tempfile.TemporaryDirectory() as folder:
    for name in ("simple.las", "autzen_trim.las", "test1_4.las", "extrabytes.las", "simple1_4.las"):
        path = os.path.join(data, "clouds", "las", name)
        las = laspy.read(path)
        for encoding in ([], ["--ascii"], ["--big-endian"]):
            out = os.path.join(folder, "out.ply")
            subprocess.run([ewa, "convert", path, "-o", out, "--quiet", *encoding], check=True)
            vertex = plyfile.PlyData.read(out)["vertex"]
            problems = []
            for axis, letter in enumerate("xyz"):
                step, offset = las.header.scales[axis], las.header.offsets[axis]
                wanted, digits = las[letter.upper()] * step + offset, max(0, round(-numpy.log10(step)))
                if abs(step * 10**digits - 1) < 1e-12:
                    # The decimal that the integer stands for, by way of text: the sum of doubles is not the nearest.
                    wanted = numpy.array([float(f"{v:.{digits}f}") for v in wanted])
                    same = numpy.array_equal(wanted, vertex[letter])
                else:
                    same = numpy.allclose(wanted, vertex[letter], rtol=3e-16, atol=0)
                if not same:
                    problems.append(f"{letter}: {numpy.abs(wanted - vertex[letter]).max()} off")
            for ours, theirs in names.items():
                if theirs in las.point_format.dimension_names and not numpy.array_equal(vertex[ours], las[theirs]):
                    problems.append(ours)
            failed += bool(problems)
            print(f"{name} {' '.join(encoding) or 'binary'}: {len(las.points)} points", "; ".join(problems) or "equal")
sys.exit(failed > 0)
