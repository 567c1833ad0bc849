import numpy as np
import pytest

from pneumorph.errors import EngineError
from pneumorph.terrain import Drive, Rover, Wheel, flat, ground_bytes, mjcf
from pneumorph.terrain.drawing import pictures

pytest.importorskip("mujoco")


@pytest.fixture
def model_file(tmp_path):
    field = flat(2_000.0)
    (tmp_path / "flat.hfield").write_bytes(ground_bytes(field))
    path = tmp_path / "run.xml"
    path.write_text(mjcf(Rover(Wheel(4)), Drive(), field, "flat.hfield"))
    return path


def test_pictures_show_the_robot_where_its_pose_is(model_file):
    poses = np.zeros((2, 11))
    poses[:, 2:4] = 0.15, 1.0
    poses[1, 0] = 0.5
    try:
        drawn = list(pictures(model_file, poses, 320, 180))
    except EngineError as error:
        pytest.skip(str(error))
    assert [picture.shape for picture in drawn] == [(180, 320, 3)] * 2
    for picture in drawn:  # the wheels are orange, and the camera keeps them in its middle
        orange = (picture[..., 0] > 1.6 * picture[..., 2]) & (picture[..., 0] > 60)
        row, column = np.argwhere(orange).mean(axis=0)
        assert abs(row - 90) < 25
        assert abs(column - 160) < 25


def test_an_opengl_that_does_not_work_is_an_error_with_advice(model_file, monkeypatch):
    monkeypatch.setenv("MUJOCO_GL", "nonsense")
    with pytest.raises(EngineError, match=r"MuJoCo cannot draw with MUJOCO_GL=nonsense \(.+\): on Linux install"):
        list(pictures(model_file, np.zeros((1, 11)), 64, 48))
