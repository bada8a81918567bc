//! Random grounds: a height field and, on request, features that are hard to render.

use glam::DVec3;
use raypencil_scene::Material;

use crate::Ground;
use crate::random_stream::{RandomStream, StreamPurpose};

/// Random ground, centred on `offset`.
///
/// Start from [`RandomGround::plain`] or [`RandomGround::nasty`] and change fields. The same fields give the same
/// bytes on every machine.
///
/// Bodies (boulders, overhangs, walls) are closed and reach into the ground. Their centres stay 2 m away from the
/// middle (at most a quarter of `extent`), so that a rover can stand there.
///
/// ```
/// use raypencil_terrain::RandomGround;
///
/// // 2,000 faces are 31 x 31 cells of two faces each: 32 x 32 cells would need 2,048.
/// let ground = RandomGround::plain(7, 2_000, 40.0).build();
/// assert_eq!(ground.faces.len(), 2 * 31 * 31);
/// // The heights stay within a fortieth of the extent.
/// assert!(ground.vertices.iter().all(|vertex| vertex.z.abs() <= 1.0));
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct RandomGround {
    /// Seed: another seed gives another ground with the same settings.
    pub seed: u64,
    /// Approximate number of faces. The height field gets the faces that the features below leave, and at least
    /// one cell of two faces.
    pub faces: usize,
    /// Side of the square of the height field, metres.
    pub extent: f64,
    /// Translation of all vertices, metres. The precision is 1e-10 m at 1e6 m.
    pub offset: DVec3,
    /// Maximum height of the height field above or below its mean level, metres.
    pub relief: f64,
    /// Number of materials, 1 to 65535. Faces and bodies get one at random; reflectivities run from 0.1 to 0.9.
    pub materials: u16,
    /// Number of boulders: closed, irregular rocks of 32 faces.
    pub boulders: usize,
    /// Number of overhangs: alternately closed mushrooms of 64 faces and floating slabs of 12 faces.
    pub overhangs: usize,
    /// Number of walls: closed upright slabs of 12 faces, 2 mm to 0.2 m thick, with exactly vertical sides. Every
    /// second one is parallel to the axes.
    pub walls: usize,
    /// Number of slivers: separate triangles near the ground, up to 3 m long, 1e3 to 1e6 times longer than wide.
    /// Far from the scene origin the thinnest lose their area when they are rounded to `f32`.
    pub slivers: usize,
    /// Number of duplicate faces: the same vertices in the same sense as another face, and a random material.
    pub duplicate_faces: usize,
    /// Number of faces without area: alternately with one vertex twice, two vertices in one place, and three on a
    /// line.
    pub zero_area_faces: usize,
    /// Number of vertices that no face uses.
    pub unreferenced_vertices: usize,
}

/// Faces of a boulder, of a mushroom with [`MUSHROOM_SIDES`] sides, and of a box.
const ROCK_FACES: usize = 32;
const MUSHROOM_FACES: usize = 8 * MUSHROOM_SIDES as usize;
const BOX_FACES: usize = 12;
const MUSHROOM_SIDES: u32 = 8;

impl RandomGround {
    /// Height field alone, of about `faces` faces, over a square of side `extent` metres: the ground for
    /// benchmarks.
    ///
    /// Hills have a third of the extent, the smallest bumps a 24th. No height exceeds a fortieth of the extent.
    pub fn plain(seed: u64, faces: usize, extent: f64) -> Self {
        Self {
            seed,
            faces,
            extent,
            offset: DVec3::ZERO,
            relief: extent / 40.0,
            materials: 1,
            boulders: 0,
            overhangs: 0,
            walls: 0,
            slivers: 0,
            duplicate_faces: 0,
            zero_area_faces: 0,
            unreferenced_vertices: 0,
        }
    }

    /// Ground with every feature. Half of about `faces` faces (from 250 on) are height field.
    ///
    /// The square has a side of 24 m, and more from 4000 faces on, so that the features do not crowd. There is no
    /// offset.
    pub fn nasty(seed: u64, faces: usize) -> Self {
        let extent = 24.0 * (faces as f64 / 4000.0).sqrt().max(1.0);
        let share = |divisor: usize| (faces / divisor).max(1);
        Self {
            relief: 0.8,
            materials: 5,
            boulders: share(250),
            overhangs: share(400).max(2),
            walls: share(240).max(2),
            slivers: share(20),
            duplicate_faces: share(20),
            zero_area_faces: share(20).max(3),
            unreferenced_vertices: share(50),
            ..Self::plain(seed, faces, extent)
        }
    }

