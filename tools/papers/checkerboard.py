# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""A picture of a black and white checkerboard: checkerboard.py PICTURE.png SIDE_PX SQUARE_PX"""
import sys

import ewa
import numpy as np

place = np.arange(int(sys.argv[2])) // int(sys.argv[3])
ewa.save_image(sys.argv[1], np.repeat(((place[:, None] + place) % 2)[..., None], 3, 2).astype(np.float32))
