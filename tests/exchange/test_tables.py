"""Nodes of a state and pressure-volume curves as CSV, meshes as VTU, programmes up to a time."""

import csv

import meshio
import numpy as np
import pytest

from pneumorph.errors import InputError, NameNotFoundError
from pneumorph.exchange import pressures_of, up_to, write_nodes, write_pressure_volume, write_vtu
from pneumorph.exchange.tables import slope
from pneumorph.exchange.written import Written
from pneumorph.materials import NeoHookean
from pneumorph.mechanics import Cavity, Model, Phase, Prescribed, Programme, Roller, VolumeSupply
from pneumorph.mesh import box, rectangle
from pneumorph.solution import solve

BULK = 200.0


@pytest.fixture(scope="module")
def pulled():
    """A block pulled to 1.5 times its length between smooth plates: uniform stress."""
    supports = (Roller("x0", "x"), Roller("y0", "y"), Roller("z0", "z"), Prescribed("x1", "x", "pull"))
    model = Model(box(1, 1, 1), {"body": NeoHookean(0.2, bulk=BULK)}, supports)
    return solve(model, Programme((Phase("pull", {"pull": 0.5}, first=0.5, largest=0.5),)))


@pytest.fixture(scope="module")
def filled():
    """A ring filled by volume, after a phase in which nothing happens."""
    mesh = rectangle(2, 1, lambda p: np.add(p, [3.0, 0.0]), space="axisymmetric")
    cavity = Cavity("ring", ("left",), VolumeSupply(), mirrors=("bottom", "top"))
    supports = (Roller("bottom", "y"), Roller("top", "y"), Prescribed("right", "y", "still"))
    model = Model(mesh, {"body": NeoHookean(0.1)}, supports, (), (cavity,))
    phases = (Phase("wait", {"still": 0.0}, first=0.5, largest=0.5), Phase("fill", {"ring": 5.0}, first=0.1))
    return solve(model, Programme(phases))


def read(path):
    with path.open(newline="") as file:
        header, *lines = list(csv.reader(file))
    return header, lines


def test_node_table_holds_places_displacements_and_the_uniform_stress(pulled, tmp_path):
    written = write_nodes(tmp_path / "nodes.csv", pulled.states[-1])
    header, lines = read(written.path)
    table = dict(zip(header, np.array(lines, dtype=float).T, strict=True))
    assert table["node"].tolist() == list(range(1, 28))
    assert written.counts == {"nodes": 27}
    assert table["ux [mm]"] == pytest.approx(0.5 * table["x [mm]"], abs=1e-9)
    # incompressible bar: mu (l^2 - 1 / l), exact to the order of stress over bulk modulus
    exact = 0.2 * (1.5**2 - 1.0 / 1.5)
    assert table["stress_xx [MPa]"] == pytest.approx(exact, rel=3.0 * exact / BULK)
    assert table["von_mises [MPa]"] == pytest.approx(exact, rel=3.0 * exact / BULK)
    assert table["stress_zx [MPa]"] == pytest.approx(0.0, abs=1e-9)
    assert table["largest_stretch"] == pytest.approx(1.5, rel=1e-9)


def test_pressure_volume_table_is_in_si_and_its_compliance_is_that_of_the_curve(filled, tmp_path):
    written = write_pressure_volume(tmp_path / "pv.csv", filled.history)
    header, lines = read(written.path)
    assert header == ["state", "pressure:ring [Pa]", "volume:ring [m3]", "compliance:ring [m3/Pa]"]
    assert written.counts == {"states": len(lines), "cavities": 1}
    pressure, volume = (np.array([line[i] for line in lines], dtype=float) for i in (1, 2))
    last = filled.states[-1]
    assert pressure[-1] == pytest.approx(1e6 * last.pressure["ring"])
    # the ring's hole: 3 mm radius, 1 mm high, and 5 mm3 more at the end
    assert volume[0] == pytest.approx(9.0 * np.pi * 1e-9, rel=1e-3)
    assert volume[-1] - volume[0] == pytest.approx(5e-9)
    # at rest the pressure stands still on one side or both
    assert lines[1][3] == ""
    assert float(lines[-1][3]) == pytest.approx((volume[-1] - volume[-2]) / (pressure[-1] - pressure[-2]))
    cut = write_pressure_volume(tmp_path / "pv.csv", filled.history, ("ring",))
    assert cut.counts == written.counts


