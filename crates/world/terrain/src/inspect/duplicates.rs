//! Duplicate and double-sided faces: faces on the same three places.

use super::geometry::MeshGeometry;
use super::report::{Inspection, Occurrence};
use super::status::FaceStatus;

/// Marks duplicate faces and counts double-sided sheets.
pub(super) fn find_duplicates(
    geometry: &MeshGeometry,
    welded: &[u32],
    statuses: &mut [FaceStatus],
    inspection: &mut Inspection,
) {
    // Corners from the lowest on, in the face's own sense: [a, b, c].
    let turned = |face: u32| {
        let mut corners = geometry.mesh.faces()[face as usize].map(|vertex| welded[vertex as usize]);
        let lowest = (0..3).min_by_key(|&corner| corners[corner]).expect("three corners");
        corners.rotate_left(lowest);
        corners
    };
    let sense = |face: u32| {
        let [_, b, c] = turned(face);
        b < c
    };
    let sorted = |face: u32| {
        let [a, b, c] = turned(face);
        ([a, b.min(c), b.max(c)], face)
    };
    let mut faces: Vec<([u32; 3], u32)> =
        geometry.faces().filter(|&face| statuses[face as usize] == FaceStatus::Sound).map(sorted).collect();
    faces.sort_unstable();
    // Faces on one place are ordered by number, so the first of each sense is the lowest.
    let mut sheets = Vec::new();
    for place in faces.chunk_by(|a, b| a.0 == b.0).filter(|place| place.len() > 1) {
        let mut first: [Option<u32>; 2] = [None; 2];
        for &(_, face) in place {
            match &mut first[usize::from(sense(face))] {
                Some(earlier) => {
                    let material = |face: u32| geometry.mesh.face_materials()[face as usize];
                    let same = material(*earlier) == material(face);
                    statuses[face as usize] =
                        if same { FaceStatus::Duplicate } else { FaceStatus::DuplicateOfOtherMaterial };
                }
                none => *none = Some(face),
            }
        }
        if let [Some(one), Some(other)] = first {
            sheets.push(one.min(other));
        }
    }
    drop(faces);
    // Examples are in the order of faces.
    sheets.sort_unstable();
    for face in sheets {
        inspection.double_sided_sheets.add(|| Occurrence::at_face(face, geometry.middle(face)));
    }
    for face in geometry.faces() {
        let status = statuses[face as usize];
        if matches!(status, FaceStatus::Duplicate | FaceStatus::DuplicateOfOtherMaterial) {
            inspection.duplicates.add(|| Occurrence::at_face(face, geometry.middle(face)));
            inspection.duplicate_faces_of_other_material +=
                usize::from(status == FaceStatus::DuplicateOfOtherMaterial);
        }
    }
}
