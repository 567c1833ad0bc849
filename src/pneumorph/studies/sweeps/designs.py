"""One design of a sweep: its values, and the study that they make, or the reason why they make none."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

from pneumorph.errors import InputError, NameNotFoundError, StorageError, StudyError, UnitError
from pneumorph.mesh import Imported
from pneumorph.studies.study import Study, study_from
from pneumorph.studies.sweeps.parameters import Parameter
from pneumorph.studies.sweeps.paths import replaced

# a slip in the sweep or study file, which would be wrong in every design; other refusals are one design's own
_SLIPS = (StudyError, UnitError, NameNotFoundError)


@dataclass(frozen=True)
class Design:
    """number: from 1 on; values: in the order of the parameters, as in a study file; study: None where the values do
    not fit together, and then reason says why.
    """  # fmt: skip

    number: int
    values: tuple[Any, ...]
    study: Study | None
    reason: str = ""

    @cached_property
    def identity(self) -> str:
        """Checksum (SHA-256) of the resolved study and of the files that it names; empty without a study.

        Equal designs of any two sweeps have the same one. Raises StorageError for a file that cannot be read.
        """
        if self.study is None:
            return ""
        total = hashlib.sha256(self.study.resolved_text().encode())
        for body in self.study.assembly.bodies.values():
            for path in body.paths if isinstance(body, Imported) else ():
                try:
                    total.update(Path(path).read_bytes())
                except OSError as error:
                    raise StorageError(f"{path} cannot be read: {error}") from error
        return total.hexdigest()


def designs_of(
    table: Mapping[str, Any],
    name: str,
    folder: Path,
    parameters: Sequence[Parameter],
    values: Sequence[tuple[Any, ...]],
) -> tuple[Design, ...]:
    """Return the designs of a sweep; no mesh is made.

    table, name, folder: contents of the study file, its name and where it lies.
    Raises StudyError, UnitError, NameNotFoundError for keys, units and names that the study does not have, and
    InputError where every single design is refused.
    """
    designs = []
    for number, line in enumerate(values, 1):
        data = dict(table)
        for parameter, value in zip(parameters, line, strict=True):
            data = replaced(data, parameter.path, value)
        try:
            designs.append(Design(number, line, study_from(data, name, folder)))
        except _SLIPS as error:
            said = ", ".join(f"{p.path} = {v!r}" for p, v in zip(parameters, line, strict=True))
            raise type(error)(f"design {number} ({said}): {error}") from None
        except InputError as error:
            designs.append(Design(number, line, None, str(error)))
    if all(design.study is None for design in designs):
        raise InputError(f"every one of the {len(designs)} designs is refused; the first: {designs[0].reason}")
    return tuple(designs)
