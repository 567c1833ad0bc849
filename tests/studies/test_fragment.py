"""A material goes into a study file and comes back the same."""

from dataclasses import dataclass

import pytest

from pneumorph.errors import InputError
from pneumorph.materials import LAWS, ExtendedTube, Gent, MooneyRivlin, NeoHookean, Ogden, Yeoh
from pneumorph.studies import load_study
from pneumorph.studies.fragment import material_fragment

MATERIALS = [
    NeoHookean(1.0 / 3.0),
    Yeoh(0.11, 0.02, density=1.13e-9),
    Yeoh(0.11, -1.23456789012345e-7, 3e-9, bulk=200.0),
    MooneyRivlin(0.2, -0.05),
    Gent(0.25, 87.94),
    ExtendedTube(0.2051, 0.1744, 0.2026, 0.09437),
    Ogden((0.63, 0.0012, -0.01), (1.3, 5.0, -2.0)),
]


@pytest.mark.parametrize("material", MATERIALS, ids=lambda material: type(material).__name__)
@pytest.mark.parametrize("domain", [None, "body"])
def test_a_study_reads_the_fragment_as_the_same_material(tmp_path, material, domain):
    path = tmp_path / "study.toml"
    rest = '[actuator]\ntemplate = "thick-sphere"\n[[phase]]\ntargets = { cavity = "1 kPa" }\n'
    path.write_text(material_fragment(material, domain) + rest)
    (read,) = load_study(path).materials.values()
    assert type(read) is type(material)
    for key, value in vars(material).items():
        assert getattr(read, key) == (pytest.approx(value, rel=1e-14) if value is not None else None)


def test_what_is_left_to_its_default_is_left_out():
    assert material_fragment(Yeoh(0.11, 0.02)) == '\n[material]\nlaw = "yeoh"\nc10 = "0.11 MPa"\nc20 = "0.02 MPa"\n'


def test_a_material_that_study_files_do_not_name_is_refused():
    @dataclass(frozen=True)
    class Own(NeoHookean):
        """A law of the user's own."""

    with pytest.raises(InputError, match=f"allowed: one of the laws {', '.join(sorted(LAWS))}"):
        material_fragment(Own(0.1))
