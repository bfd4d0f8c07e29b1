#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""An octree of many files by the workers of a Dask cluster: each makes parts, the last step joins them.

usage: dask_lod.py OUT.copc.laz IN... [--parts N] [--scheduler ADDRESS]

Without a scheduler, workers of this machine do it. All see the same folders. A part that a lost worker was making is made
again by another one; a part is there whole or not at all, and the file has the bytes of one `ewa lod IN... -o OUT`.
"""
import argparse
import os
import subprocess

from dask.distributed import Client, as_completed


def make_part(inputs, part, index, count):
    """Makes part `index` of `count`, unless it is there."""
    if not os.path.exists(part):
        subprocess.run(["ewa", "lod", *inputs, "-o", part, "--subset", f"{index}/{count}", "--quiet"], check=True)
    return part


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("output")
    parser.add_argument("inputs", nargs="+")
    parser.add_argument("--parts", type=int, default=16)
    parser.add_argument("--scheduler")
    given = parser.parse_args()
    inputs, output = [os.path.abspath(path) for path in given.inputs], os.path.abspath(given.output)
    parts = [f"{output}.part-{i}-of-{given.parts}.copc.laz" for i in range(1, given.parts + 1)]
    client = Client(given.scheduler) if given.scheduler else Client(threads_per_worker=1)
    with client:
        jobs = [client.submit(make_part, inputs, part, i + 1, given.parts, retries=3, pure=False)
                for i, part in enumerate(parts)]
        for job in as_completed(jobs):
            print("made", os.path.basename(job.result()), flush=True)
    subprocess.run(["ewa", "lod", *parts, "-o", output, "--merge"], check=True)
    for part in parts:
        os.remove(part)


if __name__ == "__main__":
    main()
