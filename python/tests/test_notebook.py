# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""The view in a notebook: what it draws as it is dragged, and what its page sends."""
from __future__ import annotations

import importlib
import io
import json
import shutil
import subprocess
import sys
import types
import unittest
from typing import Any

import numpy as np

import ewa
from common import ROOT, Case

PAGE = ROOT / "python" / "ewa" / "notebook.js"

#: A page of one picture, as far as the script asks for one.
DRIVER = """
const told = [], heard = {};
const picture = { style: {}, clientWidth: 320, listeners: {}, addEventListener(name, f) { this.listeners[name] = f; },
                  setPointerCapture() {} };
globalThis.document = { createElement: () => picture };
globalThis.URL = { createObjectURL: () => "blob:1", revokeObjectURL() {} };
globalThis.Blob = class { constructor(parts, options) { this.parts = parts; this.type = options.type; } };
const model = { get: () => 640, send: (message) => told.push(message), on: (name, f) => { heard[name] = f; }, off: () => { told.push("off"); } };
const page = (await import(process.argv[2])).default;
const end = page.render({ model, el: { appendChild() {} } });
const event = (more) => ({ preventDefault() {}, pointerId: 1, button: 0, shiftKey: false, ...more });
const answer = () => heard["msg:custom"]({ kind: "picture", type: "image/png" }, [new Uint8Array(1)]);
const fire = (name, more) => picture.listeners[name](event(more));
answer();
fire("pointermove", { clientX: 5, clientY: 5 });
fire("pointerdown", { clientX: 0, clientY: 0 });
fire("pointermove", { clientX: 10, clientY: 0 });
fire("pointermove", { clientX: 10, clientY: 4 });
fire("pointermove", { clientX: 15, clientY: 4 });
answer();
fire("pointerup", {});
answer();
fire("pointerdown", { clientX: 0, clientY: 0, shiftKey: true });
fire("pointermove", { clientX: 3, clientY: 3 });
answer();
fire("pointerup", {});
fire("wheel", { deltaY: -100, deltaMode: 0 });
answer();
await new Promise((resolve) => setTimeout(resolve, 400));
end();
console.log(JSON.stringify(told));
"""


class StandIn:
    """What the view needs of anywidget, where that is not there."""

    def __init__(self) -> None:
        self.heard: Any = None

    def on_msg(self, receive: Any) -> None:
        self.heard = receive

    def send(self, message: Any, buffers: Any = None) -> None:
        raise AssertionError("the test takes what is sent")


def notebook() -> Any:
    """The module, with anywidget, or what stands for it."""
    if "ewa.notebook" in sys.modules:
        return sys.modules["ewa.notebook"]
    try:
        importlib.import_module("anywidget")
        return importlib.import_module("ewa.notebook")
    except ImportError:
        trait = types.SimpleNamespace(tag=lambda **_: 640)
        modules: dict[str, Any] = {"anywidget": types.SimpleNamespace(AnyWidget=StandIn),
                                   "traitlets": types.SimpleNamespace(Int=lambda _: trait)}
        sys.modules.update(modules)
        try:
            return importlib.import_module("ewa.notebook")
        finally:
            for name in modules:
                del sys.modules[name]


