"""The library of silicones."""

from dataclasses import fields

import pytest

from pneumorph.errors import NameNotFoundError
from pneumorph.materials import NeoHookean, Yeoh, library


def test_silicone_of_the_hexagonal_prism_is_that_of_its_study():
    silicone = library.material("shore-a45-platinum")
    assert silicone == Yeoh(0.11, 0.02, density=1.13e-9)
    assert "assumed" not in library.entry("shore-a45-platinum").note.lower()


def test_rubber_of_the_finger_has_an_assumed_density():
    rubber = library.entry("lsr-finger")
    assert rubber.material == Yeoh(0.11, 0.03, density=1.1e-9)
    assert rubber.assumed == ("bulk", "density")


def test_pneunet_materials_are_those_of_the_study():
    assert library.material("ecoflex-pneunet") == NeoHookean(0.03, density=1.07e-9)
    assert library.material("pdms-pneunet") == NeoHookean(1.84, density=9.65e-10)


def test_auxetic_skin_is_fifty_times_as_stiff_as_its_tube():
    tube, skin = library.material("ecoflex-00-30-tube"), library.material("hei-cast-8400-skin")
    assert skin.shear_modulus / tube.shear_modulus == pytest.approx(50.0)
    # the source's measured tensile moduli, 3 mu of an incompressible solid
    assert 3.0 * tube.shear_modulus == pytest.approx(0.111)
    assert 3.0 * skin.shear_modulus == pytest.approx(5.55)


def test_a_name_is_found_in_either_case():
    assert library.material(" Shore-A45-Platinum ") is library.material("shore-a45-platinum")


def test_an_unknown_silicone_is_refused_with_the_nearest_name():
    with pytest.raises(NameNotFoundError, match=r"unknown material 'lsr-finge': did you mean 'lsr-finger'\? Allowed: "):
        library.material("lsr-finge")


@pytest.mark.parametrize("name", library.names())
def test_every_entry_says_where_each_of_its_numbers_comes_from(name):
    entry = library.entry(name)
    assert entry.name == name == name.lower()
    assert entry.source
    assert entry.note.endswith(".")
    known = {item.name for item in fields(entry.material) if getattr(entry.material, item.name) is not None}
    law_defaults = {item.name for item in fields(entry.material) if item.default == getattr(entry.material, item.name)}
    assert not set(entry.given) & set(entry.assumed)
    assert set(entry.given) | set(entry.assumed) | law_defaults >= known
    # an assumed bulk modulus is the default ratio and stays None; everything else that is listed has a value
    assert (set(entry.given) | set(entry.assumed)) - known <= {"bulk"}
