#!/usr/bin/env bash
# An environment with everything that raypencil-peers asks: Python's packages, npm's in ENV/node, and the program that asks Rust's crates.
#
#   reference/peers/install.sh ENV [WHEEL]
#
# WHEEL is a built wheel of raypencil; without one the repository is built, for which a Rust toolchain is needed. PYTHON names the
# interpreter (python3.11, for which all packages are to be had). Without npm or cargo their programs are left out. What each step
# took, in seconds and in MB of ENV, goes to ENV/installed.tsv, from which the page of peers has it.
set -euo pipefail

usage="usage: install.sh ENV [WHEEL]"
environment=$(realpath -m -- "${1:?$usage}")
wheel=${2:+$(realpath -- "$2")}
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
if [[ -e $environment ]]; then
    echo "there is already $environment; expected the name of a new folder" >&2
    exit 2
fi

# megabytes: of what lies in the environment.
megabytes() {
    if [[ -d $environment ]]; then du -sm "$environment" | cut -f 1; else echo 0; fi
}

# step NAME COMMAND...: runs it, and notes its time and disk.
step() {
    local name=$1 start=$SECONDS before
    shift
    before=$(megabytes)
    "$@"
    printf '%s\t%d\t%d\n' "$name" $((SECONDS - start)) $(($(megabytes) - before)) | tee -a "$environment/installed.tsv"
}

step "an empty environment" "${PYTHON:-python3.11}" -m venv "$environment"
pip=("$environment/bin/python" -m pip install --quiet --disable-pip-version-check)
step "${wheel:+the wheel of }raypencil" "${pip[@]}" "${wheel:-.}"
step "Python's packages" "${pip[@]}" "${wheel:-.}[peers]"
# It asks for a trimesh before 4, and works with a later one.
step "ncollpyde" "${pip[@]}" --no-deps ncollpyde
if command -v npm >/dev/null; then
    mkdir -p "$environment/node"
    step "npm's packages" npm install --silent --no-audit --no-fund --prefix "$environment/node" \
        three three-mesh-bvh @babylonjs/core @dimforge/rapier3d-compat cannon-es jolt-physics
else
    echo "there is no npm: three.js, three-mesh-bvh, Babylon.js, Rapier, cannon-es and Jolt are left out" >&2
fi
if command -v cargo >/dev/null; then
    step "the program that asks crates" cargo install --quiet --locked --path reference/peers/rust --root "$environment"
else
    echo "there is no cargo: parry, bvh, obvhs and tinybvh are left out" >&2
fi
