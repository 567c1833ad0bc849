"""Contact of grains with turning wheels, in SI units: Hertz, Mindlin and rolling resistance on triangles (Numba)."""

from __future__ import annotations

from math import sqrt
from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[np.float64]
Index = NDArray[np.integer[Any]]

_PLACES = 64  # nearest places on triangles that one grain may have
MOST_CONTACTS = 6  # of one grain with one wheel
_SAME = 0.7  # cosine between the normals of a contact in this step and the one before


@njit(cache=True, nogil=True, error_model="numpy")
def nearest_on_triangle(p: Array, corners: Array, place: Array) -> float:
    """Write the place (3,) of a triangle (3, 3) that is nearest to p (3,); return its squared distance.

    By the regions of the triangle: corners, edges, inside (Ericson 2005, section 5.1.5).
    """
    a, b, c = corners[0], corners[1], corners[2]
    d1 = d2 = d3 = d4 = d5 = d6 = 0.0
    for i in range(3):
        ab, ac = b[i] - a[i], c[i] - a[i]
        d1 += ab * (p[i] - a[i])
        d2 += ac * (p[i] - a[i])
        d3 += ab * (p[i] - b[i])
        d4 += ac * (p[i] - b[i])
        d5 += ab * (p[i] - c[i])
        d6 += ac * (p[i] - c[i])
    va, vb, vc = d3 * d6 - d5 * d4, d5 * d2 - d1 * d6, d1 * d4 - d3 * d2
    v = w = 0.0
    if d1 <= 0.0 and d2 <= 0.0:
        pass
    elif d3 >= 0.0 and d4 <= d3:
        v = 1.0
    elif d6 >= 0.0 and d5 <= d6:
        w = 1.0
    elif vc <= 0.0 and d1 >= 0.0 and d3 <= 0.0:
        v = d1 / (d1 - d3)
    elif vb <= 0.0 and d2 >= 0.0 and d6 <= 0.0:
        w = d2 / (d2 - d6)
    elif va <= 0.0 and d4 - d3 >= 0.0 and d5 - d6 >= 0.0:
        w = (d4 - d3) / ((d4 - d3) + (d5 - d6))
        v = 1.0 - w
    else:
        v, w = vb / (va + vb + vc), vc / (va + vb + vc)
    squared = 0.0
    for i in range(3):
        place[i] = a[i] + v * (b[i] - a[i]) + w * (c[i] - a[i])
        squared += (p[i] - place[i]) ** 2
    return squared


@njit(cache=True, nogil=True, error_model="numpy")
def contact_places(
    p: Array, radius: float, corners: Array, spheres: Array, candidates: Index, places: Array, depths: Array
) -> int:
    """Write the places (MOST_CONTACTS, 3) where a sphere touches and how deep; return how many.

    A sphere on a surface is near many triangles, of which those beside the nearest one do not count: a place counts
    if it stands out of the tangent planes at all places that are nearer. So a convex edge gives one contact, an inner
    corner one for each side. spheres (k, 4): centre and radius around each triangle.
    """
    found = np.empty((_PLACES, 3))
    distance = np.empty(_PLACES)
    count = 0
    place = np.empty(3)
    for t in candidates:
        far = radius + spheres[t, 3]
        gap = (p[0] - spheres[t, 0]) ** 2 + (p[1] - spheres[t, 1]) ** 2 + (p[2] - spheres[t, 2]) ** 2
        if gap >= far * far:
            continue
        squared = nearest_on_triangle(p, corners[t], place)
        if squared >= radius * radius or count == _PLACES:
            continue
        # sorted in, the nearest first
        j = count
        here = sqrt(squared)
        while j > 0 and distance[j - 1] > here:
            distance[j] = distance[j - 1]
            found[j] = found[j - 1]
            j -= 1
        distance[j] = here
        found[j] = place
        count += 1
    kept = 0
    for j in range(count):
        counts = distance[j] > 0.0
        for k in range(kept):
            above = 0.0
            for i in range(3):
                above += (found[j, i] - places[k, i]) * (p[i] - places[k, i])
            if above <= 1e-3 * radius * (radius - depths[k]):
                counts = False
                break
        if counts and kept < MOST_CONTACTS:
            places[kept] = found[j]
            depths[kept] = radius - distance[j]
            kept += 1
    return kept


