"""The property groups against the core's table of settings."""

import pytest
import rgp_core

from rgp_engine.cli import CommandError
from rgp_engine.cli.assign import assign
from rgp_engine.settings import core_settings, setting_names


def described(group, name, b_property):
    """A property in the words of the core's table."""
    kind = b_property.type
    row = {"group": group, "name": name, "description": b_property.description}
    if kind == "ENUM":
        choices = [item.identifier for item in b_property.enum_items]
        return {**row, "type": "enum", "default": b_property.default, "choices": choices}
    if kind == "INT" and b_property.is_array:
        default = "x".join(map(str, b_property.default_array))
        return {**row, "type": "bins", "default": default, "choices": None}
    digits = 6
    limits = {"minimum": round(b_property.hard_min, digits), "maximum": round(b_property.hard_max, digits)}
    default = round(b_property.default, digits)
    return {**row, "type": kind.lower(), "default": default, "choices": None, **limits}


def test_every_setting_is_the_same_on_both_sides(scene):
    ours = {}
    for group in setting_names(scene.rgp):
        b_group = getattr(scene.rgp, group)
        for name in setting_names(b_group):
            ours[group, name] = described(group, name, b_group.bl_rna.properties[name])
    theirs = {(row["group"], row["name"]): row for row in rgp_core.settings_schema()}
    assert ours.keys() == theirs.keys()
    for key, row in ours.items():
        expected = {name: theirs[key][name] for name in row}
        for name in ("default", "minimum", "maximum"):
            if isinstance(expected.get(name), float):
                expected[name] = round(expected[name], 6)
        assert row == expected


def test_the_core_takes_the_defaults(scene):
    rgp_core.check_settings(core_settings(scene))


def test_bins_are_clamped_to_what_the_core_takes(scene):
    scene.rgp.pyramid.bins = (64, 64)
    assert core_settings(scene)["pyramid"]["bins"] == "32x64"
    scene.rgp.pyramid.bins = (1, 1)
    assert core_settings(scene)["pyramid"]["bins"] == "1x1"


def test_the_largest_and_smallest_values_are_allowed(scene):
    for group in setting_names(scene.rgp):
        b_group = getattr(scene.rgp, group)
        for name in setting_names(b_group):
            b_property = b_group.bl_rna.properties[name]
            if b_property.type == "ENUM":
                values = [item.identifier for item in b_property.enum_items]
            elif b_property.is_array:
                continue
            else:
                values = [b_property.hard_min, b_property.hard_max]
            for value in values:
                setattr(b_group, name, value)
                rgp_core.check_settings(core_settings(scene))


@pytest.mark.parametrize(
    ("assignment", "allowed"),
    [
        ("gather.rays=99999999999", "a whole number from 1 to 4096"),
        ("pyramid.bins=99999999999x16", "whole numbers from 1 to 64"),
        ("gather.retrace_distance=nan", "a number from 0 to 8"),
        ("gather.sampling=\udcff", "one of cosine, uniform"),
    ],
)
def test_what_no_property_can_hold_is_refused_and_changes_nothing(scene, assignment, allowed):
    before = core_settings(scene)
    with pytest.raises(CommandError, match=allowed):
        assign(scene, assignment)
    assert core_settings(scene) == before