    /// Builds the ground.
    ///
    /// # Panics
    /// If `materials` is 0, or `extent` is not a positive, finite number.
    pub fn build(&self) -> Ground {
        assert!(self.materials > 0, "a ground needs a material");
        assert!(self.extent > 0.0 && self.extent.is_finite(), "extent {} m", self.extent);
        let relief = ValueNoise::new(self.seed, self.extent, self.relief);
        let mut ground = Ground { materials: self.material_list(), ..Ground::default() };
        self.add_height_field(&mut ground, &relief);
        self.add_boulders(&mut ground, &relief);
        self.add_overhangs(&mut ground, &relief);
        self.add_walls(&mut ground, &relief);
        self.add_slivers(&mut ground, &relief);
        self.add_duplicate_faces(&mut ground);
        self.add_zero_area_faces(&mut ground, &relief);
        self.add_unreferenced_vertices(&mut ground, &relief);
        if self.offset != DVec3::ZERO {
            for vertex in &mut ground.vertices {
                *vertex += self.offset;
            }
        }
        ground
    }

    fn material_list(&self) -> Vec<Material> {
        let reflectivity = |kind: u16| match self.materials {
            1 => 0.25,
            count => 0.1 + 0.8 * f64::from(kind) / f64::from(count - 1),
        };
        let kind = |kind| Material { name: format!("ground {kind}"), reflectivity: reflectivity(kind) };
        (0..self.materials).map(kind).collect()
    }

    fn draw_material(&self, random: &mut RandomStream) -> u16 {
        random.index_below(usize::from(self.materials)) as u16
    }

    fn add_height_field(&self, ground: &mut Ground, relief: &ValueNoise) {
        // Mushrooms and slabs alternate, mushrooms first.
        let overhangs = self.overhangs.div_ceil(2) * MUSHROOM_FACES + self.overhangs / 2 * BOX_FACES;
        let features = self.boulders * ROCK_FACES
            + overhangs
            + self.walls * BOX_FACES
            + self.slivers
            + self.duplicate_faces
            + self.zero_area_faces;
        // The height field has n x n cells of two faces each.
        let left = self.faces.saturating_sub(features);
        let cells = ((left as f64 / 2.0).sqrt() as u32).max(1);
        let step = self.extent / f64::from(cells);
        ground.vertices.reserve((cells as usize + 1) * (cells as usize + 1));
        ground.faces.reserve(left + features);
        ground.face_materials.reserve(left + features);

        // Corners move by up to j = 1/5 of a cell along x and y. Seen from above, a face then keeps an area of at
        // least ((1 - 2j)^2 - (2j)^2) / 2 = (1 - 4j) / 2 cells. This is positive for j < 1/4, so every normal
        // points up. The border stays straight.
        const MAX_SHIFT_CELLS: f64 = 0.2;
        let mut random = RandomStream::new(self.seed, StreamPurpose::Grid);
        let place = |column: u32, row: u32| {
            let mut coordinate = |index: u32| {
                let shift = random.between(-MAX_SHIFT_CELLS, MAX_SHIFT_CELLS);
                let inside = index > 0 && index < cells;
                step * (f64::from(index) + if inside { shift } else { 0.0 }) - 0.5 * self.extent
            };
            let (x, y) = (coordinate(column), coordinate(row));
            DVec3::new(x, y, relief.at(x, y))
        };
        let mut materials = RandomStream::new(self.seed, StreamPurpose::Materials);
        let mut diagonals = RandomStream::new(self.seed, StreamPurpose::Diagonals);
        ground.add_height_field(
            cells,
            cells,
            place,
            || diagonals.coin(),
            || self.draw_material(&mut materials),
        );
    }

    /// Random point of the height field outside the free circle in the middle.
    fn draw_place(&self, random: &mut RandomStream, relief: &ValueNoise) -> DVec3 {
        let clear = f64::min(2.0, 0.25 * self.extent);
        loop {
            let mut coordinate = || 0.46 * self.extent * random.between(-1.0, 1.0);
            let (x, y) = (coordinate(), coordinate());
            if x * x + y * y > clear * clear {
                return DVec3::new(x, y, relief.at(x, y));
            }
        }
    }

