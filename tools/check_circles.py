#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Whether files need each other in a circle.

    check_circles.py [ROOT]

A unit is a file of src/ or cli/ with its header: room/name.c and room/name.h. Unit A needs unit B when A names a function
that B defines: one with external linkage in B's .c, or an inline one in B's .h that A includes, itself or by way of others.
(Types alone do not count: a header that several files share lies below all of them.) A file of python/ewa needs another
one when it imports from it, wherever in the file, but for the eyes of type checkers alone. Fails, and lists the functions, for
every circle, and for every need of a room of src/ that the table of docs/architecture.md has on the same or a higher
floor, whatever header declares the function; otherwise prints how many units there are and how many needs.
"""
import ast
import re
import sys
from pathlib import Path

ROOMS = ("src", "cli")
NOISE = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])*\'|^[ \t]*#(?:\\\n|[^\n])*', re.S | re.M)


class File:
    def __init__(self, path):
        text = path.read_text()
        self.includes = re.findall(r'^[ \t]*#[ \t]*include[ \t]+"([^"]+)"', text, re.M)
        text = NOISE.sub(" ", text)
        self.outside, self.inside = set(), set()  # functions that others may name, and those of its own
        self.names = set()  # those in bodies and tables; a declaration is no need
        depth, start, at = 0, 0, 0
        for match in re.finditer(r"[{};]", text):
            if depth:
                self.names |= set(re.findall(r"\b[a-z_]\w*\b", text[at:match.start()]))
            at = match.end()
            if match.group() == "{":
                depth += 1
                head = text[start:match.start()]
                name = re.match(r"([\w\s*]*?\b(\w+))\s*\(", head)
                if depth == 1 and name and head.rstrip().endswith(")"):
                    static = path.suffix == ".c" and bool({"static", "INLINE"} & set(name.group(1).split()))
                    (self.inside if static else self.outside).add(name.group(2))
            elif match.group() == "}":
                depth -= 1
            if depth == 0:
                start = match.end()


def read(root):
    files = {}
    for room in ROOMS:
        for path in sorted([*(root / room).rglob("*.[ch]"), *(root / room).rglob("*.cpp")]):
            files[str(path.relative_to(root))] = File(path)
    return files


def headers_of(files, name, seen):
    """The headers that a file includes, itself or by way of others."""
    for header in files[name].includes:
        for found in (f"src/{header}", header, str(Path(name).parent / header)):
            if found in files and found not in seen:
                seen.add(found)
                headers_of(files, found, seen)
    return seen


def needs_of(files):
    """unit -> other unit -> the functions of it that are named."""
    linked, inline = {}, {}
    for name, file in files.items():
        for function in file.outside:
            (linked if name.endswith(".c") else inline).setdefault(function, set()).add(name)
    needs = {}
    for name, file in files.items():
        unit = name[:-2]
        needs.setdefault(unit, {})
        seen = headers_of(files, name, set())
        for function in file.names - file.inside - file.outside:
            places = linked.get(function, set()) | (inline.get(function, set()) & seen)
            for place in places:
                if place[:-2] != unit and (place.startswith("src/") or unit.startswith("cli/")):
                    needs[unit].setdefault(place[:-2], set()).add(function)
    return needs


def needs_of_python(root):
    """module -> other module -> the names that are imported from it."""
    needs = {}
    for path in sorted((root / "python" / "ewa").glob("*.py")):
        tree = ast.parse(path.read_text())
        for_types = {id(inner) for node in ast.walk(tree) if isinstance(node, ast.If)
                     and getattr(node.test, "id", "") == "TYPE_CHECKING" for inner in ast.walk(node)}
        own = needs.setdefault(f"python/ewa/{path.stem}", {})
        for node in ast.walk(tree):
            if not isinstance(node, ast.ImportFrom) or node.level != 1 or id(node) in for_types:
                continue
            for alias in node.names:
                other = (node.module or alias.name).split(".")[0]
                own.setdefault(f"python/ewa/{other}", set()).add(alias.name)
    return needs


def circles_of(needs):
    """Tarjan's strongly connected components of more than one unit."""
    index, low, stack, found = {}, {}, [], []

    def visit(unit):
        index[unit] = low[unit] = len(index)
        stack.append(unit)
        for other in needs.get(unit, {}):
            if other not in index:
                visit(other)
                low[unit] = min(low[unit], low[other])
            elif other in stack:
                low[unit] = min(low[unit], index[other])
        if low[unit] == index[unit]:
            circle = stack[stack.index(unit):]
            del stack[stack.index(unit):]
            if len(circle) > 1:
                found.append(sorted(circle))

    for unit in needs:
        if unit not in index:
            visit(unit)
    return sorted(found)


def climbs_of(root, needs):
    """Needs of other rooms that are not on a lower floor."""
    table = re.findall(r"(?m)^\| *(\d+) *\| `src/(\w+)`", (root / "docs" / "architecture.md").read_text())
    floor = {room: int(number) for number, room in table}
    room = lambda unit: unit.split("/")[1]
    return [(unit, other) for unit in sorted(needs) for other in sorted(needs[unit])
            if unit.startswith("src/") and room(unit) != room(other) and floor[room(other)] >= floor[room(unit)]]


def main():
    root = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).resolve().parent.parent).resolve()
    sys.setrecursionlimit(10000)
    needs = {**needs_of(read(root)), **needs_of_python(root)}
    circles = circles_of(needs)
    for circle in circles:
        print("circle: " + " ".join(circle))
        for unit in circle:
            for other in sorted(set(needs[unit]) & set(circle)):
                print(f"  {unit} needs {', '.join(sorted(needs[unit][other]))} of {other}")
    climbs = climbs_of(root, needs)
    for unit, other in climbs:
        print(f"climbs: {unit} needs {', '.join(sorted(needs[unit][other]))} of {other}")
    sys.stdout.flush()
    if circles or climbs or not needs:
        sys.exit(f"{len(circles)} circles and {len(climbs)} climbing needs among {len(needs)} units")
    print(f"{len(needs)} units, {sum(map(len, needs.values()))} needs, no circle, none climbs")


main()
