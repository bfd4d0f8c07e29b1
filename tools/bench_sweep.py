#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Measures frames over numbers of splats and sizes of the picture; prints the slopes.

    tools/bench_sweep.py build/release/cli/ewa build/sweep.csv [--page docs/performance.md] [--prefix "chrt -f 50"]

The CSV file is for tools/bench_sweep.gnuplot. Series: "9 px": splats of 9 pixels; "closed": splats as large as it takes
to close a plane that fills the picture.
"""
import argparse
import csv
import json
import math
import re
import shlex
import subprocess
import tempfile

SPLATS = ["1e4", "3e4", "1e5", "3e5", "1e6", "3e6", "1e7", "3e7"]
SIZES = ["256x256", "512x512", "1024x1024", "1280x1024", "1920x1080", "2560x1440", "3840x2160"]
STANDARD = "1280x1024"
SERIES = {"9 px": "9", "closed": "0"}


def measure(prefix, program, rounds, *options):
    """Results for one and two threads of the quietest of some runs."""
    runs = []
    for _ in range(rounds):
        with tempfile.NamedTemporaryFile(suffix=".json") as file:
            subprocess.run([*prefix, program, "bench", "--scene", "plane", "--stages", "off", "--workers", "1,2",
                            *options, "--json", file.name], check=True)
            runs.append(json.load(open(file.name, encoding="utf-8"))["results"])
    return min(runs, key=lambda run: sum(row["median_ms"] for row in run))


def linear_fit(points):
    """Least relative squares of y = a + b x."""
    weights = [1 / y**2 for _, y in points]
    w = sum(weights)
    x0 = sum(k * x for k, (x, _) in zip(weights, points)) / w
    y0 = sum(k * y for k, (_, y) in zip(weights, points)) / w
    b = (sum(k * (x - x0) * (y - y0) for k, (x, y) in zip(weights, points)) /
         sum(k * (x - x0)**2 for k, (x, _) in zip(weights, points)))
    return y0 - b * x0, b


def exponent(points):
    """Slope of log y over log x."""
    logs = [(math.log(x), math.log(y)) for x, y in points]
    x0, y0 = (sum(column) / len(logs) for column in zip(*logs))
    return sum((x - x0) * (y - y0) for x, y in logs) / sum((x - x0)**2 for x, _ in logs)


def fits(rows):
    """Lines of a table: time over splats at the standard size, over pixels for a million splats."""
    yield "| series | fixed | 2 threads, ms | exponent, whole range | exponent, upper half |"
    yield "|---|---|---|---|---|"
    for name in SERIES:
        for over, fixed, unit in (("splats", STANDARD, "splat"), ("pixels", "1 M splats", "pixel")):
            chosen = [r for r in rows if r["series"] == name and
                      (r["size"] == STANDARD if over == "splats" else r["splats"] == 1e6)]
            points = sorted((r[over], r["two_threads_ms"]) for r in chosen)
            a, b = linear_fit(points)
            yield (f"| {name} | {fixed} | {a:.2f} + {1e6 * b:.2f} ns per {unit} | {exponent(points):.2f} | "
                   f"{exponent(points[len(points) // 2:]):.2f} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("output")
    parser.add_argument("--prefix", default="")
    parser.add_argument("--page", help="page to write the slopes into, between <!-- table sweep --> and <!-- end -->")
    parser.add_argument("--frames", default="9")
    parser.add_argument("--rounds", type=int, default=2, help="runs of each point; the quietest counts")
    arguments = parser.parse_args()
    prefix = shlex.split(arguments.prefix)
    rows = []
    for name, pixels in SERIES.items():
        for splats, size in [(n, STANDARD) for n in SPLATS] + [("1e6", s) for s in SIZES if s != STANDARD]:
            one, two = measure(prefix, arguments.program, arguments.rounds, "--splats", splats, "--pixels", pixels,
                               "--size", size, "--frames", arguments.frames)
            rows.append({"series": name, "size": size, "splats": two["splats"],
                         "pixels": two["width"] * two["height"], "covered_px": round(two["covered_px"], 2),
                         "one_thread_ms": round(one["lower_quartile_ms"], 4),
                         "two_threads_ms": round(two["lower_quartile_ms"], 4)})
    with open(arguments.output, "w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, rows[0], lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    lines = "\n".join(fits(rows))
    print(lines)
    if arguments.page:
        page = open(arguments.page, encoding="utf-8").read()
        page = re.sub(r"(<!-- table sweep -->\n).*?(<!-- end -->)", lambda found: f"{found[1]}\n{lines}\n\n{found[2]}",
                      page, flags=re.DOTALL)
        with open(arguments.page, "w", encoding="utf-8") as file:
            file.write(page)


main()
