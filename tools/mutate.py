#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
"""Breaks the library on purpose, one number, sign or comparison at a time, and counts what the tests notice.

  tools/mutate.py list [--count N] [--seed S]   writes tests/mutations.txt: what is broken, and how
  tools/mutate.py check                         names entries whose line the sources no longer have
  tools/mutate.py run [--jobs N] [--only TEXT,...] [--sample N] [--again]
                                                breaks and tests, of each room no more than so many; results in
                                                build/mutate/results.txt, which a further run goes on from; of what is
                                                committed
  tools/mutate.py report                        the score, by room, and what survived

Rooms are the folders of src and of src/io, the program (cli), the viewer and the Python package.
A mutant is relevant when the probe (tests/probe) differs by more than 1/255 in a pixel or 1e-3 relative in a number.
Of these, so many must fail a test: see docs/testing.md. Entries are file, occurrence of the line in the file, the line,
and what stands there instead, parted by tabs; those before the line "# seeded" are chosen by hand and kept.
"""
import argparse
import fcntl
import os
import random
import re
import shutil
import subprocess
import sys
import threading
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
LIST = ROOT / "tests" / "mutations.txt"
WORK = ROOT / "build" / "mutate"
RESULTS = WORK / "results.txt"
SNAPSHOT = WORK / "snapshot"
SEEDED = "# seeded"
GOAL = 0.95
UNTIMED_S = 300  # that a test may take which has never failed

# Tables, files of one instruction set, and what only reports or allocates say nothing about the pictures.
LEFT_OUT = re.compile(
    r"_table\.c$|kernels/pixels|colormap\.h|_presets\.c$|_avx2\.|_avx512\.|_neon\.|wide_(portable|fused)\.h$|base/|options\.[ch]$")
QUIET_LINES = re.compile(
    r"ewa_fail|ewa_report|ewa_volume_fail|fail_|broken\(|ewa_progress|ewa_allocate|ewa_release|sizeof|snprintf|printf|"
    r"struct_size|static_assert|capacity|reserve|prefetch|stats|_s [+-]?=|^\s*#\s*(if|else|end|include)|"
    r"^\s*(typedef|enum|struct)\b|EWA_OK|EWA_ERROR|!context|extern|^[a-z].*[;,{]$|^\s+(const )?\w+ \*?\w+\[\d+\][,)]")
GENERATED = ("python/ewa/_bindings.py", "python/ewa/_options.py")
# Of Python: what only imports, declares or fails.
QUIET_PYTHON = re.compile(r"^\s*(import|from|raise|class|def|@|assert)\b|Error\(|^[A-Z_]+ =|ctypes|__all__|version|-> ")
ARRAY_LENGTH = re.compile(r"^\s*(static |const |extern )*(unsigned |struct )?\w+ \**\w+[\w\s,*\[\]]*\[$")

# Near tests by the beginning of a path, cheapest first; the first that fails kills the mutant.
PICTURES = ["surfel", "packets", "billboards", "reference_splat", "points", "tolerance", "resolve", "kernels", "abuffer", "reference",
            "reference_invariance", "shade", "random_scenes", "ranges", "silhouette", "holes", "facing", "layers",
            "shade_pipeline", "clip_lines", "environment", "sharp"]
