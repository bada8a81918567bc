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
    "panel/colour.js"
    "elements.js"
    "frame.js"
    "view3d/frame_elements.js"
    "keyboard.js"
    "data/numbers.js"
    "data/limits.js"
    "data/page_model.js"
    "panel/legend.js"
    "state.js"
    "drive/state.js"
    "data/page_hash.js"
    "panel/sketches.js"
    "data/causes.js"
    "data/common_rasters.js"
    "data/channels.js"
    "data/difference.js"
    "panel/painter.js"
    "panel/hand.js"
    "data/derive.js"
    "data/page_data.js"
    "data/cell_reading.js"
    "rays/cell_words.js"
    "data/container.js"
    "drive/body.js"
    "drive/replay.js"
    "drive/cell_marks.js"
    "view3d/words.js"
    "drive/chart.js"
    "view3d/vector.js"
    "view3d/search.js"
    "drive/ground.js"
    "drive/keys.js"
    "drive/looks.js"
    "drive/model.js"
    "drive/scale.js"
    "drive/legend.js"
    "drive/plan.js"
    "drive/sectors.js"
    "drive/plan_drawing.js"
    "drive/raster.js"
    "drive/map.js"
    "view3d/sensor.js"
    "drive/mounts.js"
    "view3d/camera.js"
    "drive/orbit.js"
    "view3d/labels.js"
    "view3d/overlay.js"
    "view3d/theme.js"
    "view3d/over.js"
    "drive/readout.js"
    "drive/relief.js"
    "drive/table.js"
    "drive/timeline.js"
    "view3d/drawing.js"
    "view3d/rig.js"
    "drive/scene.js"
    "gl/program.js"
    "gl/vertices.js"
    "drive/solid.js"
    "gl/lines.js"
    "view3d/terrain.js"
    "gl/mesh.js"
    "view3d/coarse.js"
    "gl/stage.js"
    "drive/stage.js"
    "drive/surface.js"
    "drive/view3d_elements.js"
    "view3d/moves.js"
    "view3d/controls.js"
    "view3d/story.js"
    "view3d/views.js"
    "drive/view3d.js"
    "drive/panel.js"
    "explorer_keys.js"
    "rays/list.js"
    "rays/filters.js"
    "view3d/caption.js"
    "view3d/panel.js"
    "view3d/key.js"
    "view3d/raydrawing.js"
    "view3d/picture.js"
    "view3d/view3d.js"
    "panel/geometry.js"
    "panel/marks.js"
    "panel/axis_words.js"
    "panel/drawing.js"
    "panel/layers.js"
    "panel/viewport.js"
    "panel/divider.js"
    "panel/panel.js"
    "panel/set.js"
    "rays/csv.js"
    "rays/probe_text.js"
    "rays/detail.js"
    "rays/table.js"
    "rays/readout.js"
    "gl/points.js"
    "cloud/stage.js"
    "cloud/view.js"
    "panel/toolbar.js"
    "explorer.js"
    "main.js"
];

/// Style of the interactive part.
pub(crate) const STYLE: &str = concat!(
    include_str!("../script/drive/drive.css"),
    include_str!("../script/explorer.css"),
    include_str!("../script/view3d/view3d.css")
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
