#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Whether the routes of docs/architecture.md can be gone: "One surfel from file to pixel", and those of "Further routes".

    check_route.py [ROOT]

Every stop is "`function()` in `file`". Fails where the file does not define the function, where no file of an earlier stop
names it, and when a route is not ten lines.
"""
import re
import sys
from pathlib import Path


def follow(root, route):
    """How many stops there are, and what is wrong."""
    lines = re.findall(r"(?m)^\d+\. .*$", route)
    stops = re.findall(r"`(\w+)\(\)` in\s+`([\w/.]+)`", route)
    wrong, before = [], ""
    for function, name in stops:
        path = root / name
        text = path.read_text() if path.is_file() else ""
        definition = rf"(?m)^\s*def {function}\(" if name.endswith(".py") else rf"(?m)^[a-z][^;=]*?\b{function}\([^;{{]*\{{"
        if not re.search(definition, text):
            wrong.append(f"{name} does not define {function}()")
        if before and not re.search(rf"\b{function}\b", before):
            wrong.append(f"{function}() is not named on the way there")
        before += text
    if len(lines) != 10:
        wrong.append(f"{len(lines)} lines")
    return len(stops), wrong


def main():
    root = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).resolve().parent.parent)
    page = (root / "docs" / "architecture.md").read_text()
    routes = [page.partition("## One surfel from file to pixel\n")[2].partition("\n## ")[0]]
    routes += page.partition("## Further routes\n")[2].partition("\n## ")[0].split("\n### ")[1:]
    count, wrong = 0, []
    for route in routes:
        stops, problems = follow(root, route)
        count += stops
        wrong += problems
    print("\n".join(wrong) or f"{len(routes)} routes, {count} stops")
    sys.exit(bool(wrong))


main()
