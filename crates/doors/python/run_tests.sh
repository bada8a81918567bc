#!/usr/bin/env bash
# The tests of the Python package, from nothing: a fresh environment, `pip install .[test]`, the types, the tests.
#
#   crates/doors/python/run_tests.sh [ARGUMENTS OF PYTEST]
#
# PYTHON names the interpreter (python3). The environment and what cargo builds go to CARGO_TARGET_DIR (target).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../../.."

python=${PYTHON:-python3}
if ! command -v "$python" >/dev/null; then
    echo "there is no $python: the Python package is not tested" >&2
    exit 1
fi
target=${CARGO_TARGET_DIR:-$PWD/target}
export CARGO_TARGET_DIR=$target
environment=$target/python-tests
mkdir -p "$target"

# step NAME COMMAND...: runs it under its name, and says how long it took.
step() {
    local name=$1 start=$SECONDS
    shift
    printf -- '--> %s: %s\n' "$name" "$*"
    if "$@"; then
        printf -- '<-- %s: ok, %d s\n' "$name" $((SECONDS - start))
    else
        local code=$?
        printf -- '<-- %s: FAILED (exit code %d), %d s\n' "$name" "$code" $((SECONDS - start)) >&2
        exit "$code"
    fi
}

step "environment" "$python" -m venv --clear "$environment"
step "build and install" "$environment/bin/python" -m pip install --quiet --disable-pip-version-check ".[test]"
step "types" "$environment/bin/python" -m mypy
# Not from the sources beside it: what is tested is what was installed.
step "tests" "$environment/bin/python" -m pytest "$@"
