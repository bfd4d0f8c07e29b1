# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""The examples of docs/python.md run, and the notebook's page is what the notebook gives."""
from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import unittest
import warnings

import numpy as np

import ewa
from common import ROOT, Case

PAGE = ROOT / "docs" / "python.md"


@unittest.skipUnless(PAGE.exists(), "not in a checkout")
class Examples(Case):
    def make_files(self) -> None:
        ewa.generate("torus", 8000).save(self.path("scan.ply"))
        ground = ewa.generate("terrain", 8000)
        ground["classification"] = np.where(ground.scalar("z") > 0.1, 6, 2).astype(np.uint8)
        ground.save(self.path("survey.laz"))
        ewa.generate_volume("vessels", dims=[48, 48, 48]).save(self.path("vessels.nrrd"))
        ewa.save_image(self.path("color.png"), np.random.default_rng(1).random((60, 80, 3)).astype(np.float32))
        corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
        with open(self.path("part.stl"), "w", encoding="utf-8") as file:
            file.write("solid part\n")
            for face in ((0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)):
                lines = "".join("vertex {} {} {}\n".format(*corners[k]) for k in face)
                file.write(f"facet normal 0 0 0\nouter loop\n{lines}endloop\nendfacet\n")
            file.write("endsolid part\n")
        depth = np.full((60, 80), 2.0, np.float32)
        depth[20:40, 30:60] = 1.0
        grey16_png(self.path("depth.png"), (1000 * depth).astype(np.uint16))

    def test_page(self) -> None:
        self.make_files()
        blocks = re.findall(r"```python\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.S)
        self.assertEqual(len(blocks), 13)
        before = os.getcwd()
        self.addCleanup(os.chdir, before)
        os.chdir(os.path.dirname(self.path("x")))
        for i, block in enumerate(blocks):
            if "ewa.film(" in block and not shutil.which("ffmpeg"):
                continue
            with self.subTest(i + 1), warnings.catch_warnings():
                warnings.simplefilter("error")
                exec(compile(block, f"docs/python.md, example {i + 1}", "exec"), {})
        made = {name for name in os.listdir(".") if os.path.getsize(name) > 500}
        self.assertLessEqual({"scan.png", "ellipses.ply", "map.png", "ground.csv", "solids.png", "ring.png",
                              "vessels.png", "floor.exr", "gaussians.png"}, made)

    def test_gradients_page(self) -> None:
        blocks = re.findall(r"```python\n(.*?)```", (ROOT / "docs" / "gradients.md").read_text(encoding="utf-8"), re.S)
        self.assertEqual(len(blocks), 1)
        exec(compile(blocks[0], "docs/gradients.md", "exec"), {})

    def test_notebook_page(self) -> None:
        done = subprocess.run([sys.executable, str(ROOT / "tools" / "notebook.py"), "--check"], capture_output=True,
                              text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)


def grey16_png(path: str, pixels: np.ndarray) -> None:
    """Write 16 bits of grey, which the library does not."""
    import struct
    import zlib

    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    height, width = pixels.shape
    rows = b"".join(b"\0" + row.astype(">u2").tobytes() for row in pixels)
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 16, 0, 0, 0, 0))
                   + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


if __name__ == "__main__":
    unittest.main()
