#!/usr/bin/env bash
# Runs every reference program against the committed packs, where there is a Python or a C++ compiler to run them
# with: the exact values once more, the two small renderers judged by `raypencil check`, and Embree and Mitsuba asked
# again, which must say what they said when their committed recordings were made.
#
#     reference/run.sh RAYPENCIL        the binary
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
raypencil=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
packs=(pyramids facets hard)

# expect CODE COMMAND...: the command must end with that exit code.
expect() {
    local wanted=$1 code=0 start=$SECONDS
    shift
    "$@" >"$work/output" 2>&1 || code=$?
    if [[ $code -ne $wanted ]]; then
        cat "$work/output" >&2
        printf 'FAILED: exit code %d, expected %d: %s\n' "$code" "$wanted" "$*" >&2
        exit 1
    fi
    printf 'ok (exit code %d, %d s): %s\n' "$code" $((SECONDS - start)) "$*"
}

# other_bit FILE: changes one bit, eight bytes before the end.
other_bit() {
    "$python" - "$1" <<'END'
import sys
with open(sys.argv[1], "r+b") as file:
    file.seek(-8, 2)
    last = file.read(1)[0]
    file.seek(-8, 2)
    file.write(bytes([last ^ 1]))
END
}

python=""
if python3 -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null; then
    if python3 -m venv "$work/venv" >/dev/null 2>&1 \
        && "$work/venv/bin/python" -m pip install --quiet --disable-pip-version-check -r reference/requirements.txt; then
        python="$work/venv/bin/python"
    fi
