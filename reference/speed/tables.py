"""What both pages of speed are made of: numbers, tables, and the name of the processor."""

from __future__ import annotations

import platform


def number(value: float | None) -> str:
    """Three digits, or whole if it has more of them; `-` where nothing was measured."""
    return "-" if value is None else f"{value:,.0f}" if value >= 99.5 else f"{value:.3g}"


def table(head: list[str], rows: list[list[str]]) -> str:
    """A table of Markdown: a column of names, and columns of numbers."""
    lines = ["| " + " | ".join(head) + " |", "| --- |" + " ---: |" * (len(head) - 1)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


def processor() -> str:
    """The processor's name, as well as the system knows it."""
    try:
        with open("/proc/cpuinfo") as lines:
            return next(line.split(":", 1)[1].strip() for line in lines if line.startswith("model name"))
    except (OSError, StopIteration):
        return platform.processor() or platform.machine()
