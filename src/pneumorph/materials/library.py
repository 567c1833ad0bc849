"""The library: silicones of published actuators by name, each with its source and what was assumed."""

from __future__ import annotations

from dataclasses import dataclass

from pneumorph.errors import NameNotFoundError, unknown_name
from pneumorph.materials.material import Material
from pneumorph.materials.neo_hookean import NeoHookean
from pneumorph.materials.yeoh import Yeoh
from pneumorph.units import parse


@dataclass(frozen=True)
class LibraryEntry:
    """A named material with its origin.

    source:  where the numbers come from.
    note:    what the material is and what the source leaves open.
    given:   names of the fields of `material` that the source gives.
    assumed: names of the fields that we chose; a field in neither is not known and stays None.
    """

    name: str
    material: Material
    source: str
    note: str
    given: tuple[str, ...]
    assumed: tuple[str, ...] = ()


_WANG = "Wang, Zhang, Zhang, Zhao, Peng, Actuators 2022, 11, 125, doi 10.3390/act11050125"
_FINGER = (
    "Numerical and experimental methods for the assessment of a human finger-inspired soft pneumatic actuator for "
    "gripping applications, MethodsX"
)
_PNEUNET = "A combined analytical and numerical study of locomotion of pneumatic-network soft robots"
_PU = "Pu, Zheng, Hu, Tang, An, Materials & Design 246 (2024) 113334, doi 10.1016/j.matdes.2024.113334"

_INCOMPRESSIBLE = "The source says incompressible: the bulk modulus is 1000 times the initial shear modulus."
_MODEL_FILES = (
    "The paper says incompressible, its model files take a bulk modulus of 50 times mu; here it is 1000 times mu. "
    "Density not given."
)

_ENTRIES = (
    LibraryEntry(
        name="shore-a45-platinum",
        material=Yeoh(c10=0.11, c20=0.02, density=parse("1130 kg/m3", "density")),
        source=_WANG,
        note=f"Platinum-cured silicone, Shore A45, of the hexagonal-prism actuator. {_INCOMPRESSIBLE}",
        given=("c10", "c20", "density"),
        assumed=("bulk",),
    ),
    LibraryEntry(
        name="lsr-finger",
        material=Yeoh(c10=0.11, c20=0.03, density=parse("1100 kg/m3", "density")),
        source=_FINGER,
        note=f"Liquid silicone rubber of the finger. {_INCOMPRESSIBLE} Density not given, 1100 kg/m³ assumed.",
        given=("c10", "c20"),
        assumed=("bulk", "density"),
    ),
    LibraryEntry(
        name="ecoflex-pneunet",
        material=NeoHookean(mu=0.03, density=parse("1070 kg/m3", "density")),
        source=_PNEUNET,
        note=f"Ecoflex, the soft layer of the PneuNet robot. {_INCOMPRESSIBLE} Density assumed.",
        given=("mu",),
        assumed=("bulk", "density"),
    ),
    LibraryEntry(
        name="pdms-pneunet",
        material=NeoHookean(mu=1.84, density=parse("965 kg/m3", "density")),
        source=_PNEUNET,
        note=f"PDMS, the strain-limiting layer of the PneuNet robot. {_INCOMPRESSIBLE} Density assumed.",
        given=("mu",),
        assumed=("bulk", "density"),
    ),
    LibraryEntry(
        name="ecoflex-00-30-tube",
        material=NeoHookean(mu=0.037),
        source=_PU,
        note=f"Ecoflex 00-30, the tube under the auxetic skin; measured tensile modulus 0.111 MPa. {_MODEL_FILES}",
        given=("mu",),
        assumed=("bulk",),
    ),
    LibraryEntry(
        name="hei-cast-8400-skin",
        material=NeoHookean(mu=1.85),
        source=_PU,
        note=f"Hei-Cast 8400, the auxetic skin, 50 times the tube's modulus; measured 5.55 MPa. {_MODEL_FILES}",
        given=("mu",),
        assumed=("bulk",),
    ),
    LibraryEntry(
        name="auxetic-end-cap",
        material=NeoHookean(mu=2.0, bulk=100.0),
        source=f"{_PU}: its model files",
        note="Stiff silicone of the tube's end caps, from C10 = 1.0 MPa (mu = 2 C10) and D1 = 0.02 /MPa "
        "(bulk modulus 2/D1). Density not given.",
        given=("mu", "bulk"),
    ),
)
_LIBRARY = {entry.name: entry for entry in _ENTRIES}


def names() -> tuple[str, ...]:
    """Return the names of all materials of the library, sorted."""
    return tuple(sorted(_LIBRARY))


def entry(name: str) -> LibraryEntry:
    """Return a material with its source and assumptions; upper and lower case are alike.

    Raises NameNotFoundError with the nearest name.
    """
    found = _LIBRARY.get(name.strip().lower())
    if found is None:
        raise NameNotFoundError(unknown_name("material", name, _LIBRARY))
    return found


def material(name: str) -> Material:
    """Return a material by its name in the library; upper and lower case are alike.

    Raises NameNotFoundError with the nearest name.

    >>> material("Shore-A45-platinum").c10
    0.11
    """
    return entry(name).material
