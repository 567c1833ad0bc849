"""Draw the templates with their symbols and write the tables of docs/geometry.md: python docs/drawings/geometry.py."""

from collections.abc import Sequence
from math import cos, pi, sin
from pathlib import Path

import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt
from matplotlib.axes import Axes
from matplotlib.patches import Circle, Polygon, Rectangle, Wedge

from pneumorph.geometry import Actuator, Finger, Forearm, HexagonalPrism, PneuNet, SoftLimb, ThickSphere, ThickTube
from pneumorph.geometry.occ import regular_polygon

DOCS = Path(__file__).parents[1]
SILICONE, LAYER, AIR, LINE = "#f3c9a5", "#8fa9c4", "#ffffff", "#40352c"
matplotlib.rcParams.update({"svg.fonttype": "none", "svg.hashsalt": "pneumorph", "font.size": 9})


def patch(axes: Axes, corners: Sequence[tuple[float, float]], colour: str = SILICONE) -> None:
    """Draw a filled polygon."""
    axes.add_patch(Polygon(corners, facecolor=colour, edgecolor=LINE, linewidth=0.8))


def block(axes: Axes, x0: float, x1: float, y0: float, y1: float, colour: str = SILICONE, edge: str = LINE) -> None:
    """Draw a filled rectangle."""
    axes.add_patch(Rectangle((x0, y0), x1 - x0, y1 - y0, facecolor=colour, edgecolor=edge, linewidth=0.8))


def measure(axes: Axes, start: tuple[float, float], end: tuple[float, float], text: str, away: float = 0.0) -> None:
    """Draw a dimension arrow; the text stands `away` (mm) to the left of the arrow's direction."""
    style = {"arrowstyle": "<->", "linewidth": 0.7, "shrinkA": 0, "shrinkB": 0, "mutation_scale": 6}
    axes.annotate("", end, start, arrowprops=style, annotation_clip=False)
    axes.update_datalim([start, end])
    dx, dy = end[0] - start[0], end[1] - start[1]
    size = (dx * dx + dy * dy) ** 0.5
    x = (start[0] + end[0]) / 2 - away * dy / size
    y = (start[1] + end[1]) / 2 + away * dx / size
    axes.text(
        x, y, text, ha="center", va="center", fontsize=8, bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.6}
    )


def finish(figure: plt.Figure, name: str) -> None:
    """Frame the axes and write the figure."""
    for axes in figure.axes:
        axes.set_aspect("equal")
        axes.autoscale_view()
        axes.margins(0.06)
        axes.axis("off")
    figure.savefig(DOCS / "figures" / f"geometry-{name}.svg", bbox_inches="tight", metadata={"Date": None})
    plt.close(figure)