@njit(cache=True, nogil=True, error_model="numpy")
def wheel_forces(
    x: Array, v: Array, omega: Array, radii: Array, mass: Array, tag: Index, force: Array, torque: Array,
    centre: Array, turn: Array, velocity: Array, spin: Array,
    reach: float, corners: Array, spheres: Array, origin: Array, size: float, counts: Index, starts: Index,
    members: Index, nearest: Array,
    law: tuple[float, ...], dt: float,
    first: Index, number: Index, old: Array, old_owner: Index, old_total: int, new: Array, new_owner: Index,
    acting: Array, wrench: Array,
) -> tuple[int, float, float, int]:  # fmt: skip
    """Add the wheels' forces and torques to the grains' and write their opposites to `wrench` (w, 6), about the axles.

    Of the grains x, v, omega, force, torque are (n, 3), the others (n,). Of the wheels centre, velocity, spin are
    (w, 3) and turn (w, 3, 3), from wheel to world. reach to members: the wheel's surface and its `CellLists`.

    Called when all other forces on the grains are known, so that their velocities in the middle of the step are.

    law: effective modulus and shear modulus, damping factor, sliding and rolling coefficient, rolling stiffness and
    damping. old, new: contacts of the last step and of this one, rows of normal, tangential and rolling spring (9);
    old_owner, new_owner: their wheel, tag and index of the grain; old_total: how many old ones there are. first, number
    (w, tags): where a grain's contacts with a wheel stand in `old`; they are brought up to date. acting: room for the
    force and torque (6) of each new contact.
    Returns (number of contacts, deepest overlap over the grain's radius, power on the grains, how many contacts found
    no room in `new`).
    """
    modulus, shear, loss, friction, rolling, rolling_k, rolling_c = law
    places, depths = np.empty((MOST_CONTACTS, 3)), np.empty(MOST_CONTACTS)
    local, n, lever = np.empty(3), np.empty(3), np.empty(3)
    xi, rho, slip, roll = np.empty(3), np.empty(3), np.empty(3), np.empty(3)
    total, dropped = 0, 0
    deepest, power = 0.0, 0.0
    wrench[:] = 0.0
    # one look at all grains for all wheels: most are far ahead or behind
    back, ahead = centre[:, 0].min() - reach, centre[:, 0].max() + reach
    candidates, count = np.empty(len(x), np.int64), 0
    for g in range(len(x)):
        if back - radii[g] < x[g, 0] < ahead + radii[g]:
            candidates[count] = g
            count += 1
    for w in range(len(centre)):
        for g in candidates[:count]:
            near = reach + radii[g]
            dx = x[g, 0] - centre[w, 0]
            if dx > near or dx < -near:
                continue
            dy, dz = x[g, 1] - centre[w, 1], x[g, 2] - centre[w, 2]
            if dx * dx + dy * dy + dz * dz > near * near:
                continue
            cell = 0
            outside, aside = False, 0.0
            for i in range(3):
                local[i] = turn[w, 0, i] * dx + turn[w, 1, i] * dy + turn[w, 2, i] * dz
                c = int((local[i] - origin[i]) / size)
                if local[i] < origin[i] or c >= counts[i]:
                    outside = True
                    break
                cell = cell * counts[i] + c
                aside += (local[i] - origin[i] - (c + 0.5) * size) ** 2
            if outside or starts[cell] == starts[cell + 1] or nearest[cell] - sqrt(aside) >= radii[g]:
                continue
            found = contact_places(
                local, radii[g], corners, spheres, members[starts[cell] : starts[cell + 1]], places, depths
            )
            for k in range(found):
                if total == len(new):
                    dropped += 1
                    continue
                # normal from the wheel to the grain, and the lever from the axle to the place, in the world
                scale = 1.0 / (radii[g] - depths[k])
                for i in range(3):
                    n[i] = lever[i] = 0.0
                    for j in range(3):
                        n[i] += turn[w, i, j] * (local[j] - places[k, j]) * scale
                        lever[i] += turn[w, i, j] * places[k, j]
                    lever[i] -= 0.5 * depths[k] * n[i]  # the middle of the overlap, for both
                # springs of the old contact whose normal is nearest
                best = _SAME
                xi[:] = 0.0
                rho[:] = 0.0
                for o in range(first[w, tag[g]], first[w, tag[g]] + number[w, tag[g]]):
                    same = old[o, 0] * n[0] + old[o, 1] * n[1] + old[o, 2] * n[2]
                    if same > best:
                        best = same
                        xi[:] = old[o, 3:6]
                        rho[:] = old[o, 6:9]
                r, depth = radii[g], depths[k]
                # the grain's surface against the wheel's, with the lever arm of the flattened grain
                arm = r - 0.5 * depth
                vn = 0.0
                for i in range(3):
                    a, b = (i + 1) % 3, (i + 2) % 3
                    grain = v[g, i] - arm * (omega[g, a] * n[b] - omega[g, b] * n[a])
                    wheel = velocity[w, i] + spin[w, a] * lever[b] - spin[w, b] * lever[a]
                    slip[i] = grain - wheel
                    roll[i] = r * ((omega[g, a] - spin[w, a]) * n[b] - (omega[g, b] - spin[w, b]) * n[a])
                    vn += slip[i] * n[i]
                contact = sqrt(r * depth)
                stiffness = 4.0 / 3.0 * modulus * sqrt(r)
                # Tsuji's damping, sqrt(m k) delta^(1/4)
                damping = loss * sqrt(mass[g] * stiffness) * sqrt(sqrt(depth))
                fn = stiffness * depth * sqrt(depth) - damping * vn
                limit = max(fn, 0.0)
                kt = 8.0 * shear * contact
                _spring(xi, slip, n, vn, kt, damping, friction * limit, dt)
                _spring(rho, roll, n, 0.0, rolling_k, rolling_c, rolling * limit, dt)
                for i in range(3):  # slip and roll hold forces now
                    a, b = (i + 1) % 3, (i + 2) % 3
                    f = fn * n[i] + slip[i]
                    fa, fb = fn * n[a] + slip[a], fn * n[b] + slip[b]
                    couple = r * (n[a] * roll[b] - n[b] * roll[a])
                    t = couple - arm * (n[a] * slip[b] - n[b] * slip[a])
                    force[g, i] += f
                    torque[g, i] += t
                    wrench[w, i] -= f
                    wrench[w, 3 + i] -= lever[a] * fb - lever[b] * fa + couple
                    acting[total, i], acting[total, 3 + i] = f, t
                new[total, 0:3] = n
                new[total, 3:6] = xi
                new[total, 6:9] = rho
                new_owner[total, 0], new_owner[total, 1], new_owner[total, 2] = w, tag[g], g
                total += 1
                deepest = max(deepest, depth / r)
    for o in range(old_total):
        number[old_owner[o, 0], old_owner[o, 1]] = 0
    for o in range(total):
        w, name, g = new_owner[o]
        if number[w, name] == 0:
            first[w, name] = o
        number[w, name] += 1
        inertia = 0.4 * mass[g] * radii[g] ** 2
        for i in range(3):
            power += acting[o, i] * (v[g, i] + 0.5 * dt * force[g, i] / mass[g])
            power += acting[o, 3 + i] * (omega[g, i] + 0.5 * dt * torque[g, i] / inertia)
    return total, deepest, power, dropped


