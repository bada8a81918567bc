//! Keys of `[terrain]` that are given only beside `file`.

use raypencil_mesh_io::{FileFrame, SCALE_RANGE, UpAxis};

use crate::parse::key::{Key, span};
use crate::parse::source::Source;
use crate::scene_error::SceneIoError;

impl Source<'_> {
    /// Axes and unit of a mesh file.
    pub(super) fn file_frame(
        &self,
        up: &Key<String>,
        scale: &Key<f64>,
        file: &Key<String>,
    ) -> Result<FileFrame, SceneIoError> {
        let spans = [("up", span(up)), ("scale", span(scale))];
        if let (None, Some((name, span))) =
            (file, spans.into_iter().find_map(|(name, span)| Some((name, span?))))
        {
            return Err(self.error(span, format!("`terrain.{name}` is given; expected it only with `file`")));
        }
        let mut frame = FileFrame::default();
        if let Some(up) = up {
            frame.up = Some(self.word(up, "terrain.up", &UpAxis::WORDS)?);
        }
        let unit = "metres for each unit of the file";
        self.number(scale, "terrain.scale", &mut frame.scale, SCALE_RANGE, unit)?;
        Ok(frame)
    }
}
