# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""What the tests share: a folder of their own, the program, and warnings that are errors unless they are asked for."""
from __future__ import annotations

import os
import subprocess
import tempfile
import unittest
import warnings
from pathlib import Path

import ewa

ROOT = Path(__file__).resolve().parents[2]


def program() -> str | None:
    """The program `ewa`: EWA_PROGRAM, or that of the checkout."""
    asked = os.environ.get("EWA_PROGRAM")
    built = ROOT / "build" / "release" / "cli" / "ewa"
    return asked or (str(built) if built.exists() else None)


class Case(unittest.TestCase):
    """A test in a folder that is gone afterwards."""

    def setUp(self) -> None:
        self._folder = tempfile.TemporaryDirectory()
        self.addCleanup(self._folder.cleanup)
        self._caught = warnings.catch_warnings()
        self._caught.__enter__()
        self.addCleanup(self._caught.__exit__, None, None, None)
        warnings.simplefilter("error", ewa.EwaWarning)

    def path(self, name: str) -> str:
        return os.path.join(self._folder.name, name)

    def bytes(self, name: str) -> bytes:
        with open(self.path(name), "rb") as file:
            return file.read()

    def run_program(self, *arguments: str) -> None:
        """Run the program in the test's folder."""
        found = program()
        if found is None:
            self.skipTest("the program ewa is not there; EWA_PROGRAM names it")
        done = subprocess.run([found, *arguments], cwd=self._folder.name, capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, f"ewa {' '.join(arguments)}: {done.stderr}")
