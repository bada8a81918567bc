# The project's everyday commands; `just` lists them. `.ci/run` runs every check in order.

# Chromium without a window
chromium := "chromium --headless --no-sandbox --hide-scrollbars --use-gl=angle --use-angle=swiftshader --enable-unsafe-swiftshader --virtual-time-budget=60000"

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
    cargo clippy --workspace --all-targets --all-features -- -D warnings
    RUSTDOCFLAGS="-D warnings" cargo doc --workspace --no-deps

# The documents as a book: out/book/index.html
book:
    mdbook build

# Licences, sources and duplicates of the dependencies
deny:
    cargo deny check bans licenses sources

# The committed digest and packs at -O0 and in release: the bits are the same at any optimisation level
digest:
    cargo test --profile unoptimised -p raypencil-tests --test same_bits
    cargo test --release -p raypencil-tests --test same_bits

# Every number of both renderers and of a drive by the unoptimised and by the optimised program
same-bits:
    cargo build --profile unoptimised --bin raypencil
    cargo build --release --bin raypencil
    .ci/same_bits.sh target/unoptimised/raypencil target/release/raypencil

# The study of docs/designs.md: its drives, its tables (out/designs/tables.md, docs/evidence/designs.csv), its charts; an hour or two on
# two cores; goes on where it was interrupted. `just seeds` comes first: its drives are rows of these tables
designs:
    cargo build --release --bin raypencil
    just _design pitch pitch crevassed,pathfinder 4 drive.scan_steps=26
    just _design heights heights pathfinder 1:4:1 drive.scan_steps=26 \
        --chart truth.clear_way_mean_m,beam.0.pitch_down_deg,beam.0.position_m --chart truth.upper_bound.clear_way_mean_m,beam.0.pitch_down_deg,beam.0.position_m
    just _design scans scans pathfinder 1:4:1 drive.scan_steps=26
    just _design steps steps pathfinder 3:4:1
    just _design sun sun pathfinder 4 drive.scan_steps=26
    just _design heights-again heights-again pathfinder 11:14:1 drive.scan_steps=26
    just _design heights-again-crevassed heights-again crevassed 11:14:1 drive.scan_steps=26
    just _design scans-again scans-again pathfinder 11:14:1 drive.scan_steps=26
    just _design scans-again-crevassed scans-again crevassed 11:14:1 drive.scan_steps=26
    just _design steps-again steps pathfinder 11:14:1
    just _design sun-again sun-again pathfinder 11:12:1 drive.scan_steps=26
    just _design rate rate pathfinder 1:4:1 drive.scan_steps=26
    just _design rate-again rate pathfinder 11:14:1 drive.scan_steps=26
    just design-tables out/designs out/seeds
    cp out/designs/heights/charts/truth.clear_way_mean_m-over-beam.0.pitch_down_deg-by-beam.0.position_m.svg docs/figures/designs-clear-way.svg
    cp out/designs/heights/charts/truth.upper_bound.clear_way_mean_m-over-beam.0.pitch_down_deg-by-beam.0.position_m.svg docs/figures/designs-clear-way-bound.svg

# The tables of the study, from the sweeps' folders: tables.md in STUDY, and docs/evidence/designs.csv
design-tables STUDY SEEDS:
    python3 reference/rover/designs.py P={{ STUDY }}/pitch/table.csv \
        H={{ STUDY }}/heights/table.csv H={{ STUDY }}/heights-again/table.csv H={{ STUDY }}/heights-again-crevassed/table.csv \
        C={{ STUDY }}/scans/table.csv C={{ STUDY }}/scans-again/table.csv C={{ STUDY }}/scans-again-crevassed/table.csv \
        T={{ STUDY }}/steps/table.csv T={{ STUDY }}/steps-again/table.csv S={{ STUDY }}/sun/table.csv \
        S={{ STUDY }}/sun-again/table.csv A={{ STUDY }}/rate/table.csv A={{ STUDY }}/rate-again/table.csv N={{ SEEDS }}/table.csv \
        --pair H9,H3 --pair H9,H1 --pair H7,H1 --pair H3,H1 --pair H5,H4 --pair H6,H5 --pair H9,H8 --pair H4,C1 --pair H6,C2 \
        --pair T1,H4 --pair T2,H9 --pair S3,S2 --pair A1,A2 --pair A3,A2 --pair A4,A5 --pair A6,A5 --pair A7,A8 --pair A9,A8 --pair A5,A2 \
        --pair A8,A2 --pair A9,A3 --pair N2,N1 --pair N3,N2 --drives docs/evidence/designs.csv -o {{ STUDY }}/tables.md

