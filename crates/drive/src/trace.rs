//! Where two sides of a drive part: how far a difference of their light gets, stage by stage.

use sha2::{Digest, Sha256};
use std::collections::BTreeSet;

use crate::job::DriveJob;
use crate::sun::Sun;
use raypencil_rover::{DriveFrame, ElevationMap, Exposure, MeasuredPoint};
use raypencil_scene::{Image, Scene};

/// What was compared at one stage.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct StageTrace {
    /// How many things.
    pub compared: u64,
    /// How many of them are not the same.
    pub differ: u64,
    /// The first of these, in words.
    pub first: Option<String>,
}

impl StageTrace {
    fn add(&mut self, compared: u64, differ: u64, first: impl FnOnce() -> String) {
        self.compared += compared;
        self.differ += differ;
        if differ > 0 && self.first.is_none() {
            self.first = Some(first());
        }
    }
}

/// What was compared of the light itself. Two honest renderers differ in its last bits; it is told, and fails nothing.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct FluxTrace {
    /// Pixels that are lit on either side.
    pub lit: u64,
    /// Those whose watts are not the very same number.
    pub differ: u64,
    /// The largest difference, of the larger of the two.
    pub largest_relative: f64,
}

/// Every stage of a drive on two sides.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Trace {
    /// Watts on the camera's pixels.
    pub flux: FluxTrace,
    /// Digital numbers of all exposures.
    pub pixels: StageTrace,
    /// Edge points of the stripes.
    pub edges: StageTrace,
    /// Cells of the map after each frame.
    pub cells: StageTrace,
    /// Sectors of obstacle maps and vectors of navigator maps.
    pub labels: StageTrace,
}

impl Trace {
    /// The stages at which a difference counts, by name.
    pub fn stages(&self) -> [(&'static str, &StageTrace); 4] {
        [
            ("pixels of the digital images", &self.pixels),
            ("edge points", &self.edges),
            ("map cells", &self.cells),
            ("labels", &self.labels),
        ]
    }

    /// Whether both sides saw, measured, mapped and labelled the same.
    pub fn is_identical(&self) -> bool {
        self.stages().iter().all(|(_, stage)| stage.differ == 0)
    }
}

/// What is kept of one exposure of the first side until the second has its own: a digest of the numbers, from which the
/// light gives them again.
#[derive(Debug, Clone)]
pub(crate) struct Kept {
    exposure: Exposure,
    /// Which exposure of the drive: of the camera's noise.
    number: u64,
    /// What was exposed, if the sun shone on it.
    scene: Option<Scene>,
    size: (u32, u32),
    /// Pixels that are lit, and their watts; nothing where a frame has more of them than are kept.
    lit: Option<Vec<(u32, f64)>>,
    digest: [u8; 32],
}

/// How many lit pixels of one frame are kept on each side: 128 MiB. A vertical scan behind blurring optics has more.
pub(crate) const MOST_LIT: usize = 1 << 23;

impl Kept {
    /// `room` is for so many lit pixels.
    pub(super) fn new(
        exposure: Exposure,
        number: u64,
        scene: Option<Scene>,
        light: &Image<f64>,
        numbers: &Image<i32>,
        room: usize,
    ) -> Self {
        let mut hasher = Sha256::new();
        let mut bytes = Vec::new();
        for row in numbers.cells().chunks(numbers.width().max(1) as usize) {
            bytes.clear();
            bytes.extend(row.iter().flat_map(|number| number.to_le_bytes()));
            hasher.update(&bytes);
        }
        let lit = || light.cells().iter().enumerate().filter(|(_, watts)| **watts != 0.0);
        let fits = lit().nth(room).is_none();
        Self {
            exposure,
            number,
            scene,
            size: (light.width(), light.height()),
            lit: fits.then(|| lit().map(|(index, &watts)| (index as u32, watts)).collect()),
            digest: hasher.finalize().into(),
        }
    }

    /// How many lit pixels are kept.
    pub(super) fn lit(&self) -> usize {
        self.lit.as_ref().map_or(0, Vec::len)
    }

    /// The digital numbers once more.
    fn numbers(&self, lit: &[(u32, f64)], job: &DriveJob, sun: Option<&Sun>) -> Image<i32> {
        let mut light = Image::filled(self.size.0, self.size.1, 0.0);
        for &(index, watts) in lit {
            light.cells_mut()[index as usize] = watts;
        }
        let background = self.scene.as_ref().zip(sun).map(|(scene, sun)| sun.background(job, scene));
        job.digital(&light, background.as_ref(), self.number)
    }
}

/// "frame 3", "frame 3, position 17 of the scan".
fn moment(frame: u64, step: Option<u32>) -> String {
    step.map_or(format!("frame {frame}"), |step| format!("frame {frame}, position {step} of the scan"))
}

impl Trace {
    /// One frame's exposures.
    pub(super) fn exposures(&mut self, job: &DriveJob, sun: Option<&Sun>, a: &[Kept], b: &[Kept]) {
        for (a, b) in a.iter().zip(b) {
            let lit = a.lit.as_ref().zip(b.lit.as_ref());
            if let Some((of_a, of_b)) = lit {
                self.light(of_a, of_b);
            }
            let cells = u64::from(a.size.0) * u64::from(a.size.1);
            let Exposure { frame, step, beam } = a.exposure;
            let when = moment(frame, step) + &beam.map_or(String::new(), |beam| format!(", beam {beam}"));
            if a.digest == b.digest {
                self.pixels.add(cells, 0, String::new);
                continue;
            }
            let Some((lit_a, lit_b)) = lit else {
                self.pixels.add(cells, 1, || format!("{when}: somewhere, in one pixel or more"));
                continue;
            };
            let (of_a, of_b) = (a.numbers(lit_a, job, sun), b.numbers(lit_b, job, sun));
            let pairs = || of_a.cells().iter().zip(of_b.cells()).enumerate().filter(|(_, (x, y))| x != y);
            let differ = pairs().count() as u64;
            self.pixels.add(cells, differ, || {
                let Some((index, (x, y))) = pairs().next() else { return when.clone() };
                let (i, j) = (index % a.size.0 as usize, index / a.size.0 as usize);
                format!("{when}, pixel {i},{j}: {x} DN against {y}")
            });
        }
        let missing = a.len().abs_diff(b.len()) as u64;
        self.pixels.add(missing, missing, || format!("{} exposures against {}", a.len(), b.len()));
    }

