#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Draws every model, cloud and volume of a folder with the program's defaults and lays the pictures out on sheets.

    contact_sheet.py EWA FOLDER OUT [--columns N] [--size WxH] [--rows N] [--jobs N] [--title TEXT] [-- OPTION...]

Files are those that 'ewa render' or 'ewa volume' may be asked to read, by suffix, in the order of their names. Each
tile names its file; a tile in grey shows the message of a file that was refused. OUT_01.png and so on are the sheets,
OUT.txt lists every file with its exit status, seconds and messages. Needs ImageMagick's 'montage' and 'convert'.
"""
import argparse
import concurrent.futures
import pathlib
import subprocess
import sys
import tempfile
import textwrap
import time

VOLUMES = (".nrrd", ".nhdr", ".nii", ".nii.gz", ".mha", ".mhd", ".vtk", ".vti", ".raw.gz")
SURFACES = (".ply", ".obj", ".stl", ".off", ".gltf", ".glb", ".vtp", ".vtu", ".vts", ".vtr", ".vtm", ".pvtp", ".pvtu", ".pvts", ".pvtr", ".pvd", ".las", ".laz", ".e57", ".pcd", ".pts", ".ptx", ".xyz",
            ".spz", ".splat", ".ksplat", ".sog")


def command_for(path):
    name = path.name.lower()
    if name.endswith(VOLUMES):
        return "volume"
    return "render" if name.endswith(SURFACES) else None


def draw(program, path, size, options, target):
    arguments = [program, command_for(path), str(path), "-o", str(target), "--size", size, *options]
    begin = time.monotonic()
    try:
        done = subprocess.run(arguments, capture_output=True, text=True, errors="replace", timeout=120)
        status, messages = done.returncode, done.stderr.strip()
    except subprocess.TimeoutExpired:
        status, messages = "timeout", "more than 120 s"
    seconds = time.monotonic() - begin
    if status != 0:
        text = "\n".join(textwrap.wrap(messages.replace(str(path.parent) + "/", ""), 40)[:8]) or f"exit {status}"
        subprocess.run(["convert", "-size", size, "xc:gray85", "-gravity", "center", "-pointsize", "12",
                        "-annotate", "0", text.replace("%", "%%").replace("@", " at "), str(target)], check=True)
    return status, seconds, messages


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("folder", type=pathlib.Path, nargs="+")
    parser.add_argument("out")
    parser.add_argument("--size", default="320x240")
    parser.add_argument("--columns", type=int, default=6)
    parser.add_argument("--rows", type=int, default=5)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--title", default="")
    parser.add_argument("--option", action="append", default=[], help="one more argument of ewa")
    given = parser.parse_args()

    files = sorted(p for folder in given.folder for p in folder.rglob("*") if p.is_file() and command_for(p))
    with tempfile.TemporaryDirectory() as scratch:
        tiles = [pathlib.Path(scratch) / f"{i:04d}.png" for i in range(len(files))]
        with concurrent.futures.ThreadPoolExecutor(given.jobs) as pool:
            results = list(pool.map(lambda f, t: draw(given.program, f, given.size, given.option, t), files, tiles))
        with open(given.out + ".txt", "w", encoding="utf-8") as listing:
            for path, (status, seconds, messages) in zip(files, results):
                listing.write(f"{path}\texit {status}\t{seconds:.2f} s\n")
                listing.writelines(f"    {line}\n" for line in messages.splitlines())
        per_sheet = given.columns * given.rows
        for first in range(0, len(files), per_sheet):
            sheet = f"{given.out}_{first // per_sheet + 1:02d}.png"
            arguments = ["montage"]
            for path, tile in list(zip(files, tiles))[first:first + per_sheet]:
                arguments += ["-label", path.name, str(tile)]
            arguments += ["-tile", f"{given.columns}x", "-geometry", "+4+4", "-pointsize", "11"]
            if given.title:
                arguments += ["-title", given.title]
            subprocess.run([*arguments, sheet], check=True)
            print(sheet)
    refused = sum(status != 0 for status, _, _ in results)
    print(f"{len(files)} files, {refused} refused")
    return 0


if __name__ == "__main__":
    sys.exit(main())
