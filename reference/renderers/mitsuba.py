"""Mitsuba 3 on the questions of a pack: its geometry, its shadows, its radiance, and its images of each beam.

Mitsuba traces all live emitters of a process, so each beam is rendered in a process of its own (`render`).
"""

import multiprocessing
import os
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path

import numpy as np

from . import llvm, maps
from .pack import NO_HIT, Pack, pose, read

VARIANT = "llvm_ad_mono"
# So many times fewer samples of `ptracer`.
PTRACER = 64
# Correlated multi-jittered samples: a stripe thinner than a pixel is a line in it, on which they err by N^(-3/4) where
# independent ones err by N^(-1/2). Images of different seeds are independent all the same.
SAMPLER = "multijitter"


@dataclass
class Effort:
    """How much light is sampled: independent images, samples of each pixel in one, and where their seeds begin."""

    images: int
    samples: int
    seed: int


def render(pack: Pack, out: Path, effort: Effort) -> dict:
    """Writes the maps and images of every sensor; returns what made them."""
    llvm.locate()
    work = [("geometry", 0)] + [(what, beam) for beam in range(len(pack.beams)) for what in ("radiance", "images")]
    spawn = multiprocessing.get_context("spawn")
    totals = []
    for what, beam in work:
        with spawn.Pool(1) as process:
            totals += process.apply(part, (what, beam, pack.folder, out, effort))
    return {
        "program": "Mitsuba 3",
        "versions": {name: version(name) for name in ("mitsuba", "drjit", "numpy")}
        | {"llvm": os.path.basename(os.path.realpath(os.environ["DRJIT_LIBLLVM_PATH"]))},
        "variant": VARIANT,
        "images": effort.images,
        "samplesPerPixel": effort.samples,
        "seeds": [effort.seed, effort.seed + effort.images - 1],
        "totals": totals,
    }


def part(what: str, beam: int, folder: Path, out: Path, effort: Effort) -> list[dict]:
    """One piece of the work, in a process of its own. Of images what they add up to."""
    import mitsuba as mi

    mi.set_variant(VARIANT)
    from .laser import ground

    pack = read(folder)
    bare = mi.load_dict(ground(pack))
    if what == "geometry":
        geometry(pack, bare, out)
        return []
    lit = lit_scene(pack, beam, bare, effort)
    if what == "radiance":
        radiance(pack, beam, lit, out)
        return []
    return images(pack, beam, lit, out, effort)


def lit_scene(pack: Pack, beam: int, bare, effort: Effort):
    """The ground under one beam, with the rover's camera."""
    import mitsuba as mi

    from .laser import Air, LaserSheet, RoverCamera, ground

    air = Air(pack.attenuation, bare)
    wavelength = pack.beams[beam]["wavelength_m"]
    mi.register_emitter("laser_sheet", lambda props: LaserSheet(props, pack.beams[beam], air))
    mi.register_sensor("rover_camera", lambda props: RoverCamera(props, pack.camera, air, wavelength))
    return mi.load_dict(ground(pack) | {
        "laser": {"type": "laser_sheet"},
        "camera": {
            "type": "rover_camera",
            "sampler": {"type": SAMPLER, "sample_count": effort.samples},
            "film": {
                "type": "hdrfilm",
                "width": pack.camera["width_px"],
                "height": pack.camera["height_px"],
                "rfilter": {"type": "box"},
                "pixel_format": "luminance",
                "component_format": "float32",
            },
        },
    })


def rays_of(origin: np.ndarray, direction: np.ndarray):
    """Rays with unit directions, in single precision."""
    import mitsuba as mi

    unit = direction / np.linalg.norm(direction, axis=1, keepdims=True)
    return mi.Ray3f(mi.Point3f(*origin.T.astype(np.float32)), mi.Vector3f(*unit.T.astype(np.float32)))


def faces_of(pack: Pack, bare, met) -> np.ndarray:
    """The number of the face that was met, -1 if none."""
    import drjit as dr

    face = np.full(dr.width(met.t), -1)
    for part, shape in zip(pack.parts, bare.shapes()):
        ours = np.array(met.shape == shape) & np.array(met.is_valid())
        face[ours] = part.first + np.array(met.prim_index)[ours]
    return face


