//! Differences between the two sides of a drive, stage by stage: how far a difference of their light gets.

use std::collections::BTreeSet;

use raypencil_rover::{DriveFrame, ElevationMap, Exposure, MeasuredPoint};

use crate::job::DriveJob;
use crate::recorded_exposure::RecordedExposure;
use crate::sun::Sun;

/// Differences at one stage.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct StageDifferences {
    /// Number of items that were compared.
    pub compared: u64,
    /// Number of items that are not equal.
    pub differ: u64,
    /// Description of the first unequal item.
    pub first: Option<String>,
}

impl StageDifferences {
    fn add(&mut self, compared: u64, differ: u64, first: impl FnOnce() -> String) {
        self.compared += compared;
        self.differ += differ;
        if differ > 0 && self.first.is_none() {
            self.first = Some(first());
        }
    }
}

/// Differences of the flux on the camera's pixels. Two correct renderers differ in the last bits: these differences are
/// reported, but they fail nothing.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct FluxDifferences {
    /// Number of pixels that are lit on at least one side.
    pub lit: u64,
    /// Number of those whose two fluxes, in watts, are not equal to the last bit.
    pub differ: u64,
    /// Largest difference, relative to the larger of the two fluxes.
    pub largest_relative: f64,
}

/// Differences at all stages of a drive on two sides.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Differences {
    /// Flux on the camera's pixels.
    pub flux: FluxDifferences,
    /// Digital numbers of all exposures.
    pub pixels: StageDifferences,
    /// Edge points of the stripes.
    pub edges: StageDifferences,
    /// Cells of the elevation map after each frame.
    pub cells: StageDifferences,
    /// Sectors of obstacle maps and vectors of navigator maps.
    pub labels: StageDifferences,
}

impl Differences {
    /// The stages at which a difference counts, with their names.
    pub fn stages(&self) -> [(&'static str, &StageDifferences); 4] {
        [
            ("pixels of the digital images", &self.pixels),
            ("edge points", &self.edges),
            ("map cells", &self.cells),
            ("labels", &self.labels),
        ]
    }

    /// Whether both sides have equal pixels, edge points, map cells and labels.
    pub fn is_identical(&self) -> bool {
        self.stages().iter().all(|(_, stage)| stage.differ == 0)
    }
}

/// Words for a frame, or for a position of its scan: "frame 3", "frame 3, position 17 of the scan".
fn moment(frame: u64, step: Option<u32>) -> String {
    step.map_or(format!("frame {frame}"), |step| format!("frame {frame}, position {step} of the scan"))
}

impl Differences {
    /// Compares the exposures of one frame: flux and digital numbers.
    pub(crate) fn add_exposures(
        &mut self,
        job: &DriveJob,
        sun: Option<&Sun>,
        a: &[RecordedExposure],
        b: &[RecordedExposure],
    ) {
        for (a, b) in a.iter().zip(b) {
            let lit = a.lit.as_ref().zip(b.lit.as_ref());
            if let Some((lit_a, lit_b)) = lit {
                self.add_flux(lit_a, lit_b);
            }
            let cells = u64::from(a.size.0) * u64::from(a.size.1);
            let Exposure { frame, step, beam } = a.exposure;
            let when = moment(frame, step) + &beam.map_or(String::new(), |beam| format!(", beam {beam}"));
            if a.digest == b.digest {
                self.pixels.add(cells, 0, String::new);
                continue;
            }
            let Some((lit_a, lit_b)) = lit else {
                self.pixels.add(cells, 1, || format!("{when}: at least one pixel"));
                continue;
            };
            let (numbers_a, numbers_b) = (a.numbers(lit_a, job, sun), b.numbers(lit_b, job, sun));
            let pairs =
                || numbers_a.cells().iter().zip(numbers_b.cells()).enumerate().filter(|(_, (x, y))| x != y);
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

    /// Compares the lit pixels of one exposure, index and watts, both in the order of their indices.
    fn add_flux(&mut self, a: &[(u32, f64)], b: &[(u32, f64)]) {
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

    /// Compares the results of one frame: edge points, map cells and labels.
    pub(crate) fn add_frame(&mut self, a: &DriveFrame, b: &DriveFrame, maps: [&ElevationMap; 2]) {
        self.add_edges(a, b);
        self.add_cells(a.index, maps);
        if let (Some((map_a, vectors_a)), Some((map_b, vectors_b))) = (&a.obstacles, &b.obstacles) {
            let sectors = map_a.sectors.iter().zip(&map_b.sectors).enumerate();
            let differing: Vec<_> = sectors.filter(|(_, (x, y))| x != y).collect();
            let (count, differ) = (map_a.sectors.len() as u64, differing.len() as u64);
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

    fn add_edges(&mut self, a: &DriveFrame, b: &DriveFrame) {
        let compared = a.measured.len().max(b.measured.len()) as u64;
        if a.measured == b.measured {
            self.edges.add(compared, 0, String::new);
            return;
        }
        // Position of the scan, beam, column, row, and the bits of the row with its fraction.
        let keys = |measured: &[MeasuredPoint]| -> BTreeSet<(Option<u32>, usize, u32, u32, u64)> {
            let key =
                |one: &MeasuredPoint| (one.step, one.beam, one.edge.i, one.edge.j, one.edge.row.to_bits());
            measured.iter().map(key).collect()
        };
        let (keys_a, keys_b) = (keys(&a.measured), keys(&b.measured));
        // A point that moved is missing on either side once: it counts once.
        let (only_a, only_b) = (keys_a.difference(&keys_b).count(), keys_b.difference(&keys_a).count());
        let differ = only_a.max(only_b).max(1) as u64;
        self.edges.add(compared, differ, || {
            let first = keys_a.symmetric_difference(&keys_b).next();
            first.map_or(moment(a.index, None), |&(step, beam, i, j, row)| {
                let side = if keys_a.contains(&(step, beam, i, j, row)) { "first" } else { "second" };
                let row = f64::from_bits(row);
                format!(
                    "{}, beam {beam}, column {i}: row {row} on the {side} side only",
                    moment(a.index, step)
                )
            })
        });
    }

    fn add_cells(&mut self, frame: u64, [a, b]: [&ElevationMap; 2]) {
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
