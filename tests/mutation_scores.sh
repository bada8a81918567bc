#!/usr/bin/env bash
# Prints the table of mutation scores of the named crates, or of all: tests/mutation_scores.sh [--run] [CRATE ...]
# It counts the recorded results of tests/mutants.sh. With --run it lets that script test what has no result yet first.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source tests/mutants_results.sh

run=
if [[ ${1:-} == --run ]]; then
    run=yes
    shift
fi
if [[ $# == 0 ]]; then set -- scene scanline tracer referee sensor terrain rover judge scene-io; fi
if [[ $run ]]; then
    for crate in "$@"; do
        tests/mutants.sh "$crate" first >&2
    done
fi

echo '| crate | drawn | without result | viable | caught | timeouts | missed at first | missed now | score |'
echo '| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |'
for crate in "$@"; do
    results=out/mutants/$crate
    if [[ ! -e $results/drawn.txt ]]; then
        echo "| $crate | not yet run | | | | | | | |"
        continue
    fi
    # A mutant that never ends counts as caught. One that does not compile is not viable.
    mutants_results "$results" | awk -F '\t' -v crate="$crate" '
        { first[$1]++; last[$2]++ }
        END {
            found = last["caught"] + last["timeout"]
            viable = found + last["missed"]
            score = viable ? sprintf("%.1f %%", 100 * found / viable) : ""
            printf "| %s | %d | %d | %d | %d | %d | %d | %d | %s |\n", crate, NR, last["-"], viable,
                last["caught"], last["timeout"], first["missed"], last["missed"], score
        }
    '
done
