"""A material as the section of a study file that gives it back."""

from __future__ import annotations

from dataclasses import fields

from pneumorph.errors import InputError
from pneumorph.materials import LAWS, Material
from pneumorph.materials.laws import law_name
from pneumorph.studies.section import section_of
from pneumorph.studies.writing import to_toml


def material_fragment(material: Material, domain: str | None = None) -> str:
    """Return TOML text to paste into a study file: [material], or [material.<domain>] for one of several domains.

    What the material leaves to its default is left out. Raises InputError for a class that study files do not name.

    >>> from pneumorph.materials import Yeoh
    >>> print(material_fragment(Yeoh(0.11, 0.02)).strip())
    [material]
    law = "yeoh"
    c10 = "0.11 MPa"
    c20 = "0.02 MPa"
    """
    name = law_name(material)
    if name is None:
        raise InputError(f"material = {material!r}, allowed: one of the laws {', '.join(sorted(LAWS))}")
    given = {
        item.name: getattr(material, item.name)
        for item in fields(material)
        if getattr(material, item.name) != item.default
    }
    kind = section_of(type(material), law=name)
    table = kind.model_validate({"law": name, **given}).model_dump(exclude_unset=True)
    ordered = {"law": name} | {key: table[key] for key in kind.model_fields if key in table}
    return to_toml({"material": ordered if domain is None else {domain: ordered}})