def hexagonal_prism(one: HexagonalPrism) -> None:
    """Draw the sections of the hexagonal prism."""
    figure, (cross, along) = plt.subplots(1, 2, figsize=(10, 4.6), width_ratios=[1.25, 1])
    a, wa, ha, ap = one.side, one.block_width, one.block_height, one.apothem
    patch(cross, regular_polygon(6, a, pi / 6))
    for i in range(6):
        angle = i * pi / 3

        def turned(x0: float, x1: float, half: float, angle: float = angle) -> list[tuple[float, float]]:
            corners = [(x0, -half), (x1, -half), (x1, half), (x0, half)]
            return [(x * cos(angle) - y * sin(angle), x * sin(angle) + y * cos(angle)) for x, y in corners]

        patch(cross, turned(ap, ap + ha, wa / 2))
        patch(cross, turned(ap, ap + one.chamber_height, one.chamber_width / 2), AIR)
        middle = ap + one.chamber_height / 2
        cross.text(middle * cos(angle), middle * sin(angle), f"cavity_{i + 1}", ha="center", va="center", fontsize=7)
    cross.add_patch(Circle((0, 0), one.core_radius, facecolor=AIR, edgecolor=LINE, linewidth=0.8))
    measure(cross, (0, 0), (one.core_radius * cos(2.1), one.core_radius * sin(2.1)), "r")
    top = ap + ha
    measure(cross, (top + 3, -wa / 2), (top + 3, -one.chamber_width / 2), "w1", -3)
    measure(cross, (top + 3, -one.chamber_width / 2), (top + 3, one.chamber_width / 2), "w2", -3)
    measure(cross, (ap, wa / 2 + 2.5), (ap + one.chamber_height, wa / 2 + 2.5), "h2", 0)
    measure(cross, (ap + one.chamber_height, wa / 2 + 2.5), (top, wa / 2 + 2.5), "h1", 3)
    corner = regular_polygon(6, a, pi / 6)
    measure(cross, (corner[3][0] * 0.93, corner[3][1] * 0.93), (corner[2][0] * 0.93, corner[2][1] * 0.93), "a")
    cross.set_title("section through the chambers, seen from the tip", fontsize=9)

    block(along, one.core_radius, ap, 0, 3 * one.block_length + 2 * one.gap + 2)
    low = 2.0
    for i in range(3):
        z = low + i * (one.block_length + one.gap)
        wall = one.expansion_wall
        block(along, ap, ap + ha, z, z + one.block_length)
        if i:
            block(along, ap, ap + one.airway_height + one.airway_roof, z - one.gap, z)
            block(along, ap, ap + one.airway_height, z - one.gap - wall, z + wall, AIR, AIR)
        block(along, ap, ap + one.chamber_height, z + wall, z + one.block_length - wall, AIR, AIR)
    right = ap + ha + 2
    z = low + one.block_length + one.gap
    measure(along, (right, z), (right, z + one.expansion_wall), "l1", -2.5)
    measure(along, (right, z + one.expansion_wall), (right, z + one.block_length - one.expansion_wall), "l2", -2.5)
    measure(along, (right, z - one.gap), (right, z), "l3", -2.5)
    x, z = ap, z - one.gap / 2
    measure(along, (x, z), (x + one.airway_height, z), "h3", 3.2)
    measure(along, (x + one.airway_height, z), (x + one.airway_height + one.airway_roof, z), "h4", -2.5)
    along.plot([0, 0], [0, 32], color=LINE, linewidth=0.7, linestyle="-.")
    along.text(0, 33, "z", ha="center")
    along.text(ap - 1.7, 6, "column", rotation=90, ha="center", va="center", fontsize=7)
    along.text(7, 15, "core", ha="center", fontsize=7)
    along.text(ap + 11, -1.6, "clamp: z = 0", ha="center", va="top", fontsize=8)
    along.set_title("section along the axis: three of N chambers", fontsize=9)
    finish(figure, "hexagonal-prism")


def chamber_row(one: Finger | PneuNet, name: str, symbols: dict[str, str], side: str) -> None:
    """Draw the sections of a beam of chambers."""
    row = one._row()
    layer = getattr(one, "layer", 0.0)
    figure, (along, cross) = plt.subplots(1, 2, figsize=(10, 3), width_ratios=[row.length, 1.6 * row.width])
    bridge = row.floor + row.airway_height + row.airway_roof
    profile = [(0.0, 0.0), (row.length, 0.0), (row.length, row.height)]
    for i in reversed(range(1, row.chambers)):
        x = row.end + i * row.pitch - row.wall
        profile += [(x, row.height), (x, bridge), (x - row.gap, bridge), (x - row.gap, row.height)]
    patch(along, [*profile, (0.0, row.height)])
    for i in range(row.chambers):
        x = row.end + i * row.pitch
        if i:
            block(along, x - 2 * row.wall - row.gap, x, row.floor, row.floor + row.airway_height, AIR, AIR)
        block(along, x, x + row.chamber_length, row.floor, row.floor + row.chamber_height, AIR, AIR)
    if layer:
        block(along, 0, row.length, -layer, 0, LAYER)
    x, top = row.end + row.pitch, row.height + 1.5
    bottom = -layer - 2.5
    measure(along, (x - row.wall - row.gap, top), (x - row.wall, top), symbols["gap"], 1.8)
    measure(along, (x - row.wall, top), (x, top), symbols["wall"], 1.8)
    if "chamber_length" in symbols:
        measure(along, (x, top), (x + row.chamber_length, top), symbols["chamber_length"], 1.8)
        measure(along, (0, top), (row.end, top), symbols["end"], 2)
    measure(along, (0, bottom), (row.length, bottom), symbols["length"])
    x = row.end + row.pitch + row.chamber_length / 2
    measure(along, (x, 0), (x, row.floor), symbols["floor"], -1.8)
    measure(along, (x, row.floor + row.chamber_height), (x, row.height), symbols["top"], -1.8)
    x = row.end + 2 * row.pitch - row.wall - row.gap / 2
    measure(along, (x, row.floor), (x, row.floor + row.airway_height), symbols["airway_height"], -2.2)
    measure(along, (x, row.floor + row.airway_height), (x, bridge), symbols["roof"], 2.2)
    if layer:
        measure(along, (row.length + 1.5, -layer), (row.length + 1.5, 0), "s", -1.8)
    along.text(-1, row.height / 2, "clamp", rotation=90, ha="right", va="center", fontsize=8)
    along.text(row.length + (3.5 if layer else 1), row.height / 2, "tip", rotation=90, va="center", fontsize=8)
    along.set_title("section y = 0", fontsize=9, pad=12)

    half, air = row.width / 2, row.chamber_width / 2
    block(cross, -half, half, 0, row.height)
    block(cross, -air, air, row.floor, row.floor + row.chamber_height, AIR)
    across = row.airway_width / 2
    cross.add_patch(
        Rectangle((-across, row.floor), 2 * across, row.airway_height, facecolor="none", edgecolor=LINE, linestyle=":")
    )
    if layer:
        block(cross, -half, half, -layer, 0, LAYER)
    measure(
        cross,
        (-across, row.floor + row.airway_height + 1.2),
        (across, row.floor + row.airway_height + 1.2),
        symbols["airway_width"],
        1.6,
    )
    measure(cross, (air, row.height * 0.6), (half, row.height * 0.6), symbols["side"], 2)
    if side == "outer":
        measure(cross, (-half, -2.5), (half, -2.5), "B")
        measure(cross, (half + 2, 0), (half + 2, row.height), "H")
    else:
        measure(cross, (-air, row.height * 0.75), (air, row.height * 0.75), "w2")
        measure(cross, (half + 2, row.floor), (half + 2, row.floor + row.chamber_height), "h2")
    cross.set_title("section through a chamber", fontsize=9)
    finish(figure, name)


