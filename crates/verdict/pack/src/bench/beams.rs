//! The bench beams: beams with dyadic numbers and exact rotations, each before rows of faces of its own.

use glam::{DQuat, DVec3};
use raypencil_scene::{Beam, Mounted, Pose, Profile};

use crate::bench::faces::AddedFaces;
use crate::bench::rows::{COLUMNS, Row, faces_of};

/// A beam for rays at the boundaries of the contract.
struct BenchBeam {
    /// Quaternion of the rotation: whole numbers, not a unit.
    quaternion: [f64; 4],
    /// Height above the scene's origin, metres: far from the ground and from the other benches.
    height: f64,
    /// Scale of all lengths but the height.
    scale: f64,
    max_range: f64,
    rows: &'static [Row],
}

/// Rows before the bench whose axes are those of the scene.
const LEVEL: &[Row] = &[
    Row::GrooveAtMaximumRange,
    Row::GrooveAtMaximumRange,
    Row::GrooveAtMaximumRange,
    Row::WallCutByMaximumRange,
    Row::PlateOnPlane,
    Row::PlateOnPlane,
    Row::PlateOnPlane,
    Row::PlateBeforePlane,
    Row::PlateTurnedAway,
    Row::RampThroughPlane,
    Row::Vertices,
    Row::HorizontalEdges,
    Row::VerticalEdges,
    Row::Diagonals,
    Row::Ridge,
    Row::DoubledPlate,
    Row::FacesWithoutArea,
    Row::SmallPlates,
    Row::PlateBesideRay,
    Row::PlateBesideRay,
    Row::PlateBesideRay,
];

/// Rows before the bench that is turned by a right angle.
const QUARTER_TURN: &[Row] = &[
    Row::Vertices,
    Row::HorizontalEdges,
    Row::VerticalEdges,
    Row::Diagonals,
    Row::WallCutByMaximumRange,
    Row::Ridge,
];

/// Rows before the bench that is turned by a rotation whose entries are multiples of 1/25.
const TURNED: &[Row] = &[
    Row::Vertices,
    Row::HorizontalEdges,
    Row::VerticalEdges,
    Row::Diagonals,
    Row::PlateBeforePlane,
    Row::PlateTurnedAway,
    Row::DoubledPlate,
];

const BENCHES: [BenchBeam; 3] = [
    BenchBeam { quaternion: [0.0, 0.0, 0.0, 1.0], height: 128.0, scale: 1.0, max_range: 4.0, rows: LEVEL },
    // A right angle about x: the quaternion (1, 0, 0, 1) has the length sqrt(2).
    BenchBeam {
        quaternion: [1.0, 0.0, 0.0, 1.0],
        height: 160.0,
        scale: 1.0,
        max_range: 4.0,
        rows: QUARTER_TURN,
    },
    // 1 + 4 + 4 + 16 = 25.
    BenchBeam {
        quaternion: [1.0, 2.0, 2.0, 4.0],
        height: 192.0,
        scale: 25.0 / 32.0,
        max_range: 4.0,
        rows: TURNED,
    },
];

/// The bench beams, each mounted; their faces are added to `faces`.
pub(super) fn bench_beams(faces: &mut AddedFaces) -> Vec<Mounted<Beam>> {
    BENCHES.iter().map(|bench| bench.mounted(faces)).collect()
}

impl BenchBeam {
    fn mounted(&self, faces: &mut AddedFaces) -> Mounted<Beam> {
        let [x, y, z, w] = self.quaternion;
        let pose =
            Pose { position: DVec3::new(0.0, 0.0, self.height), rotation: DQuat::from_xyzw(x, y, z, w) };
        let (s, rows) = (self.scale, self.rows.len());
        for (j, row) in self.rows.iter().enumerate() {
            let y = s * (2.0 * j as f64 + 1.0 - rows as f64) / 8.0;
            faces.extend(&pose, faces_of(*row, y, s));
        }
        let beam = Beam {
            columns: COLUMNS,
            rows: rows as u32,
            // y_j = T (2 j + 1 - rows) / (2 rows) = s (2 j + 1 - rows) / 8.
            thickness: s * rows as f64 / 4.0,
            grid_distance: s / 2.0,
            // x_i = w (2 i + 1 - columns) / columns = s (i - 32) / 32.
            half_width: s * f64::from(COLUMNS) / 64.0,
            max_range: self.max_range,
            power: 1.0,
            wavelength: 810e-9,
            profile: Profile::Paper,
        };
        Mounted { scene_from_sensor: pose, sensor: beam }
    }
}
