"""The three tests that rubber is measured in: their principal stretches, for an incompressible specimen."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pneumorph.errors import InputError, NameNotFoundError, unknown_name

Array = NDArray[np.float64]

# powers of the stretch along the pull; the third direction is free of stress
_POWERS = {"uniaxial": (1.0, -0.5, -0.5), "equibiaxial": (1.0, 1.0, -2.0), "planar": (1.0, 0.0, -1.0)}
MODES = tuple(_POWERS)


def principal_stretches(mode: str, stretch: ArrayLike) -> Array:
    """Return the principal stretches (..., 3), first along the pull, last across a free face, at `stretch` (...).

    mode: "uniaxial" (bar), "equibiaxial" (sheet pulled alike both ways) or "planar" (wide strip, pure shear).
    Raises NameNotFoundError for another mode, InputError for a stretch that is not finite and positive.
    """
    if mode not in _POWERS:
        raise NameNotFoundError(unknown_name("mode", mode, MODES))
    values = np.asarray(stretch, dtype=np.float64)
    if not (np.isfinite(values) & (values > 0.0)).all():
        raise InputError(f"stretch = {stretch!r}, allowed: finite and more than 0")
    return np.stack([values**power for power in _POWERS[mode]], axis=-1)
