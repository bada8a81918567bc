//! The page of a cast: the answers as maps that can be asked, ray by ray.

use std::path::{Path, PathBuf};

use raypencil_explorer::{DifferingCell, RasterChannel, RasterGroup, RasterPage, SideKind};
use raypencil_files::{FileError, write_atomically};
use raypencil_judge::Class;
use raypencil_report::{Block, Column, Document, Grid, Outcome, Room, count, described_words};
use raypencil_scene::{CastRay, NamedRaySet, Reading, Side, Triangles};

use crate::answers::{Answers, FirstHit, side_number};
use crate::comparison::{Comparison, RayVerdict, Stated, comparison_headline, wrong_text};
use crate::layout::{Layout, PageScan};
use crate::page_solid::page_solid;
use crate::range_picture::{range_picture, top_picture};
use crate::returns::BeamReturns;
use crate::text::{counts_text, ray_text};

/// Maximum number of cells of all channels and sides together: it keeps a page to some ten megabytes.
const MAX_CELLS: usize = 4_000_000;

/// Channels that find room in any case, in the order of [`CastPage::channels`]: of more rays than that allows some are left out.
const SURE_CHANNELS: usize = 8;

/// Maximum number of rays that a page describes in full.
const MAX_DESCRIBED_RAYS: usize = 1000;

