//! Rocks by the law of Golombek and Rapp (1997): sizes, places and bodies.
//!
//! Rocks of diameter D and more cover the fraction F(D) = k exp(-q D) of the ground. Here k is the fraction that
//! all rocks cover, and q = 1.79 + 0.152 / k per metre. One rock covers pi D^2 / 4. Per square metre and metre of
//! diameter there are therefore -F'(D) / (pi D^2 / 4) = 4 k q exp(-q D) / (pi D^2) rocks, or
//! 4 k q exp(-q / v) / pi per unit of v = 1/D.
//!
//! Diameters are drawn from this density: events of a Poisson process of rate 4 k q / pi in v, from 1/largest to
//! 1/smallest, are kept with probability exp(-q D). The diameter of a rock is that of the circle with the
//! same area as its outline from above.

use std::collections::BTreeMap;

use glam::{DVec2, DVec3};

use crate::Ground;
use crate::random_stream::{RandomStream, StreamPurpose};

/// Size distribution of the rocks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rocks {
    /// Fraction k of the ground that rocks of all sizes would cover, 0 to 0.4. (Golombek et al. 2003 give 0.05 to
    /// 0.4)
    pub coverage: f64,
    /// Smallest diameter D_min, metres. The law continues below it with ever more and smaller rocks.
    pub smallest: f64,
    /// Largest diameter D_max, metres.
    pub largest: f64,
}

impl Rocks {
    /// Decay rate q of the law, per metre.
    pub fn decay(&self) -> f64 {
        1.79 + 0.152 / self.coverage
    }

    /// Fraction of the ground covered by rocks from `diameter` (metres) up to the largest: F(D) - F(D_max).
    pub fn cumulative_area(&self, diameter: f64) -> f64 {
        let share = |diameter: f64| self.coverage * libm::exp(-self.decay() * diameter);
        share(diameter) - share(self.largest)
    }

    /// Upper bound on the expected number of faces of the rocks on `area` square metres.
    pub(super) fn max_expected_faces(&self, area: f64) -> f64 {
        let from = |diameter: f64| {
            (1.0 / self.smallest.max(diameter) - 1.0 / self.largest).max(0.0) * self.rate(area)
        };
        // 32 faces for each rock, plus the additional faces of the larger ones.
        32.0 * from(0.0)
            + 96.0 * from(MIN_DIAMETER_OF_128_FACES_M)
            + 384.0 * from(MIN_DIAMETER_OF_512_FACES_M)
    }

    /// Rate of the Poisson process: events per unit of 1/D.
    fn rate(&self, area: f64) -> f64 {
        if self.coverage > 0.0 {
            area * 4.0 * self.coverage * self.decay() / std::f64::consts::PI
        } else {
            0.0
        }
    }

    /// Diameters of the rocks on `area` square metres, metres, in descending order. A smaller `smallest` with the
    /// same seed appends more rocks at the end.
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

/// Place and size of a rock.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct RockSite {
    pub place: DVec2,
    pub diameter: f64,
}

/// Places for rocks of these diameters (in descending order) on the square of side `extent` about `middle`,
/// wherever `is_free` allows a rock of that diameter.
///
/// CHOICE: the law does not give places. A rock avoids earlier rocks if one of its first tries finds a clear
/// place; otherwise it overlaps them. The number of rocks does not depend on this.
pub(super) fn place_rocks(
    diameters: &[f64],
    middle: DVec2,
    extent: f64,
    seed: u64,
    is_free: impl Fn(DVec2, f64) -> bool,
) -> Vec<RockSite> {
    const MAX_TRIES_PER_ROCK: usize = 24;
    let mut random = RandomStream::new(seed, StreamPurpose::RockPlaces);
    // Cells as large as the largest rock: two rocks that touch lie in the same cell or in neighbouring cells.
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
        // A ground that is nowhere free (all start area or crevasse) gets no rock.
        let Some(place) = chosen else { continue };
        taken.entry(cell_of(place)).or_default().push(sites.len() as u32);
        sites.push(RockSite { place, diameter });
    }
    sites
}

/// Diameters, metres, from which rocks have 128 and 512 faces; smaller ones have 32. CHOICE: facets of some
/// centimetres.
const MIN_DIAMETER_OF_128_FACES_M: f64 = 0.15;
const MIN_DIAMETER_OF_512_FACES_M: f64 = 0.6;

/// Number of times that the faces of a rock's octahedron are cut in four.
fn subdivisions(diameter: f64) -> u32 {
    1 + u32::from(diameter >= MIN_DIAMETER_OF_128_FACES_M)
        + u32::from(diameter >= MIN_DIAMETER_OF_512_FACES_M)
}

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

    /// Adds a closed rock of that diameter; its widest level is at `centre`.
    ///
    /// The body is a ball that random planes have cut flat, with separate half axes; the part above `centre` is
    /// above ground. Every vertex keeps its direction from the centre, so faces look outward however the ball is
    /// cut.
    ///
    /// CHOICE: the height above ground is 0.3 to 0.7 of the diameter, as rocks at the landing sites stand.
    /// (Golombek and Rapp 1997 find linear relations of height and diameter) The rock reaches 0.35 of the
    /// diameter into the ground, so that no side hangs over a slope of less than 35 degrees.
    pub(super) fn add(&mut self, ground: &mut Ground, centre: DVec3, diameter: f64, material: u16) {
        let random = &mut self.random;
        let sphere = &self.spheres[subdivisions(diameter) as usize - 1];
        // Flat sides: at least half of the radius remains.
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
        // Scaled to the required width and height.
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

/// Area of the outline of a closed body from above: the projected area of all faces that look up. Where the upper
/// side folds over itself that part counts twice.
fn plan_area(vertices: &[DVec3], faces: &[[u32; 3]]) -> f64 {
    let twice = faces.iter().map(|face| {
        let [a, b, c] = face.map(|corner| vertices[corner as usize].truncate());
        (b - a).perp_dot(c - a).max(0.0)
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
#[path = "../../tests/unit/mars/rocks.rs"]
pub(super) mod tests;
