"""The two pictures of the page: what each peer loses as one number changes, and who is right and fast."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape
from textwrap import wrap

import numpy as np

from ._laws import LAWS
from ._measure import Measured

_FONT = 'font-family="sans-serif" font-size="11"'

#: Width of a value and height of a peer in the first picture.
_CELL, _ROW, _NAMES, _TOP = 9, 16, 225, 60


def _text(x: float, y: float, words: str, anchor: str = "start", more: str = "") -> str:
    return f'<text x="{x:g}" y="{y:g}" text-anchor="{anchor}" {more}>{escape(words)}</text>'


def _colour(share: float) -> str:
    """From pale, at hardly any wrong ray, to dark red, where all are."""
    low, high = np.array([255, 245, 235]), np.array([165, 20, 20])
    mixed = low + (high - low) * share
    return "#" + "".join(f"{round(float(part)):02x}" for part in mixed)


def _svg(width: float, height: float, parts: Sequence[str], title: str) -> str:
    head = f'<svg xmlns="http://www.w3.org/2000/svg" width="{width:g}" height="{height:g}" viewBox="0 0 {width:g} {height:g}"'
    back = f'<rect width="{width:g}" height="{height:g}" fill="white"/>'
    return "\n".join([f"{head} {_FONT}>", f"<title>{escape(title)}</title>", back, *parts, "</svg>"]) + "\n"


def laws_svg(measured: Sequence[Measured]) -> str:
    """A row for each peer, a block for each law: the darker, the more rays are wrong. Grey: it could not be asked."""
    parts: list[str] = []
    x = float(_NAMES)
    for law in LAWS.values():
        wide = _CELL * len(law.values)
        parts.append(_text(x, 16, law.name, more='font-weight="bold"'))
        parts += [_text(x, 28 + 10 * k, line, more='font-size="9"') for k, line in enumerate(wrap(law.axis, wide // 5))]
        parts.append(_text(x, _TOP - 4, f"{law.values[0]:g}", more='font-size="9"'))
        parts.append(_text(x + wide, _TOP - 4, f"{law.values[-1]:g}", "end", 'font-size="9"'))
        for row, one in enumerate(measured):
            y = _TOP + row * _ROW
            for k, (_, share) in enumerate(one.shares.get(law.name, [])):
                if share == 0:
                    # White is what is below.
                    continue
                fill = "#cccccc" if share is None else _colour(share)
                parts.append(f'<rect x="{x + k * _CELL:g}" y="{y:g}" width="{_CELL}" height="{_ROW - 2}" fill="{fill}"/>')
            parts.append(
                f'<rect x="{x:g}" y="{y:g}" width="{wide}" height="{_ROW - 2}" fill="none" stroke="#999999" stroke-width="0.5"/>'
            )
        x += wide + 14
    for row, one in enumerate(measured):
        parts.append(_text(_NAMES - 6, _TOP + row * _ROW + 11, one.peer.title, "end"))
    return _svg(x, _TOP + len(measured) * _ROW + 6, parts, "Share of wrong rays against one number")


def speed_svg(measured: Sequence[Measured]) -> str:
    """Wrong rays, of the hard ones, against rays a second."""
    left, top, wide, high = 60.0, 20.0, 640.0, 420.0
    shown = [(one, one.speed) for one in measured if one.speed]
    rates = [np.log10(speed) for _, speed in shown]
    low, up = (np.floor(min(rates)), np.ceil(max(rates))) if rates else (0.0, 1.0)
    most = max([one.total.wrong for one, _ in shown] + [1])

    def height(wrong: float) -> float:
        # Zero is a place of its own, and the rest is by the logarithm.
        return top + high - (0.0 if wrong == 0 else high * (0.08 + 0.9 * np.log10(1 + wrong) / np.log10(1 + most)))

    parts = [f'<rect x="{left}" y="{top}" width="{wide}" height="{high}" fill="none" stroke="#666666"/>']
    for power in range(int(low), int(up) + 1):
        x = left + wide * (power - low) / (up - low)
        parts.append(f'<line x1="{x:g}" x2="{x:g}" y1="{top:g}" y2="{top + high:g}" stroke="#dddddd"/>')
        parts.append(_text(x, top + high + 15, f"1e{power}", "middle"))
    for wrong in [0, 1, 10, 100, 1000]:
        if wrong <= most:
            parts.append(f'<line x1="{left:g}" x2="{left + wide:g}" y1="{height(wrong):g}" y2="{height(wrong):g}" stroke="#dddddd"/>')
            parts.append(_text(left - 6, height(wrong) + 4, str(wrong), "end"))
    parts.append(_text(left + wide / 2, top + high + 34, "rays a second on 8192 faces", "middle"))
    parts.append(_text(14, top + high / 2, "wrong of the hard rays", "middle", f'transform="rotate(-90 14 {top + high / 2:g})"'))
    taken: list[tuple[float, float]] = []
    for number, (one, speed) in enumerate(shown, 1):
        x, y = left + wide * (np.log10(speed) - low) / (up - low), height(one.total.wrong)
        at = y
        # Numbers that would lie on each other move up.
        while any(abs(at - other) < 10 and abs(x - place) < 16 for place, other in taken):
            at -= 10
        taken.append((x, at))
        fill = "#1a5fb4" if one.peer.registry == "here" else "#a51414"
        if at != y:
            parts.append(f'<line x1="{x:.1f}" x2="{x + 5:.1f}" y1="{y:.1f}" y2="{at:.1f}" stroke="{fill}" stroke-width="0.5"/>')
        parts.append(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3" fill="{fill}"/>')
        parts.append(_text(round(x + 5, 1), round(at + 3, 1), str(number), more=f'font-size="9" fill="{fill}"'))
        parts.append(_text(left + wide + 16, top + 4 + 13 * number, f"{number}  {one.peer.title}"))
    return _svg(left + wide + 230, max(top + high + 44, top + 20 + 13 * len(shown)), parts, "Wrong rays against rays a second")
