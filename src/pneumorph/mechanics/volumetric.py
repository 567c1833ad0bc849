"""How the resistance to a change of volume is shared between the cell's pressure and its points.

The bulk modulus K of a material is split in two: K - k acts on the mean of J - 1 in a cell through the pressure modes,
the small rest k at every quadrature point through U(J) = k / 4 (J^2 - 1 - 2 ln J), with U' = k / 2 (J - 1 / J).
All of K in four modes over-constrains 10-node tetrahedra: sliver cells lock, answer with pressures a hundred times the
load and end Newton's convergence; all of it in one mode lets det F go through zero in a corner of a large cell. The
share k of a few shear moduli avoids both, and is consistent: pointwise J tends to 1 as the mesh is refined.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from pneumorph.materials import Material

# pointwise bulk modulus over the initial shear modulus
LOCAL_BULK = 20.0


def split_bulk(material: Material) -> tuple[float, float]:
    """Return (K - k, k), MPa: the bulk moduli of the pressure modes and of the points."""
    local = min(LOCAL_BULK * material.shear_modulus, 0.95 * material.bulk_modulus)
    return material.bulk_modulus - local, local


def local_pressure(volume_ratio: NDArray[np.float64], local: float) -> NDArray[np.float64]:
    """Return U'(J), MPa: the pointwise part of the mean tension; the pressure modes add theirs."""
    return 0.5 * local * (volume_ratio - 1.0 / volume_ratio)
