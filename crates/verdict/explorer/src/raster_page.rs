//! A page without a scene: rasters of any channels, of one side or of two beside each other.

use raypencil_judge::Class;
use serde_json::{Map, Value, json};

use crate::arrays::{Arrays, Change, Packed};
use crate::page::{SideKind, html_of};

/// Cells of one channel, for each side; `None`: the side does not give it.
#[derive(Debug, Clone, PartialEq)]
pub enum RasterChannel {
    /// Numbers, in single precision.
    Reals(Vec<Option<Vec<f32>>>),
    /// Whole numbers.
    Wholes(Vec<Option<Vec<u32>>>),
}

/// A cell in which both sides are not the same.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct DifferingCell {
    /// Number of the cell, in reading order.
    pub cell: u32,
    /// Index of the first channel that differs.
    pub channel: usize,
    /// Its class.
    pub class: Class,
}

/// What the columns or the rows of a raster are, in numbers.
#[derive(Debug, Clone, PartialEq)]
pub struct RasterAxis {
    /// What the numbers are.
    pub name: String,
    /// Their unit.
    pub unit: String,
    /// The number of each column or row. From one to the next they may only rise, or only fall.
    pub at: Vec<f64>,
    /// Whether the numbers are angles of a turn, in degrees: -180 to 180 are read, whatever turns went before.
    pub turns: bool,
}

/// Both axes of a raster.
#[derive(Debug, Clone, PartialEq)]
pub struct RasterAxes {
    /// What columns are.
    pub columns: RasterAxis,
    /// What rows are.
    pub rows: RasterAxis,
}

/// A mesh on which the points of the rasters lie, the channels `P.X`, `P.Y` and `P.Z`.
#[derive(Debug, Clone, PartialEq)]
pub struct RasterSolid {
    /// The place of the vertices' zero, in the frame of the points.
    pub origin: [f64; 3],
    /// To the right, up the page and upward, as unit vectors of that frame.
    pub axes: [[f64; 3]; 3],
    /// Corners, from the origin.
    pub vertices: Vec<[f32; 3]>,
    /// Three corners each.
    pub faces: Vec<[u32; 3]>,
    /// What is drawn, in words.
    pub words: String,
}

/// Channels of one size that belong together, such as those of one sensor.
#[derive(Debug, Clone)]
pub struct RasterGroup {
    /// Name of the group.
    pub name: String,
    /// Columns and rows.
    pub size: (u32, u32),
    /// What columns and rows are; `None`: they have numbers alone.
    pub axes: Option<RasterAxes>,
    /// Name, unit and cells of each channel.
    pub channels: Vec<(String, String, RasterChannel)>,
    /// Cells that differ in some channel.
    pub differing: Vec<DifferingCell>,
    /// Cells that are described in full, and all that is known of each.
    pub described: Vec<(u32, String)>,
}

/// A page of rasters.
#[derive(Debug, Clone)]
pub struct RasterPage<'a> {
    /// The kind of page, for programs: `diff`, `cast`.
    pub kind: &'a str,
    /// The title.
    pub title: &'a str,
    /// Name and kind of each side, one or two. Two are compared.
    pub sides: &'a [(&'a str, SideKind)],
    /// Names of the classes, in the order of [`Class`].
    pub classes: [&'a str; Class::COUNT],
    /// The rasters.
    pub groups: &'a [RasterGroup],
    /// Which cells are described in full, in words.
    pub described_words: &'a str,
    /// The mesh on which the points lie, if they are to be seen in 3-D.
    pub solid: Option<RasterSolid>,
}

