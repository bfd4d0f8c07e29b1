# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Signals at random times to every command: it ends soon, by the signal; what was there before stays, and nothing else is left."""

import array
import math
import os
import random
import signal
import struct
import time
import zlib

from hostile import PROGRAM, Failed, check, done, finish, listing, main, start

# What is promised is 0.3 s. A machine that has other things to do takes longer to run what is asked, so that only a quiet one
# is held to it.
LIMIT_S = 0.3 if os.environ.get("EWA_QUIET_MACHINE") else 1.0
SEED = int(os.environ.get("EWA_SEED", "1"))
ROUNDS = int(os.environ.get("EWA_ROUNDS", "1"))
NUMBERS = (signal.SIGTERM, signal.SIGINT, signal.SIGHUP)
OLD = b"what was there before\n"

longest = {}


WINDOWLESS = {"SDL_VIDEODRIVER": "dummy"}  # a window that nobody sees


def interrupt(words, output, delay_s, number=signal.SIGTERM):
    """Sends one signal after a delay and holds the command to what is promised; false when it was faster than that."""
    if output:
        with open(output, "wb") as file:
            file.write(OLD)
    before = listing(".")
    process = start(words, env=WINDOWLESS)
    time.sleep(delay_s)
    os.kill(process.pid, number)
    sent = time.monotonic()
    result = finish(process)
    seconds = time.monotonic() - sent
    command = " ".join(words)
    if result.status == 0:
        return False
    longest[words[0]] = max(longest.get(words[0], 0), seconds)
    check(result.status == -number, f"{command}: status {result.status} for signal {number}: {result.err.strip()}")
    check(seconds <= LIMIT_S, f"{command}: ended {seconds:.2f} s after the signal, sent at {delay_s:.2f} s")
    check(set(listing(".")) == set(before), f"{command}: left {set(listing('.')) ^ set(before)}")
    if output:
        with open(output, "rb") as file:
            found = file.read()
        if found != OLD:  # all was done when the signal came, which only the same bytes prove
            done(*words)
            with open(output, "rb") as file:
                check(file.read() == found, f"{command}: half-written {output}")
            return False
    return True


