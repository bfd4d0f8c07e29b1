# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Columns of a CSV file over its first: curves.py GRAPH.svg X_LABEL Y_LABEL FILE.csv COLUMN=LABEL ..."""
import csv
import sys

from style import plt, save

path, x_label, y_label, source = sys.argv[1:5]
with open(source, newline="") as file:
    rows = list(csv.DictReader(file))
first = next(iter(rows[0]))
figure, axes = plt.subplots(figsize=(5.2, 2.8))
for argument in sys.argv[5:]:
    column, label = argument.rsplit("=", 1)
    axes.plot([float(row[first]) for row in rows], [float(row[column]) for row in rows], label=label)
axes.set(xlabel=x_label, ylabel=y_label, ylim=(0, None))
axes.legend()
save(figure, path)
