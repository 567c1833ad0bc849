"""Runs with gas in cavities: history, storage and resuming."""

import numpy as np
import pytest

from pneumorph.materials import NeoHookean
from pneumorph.mechanics import (
    Atmosphere,
    Cavity,
    FlowSupply,
    Model,
    Phase,
    Programme,
    SealedSupply,
    Symmetry,
    Tube,
    VolumeSupply,
)  # fmt: skip
from pneumorph.mesh.mesh import CellBlock, FaceBlock, Mesh
from pneumorph.mesh.structured import rectangle
from pneumorph.solution import Solution, read_csv, solve

PROGRAMME = Programme((
    Phase("blow", {"a": 0.05}, first=0.2, largest=0.4, duration=0.5),
    Phase("hold", {"a": 0.05}, (0.5,), first=0.2, largest=1.0, duration=3.0),
))  # fmt: skip


def two_bowls():
    """Two hollow spheres, one blown through a valve, one sealed but for a tube to the first, in thin air."""

    def bent(x):
        radius, angle = 10.0 + 4.0 * x[:, 0], 0.5 * np.pi * x[:, 1]
        return radius[:, None] * np.column_stack([np.cos(angle), np.sin(angle)])

    one = rectangle(2, 4, bent, space="axisymmetric")
    (block,), count = one.blocks, len(one.points)
    blocks = (CellBlock(block.kind, "body", np.vstack([block.nodes, block.nodes + count])),)
    faces = {
        f"{name}_{side}": tuple(FaceBlock(part.kind, part.nodes + shift) for part in parts)
        for side, shift in (("a", 0), ("b", count))
        for name, parts in one.faces.items()
    }
    mesh = Mesh(np.vstack([one.points, one.points + np.array([0.0, 40.0])]), blocks, faces, one.space)
    supplies = {"a": FlowSupply(conductance=2e7, exponent=1.2), "b": SealedSupply(dead_volume=500.0)}
    cavities = tuple(
        Cavity(side, (f"left_{side}",), supply, mirrors=(f"bottom_{side}",)) for side, supply in supplies.items()
    )
    supports = tuple(Symmetry(f"{face}_{side}") for face in ("bottom", "top") for side in "ab")
    return Model(
        mesh, {"body": NeoHookean(0.3)}, supports, (), cavities,
        tubes=(Tube(between=("a", "b"), conductance=3e6),), atmosphere=Atmosphere(pressure=0.08),
    )  # fmt: skip


class KilledError(Exception):
    pass


def test_a_resumed_run_with_flow_equals_the_uninterrupted_one(tmp_path):
    whole = solve(two_bowls(), PROGRAMME, folder=tmp_path / "whole")

    def kill(progress):
        if progress.state.index == 6:
            raise KilledError

    with pytest.raises(KilledError):
        solve(two_bowls(), PROGRAMME, folder=tmp_path / "killed", progress=kill)
    resumed = solve(two_bowls(), PROGRAMME, folder=tmp_path / "killed", resume=True)
    assert len(resumed.states) == len(whole.states) > 10
    for one, other in zip(whole.states, resumed.states, strict=True):
        assert one.gas == other.gas
        assert dict(one.pressure) == dict(other.pressure)
        assert np.array_equal(one.displacement, other.displacement)
    assert whole.states[-1].gas.seconds > 0.0
    opened = Solution.open(tmp_path / "whole").model
    assert opened.tubes == two_bowls().tubes
    assert opened.atmosphere == Atmosphere(pressure=0.08)
    assert opened.cavities == two_bowls().cavities


def test_the_history_holds_mass_temperature_and_source_of_the_gas(tmp_path):
    solution = solve(two_bowls(), PROGRAMME, folder=tmp_path)
    table = read_csv(tmp_path / "history.csv")
    volume = table["volume:a [mL]"][0]
    # 80 kPa of air at 20 degrees Celsius weigh 0.9507 mg a millilitre: 80e3 / (287.05 * 293.15)
    assert table["gas_mass:a [mg]"][0] == pytest.approx(0.9507 * volume, rel=1e-4)
    assert table["gas_mass:b [mg]"][0] == pytest.approx(0.9507 * (table["volume:b [mL]"][0] + 0.5), rel=1e-4)
    assert table["source:a [kPa]"][-1] == pytest.approx(50.0)
    assert table["temperature:a [K]"].max() > 294.0
    assert table["temperature:b [K]"] == pytest.approx(293.15, rel=1e-7)
    assert "source:b [kPa]" not in table
    assert solution.history.values("pressure:b")[-1] > 0.02


def test_a_liquid_has_no_columns_of_gas():
    model = two_bowls()
    cavities = tuple(Cavity(c.name, c.faces, VolumeSupply(), c.mirrors) for c in model.cavities)
    model = Model(model.mesh, model.materials, model.supports, (), cavities)
    keys = solve(model, Programme((Phase("fill", {"a": 10.0}, first=1.0, largest=1.0),))).history.keys
    assert not [key for key in keys if key.startswith(("gas", "temperature", "source"))]
