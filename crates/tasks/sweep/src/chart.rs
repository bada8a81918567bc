//! Charts: a result against a parameter, a line for each value of another.

use std::collections::BTreeMap;

use raypencil_report::{Anchor, Colour, Drawing, INK, LETTERS, SOFT, Scale, Tick, draw_axes};

use crate::error::SweepError;
use crate::table::SweepTable;

/// Colours of lines that colour-blind people tell apart (Okabe and Ito, 2008), without yellow, which is faint on white.
const COLOURS: [Colour; 7] =
    [[0, 114, 178], [213, 94, 0], [0, 158, 115], [204, 121, 167], [86, 180, 233], [230, 159, 0], [0, 0, 0]];

/// Left upper corner and size of the plot on its page, pixels.
const CORNER: [f64; 2] = [92.0, 40.0];
const SIZE: [f64; 2] = [520.0, 320.0];

/// Width of the page without names of lines, pixels.
const PAGE_WIDTH: u32 = 640;
const PAGE_HEIGHT: u32 = 420;

/// A chart that is wanted: a result, a parameter to the right, and if wanted one that gives a line to each of its values.
///
/// ```
/// use raypencil_sweep::Chart;
///
/// let chart = Chart::parse("truth.found_share,camera.pitch_down_deg,terrain.builtin")?;
/// assert_eq!(chart.lines.as_deref(), Some("terrain.builtin"));
/// assert!(Chart::parse("truth.found_share").is_err());
/// # Ok::<(), raypencil_sweep::SweepError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Chart {
    /// Name of the result, to the top.
    pub result: String,
    /// Key of the parameter, to the right.
    pub parameter: String,
    /// Key of the parameter that has a line for each value.
    pub lines: Option<String>,
}

/// The runs of a line at one place.
#[derive(Debug, Default, Clone)]
struct Place {
    values: Vec<f64>,
}

impl Place {
    fn mean(&self) -> f64 {
        self.values.iter().sum::<f64>() / self.values.len() as f64
    }
}

impl Chart {
    /// Parses `RESULT,KEY` or `RESULT,KEY,KEY`.
    ///
    /// # Errors
    /// Another number of names.
    pub fn parse(text: &str) -> Result<Self, SweepError> {
        let names: Vec<String> = text.split(',').map(|name| name.trim().to_string()).collect();
        match names.as_slice() {
            [result, parameter] => {
                Ok(Self { result: result.clone(), parameter: parameter.clone(), lines: None })
            }
            [result, parameter, lines] => {
                Ok(Self { result: result.clone(), parameter: parameter.clone(), lines: Some(lines.clone()) })
            }
            _ => Err(SweepError::axis(
                text,
                "expected RESULT,KEY or RESULT,KEY,KEY, such as hits,camera.pitch_down_deg",
            )),
        }
    }

    /// Name of the chart's file, without its ending.
    pub fn file_stem(&self) -> String {
        let lines = self.lines.as_ref().map_or(String::new(), |lines| format!("-by-{lines}"));
        format!("{}-over-{}{lines}", self.result, self.parameter)
    }

