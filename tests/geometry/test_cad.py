"""Export to STEP and STL."""

import struct

import numpy as np
import pytest
from netgen.occ import OCCGeometry

from pneumorph.errors import EngineError, InputError, StorageError
from pneumorph.geometry import Finger, PneuNet, export, occ


def _read_stl(path):
    data = path.read_bytes()
    (count,) = struct.unpack("<I", data[80:84])
    assert len(data) == 84 + 50 * count
    return np.frombuffer(data[84:], dtype=[("v", "<f4", (4, 3)), ("a", "<u2")])["v"].astype(float)


def test_step_file_reads_back_as_the_same_solid_in_mm(tmp_path):
    path = export(Finger(), tmp_path / "finger.step")
    assert "MILLI" in path.read_text()
    assert OCCGeometry(str(path)).shape.mass == pytest.approx(occ.volume(Finger().shape()), rel=1e-9)


@pytest.mark.parametrize("actuator", [Finger(), PneuNet(chambers=2)])
def test_stl_file_is_closed_with_outward_normals_and_holds_the_volume_of_the_solid(tmp_path, actuator):
    vectors = _read_stl(export(actuator, tmp_path / "solid.STL"))
    normal, a, b, c = (vectors[:, i] for i in range(4))
    volume = np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6.0
    assert volume == pytest.approx(occ.volume(actuator.shape()), rel=1e-5)
    assert (np.einsum("ij,ij->i", np.cross(b - a, c - a), normal) > 0.0).all()


def test_unknown_suffix_is_refused_with_those_that_are_known(tmp_path):
    with pytest.raises(InputError, match=r"unknown suffix of a CAD file '.iges'.*Allowed: .step, .stl, .stp"):
        export(Finger(), tmp_path / "finger.iges")


@pytest.mark.parametrize("suffix", ["stl", "step"])
def test_folder_that_does_not_exist_is_refused(tmp_path, suffix):
    with pytest.raises(StorageError, match="cannot write"):
        export(Finger(), tmp_path / "nowhere" / f"finger.{suffix}")


def test_engine_that_cannot_write_says_so(tmp_path):
    class Broken:
        def WriteStep(self, name):
            raise RuntimeError("no licence")

    with pytest.raises(EngineError, match="no licence"):
        occ.write_step(Broken(), tmp_path / "x.step")
