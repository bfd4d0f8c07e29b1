# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Memory over the number of layers beside table 1 of SS: ss_memory.py NAME.table WIDTH HEIGHT LAYERS=STATS.json ..."""
import json
import sys

from style import table

pixels, rows = int(sys.argv[2]) * int(sys.argv[3]), []
for argument in sys.argv[4:]:
    layers, path = argument.rsplit("=", 1)
    with open(path) as file:
        peak = json.load(file)["peak_memory_bytes"]
    rows.append((layers, "-" if layers == "exact" else f"{38 * int(layers)}", "-" if layers == "exact" else f"{38e-6 * int(layers) * pixels:.0f}", f"{peak / 1e6:.1f}"))
table(sys.argv[1], ("layers", "the paper, bytes per pixel", "the paper, MB", "here: peak of the whole program, MB"), rows)
