"""Pictures of recorded poses, drawn off the screen in a process of its own.

MuJoCo chooses its OpenGL when it is imported, and an OpenGL that does not work may end the process that asks for it.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
import weakref
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import IO, Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from pneumorph.errors import EngineError

Picture = NDArray[np.uint8]


@dataclass(frozen=True)
class View:
    """Where the camera stands: distance from the robot in m, azimuth and elevation in degrees."""

    distance: float = 2.1
    azimuth: float = 125.0
    elevation: float = -18.0


class Painter:
    """Draws an MJCF file's robot in poses that come one by one; close it, or use it as a context manager.

    The variable MUJOCO_GL chooses the OpenGL: egl, osmesa or glfw; without it and without a display egl is taken.
    """

    def __init__(self, model_file: Path, width: int = 640, height: int = 360, view: View | None = None):
        environment = {**os.environ}
        if sys.platform == "linux" and not environment.get("DISPLAY"):
            environment.setdefault("MUJOCO_GL", "egl")
        self._kind = environment.get("MUJOCO_GL", "its default")
        self._shape = (height, width, 3)
        request = {"model": str(model_file), "width": width, "height": height, "view": asdict(view or View())}
        self._log = tempfile.TemporaryFile(prefix="pneumorph-")  # noqa: SIM115 - open as long as the process
        self._process = subprocess.Popen(
            [sys.executable, "-m", __name__, json.dumps(request)],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=self._log, env=environment,
        )  # fmt: skip
        self._end = weakref.finalize(self, _end, self._process, self._log)

    def ask(self, pose: NDArray[np.float64]) -> None:
        """Begin to draw a pose (coordinates,); raises EngineError as `take`."""
        assert self._process.stdin is not None
        try:
            self._process.stdin.write(np.asarray(pose, dtype=float).tobytes())
            self._process.stdin.flush()
        except BrokenPipeError:
            self._fail()

    def take(self) -> Picture:
        """Return the picture (height, width, 3) of the first pose asked for and not yet taken.

        Raises EngineError, with MuJoCo's last words, where nothing can be drawn.
        """
        assert self._process.stdout is not None
        size = int(np.prod(self._shape))
        content = self._process.stdout.read(size)
        if len(content) < size:
            self._fail()
        return np.frombuffer(content, np.uint8).reshape(self._shape)

    def _fail(self) -> NoReturn:
        self._process.wait()
        self._log.seek(0)
        text = self._log.read().decode(errors="replace")
        words = [line for line in text.splitlines() if line.strip()]
        raise EngineError(
            f"MuJoCo cannot draw with MUJOCO_GL={self._kind} ({words[-1] if words else 'no reason given'}): "
            "on Linux install libegl1 and libgl1-mesa-dri, or try MUJOCO_GL=osmesa with libosmesa6"
        )

    def close(self) -> None:
        """End the process that draws; done by itself where the painter is forgotten."""
        self._end()

    def __enter__(self) -> Painter:
        return self

    def __exit__(self, *reason: object) -> None:
        self.close()


def _end(process: subprocess.Popen[bytes], log: IO[bytes]) -> None:
    for pipe in (process.stdin, process.stdout):
        assert pipe is not None
        with suppress(BrokenPipeError):
            pipe.close()
    if process.poll() is None:
        process.terminate()
    process.wait()
    log.close()


def pictures(
    model_file: Path, poses: NDArray[np.float64], width: int = 640, height: int = 360, view: View | None = None
) -> Iterator[Picture]:
    """Yield a picture (height, width, 3) of an MJCF file's robot for each pose (n, coordinates); see `Painter`."""
    with Painter(model_file, width, height, view) as painter:
        painter.ask(poses[0])
        for following in poses[1:]:
            painter.ask(following)  # so that the next one is drawn while this one is used
            yield painter.take()
        yield painter.take()


def main(request: dict[str, Any]) -> None:
    """Draw the poses that come on stdin, onto stdout."""
    from pneumorph.terrain import rigid

    model = rigid.load(Path(request["model"]))
    size = 8 * model.nq

    def poses() -> Iterator[NDArray[np.float64]]:
        while len(content := sys.stdin.buffer.read(size)) == size:
            yield np.frombuffer(content)

    for picture in rigid.draw(model, poses(), request["width"], request["height"], request["view"]):
        sys.stdout.buffer.write(picture.tobytes())
        sys.stdout.buffer.flush()


if __name__ == "__main__":
    main(json.loads(sys.argv[1]))
