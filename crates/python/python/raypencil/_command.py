"""The command ``raypencil``, which is the same program as the one that Rust builds."""

from __future__ import annotations

import signal
import sys

from . import _raypencil


def main() -> int:
    """Runs the command with the arguments of this process. Returns its exit code."""
    # Python would hear Ctrl-C after the command only.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    return _raypencil.command(["raypencil", *sys.argv[1:]])
