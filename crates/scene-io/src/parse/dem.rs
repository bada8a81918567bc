//! `dem`, and the keys that are there only with it.

use std::path::PathBuf;
use toml::Spanned;

use crate::keys::Key;
use crate::parse::Source;
use crate::plan::DemPart;
use crate::scene_error::SceneIoError;
use raypencil_mesh_io::dem;

impl Source<'_> {
    /// What is taken of an elevation model, whose file is filled in later: keys that are there only with `dem`.
    pub(super) fn dem_part(
        &self,
        window: Key<Vec<f64>>,
        max_error: Key<f64>,
        dem: Option<&Spanned<String>>,
    ) -> Result<DemPart, SceneIoError> {
        let mut part = DemPart { file: PathBuf::new(), window: None, max_error: None };
        let spans = [
            ("dem_window_m", window.as_ref().map(Spanned::span)),
            ("dem_max_error_m", max_error.as_ref().map(Spanned::span)),
        ];
        if let (None, Some((name, span))) =
            (dem, spans.into_iter().find_map(|(name, span)| Some((name, span?))))
        {
            return Err(self.error(span, format!("`terrain.{name}` is given; expected it only with `dem`")));
        }
        if let Some(window) = window {
            let name = "terrain.dem_window_m";
            if let &[x, y, width, height] = self.list(&window, name, &[4], dem::MAP_RANGE_M, "metres")? {
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
        if let Some(max_error) = max_error {
            let value = *max_error.get_ref();
            self.check(value, max_error.span(), "terrain.dem_max_error_m", dem::MAX_ERROR_RANGE_M, "metres")?;
            part.max_error = Some(value);
        }
        Ok(part)
    }
}
