# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""How much of each frequency there is in the middle half of a few rows of pictures:
spectrum.py FIRST_ROW LAST_ROW GRAPH.svg NAME=PICTURE.png ..."""
import sys

import ewa
import numpy as np
from style import plt, save

first, last, path = int(sys.argv[1]), int(sys.argv[2]), sys.argv[3]
figure, axes = plt.subplots(figsize=(5.2, 2.6))
for argument in sys.argv[4:]:
    name, picture = argument.rsplit("=", 1)
    rows = np.asarray(ewa.read_image(picture), float)[first:last + 1, :, 1]
    rows = rows[:, rows.shape[1] // 4:-(rows.shape[1] // 4)]  # at the sides there is sky
    window = np.hanning(rows.shape[1])
    lines = np.abs(np.fft.rfft((rows - rows.mean(1, keepdims=True)) * window)) / window.sum() * 2
    axes.plot(np.fft.rfftfreq(rows.shape[1]), 100 * np.sqrt((lines ** 2).mean(0)), label=f"{name}: contrast {100 * rows.std():.2g} %")
axes.set(xlabel="cycles per pixel", ylabel="amplitude, % of white", xlim=(0, 0.5), ylim=(0, None),
         title=f"middle of rows {first} to {last}, where a square is far smaller than a pixel")
axes.legend()
save(figure, path)