impl RasterPage<'_> {
    /// The elements of the page, with style and script.
    ///
    /// ```
    /// use raypencil_explorer::{DifferingCell, RasterChannel, RasterGroup, RasterPage, SideKind};
    /// use raypencil_judge::Class;
    ///
    /// let range = RasterChannel::Reals(vec![Some(vec![1.0, 2.0]), Some(vec![1.0, 2.5])]);
    /// let group = RasterGroup {
    ///     name: "camera".into(),
    ///     size: (2, 1),
    ///     axes: None,
    ///     channels: vec![("range.T".into(), "m".into(), range)],
    ///     differing: vec![DifferingCell { cell: 1, channel: 0, class: Class::Defect }],
    ///     described: vec![],
    /// };
    /// let page = RasterPage {
    ///     kind: "diff",
    ///     title: "mine and theirs",
    ///     sides: &[("mine", SideKind::Candidate), ("theirs", SideKind::Candidate)],
    ///     classes: ["equal", "tie", "rounding", "approximation", "undecided", "differs"],
    ///     groups: &[group],
    ///     described_words: "",
    ///     solid: None,
    /// };
    /// assert!(page.html().contains(r#""name":"theirs""#));
    /// ```
    pub fn html(&self) -> String {
        let mut arrays = Arrays::default();
        let mut quantities: Vec<Value> = Vec::new();
        let is_compared = self.sides.len() > 1;
        let sensors: Vec<Value> = self
            .groups
            .iter()
            .map(|group| {
                let first_quantity = quantities.len();
                let known =
                    group.channels.iter().map(|(name, unit, _)| json!({ "name": name, "unit": unit }));
                quantities.extend(known);
                group_model(&mut arrays, group, first_quantity, is_compared)
            })
            .collect();
        let sides: Vec<Value> = self
            .sides
            .iter()
            .map(|(name, kind)| json!({ "name": name, "kind": kind.key(), "words": "" }))
            .collect();
        let described = self.groups.iter().enumerate().flat_map(|(sensor, group)| {
            group
                .described
                .iter()
                .map(move |(cell, text)| json!({ "sensor": sensor, "cell": cell, "pair": 0, "text": text }))
        });
        let described: Vec<Value> = described.collect();
        let rays = match described.as_slice() {
            [] => Value::Null,
            described => arrays.u8(json!(described).to_string().as_bytes()),
        };
        let solid = self.solid.as_ref().map(|solid| {
            json!({
                "origin": solid.origin,
                "axes": solid.axes,
                "vertices": arrays.f32(solid.vertices.as_flattened(), Change::Delta).reference,
                "faces": arrays.u32(solid.faces.as_flattened(), Change::Delta).reference,
                "words": solid.words,
            })
        });
        let model = json!({
            "version": 1, "kind": self.kind, "title": self.title, "probe": "", "flux_unit": "", "mesh": null,
            "vehicle": null, "sides": sides, "sensors": sensors, "classes": self.classes,
            "quantities": quantities, "causes": [], "switches": {}, "rays": rays,
            "rays_words": self.described_words, "solid": solid,
        });
        html_of(&model, &arrays)
    }
}

/// References to the arrays of a channel, for each side. Later sides are stored as what differs from the first.
fn packed<T>(
    sides: &[Option<Vec<T>>],
    arrays: &mut Arrays,
    first: impl Fn(&mut Arrays, &[T]) -> Packed,
    beside: impl Fn(&mut Arrays, &[T], &Packed) -> Packed,
) -> Vec<Option<Value>> {
    let mut known: Option<Packed> = None;
    sides
        .iter()
        .map(|cells| {
            let cells = cells.as_ref()?;
            let packed = match &known {
                Some(known) => beside(arrays, cells, known),
                None => first(arrays, cells),
            };
            let reference = packed.reference.clone();
            known.get_or_insert(packed);
            Some(reference)
        })
        .collect()
}

fn group_model(arrays: &mut Arrays, group: &RasterGroup, first_quantity: usize, is_compared: bool) -> Value {
    let (width, height) = group.size;
    let cells = width as usize * height as usize;
    let mut sides = vec![Map::new(); if is_compared { 2 } else { 1 }];
    for (name, _, channel) in &group.channels {
        let references = match channel {
            RasterChannel::Reals(cells) => packed(
                cells,
                arrays,
                |arrays, cells| arrays.f32(cells, Change::None),
                |arrays, cells, known| arrays.f32_beside(cells, known),
            ),
            RasterChannel::Wholes(cells) => packed(
                cells,
                arrays,
                |arrays, cells| arrays.u32(cells, Change::Delta),
                |arrays, cells, known| arrays.u32_beside(cells, known),
            ),
        };
        for (side, reference) in sides.iter_mut().zip(references) {
            if let Some(reference) = reference {
                side.insert(name.clone(), json!({ "stored": reference }));
            }
        }
    }
    let pair = is_compared.then(|| {
        let mut classes = vec![Class::Agree as u8; cells];
        let mut quantities = vec![u8::MAX; cells];
        for DifferingCell { cell, channel, class } in &group.differing {
            classes[*cell as usize] = *class as u8;
            quantities[*cell as usize] = u8::try_from(first_quantity + channel).unwrap_or(u8::MAX);
        }
        json!({
            "a": 0, "b": 1,
            "class": arrays.u8(&classes),
            "cause": arrays.u8(&vec![u8::MAX; cells]),
            "quantity": arrays.u8(&quantities),
            "range_ulps": null, "range_bound": null,
        })
    });
    let sides: Vec<Value> = sides.into_iter().map(|channels| json!({ "channels": channels })).collect();
    let axis = |axis: &RasterAxis| {
        let at: Vec<f32> = axis.at.iter().map(|at| *at as f32).collect();
        json!({
            "name": axis.name, "unit": axis.unit, "turns": axis.turns, "at": at,
        })
    };
    let axes =
        group.axes.as_ref().map(|axes| json!({ "columns": axis(&axes.columns), "rows": axis(&axes.rows) }));
    json!({
        "name": group.name, "kind": "raster", "beam": null, "width": width, "height": height, "max_range": null,
        "pose": null, "camera": null, "grid": null, "axes": axes,
        "sides": sides, "pairs": pair.into_iter().collect::<Vec<_>>(), "margins": null,
    })
}
