//! Patches: which way round each is, and which of its faces contradict the others.

use glam::{DVec3, Vec3Swizzles as _};

use super::edges::Joints;
use super::shape::Shapes;
use super::{Fate, Inspection, at_face};

/// Of the area of open patches at least so much must be seen from above before they can be upside down: walls that
/// are upright up to a rounding look neither up nor down. CHOICE, and not derived.
const LEAST_LEVEL: f64 = 0.01;

/// All faces that hang together over edges of two faces. Those like the first are its first half, those that
/// run against it the second.
#[derive(Default)]
struct Patch {
    /// The face of the lowest number.
    first: u32,
    /// How many faces are in each half.
    halves: [u32; 2],
    /// Some edge has not just two faces.
    open: bool,
    one_sided: bool,
    /// Six times the volume, if the second half is turned; the sum of the magnitudes that it was added from.
    six_volume: f64,
    magnitude: f64,
}

/// What is wrong with a patch.
#[derive(PartialEq)]
enum Wrong {
    /// One of its halves, which may be empty.
    Half(usize),
    /// One half or the other.
    Undecided,
    /// It has no halves.
    OneSided,
}

impl Patch {
    /// Adds a face of the closed surface: a . (b x c) of its corners from any one place. (Gauss)
    fn add_volume(&mut self, [a, b, c]: [DVec3; 3], turned: bool) {
        let volume = a.dot(b.cross(c));
        self.six_volume += if turned { -volume } else { volume };
        let [a, b, c] = [a.abs(), b.abs(), c.abs()];
        self.magnitude += a.dot(b.yzx() * c.zxy() + b.zxy() * c.yzx());
    }

    /// How far rounding may have moved `six_volume`. Each product of three differences is rounded 8 times at
    /// most on its way into a face's sum, and as often again as there are faces: (n + 8) u of the magnitudes, u = 2^-53.
    /// Twice that also covers the higher powers of u, and the rounding of the magnitudes.
    fn volume_error(&self) -> f64 {
        (self.faces() as f64 + 8.0) * f64::EPSILON * self.magnitude
    }

    fn faces(&self) -> u64 {
        u64::from(self.halves[0]) + u64::from(self.halves[1])
    }

    fn wrong(&self) -> Wrong {
        if self.one_sided {
            return Wrong::OneSided;
        }
        if !self.open && self.six_volume.abs() > self.volume_error() {
            return Wrong::Half(usize::from(self.six_volume > 0.0));
        }
        match self.halves[0].cmp(&self.halves[1]) {
            std::cmp::Ordering::Less => Wrong::Half(0),
            std::cmp::Ordering::Equal => Wrong::Undecided,
            std::cmp::Ordering::Greater => Wrong::Half(1),
        }
    }
}

/// Finds faces that are the wrong way round, and closed components.
pub(super) fn find_inverted(
    shapes: &Shapes,
    mut joints: Joints,
    fates: &mut [Fate],
    inspection: &mut Inspection,
) {
    // Patches by number; the first face of each comes first, as it is the root.
    let mut numbers = vec![u32::MAX; fates.len()];
    let mut patches: Vec<Patch> = Vec::new();
    for face in shapes.faces().filter(|&face| fates[face as usize].stays()) {
        let (root, turned) = joints.patches.root(face);
        if root == face {
            numbers[face as usize] = patches.len() as u32;
            patches.push(Patch { first: face, ..Patch::default() });
        }
        let number = numbers[root as usize];
        numbers[face as usize] = number;
        let patch = &mut patches[number as usize];
        patch.halves[usize::from(turned)] += 1;
        patch.open |= joints.at_rim[face as usize];
        // From a place of its own, so that a far body does not drown in rounding.
        let [from, ..] = shapes.corners(patch.first);
        patch.add_volume(shapes.corners(face).map(|corner| corner - from), turned);
    }
    for &face in &joints.one_sided {
        patches[numbers[face as usize] as usize].one_sided = true;
    }

    for patch in &patches {
        let example = || at_face(patch.first, shapes.middle(patch.first));
        inspection.closed_components += usize::from(!patch.open);
        if !patch.open && !patch.one_sided {
            inspection.volume += patch.six_volume.abs() / 6.0;
        }
        match patch.wrong() {
            Wrong::OneSided => inspection.one_sided_patches.add(example),
            Wrong::Undecided => inspection.undecided_patches.add(example),
            Wrong::Half(0) if patch.halves[1] == 0 => inspection.inside_out += 1,
            Wrong::Half(_) => {}
        }
    }

    // Seen from above, the open patches show these areas of front and back faces; a closed one as much of both.
    let (mut up, mut down, mut area) = (0.0, 0.0, 0.0);
    for face in shapes.faces().filter(|&face| numbers[face as usize] != u32::MAX) {
        let patch = &patches[numbers[face as usize] as usize];
        let (_, turned) = joints.patches.root(face);
        if patch.wrong() == Wrong::Half(usize::from(turned)) {
            fates[face as usize] = Fate::Inverted;
            inspection.inverted.add(|| at_face(face, shapes.middle(face)));
        }
        if patch.open {
            let normal = shapes.normal(face);
            area += normal.length();
            *(if normal.z < 0.0 { &mut down } else { &mut up }) += normal.z.abs();
        }
    }
    inspection.upside_down = down > up && down + up > LEAST_LEVEL * area;
}