def round_bodies(tube: ThickTube, ball: ThickSphere) -> None:
    """Draw the sections of tube and sphere."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(8, 3), width_ratios=[1.3, 1])
    a, b, length, cap = tube.inner_radius, tube.outer_radius, tube.length, tube.cap
    block(left, 0, length, -b, b)
    block(left, cap, length - cap, -a, a, AIR)
    left.plot([-3, length + 3], [0, 0], color=LINE, linewidth=0.7, linestyle="-.")
    left.text(length + 4, 0, "z", va="center")
    measure(left, (length * 0.4, 0), (length * 0.4, a), "A")
    measure(left, (length * 0.6, 0), (length * 0.6, b), "B")
    measure(left, (0, -b - 3), (length, -b - 3), "L")
    measure(left, (0, -b * 0.4), (cap, -b * 0.4), "c")
    left.text(-1, b * 0.5, "clamp", rotation=90, ha="right", va="center", fontsize=8)
    left.text(length + 1, b * 0.5, "tip", rotation=90, va="center", fontsize=8)
    left.set_title("ThickTube", fontsize=9)
    right.add_patch(Wedge((0, 0), ball.outer_radius, 0, 360, facecolor=SILICONE, edgecolor=LINE, linewidth=0.8))
    right.add_patch(Circle((0, 0), ball.inner_radius, facecolor=AIR, edgecolor=LINE, linewidth=0.8))
    measure(right, (0, 0), (ball.inner_radius * cos(0.4), ball.inner_radius * sin(0.4)), "A")
    measure(right, (0, 0), (ball.outer_radius * cos(2.2), ball.outer_radius * sin(2.2)), "B")
    right.set_title("ThickSphere", fontsize=9)
    finish(figure, "round")


def soft_limb(one: SoftLimb) -> None:
    """Draw the middle plane of the soft limb, and a section through a chamber."""
    figure, (along, cross) = plt.subplots(1, 2, figsize=(10, 5), width_ratios=[1.5, 1])

    def arc(level: float, start: float, stop: float) -> list[tuple[float, float]]:
        return [one.place(start + (stop - start) * n / 60, 0.0, level) for n in range(61)]

    def sector(low: float, high: float, start: float, stop: float, colour: str) -> None:
        patch(along, arc(low, start, stop) + arc(high, stop, start), colour)

    bridge, turn = one.base + one.airway_height + one.airway_roof, one.turn
    for pleat in one.pleats:
        patch(along, pleat)
    sector(one.base, bridge, 0.0, turn, SILICONE)
    sector(one.base, one.height, 0.0, one.root / one.radius, SILICONE)
    sector(one.base, one.height, turn - one.end / one.radius, turn, SILICONE)
    for air in one.air:
        patch(along, air, AIR)
    sector(one.base, one.base + one.airway_height, one.cuts[0] - one.pitch / 2, one.cuts[-1] + one.pitch / 2, AIR)
    sector(0.0, one.base, 0.0, turn, LAYER)
    sector(-one.foot_height, 0.0, turn - one.foot_length / one.radius, turn, LAYER)
    measure(along, (-one.hub_radius, 0.0), (0.0, 0.0), "rh", 2.5)
    along.plot(-one.hub_radius, 0.0, "+", color=LINE)
    along.text(-one.hub_radius, 3.0, "axle", ha="center", fontsize=8)
    measure(along, (0.0, -one.radius), one.place(0.55 * turn, 0.0, 0.0), "R", 3.0)
    middle = 0.5 * (one.cuts[1] + one.cuts[2])
    top, foot = one.base + one.chamber_height, one.base
    for level, width, text in ((foot, one.chamber_foot, "x1"), (top, one.chamber_top, "x2")):
        measure(along, one.place(middle, -width / 2, level), one.place(middle, width / 2, level), text)
    along.text(-1.0, -one.height / 2, "clamp", rotation=90, ha="right", va="center", fontsize=8)
    along.text(*one.place(turn + 0.08, 0.0, one.height / 2), "tip", ha="center", va="center", fontsize=8)
    along.text(*one.place(turn - 0.1, 0.0, -3.0 * one.foot_height), "foot", ha="center", va="center", fontsize=8)
    along.set_title("middle plane", fontsize=9)
    half, air_half = one.depth / 2, one.chamber_depth / 2
    block(cross, -half, half, one.base, one.height)
    block(cross, -air_half, air_half, one.base, top, AIR)
    block(cross, -half, half, 0.0, one.base, LAYER)
    across, high = one.airway_width / 2, one.base + one.airway_height
    cross.plot([-across, -across, across, across], [one.base, high, high, one.base], color=LINE, linestyle=":", lw=0.8)
    measure(cross, (-across, high + 1.0), (across, high + 1.0), "wa", 1.5)
    measure(cross, (-half, -2.5), (half, -2.5), "d")
    measure(cross, (air_half, top / 2), (half, top / 2), "w", 1.5)
    measure(cross, (half + 2.5, 0.0), (half + 2.5, one.base), "b")
    measure(cross, (half + 2.5, one.base), (half + 2.5, top), "h")
    measure(cross, (half + 2.5, top), (half + 2.5, one.height), "ht")
    cross.set_title("section through a chamber", fontsize=9)
    finish(figure, "soft-limb")


def table(one: Actuator) -> str:
    """Return the markdown table of an actuator's dimensions."""
    lines = ["| symbol | field | default | what | source |", "|---|---|---|---|---|"]
    for row in one.dimensions():
        unit = " mm" if row.kind == "length" else ""
        source = "given" if row.given else "assumed"
        lines.append(f"| {row.symbol} | `{row.name}` | {row.value:g}{unit} | {row.help} | {source} |")
    return "\n".join(lines)


