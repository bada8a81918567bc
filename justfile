# The project's everyday commands; `just` lists them. `.ci/run` runs every check in order.

_default:
    @just --list --unsorted

# All checks, as before a merge
ci:
    .ci/run

# All tests
test:
    cargo test --workspace

# Format, clippy and docs, warnings refused
lint:
    cargo fmt --all --check
    cargo clippy --workspace --all-targets -- -D warnings
    RUSTDOCFLAGS="-D warnings" cargo doc --workspace --no-deps

# Licences, sources and duplicates of the dependencies
deny:
    cargo deny check bans licenses sources

# The committed digest and packs at -O0 and in release: same bits at any optimisation level
digest:
    cargo test --profile unoptimised -p raypencil-tests --test digest --test packs
    cargo test --release -p raypencil-tests --test digest --test packs

# The packs of data/packs, made again, and the programs of reference/ against them
packs:
    cargo run --release --bin raypencil -- pack data/scenes/pyramids-small.toml -o data/packs/pyramids
    cargo run --release --bin raypencil -- pack data/scenes/facets-small.toml -o data/packs/facets
    reference/run.sh target/release/raypencil

# The largest errors in ulp, as the first half of docs/evidence/results.md; YARD is a mesh of your own
results YARD:
    cargo run --release -p raypencil-harness --example results -- pyramids facets {{ quote(YARD) }}

# What the rover finds of what is there, as the tables of its second half
truth:
    cargo run --release -p raypencil-harness --example truth

# What catches each planted fault, and the smallest scene that does: docs/evidence/injected-faults.md
planted-faults:
    cargo run --release -p raypencil-tests --example planted_faults > docs/evidence/injected-faults.md

# Pictures of the presets of generated ground: docs/figures/ground-*.svg
portraits:
    cargo run --release -p raypencil-harness --example portraits -- docs/figures

# The property tests on CASES cases each that nobody has tried
properties CASES:
    PROPTEST_CASES={{ CASES }} PROPTEST_RNG_SEED="$(od -An -N6 -tu8 /dev/urandom | tr -d ' ')" cargo test --release -p raypencil-tests --test properties

# Mutants of a kernel crate (scanline, tracer, referee) against its fast tests, in a clone: docs/evidence/mutants.md
mutants CRATE:
    rm -rf out/mutants/clone && git clone --quiet . out/mutants/clone
    out/mutants/clone/tests/mutants.sh {{ CRATE }} "$PWD/out/mutants/{{ CRATE }}"

# The hostile files, as docs/evidence/malformed-inputs.md lists them
hostile:
    cargo run --release -p raypencil-tests --example hostile > docs/evidence/malformed-inputs.md

# Any bytes for SECONDS at a reader, starting from the hostile files: scene_toml, resolved_scene, glb, dem, exr, npy,
# pfm, manifest, candidate. Needs a nightly compiler and cargo-fuzz (cargo install cargo-fuzz --locked); fuzz/README.md
fuzz TARGET SECONDS:
    cargo run --release -p raypencil-tests --example hostile fuzz/corpus
    cd fuzz && cargo +nightly fuzz run {{ TARGET }} -- -rss_limit_mb=512 -timeout=5 -max_total_time={{ SECONDS }}

# All benchmarks
bench:
    cargo bench --workspace

# Validate both renderers on a mesh of your own (GLB, glTF or scene TOML)
yard MESH:
    cargo run --release --bin raypencil -- validate {{ quote(MESH) }} -o out/yard
