"""Values of a model as JSON and back."""

import json
from dataclasses import dataclass

import numpy as np
import pytest

from pneumorph import materials, mechanics
from pneumorph.errors import StorageError
from pneumorph.materials import NeoHookean, Yeoh
from pneumorph.mechanics import Cavity, Clamp, Gravity, Phase, Programme, Roller, VolumeSupply
from pneumorph.solution.codec import REGISTRY, decode, differences, encode, register
from pneumorph.solution.files import write_atomically


def test_every_public_material_support_load_and_supply_is_registered():
    for module in (materials, mechanics):
        for name in module.__all__:
            item = getattr(module, name)
            if hasattr(item, "__dataclass_fields__") and name not in (
                "Model",
                "State",
                "Material",
                "InvariantMaterial",
                "StretchMaterial",
            ):
                assert REGISTRY[name] is item


@pytest.mark.parametrize(
    "value",
    [
        Yeoh(0.1, 0.02, bulk=123.4567890123456789, density=1e-9),
        (Clamp("a"), Roller("b", "x")),
        {"a": NeoHookean(1 / 3)},
        Cavity("c", ("f", "g"), VolumeSupply(), mirrors=("m",)),
        Gravity((0.0, 0.0, -1.0)),
        Programme((Phase("p", {"c": 0.1}, marks=(0.25,)),)),
        (1, 0.1, None, True, "text", float("inf")),
    ],
)
def test_values_come_back_as_they_were(value):
    assert decode(json.loads(json.dumps(encode(value)))) == value


def test_numpy_numbers_and_arrays_become_plain_ones():
    assert encode(np.array([1.5, 2.0])) == [1.5, 2.0]
    assert encode(np.int64(3)) == 3


@dataclass(frozen=True)
class Own:
    size: float


def test_classes_of_your_own_are_refused_until_they_are_registered():
    with pytest.raises(StorageError, match=r"loads\[0\]: Own cannot be stored"):
        encode((Own(1.0),), "loads")
    try:
        register(Own)
        assert decode(encode(Own(1.0))) == Own(1.0)
    finally:
        del REGISTRY["Own"]


def test_what_json_cannot_hold_is_refused():
    with pytest.raises(StorageError, match="about: a object cannot be stored"):
        encode(object(), "about")
    with pytest.raises(StorageError, match=r"key '\$class'"):
        encode({"$class": 1})
    with pytest.raises(StorageError, match="key 1 cannot"):
        encode({1: 1})


def test_differences_name_the_place():
    first, second = encode({"a": Yeoh(0.1, 0.2), "b": (1, 2)}), encode({"a": NeoHookean(0.1), "b": (1, 3), "c": 0})
    lines = differences(first, second, "model")
    assert lines[0].startswith("model.a = NeoHookean(")
    assert lines[1:] == ["model.b[1] = 3, the folder holds 2", "model.c is new"]
    assert differences(float("nan"), float("nan"), "x") == []


def test_a_failing_write_keeps_the_old_file_and_names_it(tmp_path):
    path = tmp_path / "file"
    path.write_text("old")

    def fail(temporary):
        temporary.write_text("ne")
        raise OSError("disk full")

    with pytest.raises(StorageError, match=r"file cannot be written: disk full"):
        write_atomically(path, fail)
    assert path.read_text() == "old"
