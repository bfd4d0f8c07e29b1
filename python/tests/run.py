#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Runs the tests of the package `ewa` that is imported, and counts them as tools/check.sh reads it."""
from __future__ import annotations

import sys
import unittest
from pathlib import Path


def main() -> None:
    folder = str(Path(__file__).resolve().parent)
    sys.path.insert(0, folder)
    import ewa

    print(f"Python {sys.version.split()[0]}, ewa {ewa.__version__} of {Path(ewa.__file__).parent}")
    pattern = sys.argv[1] if len(sys.argv) > 1 else "test_*.py"
    result = unittest.TextTestRunner(verbosity=1).run(unittest.defaultTestLoader.discover(folder, pattern))
    failed = len(result.failures) + len(result.errors) + len(result.unexpectedSuccesses)
    skipped = len(result.skipped)
    sys.stderr.flush()
    print(f"[  PASSED  ] {max(result.testsRun - failed - skipped, 0)} test(s).")
    if skipped:
        print(f"[  SKIPPED ] {skipped} test(s).")
    if failed:
        print(f"[  FAILED  ] {failed} test(s).")
    sys.stdout.flush()
    sys.exit(1 if failed or not result.testsRun else 0)


if __name__ == "__main__":  # processes that tests start import this file
    main()
