"""Images of a recording: NPY if present, else PNG with 16 bits of grey, decoded here without any package."""

import struct
import zlib
from pathlib import Path

import numpy as np

from trouble import Trouble


def name(frame, beam, step, together):
    """`000012-beam0`, `000012-all`, `000012-scan007-beam1`; step is -1 outside scans."""
    scan = f"-scan{step:03d}" if step >= 0 else ""
    return f"{frame:06d}{scan}-" + ("all" if together else f"beam{beam}")


def load(folder, stem, shape):
    """The image `stem`, as an array (rows, columns) of its own type."""
    npy, png = Path(folder) / f"{stem}.npy", Path(folder) / f"{stem}.png"
    if npy.exists():
        try:
            image = np.load(npy)
        except (ValueError, OSError, EOFError) as error:
            raise Trouble(f"{npy}: not a readable NPY file ({error})") from None
    elif png.exists():
        image = read_png(png)
    else:
        raise Trouble(f"{npy}: no such image, nor {png.name}; record with --record npy or png")
    if image.shape != shape:
        raise Trouble(f"{npy if npy.exists() else png}: shape {image.shape}, but the camera has {shape}")
    return image


def read_png(path):
    """A PNG with one channel of 16 bits, not interlaced, as uint16."""
    data = Path(path).read_bytes()
    if data[:8] != b"\x89PNG\r\n\x1a\n":
        raise Trouble(f"{path}: not a PNG file")
    place, packed, header = 8, [], None
    while place + 8 <= len(data):
        size, kind = struct.unpack(">I4s", data[place:place + 8])
        body = data[place + 8:place + 8 + size]
        if len(body) < size:
            raise Trouble(f"{path}: ends within a chunk")
        if kind == b"IHDR":
            header = struct.unpack(">IIBBBBB", body)
        elif kind == b"IDAT":
            packed.append(body)
        place += size + 12
    if header is None or header[2:4] != (16, 0) or header[6] != 0:
        raise Trouble(f"{path}: expected 16 bits of grey, not interlaced")
    width, height = header[:2]
    try:
        raw = np.frombuffer(zlib.decompress(b"".join(packed)), np.uint8)
    except zlib.error as error:
        raise Trouble(f"{path}: {error}") from None
    if raw.size != height * (2 * width + 1):
        raise Trouble(f"{path}: {raw.size} bytes of pixels, expected {height * (2 * width + 1)}")
    lines = raw.reshape(height, 2 * width + 1)
    kinds, rest = lines[:, 0], lines[:, 1:]
    out = np.zeros((height, 2 * width), np.uint8)
    above = np.zeros(2 * width, np.uint8)
    for j in range(height):
        out[j] = above = unfiltered(kinds[j], rest[j], above)
    return out.reshape(height, width, 2).astype(np.uint16) @ np.array([256, 1], np.uint16)


def unfiltered(kind, line, above):
    """Undoes one of PNG's five filters on one line; two bytes make a pixel."""
    if not line.any() and (kind in (0, 1) or not above.any()):
        return np.zeros_like(line)  # most lines are dark; this saves the slow filters below
    if kind == 0:
        return line.copy()
    if kind == 1:
        return np.cumsum(line.reshape(-1, 2), axis=0, dtype=np.uint8).reshape(-1)
    if kind == 2:
        return line + above
    if kind not in (3, 4):
        raise Trouble(f"a PNG line has the unknown filter {kind}")
    done = [0, 0]  # the pixel to the left of the first one
    up = [0, 0] + above.tolist()
    for k, value in enumerate(line.tolist()):
        a, b, c = done[k], up[k + 2], up[k]
        if kind == 3:
            guess = (a + b) >> 1
        else:
            p = a + b - c
            pa, pb, pc = abs(p - a), abs(p - b), abs(p - c)
            guess = a if pa <= pb and pa <= pc else b if pb <= pc else c
        done.append((value + guess) & 255)
    return np.array(done[2:], np.uint8)
