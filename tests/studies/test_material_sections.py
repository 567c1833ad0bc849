"""Every law in a study file: constants, lists of constants, a series of relaxations; written out and read again."""

import tomllib

import pytest

from pneumorph.errors import InputError, StudyError, UnitError
from pneumorph.materials import (
    LAWS,
    ArrudaBoyce,
    ExtendedTube,
    Gent,
    LinearElastic,
    MooneyRivlin,
    NeoHookean,
    Ogden,
    Prony,
    Yeoh,
    library,
)
from pneumorph.report.asked import materials_table
from pneumorph.solution import codec
from pneumorph.studies import study_from

SECTIONS = {
    'law = "neo-hookean"\nmu = "30 kPa"': NeoHookean(0.03),
    'law = "mooney-rivlin"\nc10 = "0.2 MPa"\nc01 = "-10 kPa"\nc20 = "1 kPa"': MooneyRivlin(0.2, -0.01, 0.001),
    'law = "yeoh"\nc10 = "0.11 MPa"\nc20 = "0.02 MPa"\nc30 = "1 kPa"': Yeoh(0.11, 0.02, 0.001),
    'law = "gent"\nmu = "0.1 MPa"\njm = 30': Gent(0.1, 30.0),
    'law = "arruda-boyce"\nc_r = "0.1 MPa"\nlocking_stretch = 2.5': ArrudaBoyce(0.1, 2.5),
    'law = "ogden"\nmus = ["0.4 MPa", "-2 kPa"]\nalphas = [1.3, -2]': Ogden((0.4, -0.002), (1.3, -2.0)),
    'law = "extended-tube"\ngc = "0.2 MPa"\nge = "0.1 MPa"\nbeta = 0.2\ndelta = 0.1': ExtendedTube(0.2, 0.1, 0.2, 0.1),
    'law = "linear-elastic"\nyoung = "3.5 GPa"\npoisson = 0.36': LinearElastic(3500.0, 0.36),
    'law = "neo-hookean"\nmu = "30 kPa"\nprony = { g = [0.2, 0.1], tau = ["100 ms", "3 s"] }': NeoHookean(
        0.03, prony=Prony((0.2, 0.1), (0.1, 3.0))
    ),
}
CASES = pytest.mark.parametrize(("section", "material"), SECTIONS.items(), ids=[repr(m) for m in SECTIONS.values()])


def study(section):
    text = f'[actuator]\ntemplate = "finger"\n[material]\n{section}\n[[phase]]\ntargets = {{ cavity = "10 kPa" }}\n'
    return study_from(tomllib.loads(text), "test")


def test_the_cases_cover_every_law():
    assert {type(material) for material in SECTIONS.values()} == set(LAWS.values())


@CASES
def test_a_law_is_read_and_its_resolved_study_makes_it_again(section, material):
    made = study(section)
    assert made.materials == {"body": material}
    again = study_from(tomllib.loads(made.resolved_text()), "again")
    assert again.materials == made.materials


@CASES
def test_a_law_is_stored_with_a_run_and_restored(section, material):
    assert codec.decode(codec.encode(material)) == material


@CASES
def test_the_report_shows_every_constant(section, material):
    rows = materials_table({"body": material}).rows
    shown = {str(row[2]): str(row[3]) for row in rows}
    names = {"bulk", "density"} | {line.partition(" = ")[0] for line in section.splitlines()} - {"law"}
    assert names <= set(shown)
    if material.prony is not None:
        assert shown["prony"] == "0.2 in 0.1 s, 0.1 in 3 s"
    if isinstance(material, Ogden):
        assert shown["mus"] == "0.4 MPa, -0.002 MPa"
    if isinstance(material, LinearElastic):
        assert shown["bulk"] == "4167 MPa (from the others)"


def test_a_material_of_the_library_can_be_made_viscous():
    made = study('name = "lsr-finger"\n[material.prony]\ng = [0.2]\ntau = ["0.5 s"]').materials["body"]
    assert made.prony == Prony((0.2,), (0.5,))
    assert made.c10 == library.material("lsr-finger").c10


@pytest.mark.parametrize(
    ("section", "kind", "message"),
    [
        (
            'law = "ogden"\nmus = [0.4]\nalphas = [1.0]',
            UnitError,
            "material.mus[1]: mus = 0.4: expected stress with its",
        ),
        (
            'law = "ogden"\nmus = "0.4 MPa"\nalphas = [1.0]',
            StudyError,
            "material.mus = '0.4 MPa': input should be a list",
        ),
        ('law = "gent"\nmu = "1 kPa"\njm = "30"', StudyError, "material.jm = '30': input should be a valid number"),
        ('law = "gent"\nmu = "1 kPa"\njm = -3.0', InputError, "Gent: jm = -3, allowed: more than 0"),
        ('law = "gentt"', StudyError, "material: unknown law 'gentt': did you mean 'gent'?"),
        (
            'name = "lsr-finger"\nprony = { g = [1.2], tau = ["1 s"] }',
            InputError,
            "Prony: g[1] = 1.2, allowed: between 0 and 1",
        ),
        (
            'name = "lsr-finger"\nprony = { g = [0.2], tu = ["1 s"] }',
            StudyError,
            "material.prony: unknown key 'tu': did you mean 'tau'? Allowed: g, tau",
        ),
        (
            'name = "lsr-finger"\nprony = { g = [0.2], tau = ["1 mm"] }',
            UnitError,
            "material.prony.tau[1]: tau = '1 mm'",
        ),
    ],
)
def test_bad_constants_are_refused_with_their_place(section, kind, message):
    with pytest.raises(kind) as caught:
        study(section)
    assert str(caught.value).startswith(message)
