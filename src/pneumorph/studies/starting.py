"""Studies to start from: for each template a small one that runs at once."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Any

from pneumorph.errors import NameNotFoundError, StorageError, unknown_name
from pneumorph.geometry import Finger, export
from pneumorph.studies.commented import commented_study
from pneumorph.studies.describing import summary
from pneumorph.studies.importing import ImportedSection
from pneumorph.studies.json_schema import SCHEMA_FILE, write_schema
from pneumorph.studies.schema import TEMPLATES
from pneumorph.studies.study import Study, study_from

# what a template needs besides its own defaults, which give dimensions, supports and the published material
_SILICONE = {"name": "shore-a45-platinum"}
_CHOICES: Mapping[str, Mapping[str, Any]] = MappingProxyType(
    {
        "crawler-2d": {
            "support": [{"type": "clamp", "face": "front_foot"}],  # on its own it would be free to move
            "targets": {"PN1": "5 kPa"},
        },
        "finger": {"targets": {"cavity": "40 kPa"}},
        "forearm": {
            "support": [{"type": "clamp", "face": "wrist"}, {"type": "clamp", "face": "elbow"}],
            "load": [{"type": "traction", "face": "skin", "direction": "-z", "name": "press"}],
            "targets": {"press": "10 kPa"},
        },
        "gripper": {"actuator": {"half": True}, "targets": {"cavity_1": "20 kPa"}},
        "hexagonal-prism": {"targets": {"cavity_1": "40 kPa", "cavity_2": "40 kPa"}},
        "pipe-robot": {
            "actuator": {"quarter": True, "chambers": 1, "length": "12 mm"},
            "targets": {"rear_1": "60 kPa", "rear_2": "60 kPa", "middle": "4 kPa"},
        },
        "pneunet": {"targets": {"cavity": "4 kPa"}},
        "quadruped": {
            "actuator": {"half": True},
            "support": [{"type": "clamp", "face": "belly_front"}, {"type": "symmetry", "face": "symmetry_y"}],
            "targets": {"PN1": "5 kPa"},
        },
        "skinned-tube": {"actuator": {"half": True}, "targets": {"cavity": "10 kPa"}},
        "soft-limb": {"actuator": {"half": True}, "targets": {"cavity": "10 kPa"}},
        # a whole sphere has no face to hold it by
        "thick-sphere": {"actuator": {"octant": True}, "material": _SILICONE, "targets": {"cavity": "40 kPa"}},
        "thick-tube": {"actuator": {"quarter": True}, "material": _SILICONE, "targets": {"cavity": "40 kPa"}},
    }
)


# a study of a CAD file comes with a file, so that it too runs at once
IMPORT = "import"
_SAMPLE = Finger(length=40.0, chambers=3)
_IMPORT: Mapping[str, Any] = MappingProxyType(
    {
        "title": "Body from a file",
        "measures": ["tip_rotation", "chord_angle"],
        "actuator": {
            "faces": {"clamp": {"normal": "-x", "axis": "x", "at": "0 mm"}, "tip": {"axis": "x", "at": "40 mm"}}
        },
        "material": {"body": _SILICONE},
        "mesh": {"size": "coarse"},
        "phase": [{"name": "inflate", "targets": {"cavity": "20 kPa"}}],
    }
)


def starters() -> dict[str, str]:
    """Return name -> one line on each template that there is a study to start from, and on `import`."""
    known = {name: summary(TEMPLATES[name]) for name in sorted(_CHOICES)}
    return known | {IMPORT: f"{summary(ImportedSection)}: a STEP file is written too, replace it with your own"}


def starter(template: str) -> Study:
    """Return the study to start from. Raises NameNotFoundError for an unknown template, with the nearest name."""
    if template not in _CHOICES:
        raise NameNotFoundError(unknown_name("template", template, _CHOICES))
    choice = _CHOICES[template]
    table = {
        "title": template.replace("-", " ").capitalize(),
        "actuator": {"template": template, **choice.get("actuator", {})},
        "mesh": {"size": "coarse"},
        "phase": [{"name": "inflate", "targets": dict(choice["targets"])}],
    }
    table |= {key: choice[key] for key in ("material", "support", "load") if key in choice}
    return study_from(table, template)


def starter_text(template: str) -> str:
    """Return the text of the commented study file of a template. Raises NameNotFoundError for an unknown one."""
    study = starter(template)
    actuator = study.actuator
    parts = {"faces": actuator.face_names, "cavities": actuator.cavities, "material domains": actuator.domains}
    names = "; ".join(f"{what}: {', '.join(names)}" for what, names in parts.items() if names)
    free = next(name for name in ("tip", "outer", "skin", "tip_1") if name in actuator.face_names)
    return commented_study(
        study.resolved(),
        (f"{starters()[template]}.", f"{names[0].upper()}{names[1:]}."),
        {
            "face": free,
            "cavity": (*actuator.cavities, *study.programme.phases[-1].targets)[0],
            "direction": "-z" if actuator.space == "3d" else "-y",
        },
    )


def import_text(file: str) -> str:
    """Return the text of the commented study file of a body from a CAD or mesh file."""
    actuator = {"file": file, **_IMPORT["actuator"]}
    head = f"{summary(ImportedSection)}. Faces: those that are named below, and outer, the rest of the outside."
    return commented_study({**_IMPORT, "actuator": actuator}, (head,), {"face": "tip"})


def write_starter(template: str, path: Path, *, schema: bool = False) -> Path:
    """Write the commented study file of a template and return its path; `schema` puts the JSON schema beside it.

    `import` also writes a STEP file of the same name, for a start. Raises NameNotFoundError for an unknown template,
    StorageError for a file that exists or cannot be written.
    """
    if template not in starters():
        raise NameNotFoundError(unknown_name("template", template, starters()))
    sample = path.with_suffix(".step")
    text = import_text(sample.name) if template == IMPORT else starter_text(template)
    if schema:
        text = f"#:schema ./{SCHEMA_FILE}\n{text}"
    if template == IMPORT and sample.exists():
        raise StorageError(f"'{sample}' exists already: choose another file, or remove it first")
    try:
        with path.open("x", encoding="utf-8") as file:
            file.write(text)
    except FileExistsError as error:
        raise StorageError(f"'{path}' exists already: choose another file, or remove it first") from error
    except OSError as error:
        raise StorageError(f"'{path}': cannot write ({error.strerror or error})") from error
    if template == IMPORT:
        export(_SAMPLE, sample)
    if schema:
        write_schema(path.with_name(SCHEMA_FILE))
    return path
