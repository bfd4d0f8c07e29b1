# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""PSNR of pictures to a true one, in sRGB numbers: compare.py NAME.table TRUTH.png NAME=PICTURE.png ..."""
import sys

import ewa
import numpy as np
from style import table


def display(path):
    """What a screen gets of a picture, 0 to 1."""
    linear = np.asarray(ewa.read_image(path), float)[..., :3]
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * np.maximum(linear, 0.0031308) ** (1 / 2.4) - 0.055)


truth, rows = display(sys.argv[2]), []
for argument in sys.argv[3:]:
    name, path = argument.rsplit("=", 1)
    error = ((display(path) - truth) ** 2).mean()
    rows.append((name, "the same pixels" if error == 0 else f"{-10 * np.log10(error):.2f}"))
table(sys.argv[1], ("picture", "PSNR, dB"), rows)
