#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""The binding layer of the Python package, from docs/api.json and docs/options.json.

    dump_python.py           writes python/ewa/_bindings.py and python/ewa/_options.py anew
    dump_python.py --check   fails when they are not what the two files say

_bindings.py has every enumeration, struct, callback and function of include/ewa as ctypes, under the names of C.
_options.py has the members of the structs of options as TypedDicts, which are the keyword arguments of the package.
"""
import json
import keyword
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PACKAGE = ROOT / "python" / "ewa"
HEAD = """\
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# Made by tools/dump_python.py from {source}; a test holds it to that. Do not edit.
"""

# C type: (ctypes, Python)
NUMBERS = {
    "bool": ("c_bool", "bool"), "char": ("c_char", "bytes"), "float": ("c_float", "float"),
    "double": ("c_double", "float"), "int": ("c_int", "int"), "size_t": ("c_size_t", "int"),
    "int8_t": ("c_int8", "int"), "uint8_t": ("c_uint8", "int"), "int16_t": ("c_int16", "int"),
    "uint16_t": ("c_uint16", "int"), "int32_t": ("c_int32", "int"), "uint32_t": ("c_uint32", "int"),
    "int64_t": ("c_int64", "int"), "uint64_t": ("c_uint64", "int"),
}
LIMITS = {"UINT64_MAX": 2**64 - 1, "UINT32_MAX": 2**32 - 1, "UINT16_MAX": 2**16 - 1, "UINT8_MAX": 2**8 - 1,
          "INT64_MAX": 2**63 - 1, "INT32_MAX": 2**31 - 1, "INFINITY": float("inf")}


# Members that the package sets by arguments of its own.
OWN = {
    "ewa_asset_options": {"own_context", "to_world"},
    "ewa_render_options": {"background", "layers", "light_count", "material_count", "section_count"},
    "ewa_volume_options": {"background", "light_count", "section_count"}, "ewa_texture_options": {"background"},
    "ewa_gaussian_options": {"background", "section_count"},
    "ewa_generate_options": {"object", "point_count"}, "ewa_volume_generate_options": {"object"},
    "ewa_procedure_options": {"procedure"}, "ewa_furniture_options": {"category_count"},
}


class Api:
    """What docs/api.json says, over all headers."""

    def __init__(self, headers):
        self.values = dict(LIMITS)  # of constants and enumerators
        self.constants, self.enums, self.structs, self.opaque = {}, {}, {}, set()
        self.callbacks, self.functions, self.tables = {}, {}, []
        for name in sorted(headers, key=lambda name: (name != "base.h", name)):
            header = headers[name]
            for enum, items in header.get("enums", {}).items():
                self.add_enum(enum, items)
            for constant, text in header.get("constants", {}).items():
                self.add_constant(constant, text)
            for struct, members in header.get("structs", {}).items():
                if members == "opaque":
                    self.opaque.add(struct)
                else:
                    self.structs[struct] = members
            self.callbacks.update(header.get("callbacks", {}))
            self.functions.update(header.get("functions", {}))
            self.tables += header.get("tables", [])

    def evaluate(self, text):
        text = re.sub(r"\b(0[xX][0-9a-fA-F]+|\d+)[uUlL]+\b", r"\1", text)
        return eval(text, {"__builtins__": {}}, dict(self.values))  # our own headers

    def add_constant(self, name, text):
        if not text.startswith('"') and not re.fullmatch(r"[-+.\w<>|&()\s*/]+", text):
            return
        self.values[name] = self.constants[name] = self.evaluate(text)

    def add_enum(self, enum, items):
        last = -1
        named = {}
        for item in items:
            name, _, text = (part.strip() for part in item.partition("="))
            last = self.evaluate(text) if text else last + 1
            self.values[name] = named[name] = last
        if enum == "anonymous":
            self.constants.update(named)
        else:
            self.enums[enum] = named


def split(text, separator=","):
    """The parts of a list, whose separators in brackets do not count."""
    parts, depth, begin = [], 0, 0
    for i, c in enumerate(text):
        depth += (c in "([") - (c in ")]")
        if c == separator and depth == 0:
            parts.append(text[begin:i].strip())
            begin = i + 1
    return [part for part in parts + [text[begin:].strip()] if part]


class Types:
    """C declarations as ctypes and as annotations of Python."""

    def __init__(self, api):
        self.api = api
        self.needed = set()  # structs and callbacks that the last declaration named

    def scalar(self, base):
        if base in NUMBERS:
            return "c." + NUMBERS[base][0], NUMBERS[base][1]
        if base in self.api.enums:
            return "c.c_int", "int"
        if base in self.api.structs:
            self.needed.add(base)
            return base, base
        sys.exit(f"a type that is not understood: {base}")

    def pointer(self, base, stars):
        """A pointer: numbers, void, opaque objects and pointers to pointers are addresses."""
        if stars == 1 and base in self.api.callbacks:
            self.needed.add(base)
            return base, "Any"
        if stars == 1 and base == "char":
            return "c.c_char_p", "bytes | None"
        if stars == 1 and base in self.api.structs:
            self.needed.add(base)
            return f"c.POINTER({base})", "Any"
        return "c.c_void_p", "int | None"

    def signature(self, result, parameters):
        if parameters.strip() == "void":
            parameters = ""
        _, result_type, _ = self.declaration(result + " f", parameter=True) if result.strip() != "void" else (0, "None", 0)
        return [result_type] + [self.declaration(p, parameter=True)[1] for p in split(parameters)]

    def declaration(self, text, parameter=False):
        """(name, ctypes, annotation) of one declaration without commas."""
        function = re.fullmatch(r"(.+?)\(\*(\w+)\)\((.*)\)", text)
        if function:
            types = self.signature(function.group(1), function.group(3))
            return function.group(2), f"c.CFUNCTYPE({', '.join(types)})", "Any"
        text = re.sub(r"\bconst\b", " ", text)
        match = re.fullmatch(r"\s*(\w+)\s*([*\s]*?)\s*(\w+)?\s*((?:\[[^]]*\])*)\s*", text)
        if not match:
            sys.exit(f"a declaration that is not understood: {text}")
        base, stars, name, arrays = match.group(1), match.group(2).count("*"), match.group(3), match.group(4)
        lengths = [self.api.evaluate(n) for n in re.findall(r"\[([^]]*)\]", arrays)]
        if parameter and lengths:  # an array decays to a pointer
            kind = self.pointer(base, stars + 1) if len(lengths) == 1 and base in self.api.structs else (
                ("c.c_void_p", "int | None"))
            return name, *kind
        ctype, annotation = self.pointer(base, stars) if stars else self.scalar(base)
        for length in reversed(lengths):
            plain = re.fullmatch(r"[\w.]+", ctype) and annotation != "Any"
            annotation = "bytes" if ctype == "c.c_char" else f"c.Array[{ctype if plain else 'Any'}]"
            ctype = f"{ctype} * {length}" if "*" not in ctype else f"({ctype}) * {length}"
        return name, ctype, annotation

    def members(self, text):
        """All declarations of a member such as `double low[3], high[3]`."""
        if "(*" in text:
            return [self.declaration(text)]
        parts = split(text)
        base = re.match(r"((?:const\s+)?\w+)", parts[0]).group(1)
        return [self.declaration(part if i == 0 else f"{base} {part}") for i, part in enumerate(parts)]


def write_enum(name, items):
    lines = [f"class {name}(IntEnum):"]
    return lines + [f"    {item} = {value}" for item, value in items.items()] + ["", ""]


STRUCT = """\
_Type = TypeVar("_Type", bound=c.Structure)


