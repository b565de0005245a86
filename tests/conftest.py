"""What every Python test shares: how a run with Blender in the process ends."""

import os
import sys

import pytest

EXIT_CODE = pytest.StashKey[int]()


@pytest.hookimpl(trylast=True)
def pytest_unconfigure(config: pytest.Config) -> None:
    """Leaves at once, with pytest's own exit code, when Blender is loaded: bpy 4.5 may hang in its exit handlers."""
    if "bpy" not in sys.modules:
        return
    code = config.stash.get(EXIT_CODE, int(pytest.ExitCode.INTERNAL_ERROR))
    try:
        sys.stdout.flush()
        sys.stderr.flush()
    except OSError:
        code = code or int(pytest.ExitCode.INTERNAL_ERROR)  # a full disk: nobody could be told
    finally:
        os._exit(code)


def pytest_sessionfinish(session: pytest.Session, exitstatus: int) -> None:
    session.config.stash[EXIT_CODE] = int(exitstatus)


def pytest_report_header() -> str:
    """Names the Blender that is tested, and fails early when it is not the one that was asked for."""
    expected = os.environ.get("RGP_EXPECTED_BPY")
    if expected is None:
        return "Blender: whatever is installed"
    import bpy

    found = bpy.app.version_string.split()[0]
    if found != expected:
        pytest.exit(f"bpy {found} is installed where {expected} is to be tested", returncode=4)
    return f"Blender: {found}"
