//! Keys of `[terrain]` that are given only beside `dem`.

use std::path::PathBuf;

use raypencil_mesh_io::dem;

use crate::parse::key::{Key, span};
use crate::parse::source::Source;
use crate::plan::DemPart;
use crate::scene_error::SceneIoError;

impl Source<'_> {
    /// Part of an elevation model. The caller fills in its file.
    pub(super) fn dem_part(
        &self,
        window: &Key<Vec<f64>>,
        max_error: &Key<f64>,
        dem: &Key<String>,
    ) -> Result<DemPart, SceneIoError> {
        let spans = [("dem_window_m", span(window)), ("dem_max_error_m", span(max_error))];
        if let (None, Some((name, span))) =
            (dem, spans.into_iter().find_map(|(name, span)| Some((name, span?))))
        {
            return Err(self.error(span, format!("`terrain.{name}` is given; expected it only with `dem`")));
        }
        let mut part = DemPart { file: PathBuf::new(), window: None, max_error: None };
        if let Some(window) = window {
            let name = "terrain.dem_window_m";
            if let &[x, y, width, height] = self.list(window, name, &[4], dem::MAP_RANGE_M, "metres")? {
                for side in [width, height] {
                    self.check(
                        side,
                        window.span(),
                        name,
                        dem::WINDOW_SIDE_RANGE_M,
                        "metres, for a width and a height",
                    )?;
                }
                part.window = Some([x, y, width, height]);
            }
        }
        part.max_error =
            self.optional(max_error, "terrain.dem_max_error_m", dem::MAX_ERROR_RANGE_M, "metres")?;
        Ok(part)
    }
}
