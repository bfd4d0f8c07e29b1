#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Writes an equirectangular environment as PFM: sky, a sun of linear light 30, a checkered floor.

make_environment.py OUT.pfm [HEIGHT]

The middle of the picture is +z, its upper edge +y; see docs/shading.md.
"""
import math
import struct
import sys

SUN = (0.49, 0.64, 0.59)


def light(x, y, z):
    """Returns linear red, green and blue from the unit direction (x, y, z)."""
    if y < -0.02:
        across, along = -2 * x / y, -2 * z / y
        bright = (math.floor(across) + math.floor(along)) % 2
        near = math.exp(-math.hypot(across, along) / 12)
        return [near * (c + d * bright) + (1 - near) * 0.35 for c, d in ((0.08, 0.5), (0.07, 0.42), (0.06, 0.3))]
    toward_sun = sum(a * b for a, b in zip((x, y, z), SUN))
    if toward_sun > 0.993:
        return [30, 27, 22]
    return [0.55 - 0.45 * y, 0.7 - 0.4 * y, 0.9 - 0.15 * y]


def main():
    path, height = sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 256
    width = 2 * height
    with open(path, "wb") as file:
        file.write(b"PF\n%d %d\n-1.0\n" % (width, height))
        for row in reversed(range(height)):  # from the bottom
            latitude = math.pi * (0.5 - (row + 0.5) / height)
            numbers = []
            for column in range(width):
                longitude = 2 * math.pi * (0.5 - (column + 0.5) / width)
                numbers += light(math.cos(latitude) * math.sin(longitude), math.sin(latitude),
                                 math.cos(latitude) * math.cos(longitude))
            file.write(struct.pack("<%df" % len(numbers), *numbers))


main()
