#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Measures the package: memory of arrays that are taken in, time of a call, two threads with a context each.

    PYTHONPATH=python python3 python/tests/measure.py
"""
from __future__ import annotations

import multiprocessing
import threading
import time
from typing import Any, Callable

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
    for points, threads in ((16, 1), (100, 1), (1000, 1), (100, 2)):
        with ewa.Context(thread_count=threads) as context:
            surfels = ewa.generate("sphere", points, context=context).surfels()
            image = ewa.render(surfels, camera)
            whole, beside = [], []
            for _ in range(3000):
                started = time.perf_counter()
                drawn = ewa.render(surfels, camera, out=image)
                whole.append(time.perf_counter() - started)
                beside.append(whole[-1] - drawn.stats["total_s"])
            print(f"| a frame of 16 x 16 pixels, {points} surfels, {threads} worker(s): median of 3000 calls; of it outside of "
                  f"ewa_render() | {1e6 * sorted(whole)[1500]:.0f} µs; {1e6 * sorted(beside)[1500]:.0f} µs |")


CAMERA = ((0, -3, 2), (0, 0, 0))


def make(context: ewa.Context) -> ewa.Surfels:
    return ewa.generate("torus", 200_000, context=context).surfels()


def draw(surfels: ewa.Surfels) -> None:
    for _ in range(8):
        ewa.render(surfels, ewa.Camera.look_at(*CAMERA, size=(800, 600)))


def draw_as_process(barrier: Any, rounds: int) -> None:
    surfels = make(ewa.Context(thread_count=1))
    for _ in range(rounds):
        barrier.wait()
        draw(surfels)
        barrier.wait()


def measure_threads() -> None:
    """Threads beside processes, which share nothing: what other work on the machine takes is in both."""
    rounds = 9
    surfels = [make(ewa.Context(thread_count=1)) for _ in range(2)]
    spawning = multiprocessing.get_context("spawn")
    barrier = spawning.Barrier(3)
    processes = [spawning.Process(target=draw_as_process, args=(barrier, rounds)) for _ in range(2)]
    for process in processes:
        process.start()

    def one() -> None:
        for each in surfels:
            draw(each)

    def two_threads() -> None:
        threads = [threading.Thread(target=draw, args=(each,)) for each in surfels]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()

    def two_processes() -> None:
        barrier.wait()
        barrier.wait()

    times = [[best_of(1, work) for work in (one, two_threads, two_processes)] for _ in range(rounds)]
    for process in processes:
        process.join()
    alone, together, apart = (min(row[k] for row in times) for k in range(3))
    print(f"| 16 frames by two Python threads with a context each, over one after the other, best of {rounds}; by two "
          f"processes | {alone / together:.2f} times as fast; {alone / apart:.2f} |")


if __name__ == "__main__":
    measure_memory()
    measure_calls()
    measure_threads()
