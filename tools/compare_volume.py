#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
"""Times ewa's volumes beside VTK's CPU ray caster, over occupancy; prints the table of docs/volume.md.

The volumes are those of `measure_volume_speed`: 256^3, 8 bit, at 400x400, shaded, their sphere in 30 degrees. VTK
(vtkFixedPointVolumeRayCastMapper) takes one sample per voxel and pixel, trilinear, without skipping rays, on two
threads; what counts is the mapper's own time. Both are run in turns, and the least of all rounds counts.

Debian: apt install --no-install-recommends python3-vtk9 xvfb; then, with the system's Python,
    xvfb-run -a /usr/bin/python3 tools/compare_volume.py build/release/measure/measure_volume_speed

compare_volume.py MEASURE_VOLUME_SPEED [ROUNDS]
"""
import math
import os
import subprocess
import sys
import tempfile

try:
    import vtkmodules.vtkRenderingOpenGL2  # noqa: F401  (the window that the mapper needs)
    import vtkmodules.vtkRenderingVolumeOpenGL2  # noqa: F401
    from vtkmodules.vtkCommonDataModel import vtkPiecewiseFunction
    from vtkmodules.vtkIOImage import vtkNrrdReader
    from vtkmodules.vtkRenderingCore import (vtkColorTransferFunction, vtkRenderer, vtkRenderWindow, vtkVolume,
                                             vtkVolumeProperty)
    from vtkmodules.vtkRenderingVolume import vtkFixedPointVolumeRayCastMapper
except ImportError as missing:
    print(f"compare_volume.py: skipped: {missing} (Debian: python3-vtk9)")
    sys.exit(0)
if not os.environ.get("DISPLAY"):
    print("compare_volume.py: skipped: VTK needs a display (xvfb-run)")
    sys.exit(0)

PERCENTS = (1, 3, 10, 30, 60, 100)
EXTINCTIONS = (0.02, 0.2, 0.4, 1)
SIDE_PX, THREADS, FRAMES = 400, 2, 3


def vtk_scene(path, extinction):
    """A window that draws the volume, and its mapper."""
    reader = vtkNrrdReader()
    reader.SetFileName(path)
    reader.Update()
    image = reader.GetOutput()
    mapper = vtkFixedPointVolumeRayCastMapper()
    mapper.SetInputData(image)
    mapper.SetSampleDistance(1)
    mapper.AutoAdjustSampleDistancesOff()
    mapper.SetImageSampleDistance(1)
    mapper.SetNumberOfThreads(THREADS)
    opacity, color = vtkPiecewiseFunction(), vtkColorTransferFunction()
    for value in (0, 0.999):
        opacity.AddPoint(value, 0)
    for value in (1, 255):
        opacity.AddPoint(value, 1 - math.exp(-extinction))
    color.AddRGBPoint(1, 0.9, 0.5, 0.2)
    color.AddRGBPoint(128, 0.9, 0.8, 0.6)
    color.AddRGBPoint(255, 0.3, 0.5, 0.9)
    look = vtkVolumeProperty()
    look.SetScalarOpacity(opacity)
    look.SetColor(color)
    look.ShadeOn()
    look.SetInterpolationTypeToLinear()
    volume, renderer, window = vtkVolume(), vtkRenderer(), vtkRenderWindow()
    volume.SetMapper(mapper)
    volume.SetProperty(look)
    renderer.AddVolume(volume)
    window.SetOffScreenRendering(1)
    window.SetSize(SIDE_PX, SIDE_PX)
    window.AddRenderer(renderer)
    camera, side = renderer.GetActiveCamera(), image.GetDimensions()[0]
    toward = (0.5, 0.35, -1)
    length, middle = math.hypot(*toward), (side - 1) / 2
    camera.SetFocalPoint(middle, middle, middle)
    camera.SetPosition(*(middle + 3.35 * side * way / length for way in toward))
    camera.SetViewUp(0, 1, 0)
    camera.SetViewAngle(30)
    renderer.ResetCameraClippingRange()
    window.Render()
    return window, renderer, volume, mapper


def vtk_ms(scene):
    """The least of some frames, each from a camera of its own."""
    window, renderer, volume, mapper = scene
    times_s = []
    for _ in range(FRAMES):
        renderer.GetActiveCamera().Azimuth(0.01)
        window.Render()
        times_s.append(mapper.GetTimeToDraw())
    return 1e3 * min(times_s)


def ewa_ms(measure, percent, extinction, path):
    row = subprocess.run([measure, "occupied", str(percent), str(extinction), path], check=True,
                         capture_output=True, text=True).stdout
    return float(row.split("|")[4])


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    rounds = int(sys.argv[2]) if len(sys.argv) > 2 else 3
    print("| extinction | occupied | ewa, ms | VTK, ms | ewa over VTK |\n|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "volume.nrrd")
        for extinction in EXTINCTIONS:
            for percent in PERCENTS:
                ewa, vtk, scene = [], [], None
                for _ in range(rounds):
                    ewa.append(ewa_ms(sys.argv[1], percent, extinction, path))
                    scene = scene or vtk_scene(path, extinction)
                    vtk.append(vtk_ms(scene))
                ratio = min(ewa) / min(vtk)
                print(f"| {extinction} | {percent} % | {min(ewa):.1f} | {min(vtk):.1f} | {ratio:.2f} |", flush=True)


if __name__ == "__main__":
    main()
