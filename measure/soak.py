#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Renders again and again, and says whether memory grows, descriptors stay open, or a picture differs (docs/testing.md).

    soak.py python COUNT                    pictures by one process of Python; EWA_LIBRARY says which library
    soak.py program COUNT --program EWA     as many runs of the program
"""
import argparse
import hashlib
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "python"))


def resident_kib():
    return int(next(line for line in open("/proc/self/status", encoding="ascii") if line.startswith("VmRSS")).split()[1])


def by_python(count):
    import ewa
    import numpy

    random = numpy.random.default_rng(1)
    points = random.normal(size=(400, 3))
    points /= numpy.linalg.norm(points, axis=1)[:, None]
    kinds = {"estimated": lambda: ewa.Cloud(points.astype("f4")), "normals": lambda: ewa.Cloud(points, normals=points, colors=abs(points))}
    seen, resident = {}, []
    for i in range(count):
        kind = list(kinds)[i % len(kinds)]
        image = ewa.render(kinds[kind](), size=(48, 36))
        seen.setdefault(kind, set()).add(hashlib.md5(image.rgba8.tobytes()).hexdigest())
        if i % max(1, count // 20) == count // 20 - 1:
            resident.append(resident_kib())
            print(f"{i + 1} pictures: {resident[-1]} KiB, {len(os.listdir('/proc/self/fd'))} descriptors", flush=True)
    return seen, resident


def by_program(count, program):
    seen, resident = {}, []
    with tempfile.TemporaryDirectory() as folder:
        scan, picture = Path(folder, "scan.ply"), Path(folder, "picture.png")
        subprocess.run([program, "generate", "torus", "-n", "1000", "-o", scan], check=True, stdout=subprocess.DEVNULL)
        for i in range(count):
            subprocess.run([program, "render", scan, "-o", picture, "--size", "48x36"], check=True, stdout=subprocess.DEVNULL)
            seen.setdefault("render", set()).add(hashlib.md5(picture.read_bytes()).hexdigest())
            others = sorted(path.name for path in Path(folder).iterdir() if path not in (scan, picture))
            if others:
                sys.exit(f"run {i + 1} left {others}")
            if i % max(1, count // 20) == count // 20 - 1:
                print(f"{i + 1} runs", flush=True)
    return seen, resident


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("how", choices=("python", "program"))
    parser.add_argument("count", type=int)
    parser.add_argument("--program", default="ewa")
    asked = parser.parse_args()
    start = time.monotonic()
    seen, resident = by_python(asked.count) if asked.how == "python" else by_program(asked.count, asked.program)
    print(f"{asked.count} in {time.monotonic() - start:.0f} s; pictures: " + ", ".join(f"{kind} {len(all)}" for kind, all in seen.items()))
    grown = resident[-1] / resident[len(resident) // 2] - 1 if len(resident) > 1 else 0
    if resident:
        print(f"from half way on, memory grew by {100 * grown:.2f} %")
    return any(len(all) > 1 for all in seen.values()) or grown > 0.01


if __name__ == "__main__":
    sys.exit(main())
