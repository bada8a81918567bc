#!/usr/bin/env bash
# Mutants of a kernel crate, drawn at random, against its fast tests: tests/mutants.sh CRATE OUT [COUNT [SHARD]]
#   CRATE  scanline, tracer or referee
#   OUT    a folder for what cargo-mutants writes (mutants.out)
#   COUNT  how many mutants to draw, 400 unless told; the same ones every time
#   SHARD  K/N: part K, from 0, of N parts
# The sources are mutated in place: run it in a clone of its own, one clone per part.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

crate=$1 out=$2 count=${3:-400} shard=${4:-0/1}
declare -A tests=(
    [scanline]="--package raypencil-tests --lib --test light --test paper --test digest --test closed_form"
    [tracer]="--package raypencil-tests --lib --test flux --test visibility --test digest --test closed_form"
    [referee]="--lib --test digest --test verdicts --test light"
)

# The same draw every time: shuf reads its randomness from a fixed stream.
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
# Without a mutant they must pass. (cargo-mutants would try that in the first package alone. With its
# flags, or everything is built twice.)
RUSTFLAGS=--cap-lints=warn cargo nextest run --cargo-profile mutants "${packages[@]/#/--package=}" "${set[@]}"
exec cargo mutants --config "$out/mutants.toml" --in-place --package "raypencil-$crate" --baseline skip \
    --timeout 60 --build-timeout 300 --test-package "$(IFS=, && echo "${packages[*]}")" --shard "$shard" --output "$out" \
    "${set[@]/#/--cargo-arg=}"
