"""Arrays as `raypencil check` reads them."""

from pathlib import Path

import numpy as np


def write(out: Path, sensor: str, channels: dict[str, np.ndarray]) -> None:
    """One NPY file for each channel of a sensor, in single precision where it is a real number."""
    (out / sensor).mkdir(parents=True, exist_ok=True)
    for name, values in channels.items():
        kept = values.astype("<f4") if values.dtype.kind == "f" else values
        np.save(out / sensor / f"{name}.npy", kept)
