# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Misuse ends in exceptions: use after close, freed memory, threads, forks, interruptions."""
from __future__ import annotations

import gc
import os
import signal
import subprocess
import sys
import textwrap
import threading
import time
import unittest

import numpy as np

import ewa
from common import Case


class Limits(Case):
    def test_ctrl_c(self) -> None:
        """Ends within 0.3 s of the processor what is long, also where the library cannot stop: pictures are written on."""
        path, code = self.path("big.png"), textwrap.dedent("""
            import os, signal, sys, threading, time
            import numpy as np, ewa
            pixels = np.random.default_rng(1).random((3000, 4000, 3)).astype(np.float32)
            mesh = ewa.Mesh(np.eye(4, 3), [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
            sphere, cube = ewa.generate("sphere", 200000, size_world=2.5), ewa.generate("cube", 200000)
            calls = {
                "compare": lambda: ewa.compare_images(pixels, pixels), "save": lambda: ewa.save_image(sys.argv[1], pixels),
                "sample": lambda: mesh.sample(point_count=5000000), "estimate": lambda: ewa.Cloud(sphere["position"]).estimate(),
                "csg": lambda: ewa.csg(cube, sphere, "difference"),
            }
            for name, call in calls.items():
                sent = []
                def interrupt():
                    sent.append((time.monotonic(), time.process_time()))
                    os.kill(os.getpid(), signal.SIGINT)
                timer = threading.Timer(0.05, interrupt)
                timer.start()
                try:
                    call()
                    time.sleep(5)
                except KeyboardInterrupt:
                    print(name, time.monotonic() - sent[0][0], time.process_time() - sent[0][1])
                timer.join()
            print(ewa.default_context().worker_count > 0)
            """)
        done = subprocess.run([sys.executable, "-c", code, path], capture_output=True, text=True, check=False, timeout=120)
        lines = done.stdout.split("\n")
        self.assertEqual((len(lines), lines[5:]), (7, ["True", ""]), done.stdout + done.stderr)
        for line in lines[:5]:
            name, _, took_s = line.split()
            self.assertLess(float(took_s), 0.6, f"{name}, by two processors")
        self.assertEqual(ewa.read_image(path).shape, (3000, 4000, 3))

    def test_surfels_need_their_cloud_no_longer(self) -> None:
        """Also where a camera is placed at them: the memory of the cloud's points is another's by then."""
        surfels = ewa.generate("torus", 400000).surfels()
        others = [np.full((400000, 3), np.nan, np.float32) for _ in range(4)]
        picture = ewa.render(surfels, size=(64, 48))
        cloud = ewa.generate("torus", 400000)
        np.testing.assert_allclose(ewa.Camera.frame(cloud, size=(64, 48)).world_to_camera, picture.camera.world_to_camera, atol=1e-3)
        del others

    def test_memory_time_and_names(self) -> None:
        ewa.generate("torus", 20000).save(self.path("many.ply"))
        with ewa.Context(thread_count=1, max_memory_bytes=100_000) as small:
            with self.assertRaisesRegex(ewa.OutOfMemory, "bytes are needed, .* of max_memory_bytes 100000 are left"):
                ewa.read(self.path("many.ply"), context=small)
        with ewa.Context(thread_count=1, max_points=19999) as few, self.assertRaises(ewa.OutOfMemory):
            ewa.read(self.path("many.ply"), context=few)
        with ewa.Context(thread_count=1, max_seconds=1e-6) as short, self.assertRaises(ewa.Cancelled):
            ewa.read(self.path("many.ply"), context=short).estimate()
        with open(self.path("grid.nhdr"), "w", encoding="ascii") as file:
            file.write("NRRD0004\ntype: uint8\ndimension: 3\nsizes: 4 4 4\nencoding: raw\ndata file: grid.raw\n\n")
        with open(self.path("grid.raw"), "wb") as file:
            file.write(bytes(range(64)))
        self.assertEqual(ewa.read_volume(self.path("grid.nhdr")).voxels.shape, (4, 4, 4))
        with ewa.Context(thread_count=1, untrusted=True) as untrusted:
            with self.assertRaisesRegex(ewa.FileError, "files that others name are not opened"):
                ewa.read_volume(self.path("grid.nhdr"), context=untrusted)
            self.assertEqual(len(ewa.read(self.path("many.ply"), context=untrusted)), 20000)
        with self.assertRaises(ewa.ArgumentError):
            ewa.Context(max_seconds=-1)
        with self.assertRaises(ewa.ArgumentError):
            ewa.Context(named_files="everywhere")
        with self.assertRaises(TypeError):
            ewa.Context(max_bytes=1)  # type: ignore[call-arg]


