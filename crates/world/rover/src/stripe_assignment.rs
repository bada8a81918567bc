//! Which beam lit a run of light, if several beams are lit in one exposure.
//!
//! A run belongs to the beam on whose edge plane it can lie. Three rules decide, in this order: the plane itself (within the
//! beam's fan and range), the order of the stripes in a column, and continuity from column to column. What they leave open is
//! ambiguous, and is left out.

use raypencil_scene::Image;

use crate::stripe::{EdgePoint, Extraction, LitRun};
use crate::triangulation::Triangulation;

/// Beams that can be told apart in one image: a bit each.
const MAX_BEAMS: usize = 64;

/// A run with the beams that may have lit it, a bit each.
#[derive(Debug, Clone, Copy)]
struct Node {
    run: LitRun,
    beams: u64,
    piece: usize,
}

/// Runs that continue one another from column to column: one beam lit them all.
#[derive(Debug, Clone, Default)]
struct Piece {
    /// Beams that may have lit it.
    beams: u64,
    /// Number of columns that give it to each beam by their order.
    votes: Vec<u32>,
}

impl Extraction {
    /// Edges of all beams in one exposure, beam by beam, each in row-major order. `sheets` has the plane of each beam on
    /// which edges are triangulated, in order of their stripes, the lowest first. A run is given to the beam on whose plane it
    /// can lie; a run that two beams may have lit is left out. The second value is the number of columns with such runs.
    ///
    /// CHOICE: the paper does not say how it tells the stripes of one image apart. Three rules, in this order:
    ///
    /// 1. *Plane.* The ray of the run's edge meets the beam's plane in its fan and range.
    /// 2. *Continuity.* Runs of neighbouring columns that touch, one by one, are a piece, and one beam lit all of it. In a column
    ///    with exactly one run for each beam the lowest is beam 0's; a piece goes to the beam for which most of its columns
    ///    are.
    /// 3. *Order.* Above a run of a beam lie runs of this beam and of those after it, below it those before it. This is wrong
    ///    only if a beam meets the ground so near that its stripe lies above the next one.
    ///
    /// Exposures of one beam at a time have nothing to tell apart.
    pub fn edges_by_plane<T: Copy + Into<f64> + Sync>(
        &self,
        image: &Image<T>,
        sheets: &[Triangulation],
    ) -> (Vec<Vec<EdgePoint>>, usize) {
        let columns = self.columns(image);
        let count = sheets.len().min(MAX_BEAMS);
        let beams = beams_of_runs(&columns, count, |edge, beam| sheets[beam].at_edge(edge).is_some());
        let mut stripes = vec![Vec::new(); sheets.len()];
        let mut columns_left_out = 0;
        for (runs, beams) in columns.iter().zip(&beams) {
            for (run, beam) in runs.iter().zip(beams) {
                if let Some(beam) = beam {
                    stripes[*beam].push(run.edge);
                }
            }
            columns_left_out += usize::from(beams.contains(&None));
        }
        for stripe in &mut stripes {
            stripe.sort_by_key(|edge| (edge.j, edge.i));
        }
        (stripes, columns_left_out)
    }
}

/// The beam of each run, column by column and from the top as given; `None` where more than one beam may have lit it.
///
/// `can_light` says whether the edge of a run can lie on the edge plane of a beam. Beams come in order of their stripes, the
/// lowest first.
fn beams_of_runs(
    columns: &[Vec<LitRun>],
    beams: usize,
    can_light: impl Fn(&EdgePoint, usize) -> bool,
) -> Vec<Vec<Option<usize>>> {
    let possible = |edge: &EdgePoint| {
        (0..beams).filter(|&beam| can_light(edge, beam)).fold(0_u64, |set, beam| set | 1 << beam)
    };
    let mut nodes: Vec<Vec<Node>> = Vec::with_capacity(columns.len());
    let mut pieces: Vec<Piece> = Vec::new();
    for column in columns {
        let before = nodes.last().map_or(&[][..], Vec::as_slice);
        let now: Vec<Node> = column
            .iter()
            .map(|run| {
                let beams = possible(&run.edge);
                let piece = continued(run, before, column).unwrap_or(pieces.len());
                match pieces.get_mut(piece) {
                    Some(piece) => piece.beams &= beams,
                    None => pieces.push(Piece { beams, votes: Vec::new() }),
                }
                Node { run: *run, beams, piece }
            })
            .collect();
        nodes.push(now);
    }
    vote(&nodes, &mut pieces, beams);
    for piece in &mut pieces {
        piece.decide();
    }
    order(&nodes, &mut pieces);
    let beam = |node: &Node| {
        // Of a piece that no single beam can have lit, each run stands for itself.
        let set = if pieces[node.piece].beams == 0 { node.beams } else { pieces[node.piece].beams };
        (set.count_ones() == 1).then(|| set.trailing_zeros() as usize)
    };
    nodes.iter().map(|column| column.iter().map(beam).collect()).collect()
}

/// Whether two runs of neighbouring columns touch, at a corner at least.
fn touch(a: &LitRun, b: &LitRun) -> bool {
    a.first <= b.last + 1 && b.first <= a.last + 1
}

/// The piece of the column before that a run continues. Where two runs meet one, none continues another: stripes may cross.
fn continued(run: &LitRun, before: &[Node], column: &[LitRun]) -> Option<usize> {
    let mut met = before.iter().filter(|node| touch(&node.run, run));
    let (Some(node), None) = (met.next(), met.next()) else { return None };
    let is_alone = column.iter().filter(|other| touch(&node.run, other)).count() == 1;
    is_alone.then_some(node.piece)
}