MESHES = ["mesh_ply", "mesh_obj", "mesh_stl", "mesh_polygon", "mesh_gltf", "mesh_gltf_look", "mesh_broken", "referenced_file"]
NEAR = [
    ("src/homogeneous/camera_path", ["camera_path"]),
    ("src/homogeneous/camera", ["camera", "camera_path", "geometry", "paper", "cli_render"]),
    ("src/math/angle", ["camera_path", "camera"]),
    ("src/homogeneous/clip", ["clip", "clip_batch", "paper", "geometry", "map"]),
    ("src/math/wave", ["procedure", "wide_functions"]),
    ("src/homogeneous/noise", ["procedure", "generate"]),
    ("src/homogeneous", ["geometry", "map", "paper", "clip", "camera", "reference_splat", "random_scenes", "ranges"]),
    ("src/reference/gaussian", ["gaussian_render", "gaussian_exact"]), ("src/reference/section", ["planes", "section"]),
    ("src/reference/volume", ["volume_plain", "volume_integrals"]), ("src/reference/classify", ["voxels", "volume_plain"]),
    ("src/reference/texture", ["texture", "texture_kernels"]),
    ("src/reference/adjoint", ["adjoint_reference"]), ("src/reference/layering", ["adjoint_reference", "layers"]), ("src/adjoint", ["adjoint"]),
    ("src/reference", ["reference_splat", "reference", "reference_invariance", "shade", "abuffer", "random_scenes"]),
    ("src/math/gaussian", ["acquire", "refit", "procedure", "texture"]),
    ("src/wide", ["wide_functions", "resolve", "packets", "kernel_tables", "random_scenes"]),
    ("src/math", ["geometry", "map", "paper", "clip", "camera", "wide_functions", "reference_splat", "random_scenes", "ranges"]),
    ("src/image/environment", ["environment", "shade", "shade_pipeline"]),
    ("src/image/volume", ["volume_file", "voxels", "transfer", "generate_volume", "automatic"]),
    ("src/image/transfer", ["transfer", "volume_file", "automatic", "cli_volume"]),
    ("src/image/texture", ["acquire", "cli_acquire"]),
    ("src/image", ["image", "srgb", "colormap", "environment", "resolve", "png", "transfer"]),
    ("src/cloud/mesh", ["mesh"] + MESHES + ["mesh_sample"]),
    ("src/cloud", ["cloud", "edit", "morton", "neighbours", "local", "estimate", "orient", "packets", "radii"]),
    ("src/io/las/copc", ["copc", "lod_build"]),
    ("src/io/las", ["las", "las_bad", "las_write", "laz", "copc"]),
    ("src/io/e57", ["e57"]), ("src/io/ept", ["ept", "lod_draw"]),
    ("src/io/gaussian", ["gaussian_ply", "gaussian_forms", "gaussian_save"]),
    ("src/io/scene_text", ["scene_file", "fuzz_scene"]), ("src/io/filter_text", ["filter", "scene_file"]),
    ("src/io/cloud/pcd", ["pcd", "pcd_write"]), ("src/io/cloud/ptx", ["ptx"]),
    ("src/io/cloud/text", ["text_cloud", "text_write", "text_cloud_files"]),
    ("src/io/cloud/ply", ["ply", "ply_bad", "ply_write"]), ("src/io/cloud", ["stream", "ply", "text_cloud", "las"]),
    ("src/io/polygon", ["polygon"]), ("src/io/image", ["png", "exr", "pfm", "hdr", "jpeg", "webp"]),
    ("src/io/levels", ["lod_levels", "lod_build"]), ("src/io/octree", ["ept", "copc", "lod_draw"]),
    ("src/io/camera", ["camera_file", "camera_poses", "number"]),
    ("src/io/volume/transfer", ["transfer"]), ("src/io/volume", ["volume_file", "volume_bad"]),
    ("src/io/mesh", MESHES),
    ("src/io/image/png", ["png"]), ("src/io/image/exr", ["exr"]), ("src/io/image/pfm", ["pfm"]),
    ("src/io/image/hdr", ["hdr"]), ("src/io/image/jpeg", ["jpeg"]), ("src/io/image/webp", ["webp"]),
    ("src/io", ["number", "file", "ply", "png", "exr", "pfm", "hdr", "jpeg", "webp", "camera_file", "materials",
                "transfer", "volume_file", "volume_bad", "ply_bad", "ply_write", "camera_poses"] + MESHES),
    ("src/colors/acquire", ["acquire_pairs", "acquire", "acquire_quality", "cli_acquire"]),
    ("src/edges/csg", ["csg", "sharp"]), ("src/edges/solid", ["solid", "csg", "sharp"]),
    ("src/edges/feature", ["features", "feature_fit", "feature_quality"]),
    ("src/generate/volume", ["generate_volume", "volume_integrals"]),
    ("src/generate", ["generate", "sharp", "acquire", "csg"]),
    ("src/mesh", ["mesh_surface", "mesh_sample", "mesh_colors", "mesh_pages", "mesh_edges"]),
    ("src/colors/gradient", ["procedure", "acquire", "refit"]), ("src/colors/pattern", ["procedure", "acquire"]), ("src/colors/procedure", ["procedure"]),
    ("src/colors/refit", ["refit", "sparse"]), ("src/colors/sparse", ["sparse", "acquire", "refit"]),
    ("src/generate/volume_outline", ["generate_volume", "cli_volume"]),
    ("src/estimate", ["local", "estimate", "borders", "orient", "features", "feature_quality", "holes", "radii", "outline"]),
    ("src/texture", ["texture_kernels", "texture", "texture_maps", "cli_texture"]),
    ("src/warp", ["warp_kernels", "warp", "warp_nearest", "warp_pictures", "cli_warp"]),
    ("src/scene/coloring", ["coloring", "scene", "cli_filter"]),
    ("src/scene/file", ["scene_file", "cli_render"]), ("src/scene/save", ["scene_file"]),
    ("src/scene/octree", ["scene_octree", "cli_lod"]),
    ("src/scene/streamed", ["gaussian_streams"]),
    ("src/scene", ["scene", "scene_file", "scene_octree", "planes", "cli_render", "cli_gaussians", "cli_volume", "view_scripts"]),
    ("src/lod", ["lod_merge", "lod_cut", "lod_build", "scene_octree", "lod_draw", "lod_levels", "lod_borders", "lod_parts", "cli_lod"]),
    ("src/cluster", ["joint", "parts"]),
    ("src/photos/undistort", ["undistort", "photos"]), ("src/photos/image_quality", ["image_quality"]),
    ("src/photos", ["photos"]),
    ("src/framing", ["framing", "upright", "upright_bodies", "cli_places", "cli_render"]),
    ("src/furniture", ["furniture", "shapes", "text_drawing", "decimal", "cli_furniture"]),
    ("src/gl/gaussian", ["gpu_gaussians"]),
    ("src/gl/volume", ["gpu_volumes"]),
    ("src/gl/sort", ["gpu_sort", "gpu_gaussians"]),
    ("src/gl/choice", ["gpu_fallback", "gpu_gaussians"]),
    ("src/gl", ["gpu_frame", "gpu_masks", "gpu_sources", "gpu_bytes", "gpu_raster", "gpu_device", "gpu_fallback"]),
    ("src/tiling", ["bin", "render", "small"]),
    ("src/base/platform", ["referenced_file", "file"]), ("src/base", ["base", "option_tables", "bin"]),
    ("src/volume/gaussian", ["gaussian_render", "gaussian_files", "gaussian_levels", "mixture", "planes"]),
    ("src/volume/splat", ["gaussian_render", "gaussian_files", "gaussian_levels"]),
    ("src/volume", ["voxels", "volume_points", "volume_plain", "planes", "volume_near", "volume_integrals", "volume_render",
                    "cli_volume"]),
    ("src/surface", PICTURES),
    ("cli/base/options", ["options", "cli_usage"]), ("cli/base/pattern", ["pattern"]),
    ("cli/base", ["cli_usage", "cli_outputs", "cli_said", "cli_files", "cli_frames"]),
    ("cli/bench", ["cli_bench"]), ("cli/cloud/csg", ["cli_mesh", "cli_said"]),
    ("cli/cloud", ["cli_said", "cli_mesh", "cli_files", "cli_acquire", "cli_usage"]),
    ("cli/convert", ["cli_files", "cli_gaussians", "cli_filter", "cli_splats", "cli_mesh"]),
    ("cli/image/texture", ["cli_texture"]), ("cli/image", ["cli_texture", "cli_warp"]),
    ("cli/info", ["cli_said", "cli_files", "cli_filter", "cli_gaussians", "cli_lod", "cli_mesh", "cli_volume", "cli_render"]),
    ("cli/input/warp", ["cli_warp"]), ("cli/input/camera", ["cli_warp", "cli_said", "cli_places", "cli_render"]),
    ("cli/input/import", ["import"]), ("cli/input/volume", ["cli_volume"]), ("cli/input/lod", ["cli_lod"]),
    ("cli/input", ["cli_said", "cli_files", "cli_filter", "cli_gaussians", "cli_lod", "cli_render"]),
    ("cli/lod", ["cli_lod"]), ("cli/page", ["cli_page"]), ("cli/volume", ["cli_volume", "cli_said"]), ("cli/view", ["cli_usage", "view_scripts"]),
    ("cli/render/light", ["cli_light"]), ("cli/render/f", ["cli_frames", "cli_furniture", "cli_parts"]),
    ("cli/render", ["cli_render", "cli_places", "cli_frames", "cli_light", "cli_outputs", "cli_said"]),
    ("cli", ["cli_usage", "cli_said"]),
    ("viewer/navigate", ["navigate", "view_scripts"]), ("viewer/sdl", ["window_events", "window_scripts"]),
    ("viewer", ["viewer", "view_scripts", "navigate"]),
    # Files of python/tests, with the unbroken library.
    ("python/ewa/cloud", ["test_cloud.py", "test_same_bytes.py"]), ("python/ewa/gaussians", ["test_gaussians.py"]),
    ("python/ewa/scene", ["test_scene.py", "test_lifetime.py"]), ("python/ewa/_scene", ["test_same_bytes.py", "test_scene.py"]),
    ("python/ewa/_arrays", ["test_cloud.py", "test_gaussians.py"]), ("python/ewa/_errors", ["test_lifetime.py"]), ("python/ewa/_held", ["test_lifetime.py"]),
    ("python", ["test_pictures.py", "test_lifetime.py", "test_same_bytes.py", "test_cloud.py", "test_bindings.py"]),
]

