# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Inputs that others cut short, or replace, while they are read: the run fails with the name of the file and writes nothing."""

import os
import random
import shutil
import time

from hostile import check, done, finish, listing, main, start

SEED = int(os.environ.get("EWA_SEED", "1"))
ROUNDS = int(os.environ.get("EWA_ROUNDS", "2"))


def cut_while(words, source, output, chance):
    """Cuts a copy of the source to a random length at a random time; whether that came in time to be noticed."""
    name = "cut-" + source
    shutil.copyfile(source, name)
    process = start([word.replace(source, name) for word in words])
    time.sleep(chance.uniform(0.01, 0.4))
    os.truncate(name, int(os.path.getsize(source) * chance.random() * 0.5))
    result = finish(process)
    command = " ".join(words)
    check(result.status in (0, 1), f"{command}: status {result.status}: {result.err.strip()}")
    if result.status == 1:
        check(name in result.err, f"{command}: does not name the file: {result.err.strip()!r}")
        check(not os.path.exists(output), f"{command}: left {output}")
    else:
        os.remove(output)
    os.remove(name)
    return result.status == 1


def every_mapping():
    done("generate", "terrain", "-n", "1000000", "-o", "points.ply")
    done("convert", "points.ply", "-o", "points.laz")
    done("lod", "points.ply", "-o", "points.copc.laz")
    chance = random.Random(SEED)
    before = listing(".")
    noticed = []
    for words, source in [(["convert", "points.ply", "-o", "out.laz"], "points.ply"),
                          (["surfels", "points.laz", "-o", "out.ply"], "points.laz"),
                          (["lod", "points.ply", "-o", "out.copc.laz"], "points.ply"),
                          (["render", "points.copc.laz", "--levels", "always", "-o", "out.png", "--size", "3000x2000"],
                           "points.copc.laz"),
                          (["convert", "points.copc.laz", "-o", "out.ply"], "points.copc.laz")]:
        output = words[words.index("-o") + 1]
        noticed += [cut_while(words, source, output, chance) for _ in range(ROUNDS)]
        check(listing(".") == before, f"{words}: left {set(listing('.')) ^ set(before)}")
    check(any(noticed), "no cut came in time")
    print(f"  noticed: {sum(noticed)} of {len(noticed)}")


if __name__ == "__main__":
    main([every_mapping])