def png(path, side):
    """A grey picture that compresses to little."""
    rows = zlib.compress((b"\0" + bytes(range(256)) * (side // 256)) * side, 1)
    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", side, side, 8, 0, 0, 0, 0)) +
                   chunk(b"IDAT", rows) + chunk(b"IEND", b""))


def bare(path, side):
    """A hilly square of side x side points with nothing but places, written byte by byte."""
    heights = [0.1 * math.sin(0.01 * i) for i in range(side)]
    with open(path, "wb") as file:
        file.write(b"ply\nformat binary_little_endian 1.0\nelement vertex %d\nproperty float x\nproperty float y\n"
                   b"property float z\nend_header\n" % (side * side))
        for row in range(side):
            line = array.array("f", bytes(12 * side))
            line[0::3] = array.array("f", [column / side for column in range(side)])
            line[1::3] = array.array("f", [row / side]) * side
            line[2::3] = array.array("f", [heights[row] * height for height in heights])
            line.tofile(file)


def inputs():
    """Files that keep every command busy for a second and more."""
    done("generate", "terrain", "-n", "2000000", "-o", "points.ply")
    bare("bare.ply", 1400)
    with open("frames.txt", "w") as file:
        file.write("do turn 1 0\nframe\n" * 100000)
    done("convert", "bare.ply", "-o", "points.laz")
    done("generate", "ball", "--dims", "256,256,256", "-o", "ball.nrrd")
    done("generate", "sphere", "-n", "400000", "-o", "a.ply")
    done("convert", "a.ply", "--translate", "0.5,0,0", "-o", "b.ply")
    with open("mesh.off", "w") as file:
        file.write("OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n")
    png("picture.png", 8192)
    with open("depth.pfm", "wb") as file:
        file.write(b"Pf\n8192 8192\n-1\n")
        for _ in range(8192):
            file.write(array.array("f", [2.0]).tobytes() * 8192)
    done("render", "a.ply", "--size", "8192x8192", "-o", "out.png", "--save-camera", "camera.json")
    os.remove("out.png")


COMMANDS = [
    (["render", "bare.ply", "-o", "out.png", "--size", "4000x3000"], "out.png"),
    (["render", "points.ply", "-o", "out.exr", "--size", "8000x6000"], "out.exr"),
    (["info", "bare.ply"], None),
    (["convert", "points.laz", "-o", "out.ply"], "out.ply"),
    (["convert", "points.ply", "-o", "out.laz"], "out.laz"),
    (["convert", "points.ply", "-o", "out.xyz"], "out.xyz"),
    (["convert", "bare.ply", "--min-distance", "0.02", "-o", "out.ply"], "out.ply"),
    (["convert", "bare.ply", "--voxel", "0.01", "-o", "out.ply"], "out.ply"),
    (["surfels", "bare.ply", "-o", "out.ply"], "out.ply"),
    (["features", "bare.ply", "-o", "out.ply"], "out.ply"),
    (["sample", "mesh.off", "-n", "4000000", "-o", "out.ply"], "out.ply"),
    (["csg", "a.ply", "b.ply", "--op", "union", "-o", "out.ply"], "out.ply"),
    (["texture", "picture.png", "--size", "8000x8000", "--corners", "0,0,7000,100,8000,8000,100,7000", "-o", "out.png"], "out.png"),
    (["volume", "ball.nrrd", "--size", "4000x4000", "-o", "out.png"], "out.png"),
    (["lod", "bare.ply", "-o", "out.copc.laz"], "out.copc.laz"),
    (["generate", "terrain", "-n", "20000000", "-o", "out.ply"], "out.ply"),
    (["warp", "picture.png", "depth.pfm", "--camera", "camera.json", "--intrinsics", "8192,8192,4096,4096",
      "-o", "out.png"], "out.png"),
    (["bench", "--scene", "plane"], None),
]
# Where the program was built with a window.
VIEW = (["view", "bare.ply", "--script", "frames.txt"], None)


def every_command():
    inputs()
    chance = random.Random(SEED)
    wrong = []
    places = ("ewa-view", "../viewer/sdl/ewa-view")
    has_window = any(os.path.exists(os.path.join(os.path.dirname(PROGRAM), place)) for place in places)
    for words, output in COMMANDS + [VIEW] * has_window:
        for _ in range(ROUNDS):
            delay_s = chance.uniform(0.05, 0.8)
            try:
                while not interrupt(words, output, delay_s, chance.choice(NUMBERS)):
                    delay_s /= 2
                    check(delay_s > 0.005, f"{' '.join(words)}: through before any signal")
            except Failed as failure:
                wrong.append(str(failure))
    print("  longest: " + ", ".join(f"{name} {seconds:.2f} s" for name, seconds in longest.items()))
    check(not wrong, "\n  ".join(wrong))


def waiting_for_a_pipe():
    """Reads and opens that wait for somebody else are given up."""
    os.mkfifo("never.ply")
    interrupt(["info", "never.ply"], None, 0.3)
    reader, writer = os.pipe()
    process = start(["info", "-"], stdin=reader)
    time.sleep(0.3)
    os.kill(process.pid, signal.SIGTERM)
    sent = time.monotonic()
    result = finish(process)
    os.close(reader)
    os.close(writer)
    check(result.status == -signal.SIGTERM and time.monotonic() - sent < LIMIT_S, f"status {result.status}")


def ignored_signals():
    """What a shell starts in the background ignores interrupts, and goes on doing so."""
    process = start(["generate", "terrain", "-n", "4000000", "-o", "out.ply"], ignored=(signal.SIGINT,))
    for _ in range(10):
        time.sleep(0.02)
        os.kill(process.pid, signal.SIGINT)
    result = finish(process)
    check(result.status == 0 and os.path.exists("out.ply"), f"status {result.status}")


def films():
    """Parts of a film are whole or not there; the program that makes it ends with this one."""
    done("generate", "sphere", "-n", "200000", "-o", "a.ply")
    process = start(["render", "a.ply", "--turntable", "200", "-o", "f_%04d.png", "--size", "320x240"])
    time.sleep(1.0)
    os.kill(process.pid, signal.SIGINT)
    result = finish(process)
    check(result.status == -signal.SIGINT, f"status {result.status}: {result.err}")
    for name in listing("."):
        if not name.endswith(".png"):
            check(name == "a.ply", f"left {name}")
            continue
        with open(name, "rb") as file:
            check(file.read()[-8:-4] == b"IEND", f"{name} is half-written")


if __name__ == "__main__":
    main([every_command, waiting_for_a_pipe, ignored_signals, films])
