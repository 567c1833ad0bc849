"""What a report says about the filling of cavities."""

from dataclasses import dataclass

from pneumorph.mechanics import Cavity, FlowSupply, Model, Phase, Programme, SealedSupply, Traction, Tube
from pneumorph.report.asked import asked_tables


@dataclass
class Run:
    model: Model
    programme: Programme
    about: dict


def test_supplies_and_tubes_stand_there_with_their_numbers(balloon):
    model = balloon.model
    flow = FlowSupply(conductance=1e6, dead_volume=500.0)
    cavity = Cavity("cavity", ("left",), flow, mirrors=("bottom",))
    blown = Model(model.mesh, model.materials, model.supports, cavities=(cavity,))
    object.__setattr__(blown, "tubes", (Tube(between=("cavity", "other"), conductance=1e5, critical_ratio=0.2),))
    programme = Programme((Phase("blow", {"cavity": 0.02}, duration=1.0),))
    tables = {table.title: table.rows for table in asked_tables(Run(blown, programme, {}))}
    expected = "flow, exponent 1, dead volume 0.5 mL, conductance 6 L/(min·bar), critical ratio 0.3"
    assert tables["Cavities"][0][1] == expected
    assert tables["Tubes"] == (("cavity and other", "tube, conductance 0.6 L/(min·bar), critical ratio 0.2"),)


def test_a_plug_is_called_sealed(balloon):
    model = balloon.model
    cavity = Cavity("cavity", ("left",), SealedSupply(), mirrors=("bottom",))
    load = Traction("right", (0, 1), "pull")
    sealed = Model(model.mesh, model.materials, model.supports, (load,), (cavity,))
    programme = Programme((Phase("pull", {"pull": 0.01}),))
    tables = {table.title: table.rows for table in asked_tables(Run(sealed, programme, {}))}
    assert tables["Cavities"][0][1] == "sealed, exponent 1, dead volume 0 mL"
    assert "Tubes" not in tables
