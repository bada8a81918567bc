//! The page of a cast: the answers as maps that can be asked, ray by ray.

use std::path::{Path, PathBuf};

use raypencil_explorer::{DifferingCell, RasterChannel, RasterGroup, RasterPage, SideKind};
use raypencil_files::{FileError, write_atomically};
use raypencil_judge::Class;
use raypencil_report::{Block, Column, Document, Grid, Outcome, Room, count, described_words};
use raypencil_scene::{CastRay, NamedRaySet, Side};

use crate::answers::{Answers, FirstHit};
use crate::comparison::{Comparison, RayVerdict, Stated, comparison_headline, wrong_text};
use crate::range_picture::{range_picture, top_picture};
use crate::text::{counts_text, ray_text};

/// Maximum number of cells of all channels and sides together: it keeps a page to some twenty megabytes.
const MAX_CELLS: usize = 6_000_000;

/// Maximum number of rays that a page describes in full.
const MAX_DESCRIBED_RAYS: usize = 1000;

/// How the numbers of a page are to be read.
const NUMBERS: &str = "The numbers of this page are in single precision; the arrays beside it have all digits. Lengths are in the mesh's \
                       own unit, which the scales call m.";

/// Said where no ray is shown by itself.
const TOO_MANY: &str = "The rays are too many to be shown one by one.";

/// A cast as a page shows it.
#[derive(Clone, Copy)]
pub struct CastPage<'a> {
    /// What was asked, for the title: the name of the rays and of the mesh.
    pub title: &'a str,
    /// More about both: names and values.
    pub facts: &'a [(&'static str, String)],
    /// The rays' own shape.
    pub shape: &'a [u64],
    /// The rays.
    pub rays: &'a [CastRay],
    /// The exact answers.
    pub answers: &'a Answers,
    /// The set, if the rays have a pattern.
    pub set: Option<&'a NamedRaySet>,
    /// Another program's first hits.
    pub compared: Option<ComparedHits<'a>>,
}

/// Another program's first hits beside the exact ones.
#[derive(Clone, Copy)]
pub struct ComparedHits<'a> {
    /// Its name.
    pub name: &'a str,
    /// What it says.
    pub stated: &'a Stated,
    /// What became of it.
    pub comparison: &'a Comparison,
    /// The command that shows everything about the ray with an index.
    pub ray_command: &'a dyn Fn(usize) -> String,
}

type OfHit = fn(&FirstHit) -> f64;

/// Writes `report.html` into a folder that is there. Returns its path.
///
/// # Errors
/// The file cannot be written; the message names it.
pub fn write_cast_page(folder: &Path, page: &CastPage<'_>) -> Result<PathBuf, FileError> {
    let path = folder.join("report.html");
    let html = page
        .document()
        .page()
        .map_err(|error| FileError::io(&path, "write", std::io::Error::other(error)))?;
    write_atomically(&path, |file| file.write_all(html.as_bytes()))?;
    Ok(path)
}

