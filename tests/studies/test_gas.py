"""Supplies, tubes and atmosphere in study files."""

import tomllib

import pytest

from pneumorph.errors import InputError, NameNotFoundError, StudyError, UnitError
from pneumorph.mechanics import Atmosphere, FlowSupply, GasSupply, PressureSupply, SealedSupply, Tube
from pneumorph.studies import study_from

SPHERE = """
[actuator]
template = "thick-sphere"
[material]
law = "neo-hookean"
mu = "0.1 MPa"
"""
PHASE = '[[phase]]\nduration = "2 s"\ntargets = { cavity = "20 kPa" }\n'
PRISM = '[actuator]\ntemplate = "hexagonal-prism"\n'
WAIT = '[[phase]]\nduration = "2 s"\ntargets = { cavity_1 = "20 kPa" }\n'


def study(text):
    return study_from(tomllib.loads(text), "test")


def cavity(supply, name="cavity"):
    return f'[[cavity]]\nname = "{name}"\nsupply = {supply}\n'


@pytest.mark.parametrize(
    ("text", "target", "supply"),
    [
        ('"pressure"', "-20 kPa", PressureSupply()),
        ('{ type = "pressure" }', "20 kPa", PressureSupply()),
        ('"gas"', "3 mg", GasSupply()),
        ('{ type = "gas", exponent = 1.4, dead_volume = "2 mL" }', "3 mg", GasSupply(exponent=1.4, dead_volume=2e3)),
        (
            '{ type = "flow", conductance = "6 L/(min bar)", critical_ratio = 0.4 }', "20 kPa",
            FlowSupply(conductance=1e6, critical_ratio=0.4),
        ),
    ],
)  # fmt: skip
def test_a_supply_is_given_by_name_or_with_its_numbers(text, target, supply):
    made = study(SPHERE + cavity(text) + PHASE.replace("20 kPa", target))
    assert made.cavities[0].supply == supply
    assert study_from(tomllib.loads(made.resolved_text()), "again").cavities == made.cavities


def test_a_supply_without_numbers_is_written_by_its_name():
    assert 'supply = "pressure"' in study(SPHERE + PHASE).resolved_text()
    assert (
        'supply = { type = "gas", exponent = 1.0, dead_volume = "0 mL" }'
        in study(SPHERE + cavity('"gas"') + PHASE.replace("20 kPa", "1 mg")).resolved_text()
    )


def test_tubes_and_atmosphere_come_into_the_model():
    tube = '[[tube]]\nbetween = ["cavity_1", "cavity_2"]\nconductance = "0.6 L/(min bar)"\n'
    air = '[atmosphere]\npressure = "80 kPa"\ntemperature = "10 degC"\n'
    supplies = cavity('{ type = "flow", conductance = "6 L/(min bar)" }', "cavity_1") + cavity('"sealed"', "cavity_2")
    made = study(PRISM + supplies + tube + air + WAIT)
    assert made.tubes == (Tube(between=("cavity_1", "cavity_2"), conductance=1e5),)
    assert made.atmosphere == Atmosphere(pressure=0.08, temperature=283.15)
    assert made.cavities[1].supply == SealedSupply()
    again = study_from(tomllib.loads(made.resolved_text()), "again")
    assert (again.tubes, again.atmosphere) == (made.tubes, made.atmosphere)


def test_a_model_with_gas_is_built_from_its_file():
    octant = SPHERE.replace("[material]", "octant = true\n[material]") + '[mesh]\nsize = "coarse"\n'
    made = study(octant + cavity('"gas"') + PHASE.replace("20 kPa", "1 mg"))
    problem = made.build()
    assert problem.model.kinds == {"cavity": "mass"}
    assert problem.model.atmosphere == Atmosphere()


@pytest.mark.parametrize(
    ("text", "kind", "message"),
    [
        (cavity('"gass"') + PHASE, StudyError, r"cavity\[1\]\.supply: unknown type 'gass': did you mean 'gas'"),
        (cavity('"flow"') + PHASE, StudyError, r"cavity\[1\]\.supply\.conductance: missing"),
        (cavity("3") + PHASE, StudyError, r"cavity\[1\]\.supply = 3"),
        (cavity('{ exponent = 1.4 }') + PHASE, StudyError, r"cavity\[1\]\.supply: missing '?type'?"),
        (cavity('{ type = "gas", expnent = 1.4 }') + PHASE, StudyError, r"cavity\[1\]\.supply: unknown key 'expnent'"),
        (cavity('{ type = "gas", exponent = 0.5 }') + PHASE, InputError, r"cavity 'cavity': supply: exponent = 0.5, a"),
        (
            cavity('{ type = "flow", conductance = "0 L/(min bar)" }') + PHASE, InputError,
            r"cavity 'cavity': supply: conductance = 0 L/\(min·bar\), allowed: more than 0",
        ),
        (
            cavity('{ type = "flow", conductance = "6 L/min" }') + PHASE, UnitError,
            r"cavity\[1\]\.supply: conductance = '6 L/min': expected conductance with its unit",
        ),
        (
            cavity('{ type = "flow", conductance = "6 L/(min bar)", critical_ratio = 1.0 }') + PHASE, InputError,
            "critical_ratio = 1, allowed: above 0 and below 0.999",
        ),
        (cavity('"gas"') + PHASE, UnitError, r"targets\.cavity = '20 kPa': expected mass with its unit"),
        (cavity('"sealed"') + PHASE, InputError, "target cavity: the cavity is sealed and cannot be driven"),
        (PHASE.replace("20 kPa", "-102 kPa"), InputError, r"target cavity = -102 kPa, allowed: -101\.325 kPa \(vacuum"),
        (
            cavity('{ type = "flow", conductance = "6 L/(min bar)" }') + '[[phase]]\ntargets = { cavity = "20 kPa" }\n',
            InputError, "phase 'phase_1': duration missing; the flow of gas into cavity 'cavity' takes time",
        ),
        (
            PHASE + '[[tube]]\nbetween = ["cavity", "cavity"]\nconductance = "6 L/(min bar)"\n', InputError,
            r"tube\[1\]: between = .*, expected the names of two different cavities",
        ),
        (
            PHASE + '[[tube]]\nbetween = ["cavity", "cavty"]\nconductance = "6 L/(min bar)"\n' + cavity('"gas"'),
            NameNotFoundError, "tube: unknown cavity 'cavty': did you mean 'cavity'",
        ),
        (PHASE + '[atmosphere]\npressure = "0 kPa"\n', InputError, "atmosphere: pressure = 0 kPa, allowed: more than"),
    ],
)  # fmt: skip
def test_bad_supplies_are_refused_with_one_message(text, kind, message):
    with pytest.raises(kind, match=message) as caught:
        study(SPHERE + text)
    assert len(str(caught.value).splitlines()) == 1
