"""The graphics card that some peers run on."""

from __future__ import annotations

import ctypes
import functools
import sys

from .._peer import Unavailable


@functools.cache
def card() -> str:
    """The name of the first card that CUDA's driver knows, such as ``NVIDIA H200``.

    Raises:
        Unavailable: there is no driver or no card.
    """
    try:
        driver = ctypes.CDLL("nvcuda.dll" if sys.platform == "win32" else "libcuda.so.1")
    except OSError:
        raise Unavailable("it needs a graphics card with CUDA, and there is no driver of one here") from None
    first, name = ctypes.c_int(), ctypes.create_string_buffer(256)
    # Each call tells 0 where it worked.
    if driver.cuInit(0) or driver.cuDeviceGet(ctypes.byref(first), 0) or driver.cuDeviceGetName(name, len(name), first):
        raise Unavailable("it needs a graphics card with CUDA, and its driver finds none here")
    return name.value.decode()
