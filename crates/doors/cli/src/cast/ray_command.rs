//! The command that asks one ray again.

use raypencil::CastRay;
use raypencil::io::{quoted, ray_rows};

use crate::args::{Cast, typed_setting};

/// The command that shows everything about a ray.
pub(super) fn ray_command(command: &Cast, ray: &CastRay) -> String {
    let (_, mut numbers) = ray_rows(std::slice::from_ref(ray));
    if numbers[6..] == [0.0, f64::INFINITY] {
        numbers.truncate(6);
    }
    let numbers: Vec<String> = numbers.iter().map(f64::to_string).collect();
    let numbers = numbers.join(",");
    let mesh = quoted(&command.mesh.display().to_string());
    let settings: String = command.set.iter().map(|setting| format!(" {}", typed_setting(setting))).collect();
    let up = command.up.map_or(String::new(), |up| format!(" --up {}", up.word()));
    let scale = command.scale.map_or(String::new(), |scale| format!(" --scale {scale}"));
    let fronts = if command.fronts_only { " --fronts-only" } else { "" };
    format!("raypencil cast {mesh} --ray={numbers}{settings}{up}{scale}{fronts} --all --margins")
}