# Sections of the probe that a path's code may change, cheapest first.
CLOUDS = ["generated", "edited", "estimates", "sampled", "textured", "features", "solids"]
SECTIONS = [
    ("src/homogeneous/map", ["math", "resample"]), ("src/homogeneous", ["math"]),
    ("src/math", ["math", "pictures", "resample", "volumes", "generated", "textured", "sampled", "splats"]),
    ("src/image/environment", ["pictures"]), ("src/image/volume", ["files", "volumes"]),
    ("src/image/transfer", ["files", "volumes"]), ("src/image/texture", ["textured", "sampled"]),
    ("src/image", ["pictures", "files", "resample", "textured"]),
    ("src/cloud", CLOUDS + ["files", "splats"]),
    # It has files of these only: of other formats every mutant counts.
    ("src/io/image", ["files"]), ("src/io/volume", ["files"]), ("src/io/camera", ["files"]), ("src/io/cloud/ply", ["files"]),
    ("src/colors/acquire", ["textured", "sampled"]), ("src/edges/csg", ["solids"]),
    ("src/edges/solid", ["solids", "generated"]), ("src/edges/feature", ["features"]),
    ("src/generate/volume", ["files", "volumes"]), ("src/generate", ["generated", "textured"]),
    ("src/mesh", ["sampled", "files"]), ("src/colors/pattern", ["textured"]),
    ("src/colors/procedure", ["textured"]), ("src/colors/refit", ["textured"]),
    ("src/colors/sparse", ["textured", "sampled"]), ("src/generate/volume_outline", ["volumes"]),
    ("src/estimate", ["estimates", "sampled", "textured", "features"]),
    ("src/volume", ["volumes", "files"]),
    ("src/surface", ["pictures", "splats", "resample"]),
]


