//! The faces that carry a vehicle, in a tree of boxes.

use glam::{DVec2, DVec3};
use raypencil_scene::Mesh;

use crate::rectangle::Rectangle;

/// The faces of a mesh that carry or stop a vehicle, sorted once into a tree of boxes.
///
/// Two kinds of faces are ground:
///
/// * Faces whose normal points up.
/// * Vertical faces. The top of a wall is usually an edge of a face that looks up. But a thin sheet that stands alone
///   has no such face, and must stop a wheel too. A face is vertical if, in plan, it is not thicker than the rounding
///   of its stored vertices: 2^-22 of its largest coordinate (0.2 um at 1 m from the mesh's origin).
///
/// Undersides and faces without area are no ground. An underside of a closed solid has a higher face above it that
/// looks up, so nothing is lost.
///
/// CHOICE: the space below every ground face is solid, down to the ground. A vehicle does not pass under an overhang.
///
/// Memory: at most 40 bytes a face and 28 bytes a box, with at most one box a face: 68 bytes, whatever the sizes
/// of the faces.
///
/// ```
/// use glam::DVec3;
/// use raypencil_chassis::GroundFaces;
/// use raypencil_scene::{Material, Mesh};
///
/// let sand = Material { name: "sand".into(), reflectivity: 0.25 };
/// // A face that looks up, the same face seen from below, and a sheet that stands upright.
/// let corners = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// let faces = vec![[0, 1, 2], [0, 2, 1], [0, 1, 3]];
/// let mesh = Mesh::from_global(&corners, faces, vec![0; 3], vec![sand])?;
/// assert_eq!(GroundFaces::new(&mesh).len(), 2);
/// # Ok::<(), raypencil_scene::SceneError>(())
/// ```
#[derive(Debug, Clone)]
pub struct GroundFaces {
    origin: DVec3,
    /// Ordered as the leaves are.
    faces: Vec<Face>,
    /// The root first. The first child of a box follows it.
    boxes: Vec<PlanBox>,
}

/// A face: its corners from the mesh's origin, metres, and its index in the mesh.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Face {
    pub(crate) corners: [[f32; 3]; 3],
    pub(crate) index: u32,
}

/// The box of some faces: its plan, and the height of the highest corner. From the mesh's origin, metres.
#[derive(Debug, Clone, Copy)]
struct PlanBox {
    low: [f32; 2],
    high: [f32; 2],
    top: f32,
    /// Number of faces, if this is a leaf; else 0.
    count: u32,
    /// Of a leaf, its first face; else the second child.
    next: u32,
}

/// Largest number of faces in a leaf. Halving more than this many leaves at least two in each half, so there is at most
/// one box a face.
const MAX_LEAF_FACES: usize = 4;

/// Boxes that wait during a search. Each halving of up to 2^32 faces leaves one waiting: 33 are enough.
const MAX_WAITING: usize = 40;

/// Thickness in plan up to which a face is vertical, as a share of its largest plan coordinate. Storing a vertex as f32
/// moves it by up to 2^-24 of the coordinate along each axis, thus by sqrt(2) 2^-24. A corner moves against the line
/// through the other two by at most twice that, 2.9 x 2^-24: less than 2^-22.
const MAX_WALL_THICKNESS_SHARE: f64 = 1.0 / 4_194_304.0;

/// Whether a face is ground: it looks up, or it is vertical.
fn is_ground(corners: &[[f32; 3]; 3]) -> bool {
    let [a, b, c] = corners.map(|[x, y, z]| DVec3::new(f64::from(x), f64::from(y), f64::from(z)));
    let twice_area = (b - a).truncate().perp_dot((c - a).truncate());
    if twice_area > 0.0 {
        return true;
    }
    let longest_side =
        [a - b, b - c, c - a].map(|side| side.truncate().length()).into_iter().fold(0.0, f64::max);
    let largest =
        [a, b, c].map(|corner| corner.truncate().abs().max_element()).into_iter().fold(0.0, f64::max);
    // Thickness times longest side; a product, since a vertical needle has no side in plan.
    let is_vertical = -twice_area <= MAX_WALL_THICKNESS_SHARE * largest * longest_side;
    is_vertical && (b - a).cross(c - a) != DVec3::ZERO
}

impl Face {
    /// Smallest and largest coordinate along a plan axis.
    fn range(&self, axis: usize) -> [f32; 2] {
        let [a, b, c] = self.corners.map(|corner| corner[axis]);
        [a.min(b).min(c), a.max(b).max(c)]
    }

    /// Twice the middle of the box along a plan axis.
    fn middle(&self, axis: usize) -> f32 {
        let [low, high] = self.range(axis);
        low + high
    }
}

