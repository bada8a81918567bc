//! Rocks by the law of Golombek and Rapp (1997): how many of each size, where they lie, and their bodies.
//!
//! The share of the ground that rocks of diameter D and more cover is F(D) = k exp(-q D), with k the share that all of them
//! cover and q = 1.79 + 0.152 / k per metre. A rock covers pi D^2 / 4, so that per square metre and metre of diameter
//! there are -F'(D) / (pi D^2 / 4) = 4 k q exp(-q D) / (pi D^2) rocks: in v = 1/D, 4 k q exp(-q / v) / pi per unit of v.
//! That is how they are drawn: a Poisson process of rate 4 k q / pi in v, from 1/largest to 1/smallest, each event kept with
//! probability exp(-q D). A rock's diameter is that of the circle as large as its outline seen from above.

use std::collections::BTreeMap;

use glam::{DVec2, DVec3};

use crate::Ground;
use crate::random_stream::{RandomStream, StreamPurpose};

/// Which rocks lie on the ground.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rocks {
    /// Share k of the ground that rocks of all sizes would cover, 0 to 0.4 (Golombek et al. 2003 give 0.05 to 0.4).
    pub coverage: f64,
    /// The smallest diameter D_min, metres: the law goes on below it, to ever more and smaller ones.
    pub smallest: f64,
    /// The largest diameter D_max, metres.
    pub largest: f64,
}

impl Rocks {
    /// q of the law, per metre.
    pub fn decay(&self) -> f64 {
        1.79 + 0.152 / self.coverage
    }

    /// Share of the ground that rocks from that diameter up to the largest cover: F(D) - F(D_max).
    pub fn cumulative_area(&self, diameter: f64) -> f64 {
        let share = |diameter: f64| self.coverage * libm::exp(-self.decay() * diameter);
        share(diameter) - share(self.largest)
    }

    /// No fewer faces than are to be expected of the rocks on that many square metres.
    pub(super) fn max_expected_faces(&self, area: f64) -> f64 {
        let from = |diameter: f64| {
            (1.0 / self.smallest.max(diameter) - 1.0 / self.largest).max(0.0) * self.rate(area)
        };
        // Those of the least faces, and what larger ones have beyond it.
        32.0 * from(0.0)
            + 96.0 * from(MIN_DIAMETER_OF_128_FACES_M)
            + 384.0 * from(MIN_DIAMETER_OF_512_FACES_M)
    }

    /// Events of the process per unit of 1/D.
    fn rate(&self, area: f64) -> f64 {
        if self.coverage > 0.0 {
            area * 4.0 * self.coverage * self.decay() / std::f64::consts::PI
        } else {
            0.0
        }
    }

    /// The diameters of the rocks on that many square metres, the largest first, metres. A smaller `smallest` of the
    /// same seed adds more at the end.
    pub fn diameters(&self, area: f64, seed: u64) -> Vec<f64> {
        let rate = self.rate(area);
        let mut diameters = Vec::new();
        if !(rate > 0.0) {
            return diameters;
        }
        let mut random = RandomStream::new(seed, StreamPurpose::Rocks);
        let mut curvature = 1.0 / self.largest;
        loop {
            curvature += random.exponential() / rate;
            let diameter = 1.0 / curvature;
            if !(diameter >= self.smallest) {
                return diameters;
            }
            if random.uniform() < libm::exp(-self.decay() * diameter) {
                diameters.push(diameter);
            }
        }
    }
}

/// Where a rock lies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct RockSite {
    pub place: DVec2,
    pub diameter: f64,
}

/// Places for rocks of these diameters (the largest first) on the square of side `extent` about `middle`, wherever
/// `is_free` allows one of that diameter.
///
/// CHOICE: rocks do not lie in one another as long as another place is found within a few draws; the law says
/// nothing of places. The number of rocks does not depend on it.
pub(super) fn place_rocks(
    diameters: &[f64],
    middle: DVec2,
    extent: f64,
    seed: u64,
    is_free: impl Fn(DVec2, f64) -> bool,
) -> Vec<RockSite> {
    const MAX_TRIES_PER_ROCK: usize = 24;
    let mut random = RandomStream::new(seed, StreamPurpose::RockPlaces);
    // Cells as large as the largest rock: two that touch lie in the same or in neighbouring cells.
    let cell = diameters.first().copied().unwrap_or(1.0);
    let cell_of = |place: DVec2| ((place - middle) / cell).floor().to_array().map(|index| index as i64);
    let mut sites: Vec<RockSite> = Vec::with_capacity(diameters.len());
    let mut taken: BTreeMap<[i64; 2], Vec<u32>> = BTreeMap::new();
    for &diameter in diameters {
        let mut chosen = None;
        for _ in 0..MAX_TRIES_PER_ROCK {
            let half = 0.5 * extent;
            let place = middle + DVec2::new(random.between(-half, half), random.between(-half, half));
            if !is_free(place, diameter) {
                continue;
            }
            chosen = Some(place);
            let [i, j] = cell_of(place);
            let near = (i - 1..=i + 1).flat_map(|i| (j - 1..=j + 1).map(move |j| [i, j]));
            let clear = near.filter_map(|cell| taken.get(&cell)).flatten().all(|&other| {
                let other = sites[other as usize];
                place.distance(other.place) > 0.5 * (diameter + other.diameter)
            });
            if clear {
                break;
            }
        }
        // Where nothing is free at all, as on a ground that is all start or crevasse, there is no rock.
        let Some(place) = chosen else { continue };
        taken.entry(cell_of(place)).or_default().push(sites.len() as u32);
        sites.push(RockSite { place, diameter });
    }
    sites
}

