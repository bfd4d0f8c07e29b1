#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Writes the tables of docs/performance.md from what tools/bench.py measured.

    tools/bench_tables.py build/bench.json [docs/performance.md]

With a page, what stands there between <!-- table NAME --> and <!-- end --> is replaced; else all tables are printed.
"""
import json
import re
import sys

STAGES = ["bin", "setup", "visibility", "accumulate", "edges", "resolve"]

# Cycles per splat of the prototype of 2026: discs only, no edges, no far kernels.
PROTOTYPE = {9: [1.7, 20.5, 17.8, 36, None, 4], 25: [1.7, 25, 29.3, 59.5, None, 4], 100: [1.8, 29, 73, 164, None, 4]}

# Goals of the whole job: points: (seconds, MiB).
JOB_GOALS = {1_000_000: (0.10, 150)}
JOB_PEERS = {1_000_000: (0.56, 372)}


def table(heads, rows):
    lines = ["| " + " | ".join(heads) + " |", "|" + "---|" * len(heads)]
    return "\n".join(lines + ["| " + " | ".join(str(cell) for cell in row) + " |" for row in rows])


def figure(number):
    return f"{number:.0f}" if abs(number) >= 100 else f"{number:.1f}" if abs(number) >= 10 else f"{number:.2f}"


def frames_of(data, threads=2, cpu="all"):
    return [row for row in data["results"] if "scene" in row and row["threads"] == threads and row["cpu"] == cpu]


def clock(data):
    scenes = {}
    for row in frames_of(data, 1):
        scenes.setdefault(row["scene"], []).append(row["clock_ghz"])
    return table(list(scenes), [[f"{min(ghz):.2f} to {max(ghz):.2f} GHz" if len(ghz) > 1 else f"{ghz[0]:.2f} GHz"
                                 for ghz in scenes.values()]])


def goals(data):
    rows = []
    for row in data["results"]:
        name = row.get("label") or f"{row['stage']}, {row['items'] / 1e6:.3g} M"
        for goal in row.get("goals", []):
            what = name if goal["figure"] == "median" else f"{name}: {goal['figure']}"
            rows.append([
                what, f"{figure(goal['floor'])} / {figure(goal['target'])} {goal['unit']}", figure(goal["value"]),
                figure(goal["ratio_to_floor"]), figure(goal["ratio_to_target"]), goal["reaches"]])
    for job in data["jobs"]:
        seconds, mebibytes = JOB_GOALS.get(job["points"], (None, None))
        if seconds is None:
            continue
        for what, value, goal, unit in (("seconds", job["median_s"], seconds, "s"),
                                        ("memory", job["peak_bytes"] / 2**20, mebibytes, "MiB")):
            rows.append([f"whole job, {job['points'] / 1e6:.3g} M: {what}", f"- / {figure(goal)} {unit}",
                         figure(value), "-", figure(value / goal), "target" if value <= goal else "nothing"])
    return table(["what", "floor / target", "figure", "of floor", "of target", "reaches"], rows)


def frames(data):
    rows = []
    ones = {row["label"]: row for row in frames_of(data, 1)}
    for row in frames_of(data):
        one = ones[row["label"]]
        rows.append([row["label"], figure(one["median_ms"]), figure(row["median_ms"]), figure(row["lower_quartile_ms"]),
                     figure(row["speedup"]), figure(row["splats_per_s"] / 1e6),
                     f"{100 * row['splats_culled'] / row['splats']:.0f} %",
                     figure(row["splats_drawn"] / row["splats"]), figure(row["fragment_blocks"] / row["splats"])])
    return table(["scene", "1 thread, ms", "2 threads, ms", "lower quartile", "ratio", "M splats/s", "culled whole",
                  "records per splat", "blocks per splat"], rows)


def cycles(data):
    rows = []
    for row in frames_of(data, 1):
        if row["scene"] not in ("plane", "color", "large", "hidden", "points"):
            continue
        spent = [row["cycles_per_splat"][stage] for stage in STAGES]
        rows.append([row["label"], *map(figure, spent), figure(sum(spent))])
        prototype = PROTOTYPE.get(round(row["covered_px"])) if row["scene"] == "plane" else None
        if prototype:
            rows.append(["the prototype", *("-" if c is None else figure(c) for c in prototype),
                         figure(sum(c or 0 for c in prototype))])
    return table(["cycles per splat, 1 thread", *STAGES, "sum"], rows)


def peer(data):
    rows = []
    for row in frames_of(data):
        if "peer_ms" in row:
            rows.append([f"{row['splats'] / 1e6:.3g} M, {row['width']}x{row['height']}", figure(row["peer_ms"]),
                         figure(row["median_ms"]), figure(row["times_faster_than_peer"])])
    return table(["sphere and torus", "best peer, ms", "this, ms", "times faster"], rows)


def against(data):
    rows = []
    for row in frames_of(data):
        if "against" in row:
            rows.append([f"{row['splats'] / 1e6:.3g} M, {row['width']}x{row['height']}", row["against"],
                         figure(row["against_median_ms"]), figure(row["median_ms"]),
                         figure(row["times_faster_than_against"])])
    return table(["sphere and torus", "against", "it, ms", "this, ms", "times faster"], rows)


def closed(data):
    rows = []
    by_name = {row["scene"]: row for row in frames_of(data)}
    for stage in ["frame", *STAGES]:
        pair = [by_name[name]["lower_quartile_ms"] if stage == "frame" else by_name[name]["thread_ms"][stage]
                for name in ("closed", "seen")]
        rows.append([stage if stage == "frame" else f"{stage}, thread time", *map(figure, pair),
                     figure(pair[0] / pair[1])])
    left = 1 - by_name["closed"]["unseen_share"]
    rows.append(["share of the points that is seen", figure(left), "1", figure(left)])
    return table(["ms", "closed", "all seen", "ratio"], rows)


def stages(data):
    rows = []
    by_name = {}
    for row in data["results"]:
        if "stage" in row:
            by_name.setdefault(row["stage"], {})[row["threads"]] = row
    for name, row in by_name.items():
        one, two = row[1], row.get(2, row[1])
        rate = [f"{r['bytes'] / r['median_ms'] / 1e6:.2f} GB/s" if "bytes" in r
                else f"{r['items'] / r['median_ms'] / 1e3:.1f} M/s" for r in (one, two)]
        rows.append([name, figure(one["median_ms"]), figure(two["median_ms"]), *rate])
    return table(["1 M points, 1280x1024 pixels", "1 thread, ms", "2 threads, ms", "rate, 1", "rate, 2"], rows)


def jobs(data):
    rows = []
    for job in data["jobs"]:
        spent = job["stage_s"]
        rest = job["median_s"] - sum(spent[k] for k in ("load", "estimate", "surfels", "render", "write"))
        peer_s, peer_mib = JOB_PEERS.get(job["points"], (None, None))
        rows.append([f"{job['points'] / 1e6:.3g} M", figure(job["median_s"]), f"{job['peak_bytes'] / 2**20:.0f}",
                     *(figure(1e3 * spent[k]) for k in ("load", "surfels", "render", "write")), figure(1e3 * rest),
                     f"{peer_s} s, {peer_mib} MiB" if peer_s else "-"])
    return table(["surfels", "s", "MiB", "load, ms", "surfels", "render", "write", "the rest", "best peer"], rows)


TABLES = {"clock": clock, "goals": goals, "frames": frames, "cycles": cycles, "peer": peer,
          "against": against, "closed": closed,
          "stages": stages, "jobs": jobs}


def main():
    data = json.load(open(sys.argv[1], encoding="utf-8"))
    if len(sys.argv) < 3:
        for name, make in TABLES.items():
            print(f"\n{name}\n\n{make(data)}")
        return
    page = open(sys.argv[2], encoding="utf-8").read()
    for name, make in TABLES.items():
        page = re.sub(rf"(<!-- table {name} -->\n).*?(<!-- end -->)",
                      lambda found, text=make(data): f"{found[1]}\n{text}\n\n{found[2]}", page, flags=re.DOTALL)
    with open(sys.argv[2], "w", encoding="utf-8") as file:
        file.write(page)


main()
