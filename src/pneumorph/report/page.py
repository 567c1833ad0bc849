"""One self-contained HTML page from plain data: every picture inside, no outside resource."""

from __future__ import annotations

import base64
from dataclasses import dataclass, field

from jinja2 import Environment, PackageLoader, StrictUndefined

from pneumorph.report.tables import Table

_TYPES = {"svg": "image/svg+xml", "webp": "image/webp", "png": "image/png", "mp4": "video/mp4"}


@dataclass(frozen=True)
class Item:
    """A picture or a film with its caption; source and poster are data URIs."""

    caption: str
    source: str
    film: bool = False
    poster: str = ""


@dataclass
class Page:
    """What the page shows; every text is escaped. status: 'done', 'stopped' or 'running'; mesh: None without one."""

    title: str
    version: str
    status: str
    headline: str
    message: str
    tiles: list[tuple[str, str]]
    results: Table
    mesh: Table | None
    checks: Table
    versions: Table
    all_states: Table | None = None
    cycles: Table | None = None
    source: str = ""
    command: str = ""
    notes: list[str] = field(default_factory=list)
    missing: list[str] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)
    asked: list[Table] = field(default_factory=list)
    comparison: Table | None = None
    stress: Table | None = None
    films: list[Item] = field(default_factory=list)
    curves: list[Item] = field(default_factory=list)
    shapes: list[Item] = field(default_factory=list)
    mesh_pictures: list[Item] = field(default_factory=list)
    check_figures: list[Item] = field(default_factory=list)
    shapes_head: tuple[str, str] = ("Shapes and stress", "Shapes, stress and stretch")  # in the navigation, above
    beside: str = "States, history and figures"

    @property
    def sections(self) -> list[tuple[str, str]]:
        """Anchors and names of the sections that there are."""
        result = [("results", "Results")]
        result += [("comparison", "Comparison")] if self.comparison else []
        result += [("shapes", self.shapes_head[0])] if self.shapes or self.stress else []
        result += [("asked", "What was asked"), *([("mesh", "Mesh")] if self.mesh else [])]
        return [*result, ("checks", "Checks"), ("repeat", "Repeat it")]

    def html(self) -> str:
        """Return the page."""
        environment = Environment(
            loader=PackageLoader("pneumorph.report", "."), autoescape=True, undefined=StrictUndefined, trim_blocks=False
        )
        return environment.get_template("template.html").render(**self.__dict__, sections=self.sections)


def data_uri(content: bytes, form: str) -> str:
    """Return the content of a file as a data URI; form: 'svg', 'webp', 'png' or 'mp4'."""
    return f"data:{_TYPES[form]};base64,{base64.b64encode(content).decode('ascii')}"
