#!/usr/bin/env bash
# An environment with everything that raypencil-peers asks: Python's packages, npm's in ENV/node, and the program that asks Rust's crates.
#
#   reference/peers/install.sh ENV [WHEEL]
#
# WHEEL is a built wheel of raypencil; without one the repository is built, for which a Rust toolchain is needed. PYTHON names the
# interpreter (python3.11, for which all packages are to be had). Without npm or cargo their programs are left out.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

environment=${1:?usage: install.sh ENV [WHEEL]}
"${PYTHON:-python3.11}" -m venv "$environment"
pip=("$environment/bin/python" -m pip install --quiet --disable-pip-version-check)
"${pip[@]}" "${2:-.}[peers]"
# It asks for a trimesh before 4, and works with a later one.
"${pip[@]}" --no-deps ncollpyde
if command -v npm >/dev/null; then
    mkdir -p "$environment/node"
    npm install --silent --no-audit --no-fund --prefix "$environment/node" \
        three three-mesh-bvh @babylonjs/core @dimforge/rapier3d-compat cannon-es jolt-physics
else
    echo "there is no npm: three.js, three-mesh-bvh, Babylon.js, Rapier, cannon-es and Jolt are left out" >&2
fi
if command -v cargo >/dev/null; then
    cargo install --quiet --locked --path reference/peers/rust --root "$environment"
else
    echo "there is no cargo: parry, bvh, obvhs and tinybvh are left out" >&2
fi
du -sh "$environment"
