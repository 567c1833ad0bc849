"""Input files (.inp) of CalculiX and Abaqus: mesh, materials, supports, loads and the phases of a programme."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from pneumorph.errors import InputError, unknown_name
from pneumorph.exchange.inp_materials import is_hybrid, material_lines
from pneumorph.exchange.inp_mesh import ABAQUS, CALCULIX, DIALECTS, InpMesh
from pneumorph.exchange.inp_steps import InpSteps, PressureTable
from pneumorph.exchange.written import Written, put
from pneumorph.mechanics import Model, Programme
from pneumorph.solution.versions import versions


def write_inp(
    path: str | Path,
    model: Model,
    programme: Programme,
    *,
    dialect: str = CALCULIX,
    title: str = "",
    pressures: Mapping[str, PressureTable] | None = None,
    fields: bool = True,
    printed: Sequence[str] = (),
) -> Written:
    """Write a model and its programme for CalculiX or Abaqus, in mm, N, MPa, s, tonne.

    dialect:   'calculix', or 'abaqus' (hybrid elements where nearly incompressible).
    title:     heading of the file.
    pressures: cavity -> pressures over time, as `pressures_of` takes them from a run; needed by cavities that are not
               driven by a pressure.
    fields:    ask for displacement and stress in every node; printed: faces whose displacements go to the .dat file.

    Each domain becomes an element set, each face a node set and a surface, each phase a step. D1 = 2 / bulk modulus, in
    both programs. CalculiX's elements know displacements only: expect them stiffer than ours where the bulk modulus is
    large and the mesh coarse.

    Raises InputError for a law that the program does not have, a volume or gas supply without `pressures`, names that
    become one; MeshError for a kind of cell that the program does not have; StorageError where it cannot be written.
    """
    if dialect not in DIALECTS:
        raise InputError(unknown_name("dialect", dialect, DIALECTS))
    hybrid = frozenset(d for d, material in model.materials.items() if dialect == ABAQUS and is_hybrid(material))
    inp = InpMesh(model.mesh, hybrid)
    steps = InpSteps(inp, model, programme, dialect, dict(pressures or {}), fields, tuple(printed))
    lines = _header(title, dialect, inp)
    materials = []
    for domain, name in inp.domains.items():
        materials += material_lines(model.materials[domain], name, domain, dialect)
        materials += [f"*SOLID SECTION, ELSET={name}, MATERIAL={name}", *_thickness(model)]
    lines += [*inp.lines(), *materials, *steps.model_lines(), *steps.step_lines()]
    put(path, lambda part: part.write_text("\n".join(lines) + "\n", encoding="ascii", errors="replace"))
    counts = {"nodes": int(inp.used.sum()), "elements": model.mesh.cell_count, "steps": len(programme.phases)}
    return Written(Path(path), counts)


def _header(title: str, dialect: str, inp: InpMesh) -> list[str]:
    program = "CalculiX" if dialect == CALCULIX else "Abaqus"
    # a line break or a leading star would end the heading
    heading = " ".join(title.split()).lstrip("*").strip() or "model"
    lines = [
        f"** {heading}",
        f"** written by pneumorph {versions()['pneumorph']} for {program}",
        "** units: mm, N, MPa, s, tonne (density tonne/mm3, acceleration mm/s2); pressures are gauge",
        "** node numbers are those of the mesh plus one",
    ]
    if not inp.used.all():
        lines.append("** wedges and hexahedra are written without the nodes in the middle of their sides and cells")
    return [*lines, "*HEADING", heading]


def _thickness(model: Model) -> list[str]:
    return ["1."] if model.mesh.space == "plane_strain" else []