/// Rocks from these diameters on, metres, have 128 and 512 faces; smaller ones have 32. CHOICE: facets of some centimetres.
const MIN_DIAMETER_OF_128_FACES_M: f64 = 0.15;
const MIN_DIAMETER_OF_512_FACES_M: f64 = 0.6;

/// How often the faces of a rock's octahedron are cut in four.
fn subdivisions(diameter: f64) -> u32 {
    1 + u32::from(diameter >= MIN_DIAMETER_OF_128_FACES_M)
        + u32::from(diameter >= MIN_DIAMETER_OF_512_FACES_M)
}

/// The bodies of rocks.
pub(super) struct RockBodies {
    random: RandomStream,
    /// Octahedra whose faces are cut in four once, twice and three times, thrown onto the unit sphere.
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

    /// Adds a closed rock of that diameter, its widest level at `centre`.
    ///
    /// The body is a ball that random planes have cut flat, with half axes of its own: the higher of the two vertical ones is
    /// above ground. Every vertex keeps its direction from the centre, so that faces look outward however it is cut.
    ///
    /// CHOICE: half as high above ground as wide (0.3 to 0.7), as rocks at the landing sites stand (Golombek and Rapp
    /// 1997 find linear relations of height and diameter), and up to 0.35 of the diameter deep in it, so that no side of
    /// it hangs over a slope of less than 35 degrees.
    pub(super) fn add(&mut self, ground: &mut Ground, centre: DVec3, diameter: f64, material: u16) {
        let random = &mut self.random;
        let sphere = &self.spheres[subdivisions(diameter) as usize - 1];
        // Flat sides: at least half of the radius is left.
        let planes: Vec<(DVec3, f64)> =
            (0..8).map(|_| (random.unit_vector(), random.between(0.55, 0.95))).collect();
        let cut = |direction: DVec3| {
            planes.iter().fold(1.0_f64, |radius, (normal, distance)| {
                let cosine = normal.dot(direction);
                if cosine * radius > *distance { distance / cosine } else { radius }
            })
        };
        let slender = random.between(0.6, 1.0);
        let (sin, cos) = libm::sincos(random.between(0.0, std::f64::consts::TAU));
        let (height, depth) = (diameter * random.between(0.3, 0.7), 0.35 * diameter);
        let body: Vec<DVec3> = sphere
            .vertices
            .iter()
            .map(|&direction| {
                let DVec3 { x, y, z } = direction * cut(direction);
                let y = slender * y;
                DVec3::new(cos * x - sin * y, sin * x + cos * y, z)
            })
            .collect();
        // As wide as asked for, and as high.
        let scale = diameter * (std::f64::consts::FRAC_PI_4 / plan_area(&body, &sphere.faces)).sqrt();
        let top = body.iter().fold(0.0_f64, |top, v| top.max(v.z));
        let bottom = body.iter().fold(0.0_f64, |bottom, v| bottom.min(v.z));
        let first = ground.vertices.len() as u32;
        for v in body {
            let z = if v.z > 0.0 { v.z * (height / top) } else { v.z * (depth / -bottom) };
            ground.add_vertex(centre + DVec3::new(scale * v.x, scale * v.y, z));
        }
        for face in &sphere.faces {
            ground.add_face(face.map(|corner| first + corner), material);
        }
    }
}

/// Area of the outline of a closed body seen from above: that of all faces that look up, projected. Where the upper
/// side folds over itself that part counts twice.
fn plan_area(vertices: &[DVec3], faces: &[[u32; 3]]) -> f64 {
    let twice = faces.iter().map(|face| {
        let [a, b, c] = face.map(|corner| vertices[corner as usize].truncate());
        (b - a).perp_dot(c - a).max(0.0)
    });
    0.5 * twice.sum::<f64>()
}

/// A triangulated sphere: unit vertices, faces counter-clockwise from outside.
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
            // Mirroring one axis turns the order.
            if octant.count_ones().is_multiple_of(2) { [a, b, c] } else { [a, c, b] }
        };
        Self { vertices, faces: (0..8).map(face).collect() }
    }

    /// Every face cut in four at the middles of its sides.
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
#[path = "../../tests/unit/mars/rocks.rs"]
pub(super) mod tests;
