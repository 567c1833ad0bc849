"""Materials of an .inp file: each law as the card that both programs have for it.

Both programs take D1 = 2 / K: the volumetric energy is (J - 1)^2 / D1, for Arruda-Boyce ((J^2 - 1) / 2 - ln J) / D
(CalculiX 2.20 manual, *HYPERELASTIC; Abaqus Materials Guide, "Hyperelastic behavior of rubberlike materials").
"""

from __future__ import annotations

from collections.abc import Callable

from pneumorph.errors import InputError
from pneumorph.exchange.inp_mesh import CALCULIX, rows
from pneumorph.materials import ArrudaBoyce, LinearElastic, Material, MooneyRivlin, NeoHookean, Ogden, Yeoh

# Poisson's ratio above which Abaqus wants hybrid elements
_NEARLY_INCOMPRESSIBLE = 0.475
_MOST_OGDEN_TERMS = 3
# D of a volumetric term that is not wanted: CalculiX replaces a D of zero by a default, Abaqus drops its term
_UNUSED = {CALCULIX: 1e20}

Card = tuple[str, list[float]]


def is_hybrid(material: Material) -> bool:
    """Return whether Abaqus should solve the material with hybrid elements."""
    return material.poisson_ratio > _NEARLY_INCOMPRESSIBLE


def material_lines(material: Material, name: str, domain: str, dialect: str) -> list[str]:
    """Return *MATERIAL with its law and density; raises InputError, with the domain, for a law without a card."""
    card = _CARDS.get(type(material))
    if card is None:
        known = ", ".join(sorted(item.__name__ for item in _CARDS))
        raise InputError(
            f"the material of '{domain}' is a {type(material).__name__}: no such law in CalculiX and Abaqus; "
            f"allowed in an .inp file: {known}"
        )
    keyword, constants = card(material, dialect)
    lines = [f"*MATERIAL, NAME={name}", keyword, *rows([f"{value:.12g}" for value in constants], 8)]
    if material.density is not None:
        lines += ["*DENSITY", f"{material.density:.12g}"]
    if material.prony is not None:
        lines.append("** its Prony series is left out: the steps are static, the constants long-term ones")
    return lines


def _volumetric(material: Material, terms: int, dialect: str) -> list[float]:
    return [2.0 / material.bulk_modulus, *[_UNUSED.get(dialect, 0.0)] * (terms - 1)]


def _neo_hookean(material: NeoHookean, dialect: str) -> Card:
    return "*HYPERELASTIC, NEO HOOKE", [material.mu / 2.0, *_volumetric(material, 1, dialect)]


def _yeoh(material: Yeoh, dialect: str) -> Card:
    constants = [material.c10, material.c20, material.c30]
    return "*HYPERELASTIC, YEOH", [*constants, *_volumetric(material, 3, dialect)]


def _mooney_rivlin(material: MooneyRivlin, dialect: str) -> Card:
    second = [material.c20, material.c11, material.c02]
    if not any(second):
        return "*HYPERELASTIC, MOONEY-RIVLIN", [material.c10, material.c01, *_volumetric(material, 1, dialect)]
    constants = [material.c10, material.c01, *second, *_volumetric(material, 2, dialect)]
    return "*HYPERELASTIC, POLYNOMIAL, N=2", constants


def _ogden(material: Ogden, dialect: str) -> Card:
    terms = len(material.mus)
    if dialect == CALCULIX and terms > _MOST_OGDEN_TERMS:
        raise InputError(f"Ogden's law with {terms} terms: CalculiX has at most {_MOST_OGDEN_TERMS}")
    # both programs write 2 m / alpha^2 where Ogden writes mu / alpha
    pairs = [(mu * alpha / 2.0, alpha) for mu, alpha in zip(material.mus, material.alphas, strict=True)]
    constants = [value for pair in pairs for value in pair]
    return f"*HYPERELASTIC, OGDEN, N={terms}", [*constants, *_volumetric(material, terms, dialect)]


def _arruda_boyce(material: ArrudaBoyce, dialect: str) -> Card:
    constants = [material.c_r, material.locking_stretch]
    return "*HYPERELASTIC, ARRUDA-BOYCE", [*constants, *_volumetric(material, 1, dialect)]


def _linear_elastic(material: LinearElastic, dialect: str) -> Card:
    """Hooke's law of the program: CalculiX takes Green's strain, Abaqus Hencky's; alike where it is small."""
    return "*ELASTIC", [material.young, material.poisson]


_CARDS: dict[type[Material], Callable[..., Card]] = {
    ArrudaBoyce: _arruda_boyce,
    LinearElastic: _linear_elastic,
    MooneyRivlin: _mooney_rivlin,
    NeoHookean: _neo_hookean,
    Ogden: _ogden,
    Yeoh: _yeoh,
}
