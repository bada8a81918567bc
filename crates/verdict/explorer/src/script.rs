//! The script of a page: the modules of `script/`, put together.
//!
//! The modules import each other by name, so that an editor and a type checker understand them. A page has no place to
//! import from; so all of them stand in one scope, the imported before the importing, without their `import` lines and
//! without the word `export`. Their names at the top level are therefore unique; a test holds this and the rest of the
//! rule.

use std::sync::LazyLock;

/// File name and text of each module.
macro_rules! modules {
    ($($name:literal)*) => { &[$(($name, include_str!(concat!("../script/", $name)))),*] };
}

/// Modules in an order in which each stands behind all that it imports.
const MODULES: &[(&str, &str)] = modules![
    "colour.js"
    "elements.js"
    "numbers.js"
    "limits.js"
    "page_model.js"
    "legend.js"
    "state.js"
    "page_hash.js"
    "sketches.js"
    "causes.js"
    "common_rasters.js"
    "channels.js"
    "difference.js"
    "derive.js"
    "page_data.js"
    "cell_reading.js"
    "cell_words.js"
    "container.js"
    "drive_body.js"
    "drive_replay.js"
    "drive_cell_marks.js"
    "view3d_words.js"
    "drive_chart.js"
    "drive_ground.js"
    "drive_hand.js"
    "drive_keys.js"
    "drive_looks.js"
    "drive_model.js"
    "drive_scale.js"
    "drive_legend.js"
    "drive_plan.js"
    "drive_sectors.js"
    "view3d_vector.js"
    "drive_plan_drawing.js"
    "drive_raster.js"
    "drive_map.js"
    "view3d_sensor.js"
    "drive_mounts.js"
    "view3d_camera.js"
    "drive_orbit.js"
    "view3d_labels.js"
    "view3d_overlay.js"
    "view3d_theme.js"
    "drive_overlay.js"
    "drive_readout.js"
    "drive_relief.js"
    "drive_state.js"
    "drive_table.js"
    "drive_timeline.js"
    "view3d_drawing.js"
    "view3d_rig.js"
    "drive_scene.js"
    "gl_program.js"
    "drive_solid.js"
    "gl_lines.js"
    "view3d_terrain.js"
    "gl_mesh.js"
    "view3d_coarse.js"
    "gl_stage.js"
    "drive_stage.js"
    "drive_surface.js"
    "drive_view3d_elements.js"
    "view3d_controls.js"
    "view3d_moves.js"
    "view3d_search.js"
    "view3d_story.js"
    "view3d_views.js"
    "drive_view3d.js"
    "drive_panel.js"
    "explorer_keys.js"
    "ray_list.js"
    "filters.js"
    "view3d_caption.js"
    "view3d_panel.js"
    "view3d_key.js"
    "view3d_over.js"
    "view3d_raydrawing.js"
    "view3d_picture.js"
    "view3d.js"
    "geometry.js"
    "keyboard.js"
    "painter.js"
    "marks.js"
    "axis_words.js"
    "panel_drawing.js"
    "panel_layers.js"
    "pointer.js"
    "viewport.js"
    "panel.js"
    "panel_set.js"
    "ray_csv.js"
    "probe_text.js"
    "ray_detail.js"
    "ray_table.js"
    "readout.js"
    "gl_points.js"
    "cloud_stage.js"
    "cloud_view.js"
    "toolbar.js"
    "explorer.js"
    "main.js"
];

/// Style of the interactive part.
pub(crate) const STYLE: &str = concat!(
    include_str!("../script/drive.css"),
    include_str!("../script/explorer.css"),
    include_str!("../script/view3d.css")
);

pub(crate) static SCRIPT: LazyLock<String> = LazyLock::new(|| joined(MODULES));

/// The modules as one text.
fn joined(modules: &[(&str, &str)]) -> String {
    let mut script = String::new();
    for (name, text) in modules {
        script.push_str(&format!("// {name}\n"));
        for line in text.lines().filter(|line| !line.starts_with("import ")) {
            script.push_str(line.strip_prefix("export ").unwrap_or(line));
            script.push('\n');
        }
    }
    script
}

#[cfg(test)]
#[path = "../tests/unit/script.rs"]
mod tests;
