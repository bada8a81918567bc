//! Checks of single faces: area, slenderness, downward normals.

use glam::DVec3;

use super::geometry::MeshGeometry;
use super::report::{Inspection, Occurrence};
use super::status::FaceStatus;

/// Marks and counts faces without area.
pub(super) fn find_zero_area(
    geometry: &MeshGeometry,
    welded: &[u32],
    inspection: &mut Inspection,
) -> Vec<FaceStatus> {
    let twice = |[a, b, c]: [u32; 3]| a == b || b == c || c == a;
    let status = |face| {
        if geometry.normal(face) != DVec3::ZERO {
            return FaceStatus::Sound;
        }
        let corners = geometry.mesh.faces()[face as usize];
        let kinds = &mut inspection.zero_area_kinds;
        let kind = if twice(corners) {
            &mut kinds.repeated_vertex
        } else if twice(corners.map(|vertex| welded[vertex as usize])) {
            &mut kinds.coincident_vertices
        } else {
            &mut kinds.collinear
        };
        *kind += 1;
        inspection.zero_area.add(|| Occurrence::at_face(face, geometry.middle(face)));
        FaceStatus::ZeroArea
    };
    geometry.faces().map(status).collect()
}

/// Measures the faces of the surface.
pub(super) fn measure(geometry: &MeshGeometry, statuses: &[FaceStatus], inspection: &mut Inspection) {
    for face in geometry.faces().filter(|&face| statuses[face as usize].is_surface()) {
        let normal = geometry.normal(face);
        let twice_area = normal.length();
        let example = || Occurrence::at_face(face, geometry.middle(face));
        inspection.area += 0.5 * twice_area;
        // The length is 0 only for faces below 1e-150 m a side, whose aspect means nothing.
        let [a, b, c] = geometry.corners(face);
        let longest = (b - a).length_squared().max((c - b).length_squared()).max((a - c).length_squared());
        if twice_area > 0.0 {
            // aspect = length / width, and width = twice the area / length.
            let aspect = longest / twice_area;
            inspection.worst_aspect = inspection.worst_aspect.max(aspect);
            if aspect > Inspection::MIN_SLENDER_ASPECT {
                inspection.slender.add(example);
            }
        }
        if normal.z < 0.0 {
            inspection.downward_area += 0.5 * twice_area;
            inspection.down.add(example);
        }
    }
}
