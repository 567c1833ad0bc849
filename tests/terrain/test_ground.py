import io
from math import radians, sqrt, tan

import numpy as np
import pytest
from PIL import Image

from pneumorph.errors import InputError, NameNotFoundError, StorageError
from pneumorph.terrain import HeightField, course, flat, from_image, ramp, smooth, steps, terraced, to_image
from pneumorph.terrain.courses import CELL
from pneumorph.terrain.perlin import perlin

EXTENT = 4_000.0
SIZE = {"length": EXTENT, "width": EXTENT, "relief": 300.0}


def test_perlin_noise_is_zero_with_a_gradient_of_one_at_whole_places():
    whole, h = np.arange(-3.0, 4.0), 1e-6
    assert np.abs(perlin(whole, whole, 7)).max() == 0.0
    right = np.diag(perlin(whole + h, whole, 7)) / h
    up = np.diag(perlin(whole, whole + h, 7)) / h
    np.testing.assert_allclose(np.hypot(right, up), 1.0, rtol=1e-6)


def test_perlin_noise_is_continuous_and_stays_within_its_bound():
    fine = np.linspace(-2.0, 2.0, 801)
    noise = perlin(fine, fine, 3)
    assert np.abs(noise).max() <= sqrt(0.5)
    assert np.abs(noise).max() > 0.3
    # slopes of blended unit planes stay under 1 + 2 * 15/8 * sqrt(1/2)
    assert np.abs(np.diff(noise, axis=1)).max() < 3.7 * (fine[1] - fine[0])


def test_perlin_noise_depends_on_its_seed_alone():
    places = np.linspace(0.0, 5.0, 40)
    np.testing.assert_array_equal(perlin(places, places, 1), perlin(places, places, 1))
    assert np.abs(perlin(places, places, 1) - perlin(places, places, 2)).max() > 0.1


def test_flat_ground_is_level():
    assert flat(EXTENT).relief == 0.0


def test_steps_rise_by_their_height_every_tread():
    field = steps(rise=40.0, tread=500.0, count=2, extent=EXTENT)
    heights = dict(zip(field.x.round(), field.heights[0], strict=True))
    assert heights[950.0] == 0.0
    assert heights[1000.0] == heights[1450.0] == 40.0
    assert heights[1500.0] == heights[2000.0] == 80.0
    assert (field.heights == field.heights[0]).all()


def test_a_ramp_has_its_slope_and_is_level_before_and_after():
    field = ramp(slope=radians(10.0), climb=500.0, extent=EXTENT)
    slopes = np.diff(field.heights[0]) / CELL
    climbing = (field.x[:-1] >= 1000.0) & (field.x[:-1] < 1500.0)
    np.testing.assert_allclose(slopes[climbing], tan(radians(10.0)), rtol=1e-9)
    assert np.abs(slopes[~climbing]).max() < 1e-12


def test_undulating_ground_spans_its_relief_and_is_repeated_by_its_seed():
    field = smooth(4, relief=250.0, wavelength=1000.0, extent=EXTENT)
    assert field.heights.min() == 0.0
    assert field.relief == pytest.approx(250.0)
    np.testing.assert_array_equal(field.heights, smooth(4, 250.0, 1000.0, EXTENT).heights)


def test_terraces_lie_at_whole_multiples_below_the_smooth_ground():
    field = terraced(4, relief=250.0, wavelength=1000.0, terrace=50.0, extent=EXTENT)
    assert set(np.unique(field.heights)) == {0.0, 50.0, 100.0, 150.0, 200.0, 250.0}
    below = smooth(4, 250.0, 1000.0, EXTENT).heights - field.heights
    assert below.min() > -1e-6
    assert below.max() < 50.0