    /// Draws the chart. A dot is a run, a line joins the means of the runs at each place.
    ///
    /// # Errors
    /// A name that the table does not have, or a result that is no number.
    pub fn draw(&self, table: &SweepTable) -> Result<Drawing, SweepError> {
        let column = |name: &str, what: &str| {
            table.column(name).ok_or_else(|| {
                let names: Vec<&str> = table.columns.iter().map(|column| column.name.as_str()).collect();
                SweepError::Plan {
                    found: format!("the table has no {what} `{name}`"),
                    expected: format!("one of {}", names.join(", ")),
                }
            })
        };
        let (y, x) = (column(&self.result, "result")?, column(&self.parameter, "parameter")?);
        let by = self.lines.as_ref().map(|name| column(name, "parameter")).transpose()?;
        // A run that leaves the parameter as it is in the scene is of another question.
        let runs: Vec<(usize, f64)> = (0..table.runs())
            .filter(|&run| !x.cells.text(run).is_empty())
            .filter_map(|run| Some((run, y.cells.number(run).filter(|value| value.is_finite())?)))
            .collect();
        if runs.is_empty() {
            return Err(SweepError::Plan {
                found: format!("`{}` has no number in any run with a `{}`", self.result, self.parameter),
                expected: "a result that is a number".into(),
            });
        }
        // Words stand in the order in which they come; numbers where they are.
        let words = in_order(runs.iter().map(|&(run, _)| x.cells.text(run)));
        let numbers: Option<Vec<f64>> = runs.iter().map(|&(run, _)| x.cells.number(run)).collect();
        let place = |index: usize| match &numbers {
            Some(numbers) => numbers[index],
            None => words.iter().position(|word| *word == x.cells.text(runs[index].0)).unwrap_or(0) as f64,
        };
        // Every value has its colour, also if it has no result here: so charts of one sweep have the same colours.
        let all = (0..table.runs()).filter(|&run| !x.cells.text(run).is_empty());
        let names = by.map_or(vec![String::new()], |by| in_order(all.map(|run| by.cells.text(run))));
        let mut lines: Vec<BTreeMap<u64, (f64, Place)>> = vec![BTreeMap::new(); names.len()];
        for (index, &(run, value)) in runs.iter().enumerate() {
            let line =
                by.map_or(0, |by| names.iter().position(|name| *name == by.cells.text(run)).unwrap_or(0));
            let at = place(index);
            lines[line].entry(ordered(at)).or_insert_with(|| (at, Place::default())).1.values.push(value);
        }
        let x_scale = match &numbers {
            Some(numbers) => widened(Scale::of(numbers.iter().copied()).expect("runs")),
            None => Scale::linear(-0.5, words.len() as f64 - 0.5),
        };
        // Zero belongs to a share and to a count.
        let values = runs.iter().map(|&(_, value)| value);
        let y_scale = widened(Scale::of(values.chain([0.0])).expect("runs"));
        let columns = match &numbers {
            Some(_) => x_scale.ticks(8),
            None => words
                .iter()
                .enumerate()
                .map(|(at, word)| Tick { label: word.clone(), at: x_scale.fraction(at as f64) })
                .collect(),
        };
        let from_above = |tick: Tick| Tick { at: 1.0 - tick.at, ..tick };
        let rows: Vec<Tick> = y_scale.ticks(6).into_iter().map(from_above).collect();
        let title = format!("{} against {}", self.result, self.parameter);
        // The key has the parameter's own name above those of its values.
        let longest = names.iter().chain(&self.lines).map(|name| name.chars().count()).max().unwrap_or(0);
        let key_width = if by.is_some() { 60 + 8 * longest.max(12) as u32 } else { 0 };
        let mut drawing = Drawing::new(PAGE_WIDTH + key_width, PAGE_HEIGHT, &title);
        let [left, above] = CORNER;
        let [width, height] = SIZE;
        for tick in &rows {
            let y = above + tick.at * height;
            drawing.line(vec![[left, y], [left + width, y]], [228, 230, 233], 1.0);
        }
        draw_axes(&mut drawing, CORNER, SIZE, columns, rows, [&self.parameter, &self.result]);
        drawing.line(vec![[left, above], [left, above + height], [left + width, above + height]], SOFT, 1.0);
        let at = |x: f64, y: f64| {
            [left + x_scale.fraction(x) * width, above + (1.0 - y_scale.fraction(y)) * height]
        };
        for (index, line) in lines.iter().enumerate() {
            let colour = COLOURS[index % COLOURS.len()];
            for (x, place) in line.values() {
                for value in place.values.iter().filter(|_| place.values.len() > 1) {
                    dot(&mut drawing, at(*x, *value), 1.6, colour);
                }
            }
            let means: Vec<[f64; 2]> = line.values().map(|(x, place)| at(*x, place.mean())).collect();
            means.iter().for_each(|&mean| dot(&mut drawing, mean, 3.5, colour));
            drawing.line(means, colour, 1.6);
        }
        if let Some(by) = &self.lines {
            let left = left + width + 24.0;
            drawing.text([left, above + LETTERS], by.as_str(), Anchor::Start, INK);
            let shown = names.iter().enumerate().filter(|(index, _)| !lines[*index].is_empty());
            for (place, (index, name)) in shown.enumerate() {
                let y = above + LETTERS + 20.0 * (place + 1) as f64;
                let colour = COLOURS[index % COLOURS.len()];
                drawing.line(vec![[left, y - 4.0], [left + 20.0, y - 4.0]], colour, 2.0);
                dot(&mut drawing, [left + 10.0, y - 4.0], 3.5, colour);
                drawing.text([left + 28.0, y], name.as_str(), Anchor::Start, INK);
            }
        }
        let repeated = lines.iter().flat_map(BTreeMap::values).any(|(_, place)| place.values.len() > 1);
        if repeated {
            let note = "line: mean of the runs; dots: each run";
            drawing.text([left + width, above - 12.0], note, Anchor::End, SOFT);
        }
        Ok(drawing)
    }
}

/// Different texts, in the order in which they come.
fn in_order(texts: impl Iterator<Item = String>) -> Vec<String> {
    let mut found: Vec<String> = Vec::new();
    for text in texts {
        if !found.contains(&text) {
            found.push(text);
        }
    }
    found
}

/// A key that sorts as the number does.
fn ordered(number: f64) -> u64 {
    let bits = (number + 0.0).to_bits();
    if bits >> 63 == 1 { !bits } else { bits | 1 << 63 }
}

/// A scale with room at both ends; one of a single value gets an end to either side.
fn widened(scale: Scale) -> Scale {
    let span = scale.high - scale.low;
    let room = if span > 0.0 { 0.04 * span } else { scale.high.abs().max(1.0) * 0.5 };
    let low = if scale.low == 0.0 { 0.0 } else { scale.low - room };
    let high = if scale.high == 0.0 && span > 0.0 { 0.0 } else { scale.high + room };
    Scale::linear(low, high)
}

fn dot(drawing: &mut Drawing, [x, y]: [f64; 2], radius: f64, colour: Colour) {
    // An octagon: at this size a circle.
    let half = std::f64::consts::FRAC_1_SQRT_2;
    let corners = [[1.0, 0.0], [half, half], [0.0, 1.0], [-half, half]];
    let all = corners.iter().copied().chain(corners.iter().map(|[x, y]| [-x, -y]));
    drawing.polygon(all.map(|[dx, dy]| [x + radius * dx, y + radius * dy]).collect(), colour, None);
}
