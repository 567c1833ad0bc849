"""Materials: one file per stored energy, their viscosity and stability, and a library of silicones with sources."""

from pneumorph.materials import library
from pneumorph.materials.arruda_boyce import ArrudaBoyce
from pneumorph.materials.extended_tube import ExtendedTube
from pneumorph.materials.gent import Gent
from pneumorph.materials.invariant import InvariantEnergy, InvariantMaterial
from pneumorph.materials.laws import LAWS
from pneumorph.materials.linear_elastic import LinearElastic
from pneumorph.materials.material import Material
from pneumorph.materials.mooney_rivlin import MooneyRivlin
from pneumorph.materials.neo_hookean import NeoHookean
from pneumorph.materials.ogden import Ogden
from pneumorph.materials.orthotropic import OrthotropicLayer
from pneumorph.materials.prony import Prony, ViscousStep
from pneumorph.materials.ridges import Ridges
from pneumorph.materials.stability import USUAL_RANGE, Instability, instabilities, stability_limit
from pneumorph.materials.stretch import StretchEnergy, StretchMaterial
from pneumorph.materials.yeoh import Yeoh

__all__ = [
    "LAWS",
    "ArrudaBoyce",
    "ExtendedTube",
    "Gent",
    "Instability",
    "InvariantEnergy",
    "InvariantMaterial",
    "LinearElastic",
    "Material",
    "MooneyRivlin",
    "NeoHookean",
    "Ogden",
    "OrthotropicLayer",
    "Prony",
    "Ridges",
    "StretchEnergy",
    "StretchMaterial",
    "ViscousStep",
    "Yeoh",
    "USUAL_RANGE",
    "instabilities",
    "library",
    "stability_limit",
]
