#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""A default is a default: writing one out changes no byte of what a command writes, prints or says.

    check_defaults.py EWA FOLDER [COMMAND...]

Reads the options of every command and their defaults from `ewa --help-markdown`, which docs/cli.md is. Runs each line
of JOBS as it stands, then with all defaults written out that may stand beside its options, and the first line of a
command with each of them alone. Options that are written out nowhere are told of, too.
"""
import json
import re
import subprocess
import sys
from pathlib import Path

#: Command lines; {d}: the folder of inputs, {o}: an empty folder for what is written. The first of a command is the quickest.
JOBS = {
    "generate": ["sphere -n 200 -o {o}/a.ply", "checkerbox --dims 9 -o {o}/a.nrrd", "blob -o {o}/a.nrrd",
                 "cube -n 300 --procedure wood -o {o}/a.ply", "plane -n 200 --texture {d}/color.png -o {o}/a.ply", "torus -o {o}/a.ply"],
    "surfels": ["{d}/bare.ply -o {o}/a.ply", "{d}/points.txt -o {o}/a.ply"],
    "features": ["{d}/box.ply -o {o}/a.ply"],
    "sample": ["{d}/box.obj -n 300 -o {o}/a.ply", "{d}/box.obj -n 300 --procedure marble -o {o}/a.ply",
               "{d}/box.obj -o {o}/a.ply"],
    "csg": ["{d}/sphere.ply {d}/box.ply -o {o}/a.ply"],
    "convert": ["{d}/points.txt -o {o}/a.ply", "{d}/sphere.ply --procedure checker -o {o}/a.ply",
                "{d}/gaussians.ply -o {o}/a.spz", "{d}/sphere.ply --refit-colors fit -o {o}/a.ply",
                "{d}/points.txt {d}/sphere.ply -o {o}/a.ply"],
    "texture": ["{d}/color.png --size 64x48 -o {o}/a.png", "{d}/color.png --camera {d}/poses.txt --size 64x48 -o {o}/a.png",
                "{d}/color.png -o {o}/a.png"],
    "warp": ["{d}/color.png {d}/depth.pfm --source-camera {d}/camera.json --shift 0.1,0,0 -o {o}/a.png",
             "{d}/color.png {d}/depth.pfm --source-camera {d}/camera.json --camera {d}/camera.json -o {o}/a.exr",
             "{d}/color.png {d}/depth.pfm --intrinsics 80,80,40,30 --shift 0.1,0,0 -o {o}/a.png"],
    "lod": ["{d}/bare.ply -o {o}/tree.copc.laz"],
    "info": ["{d}/sphere.ply --json", "{d}/points.txt", "{d}/volume.raw --dims 8,8,8", "{d}/volume.nrrd --json",
             "{d}/gaussians.ply", "{d}/tree.copc.laz"],
    "render": ["{d}/sphere.ply --size 64x48 -o {o}/a.exr --aov depth={o}/d.pfm",
               "{d}/bare.ply --size 64x48 -o {o}/a.png", "{d}/scan.pcd -o {o}/a.png", "{d}/sphere.ply -o {o}/a.png",
               "{d}/points.txt --color-by intensity --size 64x48 -o {o}/a.png",
               "{d}/points.txt --color-by classification --size 64x48 -o {o}/a.png",
               "{d}/points.txt --color-by x --color-bar --title t --scale-bar --size 200x100 -o {o}/a.png",
               "{d}/sphere.ply --camera {d}/camera.json -o {o}/a.png",
               "{d}/sphere.ply --camera {d}/poses.txt -o {o}/a.png",
               "{d}/gaussians.ply --size 64x48 -o {o}/a.png", "{d}/volume.nrrd --size 64x48 -o {o}/a.png",
               "{d}/slice.nrrd --transfer gray --size 64x48 -o {o}/a.png",
               "{d}/tree.copc.laz --size 64x48 -o {o}/a.png", "{d}/tree.copc.laz --levels always --size 64x48 -o {o}/a.png",
               "{d}/box.obj --size 64x48 -o {o}/a.png", "{d}/scene.json -o {o}/a.png",
               "{d}/sphere.ply --turntable 2 --size 64x48 -o {o}/%d.png",
               "{d}/sphere.ply --panorama fisheye -o {o}/a.png --size 48x48", "{d}/sphere.ply --panorama equirectangular --eye 0,0,0 -o {o}/a.png --size 48x24",
               "{d}/sphere.ply --path {d}/poses.txt --size 64x48 -o {o}/%d.png",
               "{d}/sphere.ply {d}/gaussians.ply {d}/volume.nrrd {d}/box.obj --size 64x48 -o {o}/a.exr"],
    "volume": ["{d}/volume.nrrd --size 64x48 -o {o}/a.exr", "{d}/volume.nrrd -o {o}/a.png",
               "{d}/volume.raw --dims 8,8,8 --size 64x48 -o {o}/a.png",
               "{d}/volume.nrrd --transfer fog --size 64x48 -o {o}/a.png", "{d}/slice.nrrd --size 64x48 -o {o}/a.png",
               "{d}/volume.nrrd --camera {d}/camera.json -o {o}/a.png", "{d}/volume.nrrd --turntable 2 --size 64x48 -o {o}/%d.png",
               "{d}/volume.nrrd --surfels {d}/sphere.ply --camera {d}/poses.txt --size 64x48 -o {o}/a.png"],
    "view": ["{d}/sphere.ply --size 64x48 --script {d}/shot.txt", "{d}/scan.pcd --script {d}/shot.txt",
             "{d}/sphere.ply --camera {d}/camera.json --script {d}/shot.txt",
             "{d}/sphere.ply --camera {d}/poses.txt --script {d}/shot.txt", "{d}/tree.copc.laz --script {d}/shot.txt",
             "{d}/scene.json --script {d}/shot.txt"],
    "page": ["{d}/sphere.ply -o {o}/a.html --assets {d}/assets", "{d}/sphere.ply --folder {o}/site --assets {d}/assets",
             "{d}/points.txt --color-by x -o {o}/a.html --assets {d}/assets",
             "{d}/sphere.ply --camera {d}/camera.json -o {o}/a.html --assets {d}/assets",
             "{d}/sphere.ply --camera {d}/poses.txt -o {o}/a.html --assets {d}/assets",
             "{d}/scene.json {d}/gaussians.ply {d}/volume.nrrd -o {o}/a.html --assets {d}/assets"],
    "photos": ["{d}/sphere.ply --cameras {d}/photo.json -o {o}/a.ply --report {o}/a.json",
               "{d}/points.txt --cameras {d}/photo.json --method mean -o {o}/a.ply"],
    "compare": ["{d}/sphere.ply --cameras {d}/photo.json -o {o}/a.png --json {o}/a.json",
                "{d}/gaussians.ply --cameras {d}/photo.json"],
    "profile": ["{d}/points.txt --line 0,0.5;1.8,0.5 -o {o}/a.ply --graph {o}/a.png",
                "{d}/points.txt --line 0,0.5;1.8,0.5 --color-by classification --graph {o}/a.png"],
    "bench": ["--scene plane --splats 1000 --pixels 4 --size 64x48 --workers 1 --frames 1 --stages off",
              "{d}/sphere.ply --workers 1 --frames 1 --stages off"],
}
#: Options of `bench` that would take seconds at their defaults: parsed only. What pages draw with may not be built. A server does not end.
SLOW = {"page": {"assets"}, "serve": {"port", "threads", "max-memory", "max-seconds", "named-files"},
        "bench": {"scene", "splats", "pixels", "size", "frames", "stages", "workers"}}

CUBE = ("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
        "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n")


class Option:
    """One option of docs/cli.md."""

    def __init__(self, key, meaning):
        self.key = key
        found = re.search(r"\(default: ([^()]*)\)", meaning)
        said = found.group(1) if found else None
        self.value = re.sub(r"^(\w+): .*", r"\1", said) if said else None
        self.needs = self.keys("needs", meaning)
        self.excludes = self.keys("not with", meaning)

    @staticmethod
    def keys(lead, meaning):
        found = re.search(rf"; {lead} (--[\w-]+(?:, --[\w-]+)*)", meaning)
        return set(re.findall(r"--([\w-]+)", found.group(1))) if found else set()


def read_options(ewa):
    """The options of each command, and the keys of those that are known by other names."""
    page = subprocess.run([ewa, "--help-markdown"], capture_output=True, text=True, check=True).stdout
    commands, told = {}, {}
    for part in re.split(r"(?m)^## ewa ", page)[1:]:
        command = part.split()[0]
        for names, value, meaning in re.findall(r"(?m)^\| `((?:-\w, )?--[\w-]+)(.*?)` \| (.*) \|$", part.replace("\\|", "|")):
            before = re.match(r"as of \[`ewa (\w+)`\]", meaning)  # which tells them in the same words
            for key in re.findall(r"--([\w-]+)", names + value if before else names):
                if before and (before.group(1), key) not in told:
                    continue  # --no-key of a switch
                told[command, key] = told[before.group(1), key] if before else (value, meaning)
        # Switches have no value that could be written.
        commands[command] = [Option(key, meaning) for (of, key), (value, meaning) in told.items() if of == command and value[:1] == " "]
    return commands


def run(ewa, command, line, folder, more=()):
    """What a line writes, prints and says."""
    out = folder / "out"
    for path in sorted(out.glob("**/*"), reverse=True):
        path.rmdir() if path.is_dir() else path.unlink()
    out.mkdir(exist_ok=True)
    words = line.format(d=folder, o=out).split()
    done = subprocess.run([ewa, command, *words, *more], capture_output=True, cwd=out, check=False)
    files = {str(path.relative_to(out)): path.read_bytes() for path in sorted(out.glob("**/*")) if path.is_file()}
    said = done.stdout + done.stderr
    if command == "bench":
        said = re.sub(rb"[-\d.: ]|inf", b"", said)  # times
    return done.returncode, said, files


def make_inputs(ewa, folder):
    def do(*words):
        subprocess.run([ewa, *words, "-q"], cwd=folder, check=True)

    (folder / "box.obj").write_text(CUBE)
    (folder / "volume.raw").write_bytes(bytes(range(256)) * 2)
    (folder / "shot.txt").write_text("do shot a.png\n")
    (folder / "poses.txt").write_text("1 0 0 0\n0 -1 0 0\n0 0 -1 6\n0 0 0 1\n")
    rows = [(0.1 * x, 0.1 * y, 0.02 * ((x * y) % 5), (7 * x * y) % 256, 2 + (x + y) % 5) for x in range(20) for y in range(20)]
    (folder / "points.txt").write_text("x y z intensity classification\n" + "".join("%g %g %g %d %d\n" % row for row in rows))
    (folder / "scan.pcd").write_text(
        "VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 20\nHEIGHT 20\nVIEWPOINT 0 0 0 1 0 0 0\n"
        "POINTS 400\nDATA ascii\n" + "".join("%g %g %g\n" % (0.05 * (x - 9.5), 0.04 * (y - 9.5), 1 + 0.01 * x)
                                             for y in range(20) for x in range(20)))
    names = ["x", "y", "z", "f_dc_0", "f_dc_1", "f_dc_2", *(f"f_rest_{i}" for i in range(9)), "opacity",
             *(f"scale_{i}" for i in range(3)), *(f"rot_{i}" for i in range(4))]
    splats = ["%g %g %g 1 0 -1 .1 .2 .3 .1 .2 .3 .1 .2 .3 2 -2 -2.5 -3 1 .1 %g 0" % (0.3 * x, 0.3 * y, 0.1 * x * y, 0.1 * x)
              for x in range(5) for y in range(5)]
    (folder / "gaussians.ply").write_text(
        f"ply\nformat ascii 1.0\nelement vertex {len(splats)}\n" + "".join(f"property float {name}\n" for name in names) +
        "end_header\n" + "\n".join(splats) + "\n")
    (folder / "assets").mkdir(exist_ok=True)
    for name in ("files.js", "ranges.js", "module.js", "threads.js", "pictures.js", "worker.js", "look.js", "ewa-view.js", "single.js", "page.css", "page.wasm.gz", "page-relaxed.wasm.gz"):
        (folder / "assets" / name).write_text(name + "\n")
    do("generate", "sphere", "-n", "300", "-o", "sphere.ply")
    do("generate", "cube", "-n", "300", "-o", "box.ply")
    do("generate", "torus", "-n", "300", "--positions-only", "-o", "bare.ply")
    do("generate", "checkerbox", "--dims", "12", "-o", "volume.nrrd")
    do("generate", "blob", "--dims", "16,16,2", "-o", "slice.nrrd")
    do("lod", "bare.ply", "-o", "tree.copc.laz")
    do("render", "sphere.ply", "--size", "80x60", "-o", "color.png", "--aov", "depth=depth.pfm",
       "--save-camera", "camera.json", "--save-scene", "scene.json")
    photo = json.loads((folder / "camera.json").read_text())
    (folder / "photo.json").write_text(json.dumps({**photo, "file_path": "color.png"}))


def main():
    ewa, folder = str(Path(sys.argv[1]).resolve()), Path(sys.argv[2]).resolve()
    commands = read_options(ewa)
    chosen = sys.argv[3:] or list(commands)
    folder.mkdir(parents=True, exist_ok=True)
    make_inputs(ewa, folder)
    wrong, count = [], 0
    for command in chosen:
        options = {option.key: option for option in commands[command]}
        slow, written = SLOW.get(command, set()), set()
        for index, line in enumerate(JOBS.get(command, [])):
            plain = run(ewa, command, line, folder)
            if plain[0]:
                wrong.append(f"ewa {command} {line}: {plain[1].decode()}")
                continue
            given = {word[2:] for word in line.split() if word.startswith("--")} | ({"points"} if " -n " in line else set())
            beside, defaults = set(given), []
            for key, option in options.items():
                clash = option.excludes & beside or any(key in options[k].excludes for k in beside if k in options)
                lone = option.needs and not option.needs & given
                word = option.value in ("auto", "none", "all")
                if option.value is None or key in given | slow or not word and (clash or lone):
                    continue
                defaults.append((f"--{key}", option.value))
                if not word:
                    beside.add(key)
            written |= {key[2:] for key, _ in defaults}

            def differs(pairs):
                nonlocal count
                count += 1
                again = run(ewa, command, line, folder, [word for pair in pairs for word in pair])
                return again != plain and again

            together = differs(defaults)
            found = len(wrong)
            if together or index == 0:
                for pair in defaults:
                    alone = differs([pair])
                    if alone:
                        what = alone[1].decode().strip() if alone[0] else "other bytes"
                        wrong.append(f"ewa {command} {line} {' '.join(pair)}: {what}")
            if together and len(wrong) == found:
                wrong.append(f"ewa {command} {line} {' '.join(w for pair in defaults for w in pair)}: "
                             f"{together[1].decode().strip() if together[0] else 'other bytes'}")
        wrong += [f"ewa {command} --{option.key} {option.value}: written out nowhere" for option in options.values()
                  if option.value is not None and option.key not in written | slow]
    print("\n".join([*wrong, f"{count} lines with defaults, {len(wrong)} wrong"]))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
