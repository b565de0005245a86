"""The core's table of settings and its check."""

import pytest
import rgp_core

ROWS = rgp_core.settings_schema()


def test_the_table_is_complete():
    for row in ROWS:
        assert {
            "group",
            "name",
            "type",
            "default",
            "minimum",
            "maximum",
            "choices",
            "unit",
            "description",
        } <= row.keys()
        assert row["type"] in ("int", "float", "bool", "enum", "bins")
        assert row["description"]
        assert not row["description"].endswith(".")
    names = {f"{row['group']}.{row['name']}" for row in ROWS}
    assert {"photon_pass.photon_count", "pyramid.finest_resolution", "pyramid.bins", "gather.rays"} <= names
    assert len(names) == len(ROWS)


@pytest.mark.parametrize("row", ROWS, ids=lambda row: f"{row['group']}.{row['name']}")
def test_defaults_and_limits_are_allowed_and_no_more(row):
    def check(value):
        rgp_core.check_settings({row["group"]: {row["name"]: value}})

    check(row["default"])
    if row["type"] in ("int", "float"):
        check(row["minimum"])
        check(row["maximum"])
        for value in (row["minimum"] - 1, row["maximum"] + 1, "many", None):
            with pytest.raises(rgp_core.SettingsError, match=f"{row['group']}.{row['name']}"):
                check(value)
    elif row["type"] == "enum":
        for choice in row["choices"]:
            check(choice)
        with pytest.raises(rgp_core.SettingsError, match=row["choices"][-1]):
            check("something else")


@pytest.mark.parametrize("bins", ["1x1", "32x64", "8x16", "3x5"])
def test_bins(bins):
    rgp_core.check_settings({"pyramid": {"bins": bins}})


@pytest.mark.parametrize("bins", ["0x4", "33x16", "8x65", "8", "8x", "x8", "8x16x2", "8.5x16", "", 8])
def test_bins_that_are_not_allowed(bins):
    with pytest.raises(rgp_core.SettingsError, match=r"pyramid\.bins"):
        rgp_core.check_settings({"pyramid": {"bins": bins}})


@pytest.mark.parametrize("settings", [{"gather": {"rayz": 3}}, {"gatherer": {"rays": 3}}])
def test_unknown_names_are_answered_with_those_that_exist(settings):
    with pytest.raises(rgp_core.SettingsError, match=r"gather\.rays"):
        rgp_core.check_settings(settings)


def test_errors_are_what_python_expects():
    assert issubclass(rgp_core.SettingsError, rgp_core.RenderError)
    assert issubclass(rgp_core.SettingsError, ValueError)
    assert issubclass(rgp_core.SceneError, rgp_core.RenderError)
    assert issubclass(rgp_core.EmbreeError, rgp_core.RenderError)
