#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Measures everything that docs/performance.md states, into one JSON file.

    tools/bench.py build/release/cli/ewa build/bench.json [--prefix "chrt -f 50"]

The scenes and stages come from `ewa bench`; the whole job is timed here, from the start of a process that reads PLY
to its end with a picture written. --prefix goes before each command, to raise its priority on a busy machine. --against
names a program that draws the scene `peer` in turns with ewa, where there is one.
"""
import argparse
import json
import os
import shlex
import statistics
import subprocess
import tempfile
import time

SCENES = ["plane", "color", "large", "hidden", "points", "culled", "closed,seen", "peer", "layers"]
JOBS = [1_000_000, 10_000_000]


def run_bench(prefix, program, rounds, *options):
    """Runs `ewa bench` some times, shows the tables, returns the JSON of the quietest run."""
    runs = []
    for _ in range(rounds):
        with tempfile.NamedTemporaryFile(suffix=".json") as file:
            subprocess.run([*prefix, program, "bench", *options, "--json", file.name], check=True)
            runs.append(json.load(open(file.name, encoding="utf-8")))
    return min(runs, key=lambda run: sum(row["median_ms"] for row in run["results"]))


def time_process(command):
    """Wall time in seconds and largest resident memory in bytes of one process."""
    started = time.monotonic()
    process = subprocess.Popen(command)
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    took = time.monotonic() - started
    if process.returncode:
        raise subprocess.CalledProcessError(process.returncode, command)
    return took, usage.ru_maxrss * 1024


def time_job(prefix, program, points, runs):
    """The whole job: binary PLY of surfels to a 512 x 512 PNG, a new process each time, the file in the page cache."""
    with tempfile.TemporaryDirectory() as folder:
        cloud, picture, stats = (os.path.join(folder, name) for name in ("sphere.ply", "picture.png", "stats.json"))
        subprocess.run([program, "generate", "sphere", "-n", str(points), "-o", cloud], check=True)
        command = [*prefix, program, "render", cloud, "-o", picture, "--size", "512x512", "--stats", stats]
        times, peaks, stages = [], [], []
        for _ in range(runs + 1):
            took, peak = time_process(command)
            times.append(took)
            peaks.append(peak)
            stages.append(json.load(open(stats, encoding="utf-8"))["wall_s"])
        return {
            "points": points,
            "median_s": statistics.median(times[1:]),
            "lower_quartile_s": sorted(times[1:])[runs // 4],
            "peak_bytes": max(peaks),
            "stage_s": {name: statistics.median(s[name] for s in stages[1:]) for name in stages[0]},
        }


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("output")
    parser.add_argument("--prefix", default="")
    parser.add_argument("--against", default="")
    parser.add_argument("--frames", type=int, default=15)
    parser.add_argument("--rounds", type=int, default=3, help="runs of each scene; the quietest counts")
    arguments = parser.parse_args()
    prefix, program, frames = shlex.split(arguments.prefix), arguments.program, str(arguments.frames)
    rows = []
    for scene in SCENES:
        # What is compared with each other is measured in one run, in turns.
        sets = "all,avx2" if scene == "plane" else "all"
        competitor = ["--against", arguments.against] if scene == "peer" and arguments.against else []
        whole = run_bench(prefix, program, arguments.rounds, "--scene", scene, "--stages", "off", "--cpu", sets,
                          "--frames", frames, *competitor)
        rows += whole["results"]
    last = run_bench(prefix, program, arguments.rounds, "--scene", "plane", "--pixels", "9", "--frames", frames)
    whole["results"] = rows + [row for row in last["results"] if "stage" in row]
    whole["jobs"] = [time_job(prefix, program, points, 9) for points in JOBS]
    for job in whole["jobs"]:
        print(f"whole job, {job['points']:,} surfels: {job['median_s']:.3f} s, {job['peak_bytes'] / 2**20:.0f} MiB")
    with open(arguments.output, "w", encoding="utf-8") as file:
        json.dump(whole, file, indent=1)
        file.write("\n")


main()
