"""The two things that Mitsuba has not: a sheet of laser light, and a camera that measures watts.

Both are plugins in Python; rays, surfaces, shadows, sampling and the film are Mitsuba's own. A variant of Mitsuba must
be set before this module is imported.
"""

import drjit as dr
import mitsuba as mi
import numpy as np

from .pack import Pack, Pose, pose


def vector(values) -> mi.Vector3f:
    return mi.Vector3f(*(float(value) for value in values))


class Frame:
    """A sensor's axes, in single precision; positions are taken relative to the sensor's."""

    def __init__(self, stand: Pose):
        self.centre = mi.Point3f(vector(stand.position))
        self.x, self.y, self.z = (vector(stand.rotation[:, k]) for k in range(3))

    def inward(self, point):
        """Of a point of the scene its x, y and z in the sensor's frame."""
        way = point - self.centre
        return dr.dot(way, self.x), dr.dot(way, self.y), dr.dot(way, self.z)

    def outward(self, x, y, z):
        """Of a direction in the sensor's frame that in the scene's."""
        return self.x * x + self.y * y + self.z * z


class Air:
    """What is left of light after a ray's way to the ground: exp(-sigma R)."""

    def __init__(self, attenuation: float, ground: mi.Scene):
        self.attenuation, self.ground = attenuation, ground

    def along(self, ray):
        if self.attenuation == 0:
            return mi.Float(1)
        met = self.ground.ray_intersect_preliminary(ray)
        return dr.select(met.is_valid(), self.over(met.t), 0)

    def over(self, distance):
        return dr.exp(-self.attenuation * distance)


class Profile:
    """How a beam's power lies over its fan: x goes from -w to w at the distance g, tan(alpha) = x / g.

    `density(x)` is the part of the power per metre of x. The paper's profile, cos(alpha) / 2w, does not add up to 1; the
    others do.
    """

    def __init__(self, beam: dict):
        self.name, self.g, self.w = beam["profile"], beam["grid_distance_m"], beam["half_width_m"]
        self.gaussian = beam.get("gaussian_half_width_rad")
        nodes, weights = np.polynomial.legendre.leggauss(200)
        held = self.shape(np.arctan(nodes * self.w / self.g), np)
        total = self.w * float((weights * held).sum())
        self.scale = 1 / (2 * self.w) if self.name == "paper" else 1 / total

    def shape(self, alpha, module):
        if self.name == "paper":
            return module.cos(alpha)
        if self.name == "uniform_angle":
            return module.cos(alpha) * module.cos(alpha)
        if self.name == "gaussian":
            return module.exp(-2 * (alpha / self.gaussian) * (alpha / self.gaussian))
        raise SystemExit(f"{self.name}: a profile that is not known here; expected paper, uniform_angle or gaussian")

    def density(self, x):
        return self.scale * self.shape(dr.atan(x / self.g), dr)


class LaserSheet(mi.Emitter):
    """A sheet of light from a focal axis, the y axis of the beam.

    Light reaches a point from the foot of its perpendicular on that axis, if it lies within the sheet's thickness and
    its fan, and beyond the grid. Power per metre of y and radian of fan, spread over R radians' arc, is the irradiance
    square to the light: with x = g tan(alpha), dx/dalpha = g / cos^2(alpha),

        E_n = (power / thickness) density(x) (g / cos^2(alpha)) / R exp(-sigma R).
    """

    def __init__(self, props, beam: dict, air: Air):
        super().__init__(props)
        self.beam, self.air = beam, air
        self.frame, self.profile = Frame(pose(self.beam)), Profile(self.beam)
        self.reach = self.beam["max_range_m"]
        self.m_flags = +mi.EmitterFlags.DeltaDirection
        self.m_needs_sample_2, self.m_needs_sample_3 = True, True

    def sample_direction(self, it, sample, active=True):
        g, w, thickness = self.profile.g, self.profile.w, self.beam["thickness_m"]
        x, y, z = self.frame.inward(it.p)
        distance = dr.sqrt(x * x + z * z)
        at_grid = x / z * g
        cos = z / distance
        lit = active & (z >= g) & (dr.abs(y) <= thickness / 2) & (dr.abs(at_grid) <= w) & (distance <= self.reach)
        irradiance = self.beam["power_w"] / thickness * self.profile.density(at_grid) * g / (cos * cos * distance)

        sample = dr.zeros(mi.DirectionSample3f, dr.width(it.p))
        sample.p = self.frame.centre + self.frame.y * y
        sample.d = (sample.p - it.p) / distance
        sample.n = -sample.d
        sample.dist = distance
        sample.time = it.time
        sample.pdf = dr.select(lit, mi.Float(1), 0)
        sample.delta = mi.Bool(True)
        sample.emitter = mi.EmitterPtr(self)
        return sample, mi.Color1f(dr.select(lit, irradiance * self.air.over(distance), 0))

    def sample_ray(self, time, wavelength, position, direction, active=True):
        """Light as it leaves: y and x evenly over the sheet, each with the power that goes that way."""
        w = self.profile.w
        y = (position.x - 0.5) * self.beam["thickness_m"]
        x = (2 * direction.x - 1) * w
        ray = dr.zeros(mi.Ray3f, dr.width(position))
        ray.o = self.frame.centre + self.frame.y * y
        ray.d = dr.normalize(self.frame.outward(x, 0, self.profile.g))
        ray.maxt = dr.largest(mi.Float)
        ray.time = time
        power = self.beam["power_w"] * self.profile.density(x) * 2 * w
        return ray, mi.Color1f(power * self.air.along(ray)) & active

    def pdf_direction(self, it, ds, active=True):
        return mi.Float(0)

    def eval_direction(self, it, ds, active=True):
        return mi.Color1f(0)

    def eval(self, si, active=True):
        return mi.Color1f(0)

    def bbox(self):
        return mi.BoundingBox3f()

    def to_string(self):
        return f"LaserSheet[{self.profile.name}]"


