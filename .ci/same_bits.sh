#!/usr/bin/env bash
# Whether two builds of the program give the same bits: every map and all light of both renderers in double precision, a
# drive with its camera's noise, the records of a sweep and of a campaign, and the committed packs, byte for byte.
#
#     .ci/same_bits.sh A B          A: the slower build, which renders small scenes only; B also writes the packs
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
a=$1 b=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# same: whether both builds wrote the same files to $work/a and $work/b, which go then: a hundred megabytes at a time. The first
# line of a list of files names the folder it lies in, and these are two folders: it is left out.
files=0
same() {
    find "$work/a" "$work/b" -name .raypencil-made -exec sed -i '1{/^# made in folder /d}' {} +
    diff -r "$work/a" "$work/b"
    files=$((files + $(find "$work/a" -type f | wc -l)))
    rm -r "$work/a" "$work/b"
}
for scene in data/scenes/pyramids-small.toml data/scenes/facets-small.toml data/scenes/random.toml; do
    for renderer in scanline scanline-paper tracer; do
        for build in a b; do
            "${!build}" render "$scene" --with "$renderer" --format npy -o "$work/$build" >/dev/null
        done
        same
    done
done
small=(--set camera.width_px=96 --set camera.height_px=96 --set camera.pixel_pitch_um=96 --set 'drive.waypoints_m=[[0.3, 0]]'
    --set drive.scans=false --set drive.sensor=ccd_1989 --set beam.rows=2)
for build in a b; do
    "${!build}" drive pyramids "${small[@]}" --record npy,points,maps -o "$work/drive-$build" >/dev/null
    mv "$work/drive-$build/recording" "$work/$build"
done
same
[[ $files -gt 300 ]] || { echo "only $files files were compared" >&2; exit 1; }
echo "$files files of renderings and of a drive are the same"
mkdir "$work/scenes"
cp data/scenes/pyramids-small.toml data/scenes/random.toml "$work/scenes"
for build in a b; do
    "${!build}" sweep data/scenes/pyramids-small.toml --set beam.thickness_mm=5,8 -o "$work/$build/sweep" >/dev/null
    "${!build}" campaign --scenes "$work/scenes" -o "$work/$build/campaign" >/dev/null
    # The program is a part of what decides a record, and these are two programs: a run's record has its name by it, too.
    find "$work/$build" -name '*.json' -exec \
        sed -Ei 's/"(program|run)":"[0-9a-f]{64}"//g; s/"sha256":"[0-9a-f]{64}"\}$//' {} +
    sort "$work/$build/sweep/runs/"*.json >"$work/$build/sweep/runs.txt"
    rm "$work/$build/sweep/runs/"*.json
done
before=$files
same
[[ $((files - before)) -gt 6 ]] || { echo "only $((files - before)) records were compared" >&2; exit 1; }
echo "$((files - before)) files of a sweep and of a campaign are the same"

# The version and the licence of the committed packs are in them: data/packs/README.md.
own=(--pack-version 2.0.0 --licence CC0-1.0)
for pack in pyramids facets hard; do
    "$b" pack "data/scenes/packs/$pack.toml" "${own[@]}" -o "$work/packs/$pack" >/dev/null
    diff -r "$work/packs/$pack" "data/packs/$pack"
    rm -r "$work/packs/$pack"
    echo "the pack $pack is the committed one"
done