class Closed(Case):
    def test_everything_of_a_closed_context_raises(self) -> None:
        context = ewa.Context(thread_count=1)
        cloud = ewa.generate("torus", 2000, context=context)
        positions, surfels = cloud["position"], cloud.surfels()
        volume = ewa.generate_volume("ball", dims=[16, 16, 16], context=context)
        voxels, mesh = ewa.Voxels(volume), ewa.Mesh(np.eye(3), [[0, 1, 2]], context=context)
        renderer, shown = ewa.Renderer(context=context), volume.voxels
        camera = ewa.Camera.frame(cloud, size=(32, 32))
        environment = ewa.Environment(np.ones((4, 8, 3), np.float32), context=context)
        context.close()
        context.close()
        for use in (lambda: len(cloud), lambda: cloud["position"], lambda: cloud.estimate(), lambda: cloud.surfels(),
                    lambda: cloud.save(self.path("a.ply")), lambda: cloud.notes, lambda: surfels.bounds,
                    lambda: ewa.render(surfels, camera), lambda: volume.range, lambda: volume.voxels,
                    lambda: ewa.render_volume(voxels, camera), lambda: mesh.closed, lambda: mesh.sample(),
                    lambda: mesh.vertices, lambda: context.worker_count, lambda: ewa.generate(context=context),
                    lambda: renderer.render(surfels, camera), lambda: cloud.crop((0, 0, 0), (1, 1, 1)),
                    lambda: ewa.render(ewa.generate(), camera, environment=environment),
                    lambda: ewa.read(self.path("a.ply"), context=context)):
            with self.assertRaises(ewa.Error):
                use()
        self.assertTrue(np.isfinite(positions).all())  # arrays keep what they show
        self.assertEqual(shown.shape, (16, 16, 16))
        del cloud, surfels, volume, voxels, mesh, renderer, environment
        gc.collect()
        self.assertTrue(np.isfinite(positions).all())
        del positions, shown
        gc.collect()

    def test_closed_objects_raise(self) -> None:
        cloud = ewa.generate("torus", 2000)
        normals, surfels = cloud["normal"], cloud.surfels()
        derived = cloud.estimate()
        cloud.close()
        surfels.close()
        for use in (lambda: len(cloud), lambda: cloud["normal"], lambda: list(cloud), lambda: surfels.bounds,
                    lambda: ewa.render(surfels), lambda: ewa.csg(cloud, cloud), lambda: ewa.merge([cloud])):
            with self.assertRaises(ewa.ClosedError):
                use()
        gc.collect()
        np.testing.assert_array_equal(derived["normal"], normals)
        self.assertIn("closed", repr(cloud) + repr(surfels))

    def test_arrays_outlive_everything(self) -> None:
        context = ewa.Context(thread_count=1)
        cloud = ewa.generate("torus", 5000, context=context).transform(np.eye(4))
        arrays = {name: cloud[name] for name in cloud}
        copies = {name: array.copy() for name, array in arrays.items()}
        context.close()
        del cloud, context
        gc.collect()
        ewa.generate("torus", 5000)
        for name, array in arrays.items():
            np.testing.assert_array_equal(array, copies[name])

    def test_freed_arrays_are_noticed(self) -> None:
        positions = np.random.default_rng(1).random((1000, 3))
        cloud = ewa.Cloud(positions)
        derived = cloud.estimate()
        positions.resize((100000, 3), refcheck=False)
        for use in (lambda: cloud.estimate(), lambda: cloud["position"], lambda: derived.surfels()):
            with self.assertRaises(ewa.ClosedError):
                use()
        base = np.random.default_rng(1).random((1000, 4))
        cloud = ewa.Cloud(base[:, :3])
        base.resize((0, 4), refcheck=False)
        with self.assertRaises(ewa.ClosedError):
            cloud.surfels()

    def test_objects_of_two_contexts_do_not_mix(self) -> None:
        with ewa.Context(thread_count=1) as a, ewa.Context(thread_count=1) as b:
            first, second = ewa.generate("torus", 2000, context=a), ewa.generate("torus", 2000, context=b)
            for use in (lambda: ewa.merge([first, second]), lambda: ewa.csg(first, second),
                        lambda: ewa.render([first, second]),
                        lambda: ewa.render(first, renderer=ewa.Renderer(context=b))):
                with self.assertRaises(ewa.Error):
                    use()


