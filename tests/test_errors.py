"""The tree of exceptions."""

import inspect

import pytest

from pneumorph import errors


def test_every_exception_hangs_on_one_base():
    kinds = [kind for _, kind in inspect.getmembers(errors, inspect.isclass) if kind.__module__ == errors.__name__]
    assert len(kinds) > 5
    assert all(issubclass(kind, errors.PneumorphError) for kind in kinds)


@pytest.mark.parametrize("name", ["UnitError", "GeometryError", "MeshError", "NameNotFoundError", "StudyError"])
def test_bad_input_is_a_value_error_too(name):
    kind = getattr(errors, name)
    assert issubclass(kind, errors.InputError)
    assert issubclass(kind, ValueError)


@pytest.mark.parametrize("name", ["NotConvergedError", "StorageError", "EngineError"])
def test_a_failure_of_the_calculation_is_no_bad_input(name):
    assert not issubclass(getattr(errors, name), errors.InputError)


def test_a_solve_that_stopped_carries_what_it_reached():
    reached = object()
    assert errors.NotConvergedError("stopped at 80 kPa", reached).solution is reached
    assert errors.NotConvergedError("stopped").solution is None


@pytest.mark.parametrize(
    ("name", "known", "message"),
    [
        ("clmp", ["tip", "clamp"], "unknown face 'clmp': did you mean 'clamp'? Allowed: clamp, tip"),
        ("xyz", ["tip", "clamp"], "unknown face 'xyz': Allowed: clamp, tip"),
        ("xyz", [], "unknown face 'xyz': Allowed: none"),
    ],
)
def test_an_unknown_name_comes_with_the_nearest_and_all_that_are_allowed(name, known, message):
    assert errors.unknown_name("face", name, known) == message