    /// Scale of bodies: 1 on grounds of 20 m and more, smaller in proportion below.
    fn body_scale(&self) -> f64 {
        f64::min(1.0, self.extent / 20.0)
    }

    fn add_boulders(&self, ground: &mut Ground, relief: &ValueNoise) {
        let mut random = RandomStream::new(self.seed, StreamPurpose::Boulders);
        for _ in 0..self.boulders {
            let mut half_axis = || self.body_scale() * random.between(0.15, 0.9);
            let half_axes = DVec3::new(half_axis(), half_axis(), half_axis());
            let site = self.draw_place(&mut random, relief);
            let centre = site + DVec3::new(0.0, 0.0, random.between(0.0, 0.6) * half_axes.z);
            let material = self.draw_material(&mut random);
            ground.add_rock(centre, half_axes, &mut random, material);
        }
    }

    fn add_overhangs(&self, ground: &mut Ground, relief: &ValueNoise) {
        let mut random = RandomStream::new(self.seed, StreamPurpose::Overhangs);
        let scale = self.body_scale();
        for index in 0..self.overhangs {
            let site = self.draw_place(&mut random, relief);
            let radius = scale * random.between(0.3, 1.0);
            let height = scale * random.between(0.4, 1.3);
            let material = self.draw_material(&mut random);
            if index % 2 == 0 {
                let foot = site - DVec3::new(0.0, 0.0, 0.2 * height);
                ground.add_mushroom(foot, 1.2 * height, radius, MUSHROOM_SIDES, &mut random, material);
            } else {
                // A floating slab. The tilt is small enough that its top still looks up.
                let [u, v] = draw_level_axes(&mut random);
                let tilt = DVec3::new(0.0, 0.0, random.between(-0.4, 0.4));
                let thickness = DVec3::new(0.0, 0.0, scale * random.between(0.02, 0.15));
                let sides = [(u + tilt) * radius, v * (radius * random.between(0.3, 1.0)), thickness];
                ground.add_box(site + DVec3::new(0.0, 0.0, height), sides, material);
            }
        }
    }

    fn add_walls(&self, ground: &mut Ground, relief: &ValueNoise) {
        let mut random = RandomStream::new(self.seed, StreamPurpose::Walls);
        let scale = self.body_scale();
        for index in 0..self.walls {
            let site = self.draw_place(&mut random, relief);
            let turned = draw_level_axes(&mut random);
            let [u, v] = if index % 2 == 0 { [DVec3::X, DVec3::Y] } else { turned };
            let half_length = scale * random.between(0.2, 1.2);
            let half_thickness = scale * random.between(0.001, 0.1);
            let half_height = DVec3::new(0.0, 0.0, scale * random.between(0.3, 0.9));
            let material = self.draw_material(&mut random);
            ground.add_box(site, [u * half_length, v * half_thickness, half_height], material);
        }
    }

    fn add_slivers(&self, ground: &mut Ground, relief: &ValueNoise) {
        let mut random = RandomStream::new(self.seed, StreamPurpose::Slivers);
        for _ in 0..self.slivers {
            let site = self.draw_place(&mut random, relief);
            let [along, across] = draw_level_axes(&mut random);
            let length = self.body_scale() * random.between(0.3, 3.0);
            let aspect = libm::pow(10.0, random.between(3.0, 6.0));
            let rise = DVec3::new(0.0, 0.0, random.between(-0.5, 0.5));
            let low = site + DVec3::new(0.0, 0.0, random.between(0.02, 0.4));
            // The third corner lies anywhere along the long side: this gives needles and caps.
            let third = low + (along + rise) * (length * random.uniform()) + across * (length / aspect);
            let corners = [low, low + (along + rise) * length, third].map(|corner| ground.add_vertex(corner));
            let material = self.draw_material(&mut random);
            ground.add_face(corners, material);
        }
    }

