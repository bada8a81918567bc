//! How far a surface hides a piece of a border, told in intervals alone.
//!
//! A face that is met before a piece hides it up to where the piece leaves the face's picture. Behind that edge lies the
//! picture of the next face, with the same t along the edge, if the two continue one another there. So the surface is
//! followed from face to face, as long as these are certain at each edge that the piece leaves through:
//!
//! * the piece's line passes between the two vertices of the edge,
//! * the place is before the far end of the piece,
//! * the edge is met there before the piece, and not before the start of the ray.
//!
//! t is linear on the piece and on each face, so what holds at both ends of the way through a face holds between them.
//! Where something is not certain the walk ends, and exact arithmetic goes on from the last face. So the walk changes
//! no margin: it only finds sooner what is hidden.

use std::cmp::Ordering;

use raypencil_scene::FaceId;

use super::flat::FlatFace;
use super::frame::FrameNumbers;
use super::segment::{AtPlace, Piece, Segment};
use crate::numbers::number::{Interval, Number};

/// A face of the surface, in the frame.
pub(super) struct WalkedFace {
    pub(super) face: FaceId,
    pub(super) flat: FlatFace<Interval>,
}

/// How far a surface certainly hides a piece.
pub(super) enum Hidden {
    /// Up to the far end of the piece.
    Wholly,
    /// Up to where this face ends; and about where the piece enters it, as a part of the segment.
    UpToTheEndOf(FaceId, f64),
}

impl Piece {
    /// Follows the surface from a face that is met before this piece just behind the piece's near end. `behind` gives
    /// the face that continues another behind the edge from a corner of the flat face.
    pub(super) fn hidden_by_surface(
        &self,
        first: WalkedFace,
        segment: &Segment<Interval>,
        numbers: &FrameNumbers<Interval>,
        behind: impl Fn(FaceId, usize) -> Option<WalkedFace>,
    ) -> Hidden {
        let mut here = first;
        let mut entered = self.near.middle();
        loop {
            if self.ends_hidden_by(&here.flat, segment, numbers) {
                return Hidden::Wholly;
            }
            let next = self
                .certain_exit(&here.flat, segment, numbers)
                .and_then(|(k, place)| Some((behind(here.face, k)?, place)));
            match next {
                Some((face, place)) => (here, entered) = (face, place),
                None => return Hidden::UpToTheEndOf(here.face, entered),
            }
        }
    }

    /// Whether the far end is certainly within the face's picture and met after it.
    fn ends_hidden_by(
        &self,
        face: &FlatFace<Interval>,
        segment: &Segment<Interval>,
        numbers: &FrameNumbers<Interval>,
    ) -> bool {
        let sign = |values: [Interval; 2]| Interval::at(&self.far, &values).sign();
        let is_not_negative =
            |sign: Option<Ordering>| matches!(sign, Some(Ordering::Greater | Ordering::Equal));
        (0..3).all(|k| is_not_negative(sign(segment.edge_values(face, k))))
            && matches!(sign(segment.behind(face)), Some(Ordering::Less | Ordering::Equal))
            && is_not_negative(sign(segment.values(&face.not_before(&numbers.from))))
    }

    /// The edge through which the piece certainly leaves a face's picture, behind it all the way, and about where.
    fn certain_exit(
        &self,
        face: &FlatFace<Interval>,
        segment: &Segment<Interval>,
        numbers: &FrameNumbers<Interval>,
    ) -> Option<(usize, f64)> {
        // Positive to the left of the way.
        let beside = face.corners.each_ref().map(|corner| {
            let left = segment.to_the_left(corner);
            if self.is_forward() { left } else { left.negated() }
        });
        // The picture's corners go counter-clockwise, so a way out passes from the left of an edge to its right.
        let exits = |k: usize| {
            beside[k].sign() == Some(Ordering::Less) && beside[(k + 1) % 3].sign() == Some(Ordering::Greater)
        };
        let k = (0..3).find(|&k| exits(k))?;
        let values = segment.edge_values(face, k);
        if Interval::at(&self.far, &values).sign() != Some(Ordering::Less) {
            return None;
        }
        let [on_right, on_left] = [beside[k].negated(), beside[(k + 1) % 3]];
        let between = |from: &Interval, to: &Interval, part: &Interval| from.add(&to.sub(from).mul(part));
        let t_of = |k: usize| &face.corners[k % 3].0[2];
        let t_of_edge = between(t_of(k), t_of(k + 1), &on_right.over(on_right.add(&on_left)));
        let place = values[0].over(values[0].sub(&values[1]));
        let t_of_piece = between(&segment.ends[0][2], &segment.ends[1][2], &place);
        let is_before = t_of_edge.mul(&segment.divisor).sub(&t_of_piece).sign() == Some(Ordering::Less);
        let is_after_start =
            matches!(t_of_edge.sub(&numbers.from).sign(), Some(Ordering::Greater | Ordering::Equal));
        (is_before && is_after_start).then(|| (k, place.middle()))
    }
}
