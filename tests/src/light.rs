//! What tests of light share: everybody who computes it, short ways to what they say, and draws.

use std::f64::consts::TAU;

use glam::{DQuat, DVec3};
use raypencil::harness::contender;
use raypencil::{Image, Pose, Renderer, Request, Returns};

/// Every way of computing light that there is, fresh.
pub fn evaluations() -> Vec<Box<dyn Renderer>> {
    let named = ["scanline", "tracer", "referee"];
    named.map(|name| contender(name).expect("a renderer of this house").renderer).into()
}

/// Light alone: no map of camera or beam.
pub const LIGHT: Request = Request { camera: false, beams: false, ..Request::EVERYTHING };

/// The flux of each pencil of a beam.
pub fn fluxes(returns: &Returns) -> &Image<f64> {
    returns.flux.as_ref().expect("the flux of pencils is known")
}

/// Whether the camera sees the hit of a pencil.
pub fn is_visible(returns: &Returns, i: u32, j: u32) -> bool {
    returns.visible.as_ref().expect("what is visible is known").at(i, j)
}

/// All of the light on an image.
pub fn total(image: &Image<f64>) -> f64 {
    image.cells().iter().sum()
}

/// By how much of itself a number is off.
pub fn relative(found: f64, derived: f64) -> f64 {
    (found / derived - 1.0).abs()
}

/// Repeatable random numbers. (SplitMix64, G. Steele, D. Lea and C. Flood 2014)
#[derive(Debug)]
pub struct Draws(pub u64);

impl Draws {
    /// Evenly from `low` up to but not `high`.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut word = self.0;
        word = (word ^ (word >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        word = (word ^ (word >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        word ^= word >> 31;
        low + (high - low) * (word >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Each component evenly from -reach to reach.
    pub fn vector(&mut self, reach: f64) -> DVec3 {
        DVec3::from_array([(); 3].map(|()| self.between(-reach, reach)))
    }

    /// Evenly on the unit sphere.
    pub fn direction(&mut self) -> DVec3 {
        let (z, angle) = (self.between(-1.0, 1.0), self.between(0.0, TAU));
        let (sin, cos) = libm::sincos(angle);
        let level = (1.0 - z * z).sqrt();
        DVec3::new(level * cos, level * sin, z)
    }
}

/// At `position`, looking along `forward`, rolled by `roll` radians.
pub fn looking(position: DVec3, forward: DVec3, roll: f64) -> Pose {
    let rotation = DQuat::from_rotation_arc(DVec3::Z, forward.normalize());
    Pose { position, rotation } * Pose::from_axis_angle(DVec3::Z, roll)
}
