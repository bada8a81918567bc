//! Bodies of rocks: rounded, angular and flat ones, tilted, and sunk more or less deep.

use std::collections::BTreeMap;

use glam::{DMat3, DVec2, DVec3};

use crate::Ground;
use crate::random_stream::{RandomStream, StreamPurpose};

/// Diameters, metres, from which rocks have 128 and 512 faces; smaller ones have 32. CHOICE: facets of some
/// centimetres.
pub(super) const MIN_DIAMETER_OF_128_FACES_M: f64 = 0.15;
pub(super) const MIN_DIAMETER_OF_512_FACES_M: f64 = 0.6;

/// Number of times that the faces of a rock's octahedron are cut in four.
fn subdivisions(diameter: f64) -> u32 {
    1 + u32::from(diameter >= MIN_DIAMETER_OF_128_FACES_M)
        + u32::from(diameter >= MIN_DIAMETER_OF_512_FACES_M)
}

/// Kind of a rock: how a ball becomes its body. All numbers are CHOICES, to the eye of pictures of the landing sites.
struct Kind {
    /// Number of planes that cut the ball flat.
    planes: u32,
    /// Range of the distance of such a plane from the centre, in radii of the ball.
    distance: [f64; 2],
    /// Range of the half axis along z, where the longest horizontal one is 1.
    height: [f64; 2],
}

/// Broken blocks, with large flat sides.
const ANGULAR: Kind = Kind { planes: 10, distance: [0.5, 0.9], height: [0.5, 0.8] };
/// Worn stones.
const ROUNDED: Kind = Kind { planes: 5, distance: [0.85, 1.0], height: [0.5, 0.75] };
/// Plates of layered rock.
const FLAT: Kind = Kind { planes: 7, distance: [0.6, 0.95], height: [0.2, 0.35] };

/// Shares of angular and of rounded rocks; the rest are flat.
const SHARES: [f64; 2] = [0.6, 0.2];

/// Range of the half axis across, where the longest one is 1.
const BREADTH: [f64; 2] = [0.6, 1.0];

/// Standard deviation of the tilt of a rock, and its limit, radians: 12 and 35 degrees.
const TILT: f64 = 12.0 * std::f64::consts::PI / 180.0;
const MAX_TILT: f64 = 35.0 * std::f64::consts::PI / 180.0;

/// Range of the share of a rock's height that is below ground.
const SUNK: [f64; 2] = [0.15, 0.6];

/// Largest slope that rocks follow. On steeper ground they stand more upright than it.
const MAX_GRADIENT: f64 = 0.7;

/// Generator of rock bodies.
pub(super) struct RockBodies {
    random: RandomStream,
    /// Octahedra whose faces are cut in four once, twice and three times, projected onto the unit sphere.
    spheres: [Sphere; 3],
}

impl RockBodies {
    pub(super) fn new(seed: u64) -> Self {
        let mut sphere = Sphere::octahedron();
        let spheres = [(); 3].map(|()| {
            sphere = sphere.subdivided();
            sphere.clone()
        });
        Self { random: RandomStream::new(seed, StreamPurpose::RockShapes), spheres }
    }

    /// Adds a closed rock of that diameter at a place on the ground, whose slope there is `gradient`.
    ///
    /// The body is a ball that random planes have cut flat, stretched along three axes and tilted. Then it is scaled:
    /// the part above ground, seen from above, has the area of a circle of the diameter. At last it is sheared along z
    /// by the slope, so that it lies on the ground as it would on level ground. All steps but the cut are linear, and
    /// the cut keeps each vertex on its ray from the centre: the body stays closed, and its faces look outward.
    ///
    /// Where less than half of it is below ground its widest level is above ground, and it hangs over.
    pub(super) fn add(
        &mut self,
        ground: &mut Ground,
        place: DVec3,
        gradient: DVec2,
        diameter: f64,
        material: u16,
    ) {
        let random = &mut self.random;
        let sphere = &self.spheres[subdivisions(diameter) as usize - 1];
        let kind = match random.uniform() {
            chosen if chosen < SHARES[0] => &ANGULAR,
            chosen if chosen < SHARES[0] + SHARES[1] => &ROUNDED,
            _ => &FLAT,
        };
        let planes: Vec<(DVec3, f64)> = (0..kind.planes)
            .map(|_| (random.unit_vector(), random.between(kind.distance[0], kind.distance[1])))
            .collect();
        let cut = |direction: DVec3| {
            planes.iter().fold(1.0_f64, |radius, (normal, distance)| {
                let cosine = normal.dot(direction);
                if cosine * radius > *distance { distance / cosine } else { radius }
            })
        };
        let axes = DVec3::new(
            1.0,
            random.between(BREADTH[0], BREADTH[1]),
            random.between(kind.height[0], kind.height[1]),
        );
        let turned = turn(random) * DMat3::from_diagonal(axes);
        let body: Vec<DVec3> =
            sphere.vertices.iter().map(|&direction| turned * (direction * cut(direction))).collect();
        let low = body.iter().fold(f64::INFINITY, |low, v| low.min(v.z));
        let high = body.iter().fold(f64::NEG_INFINITY, |high, v| high.max(v.z));
        let level = low + (high - low) * random.between(SUNK[0], SUNK[1]);
        let area = plan_area_above(&body, &sphere.faces, level);
        let scale = diameter * (std::f64::consts::FRAC_PI_4 / area).sqrt();
        let slope = gradient.clamp_length_max(MAX_GRADIENT);
        let first = ground.vertices.len() as u32;
        for v in body {
            let across = v.truncate() * scale;
            ground.add_vertex(place + across.extend((v.z - level) * scale + slope.dot(across)));
        }
        for face in &sphere.faces {
            ground.add_face(face.map(|corner| first + corner), material);
        }
    }
}