def test_slope_is_exact_for_a_parabola_and_empty_where_the_pressure_turns_or_stands_still():
    x = np.array([0.0, 1.0, 3.0, 4.0])
    assert slope(x, x**2)[1:-1] == pytest.approx(2.0 * x[1:-1])
    assert np.isnan(slope(np.array([0.0, 1.0, 0.5]), np.array([0.0, 1.0, 2.0]))).tolist() == [False, True, False]
    assert np.isnan(slope(np.array([0.0, 0.0, 1.0]), np.array([0.0, 0.0, 2.0]))).tolist() == [True, False, False]
    assert np.isnan(slope(np.zeros(1), np.zeros(1))).all()


def test_pressure_volume_of_an_unknown_cavity_or_of_none_is_refused(filled, pulled, tmp_path):
    with pytest.raises(NameNotFoundError, match="unknown cavity 'rng': did you mean 'ring'"):
        write_pressure_volume(tmp_path / "pv.csv", filled.history, ("rng",))
    with pytest.raises(InputError, match="the run has no cavity"):
        write_pressure_volume(tmp_path / "pv.csv", pulled.history)


def test_pressures_of_a_run_go_from_rest_to_its_end(filled):
    table = pressures_of(filled.history, ("ring",))["ring"]
    assert table.time[0] == table.pressure[0] == 0.0
    assert table.time[-1] == 2.0
    assert table.pressure[-1] == filled.states[-1].pressure["ring"]


def test_vtu_file_reads_back_with_fields_and_domains(pulled, tmp_path):
    state = pulled.states[-1]
    written = write_vtu(tmp_path / "state.vtu", state.model, state)
    grid = meshio.read(written.path)
    assert grid.point_data["Displacement"] == pytest.approx(state.displacement)
    assert set(grid.point_data) == {"Displacement", "VonMises", "LargestPrincipalStress", "LargestStretch"}
    assert grid.cells_dict["tetra10"].tolist() == state.model.mesh.blocks[0].nodes.tolist()
    assert grid.cell_data["Domain"][0].tolist() == [0] * 6
    plain = meshio.read(write_vtu(tmp_path / "mesh.vtu", state.model).path)
    assert plain.point_data == {}


def test_a_programme_up_to_a_time_has_the_same_values_until_then():
    whole = Programme(
        (Phase("weight", {"g": 10.0}), Phase("fill", {"c": 8.0, "g": 0.0}, (0.25, 0.5, 0.75), first=0.4, largest=0.9))
    )
    cut = up_to(whole, 1.5)
    assert [phase.name for phase in cut.phases] == ["weight", "fill"]
    assert cut.phases[1].targets == {"c": 4.0, "g": 5.0}
    assert cut.phases[1].marks == (0.5,)
    assert cut.phases[1].first == 0.8
    assert cut.phases[1].largest == 1.0
    for time in (0.5, 1.0, 1.25, 1.5):
        stretched = time if time <= 1.0 else 1.0 + 2.0 * (time - 1.0)
        assert cut.values(stretched) == pytest.approx(whole.values(time))
    assert up_to(whole, 1.0).phases == whole.phases[:1]
    assert up_to(whole, 2.0).phases == whole.phases
    for time in (0.0, 2.5):
        with pytest.raises(InputError, match="expected more than 0, at most 2"):
            up_to(whole, time)


def test_size_of_a_file_is_said_in_its_own_unit(tmp_path):
    for size, text in ((7, "7 bytes"), (1500, "1.5 kB"), (2_000_000, "2 MB")):
        path = tmp_path / "file"
        path.write_bytes(b"x" * size)
        assert Written(path, {"nodes": 12_000}).text == f"{path}: 12,000 nodes; {text}"
