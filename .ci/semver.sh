#!/usr/bin/env bash
# Whether the public items of the crate `raypencil`, the door, still fit those of the last release, by its tag. Before the first
# tag there is nothing to compare with.
#
#     .ci/semver.sh
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

if ! tag=$(git describe --tags --abbrev=0 --match 'v*' 2>/dev/null); then
    echo "There is no tag of a release yet: no public item is compared."
    exit 0
fi
# This version: another one may know other rules.
version=0.51.0
if [[ "$(cargo semver-checks --version 2>/dev/null)" != "cargo-semver-checks $version" ]]; then
    # Unoptimised: it runs for seconds.
    cargo install cargo-semver-checks --version "$version" --debug --locked
fi
cargo semver-checks --package raypencil --baseline-rev "$tag"
