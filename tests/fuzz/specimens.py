"""Test data of materials in CSV files."""

from __future__ import annotations

import tempfile
from pathlib import Path

from hypothesis import strategies as st
from tests.fuzz.answers import Reader
from tests.fuzz.changes import changed_bytes

from pneumorph.materials.fitting.read import ReadOptions, read_tests

_PLAIN = b"stretch [-],stress [MPa]\n1.0,0.0\n1.5,0.15\n2.0,0.24\n2.5,0.31\n3.0,0.37\n4.0,0.5\n"
_STRAIN = b"# test: planar\nstrain [%];true stress [kPa]\n0;0\n10;30\n20;55\n30;80\n45;110\n60;150\n80;200\n"
_GERMAN = b"Dehnung %\tZugspannung\n0,0\t0,0\n10,5\t0,12\n"
_FORCE = b"displacement,force\nmm,N\n0,0\n1,2.5\n2,4\n3,5\n4,5.5\n5,6\n6,6.4\n"
_MODES = b"test,stretch,stress [MPa]\nuniaxial,1,0\nuniaxial,2,0.3\nequibiaxial,1,0\nequibiaxial,2,0.6\n"
_CYCLES = b"time,strain [-],stress [MPa]\n" + b"".join(
    b"%d,%.3f,%.4f\n" % (i, s, 0.1 * s) for i, s in enumerate([0, 0.2, 0.4, 0.6, 0.4, 0.2, 0, 0.3, 0.6, 0.9, 0.5, 0.1])
)
FILES = (_PLAIN, _STRAIN, _GERMAN, _FORCE, _MODES, _CYCLES)

_CELLS = st.one_of(
    st.floats().map(str), st.integers().map(str), st.text(max_size=8),
    st.sampled_from(["stretch", "strain [%]", "stress [MPa]", "true stress [kPa]", "force [N]", "test", "", "1,5"]),
)  # fmt: skip
_TABLES = st.builds(
    lambda rows, mark: "\n".join(mark.join(row) for row in rows).encode(errors="replace"),
    st.lists(st.lists(_CELLS, min_size=1, max_size=4), max_size=8),
    st.sampled_from([",", ";", "\t", "  "]),
)
_OPTIONS = st.one_of(
    st.none(),
    st.fixed_dictionaries(
        {},
        optional={
            "mode": st.sampled_from(["uniaxial", "planar", "equibiaxial", "shear", ""]),
            "stress": st.sampled_from(["engineering", "true", "nominal"]),
            "strain_unit": st.sampled_from(["-", "%", "mm", ""]),
            "stress_unit": st.sampled_from(["kPa", "MPa", "psi", "mm", ""]),
            "area": st.sampled_from([10.0, 0.0, -1.0, float("nan"), 1e300]),
            "length": st.sampled_from([20.0, 0.0, float("inf"), 1e-300]),
        },
    ),
)


def read(data: tuple[bytes, dict[str, object] | None]) -> None:
    text, options = data
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "data.csv"
        path.write_bytes(text)
        read_tests([path], ReadOptions(**options) if options is not None else ReadOptions(mode="uniaxial"))


READERS = (
    Reader("CSV, changed", st.tuples(changed_bytes(FILES), _OPTIONS), read, 3),
    Reader("CSV, random", st.tuples(st.one_of(_TABLES, st.binary(max_size=200)), _OPTIONS), read, 1),
)
