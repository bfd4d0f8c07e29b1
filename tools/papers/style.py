# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""What the graphs of docs/papers share: fonts, colours, sizes, and how tables are written."""
import os

import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt  # noqa: E402

#: Colours that colour-blind readers tell apart (Okabe and Ito 2008): the exact or ours, the paper's, and what stands beside them.
OURS, PAPER, OTHER, FOURTH, GREY = "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#777777"

#: Whether this is the quick run of the tests, which wants few of everything.
QUICK = "EWA_QUICK" in os.environ

plt.rcParams.update({
    "font.family": "DejaVu Sans", "font.size": 9, "axes.titlesize": 9, "axes.labelsize": 9, "legend.fontsize": 8,
    "axes.spines.top": False, "axes.spines.right": False, "axes.grid": True, "grid.color": "#dddddd", "grid.linewidth": 0.5,
    "lines.linewidth": 1.4, "legend.frameon": False, "figure.constrained_layout.use": True, "svg.hashsalt": "ewa",
    "axes.prop_cycle": matplotlib.cycler(color=[OURS, PAPER, OTHER, FOURTH, GREY]),
})


def save(figure, path):
    """Write a graph, on white, without the time at which it was made."""
    figure.savefig(path, facecolor="white", metadata={"Date": None})
    plt.close(figure)


def bare(axes):
    """Make axes a drawing: no frame, no ticks, equal units."""
    axes.set_aspect("equal")
    axes.axis("off")


def table(path, head, rows):
    """Write a table as Markdown; rows hold text or numbers that are written as they are."""
    with open(path, "w") as file:
        file.write("| " + " | ".join(head) + " |\n|" + "---|" * len(head) + "\n")
        for row in rows:
            file.write("| " + " | ".join(str(cell) for cell in row) + " |\n")
