//! The command that asks one ray again.

use raypencil::CastRay;
use raypencil::io::quoted;

use crate::args::{Cast, typed_setting};

/// The command that shows everything about a ray.
pub(super) fn ray_command(command: &Cast, ray: &CastRay) -> String {
    let [ox, oy, oz] = ray.origin.to_array();
    let [dx, dy, dz] = ray.direction.to_array();
    let mut numbers = format!("{ox},{oy},{oz},{dx},{dy},{dz}");
    if ray.t_min > 0.0 || ray.t_max < f64::INFINITY {
        numbers += &format!(",{},{}", ray.t_min, ray.t_max);
    }
    let mesh = quoted(&command.mesh.display().to_string());
    let settings: String = command.set.iter().map(|setting| format!(" {}", typed_setting(setting))).collect();
    let up = command.up.map_or(String::new(), |up| format!(" --up {}", up.word()));
    let scale = command.scale.map_or(String::new(), |scale| format!(" --scale {scale}"));
    let fronts = if command.fronts_only { " --fronts-only" } else { "" };
    format!("raypencil cast {mesh} --ray={numbers}{settings}{up}{scale}{fronts} --all --margins")
}
