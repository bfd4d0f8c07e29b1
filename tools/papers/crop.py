# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""A part of a picture, each pixel so many times as large: crop.py PICTURE.png PART.png X Y WIDTH HEIGHT TIMES"""
import sys

import ewa
import numpy as np

x, y, width, height, times = map(int, sys.argv[3:])
part = np.asarray(ewa.read_image(sys.argv[1]), np.float32)[y:y + height, x:x + width, :3]
ewa.save_image(sys.argv[2], np.ascontiguousarray(part.repeat(times, 0).repeat(times, 1)))
