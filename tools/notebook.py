#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Runs examples/tour.ipynb and writes what it shows, without Jupyter.

    notebook.py           writes docs/python_notebook.md and the pictures in docs/python_notebook anew
    notebook.py --check   fails when they are not what the notebook gives
"""
import ast
import contextlib
import io
import json
import sys
import tempfile
from pathlib import Path

import ewa

ROOT = Path(__file__).resolve().parent.parent
NOTEBOOK, PAGE = ROOT / "examples" / "tour.ipynb", ROOT / "docs" / "python_notebook.md"
HEAD = "<!-- Made of examples/tour.ipynb by tools/notebook.py; a test holds it to that. Do not edit. -->\n"


def run_cell(source, names):
    """What a cell prints, and the value of its last expression."""
    tree = ast.parse(source)
    last = tree.body.pop() if tree.body and isinstance(tree.body[-1], ast.Expr) else None
    printed, value = io.StringIO(), None
    with contextlib.redirect_stdout(printed):
        exec(compile(tree, NOTEBOOK.name, "exec"), names)
        if last is not None:
            value = eval(compile(ast.Expression(last.value), NOTEBOOK.name, "eval"), names)
    return printed.getvalue(), value


def render(folder):
    """The page; its pictures go to a folder."""
    parts, names, pictures = [HEAD], {}, 0
    for cell in json.loads(NOTEBOOK.read_text())["cells"]:
        source = "".join(cell["source"])
        if cell["cell_type"] == "markdown":
            parts.append(source + "\n")
            continue
        parts.append(f"```python\n{source}\n```\n")
        printed, value = run_cell(source, names)
        if value is not None and not isinstance(value, ewa.Image):
            printed += repr(value) + "\n"
        if printed:
            parts.append(f"```\n{printed}```\n")
        if isinstance(value, ewa.Image):
            pictures += 1
            value.save(folder / f"{pictures}.png")
            parts.append(f"![picture {pictures}]({PAGE.stem}/{pictures}.png)\n")
    return "\n".join(parts), pictures


def main():
    pictures = PAGE.with_suffix("")
    if not sys.argv[1:]:
        pictures.mkdir(exist_ok=True)
        PAGE.write_text(render(pictures)[0])
        return
    if sys.argv[1:] != ["--check"]:
        sys.exit(__doc__)
    with tempfile.TemporaryDirectory() as folder:
        text, count = render(Path(folder))
        if not PAGE.exists() or text != PAGE.read_text():
            sys.exit(f"{PAGE.name} is not what {NOTEBOOK.name} gives: run tools/notebook.py")
        for i in range(1, count + 1):  # pixels: compression may differ
            ours, there = (ewa.read_image(path / f"{i}.png") for path in (Path(folder), pictures))
            if ours.tobytes() != there.tobytes():
                sys.exit(f"picture {i} is not what {NOTEBOOK.name} gives: run tools/notebook.py")


main()