def sections_of(path):
    """Empty: the probe does not ask that room, so every mutant there counts."""
    return next((sections for start, sections in SECTIONS if path.startswith(start)), [])

SWAPS = {"fmin": "fmax", "fmax": "fmin", "vec3_add": "vec3_sub", "vec3_sub": "vec3_add", "wf_add": "wf_sub",
         "wf_sub": "wf_add", "wf_min": "wf_max", "wf_max": "wf_min", "wf_fma": "wf_fnma", "wf_fnma": "wf_fma",
         "wm_and": "wm_or", "wm_or": "wm_and", "floor": "ceil", "ceil": "floor", "sin": "cos", "cos": "sin",
         "wf_mul": "wf_div", "wf_lt": "wf_le", "sqrt": "fabs", "exp": "expm1"}
TOKEN = re.compile(
    r"(?P<number>(?<![\w.])(?:\d+\.\d*(?:e[+-]?\d+)?|\d+e[+-]?\d+|\d+)(?=[fuU;,)\s*/+\-\]}:<>=&|]|$))"
    r"|(?P<compare><=|>=|==|!=|(?<=[\s])<(?=\s)|(?<=\s)>(?=\s))"
    r"|(?P<logic>&&|\|\||(?<=\s)(?:and|or)(?=\s)|\bnot (?!in\b))"
    r"|(?P<binary>(?<=[\w)\]]\s)[-+*/](?=\s[\w(-]))"
    r"|(?P<unary>(?<=[(,=]\s)-(?=[\w(])|(?<=\()-(?=[\w(])|(?<=return\s)-(?=[\w(]))"
    r"|(?P<name>\b(?:%s)\b(?=\())"
    r"|(?P<axis>(?<=\w)\.[xyz]\b)" % "|".join(SWAPS))


def blank_comments(text):
    """The text with comments and strings as spaces, so that columns stay."""
    spaces = lambda match: re.sub(r"[^\n]", " ", match.group(0))
    return re.sub(r"/\*.*?\*/|//[^\n]*|\"(?:\\.|[^\"\\\n])*\"|'(?:\\.|[^'\\\n])*'", spaces, text, flags=re.S)


