#!/usr/bin/env python3
"""Photons to digital numbers: whether a recording's images obey the laws of docs/theory/sensor.md, steps 7 and 8.

    python3 reference/rover/check_sensor.py IDEAL NOISY [NOISY ...] --preset cmos [--electronics FILE.json]

IDEAL is a recording of a drive with `sensor = "ideal"`, NOISY of the very same drive with the preset, without blur
and dust, as `grounds.py` writes them (a tiny aperture keeps defocus away). All need NPY images. The ideal camera has
no read noise and a fine scale, so that its numbers tell the photons of each pixel; the noisy numbers are then drawn
again and again here, with numpy's own random numbers, by the laws of the page alone.

The test: of a pixel's number and 199 numbers drawn by the law for the same photons, each rank is equally likely,
whatever the law, rounding and clipping included. Ranks of many pixels are counted in 20 classes; the sum of
(found - expected)^2 / expected follows chi-square with 19 degrees of freedom. A law is rejected below a probability of
1e-6 (some twenty tests: one false alarm in 50,000 runs). Each pixel is used once, since its fixed pattern is the same
in all frames; pixels are independent of one another. Then deliberately wrong laws are put in the law's place, and each
must be rejected. The exit code is 0 if the laws hold and all wrong ones are rejected, 1 if not, 2 for trouble.
"""

import argparse
import json
import math
import sys
from pathlib import Path

import numpy as np

from trouble import Trouble

PLANCK, LIGHT = 6.62607015e-34, 299792458.0  # by definition of the SI
DRAWS, CLASSES = 199, 20  # 200 ranks, ten to a class
LEAST = 1e-6
SAMPLES = 30_000  # of a group at most

# The table "Presets" of docs/theory/sensor.md.
PRESETS = {
    "ideal": dict(exposure=2e-3, eta=1.0, dark=0.0, read=0.0, prnu=0.0, dsnu=0.0, well=math.inf, gain=0.25, bias=0.0,
                  bits=16),
    # 1200 e-/s at 0 degrees Celsius, used there.
    "ccd_1989": dict(exposure=2e-3, eta=0.35, dark=1200.0, read=35.0, prnu=0.02, dsnu=20.0, well=100_000.0,
                     gain=253 / 100_000, bias=2.0, bits=8),
    "cmos": dict(exposure=0.4e-3, eta=0.22, dark=5.0, read=2.4, prnu=0.006, dsnu=0.6, well=10_700.0,
                 gain=4035 / 10_700, bias=60.0, bits=12),
}


def draw(law, photons_per_s, rng, shape, wrong=None):
    """Digital numbers by steps 7 and 8. `wrong` names a deliberate mistake."""
    p = dict(law)
    if wrong == "gain 2 % high":
        p["gain"] *= 1.02
    if wrong == "bias 1 DN high":
        p["bias"] += 1
    if wrong == "efficiency 1 % low":
        p["eta"] *= 0.99
    if wrong == "read noise 10 % low":
        p["read"] *= 0.9
    if wrong == "no fixed gain pattern":
        p["prnu"] = 0.0
    if wrong == "no full well":
        p["well"] = math.inf
    if wrong == "exposure 1 % long":
        p["exposure"] *= 1.01
    mean = np.broadcast_to(p["eta"] * photons_per_s * p["exposure"], shape)
    mean = np.maximum(0, mean * (1 + p["prnu"] * rng.standard_normal(shape))) + p["dark"] * p["exposure"]
    if wrong == "no shot noise":
        electrons = mean
    elif wrong == "shot noise of 1.1 times the variance":
        electrons = mean + np.sqrt(1.1 * mean) * rng.standard_normal(shape)
    else:
        electrons = rng.poisson(mean).astype(float)
    electrons = np.minimum(electrons, p["well"])
    y = p["bias"] + p["gain"] * (electrons + p["dsnu"] * rng.standard_normal(shape)
                                 + p["read"] * rng.standard_normal(shape))
    number = np.floor(y) if wrong == "cut instead of rounded" else np.floor(y + 0.5)
    return np.clip(number, 0, math.inf if wrong == "no highest number" else 2 ** p["bits"] - 1)


def chi_square_tail(value, freedom):
    """Probability of a larger value: the incomplete gamma function by its series or its continued fraction."""
    a, x = freedom / 2, value / 2
    if x <= 0:
        return 1.0
    head = math.exp(a * math.log(x) - x - math.lgamma(a)) if x < 700 else 0.0
    if x < a + 1:
        term = total = 1 / a
        for k in range(1, 1000):
            term *= x / (a + k)
            total += term
        return max(0.0, 1 - head * total)
    b = x + 1 - a
    c, d = 1e300, 1 / b
    h = d
    for k in range(1, 1000):
        an = -k * (k - a)
        b += 2
        d, c = 1 / (an * d + b), b + an / c
        h *= d * c
    return head * h


