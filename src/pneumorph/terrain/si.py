"""What files for MuJoCo share: factors from mm, tonne and N mm to SI units, and numbers as text."""

METRE, KILOGRAM, NEWTON_METRE = 1e-3, 1e3, 1e-3


def text(*values: float) -> str:
    """Return numbers as an attribute of MJCF.

    >>> text(0.1, 2.0)
    '0.1 2'
    """
    return " ".join(f"{value:.9g}" for value in values)
