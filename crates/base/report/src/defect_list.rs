//! Lists of defects, as every page shows them.

use askama::Template;

/// A ray that is wrong: where, in what, and the command that shows it.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct DefectLine {
    /// Place of the ray.
    pub place: String,
    /// Name of the quantity.
    pub quantity: String,
    /// Said, true, difference and margin.
    pub words: String,
    /// All that is wrong with the ray, with the ruling.
    pub what: String,
    /// A folder with more about the ray; empty if there is none.
    pub folder: String,
    /// Files with more about it: their titles, and their paths from the page.
    pub links: Vec<(&'static str, String)>,
    /// Command that shows everything about the ray.
    pub command: String,
}

/// The listed defects of a sensor or a renderer.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DefectGroup {
    /// Whose defects, and how many.
    pub title: String,
    /// The listed ones.
    pub lines: Vec<DefectLine>,
    /// A sentence on those that are not listed; empty if all are.
    pub more: String,
}

#[derive(Template)]
#[template(path = "defects.html")]
struct DefectList<'a> {
    groups: &'a [DefectGroup],
}

/// The lists of defects as HTML; "None." if there is none.
///
/// ```
/// use raypencil_report::{DefectGroup, DefectLine, defect_list};
///
/// let line = DefectLine {
///     place: "camera 3,4".into(),
///     quantity: "range".into(),
///     words: "says 2 m, true is 3 m".into(),
///     what: "a hit on another face".into(),
///     command: "raypencil probe yard.toml --pixel 3,4".into(),
///     ..DefectLine::default()
/// };
/// let group = DefectGroup { title: "camera: 1 wrong ray".into(), lines: vec![line], more: String::new() };
/// let html = defect_list(&[group])?;
/// assert!(html.contains("<li><b>camera 3,4</b>, range. says 2 m, true is 3 m."));
/// assert!(defect_list(&[])?.contains("<p>None.</p>"));
/// # Ok::<(), askama::Error>(())
/// ```
///
/// # Errors
/// An error of the template.
pub fn defect_list(groups: &[DefectGroup]) -> Result<String, askama::Error> {
    DefectList { groups }.render()
}