def blank_python(text):
    """The same of Python."""
    spaces = lambda match: re.sub(r"[^\n]", " ", match.group(0))
    return re.sub(r"\"\"\".*?\"\"\"|#[^\n]*|[frb]*\"(?:\\.|[^\"\\\n])*\"", spaces, text, flags=re.S)


def other_number(token, chance):
    if re.fullmatch(r"\d+", token):
        return {"0": "1", "1": chance.choice(["2", "0"])}.get(token, str(int(token) + chance.choice([-1, 1])))
    value = float(token)
    changed = value * chance.choice([0.8, 1.25]) if value else 0.1
    return repr(changed)


def replacement(match, chance):
    token, kind = match.group(0), match.lastgroup
    if kind == "number":
        return other_number(token, chance)
    if kind == "compare":
        return {"<": chance.choice([">", ">", "<="]), ">": chance.choice(["<", "<", ">="]), "<=": "<", ">=": ">", "==": "!=",
                "!=": "=="}[token]
    if kind == "logic":
        return {"&&": "||", "||": "&&", "and": "or", "or": "and", "not ": ""}[token]
    if kind == "binary":
        return {"+": "-", "-": "+", "*": "/", "/": "*"}[token]
    if kind == "unary":
        return ""
    if kind == "axis":
        return {".x": ".y", ".y": ".z", ".z": ".x"}[token]
    return SWAPS[token]


def candidates(path, chance):
    """(old line, new line, occurrence) of every place that can be broken, one way each."""
    text = path.read_text()
    python = path.suffix == ".py"
    quiet, bared = (QUIET_PYTHON, blank_python(text)) if python else (QUIET_LINES, blank_comments(text))
    seen, found = {}, []
    for line, bare in zip(text.split("\n"), bared.split("\n")):
        seen[line.strip()] = seen.get(line.strip(), 0) + 1
        if quiet.search(bare) or not bare.strip():
            continue
        define = re.match(r"\s*#\s*define\s+\w+\s", bare)
        if bare.lstrip().startswith("#") and not define:
            continue
        for match in TOKEN.finditer(bare, define.end() if define else 0):
            if match.lastgroup == "binary" and match.group(0) == "*" and re.search(r"\b(const|float|double|void|char|"
                                                                                r"uint\w+|int\w+|ewa_\w+)\s$",
                                                                                bare[: match.start()]):
                continue
            if match.lastgroup == "number" and ARRAY_LENGTH.match(bare[: match.start()]):
                continue
            new = line[: match.start()] + replacement(match, chance) + line[match.end():]
            if new != line and not re.match(r"\s*for \(", line):
                found.append((line, new, seen[line.strip()]))
    return found


class Entry:
    def __init__(self, path, occurrence, old, new):
        self.path, self.occurrence, self.old, self.new = path, int(occurrence), old, new

    def key(self):
        return "\t".join([self.path, str(self.occurrence), self.old, self.new])

    def room(self):
        parts = self.path.split("/")
        if parts[0] != "src":
            return parts[0]
        return "/".join(parts[1:3]) if parts[1] == "io" and len(parts) > 3 else parts[1]

    def apply(self, text):
        """The text with the line replaced, or None where it is not found."""
        lines, left = text.split("\n"), self.occurrence
        for i, line in enumerate(lines):
            if line.strip() == self.old:
                left -= 1
                if left == 0:
                    indent = line[: len(line) - len(line.lstrip())]
                    return "\n".join(lines[:i] + [indent + self.new] + lines[i + 1:])
        return None


def read_list():
    """Entries, and how many of them are chosen by hand."""
    entries, by_hand = [], None
    for line in LIST.read_text().split("\n") if LIST.exists() else []:
        if line == SEEDED:
            by_hand = len(entries)
        elif line and not line.startswith("#"):
            entries.append(Entry(*line.split("\t")))
    return entries, len(entries) if by_hand is None else by_hand


def sources():
    files = subprocess.check_output(["git", "ls-files", "src", "cli", "viewer", "python/ewa"], cwd=ROOT, text=True).split()
    broken = [f for f in files if f.endswith((".c", ".h", ".py")) and f not in GENERATED]
    return [f for f in broken if not f.startswith("src/") or not LEFT_OUT.search(f)]