class Views(Case):
    def setUp(self) -> None:
        super().setUp()
        self.scene = ewa.Scene(ewa.generate("torus", 2000))
        self.sent: list[tuple[dict[str, Any], bytes]] = []

    def view(self, *arguments: Any, **options: Any) -> Any:
        made = notebook().View(*arguments, **options)
        made.send = lambda message, buffers: self.sent.append((message, buffers[0]))
        return made

    def test_draws(self) -> None:
        view = self.view(self.scene, size=(96, 64))
        view._receive(view, {"whole": True, "again": True}, [])
        expected = self.scene.render(size=(96, 64))
        self.assertEqual(self.sent[-1], ({"kind": "picture", "type": "image/jpeg"}, expected.encode(".jpg")))
        view._receive(view, {"turn": [40, 0], "whole": False}, [])
        self.assertNotEqual(self.sent[-1][1], expected.encode(".jpg"))
        small = ewa.render(self.scene, view.camera.resized(48, 32))
        self.assertEqual(self.sent[-1][1], small.encode(".jpg"))
        clear = self.view(ewa.generate("torus", 500), size=(32, 24), background="transparent")
        clear.show()
        self.assertEqual(self.sent[-1][0]["type"], "image/png")
        with self.assertRaises(TypeError):
            self.view(self.scene, no_such_option=1)

    def test_moves(self) -> None:
        view = self.view(self.scene, ewa.Camera.look_at((0, -4, 1), (0, 0, 0), size=(96, 64)), size=(96, 64))
        before = view.camera
        view._receive(view, {"turn": [100, 0]}, [])
        self.assertAlmostEqual(view.camera.eye[2], before.eye[2])
        self.assertLess(view.camera.eye[0], -1)  # to the left, so that what is seen turns to the right
        view._receive(view, {"turn": [-100, 0]}, [])
        np.testing.assert_allclose(view.camera.world_to_camera, before.world_to_camera, atol=1e-9)
        for drag, sign in ((10000, 1), (-20000, -1)):  # never over a pole
            view._receive(view, {"turn": [0, drag]}, [])
            distance = np.linalg.norm(view.camera.eye - view._pivot)
            self.assertAlmostEqual((view.camera.eye - view._pivot)[2] / distance, sign * np.sin(np.radians(89)), places=6)
        view = self.view(self.scene, before, size=(96, 64))
        view._receive(view, {"nearer": 1}, [])
        self.assertAlmostEqual(np.linalg.norm(view.camera.eye - view._pivot) * 1.1, np.linalg.norm(before.eye - view._pivot))
        view = self.view(self.scene, before, size=(96, 64))
        pixel = before.K @ (before.world_to_camera @ np.append(view._pivot, 1))[:3]
        middle = view._pivot
        view._receive(view, {"shift": [7, -3]}, [])
        shifted = view.camera.K @ (view.camera.world_to_camera @ np.append(middle, 1))[:3]
        np.testing.assert_allclose(shifted[:2] / shifted[2] - pixel[:2] / pixel[2], [7, -3], atol=1e-9)
        kept = view.camera
        view._receive(view, {"turn": [float("nan"), 0]}, [])
        self.assertEqual(view.camera, kept)
        flat = self.view(self.scene, self.scene.camera(ortho=3), size=(96, 64))
        before = flat.camera
        flat._receive(flat, {"nearer": 1, "shift": [4, 4]}, [])
        self.assertAlmostEqual(flat.camera.K[0, 0], before.K[0, 0] * 1.1)

    def test_encode(self) -> None:
        image = self.scene.render(size=(32, 24), planes=("rgba8", "rgba"))
        for suffix in (".png", ".jpg", ".exr"):
            image.save(self.path("a" + suffix))
            self.assertEqual(image.encode(suffix), self.bytes("a" + suffix))
        self.assertEqual(ewa.read_image(io.BytesIO(image.encode())).shape, (24, 32, 3))
        self.assertEqual(image._repr_png_(), image.encode(".png"))

    @unittest.skipUnless(shutil.which("node") and PAGE.exists(), "node is not installed; Debian: nodejs")
    def test_page(self) -> None:
        """One picture is asked for at a time; what moves meanwhile is summed up, in pixels of the picture."""
        with open(self.path("page.mjs"), "wb") as file:
            file.write(PAGE.read_bytes())
        with open(self.path("driver.mjs"), "w", encoding="utf-8") as text:
            text.write(DRIVER)
        done = subprocess.run(["node", self.path("driver.mjs"), self.path("page.mjs")], capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        told = json.loads(done.stdout)
        self.assertEqual([told[0]["whole"], told[0]["again"]], [True, True])
        self.assertEqual([message["turn"] for message in told[1:3]], [[20, 0], [10, 8]])
        self.assertEqual([message["whole"] for message in told[1:3]], [False, False])
        self.assertEqual(told[3]["shift"], [6, 6])
        self.assertEqual(told[4]["nearer"], 1)
        self.assertEqual((told[5]["whole"], told[6:]), (True, ["off"]))


if __name__ == "__main__":
    unittest.main()