def rank_test(numbers, photons_per_s, law, rng, wrong=None):
    """Probability of ranks as uneven as these, if the numbers follow the law."""
    counts = np.zeros(CLASSES)
    for part in range(0, len(numbers), 5000):
        mine, flux = numbers[part:part + 5000], photons_per_s[part:part + 5000]
        drawn = draw(law, flux[:, None], rng, (len(mine), DRAWS), wrong)
        below, equal = (drawn < mine[:, None]).sum(axis=1), (drawn == mine[:, None]).sum(axis=1)
        rank = below + rng.integers(0, equal + 1)  # equal numbers: by lot
        counts += np.bincount(rank * CLASSES // (DRAWS + 1), minlength=CLASSES)
    expected = len(numbers) / CLASSES
    return chi_square_tail(float(((counts - expected) ** 2 / expected).sum()), CLASSES - 1)


def images(folder):
    folder = Path(folder) / "images"
    found = {path.name: path for path in sorted(folder.glob("*.npy"))}
    if not found:
        raise Trouble(f"{folder}: no NPY images; record with --record npy")
    return found


def samples(ideal, noisy, law, rng):
    """Photons per second and number of pixels, each pixel once; also the same pixel in the next frame of equal light."""
    scale = 1 / (PRESETS["ideal"]["gain"] * PRESETS["ideal"]["exposure"])  # photons per second of one ideal number
    top = 2 ** PRESETS["ideal"]["bits"] - 1
    ours, theirs = images(ideal), images(noisy)
    names = [name for name in ours if name in theirs]
    if not names:
        raise Trouble(f"{ideal} and {noisy} have no image of the same name")
    kept = {}
    pairs = []
    last = {}
    order = rng.permutation(len(names))
    first = np.load(ours[names[0]])
    used = np.zeros(first.shape, bool)
    flux, number = [], []
    dark_used = np.zeros(first.shape, bool)
    for n in order:
        a, b = np.load(ours[names[n]]), np.load(theirs[names[n]])
        if a.shape != b.shape:
            raise Trouble(f"{names[n]}: shapes {a.shape} and {b.shape}")
        # Faint pixels are left out: there the rounding of the ideal number is not small beside the light.
        lit = (a >= 40) & (a < top) & ~used
        dark = (a == 0) & ~dark_used & ~used & (rng.random(a.shape) < 5e-4)
        for chosen in (lit, dark):
            flux.append(a[chosen] * scale), number.append(b[chosen].astype(float))
        used |= lit
        dark_used |= dark
    return np.concatenate(flux), np.concatenate(number)


def photon_transfer(ideal, noisy, law):
    """Variance over mean from pairs of frames with equal light in a pixel: the fixed pattern cancels in the difference.

    Returns counts, means and half the variance of the difference, in classes of the mean.
    """
    ours, theirs = images(ideal), images(noisy)
    names = sorted(set(ours) & set(theirs))
    by_beam = {}
    for name in names:
        by_beam.setdefault(name.split("-", 1)[1], []).append(name)
    mean, square = [], []
    full = law["bias"] + law["gain"] * law["well"] * 0.8
    for series in by_beam.values():
        for one, two in list(zip(series, series[1:]))[::2]:  # each frame in one pair only
            a, b = np.load(ours[one]).astype(int), np.load(ours[two]).astype(int)
            c, d = np.load(theirs[one]).astype(float), np.load(theirs[two]).astype(float)
            # Equal within a thousandth: the difference of the means is then far below the noise.
            same = (a >= 40) & (np.abs(a - b) <= 1e-3 * a) & (c + d < 2 * full)
            mean.append((c[same] + d[same]) / 2), square.append((c[same] - d[same]) ** 2 / 2)
    return np.concatenate(mean), np.concatenate(square)


WRONG = ["gain 2 % high", "bias 1 DN high", "efficiency 1 % low", "read noise 10 % low", "no fixed gain pattern",
         "no full well", "no shot noise", "shot noise of 1.1 times the variance", "cut instead of rounded",
         "exposure 1 % long", "no highest number"]


def matters(wrong, law, electrons):
    """Whether a wrong law makes a difference that so many pixels can show: parts of the variance at the best pixel."""
    shot = np.maximum(electrons, 1)
    pattern, quantum = (law["prnu"] * electrons) ** 2, 1 / (12 * law["gain"] ** 2)
    variance = shot + pattern + quantum + law["read"] ** 2 + law["dsnu"] ** 2
    top = law["gain"] * min(law["well"], electrons.max()) + law["bias"]
    return {"read noise 10 % low": law["read"] * law["gain"] > 0.3,
            "no fixed gain pattern": (pattern / variance).max() > 0.3,
            "shot noise of 1.1 times the variance": (shot / variance).max() > 0.5,
            "no full well": electrons.max() > 1.1 * law["well"],
            "no highest number": top > 2 ** law["bits"] - 1}.get(wrong, True)


def check(ideal, noisy, law, seed):
    rng = np.random.default_rng(seed)
    flux, number = samples(ideal, noisy, law, rng)
    electrons = law["eta"] * flux * law["exposure"]
    brightest = electrons.max()
    groups = [("dark", electrons == 0), ("faint", (electrons > 0) & (electrons <= brightest * 0.03)),
              ("middle", (electrons > brightest * 0.03) & (electrons <= brightest * 0.3)),
              ("bright", electrons > brightest * 0.3),
              ("at the full well", electrons > 0.98 * law["well"])]
    good = True
    print(f"{noisy}")
    print(f"  {'group':<18}{'pixels':>8}{'electrons':>22}{'probability':>14}")
    usable = {}
    for name, which in groups:
        pick = np.flatnonzero(which)
        if len(pick) < 40 * CLASSES:
            print(f"  {name:<18}{len(pick):>8}   too few, not tested")
            continue
        pick = rng.permutation(pick)[:SAMPLES]
        usable[name] = pick
        p = rank_test(number[pick], flux[pick], law, rng)
        span = f"{electrons[pick].min():.0f} to {electrons[pick].max():.0f}"
        print(f"  {name:<18}{len(pick):>8}{span:>22}{p:>14.2g}" + ("" if p >= LEAST else "   REJECTED"))
        good &= p >= LEAST
    if "dark" not in usable or len(usable) < 2:
        print("  too few pixels for a verdict")
        good = False
    for wrong in WRONG:
        if not matters(wrong, law, electrons):
            print(f"  wrong law, {wrong}: makes too little difference here, not tested")
            continue
        found = {name: rank_test(number[pick], flux[pick], law, rng, wrong) for name, pick in usable.items()}
        name = min(found, key=found.get)
        rejected = found[name] < LEAST
        print(f"  wrong law, {wrong}: " + (f"rejected by {name} pixels" if rejected else "NOT REJECTED"))
        good &= rejected
    mean, square = photon_transfer(ideal, noisy, law)
    if len(mean) > 1000:
        # Least squares of the variance on the mean; each square has twice its variance squared as its own variance.
        offset = law["gain"] ** 2 * law["read"] ** 2 + 1 / 12 - law["gain"] * law["bias"]
        expected = law["gain"] * mean + offset
        weight = 1 / (2 * np.maximum(expected, 1e-3) ** 2)
        slope = float((weight * mean * (square - offset)).sum() / (weight * mean ** 2).sum())
        error = float(1 / np.sqrt((weight * mean ** 2).sum()))
        ok = abs(slope - law["gain"]) <= 5 * error
        print(f"  photon transfer: slope {slope:.5f} DN/e of {len(mean)} pairs, gain {law['gain']:.5f}, "
              f"standard error {error:.5f}" + ("" if ok else "   REJECTED"))
        good &= ok
    return good


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("ideal")
    parser.add_argument("noisy", nargs="+")
    parser.add_argument("--preset", choices=["ccd_1989", "cmos"], required=True)
    parser.add_argument("--electronics", help="JSON with numbers that replace the preset's: eta, prnu, read, ...")
    parser.add_argument("--seed", type=int, default=1, help="of the numbers drawn here")
    options = parser.parse_args()
    law = dict(PRESETS[options.preset])
    try:
        if options.electronics:
            more = json.loads(Path(options.electronics).read_text())
            unknown = set(more) - set(law)
            if unknown:
                raise Trouble(f"{options.electronics}: unknown {', '.join(sorted(unknown))}")
            law.update(more)
        good = True
        for noisy in options.noisy:
            good &= check(options.ideal, noisy, law, options.seed)
    except (Trouble, OSError, ValueError) as trouble:
        print(f"trouble: {trouble}", file=sys.stderr)
        return 2
    print("the laws hold, and the wrong ones are rejected" if good else "NOT as the laws say")
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
