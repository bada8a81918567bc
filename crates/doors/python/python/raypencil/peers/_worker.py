"""Asks one peer in a process of its own: it may crash, hang, or load what does not go with another peer.

`python -m raypencil.peers._worker PEER JOBS RESULTS`: jobs are a JSON list; each result is a line of JSON, written at once.
"""

from __future__ import annotations

import json
import sys
import tempfile
from pathlib import Path
from subprocess import DEVNULL, TimeoutExpired, run
from typing import Any

import numpy as np

from .._mesh import Mesh
from ..testing import hard_rays
from ._known import peer
from ._laws import LAWS, bumpy, share_wrong, thresholds
from ._peer import Peer, Unavailable
from ._question import Counts, asked, judged

Job = dict[str, Any]

#: Seconds after which a process is stopped, and the job that it was at is told as not answered.
_PATIENCE = 1800.0


def _family(one: Peer, job: Job) -> Any:
    hard = hard_rays()[job["family"]]
    question = asked(one, hard.mesh, hard.rays)
    counts, _ = judged(one, question, one.first(question.mesh, question.rays))
    return counts.all


def _law(one: Peer, job: Job) -> Any:
    law = LAWS[job["law"]]
    shares: dict[float, tuple[float, float] | None] = {}
    refused = None
    for value in law.values:
        try:
            shares[value] = share_wrong(one, law, value)
        except Unavailable:
            raise
        except Exception as error:  # Whatever a peer raises is its answer.
            shares[value], refused = None, str(error)
    found = thresholds(one, law, shares)
    return {
        "shares": [[value, *(share or (None, None))] for value, share in shares.items()],
        "thresholds": [vars(threshold) for threshold in found],
        "refused": refused,
    }


def _speed(one: Peer, job: Job) -> Any:
    """Rays a second on a ground of 8192 faces: ever more rays, until they take a third of a second; then the best of five."""
    vertices, faces = bumpy(64)
    draw = np.random.default_rng(1)
    origins = draw.uniform(-0.45, 0.45, (int(job["rays"]), 3)) + [0, 0, 1.5]
    aims = draw.uniform(-0.45, 0.45, origins.shape) * [1, 1, 0]
    rays = np.concatenate([origins, aims - origins], axis=1)
    question = asked(one, Mesh(vertices, faces), rays)
    built = one.build(question.mesh)
    count, seconds = 16, 0.0
    # Once without a clock: some compile themselves at first.
    one.timed(built, question.rays[:count])
    while True:
        _, seconds = one.timed(built, question.rays[:count])
        if seconds > 0.33 or count >= len(rays):
            # What else the machine does makes a run longer, never shorter.
            seconds = min([seconds, *(one.timed(built, question.rays[:count])[1] for _ in range(4))])
            return {"rays": count, "seconds": seconds, "faces": len(faces)}
        count = min(count * 4, len(rays))


_KINDS = {"family": _family, "law": _law, "speed": _speed}


def main(words: list[str]) -> None:
    """Answers all jobs of a file."""
    name, jobs, results = words
    one = peer(name)
    with open(results, "a", encoding="utf-8") as file:
        for job in json.loads(Path(jobs).read_text(encoding="utf-8")):
            kind = next(kind for kind in _KINDS if kind in job)
            try:
                answer = {"answer": _KINDS[kind](one, job)}
            except Unavailable as missing:
                answer = {"unavailable": str(missing)}
            except Exception as error:  # Whatever a peer raises is its answer.
                answer = {"refused": f"{type(error).__name__}: {error}".strip()}
            file.write(json.dumps(answer) + "\n")
            file.flush()


def work(name: str, jobs: list[Job], patience: float = _PATIENCE) -> list[dict[str, Any]]:
    """The answers of a peer to jobs: each has `answer`, `refused` with what the peer said, or `unavailable`.

    A process that dies at a job is followed by another one for the rest.
    """
    done: list[dict[str, Any]] = []
    with tempfile.TemporaryDirectory() as folder:
        results = Path(folder, "results")
        while len(done) < len(jobs):
            given = Path(folder, "jobs")
            given.write_text(json.dumps(jobs[len(done) :]), encoding="utf-8")
            results.write_text("", encoding="utf-8")
            words = [sys.executable, "-m", "raypencil.peers._worker", name, str(given), str(results)]
            try:
                code = run(words, stdout=DEVNULL, stderr=DEVNULL, timeout=patience).returncode
                why = f"its process ended with code {code}"
            except TimeoutExpired:
                why = f"it did not answer in {patience:g} s"
            lines = results.read_text(encoding="utf-8").splitlines()
            done += [json.loads(line) for line in lines if line.endswith("}")]
            if len(done) < len(jobs):
                done.append({"refused": why})
    return done


def counts_of(answer: dict[str, Any]) -> Counts | None:
    """The counts of a family's answer; ``None`` where the peer refused it."""
    return Counts(*answer["answer"]) if "answer" in answer else None


if __name__ == "__main__":
    main(sys.argv[1:])
