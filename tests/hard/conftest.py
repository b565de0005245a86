"""The suite of hard cases: every check is a row of the table in docs/stability.md."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from tests.hard import page
from tests.hard.record import Record

RECORD = pytest.StashKey[Record]()
FOLDER = os.environ.get("RGP_STABILITY")
"""Where stability.json and stability.md are written; without it nothing is written and no edge is looked for."""


def pytest_configure(config: pytest.Config) -> None:
    config.stash[RECORD] = Record(thorough=bool(FOLDER))


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """What takes minutes or gigabytes runs only where the page is written, and last."""
    items.sort(key=lambda item: item.get_closest_marker("heavy") is not None)
    for item in items:
        if item.get_closest_marker("heavy") and not FOLDER:
            item.add_marker(pytest.mark.skip(reason="runs in `make hard`"))


@pytest.fixture
def record(request: pytest.FixtureRequest) -> Record:
    return request.config.stash[RECORD]


@pytest.fixture
def check(record: Record, request: pytest.FixtureRequest) -> Callable[..., None]:
    """`check(case, expected=, got=, bound=)` adds a row to the table of the test's file, and fails over the bound."""
    group = request.module.GROUP

    def run(case: str, **values: Any) -> None:
        record.check(group, case, **values)

    return run


@pytest.fixture
def edge(record: Record, request: pytest.FixtureRequest) -> Callable[..., None]:
    """`edge(case, dial, deviation, unit=)` turns a dial until the case breaks; only where the table is written."""
    group = request.module.GROUP

    def run(case: str, *arguments: Any, **values: Any) -> None:
        record.edge(group, case, *arguments, **values)

    return run


@pytest.hookimpl(wrapper=True)
def pytest_sessionfinish(session: pytest.Session) -> Iterator[None]:
    record = session.config.stash[RECORD]
    if FOLDER and record.groups:
        page.write(record, Path(FOLDER))
    yield
