"""Pictures of recorded poses, drawn off the screen in a process of its own.

MuJoCo chooses its OpenGL when it is imported, and an OpenGL that does not work may end the process that asks for it.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from pathlib import Path

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


def pictures(
    model_file: Path, poses: NDArray[np.float64], width: int = 640, height: int = 360, view: View | None = None
) -> Iterator[Picture]:
    """Yield a picture (height, width, 3) of an MJCF file's robot for each pose (n, coordinates).

    The variable MUJOCO_GL chooses the OpenGL: egl, osmesa or glfw; without it and without a display egl is taken.
    Raises EngineError, with MuJoCo's last words, where nothing can be drawn.
    """
    environment = {**os.environ}
    if sys.platform == "linux" and not environment.get("DISPLAY"):
        environment.setdefault("MUJOCO_GL", "egl")
    request = {"model": str(model_file), "width": width, "height": height, "view": asdict(view or View())}
    with tempfile.TemporaryDirectory(prefix="pneumorph-") as folder:
        np.save(Path(folder) / "poses.npy", poses)
        (Path(folder) / "request.json").write_text(json.dumps(request), encoding="utf-8")
        log = Path(folder) / "log"
        with log.open("wb") as errors:
            process = subprocess.Popen(
                [sys.executable, "-m", __name__, folder], stdout=subprocess.PIPE, stderr=errors, env=environment
            )
        assert process.stdout is not None
        try:
            for _ in poses:
                content = process.stdout.read(3 * width * height)
                if len(content) < 3 * width * height:
                    process.wait()
                    words = [line for line in log.read_text(errors="replace").splitlines() if line.strip()]
                    kind = environment.get("MUJOCO_GL", "its default")
                    raise EngineError(
                        f"MuJoCo cannot draw with MUJOCO_GL={kind} ({words[-1] if words else 'no reason given'}): "
                        "on Linux install libegl1 and libgl1-mesa-dri, or try MUJOCO_GL=osmesa with libosmesa6"
                    )
                yield np.frombuffer(content, np.uint8).reshape(height, width, 3)
        finally:
            process.stdout.close()
            if process.poll() is None:
                process.terminate()
            process.wait()


def main(folder: Path) -> None:
    """Draw what a folder's request asks for, onto stdout."""
    from pneumorph.terrain import rigid

    request = json.loads((folder / "request.json").read_text(encoding="utf-8"))
    model = rigid.load(Path(request["model"]))
    for picture in rigid.draw(
        model, np.load(folder / "poses.npy"), request["width"], request["height"], request["view"]
    ):
        sys.stdout.buffer.write(picture.tobytes())
    sys.stdout.buffer.flush()


if __name__ == "__main__":
    main(Path(sys.argv[1]))