class Interrupted(Case):
    def test_progress_and_its_exceptions(self) -> None:
        stages: list[tuple[str, float]] = []
        with ewa.progress(lambda stage, fraction: stages.append((stage, fraction))):
            cloud = ewa.generate("torus", 50000, positions_only=True).estimate()
        self.assertTrue(stages and all(0 <= fraction <= 1 for _, fraction in stages))
        bare = ewa.Cloud(cloud["position"])
        with ewa.progress(lambda stage, fraction: False), self.assertRaises(ewa.Cancelled):
            bare.estimate()

        def broken(stage: str, fraction: float) -> None:
            raise RuntimeError("of the caller")

        with ewa.progress(broken), self.assertRaisesRegex(RuntimeError, "of the caller"):
            bare.estimate()

        def inside(stage: str, fraction: float) -> None:
            len(bare)

        with ewa.progress(inside), self.assertRaisesRegex(ewa.Error, "during its own call"):
            bare.estimate()
        self.assertEqual(bare.estimate().keys(), ["position", "radius", "normal", "signed_curvature"])

    def test_control_c(self) -> None:
        cloud = ewa.generate("terrain", 400000, positions_only=True)
        before = signal.signal(signal.SIGINT, signal.default_int_handler)
        self.addCleanup(signal.signal, signal.SIGINT, before)
        timer = threading.Timer(0.1, os.kill, (os.getpid(), signal.SIGINT))
        timer.start()
        started = time.monotonic()
        with self.assertRaises(KeyboardInterrupt):
            for _ in range(100):
                cloud.estimate()
        self.assertLess(time.monotonic() - started, 20)
        timer.join()
        self.assertEqual(len(cloud), 400000)

    def test_control_c_stops_at_the_next_report(self) -> None:
        cloud = ewa.generate("terrain", 100000, positions_only=True)
        before = signal.signal(signal.SIGINT, signal.default_int_handler)
        self.addCleanup(signal.signal, signal.SIGINT, before)
        calls: list[float] = []

        def press(stage: str, fraction: float) -> None:
            calls.append(fraction)
            if len(calls) == 1:
                os.kill(os.getpid(), signal.SIGINT)

        with ewa.progress(press), self.assertRaises(KeyboardInterrupt):
            cloud.estimate()
        self.assertLessEqual(len(calls), 2)
        self.assertIs(signal.getsignal(signal.SIGINT), signal.default_int_handler)

    def test_progress_by_tqdm(self) -> None:
        try:
            import tqdm  # noqa: F401
        except ImportError:
            with self.assertRaises(ImportError):
                ewa.progress().__enter__()
            return
        with ewa.progress():
            ewa.generate("torus", 20000)


class Threads(Case):
    def test_threads_of_one_context(self) -> None:
        cloud = ewa.generate("torus", 3000)
        camera = ewa.Camera.frame(cloud, size=(64, 64))
        surfels = cloud.surfels()
        expected = np.asarray(ewa.render(surfels, camera)).tobytes()
        failures: list[str] = []

        def work() -> None:
            for _ in range(20):
                made = ewa.generate("torus", 3000)
                if np.asarray(ewa.render(made, camera)).tobytes() != expected:
                    failures.append("other bytes")
                if np.asarray(ewa.render(surfels, camera)).tobytes() != expected:
                    failures.append("other bytes of shared surfels")

        threads = [threading.Thread(target=work) for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(failures, [])

    def test_closing_while_others_work(self) -> None:
        for _ in range(10):
            context = ewa.Context(thread_count=2)
            cloud = ewa.generate("torus", 3000, context=context)
            errors: list[BaseException] = []

            def work() -> None:
                try:
                    while True:
                        made = cloud.estimate(keep_normals=False)
                        made["normal"], made.notes, made.surfels()
                except ewa.ClosedError:
                    pass
                except BaseException as error:  # noqa: B902 - told by the main thread
                    errors.append(error)

            threads = [threading.Thread(target=work) for _ in range(3)]
            for thread in threads:
                thread.start()
            time.sleep(0.02)
            context.close()
            for thread in threads:
                thread.join()
            self.assertEqual(errors, [])

    @unittest.skipUnless(hasattr(os, "fork"), "no fork")
    def test_a_forked_process_has_no_context(self) -> None:
        cloud = ewa.generate("torus", 2000)
        import warnings

        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            child = os.fork()
        if child == 0:
            code = 1
            try:
                len(cloud)
            except ewa.ClosedError:
                code = 2 if len(ewa.generate("torus", 100)) == 100 else 3
            finally:
                os._exit(code)
        self.assertEqual(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), 2)


if __name__ == "__main__":
    unittest.main()
