#!/usr/bin/env bash
# Runs a program of tests so that it says how long each test took: cargo's `runner` in .ci/run.
#
#     .ci/with_times.sh PROGRAM ARGUMENTS
#
# The option is not stable yet; the variable lets a stable toolchain take it, and changes nothing else.
exec env RUSTC_BOOTSTRAP=1 "$@" -Z unstable-options --report-time