class RoverCamera(mi.Sensor):
    """A pinhole whose pixels need not be square, and which counts watts.

    Backward (`direct`), radiance L becomes (pi/4) L (D/f)^2 cos^4(phi) C F(phi) A exp(-sigma d), A the area of a pixel.
    Forward (`ptracer`), radiance from a point at the distance d becomes L (pi D^2/4) cos(phi)/d^2 C F(phi) exp(-sigma d).
    """

    def __init__(self, props, camera: dict, air: Air, wavelength: float):
        super().__init__(props)
        self.camera, self.air, self.wavelength = camera, air, wavelength
        self.frame = Frame(pose(self.camera))
        self.size = (self.camera["width_px"], self.camera["height_px"])
        self.pitch, self.principal = self.camera["pixel_pitch_m"], self.camera["principal_point_px"]
        self.m_needs_sample_2, self.m_needs_sample_3 = True, False

    def let_through(self, cos):
        """By the lens, and by the interference filter, whose band shifts with the angle."""
        through, held = mi.Float(self.camera["transmission"]), self.camera.get("filter")
        if held:
            sine = (1 - cos * cos) / held["index"] ** 2
            # centre sqrt(1 - s) as centre - centre s / (1 + sqrt(1 - s)): the difference of two near wavelengths
            # would lose three digits.
            off = self.wavelength - held["centre_m"]
            off = (off + held["centre_m"] * sine / (1 + dr.sqrt(1 - sine))) / held["width_m"]
            through *= dr.exp(-4 * np.log(2).item() * off * off)
        return through

    def sample_ray(self, time, wavelength, position, aperture, active=True):
        focal = self.camera["focal_length_m"]
        x = (position.x * self.size[0] - self.principal[0]) * self.pitch[0]
        y = (position.y * self.size[1] - self.principal[1]) * self.pitch[1]
        ray = dr.zeros(mi.Ray3f, dr.width(position))
        ray.o = self.frame.centre
        ray.d = dr.normalize(self.frame.outward(x, y, focal))
        ray.maxt = self.camera["max_range_m"]
        ray.time = time
        cos = focal / dr.sqrt(x * x + y * y + focal * focal)
        relative = (self.camera["aperture_m"] / focal) ** 2 * self.pitch[0] * self.pitch[1]
        weight = float(np.pi / 4 * relative) * dr.square(dr.square(cos)) * self.let_through(cos) * self.air.along(ray)
        return ray, mi.Color1f(weight) & active

    def sample_ray_differential(self, time, wavelength, position, aperture, active=True):
        ray, weight = self.sample_ray(time, wavelength, position, aperture, active)
        return mi.RayDifferential3f(ray), weight

    def sample_direction(self, it, sample, active=True):
        focal = self.camera["focal_length_m"]
        x, y, depth = self.frame.inward(it.p)
        distance = dr.sqrt(x * x + y * y + depth * depth)
        cos = depth / distance
        uv = mi.Point2f(
            self.principal[0] + focal * x / (depth * self.pitch[0]),
            self.principal[1] + focal * y / (depth * self.pitch[1]),
        )
        seen = active & (depth > focal) & (uv.x >= 0) & (uv.x < self.size[0]) & (uv.y >= 0) & (uv.y < self.size[1])
        aperture = float(np.pi / 4 * self.camera["aperture_m"] ** 2)
        weight = aperture * cos / (distance * distance) * self.let_through(cos) * self.air.over(distance)

        sample = dr.zeros(mi.DirectionSample3f, dr.width(it.p))
        sample.p = self.frame.centre
        sample.uv = uv
        sample.d = (sample.p - it.p) / distance
        sample.n = self.frame.z
        sample.dist = distance
        sample.time = it.time
        sample.pdf = dr.select(seen, mi.Float(1), 0)
        sample.delta = mi.Bool(True)
        return sample, mi.Color1f(dr.select(seen, weight, 0))

    def bbox(self):
        return mi.BoundingBox3f()

    def to_string(self):
        return f"RoverCamera{self.size}"


def ground(pack: Pack) -> dict:
    """The triangles as Mitsuba's meshes, one for each reflectivity, flat, seen from both sides."""
    scene = {"type": "scene"}
    for number, part in enumerate(pack.parts):
        props = mi.Properties()
        props["bsdf"] = mi.load_dict({
            "type": "twosided",
            "of": {"type": "diffuse", "reflectance": {"type": "uniform", "value": part.reflectivity}},
        })
        props["face_normals"] = True  # interpolated ones would be another ground
        mesh = mi.Mesh(f"part-{number}", len(pack.vertices), len(part.faces), props=props)
        held = mi.traverse(mesh)
        held["vertex_positions"] = pack.vertices.ravel()
        held["faces"] = part.faces.astype(np.uint32).ravel()
        held.update()
        scene[f"part-{number}"] = mesh
    return scene