/// How the numbers of a page are to be read; whether the arrays that it shows stand beside it.
fn of_numbers(has_arrays: bool) -> String {
    let arrays = if has_arrays { "; the arrays beside it have all digits" } else { "" };
    format!(
        "The numbers of this page are in single precision{arrays}. Lengths are in the mesh's own unit, which the scales call m."
    )
}

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
    /// The mesh, for the points in 3-D over it.
    pub mesh: Option<&'a Triangles>,
    /// The set, if the rays have a pattern: it is drawn as fixed pictures too.
    pub set: Option<&'a NamedRaySet>,
    /// The scan, if the rays have one.
    pub scan: Option<PageScan<'a>>,
    /// Whether the arrays of the answers stand beside the page.
    pub has_arrays: bool,
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
    ///     mesh: None,
    ///     set: None,
    ///     scan: None,
    ///     has_arrays: false,
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

    /// The part that answers when asked, as HTML, and sentences on what it shows.
    pub(crate) fn explorer_with_notes(&self) -> (String, Vec<String>) {
        let (html, layout, left_out) = self.explorer();
        let words = [layout, left_out, of_numbers(self.has_arrays)];
        (html, words.into_iter().filter(|words| !words.is_empty()).collect())
    }

    /// Number of sides: the exact answers, and the other program's.
    fn sides(&self) -> usize {
        1 + usize::from(self.compared.is_some())
    }

    /// The elements of the explorer; in words, where each ray stands, and which channels found no room.
    fn explorer(&self) -> (String, String, String) {
        let layout = self.layout();
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
            solid: self.mesh.map(|mesh| page_solid(mesh, self.scan.as_ref())),
        };
        (page.html(), layout.words, left_out)
    }

    /// Where each ray stands. Of rays without room for each the worst are shown.
    fn layout(&self) -> Layout {
        let most = MAX_CELLS / (SURE_CHANNELS * self.sides());
        let rank = |ray: usize| match self.compared.as_ref().map(|of| &of.comparison.verdicts[ray]) {
            Some(RayVerdict::Wrong(_)) => 2,
            Some(RayVerdict::Rounding { .. }) => 1,
            _ => 0,
        };
        Layout::of(self.shape, self.rays, self.scan.as_ref()).thinned(most, rank)
    }

    /// The channels of both sides, and in words which of them found no room.
    fn group(&self, layout: &Layout) -> (RasterGroup, String) {
        let mut room = MAX_CELLS;
        let mut channels = Vec::new();
        let mut left_out = Vec::new();
        let sides = self.sides();
        for (name, unit, channel) in self.channels(layout) {
            match room.checked_sub(sides * layout.rays.len()) {
                Some(left) => {
                    room = left;
                    channels.push((name.to_string(), unit.to_string(), channel));
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
        (
            RasterGroup {
                name: layout.name.clone(),
                size,
                axes: layout.axes.clone(),
                channels,
                differing,
                described,
            },
            words,
        )
    }

    /// Each channel with its name and unit, in order of importance: cell by cell, the exact answers and then the others.
    fn channels(&self, layout: &Layout) -> Vec<(&'static str, &'static str, RasterChannel)> {
        let (answers, stated) = (self.answers, self.compared.map(|compared| compared.stated));
        let cells = |of: &dyn Fn(usize) -> f64| -> Vec<f32> {
            layout.rays.iter().map(|ray| ray.map_or(f32::NAN, |ray| of(ray) as f32)).collect()
        };
        let whole_cells = |of: &dyn Fn(usize) -> u32| -> Vec<u32> {
            layout.rays.iter().map(|ray| ray.map_or(u32::MAX, of)).collect()
        };
        let hit = |of: OfHit, none: f64| cells(&|ray| answers.first[ray].hit().map_or(none, of));
        let distance = |of: OfHit| {
            cells(&|ray| match &answers.first[ray] {
                Reading::Hit(hit) => of(hit),
                Reading::TooNear => f64::NEG_INFINITY,
                Reading::Miss => f64::INFINITY,
            })
        };
        let both = |exact: Vec<f32>, other: Option<Vec<f32>>| match stated {
            Some(_) => RasterChannel::Reals(vec![Some(exact), other]),
            None => RasterChannel::Reals(vec![Some(exact)]),
        };
        let wholes = |exact: Vec<u32>, other: Option<Vec<u32>>| match stated {
            Some(_) => RasterChannel::Wholes(vec![Some(exact), other]),
            None => RasterChannel::Wholes(vec![Some(exact)]),
        };
        let side = |side: Option<Side>| match side {
            Some(Side::Front) => 1.0,
            Some(Side::Back) => -1.0,
            None => 0.0,
        };
        let numbers = |of: fn(&Stated) -> &Option<Vec<f64>>| {
            let values = of(stated?).as_ref()?;
            Some(cells(&|ray| values[ray]))
        };
        let part = |of: fn(&Stated) -> &Option<Vec<glam::DVec3>>, axis: usize| {
            let values = of(stated?).as_ref()?;
            Some(cells(&|ray| values[ray][axis]))
        };
        // What gives t and no range gives it all the same.
        let stated_range = || {
            numbers(|stated| &stated.range).or_else(|| {
                let t = stated?.t.as_ref()?;
                Some(cells(&|ray| t[ray] * self.rays[ray].direction.length()))
            })
        };
        let stated_face = || {
            let faces = stated?.face.as_ref()?;
            Some(whole_cells(&|ray| faces[ray].map_or(u32::MAX, |face| face.0)))
        };
        let stated_side = || {
            let sides = stated?.side.as_ref()?;
            Some(cells(&|ray| side(sides[ray])))
        };
        let exact_face = |ray: usize| answers.first[ray].hit().map_or(u32::MAX, |hit| hit.face.0);
        let number = |ray: usize| ray as u32;
        let mut channels = vec![
            ("range.T", "m", both(distance(|hit| hit.range), stated_range())),
            ("face.I", "", wholes(whole_cells(&exact_face), stated_face())),
            // Which ray of the arrays a cell is.
            ("ray", "", wholes(whole_cells(&number), stated.map(|_| whole_cells(&number)))),
        ];
        let points: [(&str, OfHit); 3] =
            [("P.X", |hit| hit.point.x), ("P.Y", |hit| hit.point.y), ("P.Z", |hit| hit.point.z)];
        for (axis, (name, of)) in points.into_iter().enumerate() {
            channels.push((name, "m", both(hit(of, f64::NAN), part(|stated| &stated.point, axis))));
        }
        if let Some(times) = self.scan.and_then(|scan| scan.times) {
            channels.push(("time", "s", both(cells(&|ray| times[ray]), None)));
        }
        if let Some(rings) = self.scan.and_then(|scan| scan.rings()) {
            // Channels are the second dimension.
            let inner: usize = self.shape.iter().skip(2).map(|&count| count as usize).product();
            let ring = cells(&|ray| rings[ray / inner % rings.len()] as f64);
            channels.push(("ring", "", both(ring, None)));
        }
        if let Some(returns) = self.set.and_then(|set| BeamReturns::of(answers, set)) {
            let footprint = |ray: usize| &returns.footprints()[ray / returns.rays_of_beam()];
            let of_ray = cells(&|ray| match returns.of_rays()[ray] {
                0 => f64::NAN,
                number => f64::from(number),
            });
            channels.push(("return", "", both(of_ray, None)));
            let mixed = cells(&|ray| f64::from(u8::from(footprint(ray).is_mixed())));
            channels.push(("mixed", "", both(mixed, None)));
            let missed = cells(&|ray| returns.missed(footprint(ray)));
            channels.push(("share that missed", "", both(missed, None)));
        }
        channels.extend([
            (
                "incidence.V",
                "",
                both(hit(|hit| hit.cos_incidence, f64::NAN), numbers(|stated| &stated.cos_incidence)),
            ),
            ("side", "", both(hit(|hit| f64::from(side_number(hit.side)), 0.0), stated_side())),
            ("faces at this t", "", both(hit(|hit| f64::from(hit.ties), 0.0), None)),
            ("t", "", both(distance(|hit| hit.t), numbers(|stated| &stated.t))),
        ]);
        let normals: [(&str, OfHit); 3] =
            [("N.X", |hit| hit.normal.x), ("N.Y", |hit| hit.normal.y), ("N.Z", |hit| hit.normal.z)];
        for (axis, (name, of)) in normals.into_iter().enumerate() {
            channels.push((name, "", both(hit(of, f64::NAN), part(|stated| &stated.normal, axis))));
        }
        if let Some(margins) = &self.answers.margins {
            let of = |margin: fn(&raypencil_referee::Margins) -> f64| cells(&|ray| margin(&margins[ray]));
            channels.push(("margin to another face", "m", both(of(|margins| margins.face.lo), None)));
            channels.push(("margin to another surface", "m", both(of(|margins| margins.surface.lo), None)));
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

#[cfg(test)]
#[path = "../tests/unit/page.rs"]
mod tests;
