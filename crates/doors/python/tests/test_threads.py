"""Python's lock is free while the engine works, and Ctrl-C is heard."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import raypencil
from raypencil._arrays import RayParts

#: Rays that take the exact answers some seconds, margins above all.
LONG = """
import numpy as np, raypencil, sys
mesh = raypencil.terrain.generate("smooth", 1, extent=8)
rays = np.zeros((400_000, 6)); rays[:, 0:2] = np.random.default_rng(0).uniform(-4, 4, (400_000, 2)); rays[:, 2] = 5
rays[:, 3:6] = [0.1, 0.2, -1]
many = np.tile(rays, (8, 1))
print("ready", flush=True)
"""


def long_question() -> tuple[raypencil.Mesh, np.ndarray]:
    scope: dict[str, object] = {}
    exec(LONG, scope)
    return scope["mesh"], scope["rays"]  # type: ignore[return-value]


def test_other_threads_run_during_the_work() -> None:
    mesh, rays = long_question()
    ticks, is_over = [], threading.Event()

    def tick() -> None:
        while not is_over.is_set():
            ticks.append(time.perf_counter())
            time.sleep(0.005)

    thread = threading.Thread(target=tick)
    thread.start()
    start = time.perf_counter()
    raypencil.cast(mesh, rays, query="all")
    took = time.perf_counter() - start
    is_over.set()
    thread.join()
    during = [one for one in ticks if start < one < start + took]
    assert took > 0.2, "the question is too short to tell"
    # With the lock held there would be none but at the ends.
    assert len(during) > took / 0.005 / 20 and max(np.diff(during)) < took / 2


def test_two_calls_overlap_and_answer_as_one() -> None:
    mesh, rays = long_question()
    answers: list[raypencil.CastResult] = []
    spans: list[tuple[float, float]] = []

    def work() -> None:
        start = time.perf_counter()
        answers.append(raypencil.cast(mesh, rays))
        spans.append((start, time.perf_counter()))

    threads = [threading.Thread(target=work) for _ in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert max(start for start, _ in spans) < min(end for _, end in spans)
    assert np.array_equal(answers[0].t, answers[1].t)


@pytest.mark.skipif(os.name != "posix", reason="signals of POSIX")
@pytest.mark.parametrize(
    "call",
    [
        "raypencil.cast(mesh, rays, margins=True)",
        "raypencil.judge(mesh, many, {'t': np.ones(len(many))})",
        "raypencil.validate(raypencil.Scene('pyramids'), judge='all')",
        "raypencil.drive('pyramids', with_='referee').run()",
    ],
)
def test_an_interrupt_is_heard_within_a_second(call: str) -> None:
    program = f"""{LONG}
import signal, time
# A job in the background of a shell ignores Ctrl-C, and its children do.
signal.signal(signal.SIGINT, signal.default_int_handler)
try:
    {call}
except KeyboardInterrupt:
    print("interrupted", flush=True)
    # The engine is as good as before.
    print(float(raypencil.cast(mesh, [0, 0, 9], [0, 0, -1]).ties), flush=True)
    import os; os._exit(7)
print("not interrupted", flush=True)
"""
    with subprocess.Popen([sys.executable, "-c", program], stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "ready\n"
        time.sleep(0.7)
        sent = time.perf_counter()
        process.send_signal(signal.SIGINT)
        assert process.stdout.readline() == "interrupted\n"
        assert time.perf_counter() - sent < 1.0
        assert float(process.stdout.readline()) >= 1
        assert process.wait(60) == 7


def test_a_callback_that_raises_ends_the_call(cube: raypencil.Mesh) -> None:
    class Enough(Exception):
        pass

    def enough(stage: str) -> None:
        raise Enough(stage)

    with pytest.raises(Enough, match="tree of 12 faces"):
        raypencil.cast(raypencil.Mesh(cube.vertices, cube.faces), [0, 0, 3], [0, 0, -1], progress=enough)
    with pytest.raises(Enough, match="casting 1 rays"):
        raypencil.cast(cube.build(), [0, 0, 3], [0, 0, -1], progress=enough)


def test_stages_are_told(small: raypencil.Scene) -> None:
    said: list[str] = []
    raypencil.validate(small, progress=said.append)
    assert said[0] == "scanline: rendering" and "tracer: rendering" in said and len(said) > 4


def test_progress_by_tqdm_is_written_where_errors_are(cube: raypencil.Mesh, capfd: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("tqdm")
    raypencil.cast(raypencil.Mesh(cube.vertices, cube.faces), [0, 0, 3], [0, 0, -1], progress=True)
    out, error = capfd.readouterr()
    assert out == "" and "tree of 12 faces" in error
    raypencil.cast(cube, [0, 0, 3], [0, 0, -1])
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize("shape", [(200_001,), (3, 70_000), (2, 150_000), (0,), ()])
def test_rays_that_are_copied_in_blocks_are_all_there(shape: tuple[int, ...]) -> None:
    given = np.random.default_rng(1).uniform(size=(*shape, 9))
    whole = RayParts(given, None).whole()
    assert np.array_equal(whole, given.reshape(-1, 9))
