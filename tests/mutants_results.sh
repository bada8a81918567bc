# What the runs of tests/mutants.sh found. Read by `source`.

# Prints each drawn mutant and its outcomes, one line each: FIRST LAST NAME, separated by tabs. An outcome is caught,
# timeout, missed or unviable, or - without a result. The runs sort by their time. What is not drawn any more is left out.
mutants_results() {
    local results=$1 run outcome
    {
        for run in "$results"/run-*/; do
            # Without it cargo-mutants did not begin, and the lists are what it was told to leave out.
            [[ -e $run/mutants.out/lock.json ]] || continue
            for outcome in caught timeout missed unviable; do
                [[ -e $run/mutants.out/$outcome.txt ]] && sed "s/^/$outcome\t/" "$run/mutants.out/$outcome.txt"
            done
        done
        sed 's/^/-\t/' "$results/drawn.txt"
    } | awk -F '\t' '
        $1 != "-" { if (!($2 in first)) first[$2] = $1; last[$2] = $1; next }
        { print ($2 in first ? first[$2] : "-") "\t" ($2 in last ? last[$2] : "-") "\t" $2 }
    '
}

mutants_without_result() { mutants_results "$1" | awk -F '\t' '$2 == "-" { print $3 }'; }
mutants_missed() { mutants_results "$1" | awk -F '\t' '$2 == "missed" { print $3 }'; }
