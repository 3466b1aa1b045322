# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
"""Pictures drawn on the processor."""

import numpy as np
import pytest

import isotet


@pytest.fixture
def sphere():
    return isotet.make("kuhn", 12, ["sphere", "plane"]).contour(0.5, "sphere")


def drawn(picture):
    """Which pixels are not white."""
    return (picture[:, :, :3] < 250).any(axis=2)


def test_a_sphere_is_a_disk_in_the_middle(sphere):
    picture = isotet.render(sphere, size=(240, 180), view="+x")
    assert picture.shape == (180, 240, 4) and picture.dtype == np.uint8
    rows, columns = np.nonzero(drawn(picture))
    assert abs(rows.mean() - 89.5) < 2 and abs(columns.mean() - 119.5) < 2
    height, width = np.ptp(rows) + 1, np.ptp(columns) + 1
    assert abs(height - width) <= 3 and height > 130
    assert abs(drawn(picture).sum() / (np.pi / 4 * height * width) - 1) < 0.05


def test_threads_do_not_change_a_picture(sphere):
    one = isotet.render(sphere, size=(200, 150), color_by="plane", threads=1)
    assert np.array_equal(one, isotet.render(sphere, size=(200, 150), color_by="plane", threads=2))


def test_colors_follow_the_field(sphere):
    picture = isotet.render(sphere, size=(300, 200), color_by="plane", color_map="cool-warm", view=(30, 10), legend=False)
    rgb = picture[drawn(picture)][:, :3].astype(int)
    assert (rgb[:, 0] > rgb[:, 2] + 60).any() and (rgb[:, 2] > rgb[:, 0] + 60).any()
    narrow = isotet.render(sphere, size=(300, 200), color_by="plane", color_map="cool-warm", view=(30, 10), legend=False,
                           range=(100, 101))  # fmt: skip
    rgb = narrow[drawn(narrow)][:, :3].astype(int)
    assert not (rgb[:, 0] > rgb[:, 2] + 60).any()


def test_a_legend_stands_beside_and_can_be_left_out(sphere):
    with_scale = isotet.render(sphere, size=(640, 480), color_by="plane", title="height")
    without = isotet.render(sphere, size=(640, 480), color_by="plane", legend=False)
    assert drawn(with_scale)[:, 560:].any()
    assert not np.array_equal(with_scale, without)


def test_surfaces_shine_through_each_other():
    grid = isotet.make("kuhn", 12, ["sphere"])
    both = [grid.contour(0.3, "sphere"), grid.contour(0.6, "sphere")]
    outer = isotet.render(both, colors=["red", "blue"], size=(200, 200), view="+x")
    through = isotet.render(both, colors=["red", "blue"], opacity=0.4, size=(200, 200), view="+x")
    assert outer[100, 100, 0] < 60 and through[100, 100, 0] > outer[100, 100, 0] + 40


def test_a_volume_is_drawn_with_surfaces_inside(sphere):
    packed = isotet.make("kuhn", 12, ["sphere"]).pack("sphere")
    fog = isotet.render(volume=packed, size=(160, 120))
    assert drawn(fog).any()
    assert np.array_equal(fog, isotet.render(volume=packed, volume_opacity="ramp", size=(160, 120), threads=1))
    shell = isotet.render(volume=packed, volume_opacity=[(0.4, 0), (0.5, 0.9), (0.6, 0)], opacity_length=0.1, size=(160, 120))
    both = isotet.render(sphere, volume=packed, colors="red", size=(160, 120))
    met = isotet.render(volume=packed, volume_opacity="", volume_isovalues=[0.5], size=(160, 120))
    lit = isotet.render(volume=packed, volume_shading=True, size=(160, 120))
    pictures = [fog, shell, both, met, lit]
    assert not any(np.array_equal(a, b) for i, a in enumerate(pictures) for b in pictures[:i])
    with pytest.raises(ValueError, match="must ascend"):
        isotet.render(volume=packed, volume_opacity=[(1, 0), (0, 1)])
    with pytest.raises(ValueError, match="must be positive"):
        isotet.render(volume=packed, opacity_length=-1)


def test_colours_and_opacity_may_come_from_files(tmp_path):
    packed = isotet.make("kuhn", 8, ["sphere"]).pack("sphere")
    file = tmp_path / "map.json"
    file.write_text('[{"Name": "a", "RGBPoints": [0, 0, 0, 1, 5, 1, 1, 0], "Points": [0.3, 0, 0.5, 0, 0.5, 0.8, 0.5, 0]},'
                    ' {"Name": "b", "RGBPoints": [0, 1, 0, 0, 5, 1, 1, 0]}]')
    points = isotet.render(volume=packed, volume_opacity=[(0.3, 0), (0.5, 0.8)], size=(80, 60))
    assert np.array_equal(points, isotet.render(volume=packed, volume_opacity=f"@{file}:a", size=(80, 60)))
    blue, red = (isotet.render(volume=packed, color_map=f"@{file}:{name}", size=(80, 60)) for name in "ab")
    assert not np.array_equal(blue, red)
    with pytest.raises(ValueError, match="no Points of opacity"):
        isotet.render(volume=packed, volume_opacity=f"@{file}:b")
    with pytest.raises(ValueError, match="2 colour maps"):
        isotet.render(volume=packed, color_map=f"@{file}")
    with pytest.raises(FileNotFoundError):
        isotet.render(volume=packed, color_map="@none.json")


def test_backgrounds_may_be_transparent(sphere):
    picture = isotet.render(sphere, size=(120, 120), background="transparent")
    assert picture[0, 0, 3] == 0 and picture[60, 60, 3] == 255


def test_views_are_names_angles_and_cameras(sphere):
    front = isotet.render(sphere, size=(160, 120), view="-y", color_by="plane", legend=False)
    assert np.array_equal(front, isotet.render(sphere, size=(160, 120), view=(0, 0), color_by="plane", legend=False))
    camera = "parallel:0,0,0:1,0,0:0,0,1:4"
    assert drawn(isotet.render(sphere, size=(160, 120), view=camera)).sum() < drawn(
        isotet.render(sphere, size=(160, 120), view="+x", parallel=True)).sum()  # fmt: skip


def test_wrong_arguments_are_refused(sphere):
    with pytest.raises(ValueError, match="color_by is 'heat'.*there are plane, sphere"):
        isotet.render(sphere, color_by="heat")
    with pytest.raises(ValueError, match="color_map is 'jet'"):
        isotet.render(sphere, color_by="plane", color_map="jet")
    with pytest.raises(ValueError, match="view is 'top'"):
        isotet.render(sphere, view="top")
    with pytest.raises(ValueError, match="2 colors for 1 surfaces"):
        isotet.render(sphere, colors=["red", "blue"])
    with pytest.raises(ValueError):
        isotet.render(sphere, size=(0, 10))
    with pytest.raises(ValueError):
        isotet.render(sphere, opacity=2)


def test_shading_is_smooth_or_flat(sphere):
    flat = isotet.render(sphere, size=(200, 200), smooth=False)
    smooth = isotet.render(sphere, size=(200, 200))
    shades = [len(np.unique(picture[drawn(picture)], axis=0)) for picture in (flat, smooth)]
    assert not np.array_equal(flat, smooth)
    assert np.array_equal(drawn(flat), drawn(smooth)) and min(shades) > 10


def test_no_surface_is_an_empty_picture():
    assert not drawn(isotet.render([], size=(40, 30))).any()
