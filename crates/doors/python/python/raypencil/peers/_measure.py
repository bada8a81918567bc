"""All that the page says of a peer, measured: as plain numbers that a JSON file can keep."""

from __future__ import annotations

import json
import os
import platform
import shutil
import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from ..testing import hard_rays
from ._known import peer
from ._laws import LAWS, Threshold
from ._peer import PROCESSOR, Peer, Unavailable
from ._question import Counts
from ._worker import Job, work

#: Rays of the measurement of speed, at most.
_RAYS = 1 << 20

#: What `reference/peers/install.sh` notes of the environment that it makes: a line for each step, its seconds and MB.
INSTALLED = "installed.tsv"


@dataclass(frozen=True)
class Step:
    """One step of making an environment.

    Attributes:
        name: in words.
        seconds: that it took.
        megabytes: by which the environment grew.
    """

    name: str
    seconds: int
    megabytes: int


def installed(kept: Path, environment: Path = Path(sys.prefix)) -> list[Step]:
    """The steps of making an environment, as a folder of answers keeps them; none: no one noted them.

    Args:
        kept: the folder. What `environment` notes is copied into it once.
        environment: of which the notes are.
    """
    file = kept / INSTALLED
    if not file.is_file() and (environment / INSTALLED).is_file():
        shutil.copyfile(environment / INSTALLED, file)
    if not file.is_file():
        return []
    rows = (line.split("\t") for line in file.read_text(encoding="utf-8").splitlines())
    return [Step(name, int(seconds), int(megabytes)) for name, seconds, megabytes in rows]


@dataclass(frozen=True, eq=False)
class Measured:
    """What was measured of a peer.

    Attributes:
        peer: its adapter.
        version: of its package.
        machine: on what it was measured, in words.
        families: the counts of each family of hard rays, or what the peer said when it refused the mesh.
        shares: for each law the values, and at each the share of wrong rays; ``None`` where the peer could not be asked.
        thresholds: where half of the rays become wrong.
        speed: rays a second on a ground of 8192 faces; ``None`` where it could not be asked.
        seconds: that all of it took; ``None`` where nobody noted them.
        load: processes that wanted a core, a mean of the minute before; ``None`` as well.
        times: how often the speed was asked; it is the highest.
    """

    peer: Peer
    version: str
    machine: str
    families: dict[str, Counts | str]
    shares: dict[str, list[tuple[float, float | None]]]
    thresholds: list[Threshold]
    speed: float | None
    seconds: float | None = None
    load: float | None = None
    times: int = 1

    @property
    def total(self) -> Counts:
        """The counts of all families that it answered."""
        return sum((counts for counts in self.families.values() if isinstance(counts, Counts)), Counts())

    @property
    def refused(self) -> dict[str, str]:
        """The families whose mesh it refused, and what it said."""
        return {name: said for name, said in self.families.items() if isinstance(said, str)}


def jobs() -> list[Job]:
    """All that a peer is asked."""
    return [{"family": name} for name in hard_rays()] + [{"law": name} for name in LAWS] + [{"speed": True, "rays": _RAYS}]


def of_answers(one: Peer, version: str, machine: str, answers: Sequence[dict[str, Any]]) -> Measured:
    """The answers to :func:`jobs` as what was measured."""
    families: dict[str, Counts | str] = {}
    shares: dict[str, list[tuple[float, float | None]]] = {}
    found: list[Threshold] = []
    speed = None
    for job, told in zip(jobs(), answers, strict=True):
        answer = told.get("answer")
        if "family" in job:
            families[job["family"]] = told["refused"] if answer is None else Counts(*answer)
        elif "law" in job:
            law = LAWS[job["law"]]
            if answer is None:
                shares[law.name] = [(value, None) for value in law.values]
            else:
                shares[law.name] = [(value, share) for value, share, _ in answer["shares"]]
                found += [Threshold(**threshold) for threshold in answer["thresholds"]]
        elif answer is not None:
            speed = answer["rays"] / answer["seconds"]
    return Measured(one, version, machine, families, shares, found, speed)


def measure(
    names: Sequence[str], kept: Path, tell: Callable[[str], None] = lambda line: None, elsewhere: Path | None = None
) -> tuple[list[Measured], dict[str, str]]:
    """Asks peers all jobs, one after the other, each in a process of its own.

    Args:
        names: of peers.
        kept: a folder for what they answer; a peer whose answers are in it is not asked again.
        tell: is called with the name of each peer that is asked.
        elsewhere: a folder that another machine kept; its peers are not asked here.

    Returns:
        What was measured, and the peers that could not be asked, each with the reason.
    """
    kept.mkdir(parents=True, exist_ok=True)
    measured, missing = [], {}
    for name in names:
        one, file = peer(name), kept / f"{name}.json"
        if elsewhere is not None and (elsewhere / file.name).is_file():
            file = elsewhere / file.name
        if not file.is_file():
            try:
                version, device = one.version(), one.device()
            except Unavailable as error:
                missing[name] = str(error)
                continue
            tell(f"{one.title} {version}")
            load, start = _load(), time.monotonic()
            answers = work(name, jobs())
            seconds = round(time.monotonic() - start, 1)
            if gone := [answer["unavailable"] for answer in answers if "unavailable" in answer]:
                missing[name] = gone[0]
                continue
            data = {
                "version": version, "machine": machine(device), "seconds": seconds, "load": load,
                "jobs": jobs(), "answers": answers,
            }  # fmt: skip
            file.write_text(json.dumps(data) + "\n", encoding="utf-8")
        data = json.loads(file.read_text(encoding="utf-8"))
        if data["jobs"] == jobs() and "machine" in data:
            whole = of_answers(one, data["version"], data["machine"], data["answers"])
            measured.append(replace(whole, seconds=data.get("seconds"), load=data.get("load"), times=data.get("times", 1)))
        else:
            missing[name] = f"{file} is of other questions: remove it"
    return measured, missing


def time_again(names: Sequence[str], kept: Path, tell: Callable[[str], None] = lambda line: None) -> None:
    """Asks the speed of peers once more, one after the other, and keeps the higher one: other work on a machine only makes it lower.

    Args:
        names: of peers.
        kept: a folder of what they answered; peers that are not in it are left alone.
        tell: is called with the name of each peer that is asked.
    """
    for name in names:
        file = kept / f"{name}.json"
        if not file.is_file():
            continue
        tell(peer(name).title)
        data = json.loads(file.read_text(encoding="utf-8"))
        at = next((k for k, job in enumerate(data["jobs"]) if "speed" in job), None)
        (told,) = work(name, jobs()[-1:])
        if at is None or "answer" not in told:
            continue
        old, new = data["answers"][at].get("answer"), told["answer"]
        if old is None or new["rays"] / new["seconds"] > old["rays"] / old["seconds"]:
            data["answers"][at] = told
        data["times"] = data.get("times", 1) + 1
        file.write_text(json.dumps(data) + "\n", encoding="utf-8")


def _load() -> float | None:
    """Processes that want a core, a mean of the last minute; ``None`` on a system that does not tell."""
    return round(os.getloadavg()[0], 1) if hasattr(os, "getloadavg") else None


def machine(device: str = PROCESSOR) -> str:
    """A machine of speeds, in words."""
    card = "" if device == PROCESSOR else f"{device}, "
    return f"{card}{os.cpu_count()} cores, {platform.machine()}, Python {platform.python_version()}"
