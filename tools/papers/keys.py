# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""One file of the cameras of several, for --path: keys.py KEYS.json CAMERA.json ..."""
import sys

import ewa

ewa.save_cameras(sys.argv[1], [ewa.cameras(path)[0] for path in sys.argv[2:]])
