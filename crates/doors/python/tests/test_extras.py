"""What needs a package that is not installed says so."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import SMALL

import raypencil
from raypencil._sweep import SweepResult


def judged(mesh: raypencil.Mesh) -> raypencil.Judgement:
    return raypencil.judge(mesh, [0.25, 0.5, 3, 0, 0, -2], {"t": np.array(1.0)})


CALLS: dict[str, tuple[str, Callable[[raypencil.Mesh, Path], Any]]] = {
    "cast, xarray": ("xarray", lambda mesh, _: raypencil.cast(mesh, [0, 0, 3], [0, 0, -1]).to_xarray()),
    "cast, pandas": ("pandas", lambda mesh, _: raypencil.cast(mesh, [0, 0, 3], [0, 0, -1]).to_pandas()),
    "judge": ("xarray", lambda mesh, _: judged(mesh).to_xarray()),
    "render": ("xarray", lambda mesh, _: raypencil.render(raypencil.Scene(SMALL)).to_xarray()),
    "elevation map": (
        "xarray",
        lambda mesh, _: raypencil.ElevationMap(np.zeros((2, 2)), np.zeros((2, 2), np.uint8), 0, 0, 1).to_xarray(),
    ),
    "sweep": ("pandas", lambda mesh, _: SweepResult(True, "", "{}", {"run": []}, "out").to_pandas()),
    "cluster": ("distributed", lambda mesh, folder: raypencil.campaign(1, output=folder, client=object())),
}


@pytest.mark.parametrize("of", CALLS)
def test_a_package_that_is_missing_is_named(
    of: str, cube: raypencil.Mesh, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    package, call = CALLS[of]
    # Whoever imports it finds nothing.
    monkeypatch.setitem(sys.modules, package, None)
    extra = {"distributed": "dask"}.get(package, package)
    with pytest.raises(ImportError, match=rf"needs {package}: pip install raypencil\[{extra}\]") as caught:
        call(cube, tmp_path)
    # As all that is refused.
    assert isinstance(caught.value, raypencil.RaypencilError)


def test_a_table_without_pandas_is_shown_as_text(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pandas", None)
    assert SweepResult(True, "4 runs", "{}", {"run": []}, "out")._repr_html_() == "<pre>4 runs</pre>"