def test_terrains_are_known_by_name_and_cover_fifty_metres():
    assert course("ramp").length == 50_000.0
    with pytest.raises(NameNotFoundError, match="unknown terrain 'stpes': did you mean 'steps'"):
        course("stpes")


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: flat(90.0), "extent = 90 mm, expected at least 100 mm"),
        (lambda: steps(rise=0.0), "steps: rise = 0 mm, expected more than 0"),
        (lambda: steps(tread=50.0), "steps: tread = 50 mm, expected more than 50 mm"),
        (lambda: steps(count=0), "steps: count = 0, expected at least 1"),
        (lambda: ramp(climb=-1.0), "ramp: climb = -1 mm"),
        (lambda: ramp(slope=radians(50.0)), "ramp: slope = 50 deg, expected between 0 and 45 deg"),
        (lambda: smooth(relief=0.0), "undulating terrain: relief = 0 mm"),
        (lambda: terraced(terrace=400.0), "terrace = 400 mm, expected between 0 and 400 mm"),
        (lambda: HeightField(np.zeros((1, 5)), 1.0, 1.0), r"shape \(1, 5\): expected at least 2 rows"),
        (lambda: HeightField(np.full((2, 2), np.nan), 1.0, 1.0), "every height must be a finite number"),
        (lambda: HeightField(np.zeros((2, 2)), 0.0, 1.0), "length = 0 mm, expected more than 0"),
        (lambda: flat(EXTENT).highest((0.0, 2001.0), (0.0, 1.0)), "0 to 2 m by 0 to 0.001 m: off the terrain"),
    ],
)
def test_impossible_ground_is_refused(make, message):
    with pytest.raises(InputError, match=message):
        make()


def test_the_highest_place_counts_neighbours_of_the_rectangle():
    heights = np.zeros((5, 5))
    heights[2, 3] = 7.0
    field = HeightField(heights, 40.0, 40.0)  # a height every 10 mm from -20 mm on
    assert field.highest((1.0, 2.0), (-1.0, 1.0)) == 7.0
    assert field.highest((-9.0, -1.0), (-1.0, 1.0)) == 0.0


def test_an_image_has_black_at_the_bottom_white_at_the_relief_and_y_upwards(tmp_path):
    pixels = np.array([[0, 51], [102, 255]], np.uint8)
    Image.fromarray(pixels).save(tmp_path / "a.png")
    field = from_image(tmp_path / "a.png", **SIZE)
    np.testing.assert_allclose(field.heights, [[120.0, 300.0], [0.0, 60.0]])


def test_a_height_field_comes_back_from_its_16_bit_image(tmp_path):
    field = smooth(1, 300.0, 1000.0, EXTENT)
    to_image(field).save(tmp_path / "a.png")
    again = from_image(tmp_path / "a.png", **SIZE)
    assert np.abs(again.heights - field.heights).max() <= 0.51 * 300.0 / 65535
    assert np.asarray(to_image(flat(EXTENT))).max() == 0


def test_an_image_that_is_not_grey_scale_is_refused(tmp_path):
    Image.new("RGB", (4, 4), "red").save(tmp_path / "a.png")
    with pytest.raises(InputError, match=r"a\.png': its pixels are RGB, expected grey-scale of 8 or 16 bits"):
        from_image(tmp_path / "a.png", **SIZE)


def test_an_image_without_relief_is_refused(tmp_path):
    Image.new("L", (4, 4), 90).save(tmp_path / "a.png")
    with pytest.raises(InputError, match="every pixel has the grey 90, so it has no relief"):
        from_image(tmp_path / "a.png", **SIZE)


def test_a_file_that_is_no_image_is_refused(tmp_path):
    (tmp_path / "a.png").write_text("no picture")
    with pytest.raises(InputError, match="expected a grey-scale image, such as PNG"):
        from_image(tmp_path / "a.png", **SIZE)
    stream = io.BytesIO()
    Image.new("L", (64, 64), 90).save(stream, "PNG")
    (tmp_path / "b.png").write_bytes(stream.getvalue()[:60])
    with pytest.raises(InputError, match="expected a grey-scale image"):
        from_image(tmp_path / "b.png", **SIZE)


def test_an_image_that_is_not_there_is_refused(tmp_path):
    with pytest.raises(StorageError, match=r"a\.png' cannot be read: No such file"):
        from_image(tmp_path / "a.png", **SIZE)


def test_an_image_needs_a_positive_relief(tmp_path):
    Image.fromarray(np.array([[0, 51], [102, 255]], np.uint8)).save(tmp_path / "a.png")
    with pytest.raises(InputError, match="relief = 0 mm, expected more than 0"):
        from_image(tmp_path / "a.png", length=1.0, width=1.0, relief=0.0)
