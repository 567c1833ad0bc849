"""From lattice cells to laws of closed layers: periodic cells at finite strain, fitted skins, tubes that wear them."""

from pneumorph.homogenisation.law import SkinLaw, blended, skin_law
from pneumorph.homogenisation.periodic import Mean, PeriodicCell
from pneumorph.homogenisation.skinned import homogenised_model, inflate, inflated_line, skin_laws
from pneumorph.homogenisation.tension import Sheet, TensionTest, periodic_test, tension_test

__all__ = [
    "Mean", "PeriodicCell", "Sheet", "SkinLaw", "TensionTest", "blended", "homogenised_model", "inflate",
    "inflated_line", "periodic_test", "skin_law", "skin_laws", "tension_test",
]  # fmt: skip