def write_list(count, seed):
    entries, by_hand = read_list()
    kept = entries[:by_hand]
    chance = random.Random(seed)
    # Every file has its share, by the root of its size, so that small files are asked too.
    found = {path: candidates(ROOT / path, chance) for path in sources()}
    found = {path: places for path, places in found.items() if places}
    weight = {path: len(places) ** 0.5 * (1 if path.startswith("src/") and "/io/" not in path else 0.5)
              for path, places in found.items()}
    total, made, taken = sum(weight.values()), [], {entry.key() for entry in kept}
    share = {path: weight[path] * count / total for path in found}
    owed = 0.0
    for path in sorted(found):
        owed += share[path]
        take = min(int(owed), len(found[path]))
        owed -= take
        for line, new, occurrence in chance.sample(found[path], take):
            entry = Entry(path, occurrence, line.strip(), new.strip())
            if entry.key() not in taken:
                made.append(entry)
                taken.add(entry.key())
    head = ["# What tools/mutate.py breaks: file, occurrence of the line, the line, what stands there instead."]
    lines = head + [e.key() for e in kept] + [SEEDED] + [e.key() for e in made]
    LIST.write_text("\n".join(lines) + "\n")
    print("%d by hand, %d seeded, in %d files" % (len(kept), len(made), len({e.path for e in made})))


def stale_entries(entries):
    return [e for e in entries if not (ROOT / e.path).exists() or e.apply((ROOT / e.path).read_text()) is None]


def take_snapshot():
    """What is committed, so that who goes on working beside this does not change what is broken."""
    shutil.rmtree(SNAPSHOT, ignore_errors=True)
    SNAPSHOT.mkdir(parents=True)
    archive = subprocess.Popen(["git", "archive", "HEAD"], cwd=ROOT, stdout=subprocess.PIPE)
    if subprocess.call(["tar", "-x", "-C", str(SNAPSHOT)], stdin=archive.stdout) or archive.wait():
        sys.exit("mutate: git archive failed")


