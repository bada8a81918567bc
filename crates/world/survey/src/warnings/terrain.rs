//! Rules on the terrain's axes and unit.

use glam::DVec3;
use raypencil_report::quantity;
use raypencil_scene::{Mesh, Triangles};

use crate::warning::{Warning, WarningCode};

/// Size and direction of a terrain, metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TerrainShape {
    /// Extents of the faces along the global axes.
    pub extents: DVec3,
    /// Sum of the normals of all faces, each as long as its face is large, square metres. On an open ground it points
    /// up; on a closed surface it is zero.
    pub area_vector: DVec3,
    /// Sum of the areas of all faces, square metres.
    pub area: f64,
    /// Median length of the faces' longest sides.
    pub median_side: f64,
}

/// Most faces whose sides are measured for the median.
const MEASURED_FACES: usize = 1 << 16;

impl TerrainShape {
    /// Measures a mesh. `None` if it has no faces.
    pub fn of(mesh: &Mesh) -> Option<Self> {
        Self::of_faces(mesh.faces(), |index| {
            DVec3::from_array(mesh.vertices()[index as usize].map(f64::from))
        })
    }

    /// Measures a mesh in the axes and the unit of its file. `None` if it has no faces.
    pub fn of_triangles(mesh: &Triangles) -> Option<Self> {
        Self::of_faces(mesh.faces(), |index| DVec3::from_array(mesh.vertices()[index as usize]))
    }

    fn of_faces(faces: &[[u32; 3]], vertex: impl Fn(u32) -> DVec3) -> Option<Self> {
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        let (mut area_vector, mut area) = (DVec3::ZERO, 0.0);
        let mut sides = Vec::new();
        // Every n-th face, so that a large mesh costs no more.
        let step = faces.len().div_ceil(MEASURED_FACES).max(1);
        for (index, face) in faces.iter().enumerate() {
            let corners @ [a, b, c] = face.map(&vertex);
            for corner in corners {
                (low, high) = (low.min(corner), high.max(corner));
            }
            let normal = 0.5 * (b - a).cross(c - a);
            area_vector += normal;
            area += normal.length();
            if index % step == 0 {
                sides.push((b - a).length().max((c - b).length()).max((a - c).length()));
            }
        }
        sides.sort_by(f64::total_cmp);
        let median_side = *sides.get(sides.len() / 2)?;
        Some(Self { extents: high - low, area_vector, area, median_side })
    }
}

/// Smallest ratio of a terrain's height to its smaller width at which it stands upright, tuned. A ground that lies has
/// relief of less than half its width nearly always; turned about x, its width becomes its height and its relief its
/// width, and the ratio becomes 2 or more.
const MIN_UPRIGHT_RATIO: f64 = 2.0;

/// Smallest length of the area vector, as a share of the area, that gives the terrain a direction, tuned. A closed
/// surface has 0, a flat ground 1.
const MIN_DIRECTION: f64 = 0.1;

/// Warns if a terrain stands upright along the axis on which a file with z up puts it.
///
/// glTF is y up: (x, y, z) of the file is (x, -z, y) of the global frame. A ground with z up in its file faces -y in
/// the global frame and is as high as it should be wide. A wall that faces along x, or a canyon that faces up, is none
/// of that. A closed surface faces nowhere; only its extents can tell.
pub fn terrain_on_its_side(shape: &TerrainShape) -> Option<Warning> {
    let TerrainShape { extents, area_vector, area, .. } = *shape;
    let is_upright = extents.z > MIN_UPRIGHT_RATIO * extents.x.min(extents.y);
    let [x, y, z] = area_vector.abs().to_array();
    let has_direction = area_vector.length() > MIN_DIRECTION * area;
    let faces_y = y > x && y > z;
    // Upright along y: the smaller of its widths.
    let is_turned = if has_direction { faces_y } else { extents.y < extents.x };
    (is_upright && is_turned).then(|| {
        let [x, y, z] = extents.to_array().map(|extent| quantity(extent, "m"));
        let sentence = format!(
            "the terrain stands upright: it is {z} high, and {x} by {y} wide. glTF is y up: does its file have z up?"
        );
        Warning::of_scene(WarningCode::TerrainOnItsSide, sentence)
    })
}

/// Whether a mesh whose axes were not turned lies on its side where z is up: it is flat along y and faces along it, like a ground
/// whose file has y up.
pub fn lies_on_its_side(shape: &TerrainShape) -> bool {
    let TerrainShape { extents, area_vector, area, .. } = *shape;
    let is_flat = MIN_UPRIGHT_RATIO * extents.y < extents.x.min(extents.z);
    let [x, y, z] = area_vector.abs().to_array();
    let has_direction = area_vector.length() > MIN_DIRECTION * area;
    is_flat && has_direction && y > x && y > z
}

/// Smallest extent of a terrain that may be in the wrong unit, metres, tuned: a ground of 1 m to 1 km in millimetres
/// has 1 km and more.
const MIN_LARGE_EXTENT_M: f64 = 1e3;

/// Smallest ratio of the median side of a face to the sensors' longest range at which a terrain has no detail where the
/// sensors look, tuned. Grounds for a rover have faces of centimetres to metres, also if they are kilometres wide; in
/// millimetres they have faces of hundreds of metres.
const MIN_COARSE_RATIO: f64 = 0.25;

/// Smallest median side of a face of a terrain that may be in millimetres, metres, tuned: a ground for a rover has faces of a
/// centimetre and more. Elevation models from orbit have posts some metres apart, in metres.
const MIN_SIDE_IN_MILLIMETRES_M: f64 = 10.0;

/// Warns if a terrain is kilometres wide and its faces are large beside the sensors' longest range (metres).
pub fn terrain_too_large(shape: &TerrainShape, longest_range: f64) -> Option<Warning> {
    let extent = shape.extents.max_element();
    let is_large = extent >= MIN_LARGE_EXTENT_M && shape.median_side >= MIN_COARSE_RATIO * longest_range;
    is_large.then(|| {
        let cause = match shape.median_side >= MIN_SIDE_IN_MILLIMETRES_M {
            true => "is its file in millimetres?",
            false => "it has hardly any detail there. `terrain generate --coarse` adds it to an elevation model.",
        };
        let sentence = format!(
            "the terrain is {} wide and half of its faces have a side of {} or more, but the sensors see {}: {cause}",
            quantity(extent, "m"),
            quantity(shape.median_side, "m"),
            quantity(longest_range, "m")
        );
        Warning::of_scene(WarningCode::TerrainTooLarge, sentence)
    })
}
