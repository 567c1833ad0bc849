"""Pictures of triangles and lines without a display: the only module that imports PyVista and VTK."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cache
from types import TracebackType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pneumorph.errors import EngineError
from pneumorph.report.surface import normals
from pneumorph.report.view import View

Array = NDArray[np.float64]
Picture = NDArray[np.uint8]
Colour = tuple[float, float, float]

_PROBE = "from pneumorph.report.render import _probe; _probe()"


@dataclass(frozen=True, eq=False)
class Layer:
    """Something to draw at points (n, 3), mm: triangles (t, 3), or segments (s, 2) if there are none.

    colour: red, green, blue from 0 to 1; of the whole layer, or (n, 3) of its points, or (t, 3) of its triangles (then
    triangles of different colours share no point).
    shaded: lit by a lamp, or flat. width: of lines, in pixels.
    """

    points: Array
    triangles: NDArray[np.int64] | None = None
    segments: NDArray[np.int64] | None = None
    colour: Colour | Array = field(default=(0.8, 0.8, 0.8))
    opacity: float = 1.0
    shaded: bool = True
    width: float = 1.0


class Scene:
    """A window off the screen that draws layers; a context manager.

    view: what is seen; height: of the pictures in pixels, the width follows from the view; both are made even.
    fine: draw at twice the size and reduce, for smooth edges; otherwise the edges are smoothed while drawing.
    Raises EngineError where rendering is impossible.
    """

    def __init__(self, view: View, height: int = 800, *, fine: bool = True):
        check()
        self._view = view
        self._scale = 2 if fine else 1
        height = 2 * round(height / 2)
        self.size = (2 * round(height * view.aspect / 2), height)
        self._plotter: Any = _plotter((self._scale * self.size[0], self._scale * height))
        if not fine:
            self._plotter.enable_anti_aliasing("msaa", multi_samples=4)
        self._look()

    def __enter__(self) -> Scene:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._plotter.close()

    def draw(self, layers: Sequence[Layer]) -> Picture:
        """Return the picture (height, width, 3) of the layers."""
        plotter = self._plotter
        plotter.clear_actors()
        for layer in layers:
            if layer.triangles is not None and len(layer.triangles):
                _add_surface(plotter, layer, self._view)
            elif layer.segments is not None and len(layer.segments):
                _add_lines(plotter, layer, self._scale)
        plotter.renderer.ResetCameraClippingRange()
        picture = _picture(plotter)
        if self._scale == 1:
            return picture
        large = picture.astype(np.uint16)
        small = large[::2, ::2] + large[1::2, ::2] + large[::2, 1::2] + large[1::2, 1::2]
        return np.asarray(small // 4, dtype=np.uint8)

    def _look(self) -> None:
        view, plotter = self._view, self._plotter
        centre = np.array(view.centre)
        far = 10.0 * max(view.width, view.height)
        plotter.camera.position = tuple(centre + far * np.array(view.direction))
        plotter.camera.focal_point = view.centre
        plotter.camera.up = view.up
        plotter.camera.parallel_projection = True
        plotter.camera.parallel_scale = 0.5 * view.height


@cache
def check() -> str:
    """Return the name of the renderer; raises EngineError with the reason where pictures cannot be drawn.

    Tried in a process of its own, because VTK ends the process where it finds no OpenGL.
    """
    if sys.modules.get("pyvista", True) is None:
        raise EngineError("pictures cannot be drawn: PyVista is not installed")
    try:
        result = subprocess.run([sys.executable, "-c", _PROBE], capture_output=True, text=True, timeout=120)
    except (OSError, subprocess.TimeoutExpired) as error:
        raise EngineError(f"pictures cannot be drawn: the test of VTK did not run ({error})") from error
    if result.returncode != 0:
        lines = [line for line in (result.stderr + result.stdout).splitlines() if line.strip()]
        reason = lines[-1].strip() if lines else "VTK ended without a message"
        raise EngineError(
            f"pictures cannot be drawn: VTK found no OpenGL it can use without a display ({reason}; exit code "
            f"{result.returncode}). On Linux install libegl1 and libgl1-mesa-dri, or libosmesa6"
        )
    return result.stdout.strip().splitlines()[-1]


def _probe() -> None:
    """Draw one triangle and print the name of the window class."""
    plotter = _plotter((64, 64))
    _add_surface(plotter, Layer(np.eye(3), np.array([[0, 1, 2]])), View((0.0, 0.0, 1.0), (0.0, 1.0, 0.0)))
    plotter.reset_camera()
    if np.ptp(_picture(plotter)) == 0:
        raise EngineError("the picture is empty")
    print(type(plotter.render_window).__name__)


def _pyvista() -> Any:
    import pyvista
    from vtkmodules.vtkCommonCore import vtkLogger, vtkObject

    # no display is the usual case here, not something to warn about
    vtkObject.GlobalWarningDisplayOff()
    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_OFF)
    return pyvista


def _plotter(size: tuple[int, int]) -> Any:
    """Return an empty window off the screen."""
    pyvista = _pyvista()
    if sys.platform == "linux" and not os.environ.get("DISPLAY"):
        os.environ.setdefault("EGL_LOG_LEVEL", "fatal")
    plotter = pyvista.Plotter(off_screen=True, window_size=size, lighting=None)
    plotter.set_background("white")
    return plotter


def _picture(plotter: Any) -> Picture:
    """Render once and return what the window holds (height, width, 3)."""
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkRenderingCore import vtkWindowToImageFilter

    window = plotter.render_window
    window.Render()
    grab = vtkWindowToImageFilter()
    grab.SetInput(window)
    grab.SetInputBufferTypeToRGB()
    grab.ReadFrontBufferOff()
    grab.ShouldRerenderOff()
    grab.Update()
    image = grab.GetOutput()
    width, height, _ = image.GetDimensions()
    pixels = vtk_to_numpy(image.GetPointData().GetScalars()).reshape(height, width, 3)
    return np.ascontiguousarray(pixels[::-1])


def _add_surface(plotter: Any, layer: Layer, view: View) -> None:
    pyvista = _pyvista()
    assert layer.triangles is not None
    mesh = pyvista.PolyData.from_regular_faces(layer.points.astype(np.float32), layer.triangles)
    mesh.point_data["colour"] = np.round(255.0 * np.clip(_lit(layer, view), 0.0, 1.0)).astype(np.uint8)
    plotter.add_mesh(
        mesh, rgb=True, scalars="colour", opacity=layer.opacity, lighting=False, show_scalar_bar=False,
        copy_mesh=False, reset_camera=False, render=False,
    )  # fmt: skip


def _lit(layer: Layer, view: View) -> Array:
    """Return the colours (n, 3) of a layer's points under a lamp at the camera and one above on the left.

    Done here, because without a graphics card lamps cost much of the time of a picture.
    """
    assert layer.triangles is not None
    colour = np.asarray(layer.colour, dtype=float)
    if colour.ndim == 2 and len(colour) != len(layer.points):
        of_triangles, colour = colour, np.zeros((len(layer.points), 3))
        colour[layer.triangles.ravel()] = np.repeat(of_triangles, 3, axis=0)
    colour = np.broadcast_to(colour, (len(layer.points), 3))
    if not layer.shaded:
        return colour
    normal = normals(layer.points, layer.triangles)
    away, up = np.array(view.direction), np.array(view.up)
    side = 0.7 * away + 0.6 * up - 0.4 * view.right
    facing = normal @ away
    other = (normal @ side) / np.linalg.norm(side) * np.where(facing < 0.0, -1.0, 1.0)  # both sides are seen
    light = 0.5 + 0.42 * np.abs(facing) + 0.16 * np.maximum(other, 0.0)
    return np.asarray(colour * light[:, None])


def _add_lines(plotter: Any, layer: Layer, scale: int) -> None:
    pyvista = _pyvista()
    assert layer.segments is not None
    cells = np.column_stack([np.full(len(layer.segments), 2), layer.segments]).ravel()
    mesh = pyvista.PolyData(layer.points.astype(np.float32), lines=cells)
    actor = plotter.add_mesh(
        mesh, color=tuple(np.asarray(layer.colour, dtype=float)), opacity=layer.opacity, lighting=False,
        line_width=scale * layer.width, copy_mesh=False, reset_camera=False, render=False,
    )  # fmt: skip
    # lines lie in the surfaces that they border: draw them slightly in front
    actor.mapper.SetResolveCoincidentTopologyToPolygonOffset()
    actor.mapper.SetRelativeCoincidentTopologyLineOffsetParameters(0.0, -6.0)
