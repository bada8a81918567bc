//! The numbers that place a node or an instance, as a transform. (glTF 2.0, §3.5.3)

use glam::{DAffine3, DMat3, DVec3};
use raypencil_files::Fault;
use raypencil_scene::Pose;

use crate::gltf::placement::Placement;

/// Squared lengths that a rotation may have. The coarsest storage of glTF is a normalised byte (§3.6.2.2), which is off by at most 1 / 254:
/// four of them change the length by at most 1 / 127. Numbers in single precision, or with three decimals, are nearer to 1. The bounds are
/// a little wider, for the rounding of the products here.
const MIN_LENGTH_SQUARED: f64 = 125.0 / 126.0 * (125.0 / 126.0);
const MAX_LENGTH_SQUARED: f64 = 127.0 / 126.0 * (127.0 / 126.0);

/// Transform of a node to its parent's axes; `None` if it has none, so that its vertices are not changed.
pub(super) fn local(node: &Placement, place: &str) -> Result<Option<DAffine3>, Fault> {
    let finite = |name: &str, numbers: &[f64]| match numbers.iter().all(|number| number.is_finite()) {
        true => Ok(()),
        false => Err(Fault::new(place, format!("{name} {numbers:?}"), "finite numbers")),
    };
    let has_parts = node.translation.is_some() || node.rotation.is_some() || node.scale.is_some();
    if let Some(matrix) = node.matrix.as_deref() {
        if has_parts {
            return Err(Fault::new(
                place,
                "a matrix beside translation, rotation or scale",
                "one or the other",
            ));
        }
        finite("matrix", matrix)?;
        // Stored column by column; the last row must be that of an affine map.
        let [a, b, c, d]: [[f64; 4]; 4] =
            std::array::from_fn(|column| std::array::from_fn(|row| matrix[4 * column + row]));
        if [a[3], b[3], c[3], d[3]] != [0.0, 0.0, 0.0, 1.0] {
            let found = format!("a matrix with the last row {:?}", [a[3], b[3], c[3], d[3]]);
            return Err(Fault::new(place, found, "[0, 0, 0, 1]"));
        }
        let column = |c: [f64; 4]| DVec3::new(c[0], c[1], c[2]);
        let linear = DMat3::from_cols(column(a), column(b), column(c));
        return Ok(Some(DAffine3 { matrix3: linear, translation: column(d) }));
    }
    if !has_parts {
        return Ok(None);
    }
    let translation = node.translation.unwrap_or_default();
    let scale = node.scale.unwrap_or([1.0; 3]);
    let rotation = node.rotation.unwrap_or([0.0, 0.0, 0.0, 1.0]);
    finite("translation", &translation)?;
    finite("scale", &scale)?;
    finite("rotation", &rotation)?;
    let [x, y, z, w] = rotation;
    let norm_squared = x * x + y * y + z * z + w * w;
    if !(MIN_LENGTH_SQUARED..=MAX_LENGTH_SQUARED).contains(&norm_squared) {
        let found = format!("rotation {rotation:?}");
        return Err(Fault::new(place, found, "a unit quaternion"));
    }
    // `rotate` divides by the squared length, so that a length other than 1 does not scale the ground.
    let turn = Pose { rotation: glam::DQuat::from_xyzw(x, y, z, w), ..Pose::IDENTITY };
    let scale = DVec3::from_array(scale);
    let linear = DMat3::from_cols(
        turn.rotate(DVec3::X) * scale.x,
        turn.rotate(DVec3::Y) * scale.y,
        turn.rotate(DVec3::Z) * scale.z,
    );
    Ok(Some(DAffine3 { matrix3: linear, translation: DVec3::from_array(translation) }))
}