impl CastPage<'_> {
    /// The document that every report prints.
    ///
    /// ```
    /// use raypencil_cast::{CastPage, Questions, cast, rays_from_bytes};
    /// use raypencil_scene::{Sides, Silent, Triangles};
    ///
    /// let corners = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    /// let mesh = Triangles::new(corners, vec![[0, 1, 2]])?;
    /// let rays = rays_from_bytes(b"0.25,0.25,1,0,0,-1\n2,2,1,0,0,-1", "here".as_ref())?;
    /// let answers = cast(&mesh, &rays.rays, Sides::Both, Questions::default(), &Silent);
    /// let page = CastPage {
    ///     title: "two rays on <a mesh>",
    ///     facts: &[],
    ///     shape: &rays.shape,
    ///     rays: &rays.rays,
    ///     answers: &answers,
    ///     set: None,
    ///     compared: None,
    /// };
    /// assert!(page.document().page()?.contains("<h1>two rays on &#60;a mesh&#62;</h1>"));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn document(&self) -> Document {
        let (explorer, notes) = self.explorer_with_notes();
        let (outcome, headline) = match &self.compared {
            Some(ComparedHits { name, comparison, .. }) => {
                let outcome = match (comparison.passes(), comparison.counts().wrong) {
                    (true, _) => Outcome::Agrees,
                    (false, 0) => Outcome::Open,
                    (false, _) => Outcome::Fails,
                };
                (outcome, format!("{name}: {}", comparison_headline(comparison)))
            }
            None => (Outcome::Told, self.title.to_string()),
        };
        let drawings = self.set.map(|set| [range_picture(self.answers, set), top_picture(self.answers, set)]);
        let titles = ["Range of each ray", "Points from above"];
        let pictures = drawings.into_iter().flatten().zip(titles).filter_map(|(drawing, title)| {
            let source = drawing?.data_uri();
            Some(format!(
                "<figure><img src=\"{source}\" alt=\"{title}\" style=\"max-width:100%;height:auto\"></figure>\n"
            ))
        });
        let text = |lines| Block::Text { title: "", lines, room: Room::Everywhere };
        Document {
            run: format!("raypencil cast: {}", self.title),
            question: self.title.to_string(),
            outcome,
            headline,
            remarks: vec![format!("{}.", counts_text(self.answers))],
            explanation: Vec::new(),
            counts: Vec::new(),
            facts: self.facts.to_vec(),
            blocks: vec![
                text(notes),
                Block::Table { title: "Values where the face is the same", grid: self.values() },
                Block::Pictures { title: "From the sensor", html: pictures.collect(), stays: true },
            ],
            suites: Vec::new(),
            format: 1,
            verdict: match outcome {
                Outcome::Agrees => "agrees",
                Outcome::Fails => "defects",
                Outcome::Open => "nothing_hit",
                Outcome::Told => "told",
            },
            data: serde_json::Map::new(),
            explorer,
        }
    }

    /// The values that another program gives, with their worst errors.
    fn values(&self) -> Grid {
        let mut grid = Grid::new([
            Column::text("value"),
            Column::number("compared"),
            Column::number("worst error / bound"),
            Column::number("at ray"),
        ]);
        for tally in self.compared.iter().flat_map(|compared| &compared.comparison.values) {
            let worst = tally.worst.map(|(worst, at)| (format!("{worst:.3}"), at.to_string()));
            let (worst, at) = worst.unwrap_or_default();
            grid.row([tally.value.name().to_string(), count(tally.compared), worst, at], false);
        }
        grid
    }

    /// The part that answers when asked, as HTML, and sentences on what it shows. Empty where the rays are too many.
    pub(crate) fn explorer_with_notes(&self) -> (String, Vec<String>) {
        match self.explorer() {
            None => (String::new(), vec![TOO_MANY.into()]),
            Some((html, layout, left_out)) => {
                let words = [layout, left_out, NUMBERS.to_string()];
                (html, words.into_iter().filter(|words| !words.is_empty()).collect())
            }
        }
    }

    /// Number of sides: the exact answers, and the other program's.
    fn sides(&self) -> usize {
        1 + usize::from(self.compared.is_some())
    }

    /// The elements of the explorer; in words, where each ray stands, and which channels found no room. `None` if not one
    /// channel would find room: nothing is then made for each ray.
    fn explorer(&self) -> Option<(String, String, String)> {
        if self.sides() * self.rays.len() > MAX_CELLS {
            return None;
        }
        let layout = Layout::of(self.shape, self.set);
        let (group, left_out) = self.group(&layout);
        let (described, differing) = (group.described.len() as u64, group.differing.len() as u64);
        let words = match differing {
            0 => String::new(),
            _ if described == differing => described_words(described, differing),
            _ => format!(
                "{} of the {} rays that are not the same are described in full: the worst by class, the first of each.",
                count(described),
                count(differing)
            ),
        };
        let exact = ("exact", SideKind::Exact);
        let other = self.compared.map(|compared| (compared.name, SideKind::Candidate));
        let sides: Vec<(&str, SideKind)> = std::iter::once(exact).chain(other).collect();
        let page = RasterPage {
            kind: "cast",
            title: self.title,
            sides: &sides,
            classes: ["same", "tie", "rounding", "approximation", "undecided", "wrong"],
            groups: &[group],
            described_words: &words,
        };
        Some((page.html(), layout.words, left_out))
    }

    /// The channels of both sides, and in words which of them found no room.
    fn group(&self, layout: &Layout) -> (RasterGroup, String) {
        let mut room = MAX_CELLS;
        let mut channels = Vec::new();
        let mut left_out = Vec::new();
        let sides = self.sides();
        for (name, unit, channel) in self.channels() {
            match room.checked_sub(sides * layout.rays.len()) {
                Some(left) => {
                    room = left;
                    channels.push((name.to_string(), unit.to_string(), channel.laid_out(layout)));
                }
                None => left_out.push(name),
            }
        }
        let words = match left_out.as_slice() {
            [] => String::new(),
            names => format!("Not among the maps for want of room: {}.", names.join(", ")),
        };
        let (differing, described) = self.differing(layout);
        let size = (layout.width, layout.height);
        (RasterGroup { name: layout.name.clone(), size, channels, differing, described }, words)
    }

    /// Each channel with its name and unit, in order of importance: ray by ray, the exact answers and then the others.
    fn channels(&self) -> Vec<(&'static str, &'static str, PerRay)> {
        let (answers, rays) = (self.answers, self.answers.first.len() as u32);
        let stated = self.compared.map(|compared| compared.stated);
        let real = |of: OfHit, none: f64| answers.values(of, none);
        let both = |exact: Vec<f64>, other: Option<Vec<f64>>| match stated {
            Some(_) => PerRay::Reals(vec![Some(exact), other]),
            None => PerRay::Reals(vec![Some(exact)]),
        };
        let wholes = |exact: Vec<u32>, other: Option<Vec<u32>>| match stated {
            Some(_) => PerRay::Wholes(vec![Some(exact), other]),
            None => PerRay::Wholes(vec![Some(exact)]),
        };
        let face = |face: Option<raypencil_scene::FaceId>| face.map_or(u32::MAX, |face| face.0);
        let sides = |side: Option<Side>| match side {
            Some(Side::Front) => 1.0,
            Some(Side::Back) => -1.0,
            None => 0.0,
        };
        let part = |vectors: &Option<Vec<glam::DVec3>>, axis: usize| -> Option<Vec<f64>> {
            Some(vectors.as_ref()?.iter().map(|vector| vector[axis]).collect())
        };
        let given = |of: fn(&Stated) -> &Option<Vec<f64>>| stated.and_then(|stated| of(stated).clone());
        let mut channels = vec![
            ("range.T", "m", both(answers.distances(|hit| hit.range), given(|stated| &stated.range))),
            (
                "face.I",
                "",
                wholes(
                    answers.values(|hit| hit.face.0, u32::MAX),
                    stated.and_then(|stated| {
                        Some(stated.face.as_ref()?.iter().map(|one| face(*one)).collect())
                    }),
                ),
            ),
            (
                "incidence.V",
                "",
                both(real(|hit| hit.cos_incidence, f64::NAN), given(|stated| &stated.cos_incidence)),
            ),
            // Which ray of the arrays a cell is.
            ("ray", "", wholes((0..rays).collect(), stated.map(|_| (0..rays).collect()))),
            (
                "side",
                "",
                both(
                    answers.values(|hit| sides(Some(hit.side)), 0.0),
                    stated.and_then(|stated| {
                        Some(stated.side.as_ref()?.iter().map(|one| sides(*one)).collect())
                    }),
                ),
            ),
            ("faces at this t", "", both(real(|hit| f64::from(hit.ties), 0.0), None)),
            ("t", "", both(answers.distances(|hit| hit.t), given(|stated| &stated.t))),
        ];
        let points: [(&str, OfHit); 3] =
            [("P.X", |hit| hit.point.x), ("P.Y", |hit| hit.point.y), ("P.Z", |hit| hit.point.z)];
        let normals: [(&str, OfHit); 3] =
            [("N.X", |hit| hit.normal.x), ("N.Y", |hit| hit.normal.y), ("N.Z", |hit| hit.normal.z)];
        for (axis, (name, of)) in points.into_iter().enumerate() {
            let other = stated.and_then(|stated| part(&stated.point, axis));
            channels.push((name, "m", both(real(of, f64::NAN), other)));
        }
        for (axis, (name, of)) in normals.into_iter().enumerate() {
            let other = stated.and_then(|stated| part(&stated.normal, axis));
            channels.push((name, "", both(real(of, f64::NAN), other)));
        }
        if let Some(margins) = &self.answers.margins {
            let of = |margin: fn(&raypencil_referee::Margins) -> f64| margins.iter().map(margin).collect();
            channels.push(("margin to another face", "m", both(of(|margins| margins.face.lo), None)));
            channels.push(("margin to another surface", "m", both(of(|margins| margins.surface.lo), None)));
        }
        if let Some(times) = self.set.and_then(|set| set.times.as_ref()) {
            channels.push(("time", "s", both(times.clone(), None)));
        }
        channels
    }

    /// The cells on which both sides are not the same, and those that are described in full.
    fn differing(&self, layout: &Layout) -> (Vec<DifferingCell>, Vec<(u32, String)>) {
        let Some(compared) = &self.compared else { return (Vec::new(), Vec::new()) };
        // Channels are in the order of `channels`.
        let (range, face) = (0, 1);
        let mut differing = Vec::new();
        let mut described = Vec::new();
        for (cell, ray) in layout.rays.iter().enumerate() {
            let Some(ray) = *ray else { continue };
            let verdict = &compared.comparison.verdicts[ray];
            let names_another = compared
                .stated
                .face
                .as_ref()
                .is_some_and(|faces| faces[ray] != self.answers.first[ray].hit().map(|hit| hit.face));
            let (class, words) = match verdict {
                RayVerdict::Same { is_tie: true } if names_another => {
                    (Class::Tie, "another face that is met at this very t".to_string())
                }
                RayVerdict::Same { .. } => continue,
                RayVerdict::Rounding { moved: [a, b] } => {
                    (Class::Rounding, format!("the answer of a ray moved sideways by {a:e} and {b:e}"))
                }
                RayVerdict::Wrong(wrong) => (Class::Defect, wrong_text(wrong)),
            };
            let cell = cell as u32;
            let channel = if names_another { face } else { range };
            differing.push(DifferingCell { cell, channel, class });
            described.push((cell, class, ray, words));
        }
        // The worst first; of equals the first.
        described.sort_by_key(|(_, class, _, _)| std::cmp::Reverse(*class));
        described.truncate(MAX_DESCRIBED_RAYS);
        let described = described.into_iter().map(|(cell, _, ray, words)| {
            let exact = ray_text(&self.rays[ray], self.answers, ray);
            let (question, answer) = exact.split_once('\n').unwrap_or((&exact, ""));
            let answer: String = answer.lines().map(|line| format!("  {line}\n")).collect();
            let text = format!(
                "  ray {ray}\n    {question}\n  {}\n    {words}\n  exactly\n{answer}  again: {}\n",
                compared.name,
                (compared.ray_command)(ray)
            );
            (cell, text)
        });
        (differing, described.collect())
    }
}

