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

# The committed digest at -O0 and in release: same bits at any optimisation level
digest:
    cargo test --profile unoptimised -p raypencil-tests --test digest
    cargo test --release -p raypencil-tests --test digest

# All benchmarks
bench:
    cargo bench --workspace

# Validate both renderers on a mesh of your own (GLB, glTF or scene TOML)
yard MESH:
    cargo run --release --bin raypencil -- validate {{ quote(MESH) }} -o out/yard