/// In a column with one run for each beam, the lowest is beam 0's, the next one above it beam 1's, if these beams can have lit
/// them.
fn vote(nodes: &[Vec<Node>], pieces: &mut [Piece], beams: usize) {
    for column in nodes.iter().filter(|column| column.len() == beams) {
        let ranked = || column.iter().rev().enumerate();
        if ranked().all(|(beam, node)| node.beams & 1 << beam != 0) {
            for (beam, node) in ranked() {
                let votes = &mut pieces[node.piece].votes;
                votes.resize(beams, 0);
                votes[beam] += 1;
            }
        }
    }
}

impl Piece {
    /// Gives the piece to the beam for which most of the votes are, of those that can have lit it.
    fn decide(&mut self) {
        let of = |beam: usize| self.votes.get(beam).copied().unwrap_or(0);
        let allowed = (0..self.votes.len()).filter(|beam| self.beams & 1 << beam != 0);
        let all: u32 = allowed.clone().map(of).sum();
        if let Some(beam) = allowed.max_by_key(|&beam| of(beam)).filter(|&beam| 2 * of(beam) > all) {
            self.beams = 1 << beam;
        }
    }
}

/// Above a run of a beam lie runs of this beam and of those after it, below it of this one and of those before it. Repeated
/// until nothing changes: each change takes a beam from a piece.
fn order(nodes: &[Vec<Node>], pieces: &mut [Piece]) {
    loop {
        let mut changed = false;
        for column in nodes {
            for (at, node) in column.iter().enumerate() {
                let set = pieces[node.piece].beams;
                if set.count_ones() != 1 {
                    continue;
                }
                let not_before = set.wrapping_neg();
                let not_after = set | (set - 1);
                for (place, other) in column.iter().enumerate() {
                    let allowed = if place < at { not_before } else { not_after };
                    let piece = &mut pieces[other.piece];
                    // What no beam can have lit by the order is no matter of the order.
                    if place != at && piece.beams.count_ones() > 1 && piece.beams & allowed != 0 {
                        changed |= piece.beams & allowed != piece.beams;
                        piece.beams &= allowed;
                    }
                }
            }
        }
        if !changed {
            return;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run(i: u32, first: u32) -> LitRun {
        let last = first + 1;
        LitRun { first, last, edge: EdgePoint { i, j: last, row: f64::from(last) + 0.5 } }
    }

    /// Columns with runs of two rows that begin at these rows, from the top.
    fn columns(rows: &[&[u32]]) -> Vec<Vec<LitRun>> {
        (0..).zip(rows).map(|(i, rows)| rows.iter().map(|&first| run(i, first)).collect()).collect()
    }

    /// The beams of the runs. Below row 50 only beam 0 can light, down to row 100; above it both can.
    fn beams(rows: &[&[u32]]) -> Vec<Vec<Option<usize>>> {
        beams_of_runs(&columns(rows), 2, |edge, beam| edge.row < if beam == 0 { 100.0 } else { 50.0 })
    }

    const NEAR: Option<usize> = Some(0);
    const FAR: Option<usize> = Some(1);

    #[test]
    fn a_column_with_one_stripe_is_kept_and_goes_to_its_sheet() {
        // The near stripe ends after column 1 and begins again in column 3; the far one ends after column 2.
        let found = beams(&[&[20, 70], &[21, 71], &[22], &[70], &[71]]);
        assert_eq!(found, [vec![FAR, NEAR], vec![FAR, NEAR], vec![FAR], vec![NEAR], vec![NEAR]]);
    }

    #[test]
    fn two_runs_of_one_sheet_are_not_given_to_two() {
        // Both runs of columns 2 and 3 lie where only beam 0 lights: a stone and the ground behind it. Its ground stripe goes
        // on from column 1. By their number the upper ones would be beam 1's.
        let found = beams(&[&[20, 80], &[20, 80], &[60, 80], &[60, 80]]);
        assert_eq!(found[2..], [vec![NEAR, NEAR], vec![NEAR, NEAR]]);
    }

    #[test]
    fn above_the_far_stripe_is_only_the_far_sheet() {
        // Column 2 has three runs: over a far stripe that is known from its neighbours nothing of beam 0 lies.
        let found = beams(&[&[30, 80], &[30, 80], &[10, 30, 80]]);
        assert_eq!(found[2], [FAR, FAR, NEAR]);
        // Between the stripes it may be either.
        assert_eq!(beams(&[&[20, 80], &[20, 80], &[20, 40, 80]])[2], [FAR, None, NEAR]);
    }

    #[test]
    fn what_either_sheet_may_have_lit_is_ambiguous() {
        assert_eq!(beams(&[&[20], &[21], &[]]), [vec![None], vec![None], vec![]]);
        // A run that none can have lit belongs to none.
        assert_eq!(beams(&[&[120]]), [vec![None]]);
    }

    #[test]
    fn where_two_stripes_meet_neither_goes_on_as_the_other() {
        // A run of the near stripe grows until it touches the far one's row: from there on it may be either's.
        let grown = LitRun { first: 20, last: 71, edge: EdgePoint { i: 2, j: 71, row: 71.5 } };
        let mut all = columns(&[&[20, 70], &[20, 70]]);
        all.push(vec![grown]);
        let found = beams_of_runs(&all, 2, |edge, beam| edge.row < if beam == 0 { 100.0 } else { 50.0 });
        assert_eq!(found[2], [NEAR]);
        assert_eq!(found[1], [FAR, NEAR]);
    }
}
