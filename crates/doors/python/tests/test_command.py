"""The command of the wheel."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import sysconfig
import time
from pathlib import Path

import pytest
from conftest import DATA, Command

import raypencil


def test_exit_codes_are_the_commands(command: Command) -> None:
    assert command("--version").stdout == f"raypencil {raypencil.__version__}\n"
    command("validate", "nowhere.toml", code=2)
    command("no-such-command", code=2)
    # Both sides miss: nothing is compared that could be right.
    command("cast", DATA / "rays/cube.obj", "--ray=9,9,9,1,0,0", "--with", "tracer", code=1)


def test_there_is_a_script() -> None:
    script = Path(sysconfig.get_path("scripts")) / "raypencil"
    done = subprocess.run([script, "--help"], capture_output=True, text=True, timeout=60)
    assert done.returncode == 0 and "Usage: raypencil" in done.stdout


def test_errors_say_the_same(command: Command, tmp_path: Path) -> None:
    (tmp_path / "bad.toml").write_text("version = 1\n[camera]\nfocal_length_mm = -6\n")
    screen = command("validate", "bad.toml", code=2).stderr
    with pytest.raises(raypencil.RaypencilError) as caught:
        raypencil.Scene(str(tmp_path / "bad.toml"))
    message = str(caught.value).rsplit("/", 1)[-1]
    assert message in screen.replace("\n  │ ", " ").replace("\n", " ").replace("  ", " ") or message.split(";")[0] in screen


@pytest.mark.skipif(os.name != "posix", reason="signals of POSIX")
def test_the_command_hears_ctrl_c(tmp_path: Path) -> None:
    words = [sys.executable, "-m", "raypencil", "validate", "facets", "--judge", "all", "-o", str(tmp_path / "out")]
    with subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        time.sleep(1.5)
        process.send_signal(signal.SIGINT)
        assert process.wait(10) == -signal.SIGINT