class Tree:
    """A copy of the sources with a build of its own, in which one mutant after another is built."""

    def __init__(self, number):
        self.root, self.build = WORK / ("tree%d" % number), WORK / ("build%d" % number)
        self.scratch = WORK / ("scratch%d" % number)
        self.log = WORK / ("log%d.txt" % number)
        self.environment = dict(os.environ, EWA_DATA=os.environ.get("EWA_DATA", str(ROOT.parent / "shared" / "data")))

    def call(self, command, timeout=None):
        with open(self.log, "a") as log:
            try:
                return subprocess.run(command, stdout=log, stderr=log, timeout=timeout, env=self.environment).returncode
            except subprocess.TimeoutExpired:
                return 124

    def text_of(self, path):
        """Sources without the files of one instruction set: what is there once more only takes time to compile."""
        text = (SNAPSHOT / path).read_text()
        if path.endswith((".c", ".h")):
            return text.replace("defined(__x86_64__)", "0")
        return text.replace("x86_64|AMD64", "none") if path.endswith(".cmake") else text

    def prepare(self, entries):
        """Builds what breaking `entries` needs."""
        for path in (str(file.relative_to(SNAPSHOT)) for file in SNAPSHOT.rglob("*") if file.is_file()):
            target = self.root / path
            target.parent.mkdir(parents=True, exist_ok=True)
            try:
                text = self.text_of(path)
            except UnicodeDecodeError:
                shutil.copyfile(SNAPSHOT / path, target)
                continue
            if not target.exists() or target.read_bytes() != text.encode():
                target.write_text(text)
            if os.access(SNAPSHOT / path, os.X_OK):
                target.chmod(0o755)
        self.scratch.mkdir(parents=True, exist_ok=True)
        self.log.write_text("")
        launcher = ["-DCMAKE_C_COMPILER_LAUNCHER=ccache"] if shutil.which("ccache") else []
        configured = self.call(["cmake", "-G", "Ninja", "-S", str(self.root), "-B", str(self.build),
                                "-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_C_FLAGS_RELEASE=-O2 -march=native -w",
                                "-DEWA_INNER_LIBRARY=ON", "-DEWA_DATA=" + self.environment["EWA_DATA"]] + launcher)
        if configured:
            sys.exit("mutate: the unbroken tree cannot be configured: see %s" % self.log)
        names = subprocess.check_output(["ctest", "--test-dir", str(self.build), "-N"], text=True)
        self.tests = set(re.findall(r"Test\s+#\d+: (\S+)", names))
        near = {name for entry in entries for name in self.near_tests(entry.path) if not name.endswith(".py")}
        targets = ["ewa", "ewa_shared", "probe"] + ["test_" + name for name in sorted(near)]
        if self.call(["cmake", "--build", str(self.build), "-j", "2", "--target"] + targets):
            sys.exit("mutate: the unbroken tree does not build: see %s" % self.log)
        return self

    def probe(self, sections, name):
        """Runs the probe; False where it ends badly."""
        program = str(self.build / "tests" / "probe" / "probe")
        return self.call(["timeout", "120", program, "write", str(self.scratch / name), str(self.root),
                          str(self.scratch)] + sections) == 0

    def test(self, name, timeout):
        if name.endswith(".py"):
            environment = {"EWA_LIBRARY": self.build / "libewa.so", "EWA_PROGRAM": self.build / "cli" / "ewa",
                           "PYTHONPATH": self.root / "python", "PYTHONDONTWRITEBYTECODE": 1}
            return self.call(["env", *("%s=%s" % pair for pair in environment.items()), "timeout", str(timeout),
                              sys.executable, str(self.root / "python" / "tests" / "run.py"), name])
        return self.call(["ctest", "--test-dir", str(self.build), "-R", "^%s$" % name, "--timeout", str(timeout)])

    def rebuild(self, name):
        """Tests that have a header's functions in themselves; the library is one that is loaded. False: not to be had."""
        return self.call(["cmake", "--build", str(self.build), "--target", "test_" + name]) == 0

    def make(self, path):
        """Builds what a file is part of, but for tests; False where it does not compile."""
        targets = ["ewa_objects"] if path.startswith("src/") else []
        if any(name.startswith("cli_") for name in self.near_tests(path)):
            targets.append("ewa")
        return not targets or self.call(["cmake", "--build", str(self.build), "--target"] + targets) == 0

    def is_held(self, path):
        """Whether tests have a file in themselves: program and viewer, but for tests that run the program."""
        return path.endswith(".h") or path.startswith(("cli/", "viewer/"))

    def near_tests(self, path):
        names = next(tests for start, tests in NEAR if path.startswith(start))
        return [name for name in names if name in self.tests or name.endswith(".py")]

    def differs(self, sections):
        """Whether the library does anything else than the unbroken one."""
        program = str(self.build / "tests" / "probe" / "probe")
        for section in sections:
            unbroken = "unbroken-" + section
            if not self.probe([section], "broken"):
                return True
            if self.call([program, "compare", str(self.scratch / unbroken), str(self.scratch / "broken")]):
                return True
        return False

    def try_tests(self, entry, timeouts):
        """(verdict, test): one of stale, uncompilable, irrelevant, killed, survived."""
        text = entry.apply(self.text_of(entry.path))
        if text is None:
            return "stale", ""
        (self.root / entry.path).write_text(text)
        if not self.make(entry.path):
            return "uncompilable", ""
        sections = sections_of(entry.path)
        if sections and not self.differs(sections):
            return "irrelevant", ""
        for name in self.near_tests(entry.path):
            if self.is_held(entry.path) and not self.rebuild(name):
                return "uncompilable", name
            if self.test(name, timeouts.get(name, UNTIMED_S)):
                return "killed", name
        return "survived", ""

    def time_test(self, path, name):
        """How long a test may take that failed for the first time: several times what the unbroken library needs."""
        self.restore(path)
        if not self.make(path) or (self.is_held(path) and not self.rebuild(name)):
            sys.exit("mutate: the unbroken tree does not build: see %s" % self.log)
        begin = time.time()
        if self.test(name, 3 * UNTIMED_S):
            sys.exit("mutate: test %s fails without any change: see %s" % (name, self.log))
        return 20 + 6 * (time.time() - begin)

    def restore(self, path):
        (self.root / path).write_text(self.text_of(path))


def read_results():
    results = {}
    for line in RESULTS.read_text().split("\n") if RESULTS.exists() else []:
        if line:
            verdict, test, key = line.split("\t", 2)
            results[key] = (verdict, test)
    return results


def on_each(trees, work):
    threads = [threading.Thread(target=work, args=(tree,)) for tree in trees]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()


def sample_of(entries, results, count):
    """No more than `count` of each room, what has a result included: one of each file before a second one."""
    chance, rooms = random.Random(count), {}
    for entry in chance.sample(entries, len(entries)):
        rooms.setdefault(entry.room(), []).append(entry)
    taken = []
    for room in rooms.values():
        asked = {}
        for entry in room:
            asked.setdefault(entry.path, []).append(entry)
        turns = [(turn, i, entry) for i, of in enumerate(asked.values()) for turn, entry in enumerate(of)]
        left = count - sum(entry.key() in results for entry in room)
        taken += [e for _, _, e in sorted(turns, key=lambda t: t[:2]) if e.key() not in results][:max(left, 0)]
    return taken