/// A random rotation: about z by any angle, then about a random level axis by the tilt.
fn turn(random: &mut RandomStream) -> DMat3 {
    let mut angle = || libm::sincos(random.between(0.0, std::f64::consts::TAU));
    let ((sin_yaw, cos_yaw), (sin_axis, cos_axis)) = (angle(), angle());
    let (sin, cos) = libm::sincos((TILT * random.normal()).clamp(-MAX_TILT, MAX_TILT));
    let about_z = |sin: f64, cos: f64| {
        DMat3::from_cols(DVec3::new(cos, sin, 0.0), DVec3::new(-sin, cos, 0.0), DVec3::Z)
    };
    let about_x = DMat3::from_cols(DVec3::X, DVec3::new(0.0, cos, sin), DVec3::new(0.0, -sin, cos));
    about_z(sin_axis, cos_axis) * about_x * about_z(-sin_axis, cos_axis) * about_z(sin_yaw, cos_yaw)
}

/// Area of the outline, from above, of the part of a closed body above a level: the projected area of all faces that
/// look up, as far as they are above it. Where the upper side folds over itself that part counts twice.
fn plan_area_above(vertices: &[DVec3], faces: &[[u32; 3]], level: f64) -> f64 {
    let twice = faces.iter().map(|face| {
        let corners = face.map(|corner| vertices[corner as usize]);
        // The polygon of the part of the face above the level, as a fan about its first corner.
        let mut above: Vec<DVec2> = Vec::with_capacity(4);
        for (from, to) in [(0, 1), (1, 2), (2, 0)].map(|(i, j)| (corners[i], corners[j])) {
            if from.z >= level {
                above.push(from.truncate());
            }
            if (from.z >= level) != (to.z >= level) {
                let share = (level - from.z) / (to.z - from.z);
                above.push(from.truncate().lerp(to.truncate(), share));
            }
        }
        let fan = above.windows(2).skip(1).map(|pair| (pair[0] - above[0]).perp_dot(pair[1] - above[0]));
        fan.sum::<f64>().max(0.0)
    });
    0.5 * twice.sum::<f64>()
}

/// Triangulated sphere: unit vertices, faces counter-clockwise from outside.
#[derive(Clone)]
struct Sphere {
    vertices: Vec<DVec3>,
    faces: Vec<[u32; 3]>,
}

impl Sphere {
    fn octahedron() -> Self {
        let vertices = DVec3::AXES.into_iter().flat_map(|axis| [axis, -axis]).collect();
        let face = |octant: u32| {
            let (a, b, c) = (octant & 1, 2 + (octant >> 1 & 1), 4 + (octant >> 2));
            // Mirroring one axis reverses the order.
            if octant.count_ones().is_multiple_of(2) { [a, b, c] } else { [a, c, b] }
        };
        Self { vertices, faces: (0..8).map(face).collect() }
    }

    /// The sphere with every face cut in four at the midpoints of its sides.
    fn subdivided(&self) -> Self {
        let mut vertices = self.vertices.clone();
        let mut middles = BTreeMap::new();
        let mut middle_of = |a: u32, b: u32| {
            *middles.entry([a.min(b), a.max(b)]).or_insert_with(|| {
                vertices.push((self.vertices[a as usize] + self.vertices[b as usize]).normalize());
                vertices.len() as u32 - 1
            })
        };
        let mut faces = Vec::with_capacity(4 * self.faces.len());
        for &[a, b, c] in &self.faces {
            let (ab, bc, ca) = (middle_of(a, b), middle_of(b, c), middle_of(c, a));
            faces.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
        }
        Self { vertices, faces }
    }
}

#[cfg(test)]
#[path = "../../tests/unit/mars/rock_bodies.rs"]
pub(super) mod tests;