@njit(cache=True, nogil=True, error_model="numpy")
def _spring(
    xi: Array, rate: Array, n: Array, along: float, stiffness: float, damping: float, limit: float, dt: float
) -> None:
    """Advance a spring across the normal by a velocity, slip it at the limit, and put its force in place of the rate.

    along: the part of the velocity along n, which does not count. The spring turns with the contact: its part along
    the new normal goes, its length stays.
    """
    part = xi[0] * n[0] + xi[1] * n[1] + xi[2] * n[2]
    before = sqrt(xi[0] ** 2 + xi[1] ** 2 + xi[2] ** 2)
    for i in range(3):
        xi[i] -= part * n[i]
    after = sqrt(xi[0] ** 2 + xi[1] ** 2 + xi[2] ** 2)
    if after > 0.0:
        for i in range(3):
            xi[i] *= before / after
    size = 0.0
    for i in range(3):
        speed = rate[i] - along * n[i]
        xi[i] += speed * dt
        rate[i] = -stiffness * xi[i] - damping * speed
        size += rate[i] ** 2
    size = sqrt(size)
    if size > limit:
        for i in range(3):
            wanted = rate[i] * limit / size if size > 0.0 else 0.0
            speed = (-rate[i] - stiffness * xi[i]) / damping if damping > 0.0 else 0.0
            xi[i] = -(wanted + damping * speed) / stiffness if stiffness > 0.0 else 0.0
            rate[i] = wanted


@njit(cache=True, nogil=True, error_model="numpy")
def shift_moments(wrench: Array, new: Array, old: Array) -> None:
    """Turn moments about `old` places into those about `new` ones; wrench (b, 6): force, moment; places (b, 3)."""
    for w in range(len(wrench)):
        for i in range(3):
            a, b = (i + 1) % 3, (i + 2) % 3
            wrench[w, 3 + i] -= (new[w, a] - old[w, a]) * wrench[w, b] - (new[w, b] - old[w, b]) * wrench[w, a]