def write_tables(page: Path, templates: Sequence[Actuator]) -> None:
    """Replace what stands between the table markers of each template."""
    text = page.read_text()
    for one in templates:
        name = type(one).__name__
        start, end = f"<!-- table {name} -->\n", "<!-- end -->"
        head, rest = text.split(start)
        text = head + start + table(one) + "\n" + end + rest.split(end, 1)[1]
    page.write_text(text)


if __name__ == "__main__":
    hexagonal_prism(HexagonalPrism())
    finger_symbols = {"gap": "g", "wall": "t", "length": "L", "floor": "b", "top": "t", "airway_height": "hp"}
    finger_symbols |= {"roof": "tp", "airway_width": "wp", "side": "t"}
    chamber_row(Finger(), "finger", finger_symbols, "outer")
    beam_symbols = {
        "gap": "l3",
        "wall": "l1",
        "chamber_length": "l2",
        "end": "l4",
        "length": "whole length = 2 l4 + n l2 + (n - 1) (2 l1 + l3)",
        "floor": "b",
    }
    beam_symbols |= {"top": "h1", "airway_height": "h3", "roof": "h4", "airway_width": "w3", "side": "w1"}
    chamber_row(PneuNet(), "pneunet", beam_symbols, "inner")
    round_bodies(ThickTube(), ThickSphere())
    soft_limb(SoftLimb())
    tables = [HexagonalPrism(), Finger(), Forearm(), PneuNet(), SoftLimb(), ThickTube(), ThickSphere()]
    write_tables(DOCS / "geometry.md", tables)
