"""The laws by the names that study files, the library and the command line give them."""

from __future__ import annotations

from pneumorph.materials.arruda_boyce import ArrudaBoyce
from pneumorph.materials.extended_tube import ExtendedTube
from pneumorph.materials.gent import Gent
from pneumorph.materials.linear_elastic import LinearElastic
from pneumorph.materials.material import Material
from pneumorph.materials.mooney_rivlin import MooneyRivlin
from pneumorph.materials.neo_hookean import NeoHookean
from pneumorph.materials.ogden import Ogden
from pneumorph.materials.yeoh import Yeoh

LAWS: dict[str, type[Material]] = {
    "arruda-boyce": ArrudaBoyce,
    "extended-tube": ExtendedTube,
    "gent": Gent,
    "linear-elastic": LinearElastic,
    "mooney-rivlin": MooneyRivlin,
    "neo-hookean": NeoHookean,
    "ogden": Ogden,
    "yeoh": Yeoh,
}


def law_name(material: Material) -> str | None:
    """Return the name of a material's law in study files; None for a class that these do not name."""
    return next((name for name, law in LAWS.items() if law is type(material)), None)