def geometry(pack: Pack, bare, out: Path) -> None:
    """What every ray meets first, and whether a shadow ray from there reaches the camera.

    Mitsuba knows no backs that rays go through, nor a plane that they start behind: where a pack has such rays, it is
    wrong there.
    """
    import mitsuba as mi

    stand = pose(pack.camera)
    corners = pack.vertices.astype(float)[pack.faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    for name, sensor in pack.sensors().items():
        rays = pack.rays[name].reshape(-1, 6)
        origin, direction = rays[:, :3], rays[:, 3:]
        ray = rays_of(origin, direction)
        met = bare.ray_intersect_preliminary(ray)
        face, reach = faces_of(pack, bare, met), np.array(met.t).astype(float)
        is_hit = (face >= 0) & (reach <= sensor["max_range_m"])
        channels = {
            "range.T": np.where(is_hit, reach, np.inf),
            "face.I": np.where(is_hit, face, NO_HIT).astype("<u4"),
        }
        if name != "camera":
            surface = bare.ray_intersect(ray)
            shadow = surface.spawn_ray_to(mi.Point3f(*(float(c) for c in stand.position)))
            is_free = ~np.array(bare.ray_test(shadow))
            point = np.array(surface.p).T.astype(float)
            x, y, depth = ((point - stand.position) @ stand.rotation).T
            camera = pack.camera
            focal = camera["focal_length_m"]
            with np.errstate(divide="ignore", invalid="ignore"):
                column = camera["principal_point_px"][0] + focal * x / (depth * camera["pixel_pitch_m"][0])
                row = camera["principal_point_px"][1] + focal * y / (depth * camera["pixel_pitch_m"][1])
            lands = (column >= 0) & (column < camera["width_px"]) & (row >= 0) & (row < camera["height_px"])
            is_towards = (normals[face] * (stand.position - point)).sum(axis=1) > 0
            channels["visible.V"] = (is_hit & is_free & lands & (depth > focal) & is_towards).astype("u1")
        shape = pack.rays[name].shape[:2]
        maps.write(out, name, {key: values.reshape(shape) for key, values in channels.items()})


def radiance(pack: Pack, beam: int, lit, out: Path) -> None:
    """Radiance in W m^-2 sr^-1 without chance: along the camera's own rays, and towards the camera from every point that
    the pack says a pencil hits (NaN where it hits nothing)."""
    import mitsuba as mi

    integrator = mi.load_dict({"type": "direct", "emitter_samples": 1, "bsdf_samples": 0})
    sampler = mi.load_dict({"type": "independent"})

    def along(origin: np.ndarray, direction: np.ndarray) -> np.ndarray:
        sampler.seed(0, len(origin))
        ray = mi.RayDifferential3f(rays_of(origin, direction))
        return np.array(integrator.sample(lit, sampler, ray)[0])[0].astype(float)

    centre = pose(pack.camera).position
    rays = pack.rays["camera"].reshape(-1, 6)
    found = along(rays[:, :3], rays[:, 3:]).reshape(pack.rays["camera"].shape[:2])
    maps.write(out, "camera", {f"radiance.beam{beam}": found})

    points = pack.answer(f"beam-{beam}", "P")
    if points is None:
        return
    is_hit = np.isfinite(points[..., 0])
    hit = points[is_hit]
    found = np.full(points.shape[:2], np.nan)
    found[is_hit] = along(np.broadcast_to(centre, hit.shape), hit - centre)
    maps.write(out, f"beam-{beam}", {"radiance.V": found})


def images(pack: Pack, beam: int, lit, out: Path, effort: Effort) -> list[dict]:
    """Watts in each pixel, mean and standard error of the mean: seen from the camera (`direct`), and sent out from the
    laser (`ptracer`), which knows nothing of the irradiance on a slope or at a distance. What the images add up to is
    returned: its error is not that of independent pixels where light that misses one falls into the next."""
    import mitsuba as mi

    pixels = pack.camera["width_px"] * pack.camera["height_px"]
    ways = {
        "direct": ({"type": "direct", "emitter_samples": 1, "bsdf_samples": 0}, effort.samples, 1.0),
        # Its film holds the sum over paths, times pixels over paths: one pixel's share of a unit is what a sensor of
        # radiance wants. Ours wants the sum over paths itself, of one unit for all of them. All of its light falls on a
        # stripe, so that fewer paths do; and many equal numbers in one pixel of a film in single precision add up
        # badly.
        "ptracer": (
            {"type": "ptracer", "max_depth": 2, "hide_emitters": True},
            max(1, effort.samples // PTRACER),
            1.0 / pixels,
        ),
    }
    totals = []
    for way, (integrator, samples, unit) in ways.items():
        integrator = mi.load_dict(integrator)
        # Every image is a sum in single precision; their mean and scatter are taken in double.
        drawn = np.stack([
            np.array(mi.render(lit, integrator=integrator, spp=samples, seed=effort.seed + k))[..., 0]
            for k in range(effort.images)
        ]).astype(float) * unit
        maps.write(out, "camera", {
            f"{way}.mean.beam{beam}": drawn.mean(axis=0),
            f"{way}.error.beam{beam}": drawn.std(axis=0, ddof=1) / np.sqrt(effort.images),
        })
        sums = drawn.sum(axis=(1, 2))
        error = sums.std(ddof=1) / np.sqrt(effort.images)
        totals.append({"way": way, "beam": beam, "mean": float(sums.mean()), "error": float(error)})
    return totals
