"""Reading test data: every way that a file may say what it holds, and every file that does not."""

from contextlib import suppress
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pneumorph.errors import InputError, NameNotFoundError, UnitError
from pneumorph.materials.fitting import ReadOptions, SpecimenTest, mode_named, prepare, read_tests
from pneumorph.materials.fitting.table import LARGEST_FILE

UNIAXIAL = ReadOptions(mode="uniaxial")


@pytest.fixture
def read(tmp_path):
    def written_and_read(content, options=UNIAXIAL, name="data.csv"):
        path = tmp_path / name
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return read_tests([path], options)

    return written_and_read


@pytest.mark.parametrize(
    "text",
    [
        "stretch [-],nominal stress [MPa]\n1.0,0\n1.5,0.2\n2,0.35\n",
        "strain [%], stress [kPa]\n0,0\n50,200\n100,350\n",
        "Tensile strain (%);Tensile stress (kPa)\n0;0\n50,0;200,0\n1e2;3,5e2\n",
        "strain / %\tstress / MPa\n0\t0\n50\t0,2\n100\t0.35".replace(".", ","),
        "Time (s),Strain [mm/mm],Load (N),Stress [N/mm2]\n0,0,0,0\n1,0.5,9,0.2\n2,1,9,0.35\n",
        "# comment\n% another\n\nstretch,stress_MPa\n1,0\n1.5,.2\n2.,0.35\n",
        "displacement [mm],force [N]\n0,0\n10,4\n20,7\n",
        "Displacement,Force\n(mm),(N)\n0,0\n10,4\n20,7\n",
        "λ;σ stress [MPa]\n1;0\n1,5;0,2\n2;0,35\n",
        'stretch [%],"stress [MPa]",\n100,0,\n150,0.2,\n200,0.35,\n',
        "log strain [-],true stress [MPa]\n0,0\n0.4054651081,0.3\n0.6931471806,0.7\n",
        "stretch [-],true stress [psi]\n1,0\n1.5,43.511321\n2,101.52642\n",
    ],
)
def test_the_same_test_is_read_from_every_way_of_writing_it(read, text):
    (test,) = read(text, ReadOptions(mode="uniaxial", area=20.0, length=20.0))
    np.testing.assert_allclose(test.stretch, [1.0, 1.5, 2.0], rtol=1e-9)
    np.testing.assert_allclose(test.stress, [0.0, 0.2, 0.35], rtol=1e-7)
    assert test.mode == "uniaxial"


@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16", "latin-1"])
def test_exports_in_other_encodings_are_read(read, encoding):
    (test,) = read("# 20 °C\nstretch [-],stress [MPa]\n1,0\n2,0.3\n".encode(encoding))
    assert test.stress[1] == 0.3


def test_units_and_measure_come_from_options_where_the_header_is_silent(read):
    options = ReadOptions(mode="planar", stress="true", strain_unit="%", stress_unit="kPa")
    (test,) = read("strain,stress\n0,0\n100,300\n", options)
    np.testing.assert_allclose((test.stretch[1], test.stress[1]), (2.0, 0.15))
    assert test.mode == "planar"


def test_kilograms_per_area_are_kilogram_force(read):
    (test,) = read("stretch,stress [kg/cm2]\n1,0\n2,10\n")
    assert test.stress[1] == pytest.approx(0.980665)  # 1 kgf = 9.80665 N, by definition


def test_tests_and_specimens_of_one_file_are_told_apart_with_their_lines(read):
    text = "test,specimen,stretch,stress [MPa]\n" + "".join(
        f"{mode},{name},{stretch},0.{stretch}\n"
        for stretch in (1, 2, 3)
        for mode, name in (("UT", "A"), ("pure shear", "A"), ("uniaxial", "B"))
    )
    tests = read(text, None)
    assert [(t.mode, t.source.rpartition(" ")[2]) for t in tests] == [
        ("uniaxial", "(A)"), ("planar", "(A)"), ("uniaxial", "(B)"),
    ]  # fmt: skip
    assert tests[1].lines.tolist() == [3, 6, 9]
    assert tests[1].where(1).endswith("data.csv (A) line 6")


