import numpy as np
import pytest

from pneumorph.errors import InputError
from pneumorph.materials import library
from pneumorph.report.material_figure import FORMATS, held_to, material_figure

HEADS = {"png": b"\x89PNG", "svg": b"<?xml", "pdf": b"%PDF"}


@pytest.mark.parametrize("form", FORMATS)
def test_curves_are_drawn_in_each_format(form):
    entries = [library.entry("ecoflex-00-30"), library.entry("elastosil-m4601")]
    assert material_figure(entries, form).startswith(HEADS[form])


def test_soft_and_stiff_materials_share_a_logarithmic_axis(monkeypatch):
    from matplotlib.axes import Axes

    scales = []
    monkeypatch.setattr(Axes, "set_yscale", lambda self, scale: scales.append(scale))
    material_figure([library.entry("dragon-skin-10"), library.entry("dragon-skin-30")])
    assert scales == []
    material_figure([library.entry("ecoflex-00-30"), library.entry("pla")])
    assert scales == ["log"] * 3


def test_the_same_materials_give_the_same_picture():
    entries = [library.entry("pet-sheet")]
    assert material_figure(entries) == material_figure(entries)


def test_constants_hold_up_to_the_same_first_invariant_in_every_test():
    entry = library.entry("ecoflex-00-30")  # fitted to a uniaxial stretch of 2, where I1 = 4 + 2/2 = 5
    # planar: λ² + 1 + 1/λ² = 5, so λ² = 2 + √3
    planar = np.sqrt(2.0 + np.sqrt(3.0))
    for mode, limit in (("uniaxial", 2.0), ("planar", planar)):
        held = held_to(entry, mode, limit * np.array([0.5, 0.999, 1.001]))
        assert held.tolist() == [True, True, False]
    # equibiaxial: 2 λ² + 1/λ⁴ = 5 lies between 1.5 and 1.6
    assert held_to(entry, "equibiaxial", np.array([1.5, 1.6])).tolist() == [True, False]
    assert held_to(library.entry("elastosil-m4601"), "planar", np.array([9.0])).all()


def test_what_cannot_be_drawn_is_refused():
    with pytest.raises(InputError, match="no material to draw"):
        material_figure([])
    with pytest.raises(InputError, match="format = 'jpg', allowed: png, svg, pdf"):
        material_figure([library.entry("pla")], "jpg")
