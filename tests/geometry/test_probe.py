"""A CAD file that ends Open CASCADE's process does not end ours."""

from pathlib import Path

import pytest

from pneumorph.errors import GeometryError
from pneumorph.geometry import occ
from pneumorph.geometry.probe import check_survives

FINGER = Path(__file__).parents[1] / "data" / "finger_closed.step"


def test_a_damaged_file_that_breaks_the_engine_is_refused(tmp_path):
    broken = tmp_path / "broken.step"
    # found by changing the bytes of the file: a point in the plane without its opening parenthesis
    broken.write_bytes(
        FINGER.read_bytes().replace(b"#1514 = CARTESIAN_POINT('',(0.,12.));", b"#1514 = CARTESIAN_POINT('', 0.,12.));")
    )
    with pytest.raises(GeometryError, match=r"broken\.step': Open CASCADE breaks down"):
        occ.read_cad(broken)


def test_a_good_file_and_a_missing_one_pass_the_probe(tmp_path):
    check_survives(FINGER)
    check_survives(tmp_path / "nothing.step")