_design NAME LIST PRESETS SEEDS *MORE:
    target/release/raypencil sweep data/designs/rover.toml --list data/designs/{{ LIST }}.csv --set terrain.generate.preset={{ PRESETS }} \
        --set terrain.generate.seed={{ SEEDS }} --set drive.scans=true {{ if MORE == "" { "" } else { "--set " + MORE } }} --do drive \
        -o out/designs/{{ NAME }}

# The rover with a scan on ten grounds of each kind, without noise, with that of the camera, and with that of the sensors, and exact eyes
# beside each: out/seeds/seeds.md. 180 drives, hours on two cores; goes on where it was interrupted
seeds:
    cargo run --release --bin raypencil -- sweep data/designs/rover.toml --list data/designs/noise.csv \
        --set terrain.generate.preset=smooth,viking1,pathfinder,crater_field,crevassed,worst --set terrain.generate.seed=1:10:1 \
        --set drive.scans=true --set drive.scan_steps=26 --do drive -o out/seeds
    python3 reference/rover/seeds.py out/seeds/table.csv -o out/seeds/seeds.md

# Thickness, power, noise and pitch, one at a time on all presets, ten seeds each: days; no page shows it yet
designs-wide:
    cargo run --release --bin raypencil -- sweep data/designs/rover.toml --list data/designs/runs.csv \
        --set terrain.generate.preset=smooth,viking1,pathfinder,crater_field,crevassed,worst --set terrain.generate.seed=1:10:1 \
        --set drive.scans=true --set drive.scan_steps=26 --do drive -o out/designs-wide

# The Python package into a fresh environment; its tests and its types
python:
    crates/doors/python/run_tests.sh

# Writes the packs of data/packs again, and runs the programs of reference/ on them
packs:
    cargo run --release --bin raypencil -- pack data/scenes/packs/pyramids.toml --pack-version 2.0.0 --licence CC0-1.0 -o data/packs/pyramids
    cargo run --release --bin raypencil -- pack data/scenes/packs/facets.toml --pack-version 2.0.0 --licence CC0-1.0 -o data/packs/facets
    cargo run --release --bin raypencil -- pack data/scenes/packs/hard.toml --pack-version 2.0.0 --licence CC0-1.0 -o data/packs/hard
    cargo run --release --bin raypencil -- pack --input -o data/packs/input
    reference/run.sh target/release/raypencil

# The largest errors in ulp, as in the first half of docs/evidence/results.md; MESH is a mesh of your own
results MESH:
    cargo run --release -p raypencil --features examples --example results -- pyramids facets {{ quote(MESH) }}

# The confusion matrices of the rover's detections, as in the second half of that page
truth:
    cargo run --release -p raypencil --features examples --example truth

# How large a mistake passes: docs/evidence/slack.md, with the worst of so many blind packs; five minutes for 12 on two cores
slack SEEDS="12":
    cargo run --release -p raypencil --features examples --example slack -- {{ SEEDS }} > docs/evidence/slack.md
    just stamp docs/evidence/slack.md 'just slack {{ SEEDS }}'

# The times of raypencil and of Embree on the same rays: docs/speed.md. MESH: a mesh of your own beside the generated grounds
speed MESH="":
    cargo build --release -p raypencil --features examples --example speed
    python3 reference/speed/speed.py target/release/examples/speed {{ if MESH == "" { "" } else { "--mesh " + quote(MESH) } }} -o docs/speed.md

# The times of any rays from Python, beside Embree, Open3D and Warp where they are installed: docs/evidence/speed.md. PYTHON has raypencil
speed-rays PYTHON="python3" *ARGUMENTS:
    {{ PYTHON }} reference/speed/rays.py {{ ARGUMENTS }} -o docs/evidence/speed.md

# Which tables and figures of the documents are older than the rules that they show; a test fails on these
stale:
    cargo run -p raypencil-tests --features examples --example stale

# After a table was made again: its stamp in PAGE, of the command MADE_BY, gets the fingerprints of now
stamp PAGE MADE_BY:
    cargo run -p raypencil-tests --features examples --example stale -- {{ quote(PAGE) }} {{ quote(MADE_BY) }}

# The detection of each injected fault, and the smallest scene that reveals it: docs/evidence/injected-faults.md
injected-faults:
    cargo run --release -p raypencil-tests --features examples --example injected_faults > docs/evidence/injected-faults.md

# The reference of the command line, from the program itself: docs/reference/commands
reference:
    cargo run --bin raypencil -- reference -o docs/reference/commands

# The pictures of reports: of a wrong candidate in README.md, and of the paper's approximations. Needs Chromium
report-figures:
    cargo build --release --bin raypencil
    target/release/raypencil pack data/scenes/pyramids-small.toml --no-bench -o out/figures/pack
    target/release/raypencil render data/scenes/pyramids-small.toml --with scanline --switch place=paper --format npy -o out/figures/subtle
    -target/release/raypencil check out/figures/pack out/figures/subtle -o out/figures/checked
    {{ chromium }} --window-size=1280,1380 --screenshot=docs/figures/disagreement.png "file://$PWD/out/figures/checked/report.html#beam-0/117,3/visible.V"
    target/release/raypencil validate pyramids --with scanline-paper,tracer --thickness 80 -o out/figures/paper
    {{ chromium }} --window-size=1280,1480 --screenshot=docs/figures/report.png "file://$PWD/out/figures/paper/report.html"

