# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Discs as a camera sees them, by the library's conics (docs/math.md sections 1 and 3)."""
import ctypes

import numpy as np
from ewa import _bindings as b
from ewa._library import functions as lib


def tilted(tilt_deg, center, radius):
    """A disc that is turned by an angle against the picture about the x axis: centre and axes in camera space,
    the axes as long as the radius."""
    turn = np.radians(tilt_deg)
    return np.array(center, float), radius * np.array([[1, 0, 0], [0, np.cos(turn), np.sin(turn)]])


def mat3(rows):
    made = b.ewa_mat3()
    for i in range(3):
        for j in range(3):
            made.m[i][j] = rows[i][j]
    return made


def projected(center, axes, radius):
    """The conic of the circle of `radius` in units of the axes, on the plane z = 1: its centre and its shape S (2x2), with
    (x - c) S^-1 (x - c)' = 1. None where it is no ellipse."""
    circle = b.ewa_conic(xx=radius ** 2, yy=radius ** 2, ww=-1)
    dual = lib.ewa_dual_conic_transform(ctypes.byref(circle), ctypes.byref(mat3([*axes, center])))
    middle, shape = (ctypes.c_double * 2)(), (ctypes.c_double * 3)()
    if lib.ewa_dual_conic_ellipse(ctypes.byref(dual), middle, shape) != 0:
        return None
    return np.array(middle), np.array([[shape[0], shape[1]], [shape[1], shape[2]]])


def affine(center, axes):
    """The same of radius 1 under the affine map at the disc's centre (SS): rows of J."""
    jacobian = (axes[:, :2] * center[2] - np.outer(axes[:, 2], center[:2])) / center[2] ** 2
    return center[:2] / center[2], jacobian.T @ jacobian


def outline(middle, shape, count=361):
    """Points of an ellipse, one a row."""
    around = np.linspace(0, 2 * np.pi, count)
    return middle + np.stack([np.cos(around), np.sin(around)], 1) @ np.linalg.cholesky(shape).T


def furthest(points, middle, shape):
    """The largest distance of points from an ellipse: to first order for those on it but for rounding, else to its
    outline of many points."""
    other, inverse, largest = outline(middle, shape, 3601), np.linalg.inv(shape), 0.0
    for point in points:
        slope = inverse @ (point - middle)
        near = abs((point - middle) @ slope - 1) / (2 * np.hypot(*slope))
        largest = max(largest, near if near < 1e-6 else np.min(np.hypot(*(other - point).T)))
    return largest
