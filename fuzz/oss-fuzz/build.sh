#!/bin/bash -eu
# Builds every fuzz target for OSS-Fuzz, with the malformed inputs, and good files, as the corpus to start from.
cd "$SRC/raypencil"
cargo run --release -p raypencil-tests --features examples --example malformed_inputs fuzz/corpus
cargo fuzz build -O
built=fuzz/target/x86_64-unknown-linux-gnu/release
for target in fuzz/fuzz_targets/*.rs; do
    name=$(basename "$target" .rs)
    cp "$built/$name" "$OUT/"
    if [[ -d "fuzz/corpus/$name" ]]; then
        (cd "fuzz/corpus/$name" && zip -q -r "$OUT/${name}_seed_corpus.zip" .)
    fi
done