    /// Lit pixels of one exposure, both in the order of their indices.
    fn light(&mut self, a: &[(u32, f64)], b: &[(u32, f64)]) {
        let (mut a, mut b) = (a.iter().peekable(), b.iter().peekable());
        loop {
            let (x, y) = match (a.peek(), b.peek()) {
                (None, None) => return,
                (Some(&&(i, x)), Some(&&(j, y))) if i == j => {
                    a.next();
                    b.next();
                    (x, y)
                }
                (Some(&&(i, x)), other) if other.is_none_or(|&&(j, _)| i < j) => {
                    a.next();
                    (x, 0.0)
                }
                _ => (0.0, b.next().map_or(0.0, |&(_, y)| y)),
            };
            self.flux.lit += 1;
            if x != y {
                self.flux.differ += 1;
                let relative = (x - y).abs() / x.abs().max(y.abs());
                self.flux.largest_relative = self.flux.largest_relative.max(relative);
            }
        }
    }

    /// What one frame made of its exposures.
    pub(super) fn frames(&mut self, a: &DriveFrame, b: &DriveFrame, maps: [&ElevationMap; 2]) {
        self.edges(a, b);
        self.cells(a.index, maps);
        if let (Some((of_a, vectors_a)), Some((of_b, vectors_b))) = (&a.obstacles, &b.obstacles) {
            let sectors = of_a.sectors.iter().zip(&of_b.sectors).enumerate();
            let differing: Vec<_> = sectors.filter(|(_, (x, y))| x != y).collect();
            let (count, differ) = (of_a.sectors.len() as u64, differing.len() as u64);
            self.labels.add(count, differ, || {
                differing.first().map_or(String::new(), |(sector, (x, y))| {
                    format!(
                        "{}, sector {sector}: {:?} at {} m against {:?} at {} m",
                        moment(a.index, None),
                        x.label,
                        x.radius,
                        y.label,
                        y.radius
                    )
                })
            });
            let vectors = vectors_a.iter().zip(vectors_b).enumerate();
            let differing: Vec<_> = vectors.filter(|(_, (x, y))| x != y).collect();
            let (count, differ) = (vectors_a.len() as u64, differing.len() as u64);
            self.labels.add(count, differ, || {
                differing.first().map_or(String::new(), |(vector, (x, y))| {
                    let when = moment(a.index, None);
                    format!("{when}, vector {vector}: {:?} against {:?}", x.label, y.label)
                })
            });
        }
    }

    fn edges(&mut self, a: &DriveFrame, b: &DriveFrame) {
        let compared = a.measured.len().max(b.measured.len()) as u64;
        if a.measured == b.measured {
            self.edges.add(compared, 0, String::new);
            return;
        }
        // Position of the scan, beam, column, row; where within the pixel it was measured counts as well.
        let keys = |measured: &[MeasuredPoint]| -> BTreeSet<(Option<u32>, usize, u32, u32, u64)> {
            let key =
                |one: &MeasuredPoint| (one.step, one.beam, one.edge.i, one.edge.j, one.edge.row.to_bits());
            measured.iter().map(key).collect()
        };
        let (of_a, of_b) = (keys(&a.measured), keys(&b.measured));
        // A point that moved is on one side here and on the other there: it counts once.
        let (only_a, only_b) = (of_a.difference(&of_b).count(), of_b.difference(&of_a).count());
        let differ = only_a.max(only_b).max(1) as u64;
        self.edges.add(compared, differ, || {
            let first = of_a.symmetric_difference(&of_b).next();
            first.map_or(moment(a.index, None), |&(step, beam, i, j, row)| {
                let side = if of_a.contains(&(step, beam, i, j, row)) { "first" } else { "second" };
                let row = f64::from_bits(row);
                format!(
                    "{}, beam {beam}, column {i}: row {row} on the {side} side only",
                    moment(a.index, step)
                )
            })
        });
    }

    fn cells(&mut self, frame: u64, [a, b]: [&ElevationMap; 2]) {
        let cell = |map: &ElevationMap, point| (map.source(point), map.elevation(point).map(f64::to_bits));
        let (mut compared, mut differ, mut first) = (0, 0, None);
        for point in a.points() {
            compared += 1;
            if cell(a, point) != cell(b, point) {
                differ += 1;
                first.get_or_insert(point);
            }
        }
        self.cells.add(compared, differ, || {
            first.map_or(String::new(), |point| {
                let place = a.place(point);
                let word =
                    |map: &ElevationMap| map.elevation(point).map_or("unknown".into(), |z| format!("{z} m"));
                let when = moment(frame, None);
                format!("{when}, cell at {:.3}, {:.3} m: {} against {}", place.x, place.y, word(a), word(b))
            })
        });
    }
}