def _struct(made: type[_Type]) -> type[_Type]:
    \"\"\"A struct whose annotations are its members: of each a struct, or its type in Python with that in C.\"\"\"
    made._fields_ = [(name, getattr(kind, "__metadata__", (kind,))[0]) for name, kind in made.__annotations__.items()]
    return made"""


def optional(annotation):
    """Without `X | None`, which Python before 3.10 does not take where annotations are read."""
    return re.sub(r"^(\w+) \| None$", r"Optional[\1]", annotation)


def write_struct(name, members):
    lines = ["@_struct", f"class {name}(c.Structure):"]
    for member, ctype, annotation in members:
        kind = annotation if ctype == annotation else f"Annotated[{optional(annotation)}, {ctype}]"
        lines.append(f"    {member}: {kind}")
    return ["", ""] + lines


def ordered(needs):
    """Names so that what one needs comes before it."""
    done, order = set(), []

    def visit(name, path=()):
        if name in path:
            sys.exit("structs need each other in a circle: " + " ".join(path + (name,)))
        if name in done or name not in needs:
            return
        for other in sorted(needs[name] - {name}):
            visit(other, path + (name,))
        done.add(name)
        order.append(name)

    for name in needs:
        visit(name)
    return order


def write_bindings(api):
    types = Types(api)
    written, needs = {}, {}
    for name, text in api.callbacks.items():
        types.needed = set()
        result, parameters = re.fullmatch(rf"(.*?)\b{name}\((.*)\)", text).groups()
        written[name] = [f"{name} = c.CFUNCTYPE({', '.join(types.signature(result, parameters))})"]
        needs[name] = types.needed
    for name, members in api.structs.items():
        types.needed = set()
        written[name] = write_struct(name, [part for member in members for part in types.members(member)])
        needs[name] = types.needed
    lines = [HEAD.format(source="docs/api.json"),
             '"""The C interface of libewa as ctypes, under its own names; see include/ewa."""',
             "import ctypes as c", "from enum import IntEnum",
             "from typing import Annotated, Any, Callable, Optional, TypeVar", "", ""]
    lines += [f"{name} = {value!r}" for name, value in api.constants.items()] + ["", ""]
    for name, items in api.enums.items():
        lines += write_enum(name, items)
    lines += STRUCT.split("\n")
    before = True
    for name in ordered(needs):
        lines += ["", ""] * (before and name not in api.structs) + written[name]
        before = name in api.structs
    lines += ["", "", "#: Tables of options that the library exports.", "TABLES = ("]
    lines += [f'    "{table}",' for table in api.tables] + [")", "", ""]
    binds = []
    for name, text in api.functions.items():
        result, parameters = re.fullmatch(rf"(.*?)\b{name}\((.*)\)", text).groups()
        result_type, *parameter_types = types.signature(result, parameters)
        if result.strip() == "void":
            annotation = "None"
        else:
            annotation = types.declaration(result + " f", parameter=True)[2]
        arguments = ", ".join([f'"{name}"', result_type] + parameter_types)
        binds.append(f"        self.{name}: Callable[..., {annotation}] = bind({arguments})")
    lines += ["class Functions:", '    """Every function of the library, with the types of its arguments."""', "",
              "    def __init__(self, library: c.CDLL) -> None:",
              "        def bind(name: str, result: Any, *parameters: Any) -> Any:",
              "            function = getattr(library, name)",
              "            function.restype = result",
              "            function.argtypes = parameters",
              "            return function", ""]
    return "\n".join(lines + binds) + "\n"


def write_options(options):
    python = {"bool": "bool", "u32": "int", "u64": "int", "f32": "float", "f64": "float"}
    lines = [HEAD.format(source="docs/options.json"),
             '"""Keyword arguments: the members of the C library\'s structs of options, for type checkers."""',
             "from __future__ import annotations", "", "from typing import Literal, Sequence, TypedDict", ""]
    names = []
    for struct, members in options.items():
        name = "".join(part.capitalize() for part in struct.replace("ewa_", "").split("_"))
        name = name if name.endswith("Options") else name + "Options"
        names.append(name)
        lines += ["", f"class {name}(TypedDict, total=False):", f'    """Members of {struct}."""', ""]
        for member, option in members.items():
            if member in OWN.get(struct, ()):
                continue
            if keyword.iskeyword(member):
                sys.exit(f"{struct}.{member} is a word of Python")
            if option["type"] == "choice":
                words = ", ".join(f'"{word}"' for word in option["range"].split("|"))
                kind = f"Literal[{words}] | int"
            else:
                kind = python[option["type"]]
            if option.get("count"):
                kind = f"Sequence[{kind}]"
            default = option["default"]
            if option["type"] == "choice":
                default = option["range"].split("|")[int(default)]
            elif option["type"] == "bool":
                default = "on" if default else "off"
            unit = f", {option['unit']}" if option.get("unit") else ""
            lines += [f"    #: {option['help']}; {option['range']}{unit}, default {default}", f"    {member}: {kind} | None"]
        lines.append("")
    lines += ["", "#: Members that are no keyword arguments: the package sets them by arguments of its own.",
              "OWN: dict[str, frozenset[str]] = {"]
    lines += [f'    "{struct}": frozenset({sorted(members)}),' for struct, members in OWN.items()] + ["}"]
    lines += ["", "__all__ = ["] + [f'    "{name}",' for name in sorted(names)] + ["]"]
    return "\n".join(lines) + "\n"


def main():
    api = Api(json.loads((ROOT / "docs" / "api.json").read_text()))
    texts = {PACKAGE / "_bindings.py": write_bindings(api),
             PACKAGE / "_options.py": write_options(json.loads((ROOT / "docs" / "options.json").read_text()))}
    if sys.argv[1:] not in ([], ["--check"]):
        sys.exit(__doc__)
    for path, text in texts.items():
        if not sys.argv[1:]:
            path.write_text(text)
        elif not path.exists() or path.read_text() != text:
            sys.exit(f"{path.relative_to(ROOT)} is not what docs/api.json and docs/options.json say: "
                     "run tools/dump_python.py")


main()
