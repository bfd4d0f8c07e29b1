#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Writes the calls of test `wrong_arguments` by rule: every function of docs/api.json with everything as it should be but one
argument, which is NULL, zero, no number, or absurd; and with all of them so.

write_wrong_arguments.py docs/api.json tests/house/wrong_arguments.txt OUT.c

wrong_arguments.txt lists the arguments that have to be right, FUNCTION ARGUMENT..., below the reason of each group."""

import json
import re
import sys

# What is opaque, or more than zeros, is made by the test itself: an expression of its file, by type.
MADE = {"ewa_context": "made.context", "ewa_cloud": "made.cloud", "ewa_image": "&made.image", "ewa_mesh": "&made.mesh",
        "ewa_volume": "&made.volume", "ewa_gaussians": "&made.gaussians", "ewa_renderer": "made.renderer",
        "ewa_surfels": "made.surfels", "ewa_scene": "made.scene", "ewa_asset": "made.asset", "ewa_camera": "&made.camera",
        "ewa_scene_renderer": "made.scene_renderer", "ewa_scene_reader": "made.scene_reader", "ewa_framing": "made.framing", "ewa_polygon": "made.polygon",
        "ewa_splats": "made.splats", "ewa_voxels": "made.voxels", "ewa_gaussian_renderer": "made.gaussian_renderer",
        "ewa_volume_renderer": "made.volume_renderer", "ewa_warp": "made.warp", "ewa_frame": "&made.frame",
        "ewa_attribute": "made.attribute", "ewa_transfer": "&made.transfer", "ewa_volume_facts": "&made.facts",
        "ewa_camera_path": "made.path", "ewa_scalar": "&made.scalar", "ewa_canvas": "&made.canvas", "ewa_lod": "made.lod",
        "ewa_cloud_reader": "made.reader", "ewa_cloud_writer": "made.writer", "ewa_option_table": "&ewa_render_options_table",
        "ewa_option": "ewa_render_options_table.options", "ewa_environment": "made.environment", "ewa_exchange": "&made.exchange",
        "ewa_scene_file": "made.scene_file", "ewa_elements": "made.elements", "ewa_photo_list": "made.photo_list",
        "ewa_mat3": "&made.mat3", "ewa_mat4": "&made.mat4",
        "ewa_conic": "&made.conic"}
ARRAYS = {"double": "numbers", "ewa_vec3": "vectors", "ewa_vec4": "vectors"}
MEMBERS = {"ewa_vec3": 3, "ewa_vec4": 4, "ewa_line3": 2}
CALLBACK = {"ewa_camera_callback": "receive_camera", "ewa_line_callback": "receive_line"}
FLOATS = ("double", "float")
INTEGERS = ("uint8_t", "uint32_t", "uint64_t", "int", "int64_t", "size_t", "bool", "char")
# How many items an array has is what the caller says; nobody can look.
LENGTH = re.compile(r"(^|_)(count|size_bytes)$")


def arguments_of(prototype):
    """Name, type without the name, and whether it is an array, of every argument."""
    found = []
    for text in re.split(r",\s*(?![^\[]*\])", prototype[prototype.index("(") + 1:-1]):
        text = text.strip()
        if text == "void":
            continue
        array = re.search(r"(\w+)((\[\w*\])+)$", text)
        if array:
            found.append((array.group(1), text[:array.start(1)].strip(), True))
        else:
            name = re.search(r"(\w+)$", text)
            found.append((name.group(1), text[:name.start(1)].strip(), False))
    return found


def base_of(kind):
    return re.sub(r"\bconst\b|\*", "", kind).strip()


class Writer:
    """Writes one C file."""

    def __init__(self, api, exceptions):
        self.functions = {name: text for header in api.values() for name, text in header.get("functions", {}).items()}
        self.structs = {name for header in api.values() for name in header.get("structs", {})}
        self.enums = {name for header in api.values() for name in header.get("enums", {})}
        self.exceptions = exceptions
        self.used = set()
        self.lines, self.cases = [], []

    def right(self, name, kind, is_array, index):
        """An expression that is right, after what it needs in `self.lines`."""
        base, stars = base_of(kind), kind.count("*")
        if base in CALLBACK:
            return CALLBACK[base]
        if is_array or base in FLOATS + INTEGERS + ("void", ) and stars:
            if base == "char" and stars == 1 and "const" in kind and not is_array:
                return '"nothing.ply"'
            if base == "char" and stars == 2:
                return "made.names" if "const" in kind else "(char **)made.nothing"
            return f"(void *)made.{ARRAYS.get(base, 'bytes')}"
        if stars == 2:
            return f"({kind.replace(' *const *', ' *const *')})(void *)" + ("made.clouds" if "const *" in kind else "made.nothing")
        if stars == 1:
            if base in MADE:
                return f"({kind})(uintptr_t){MADE[base]}"
            value = f"value{index}"
            self.lines.append(f"    static {base} {value};\n    (void)&{value};")
            init = self.functions.get(f"{base}_init")
            if init:
                rest = arguments_of(init)[1:]
                words = ["EWA_PROCEDURE_MARBLE" if k == "ewa_procedure" else f"sizeof {value}" for _, k, _ in rest]
                self.lines.append(f"    {base}_init({', '.join(['&' + value] + words)});")
            return f"&{value}"
        if base in FLOATS + INTEGERS or base in self.enums:
            return "1"
        numbers = ["1", str(2 + index), str(3 * index), "1"] if base != "ewa_line3" else ["{1, 2, 0}", "{0, 0, 3}"]
        return f"({base}){{{', '.join(numbers[:MEMBERS[base]])}}}"

    def wrong(self, name, kind, is_array, before):
        """Expressions that are not right, with a word for each."""
        base, stars = base_of(kind), kind.count("*")
        if stars or is_array:
            return [("NULL", "NULL")]
        if base in FLOATS:
            return [("0", "0"), ("NAN", "nan"), ("-INFINITY", "-infinity")]
        if LENGTH.search(name) and before and (before[1].count("*") or before[2]):
            return [("0", "zero")]
        if base == "size_t" and name == "struct_size":
            return [("0", "zero")]
        if base in INTEGERS or base in self.enums:
            return [("0", "zero"), (f"({base})-1", "absurd")]
        return []

    def function(self, name, prototype):
        arguments, begin = arguments_of(prototype), len(self.lines)
        self.lines.append(f"static int call_{name}(int which) {{")
        rights = [self.right(*argument, index) for index, argument in enumerate(arguments)]
        wrongs, everything = [], list(rights)
        for index, argument in enumerate(arguments):
            excepted = (name, argument[0]) in self.exceptions
            if excepted:
                self.used.add((name, argument[0]))
            for value, word in self.wrong(*argument, arguments[index - 1] if index else None):
                if excepted:
                    continue
                wrongs.append((f"{argument[0]} {word}", rights[:index] + [value] + rights[index + 1:]))
                if word in ("NULL", "zero", "nan"):
                    everything[index] = value
        if not wrongs:
            del self.lines[begin:]
            return
        if len(wrongs) > 1:
            wrongs.append(("all", everything))
        returns = prototype[:prototype.index("(")].strip()
        says = returns.startswith("ewa_status ")
        self.lines.append("    switch (which) {")
        for index, (word, values) in enumerate(wrongs):
            call = f"{name}({', '.join(values)})"
            self.lines.append(f"    case {index}: {'return (int)' + call if says else '(void)' + call + '; return 0'}; // {word}")
            self.cases.append(f'    {{"{name}", "{word}", call_{name}, {index}}},')
        self.lines.append("    default: return 0;\n    }\n}\n")


def main(api_path, exceptions_path, out_path):
    with open(api_path) as file:
        api = json.load(file)
    exceptions = set()
    with open(exceptions_path) as file:
        for line in file:
            if line.strip() and not line.startswith("#"):
                function, *arguments = line.split()
                exceptions |= {(function, argument) for argument in arguments}
    writer = Writer(api, exceptions)
    for name, prototype in writer.functions.items():
        writer.function(name, prototype)
    astray = sorted(f"{function} {argument}" for function, argument in exceptions - writer.used)
    if astray:
        raise SystemExit("wrong_arguments.txt names what is not there: " + ", ".join(astray))
    with open(out_path, "w") as file:
        file.write("// Written by tests/house/write_wrong_arguments.py from docs/api.json.\n")
        file.write('#include "house/wrong_arguments.h"\n\n' + "\n".join(writer.lines))
        file.write("\nconst wrong_call wrong_calls[] = {\n" + "\n".join(writer.cases) + "\n    {0},\n};\n")


if __name__ == "__main__":
    main(*sys.argv[1:])
