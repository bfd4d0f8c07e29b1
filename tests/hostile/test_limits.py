# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""A disk that is full, descriptors and memory that run out: a message, and what was there before."""

import itertools
import os
import resource
import subprocess

from hostile import check, done, listing, main, run

LOADER = 127  # the status of the system's loader, which speaks where it has no room for the libraries
OLD = b"what was there before\n"


def inputs():
    done("generate", "sphere", "-n", "20000", "-o", "a.ply")
    done("generate", "ball", "--dims", "32,32,32", "-o", "ball.nrrd")
    done("render", "a.ply", "-o", "in.png", "--size", "256x256", "--aov", "depth=in.pfm")


WRITERS = [["convert", "a.ply", "-o", "out" + suffix] for suffix in (".ply", ".las", ".laz", ".pcd", ".xyz", ".pts", ".csv")] + [
    ["render", "a.ply", "-o", "out.png", "--size", "512x512"],
    ["render", "a.ply", "-o", "out.exr", "--size", "512x512"],
    ["render", "a.ply", "-o", "out.pfm", "--size", "512x512"],
    ["generate", "ball", "--dims", "64,64,64", "-o", "out.nrrd"],
    ["volume", "ball.nrrd", "-o", "out.png", "--size", "512x512"],
    ["lod", "a.ply", "-o", "out.copc.laz"],
    ["texture", "in.png", "-o", "out.png", "--size", "512x512", "--corners", "0,0,500,10,512,512,10,500"],
    ["surfels", "a.ply", "-o", "out.ply"],
]


def held(words, result, before):
    """Either done, or refused with the old output as it was, and nothing else."""
    output = words[words.index("-o") + 1]
    command = " ".join(words)
    check(result.status in (0, 1), f"{command}: status {result.status}: {result.err[-300:]}")
    if result.status == 1:
        check(result.err.startswith("ewa: "), f"{command}: says {result.err[-300:]!r}")
        with open(output, "rb") as file:
            check(file.read() == OLD, f"{command}: changed {output}")
        check(listing(".") == before, f"{command}: left {set(listing('.')) ^ set(before)}")
    os.remove(output)
    return result.status == 1


def full_disk():
    """A limit of the size of files stands for a full disk, at every place of the output: each write fails with an error."""
    inputs()
    for words in WRITERS:
        output = words[words.index("-o") + 1]
        failed = 0
        for limit in (0, 100, 5000, 60000):
            with open(output, "wb") as file:
                file.write(OLD)
            before = listing(".")
            failed += held(words, run(*words, limits=[(resource.RLIMIT_FSIZE, limit)]), before)
        check(failed > 0, f"{' '.join(words)}: no limit was met")


def few_descriptors():
    """From none to spare to enough."""
    inputs()
    for words in (["convert", "a.ply", "-o", "out.laz"], ["lod", "a.ply", "-o", "out.copc.laz"],
                  ["render", "a.ply", "ball.nrrd", "-o", "out.png", "--size", "64x64"]):
        for count in (3, 4, 5, 6, 8):
            output = words[words.index("-o") + 1]
            with open(output, "wb") as file:
                file.write(OLD)
            before = listing(".")
            result = run(*words, limits=[(resource.RLIMIT_NOFILE, count)])
            if result.status != LOADER:
                held(words, result, before)


def little_memory():
    """Addresses run out at some step of the work: a message, no crash."""
    inputs()
    mb = 1 << 20
    for words in (["convert", "a.ply", "-o", "out.laz"], ["lod", "a.ply", "-o", "out.copc.laz"],
                  ["render", "a.ply", "-o", "out.png", "--size", "2000x2000"],
                  ["volume", "ball.nrrd", "-o", "out.png", "--size", "2000x2000"]):
        failed = 0
        # Fine steps from where the program starts at all: a conversion needs little more than that.
        first = next(size for size in range(20, 1000, 7) if run("--version", limits=[(resource.RLIMIT_AS, size * mb)]).status != LOADER)
        for size in itertools.chain(range(first - 7, first + 7), range(first + 7, 1000, 7)):
            output = words[words.index("-o") + 1]
            with open(output, "wb") as file:
                file.write(OLD)
            before = listing(".")
            result = run(*words, "--threads", "2", limits=[(resource.RLIMIT_AS, size * mb), (resource.RLIMIT_CORE, 0)])
            # Libraries may die before main: libgfortran's start does where it gets no memory for a message.
            if result.status == LOADER or result.status < 0 and run("--version", limits=[(resource.RLIMIT_AS, size * mb), (resource.RLIMIT_CORE, 0)]).status < 0:
                continue
            if not held(words, result, before):
                break
            failed += 1
        check(failed > 0, f"{' '.join(words)}: no limit was met")


def closed_pipe():
    """A reader that goes away is no signal."""
    inputs()
    reader, writer = os.pipe()
    os.close(reader)
    process = subprocess.run([os.environ["EWA_PROGRAM"], "convert", "a.ply", "-o", "-"], stdout=writer, stderr=subprocess.PIPE,
                             restore_signals=True)
    os.close(writer)
    check(process.returncode == 1, f"status {process.returncode}")


if __name__ == "__main__":
    main([full_disk, few_descriptors, little_memory, closed_pipe])
