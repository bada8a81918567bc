//! Light in tests: every renderer that computes it, and short access to its results.

use glam::{DQuat, DVec3};
use raypencil::harness::contender;
use raypencil::{Image, Pose, Renderer, Request, Returns};

/// New instances of all renderers that compute light.
pub fn evaluations() -> Vec<Box<dyn Renderer>> {
    let named = ["scanline", "tracer", "referee"];
    named.map(|name| contender(name).expect("a renderer of the workspace").renderer).into()
}

/// A request for light alone, without maps of camera and beams.
pub const LIGHT: Request = Request { camera: false, beams: false, ..Request::EVERYTHING };

/// The flux of each pencil of a beam, W.
pub fn fluxes(returns: &Returns) -> &Image<f64> {
    returns.flux.as_ref().expect("the flux of pencils was asked for")
}

/// Whether the camera sees the hit of a pencil.
pub fn is_visible(returns: &Returns, i: u32, j: u32) -> bool {
    returns.visible.as_ref().expect("visibility was asked for").at(i, j)
}

/// The total flux on an image, W.
pub fn total(image: &Image<f64>) -> f64 {
    image.cells().iter().sum()
}

/// The relative error of `found`.
pub fn relative(found: f64, derived: f64) -> f64 {
    (found / derived - 1.0).abs()
}

/// The pose of a sensor at `position` that looks along `forward`, rolled by `roll` radians.
pub fn looking(position: DVec3, forward: DVec3, roll: f64) -> Pose {
    let rotation = DQuat::from_rotation_arc(DVec3::Z, forward.normalize());
    Pose { position, rotation } * Pose::from_axis_angle(DVec3::Z, roll)
}
