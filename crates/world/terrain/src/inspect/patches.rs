//! Patches: the orientation of each, and the faces that contradict it.

use glam::{DVec3, Vec3Swizzles as _};

use super::edges::FaceConnectivity;
use super::geometry::MeshGeometry;
use super::report::{Inspection, Occurrence};
use super::status::FaceStatus;

/// Minimum fraction of the area of open patches, projected on the horizontal, before they can be upside down.
/// Walls that are vertical up to rounding face neither up nor down. CHOICE: not derived.
const MIN_HORIZONTAL_SHARE: f64 = 0.01;

/// Faces connected over edges of two faces. The first half has the orientation of the first face, the second half
/// the opposite one.
#[derive(Default)]
struct Patch {
    /// Face of the lowest number.
    first: u32,
    /// Number of faces in each half.
    halves: [u32; 2],
    /// Whether some edge is not shared by exactly two faces.
    open: bool,
    non_orientable: bool,
    /// Six times the volume with the second half turned, and the sum of the magnitudes of its terms.
    six_volume: f64,
    magnitude: f64,
}

/// Faces of a patch with the wrong orientation.
#[derive(PartialEq)]
enum WrongFaces {
    /// One of the halves, which may be empty.
    Half(usize),
    /// One of two halves of equal size.
    Undecided,
    /// Undefined: the patch has no two sides.
    NonOrientable,
}

impl Patch {
    /// Adds the volume term of a face, a . (b x c) of its corners relative to a fixed place. (Gauss)
    fn add_volume(&mut self, [a, b, c]: [DVec3; 3], turned: bool) {
        let volume = a.dot(b.cross(c));
        self.six_volume += if turned { -volume } else { volume };
        let [a, b, c] = [a.abs(), b.abs(), c.abs()];
        self.magnitude += a.dot(b.yzx() * c.zxy() + b.zxy() * c.yzx());
    }

    /// Bound on the rounding of `six_volume`. Each product of three differences is rounded at most 8 times on its
    /// way into a face's term, and once for each of the n faces in the sum: (n + 8) u of the magnitudes, u =
    /// 2^-53. Twice that also covers the higher powers of u and the rounding of the magnitudes.
    fn volume_error(&self) -> f64 {
        (self.faces() as f64 + 8.0) * f64::EPSILON * self.magnitude
    }

    fn faces(&self) -> u64 {
        u64::from(self.halves[0]) + u64::from(self.halves[1])
    }

    fn wrong(&self) -> WrongFaces {
        if self.non_orientable {
            return WrongFaces::NonOrientable;
        }
        if !self.open && self.six_volume.abs() > self.volume_error() {
            return WrongFaces::Half(usize::from(self.six_volume > 0.0));
        }
        match self.halves[0].cmp(&self.halves[1]) {
            std::cmp::Ordering::Less => WrongFaces::Half(0),
            std::cmp::Ordering::Equal => WrongFaces::Undecided,
            std::cmp::Ordering::Greater => WrongFaces::Half(1),
        }
    }
}

/// Finds faces with the wrong orientation, and closed components.
pub(super) fn find_inverted(
    geometry: &MeshGeometry,
    mut connectivity: FaceConnectivity,
    statuses: &mut [FaceStatus],
    inspection: &mut Inspection,
) {
    // Patches by number. The first face of each comes first, since it is the root.
    let mut numbers = vec![u32::MAX; statuses.len()];
    let mut patches: Vec<Patch> = Vec::new();
    for face in geometry.faces().filter(|&face| statuses[face as usize].is_surface()) {
        let (root, turned) = connectivity.patches.find(face);
        if root == face {
            numbers[face as usize] = patches.len() as u32;
            patches.push(Patch { first: face, ..Patch::default() });
        }
        let number = numbers[root as usize];
        numbers[face as usize] = number;
        let patch = &mut patches[number as usize];
        patch.halves[usize::from(turned)] += 1;
        patch.open |= connectivity.at_patch_border[face as usize];
        // Relative to a vertex of the patch, so that a far body is not lost in rounding.
        let [from, ..] = geometry.corners(patch.first);
        patch.add_volume(geometry.corners(face).map(|corner| corner - from), turned);
    }
    for &face in &connectivity.non_orientable {
        patches[numbers[face as usize] as usize].non_orientable = true;
    }

    for patch in &patches {
        let example = || Occurrence::at_face(patch.first, geometry.middle(patch.first));
        inspection.closed_components += usize::from(!patch.open);
        if !patch.open && !patch.non_orientable {
            inspection.volume += patch.six_volume.abs() / 6.0;
        }
        match patch.wrong() {
            WrongFaces::NonOrientable => inspection.non_orientable_patches.add(example),
            WrongFaces::Undecided => inspection.undecided_patches.add(example),
            WrongFaces::Half(0) if patch.halves[1] == 0 => inspection.inside_out_components += 1,
            WrongFaces::Half(_) => {}
        }
    }

    // Areas of front and back faces that the open patches show from above; a closed patch shows as much of both.
    let (mut up, mut down, mut area) = (0.0, 0.0, 0.0);
    for face in geometry.faces().filter(|&face| numbers[face as usize] != u32::MAX) {
        let patch = &patches[numbers[face as usize] as usize];
        let (_, turned) = connectivity.patches.find(face);
        if patch.wrong() == WrongFaces::Half(usize::from(turned)) {
            statuses[face as usize] = FaceStatus::Inverted;
            inspection.inverted.add(|| Occurrence::at_face(face, geometry.middle(face)));
        }
        if patch.open {
            let normal = geometry.normal(face);
            area += normal.length();
            *(if normal.z < 0.0 { &mut down } else { &mut up }) += normal.z.abs();
        }
    }
    inspection.upside_down = down > up && down + up > MIN_HORIZONTAL_SHARE * area;
}
