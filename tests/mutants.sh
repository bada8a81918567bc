#!/usr/bin/env bash
# Runs random mutants of a kernel crate against its fast tests: tests/mutants.sh CRATE OUT [COUNT [SHARD]]
#   CRATE  scanline, tracer or referee
#   OUT    a folder for the output of cargo-mutants (mutants.out)
#   COUNT  the number of mutants to draw, 400 by default; every run draws the same ones
#   SHARD  K/N: part K of N, counted from 0
# The script mutates the sources in place: run it in a separate clone, one for each part.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

crate=$1 out=$2 count=${3:-400} shard=${4:-0/1}
declare -A tests=(
    [scanline]="--package raypencil-tests --lib --test light --test paper --test digest --test closed_form"
    [tracer]="--package raypencil-tests --lib --test flux --test visibility --test digest --test closed_form"
    [referee]="--lib --test digest --test verdicts --test light"
)

# shuf reads its random bytes from a fixed stream, so that every run draws the same mutants.
stream() { openssl enc -aes-256-ctr -pass "pass:$crate" -nosalt </dev/zero 2>/dev/null; }
draw() { shuf -n "$count" --random-source=<(stream); }

mkdir -p "$out"
{
    echo 'examine_re = ['
    cargo mutants --list --no-shuffle --package "raypencil-$crate" --colors never | sort | draw |
        sed -e 's/[][\.*^$+?(){}|]/\\&/g' -e "s/.*/'''^&\$''',/"
    echo ']'
    cat .cargo/mutants.toml
} >"$out/mutants.toml"

packages=("raypencil-$crate")
read -ra set <<<"${tests[$crate]}"
if [[ "${set[0]}" == --package ]]; then
    packages+=("${set[1]}")
    set=("${set[@]:2}")
fi
# Without a mutant the tests must pass. cargo-mutants would run them in the first package only. The flags are those of
# cargo-mutants, so that the build is reused.
RUSTFLAGS=--cap-lints=warn cargo nextest run --cargo-profile mutants "${packages[@]/#/--package=}" "${set[@]}"
exec cargo mutants --config "$out/mutants.toml" --in-place --package "raypencil-$crate" --baseline skip \
    --timeout 60 --build-timeout 300 --test-package "$(IFS=, && echo "${packages[*]}")" --shard "$shard" --output "$out" \
    "${set[@]/#/--cargo-arg=}"
