//! Ground of simple shapes. Numbers that are multiples of 1/64 are stored exactly.

use glam::DVec3;
use raypencil_chassis::GroundFaces;
use raypencil_scene::{Material, Mesh};

/// Triangles under construction.
#[derive(Default, Clone)]
pub(crate) struct Shape {
    pub(crate) vertices: Vec<DVec3>,
    pub(crate) faces: Vec<[u32; 3]>,
}

impl Shape {
    /// A square of 32 m of the plane z = height + p x + q y.
    pub(crate) fn plane(height: f64, p: f64, q: f64) -> Self {
        let corner = |(x, y)| DVec3::new(x, y, height + p * x + q * y);
        let corners = [(-16.0, -16.0), (16.0, -16.0), (16.0, 16.0), (-16.0, 16.0)].map(corner);
        Self::default().quad(corners)
    }

    /// A profile (x, z) from left to right, drawn out from y = -16 m to 16 m. Equal x make a vertical wall.
    pub(crate) fn profile(points: &[(f64, f64)]) -> Self {
        points.windows(2).fold(Self::default(), |shape, ends| {
            let [(x0, z0), (x1, z1)] = [ends[0], ends[1]];
            let corner = |x, y, z| DVec3::new(x, y, z);
            shape.quad([
                corner(x0, -16.0, z0),
                corner(x1, -16.0, z1),
                corner(x1, 16.0, z1),
                corner(x0, 16.0, z0),
            ])
        })
    }

    /// A step of this height at x = 0, up towards +x.
    pub(crate) fn step(height: f64) -> Self {
        Self::profile(&[(-16.0, 0.0), (0.0, 0.0), (0.0, height), (16.0, height)])
    }

    /// A trench of vertical sides across x, its middle at x = 0.
    pub(crate) fn trench(width: f64, depth: f64) -> Self {
        let side = 0.5 * width;
        Self::profile(&[
            (-16.0, 0.0),
            (-side, 0.0),
            (-side, -depth),
            (side, -depth),
            (side, 0.0),
            (16.0, 0.0),
        ])
    }

    /// Adds four corners as two triangles.
    pub(crate) fn quad(self, [a, b, c, d]: [DVec3; 4]) -> Self {
        self.triangle([a, b, c]).triangle([a, c, d])
    }

    /// Adds a triangle.
    pub(crate) fn triangle(mut self, corners: [DVec3; 3]) -> Self {
        let first = self.vertices.len() as u32;
        self.vertices.extend(corners);
        self.faces.push([first, first + 1, first + 2]);
        self
    }

    /// Adds a box that stands at z = 0: its middle in plan, its half sizes and its height.
    pub(crate) fn stone(self, (x, y): (f64, f64), (half_x, half_y): (f64, f64), height: f64) -> Self {
        let corner = |sx: f64, sy: f64, z| DVec3::new(x + sx * half_x, y + sy * half_y, z);
        let ring = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
        let top = self.quad(ring.map(|(sx, sy)| corner(sx, sy, height)));
        (0..4).fold(top, |shape, i| {
            let [(ax, ay), (bx, by)] = [ring[i], ring[(i + 1) % 4]];
            shape.quad([
                corner(ax, ay, 0.0),
                corner(bx, by, 0.0),
                corner(bx, by, height),
                corner(ax, ay, height),
            ])
        })
    }

    /// Adds a pyramid that stands at z = 0: its ridges run along x and y, each `half` long in plan.
    pub(crate) fn spike(self, (x, y): (f64, f64), half: f64, height: f64) -> Self {
        let apex = DVec3::new(x, y, height);
        let foot = [(half, 0.0), (0.0, half), (-half, 0.0), (0.0, -half)];
        let foot = foot.map(|(dx, dy)| DVec3::new(x + dx, y + dy, 0.0));
        (0..4).fold(self, |shape, i| shape.triangle([foot[i], foot[(i + 1) % 4], apex]))
    }

    /// Moves all of it.
    pub(crate) fn moved(mut self, by: DVec3) -> Self {
        self.vertices.iter_mut().for_each(|vertex| *vertex += by);
        self
    }

    /// The mirror image in the plane y = 0, with fronts where fronts were.
    pub(crate) fn mirrored(mut self) -> Self {
        self.vertices.iter_mut().for_each(|vertex| vertex.y = -vertex.y);
        self.faces.iter_mut().for_each(|face| face.swap(1, 2));
        self
    }

    pub(crate) fn ground(&self) -> GroundFaces {
        let sand = Material { name: "sand".into(), reflectivity: 0.25 };
        let materials = vec![0; self.faces.len()];
        let mesh = Mesh::from_global(&self.vertices, self.faces.clone(), materials, vec![sand]);
        GroundFaces::new(&mesh.expect("a mesh"))
    }
}

/// Whether two lengths or angles agree up to a few roundings of numbers of size 10.
pub(crate) fn agree(a: f64, b: f64) -> bool {
    (a - b).abs() < 1e-13
}
