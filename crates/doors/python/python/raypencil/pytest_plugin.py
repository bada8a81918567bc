"""The plugin of pytest: fixtures with hard rays and reference packs, and an assertion that leaves a report.

* ``raypencil_check(pack, answers, arithmetic=None, ...)`` fails the test if answers are wrong, with what is wrong, what
  explains it, and the folder of the report. ``pack`` may be one of the hard rays.
* ``hard_rays``: a test with this argument runs once for each family of hard rays.
* ``raypencil_pack``: a test with this argument runs once for each pack of the folder of ``--raypencil-packs``.
* ``raypencil_packs``: all of these packs, by name.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from ._judge import Judgement
    from ._packs import CheckResult


def pytest_addoption(parser: pytest.Parser) -> None:
    """Adds the options."""
    group = parser.getgroup("raypencil", "reference packs for ray tracers")
    group.addoption("--raypencil-packs", metavar="DIR", help="folder with reference packs, or one of them")
    group.addoption("--raypencil-reports", metavar="DIR", help="folder for the reports of failures: raypencil-reports")
    parser.addini("raypencil_packs", "folder with reference packs, from the root folder", default="")
    parser.addini("raypencil_reports", "folder for the reports of failures", default="raypencil-reports")


def _folder(config: pytest.Config, name: str) -> Path | None:
    """A folder by its option, else by its setting."""
    option = config.getoption(f"--raypencil-{name}")
    if option:
        return Path(str(option))
    setting = str(config.getini(f"raypencil_{name}"))
    return config.rootpath / setting if setting else None


def _packs(config: pytest.Config) -> dict[str, Path]:
    from .testing import packs_in

    folder = _folder(config, "packs")
    if folder is None:
        return {}
    packs = packs_in(folder)
    if not packs:
        raise pytest.UsageError(f"--raypencil-packs {folder}: no reference packs there; expected folders with manifest.json")
    return packs


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    """Runs a test once for each family of hard rays, and for each pack."""
    if "hard_rays" in metafunc.fixturenames:
        from .testing import hard_rays

        families = hard_rays()
        metafunc.parametrize("hard_rays", list(families.values()), ids=list(families))
    if "raypencil_pack" in metafunc.fixturenames:
        packs = _packs(metafunc.config)
        if packs:
            metafunc.parametrize("raypencil_pack", list(packs.values()), ids=list(packs))
        else:
            skip = pytest.mark.skip(reason="no reference packs: --raypencil-packs DIR")
            metafunc.parametrize("raypencil_pack", [pytest.param(None, marks=skip)], ids=["none"])


@pytest.fixture
def raypencil_packs(request: pytest.FixtureRequest) -> dict[str, Path]:
    """The packs of ``--raypencil-packs``, by name. Without them the test is skipped."""
    packs = _packs(request.config)
    if not packs:
        pytest.skip("no reference packs: --raypencil-packs DIR")
    return packs


@pytest.fixture
def raypencil_check(request: pytest.FixtureRequest) -> Callable[..., CheckResult | Judgement]:
    """Fails the test if answers to a pack, or to hard rays, are wrong."""
    from .testing import assert_answers

    root = _folder(request.config, "reports") or Path("raypencil-reports")
    reports = root / re.sub(r"[^\w.-]+", "-", request.node.name).strip("-")
    count = 0

    def raypencil_check(pack: Any, answers: Any, arithmetic: Any = None, **options: Any) -> CheckResult | Judgement:
        # What fails is not where it fails.
        __tracebackhide__ = True
        nonlocal count
        count += 1
        folder = reports if count == 1 else reports / str(count)
        try:
            return assert_answers(pack, answers, arithmetic, reports=folder, **options)
        except AssertionError as error:
            words = str(error)
        # Not while the error is handled: it would be shown as well.
        pytest.fail(words, pytrace=False)

    return raypencil_check