fi
if [[ -n $python ]]; then
    for pack in "${packs[@]}"; do
        expect 0 "$python" reference/exact_values.py "data/packs/$pack" --exr
        tail -n 2 "$work/output"
        expect 0 "$python" reference/numpy_candidate.py "data/packs/$pack" "$work/f64/$pack"
        expect 0 "$raypencil" check "data/packs/$pack" "$work/f64/$pack" --arithmetic f64
        # In single precision it is right for single precision, and for nothing better.
        expect 0 "$python" reference/numpy_candidate.py "data/packs/$pack" "$work/f32/$pack" --dtype float32
        expect 0 "$raypencil" check "data/packs/$pack" "$work/f32/$pack" --arithmetic f32
        expect 1 "$raypencil" check "data/packs/$pack" "$work/f32/$pack" --arithmetic f64
    done
    # Any rays: every bit of every array once more, by other arithmetic; one bit that is off is found.
    expect 0 "$python" reference/make_hard_rays.py --check
    for mesh in data/rays/cube.obj data/rays/hard/*/mesh.obj; do
        rays=data/rays/cube.npy
        [[ $mesh == data/rays/cube.obj ]] || rays=$(dirname "$mesh")/rays.npy
        folder=$work/cast/$(basename "$(dirname "$mesh")")
        expect 0 "$raypencil" cast "$mesh" "$rays" --any --all --margins -o "$folder"
        expect 0 "$python" reference/exact_cast.py "$mesh" "$rays" "$folder"
    done
    # Margins once more, in fractions; one that is a millionth of itself off is found.
    margins=$work/cast/margins
    expect 0 "$raypencil" cast data/rays/cube.obj data/rays/cube.npy --margins -o "$margins"
    expect 0 "$python" reference/exact_margins.py data/rays/cube.obj data/rays/cube.npy "$margins" --rays 20
    "$python" -c 'import sys, numpy; numpy.save(sys.argv[1], numpy.load(sys.argv[1]) * (1 + 1e-6))' "$margins/margin.surface.npy"
    expect 1 "$python" reference/exact_margins.py data/rays/cube.obj data/rays/cube.npy "$margins" --rays 20
    other_bit "$folder/t.npy"
    expect 1 "$python" reference/exact_cast.py "$mesh" "$rays" "$folder" --displaced 0
    # The returns of beams once more; a bit of one strength is found.
    wide=$work/cast/wide
    expect 0 "$raypencil" cast data/packs/facets/terrain.glb data/rays/wide.toml --up y -o "$wide"
    expect 0 "$python" reference/lidar/returns.py "$wide"
    other_bit "$wide/return.strength.npy"
    expect 1 "$python" reference/lidar/returns.py "$wide"
    expect 0 "$python" reference/load_ground.py data/packs/input "$work/input"
    expect 0 "$raypencil" check data/packs/input "$work/input"
    # Nobody has seen these answers before.
    for seed in 3 17; do
        expect 0 "$raypencil" pack --blind "$seed" -o "$work/blind-$seed"
        expect 0 "$python" reference/numpy_candidate.py "$work/blind-$seed" "$work/f64/blind-$seed"
        expect 0 "$raypencil" check "$work/blind-$seed" "$work/f64/blind-$seed"
    done
    # The bag of a drive, by two readers; one pixel of the recording that is off is found.
    expect 0 "$raypencil" drive data/scenes/rocky-drive.toml --record npy,points,maps,mcap -o "$work/drive"
    expect 0 "$python" reference/rosbag/check.py "$work/drive/recording"
    tail -n 1 "$work/output"
    other_bit "$work/drive/recording/images/000012-beam0.npy"
    expect 1 "$python" reference/rosbag/check.py "$work/drive/recording"
    rm -r "$work/drive"
    # The second rover: from the images of twenty random grounds to the navigator maps, and the laws of the sensor.
    expect 0 "$python" reference/rover/self_check.py
    expect 0 "$python" reference/rover/designs_check.py
    expect 0 "$python" reference/rover/grounds.py "$work/grounds"
    for scene in "$work"/grounds/ground*.toml; do
        expect 0 "$raypencil" drive "$scene" --record npy,points,maps -o "$work/drive"
        expect 0 "$python" reference/rover/follow.py "$work/drive/recording"
        tail -n 1 "$work/output"
        rm -r "$work/drive"
    done
    # The vehicle's truth once more; that of other limits is found.
    expect 0 "$python" reference/rover/truth.py --make "$work/truth"
    for rules in tips steps default; do
        rm -rf "$work/drive"
        expect 0 "$raypencil" drive "$work/truth/$rules.toml" --record poses -o "$work/drive"
        expect 0 "$python" reference/rover/truth.py "$work/truth/$rules.toml" "$work/drive/recording"
    done
    expect 1 "$python" reference/rover/truth.py "$work/truth/tips.toml" "$work/drive/recording"
    rm -r "$work/drive" "$work/truth"
    for camera in ideal ccd_1989 cmos; do
        expect 0 "$raypencil" drive "$work/grounds/sensor-$camera.toml" --record npy -o "$work/sensor/$camera"
    done
    for camera in ccd_1989 cmos; do
        expect 0 "$python" reference/rover/check_sensor.py "$work/sensor/ideal/recording" \
            "$work/sensor/$camera/recording" --preset "$camera"
    done
    rm -r "$work/sensor"
    candidates=data/candidates
    make=(reference/make.py --pack)
    for pack in "${packs[@]}"; do
        expect 0 "$python" "${make[@]}" "data/packs/$pack" --with embree -o "$work/embree/$pack"
        expect 0 "$python" "${make[@]}" "data/packs/$pack" --with embree -o "$work/embree-again/$pack"
        expect 0 "$python" reference/agree.py "$work/embree/$pack" "$work/embree-again/$pack"
        # Another processor takes other instructions.
        agree=(reference/agree.py "$candidates/embree/$pack" --maps single --pack "data/packs/$pack")
        expect 0 "$python" "${agree[@]}" "$work/embree/$pack"
        # One face that is another, which the ray does not meet there, is found.
        other_bit "$work/embree-again/$pack/camera/face.I.npy"
        expect 1 "$python" "${agree[@]}" "$work/embree-again/$pack"
        expect 0 "$raypencil" check "data/packs/$pack" "$work/embree/$pack"
    done
    # Light on plain ground. Seeds that the committed images have not: independent of them.
    plain=pyramids-small
    expect 0 "$raypencil" pack "data/scenes/$plain.toml" --no-bench -o "$work/$plain"
    expect 0 "$python" "${make[@]}" "$work/$plain" --with embree -o "$work/embree/$plain"
    expect 0 "$python" reference/agree.py "$work/embree/$plain" "$candidates/embree/$plain" --maps single \
        --pack "$work/$plain"
    if PYTHONPATH=reference "$python" -c 'from renderers import llvm; llvm.locate()' 2>"$work/output"; then
        expect 0 "$python" "${make[@]}" "$work/$plain" --with mitsuba -o "$work/mitsuba/$plain" \
            --images 12 --samples 1024 --seed 1001
        expect 0 "$python" reference/agree.py "$work/mitsuba/$plain" "$candidates/mitsuba/$plain" --maps single \
            --pack "$work/$plain"
        cat "$work/output"
        expect 0 "$raypencil" check "$work/$plain" "$work/mitsuba/$plain"
        # Of Monte Carlo images one may be off by chance or by bias: the report says so, and the run goes on.
        expect 0 "$raypencil" validate "$work/$plain/scene.toml" --candidate "$work/mitsuba/$plain" \
            --candidate "$work/embree/$plain" --candidates-must-pass=false -o "$work/panel"
        grep -E '^(Embree|Mitsuba)' "$work/output"
    else
        echo "SKIPPED Mitsuba: $(tail -n 1 "$work/output")"
    fi
else
    echo "SKIPPED the Python programs: no Python of 3.11 or later with numpy and mpmath to be had"
fi

if command -v g++ >/dev/null; then
    expect 0 g++ -O2 -std=c++17 -ffp-contract=off -Wall -Wextra -Werror reference/cpp_candidate.cpp -o "$work/cpp"
    for pack in "${packs[@]}"; do
        expect 0 "$work/cpp" "data/packs/$pack" "$work/cpp-out/$pack"
        expect 0 "$raypencil" check "data/packs/$pack" "$work/cpp-out/$pack"
    done
else
    echo "SKIPPED the C++ program: no g++"
fi