def test_a_comment_may_say_which_test_it_is(read):
    assert read("# test: Equi-Biaxial\nstretch,stress [MPa]\n1,0\n2,1\n", None)[0].mode == "equibiaxial"


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("strain,stress [MPa]\n0,0\n1,1\n", ["column 'strain' has no unit", "--strain-unit"]),
        ("strain [%],stress\n0,0\n1,1\n", ["column 'stress' has no unit", "--stress-unit"]),
        ("strain [mm],stress [MPa]\n0,0\n1,1\n", ["unit 'mm'", "'-', 'mm/mm' or '%'"]),
        ("strain [%],stress [mm]\n0,0\n1,1\n", ["unit 'mm'", "unit of stress"]),
        ("strain [%],stress [2]\n0,0\n1,1\n", ["unit '2'", "unit of stress"]),
    ],
)
def test_data_without_the_right_unit_is_refused(read, text, words):
    with pytest.raises(UnitError) as refused:
        read(text)
    assert all(word in str(refused.value) for word in words)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", ["0 lines with data"]),
        ("stretch,stress [MPa]\n", ["1 lines with data"]),
        ("stretch\n1\n2\n", ["line 1: one column only in 'stretch'"]),
        ("1,2\n3,4\n", ["line 1: '1,2' are numbers, expected a header"]),
        ("stretch,stress [MPa]\n1,0\n1.5,0.1,7\n", ["line 3: 3 cells in '1.5,0.1,7', allowed: 2"]),
        ("stretch,stress [MPa]\n1,0\n1,5,0,1\n", ["line 3: 4 cells", "decimal commas", "semicolons"]),
        ("stretch,stress [MPa]\n1,0\n\n1.5,nan\n", ["line 4, column 'stress [MPa]': 'nan', allowed: a number"]),
        ("stretch,stress [MPa]\n1,0\n1.5,\n", ["line 3, column 'stress [MPa]': nothing, allowed: a number"]),
        ("stretch,stress [MPa]\n1,0\n1.5,1e999\n", ["line 3", "'1e999', allowed: a finite number"]),
        ("stretch;stress [MPa]\n1,0;0\n1.5;0,1\n", ["line 3", "another decimal mark"]),
        ("stretch,stress [MPa]\n0,0\n0.5,1\n", ["line 2: stretch = 0, allowed: 0.05 to 20"]),
        ("strain [-],stress [MPa]\n0,0\n50,1\n", ["line 3: stretch = 51, allowed: 0.05 to 20"]),
        ("stretch,true stress [MPa]\n-1,0\n1.5,1\n", ["line 2: stress = nan, allowed: finite"]),
        ("stretch,time [s]\n1,0\n1.5,1\n", ["no column for the stress among 'stretch', 'time [s]'"]),
        ("x,stress [MPa]\n1,0\n1.5,1\n", ["no column for the deformation among 'x'"]),
        ("stretch,elongation [%],stretch 2,stress [MPa]\n1,0,1,0\n", ["both give the deformation"]),
        ("stress [MPa],stress [kPa],stretch\n0,0,1\n", ["both give the stress"]),
        ("test,stretch,stress [MPa]\nuni,1,0\n", ["line 2, column 'test': unknown test 'uni'", "Allowed: equibiaxial"]),
        ("displacement [mm],stress [MPa]\n0,0\n1,1\n", ["displacement", "--length"]),
        ("stretch,force [N]\n1,0\n2,1\n", ["force", "--area"]),
        (b"PK\x03\x04\x00\x00,\n\x00,\n", ["is no text file"]),
        ('stretch,"stress [MPa]\n1,0\n' + "x" * 140_000 + ",1\n", ["line 3"]),
    ],
)
def test_a_file_that_is_no_test_data_is_refused_with_its_place(read, text, words):
    with pytest.raises(InputError) as refused:
        read(text)
    assert all(word in str(refused.value) for word in words), refused.value
    assert "data.csv" in str(refused.value)


def test_a_file_that_does_not_say_its_test_is_refused(read):
    with pytest.raises(InputError, match=r"which test is it\? Give --test"):
        read("stretch,stress [MPa]\n1,0\n2,1\n", None)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"strain_unit": "-"}, "has the unit '%', but --strain-unit is '-'"),
        ({"stress": "engineering"}, "the header says true, but --stress is engineering"),
    ],
)
def test_options_that_contradict_the_header_are_refused(read, options, words):
    with pytest.raises(InputError, match=words):
        read("strain [%],true stress [MPa]\n0,0\n10,1\n", ReadOptions(mode="uniaxial", **options))


@pytest.mark.parametrize(
    "options",
    [{"stress": "cauchy"}, {"strain_unit": "mm"}, {"stress_unit": "m"}, {"area": 0.0}, {"length": float("nan")}],
)
def test_wrong_options_are_refused(options):
    with pytest.raises(InputError):
        ReadOptions(**options)


def test_missing_and_oversized_files_are_refused(tmp_path):
    with pytest.raises(InputError, match="cannot read the test data"):
        read_tests([tmp_path / "nothing.csv"], UNIAXIAL)
    with pytest.raises(InputError, match="no test data given"):
        read_tests([], UNIAXIAL)
    large = tmp_path / "large.csv"
    with large.open("wb") as file:
        file.truncate(LARGEST_FILE + 1)
    with pytest.raises(InputError, match="allowed: 64 MB"):
        read_tests([large], UNIAXIAL)


def test_an_unknown_test_is_refused_with_the_three_that_there_are():
    with pytest.raises(NameNotFoundError, match="Allowed: equibiaxial, planar, uniaxial"):
        mode_named("bending")


@pytest.mark.parametrize(("stretch", "stress"), [([1.0, 2.0], [1.0]), ([], []), ([[1.0]], [[1.0]])])
def test_arrays_that_do_not_match_are_refused(stretch, stress):
    with pytest.raises(InputError, match="allowed: the same"):
        SpecimenTest("uniaxial", stretch, stress)


CELL = st.one_of(
    st.sampled_from(["", "1", "1.5", "-2,5", "nan", "1e999", "stretch", "strain [%]", "stress [MPa]", "true stress",
                     "test", "uniaxial", "[mm]", '"', "λ", "\x00", "#", "(kPa", "/", "1.2.3", "force [N]"]),
    st.text(max_size=6),
)  # fmt: skip


@settings(max_examples=150, deadline=None)
@given(st.lists(st.lists(CELL, min_size=1, max_size=4), max_size=6), st.sampled_from(",;\t"), st.booleans())
def test_no_text_makes_the_reader_fail_otherwise_than_with_a_message(tmp_path_factory, rows, separator, headed):
    head = f"stretch{separator}stress [MPa]\n" if headed else ""
    path = Path(tmp_path_factory.getbasetemp()) / "fuzzed.csv"
    path.write_text(head + "\n".join(separator.join(row) for row in rows), encoding="utf-8", errors="surrogatepass")
    with suppress(InputError):
        for test in read_tests([path], UNIAXIAL):
            prepare(test)
