# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""What changes from frame to frame of trained Gaussians on a turntable, by either order.

    gaussian_popping.py FILE ...

Of 200 frames in steps of 0.002 degrees: the share of pixels that change by more than 1 % from one to the next, and the largest
change; of 361 frames over 90 degrees: the largest RMS of a step.
"""
import sys

import ewa
import numpy as np
from gaussian_formula import display


def changes(splats, start, order, first_deg, step_deg, count):
    """Of every step the share of pixels that change by more than 1 %, the largest change, and the RMS."""
    pivot, found, before = splats.core.mean(0), [], None
    for i in range(count):
        camera = start.orbit(pivot, (0, 1, 0), first_deg + i * step_deg)
        picture = display(ewa.render_gaussians(splats, camera, order=order, planes=("rgba",), background="transparent"))
        if before is not None:
            change = np.abs(picture - before).max(-1)
            found.append(((change > 0.01).mean(), change.max(), np.sqrt((change ** 2).mean())))
        before = picture
    return np.array(found)


print("| file | order | pixels that change by > 1 % in 0.002° | the most | largest RMS in 0.25° |\n|---|---|---:|---:|---:|")
for path in sys.argv[1:]:
    splats = ewa.Splats(ewa.read_gaussians(path))
    start = ewa.Camera.frame(splats, size=(400, 400))
    for order in ("centre", "ray"):
        small, large = changes(splats, start, order, 0, 0.002, 200), changes(splats, start, order, 0, 0.25, 361)
        print(f"| {path.rsplit('/', 1)[-1]} | {order} | {100 * small[:, 0].mean():.4f} % | {small[:, 1].max():.3f} "
              f"| {large[:, 2].max():.4f} |", flush=True)
