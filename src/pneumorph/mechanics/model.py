"""The model: a mesh with materials, supports, loads and cavities, checked when it is made."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from pneumorph.errors import InputError, MeshError, NameNotFoundError, unknown_name
from pneumorph.materials import Material
from pneumorph.mechanics.body import Body, cell_volumes
from pneumorph.mechanics.cavity import Cavity, CavitySurface
from pneumorph.mechanics.contact import Contact, Contacts, Frame, FreeBody, Motion
from pneumorph.mechanics.contact.apart import body_of_nodes
from pneumorph.mechanics.contact.free_body import with_frames
from pneumorph.mechanics.contact.rigidity import STIFFER, Rigidity
from pneumorph.mechanics.loads import Gravity, Load, lumped_mass
from pneumorph.mechanics.supplies import Atmosphere, Supply, Tube
from pneumorph.mechanics.supplies.checks import check_tubes
from pneumorph.mechanics.supports import Prescribed, Support
from pneumorph.mesh.mesh import Mesh

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Model:
    """What is solved.

    mesh:      cells and named faces; the model adds nodes for its free bodies to it.
    materials: domain -> material, one for each domain of the mesh.
    supports:  clamps, rollers, symmetry planes and prescribed displacements; together they must hold the body.
    loads:     gravity, tractions and forces.
    cavities:  the spaces that are inflated.
    tubes:     tubes between cavities filled with gas.
    atmosphere: pressure and temperature outside, and the gas.
    contacts:  what may touch what; with any, supports need not hold the body.
    free_bodies: rigid bodies with mass; contacts, loads and supports name them like faces.
    pressure:  'constant' or 'linear' pressure modes in each cell (see `mechanics.volumetric`).

    Raises InputError for a domain without material or unknown, names given twice, a body that is free to move,
    surfaces in contact that intersect, a free body without a closed surface or that no contact names;
    MeshError for cells turned inside out or nodes without a cell; LeakingCavityError for an open cavity.
    """

    mesh: Mesh
    materials: Mapping[str, Material]
    supports: tuple[Support, ...] = ()
    loads: tuple[Load, ...] = ()
    cavities: tuple[Cavity, ...] = ()
    pressure: str = field(default="constant", kw_only=True)
    tubes: tuple[Tube, ...] = field(default=(), kw_only=True)
    atmosphere: Atmosphere = field(default=Atmosphere(), kw_only=True)
    contacts: tuple[Contact, ...] = field(default=(), kw_only=True)
    free_bodies: tuple[FreeBody, ...] = field(default=(), kw_only=True)

    def __post_init__(self) -> None:
        if self.pressure not in ("linear", "constant"):
            raise InputError(f"pressure = {self.pressure!r}, allowed: linear, constant")
        for domain in self.materials:
            if domain not in self.mesh.domains:
                raise NameNotFoundError(unknown_name("domain", domain, self.mesh.domains))
        for domain in self.mesh.domains:
            if domain not in self.materials:
                raise InputError(f"no material for the domain '{domain}' of the mesh")
        object.__setattr__(self, "mesh", with_frames(self.mesh, self.free_bodies)[0])
        for contact in self.contacts:
            if contact.body in self.mesh.frames:
                raise InputError(f"contact '{contact.name}': '{contact.body}' is a free body; name it among faces")
        names = [item.name for item in (*self.loads, *self.cavities, *self._moved, *self.free_bodies)]
        names += [*self.obstacles, *(contact.name for contact in self.contacts)]
        for name in names:
            if names.count(name) > 1:
                raise InputError(
                    f"the name '{name}' is given to {names.count(name)} loads, cavities, displacements or contacts"
                )
        self._check_mesh()
        self._check_held()
        _ = self.load_patterns
        _ = self.surfaces
        _ = self.contact
        for body in self.free_bodies:
            if not any(body.name in (*c.faces, *c.other_faces) for c in self.contacts):
                raise InputError(f"free body '{body.name}': no contact has it among its faces or against them")
        check_tubes(self.tubes, self.supplies)

    @property
    def _moved(self) -> tuple[Prescribed, ...]:
        return tuple(support for support in self.supports if isinstance(support, Prescribed))

    @cached_property
    def kinds(self) -> dict[str, str]:
        """Name -> unit kind of everything that a programme can drive."""
        kinds = {name: supply.kind for name, supply in self.supplies.items() if supply.kind is not None}
        kinds |= {item.name: item.kind for item in (*self.loads, *self._moved)}
        return kinds | {name: motion.kind for name, motion in self.obstacles.items()}

    @property
    def obstacles(self) -> dict[str, Motion]:
        """Name -> motion of the obstacles that a programme moves; one motion may move several."""
        return {contact.motion.name: contact.motion for contact in self.contacts if contact.motion}

    @property
    def bodies(self) -> dict[str, tuple[str, ...]]:
        """Name of each rigid body that has one -> names of the contacts with it."""
        named = [contact.body for contact in self.contacts if contact.body]
        return {body: tuple(c.name for c in self.contacts if c.body == body) for body in dict.fromkeys(named)}

    @cached_property
    def contact(self) -> Contacts:
        """The contacts at work."""
        softest = min(item.shear_modulus for item in self.materials.values())
        return Contacts(self.mesh, self.contacts, softest, self.frames)

    @cached_property
    def supplies(self) -> dict[str, Supply]:
        """Name -> supply of each cavity."""
        return {cavity.name: cavity.supply for cavity in self.cavities}

    @cached_property
    def body(self) -> Body:
        """Elements and sparsity pattern."""
        stiffest = max(item.shear_modulus for item in self.materials.values())
        rigidity = Rigidity(self.frames, STIFFER * stiffest) if self.frames else None
        return Body(self.mesh, dict(self.materials), self.pressure, rigidity)

    @cached_property
    def frames(self) -> tuple[Frame, ...]:
        """The free bodies on the mesh, in their order."""
        return with_frames(self.mesh, self.free_bodies)[1]

    @cached_property
    def surfaces(self) -> dict[str, CavitySurface]:
        """Name -> surface of each cavity."""
        return {c.name: CavitySurface(c, self.mesh, self.body.pattern) for c in self.cavities}

    @cached_property
    def held(self) -> NDArray[np.int64]:
        """Unknowns with a given displacement, sorted, each once."""
        sets = [s.driven(self.mesh) if isinstance(s, Prescribed) else s.held(self.mesh) for s in self.supports]
        return np.unique(np.concatenate(sets)) if sets else np.empty(0, dtype=np.int64)

    @property
    def loose_bodies(self) -> tuple[str, ...]:
        """Names of the free bodies that supports leave free to move in some direction."""
        d, held = self.mesh.dimension, self.held
        unknowns = {frame.name: (d * frame.nodes[:, None] + np.arange(d)).ravel() for frame in self.frames}
        return tuple(name for name, own in unknowns.items() if not np.isin(own, held).all())

    def prescribed(self, values: Mapping[str, float]) -> Array:
        """Return the displacement (nodes * d,) that supports give: zero, or what `values` (mm) say by name."""
        result = np.zeros(self.mesh.points.size)
        for moved in self._moved:
            result[moved.driven(self.mesh)] = values.get(moved.name, 0.0)
        for support in self.supports:
            if not isinstance(support, Prescribed):
                result[support.held(self.mesh)] = 0.0
        return result

    @cached_property
    def load_patterns(self) -> dict[str, Array]:
        """Name -> nodal forces (nodes * d,) of each load at the value 1."""
        patterns = {}
        for load in self.loads:
            patterns[load.name] = load.pattern(self.mesh, self.materials)
            if isinstance(load, Gravity):
                patterns[load.name] += load.weights(self.mesh, {f.name: f.mass for f in self.frames})
        return patterns

    @cached_property
    def unit_mass(self) -> Array:
        """Lumped volume (nodes,), mm3: the weights of viscous regularisation."""
        return lumped_mass(self.mesh, dict.fromkeys(self.mesh.domains, 1.0))

    def _check_mesh(self) -> None:
        used = np.zeros(self.mesh.solid, dtype=bool)
        for block in self.mesh.blocks:
            used[block.nodes] = True
            volumes = cell_volumes(self.mesh, block)
            if volumes.min() <= 0.0:
                cell = int(np.argmin(volumes.min(axis=1)))
                where = ", ".join(f"{x:.4g}" for x in self.mesh.points[block.nodes[cell]].mean(axis=0))
                raise MeshError(f"{block.kind} {cell} of '{block.domain}' at ({where}) mm is turned inside out")
        if not used.all():
            raise MeshError(f"{int((~used).sum())} nodes belong to no cell")

    def _check_held(self) -> None:
        """Every rigid motion of every body must move a held unknown."""
        modes, names = _rigid_modes(self.mesh)
        label = body_of_nodes(self.mesh)
        # friction and walls hold, too, but only once there is contact
        touching = [face for contact in self.contacts for face in (*contact.faces, *contact.other_faces)]
        touched = {int(label[self.mesh.face_nodes(face)[0]]) for face in touching if face in self.mesh.faces}
        owner = label[self.held // self.mesh.dimension]
        domains = {int(label[block.nodes[0, 0]]): block.domain for block in reversed(self.mesh.blocks)}
        for body, domain in domains.items():
            if body in touched:
                continue
            held = modes[self.held[owner == body]]
            _, values, axes = (
                np.linalg.svd(held, full_matrices=True) if len(held) else (None, np.zeros(0), np.eye(len(names)))
            )
            rank = int(np.sum(values > 1e-9 * max(1.0, values.max(initial=0.0))))
            if rank < len(names):
                free = names[int(np.argmax(np.abs(axes[rank])))]
                which = "the body" if len(domains) == 1 else f"the body of '{domain}'"
                raise InputError(f"the supports do not hold {which}: it is free in {free}")


def _rigid_modes(mesh: Mesh) -> tuple[Array, tuple[str, ...]]:
    """Return the rigid motions (nodes * d, modes), about the centre and of like size, and their names."""
    x = (mesh.points - mesh.points.mean(axis=0)) / mesh.size
    zero, one = np.zeros(len(x)), np.ones(len(x))
    if mesh.space == "axisymmetric":
        return np.column_stack([zero, one]).reshape(-1, 1), ("translation y (along the axis)",)
    if mesh.dimension == 2:
        columns = [(one, zero), (zero, one), (-x[:, 1], x[:, 0])]
        return np.stack([np.column_stack(c).ravel() for c in columns], axis=1), (
            "translation x", "translation y", "rotation about z",
        )  # fmt: skip
    columns3 = [(one, zero, zero), (zero, one, zero), (zero, zero, one)]
    columns3 += [(zero, -x[:, 2], x[:, 1]), (x[:, 2], zero, -x[:, 0]), (-x[:, 1], x[:, 0], zero)]
    names = tuple(f"{kind} {axis}" for kind in ("translation", "rotation about") for axis in "xyz")
    return np.stack([np.column_stack(c).ravel() for c in columns3], axis=1), names