    fn add_duplicate_faces(&self, ground: &mut Ground) {
        let mut random = RandomStream::new(self.seed, StreamPurpose::DuplicateFaces);
        let originals = ground.faces.len();
        for _ in 0..self.duplicate_faces {
            let mut corners = ground.faces[random.index_below(originals)];
            corners.rotate_left(random.index_below(3));
            let material = self.draw_material(&mut random);
            ground.add_face(corners, material);
        }
    }

    fn add_zero_area_faces(&self, ground: &mut Ground, relief: &ValueNoise) {
        let mut random = RandomStream::new(self.seed, StreamPurpose::ZeroAreaFaces);
        for index in 0..self.zero_area_faces {
            let site = self.draw_place(&mut random, relief);
            let a = ground.add_vertex(site);
            let b = ground.add_vertex(site + DVec3::new(random.between(0.1, 1.0), 0.0, 0.0));
            let c = match index % 3 {
                0 => a,
                1 => ground.add_vertex(site),
                // y and z are equal to the bit, so the three vertices stay on a line when they are rounded.
                _ => ground.add_vertex(site + DVec3::new(random.between(1.0, 2.0), 0.0, 0.0)),
            };
            let material = self.draw_material(&mut random);
            ground.add_face([a, b, c], material);
        }
    }

    fn add_unreferenced_vertices(&self, ground: &mut Ground, relief: &ValueNoise) {
        let mut random = RandomStream::new(self.seed, StreamPurpose::UnreferencedVertices);
        for _ in 0..self.unreferenced_vertices {
            let site = self.draw_place(&mut random, relief);
            ground.add_vertex(site + DVec3::new(0.0, 0.0, random.between(-1.0, 1.0)));
        }
    }
}

/// Two horizontal unit vectors at right angles, counter-clockwise from above. Neither is parallel to an axis.
fn draw_level_axes(random: &mut RandomStream) -> [DVec3; 2] {
    let (sin, cos) = libm::sincos(random.between(0.0, std::f64::consts::TAU));
    [DVec3::new(cos, sin, 0.0), DVec3::new(-sin, cos, 0.0)]
}

/// Value noise in four octaves: random heights on a lattice, blended with 3t^2 - 2t^3. Each octave is twice as
/// fine and half as high as the one before. (After Perlin's lattice noise; polynomials only)
struct ValueNoise {
    extent: f64,
    amplitude: f64,
    /// Cells per side and lattice heights in [-1, 1) of each octave: (cells + 1)^2 nodes, row by row.
    octaves: Vec<(usize, Vec<f64>)>,
}

impl ValueNoise {
    /// Cells per side of the coarsest octave.
    const COARSEST_CELLS: usize = 3;
    const OCTAVES: usize = 4;

    fn new(seed: u64, extent: f64, relief: f64) -> Self {
        let mut random = RandomStream::new(seed, StreamPurpose::Relief);
        let octave = |octave| {
            let cells = Self::COARSEST_CELLS << octave;
            (cells, (0..(cells + 1) * (cells + 1)).map(|_| random.between(-1.0, 1.0)).collect())
        };
        let octaves = (0..Self::OCTAVES).map(octave).collect();
        // The octaves' amplitudes are 1, 1/2, 1/4, ...: their sum is below 2.
        Self { extent, amplitude: 0.5 * relief, octaves }
    }

    /// Height at a point of the square before the offset, metres; outside, the height at the nearest border.
    fn at(&self, x: f64, y: f64) -> f64 {
        let [u, v] = [x, y].map(|coordinate| (coordinate / self.extent + 0.5).clamp(0.0, 1.0));
        let mut height = 0.0;
        let mut weight = self.amplitude;
        for (cells, nodes) in &self.octaves {
            let locate = |share: f64| {
                let place = share * *cells as f64;
                let cell = (place as usize).min(cells - 1);
                let t = place - cell as f64;
                (cell, t * t * (3.0 - 2.0 * t))
            };
            let ((i, s), (j, t)) = (locate(u), locate(v));
            let node = |i: usize, j: usize| nodes[j * (cells + 1) + i];
            let near = node(i, j) + (node(i + 1, j) - node(i, j)) * s;
            let far = node(i, j + 1) + (node(i + 1, j + 1) - node(i, j + 1)) * s;
            height += weight * (near + (far - near) * t);
            weight *= 0.5;
        }
        height
    }
}

#[cfg(test)]
#[path = "../tests/unit/random_ground.rs"]
mod tests;
