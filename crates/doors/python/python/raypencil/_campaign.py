"""Campaigns: both renderers, or one of somebody else's, on many terrains."""

from __future__ import annotations

import functools
import os
from collections.abc import Sequence
from typing import Any

from . import _raypencil
from ._cluster import Files, Work, made_apart, run_shards
from ._errors import RaypencilError
from ._progress import Progress
from ._validate import Outcome

#: Terrains of a shard, if their number is not given: some seconds of work.
TERRAINS_OF_A_SHARD = 10


class CampaignResult(Outcome):
    """What a campaign found."""

    @property
    def counts(self) -> dict[str, int]:
        """Rays of each class, over all terrains: ``agree``, ``tie``, ``rounding``, ``approximation``, ``undecided``,
        ``defects``."""
        return dict(self.summary["all"]["classes"])

    @property
    def wrong(self) -> list[dict[str, Any]]:
        """The first wrong rays, each with the commands that show it."""
        return list(self.summary["first_wrong"])

    def __repr__(self) -> str:
        return f"<raypencil.CampaignResult: {self.summary['terrains']} terrains, {self.summary['verdict']}>"


def _shard(arguments: dict[str, Any], count: int, index: int) -> Files:
    """A shard, made by a worker in a folder of its own."""
    core = _raypencil.CampaignCore(**arguments)
    files = made_apart(lambda folder: core.shard(index, count, folder))
    # The records of its terrains are within its result.
    return {name: content for name, content in files.items() if not name.startswith("terrains")}


def campaign(
    terrains: int = 100,
    seed: int = 1,
    *,
    output: str | os.PathLike[str],
    force: bool = False,
    scenes: str | os.PathLike[str] | None = None,
    rig: str | os.PathLike[str] | None = None,
    candidate_command: str | None = None,
    timeout: float | None = None,
    partial: bool = False,
    arithmetic: str | None = None,
    parts: Sequence[str] | None = None,
    max_faces: int | None = None,
    shards: int | None = None,
    client: Any = None,
    retries: int = 3,
    progress: Progress = False,
) -> CampaignResult:
    """Compares both renderers on random terrains; the referee rules on every ray on which they differ.

    Args:
        terrains: their number.
        seed: of all random numbers.
        output: a folder for the records and the report. A campaign that was broken off there goes on.
        force: begin in a folder that has results of another command; without it they are an error.
        scenes: a folder with scenes, terrains and elevation models of your own, in place of random ones.
        rig: a scene file whose vehicle, camera and beams stand on each terrain of ``scenes``.
        candidate_command: a program to hunt in: ``'my-tracer {pack} {out}'``; docs/guide/campaign.md.
        timeout: most time of that program for one scene, seconds; half an hour by default.
        partial: whether that program may leave out what decides, faces and distances.
        arithmetic: ``"f64"`` or ``"f32"``, that of the program; as its ``candidate.json`` says by default, else ``"f64"``.
        parts: scenes of each terrain, some of ``"own"``, ``"paper"``, ``"aimed"`` and ``"lattice"``; all by default.
        max_faces: grounds with more faces are left out; a lattice, which has few faces of its own, stays.
        shards: shards of the campaign; 1, or with ``client`` one for ten terrains. The result does not depend on it.
        client: a ``distributed.Client``; then each shard is a task of its cluster. Its workers need this package, in the same
            version, and the files that are named. Without it the campaign runs here, on all cores.
        retries: how often a shard that fails on the cluster is tried again.
        progress: see :func:`cast`.

    Returns:
        What was found; byte for byte the same for any number of shards and workers.

    Raises:
        RaypencilError: a folder with another campaign, a file that cannot be read or written.
    """
    if terrains < 1 or seed < 0:
        raise RaypencilError(f"terrains is {terrains} and seed {seed}; expected at least 1 and at least 0")
    arguments: dict[str, Any] = {"terrains": terrains, "seed": seed, "candidate_command": candidate_command}
    arguments["scenes"] = None if scenes is None else os.path.abspath(os.fspath(scenes))
    arguments["rig"] = None if rig is None else os.path.abspath(os.fspath(rig))
    arguments |= {"timeout": timeout, "partial": partial, "arithmetic": arithmetic, "max_faces": max_faces}
    arguments["parts"] = None if parts is None else list(parts)
    core = _raypencil.CampaignCore(**arguments)
    folder = os.fspath(output)
    task = functools.partial(_shard, arguments)
    work = Work("campaign", "terrains", core.terrains, TERRAINS_OF_A_SHARD, core.shard, core.has_result, task)
    shared = _raypencil.SharedCore(folder, force)
    try:
        run_shards(work, shards, folder, client, retries, progress)
        return CampaignResult(*core.merge([folder], folder))
    finally:
        shared.release()