/// Numbers of one channel, one for each ray, on each side.
enum PerRay {
    Reals(Vec<Option<Vec<f64>>>),
    Wholes(Vec<Option<Vec<u32>>>),
}

impl PerRay {
    fn laid_out(&self, layout: &Layout) -> RasterChannel {
        match self {
            Self::Reals(sides) => {
                let cells = |side: &Option<Vec<f64>>| {
                    let side = side.as_ref()?;
                    Some(layout.rays.iter().map(|ray| ray.map_or(f32::NAN, |ray| side[ray] as f32)).collect())
                };
                RasterChannel::Reals(sides.iter().map(cells).collect())
            }
            Self::Wholes(sides) => {
                let cells = |side: &Option<Vec<u32>>| {
                    let side = side.as_ref()?;
                    Some(layout.rays.iter().map(|ray| ray.map_or(u32::MAX, |ray| side[ray])).collect())
                };
                RasterChannel::Wholes(sides.iter().map(cells).collect())
            }
        }
    }
}

/// Where each ray stands on the page.
struct Layout {
    name: String,
    width: u32,
    height: u32,
    /// The ray of each cell; `None` behind the last one.
    rays: Vec<Option<usize>>,
    words: String,
}

impl Layout {
    fn of(shape: &[u64], set: Option<&NamedRaySet>) -> Self {
        let name = set.map_or("rays", |set| &set.name).to_string();
        let of_set = set.and_then(|set| Some((shape, set.elevations_deg.as_ref()?)));
        if let Some((&[firings, channels], elevations)) = of_set {
            let mut order: Vec<usize> = (0..elevations.len()).collect();
            order.sort_by(|&a, &b| elevations[b].total_cmp(&elevations[a]));
            let rays = order.iter().flat_map(|channel| {
                (0..firings as usize).map(move |firing| Some(firing * channels as usize + channel))
            });
            let words = "A row for each channel, the highest elevation on top; columns are firing sequences, in the order of \
                         time.";
            return Self {
                name,
                width: firings as u32,
                height: channels as u32,
                rays: rays.collect(),
                words: words.into(),
            };
        }
        let all: u64 = shape.iter().product();
        let (width, words) = match shape {
            [] | [_] => {
                let side = (1..).find(|side: &u64| side * side >= all).unwrap_or(1).max(1);
                (side, "The rays in their order, row by row.")
            }
            [_, rest @ ..] => (
                rest.iter().product::<u64>().max(1),
                "A row for each index of the first dimension; the others follow each other along it.",
            ),
        };
        let height = all.div_ceil(width).max(1);
        let rays = (0..(width * height) as usize).map(|ray| (ray < all as usize).then_some(ray));
        Self { name, width: width as u32, height: height as u32, rays: rays.collect(), words: words.into() }
    }
}

#[cfg(test)]
#[path = "../tests/unit/page.rs"]
mod tests;