# Figures 11 to 16 of the paper, by the rules as printed and without scans: out/figures/pyramids and out/figures/facets
# (docs/theory/paper.md)
figures:
    cargo run --release --bin raypencil -- drive pyramids --as-printed --set drive.scans=false --set drive.obstacles_every_frames=25 -o out/figures/pyramids
    cargo run --release --bin raypencil -- drive facets --as-printed --set drive.scans=false --set drive.obstacles_every_frames=25 -o out/figures/facets

# Times of the cold build, of rebuilds and of the tests: docs/evidence/build-times.md. An hour on two cores with nothing beside it
build-times:
    .ci/build_times.py

# Sizes of reports and the time to their first picture, as in docs/evidence/page-times.md. Needs Chromium with its driver
page-times:
    cargo run --release -p raypencil-tests --features examples --example page_times

# Pictures of the presets of generated ground: docs/figures/ground-*.svg
portraits:
    cargo run --release -p raypencil --features examples --example portraits -- docs/figures

# The property tests on CASES cases each, from a random seed
properties CASES:
    PROPTEST_CASES={{ CASES }} PROPTEST_RNG_SEED="$(od -An -N6 -tu8 /dev/urandom | tr -d ' ')" cargo test --release -p raypencil-tests --test it properties::

# The signs and hits of `cast` against exact arithmetic, on CASES cases of each of six hostile families: 1,700,000 are ten million, a few minutes
paths CASES:
    RAYPENCIL_PATH_CASES={{ CASES }} cargo test --release -p raypencil-referee --lib -- --nocapture every_sign_and_every_hit

# Random mutants of a crate, all in one build, against its tests; goes on where it was interrupted. OPTIONS: --again (those that were
# missed so far, after new tests were written), --only 'plane.rs:12', --part 0/2, ...: docs/evidence/mutants.md
mutants CRATE *OPTIONS:
    cargo run --quiet --release --manifest-path tests/mutants/Cargo.toml --target-dir target/mutants -- {{ CRATE }} {{ OPTIONS }}

# The table of the scores of these crates, or of all of which mutants were tested
mutation-scores *CRATES:
    cargo run --quiet --release --manifest-path tests/mutants/Cargo.toml --target-dir target/mutants -- --table {{ CRATES }}

# The faults of tests/planted, planted one at a time in a clone, and the tests that catch them: docs/evidence/shared-faults.md
planted-faults *AGAIN:
    cargo run -p raypencil-tests --features examples --example planted_faults -- {{ AGAIN }}

# The malformed inputs and their refusals: docs/evidence/malformed-inputs.md
malformed-inputs:
    cargo run --release -p raypencil-tests --features examples --example malformed_inputs > docs/evidence/malformed-inputs.md

# Every malformed input, each in a process of its own: docs/evidence/hostile-inputs.md
hostile-inputs:
    mkdir -p out
    cargo build --release -p raypencil-cli --bin raypencil
    cargo run --release -p raypencil-cli --features examples --example hostile_inputs > out/hostile-inputs.md
    mv out/hostile-inputs.md docs/evidence/hostile-inputs.md

# Each operation of each command that writes a folder (or of COMMANDS) fails once, and ends the process once: the table of
# docs/evidence/folder-faults.md, on the screen
folder-faults *COMMANDS:
    cargo run --release -p raypencil-cli --features examples --example folder_faults -- {{ COMMANDS }}

# Fuzzes a reader for SECONDS, starting from the malformed inputs: scene_toml, resolved_scene, glb, dem, exr, npy, pfm, stl,
# obj, ply, cloud, trajectory, bag_poses, manifest, candidate; from good files: terrain, campaign, sweep, settings, camera_info; from nothing: rays, ray_sets,
# numbers. Needs a nightly
# compiler and cargo-fuzz (cargo install cargo-fuzz --locked); fuzz/README.md
fuzz TARGET SECONDS:
    cargo run --release -p raypencil-tests --features examples --example malformed_inputs fuzz/corpus
    cd fuzz && cargo +nightly fuzz run {{ TARGET }} -- -rss_limit_mb=512 -timeout=5 -max_total_time={{ SECONDS }}

# All benchmarks
bench:
    cargo bench --workspace

# Validate both renderers on a mesh of your own (GLB, glTF or scene TOML)
marsyard MESH:
    cargo run --release --bin raypencil -- validate {{ quote(MESH) }} -o out/marsyard