/// What a search through the faces over a rectangle asks for.
pub(crate) trait Search {
    /// Whether a face no corner of which is above `top` (from the mesh's origin, metres) can matter.
    fn can_matter(&self, top: f64) -> bool;

    /// A face whose box touches that of the rectangle.
    fn visit(&mut self, face: &Face);
}

impl GroundFaces {
    /// Collects and sorts the ground faces of a mesh.
    pub fn new(mesh: &Mesh) -> Self {
        let faces = mesh.faces().iter().enumerate().map(|(index, face)| Face {
            corners: face.map(|vertex| mesh.vertices()[vertex as usize]),
            index: index as u32,
        });
        let mut faces: Vec<Face> = faces.filter(|face| is_ground(&face.corners)).collect();
        faces.shrink_to_fit();
        let mut boxes = Vec::new();
        if !faces.is_empty() {
            add_boxes(&mut faces, 0, &mut boxes);
        }
        boxes.shrink_to_fit();
        Self { origin: mesh.origin(), faces, boxes }
    }

    /// Number of faces that are ground.
    pub fn len(&self) -> usize {
        self.faces.len()
    }

    /// Whether there is no ground at all.
    pub fn is_empty(&self) -> bool {
        self.faces.is_empty()
    }

    /// Origin of the mesh, global, metres.
    pub(crate) fn origin(&self) -> DVec3 {
        self.origin
    }

    /// Visits all faces over a rectangle that can matter, and perhaps some beside it.
    pub(crate) fn search(&self, rectangle: &Rectangle, search: &mut impl Search) {
        if !rectangle.is_finite() || self.boxes.is_empty() {
            return;
        }
        let [low, high] = rectangle.bounds();
        let touches = |plan: &PlanBox| {
            let [from, to] = [plan.low, plan.high].map(|[x, y]| DVec2::new(f64::from(x), f64::from(y)));
            from.x <= high.x && from.y <= high.y && to.x >= low.x && to.y >= low.y
        };
        let mut waiting = [0_u32; MAX_WAITING];
        let mut count = 1;
        while count > 0 {
            count -= 1;
            let at = waiting[count];
            let plan = &self.boxes[at as usize];
            if !touches(plan) || !search.can_matter(f64::from(plan.top)) {
                continue;
            }
            if plan.count > 0 {
                let first = plan.next as usize;
                for face in &self.faces[first..first + plan.count as usize] {
                    search.visit(face);
                }
                continue;
            }
            // The higher child first: what it finds rules out most of the other one.
            let (first, second) = (at + 1, plan.next);
            let first_is_higher = self.boxes[first as usize].top >= self.boxes[second as usize].top;
            let (sooner, later) = if first_is_higher { (first, second) } else { (second, first) };
            waiting[count] = later;
            waiting[count + 1] = sooner;
            count += 2;
        }
    }
}

/// Adds the boxes of `faces`, which begin at face `first`, and puts the faces into the order of the leaves.
fn add_boxes(faces: &mut [Face], first: usize, boxes: &mut Vec<PlanBox>) {
    let mut plan = PlanBox {
        low: [f32::INFINITY; 2],
        high: [f32::NEG_INFINITY; 2],
        top: f32::NEG_INFINITY,
        count: 0,
        next: 0,
    };
    let mut middles = [[f32::INFINITY, f32::NEG_INFINITY]; 2];
    for face in faces.iter() {
        for axis in 0..2 {
            let [low, high] = face.range(axis);
            plan.low[axis] = plan.low[axis].min(low);
            plan.high[axis] = plan.high[axis].max(high);
            let middle = face.middle(axis);
            middles[axis] = [middles[axis][0].min(middle), middles[axis][1].max(middle)];
        }
        plan.top = plan.top.max(face.range(2)[1]);
    }
    let at = boxes.len();
    boxes.push(plan);
    if faces.len() <= MAX_LEAF_FACES {
        boxes[at].count = faces.len() as u32;
        boxes[at].next = first as u32;
        return;
    }
    let axis = usize::from(middles[1][1] - middles[1][0] > middles[0][1] - middles[0][0]);
    let half = faces.len() / 2;
    // The index makes the order total, and the halves the same on every machine.
    faces.select_nth_unstable_by(half, |a, b| {
        a.middle(axis).total_cmp(&b.middle(axis)).then(a.index.cmp(&b.index))
    });
    let (left, right) = faces.split_at_mut(half);
    add_boxes(left, first, boxes);
    boxes[at].next = boxes.len() as u32;
    add_boxes(right, first + half, boxes);
}

#[cfg(test)]
#[path = "../tests/unit/ground_faces.rs"]
mod tests;
