"""Where the LLVM is that Mitsuba compiles its kernels with."""

import ctypes.util
import os
from glob import glob

# Mitsuba 3.9.1 refuses 14, and its kernels end the process with 15 and 16.
PATTERNS = ["/usr/lib/*/libLLVM.so.19*", "/usr/lib/*/libLLVM-19.so*", "/usr/lib/llvm-19/lib/libLLVM*.so*"]


def locate() -> None:
    """Points Mitsuba at LLVM 19, unless DRJIT_LIBLLVM_PATH already points somewhere."""
    if os.environ.get("DRJIT_LIBLLVM_PATH"):
        return
    found = [path for pattern in PATTERNS for path in sorted(glob(pattern))] or [ctypes.util.find_library("LLVM-19")]
    if not found[0]:
        raise SystemExit(
            "Mitsuba's llvm_ad_mono needs LLVM 19: install Debian's package libllvm19, "
            "or set DRJIT_LIBLLVM_PATH to its libLLVM.so"
        )
    os.environ["DRJIT_LIBLLVM_PATH"] = found[0]