def run(jobs, only, sample, again):
    entries, _ = read_list()
    WORK.mkdir(parents=True, exist_ok=True)
    lock_file = open(WORK / "lock", "w")
    try:
        fcntl.flock(lock_file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        sys.exit("mutate: another run is at work in %s" % WORK)
    results = {} if again else read_results()
    wanted = [e for e in entries if any(text in e.path for text in only.split(","))]
    wanted = sample_of(wanted, results, sample) if sample else [e for e in wanted if e.key() not in results]
    if not wanted:
        return report()
    take_snapshot()
    trees = [Tree(i).prepare(wanted) for i in range(jobs)]
    for tree in trees:
        for section in sorted({s for e in wanted for s in sections_of(e.path)}):
            if not tree.probe([section], "unbroken-" + section):
                sys.exit("mutate: the probe fails: see %s" % tree.log)
    timeouts, queues = {}, {}
    for entry in wanted:  # one file after another, so that little is built again
        queues.setdefault(entry.path, []).append(entry)
    pending, lock = sorted(queues), threading.Lock()
    random.Random(len(pending)).shuffle(pending)  # a run that is cut short has asked every room

    def work(tree):
        while True:
            with lock:
                if not pending:
                    return
                path = pending.pop(0)
            for entry in queues[path]:
                begin = time.time()
                verdict, test = tree.try_tests(entry, timeouts)
                if test and verdict == "killed" and test not in timeouts:
                    timeouts[test] = tree.time_test(path, test)
                with lock:
                    results[entry.key()] = (verdict, test)
                    RESULTS.write_text("".join("%s\t%s\t%s\n" % (v, t, k) for k, (v, t) in results.items()))
                    print("%-12s %-20s %5.1f s  %s: %s  ->  %s" % (verdict, test, time.time() - begin, entry.path,
                                                                  entry.old, entry.new), flush=True)
            tree.restore(path)

    on_each(trees, work)
    return report()


def report():
    entries, by_hand = read_list()
    results, rooms = read_results(), {}
    for entry in entries:
        verdict = results.get(entry.key(), ("untried", ""))[0]
        for room in (entry.room(), "all"):
            counts = rooms.setdefault(room, {})
            counts[verdict] = counts.get(verdict, 0) + 1
    columns = ["killed", "survived", "irrelevant", "uncompilable", "stale", "untried"]
    print("%-10s" % "room" + "".join("%13s" % c for c in columns) + "        score")
    for room in sorted(rooms, key=lambda r: (r == "all", r)):
        counts = rooms[room]
        relevant = counts.get("killed", 0) + counts.get("survived", 0)
        score = "%.1f %%" % (100 * counts.get("killed", 0) / relevant) if relevant else "-"
        print("%-10s" % room + "".join("%13d" % counts.get(c, 0) for c in columns) + "%13s" % score)
    for entry in entries:
        if results.get(entry.key(), ("",))[0] in ("survived", "stale"):
            print("%s: %s: %s  ->  %s" % (results[entry.key()][0], entry.path, entry.old, entry.new))
    print("%d by hand, %d seeded" % (by_hand, len(entries) - by_hand))
    counts = rooms["all"]
    relevant = counts.get("killed", 0) + counts.get("survived", 0)
    return 0 if relevant and counts.get("killed", 0) >= GOAL * relevant else 1


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=["list", "check", "run", "report"])
    parser.add_argument("--count", type=int, default=330)
    parser.add_argument("--seed", type=int, default=14)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--only", default="")
    parser.add_argument("--sample", type=int, default=0)
    parser.add_argument("--again", action="store_true")
    options = parser.parse_args()
    if options.what == "list":
        write_list(options.count, options.seed)
        return 0
    if options.what == "check":
        stale = stale_entries(read_list()[0])
        for entry in stale:
            print("stale: %s: %s" % (entry.path, entry.old))
        alone = [path for path in sources() if not any(path.startswith(start) for start, _ in NEAR)]
        for path in alone:
            print("no near tests: %s" % path)
        return 1 if stale or alone else 0
    return run(options.jobs, options.only, options.sample, options.again) if options.what == "run" else report()


if __name__ == "__main__":
    sys.exit(main())
