#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Measures the package: memory of arrays that are taken in, time of a call, two threads with a context each.

    PYTHONPATH=python python3 python/tests/measure.py
"""
from __future__ import annotations

import threading
import time
from typing import Callable

import numpy as np

import ewa


def resident_mib() -> float:
    with open("/proc/self/statm", encoding="ascii") as file:
        return int(file.read().split()[1]) * 4096 / 2**20


def measure_memory() -> None:
    rows = np.ones((10_000_000, 4), np.float32)
    ewa.generate("plane", 100)
    for name, positions in (("contiguous float64", np.ones((10_000_000, 3))), ("strided float32", rows[:, :3])):
        before = resident_mib()
        cloud = ewa.Cloud(positions, copy=False)
        assert len(cloud["position"]) == 10_000_000
        after = resident_mib()
        print(f"| 10 M points in, {name} of {positions.base.nbytes if positions.base is not None else positions.nbytes:,} "
              f"bytes: memory gained | {after - before:.2f} MiB |")
        del cloud


def best_of(count: int, work: Callable[[], object]) -> float:
    best = float("inf")
    for _ in range(count):
        started = time.perf_counter()
        work()
        best = min(best, time.perf_counter() - started)
    return best


def measure_calls() -> None:
    camera = ewa.Camera.look_at((0, -4, 0), (0, 0, 0), size=(16, 16))
    for points in (16, 100, 1000):
        with ewa.Context(thread_count=1) as context:
            surfels = ewa.generate("sphere", points, context=context).surfels()
            image = ewa.render(surfels, camera)
            whole, beside = [], []
            for _ in range(3000):
                started = time.perf_counter()
                drawn = ewa.render(surfels, camera, out=image)
                whole.append(time.perf_counter() - started)
                beside.append(whole[-1] - drawn.stats["total_s"])
            print(f"| a frame of 16 x 16 pixels, {points} surfels, one thread: median of 3000 calls; of it outside of "
                  f"ewa_render() | {1e6 * sorted(whole)[1500]:.0f} µs; {1e6 * sorted(beside)[1500]:.0f} µs |")


def measure_threads() -> None:
    contexts = [ewa.Context(thread_count=1) for _ in range(2)]
    surfels = [ewa.generate("torus", 200_000, context=context).surfels() for context in contexts]
    camera = ewa.Camera.look_at((0, -3, 2), (0, 0, 0), size=(800, 600))

    def draw(which: int) -> None:
        for _ in range(8):
            ewa.render(surfels[which], camera)

    def one() -> None:
        draw(0)
        draw(1)

    def two() -> None:
        threads = [threading.Thread(target=draw, args=(which,)) for which in (0, 1)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()

    one()
    pairs = [(best_of(1, one), best_of(1, two)) for _ in range(7)]
    alone, together = min(pair[0] for pair in pairs), min(pair[1] for pair in pairs)
    print(f"| 16 frames by two Python threads with a context each, over one after the other, best of 7 | "
          f"{alone / together:.2f} times as fast |")


if __name__ == "__main__":
    measure_memory()
    measure_calls()
    measure_threads()
