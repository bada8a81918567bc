#!/usr/bin/env bash
# Tests random mutants of a crate: tests/mutants.sh CRATE [PASS [SHARD]]
#   CRATE  scene, scanline, tracer, referee, sensor, terrain, rover, judge or scene-io
#   PASS   first: the mutants without a result, against the crate's fast tests (the default)
#          again: those that were missed so far, against the same tests (after new tests were written)
#   SHARD  K/N: part K of N, counted from 0; parts can run at the same time, each in a clone of its own
#
# The results lie in out/mutants/CRATE: drawn.txt, and a folder of cargo-mutants for each run. A run can be interrupted at
# any time. The next one goes on where it stopped. tests/mutation_scores.sh counts the results.
#
# cargo-mutants changes the sources in place, so every part works in a clone of the last commit.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source tests/mutants_results.sh

crate=$1 pass=${2:-first} shard=${3:-0/1}
part=${shard%/*} parts=${shard#*/}

# The fast tests of a crate: they take some ten seconds with their build. `--package` names a second package with tests;
# `-E` is a filter of nextest. Left out are whole drives of the rover, ten seconds and more by themselves.
all='all()'
whole="package(=raypencil-$crate)|test(/^digest::/)|test(/^closed_form::/)"
declare -A fast=(
    [scanline]="--package raypencil-tests -E $whole"
    [tracer]="--package raypencil-tests -E $whole"
    [referee]="-E not(test(/^it::(cast|cast_margins|cast_ruling|margins|visibility_margins)::/))"
    [scene]="-E $all"
    [sensor]="-E $all"
    [rover]="-E not(test(/^it::(drive|pyramids)::/))"
    [judge]="-E $all"
    [scene-io]="-E $all"
    [terrain]="-E $all"
)
# How many mutants are drawn. Some do not compile, and at least 80 that do shall be left.
declare -A counts=([scanline]=400 [tracer]=400 [referee]=400 [scene]=125 [scene-io]=115)
count=${counts[$crate]:-100}
chosen=${fast[$crate]:-}
case $pass in first | again) ;; *) chosen= ;; esac
if [[ -z $chosen ]]; then
    echo "no tests are listed for the pass '$pass' of the crate '$crate'" >&2
    exit 2
fi

results=$PWD/out/mutants/$crate
clone=$PWD/out/mutants/clone
if [[ $parts != 1 ]]; then clone+=-$part-of-$parts; fi
mkdir -p "$results"
exec 9>"$clone.lock"
flock --nonblock 9 || { echo "another run works in $clone" >&2 && exit 2; }
# A run that was killed leaves a mutant in the sources: the reset removes it. The build stays.
[[ -d $clone ]] || git clone --quiet . "$clone"
git -C "$clone" fetch --quiet origin "$(git rev-parse HEAD)"
git -C "$clone" reset --quiet --hard FETCH_HEAD
cd "$clone"
# A build folder of its own: in one that another checkout uses too, cargo takes the builds of the two for each other's.
mkdir -p target
export CARGO_TARGET_DIR
CARGO_TARGET_DIR=$(realpath target)

# shuf reads its random bytes from a fixed stream, whose seed is the crate's name: every run draws the same mutants.
stream() { openssl enc -aes-256-ctr -pass "pass:$crate" -nosalt </dev/zero 2>/dev/null; }
cargo mutants --list --no-shuffle --package "raypencil-$crate" --colors never | sort >"$results/all.$part.txt"
draw() { shuf -n "$count" --random-source=<(stream) "$@"; }
case $crate in
    # shuf draws others from a pipe than from a file. These were drawn first, from a pipe: their draws stay as they are.
    scanline | tracer | referee | scene) cat "$results/all.$part.txt" | draw ;;
    *) draw "$results/all.$part.txt" ;;
esac >"$results/drawn.$part.tmp"
if [[ -e $results/drawn.txt ]] && ! cmp -s "$results/drawn.$part.tmp" "$results/drawn.txt"; then
    echo "the code of $crate changed, so other mutants are drawn: remove $results and begin anew" >&2
    exit 2
fi
mv "$results/drawn.$part.tmp" "$results/drawn.txt"

case $pass in
    first) mutants_without_result "$results" ;;
    again) mutants_missed "$results" ;;
esac | awk -v part="$part" -v parts="$parts" -v drawn="$results/drawn.txt" '
    # The place in the drawn list decides the part, so that parts never share a mutant.
    BEGIN { while ((getline line < drawn) > 0) place[line] = n++ }
    place[$0] % parts == part
' >"$results/todo.$part.txt"
left=$(wc -l <"$results/todo.$part.txt")
echo "$crate, $pass pass, part $part of $parts: $left mutants left"
if [[ $left == 0 ]]; then exit 0; fi

# cargo-mutants can leave out by name what an earlier run caught (--iterate). It is told that of all that is not left.
# (A filter by --re would not do: it does not hold for mutants that leave out a field.)
run=$results/run-$(date -u +%Y%m%dT%H%M%S)-$pass-$part-of-$parts
mkdir -p "$run/mutants.out"
grep -vxFf "$results/todo.$part.txt" "$results/all.$part.txt" >"$run/mutants.out/caught.txt" || true

packages=("raypencil-$crate")
read -ra set <<<"$chosen"
if [[ ${set[0]} == --package ]]; then
    packages+=("${set[1]}")
    set=("${set[@]:2}")
fi
# Without a mutant the tests must pass. cargo-mutants would run them in the first package only. The flags are those of
# cargo-mutants, so that the build is reused.
RUSTFLAGS=--cap-lints=warn cargo nextest run --cargo-profile mutants "${packages[@]/#/--package=}" "${set[@]}"
code=0
cargo mutants --iterate --in-place --package "raypencil-$crate" --baseline skip \
    --timeout 60 --build-timeout 300 --test-package "$(IFS=, && echo "${packages[*]}")" --output "$run" \
    "${set[@]/#/--cargo-arg=}" || code=$?
# 2: some were missed; 3: some never ended. Both are results.
if [[ $code != 0 && $code != 2 && $code != 3 ]]; then exit "$code"; fi
