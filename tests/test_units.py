"""Units at the edges."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pneumorph import units
from pneumorph.errors import InputError, UnitError


@pytest.mark.parametrize(
    ("text", "kind", "value"),
    [
        ("80 kPa", "pressure", 0.08),
        ("80kPa", "pressure", 0.08),
        ("-20 kPa", "pressure", -0.02),
        ("1 bar", "pressure", 0.1),
        ("0.11 MPa", "stress", 0.11),
        ("2 cm", "length", 20.0),
        ("75 mL", "volume", 75_000.0),
        ("1 cm3", "volume", 1000.0),
        ("1130 kg/m3", "density", 1.13e-9),
        ("1.13 g/cm³", "density", 1.13e-9),
        ("90 deg", "angle", math.pi / 2.0),
        ("5 mN", "force", 0.005),
        ("1 N m", "moment", 1000.0),
        ("1 N·mm", "moment", 1.0),
        ("9.81 m/s2", "acceleration", 9810.0),
        ("9.81 m/s²", "acceleration", 9810.0),
        ("10 1/m", "curvature", 0.01),
        ("2 ms", "time", 0.002),
        ("12 mg", "mass", 1.2e-8),
        ("20 degC", "temperature", 293.15),
        ("1e-8 m3/(s Pa)", "conductance", 1e7),
        ("6 L/(min bar)", "conductance", 1e6),
        ("287.05 J/(kg K)", "gas constant", 287.05e6),
        ("1 J", "energy", 1000.0),
        ("3 cm2", "area", 300.0),
        (" 0.7 ", "number", 0.7),
        ("1e-3 m", "length", 1.0),
    ],
)
def test_text_with_a_unit_becomes_an_inside_number(text, kind, value):
    assert units.parse(text, kind) == pytest.approx(value, rel=1e-13)


@pytest.mark.parametrize(
    ("text", "kind"),
    [
        ("80", "pressure"),
        ("80 mm", "pressure"),
        ("80 kPaa", "pressure"),
        ("kPa", "length"),
        ("", "pressure"),
        ("eighty kPa", "pressure"),
        ("nan kPa", "pressure"),
        ("inf mm", "length"),
        ("1 mm", "number"),
        ("1 kg", "density"),
        ("((", "length"),
        ("1 mm; 2 mm", "length"),
        ("80 kPa extra", "pressure"),
        ("1/0 mm", "length"),
        ("mm", "length"),
        ("1 mm; 2", "length"),
        ("1 m±2", "length"),
        ("[1,2] mm", "length"),
        ("9**9**9**9 mm", "length"),
        ("1 mm**9**9**9", "length"),
        ("1 " + "a " * 10_000 + "!", "length"),
        ("__import__('os') mm", "length"),
        (80, "pressure"),
        (None, "pressure"),
        (True, "pressure"),
    ],
)
def test_text_without_the_right_unit_is_refused_by_its_name(text, kind):
    with pytest.raises(UnitError) as caught:
        units.parse(text, kind, name="supply")
    message = str(caught.value)
    assert message.startswith("supply = ")
    assert "expected" in message
    if units.printed_unit(kind) and "finite" not in message:
        assert units.printed_unit(kind) in message


def test_a_long_text_is_cut_in_the_message_and_stays_on_one_line():
    with pytest.raises(UnitError) as caught:
        units.parse("1 mm\n\n" + "x" * 10_000, "length")
    assert len(str(caught.value)) < 300
    assert "\n" not in str(caught.value)


@given(st.text(max_size=12))
def test_no_text_escapes_as_anything_but_a_unit_error(text):
    try:
        value = units.parse(text, "length")
    except UnitError:
        return
    assert math.isfinite(value)


@pytest.mark.parametrize("call", [lambda: units.parse("1 mm", "lenght"), lambda: units.show(1.0, "lenght")])
def test_an_unknown_kind_of_quantity_is_refused_with_the_nearest(call):
    with pytest.raises(UnitError, match="unknown kind of quantity 'lenght': did you mean 'length'"):
        call()


@pytest.mark.parametrize(
    ("value", "kind", "text"),
    [
        (0.08, "pressure", "80 kPa"),
        (1.13e-9, "density", "1130 kg/m³"),
        (math.pi / 2.0, "angle", "90 deg"),
        (75_000.0, "volume", "75 mL"),
        (9810.0, "acceleration", "9.81 m/s²"),
        (12.0, "moment", "12 N·mm"),
        (0.7, "number", "0.7"),
        (1.2e-8, "mass", "12 mg"),
        (1e6, "conductance", "6 L/(min·bar)"),
    ],
)
def test_inside_numbers_are_printed_with_their_unit(value, kind, text):
    assert units.show(value, kind) == text


@pytest.mark.parametrize("kind", units.KINDS)
def test_what_is_printed_parses_back(kind):
    assert units.parse(units.show(1.2345678901, kind, digits=12), kind) == pytest.approx(1.2345678901, rel=1e-11)


def test_printed_values_and_units_belong_together():
    assert units.to_printed(0.25, "pressure") == pytest.approx(250.0)
    assert units.printed_unit("pressure") == "kPa"


def test_a_unit_error_is_an_input_error():
    assert issubclass(UnitError, InputError)
