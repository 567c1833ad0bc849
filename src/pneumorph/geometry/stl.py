"""Binary STL files."""

from __future__ import annotations

import struct

import numpy as np
from numpy.typing import NDArray


def stl_bytes(points: NDArray[np.float64], triangles: NDArray[np.int64], title: str) -> bytes:
    """Return a binary STL file: 80 bytes of header, a count, and 50 bytes a triangle.

    points (n, 3), mm; triangles (k, 3), anticlockwise seen from outside; title: for the header, which keeps 80 bytes.
    Equal nodes give equal corners, so what closes on its nodes closes in the file.
    """
    corners = points[triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    length = np.linalg.norm(normals, axis=1, keepdims=True)
    normals /= np.where(length > 0.0, length, 1.0)  # the format allows a zero normal for a flat triangle
    table = np.zeros(len(triangles), dtype=[("vectors", "<f4", (4, 3)), ("attribute", "<u2")])
    table["vectors"][:, 0], table["vectors"][:, 1:] = normals, corners
    # readers take a header that starts with "solid" for the text format
    header = f"pneumorph {title}, mm".encode("ascii", "replace")[:80].ljust(80)
    return header + struct.pack("<I", len(triangles)) + table.tobytes()
