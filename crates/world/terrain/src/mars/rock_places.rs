//! Places of rocks: some anywhere, some in clusters about larger rocks.

use std::collections::BTreeMap;

use glam::DVec2;

use crate::random_stream::{RandomStream, StreamPurpose};

/// Place and size of a rock.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct RockSite {
    pub place: DVec2,
    pub diameter: f64,
}

/// Share of the rocks that lie in clusters, once there are rocks for the centres. CHOICE.
const CLUSTERED_SHARE: f64 = 0.6;

/// Centres of clusters per square metre: the largest rocks. CHOICE.
const CENTRES_PER_M2: f64 = 0.04;

/// Mean distance from the side of the rock in the centre of a cluster: metres, and diameters of that rock. CHOICE.
const CLUSTER_RADIUS_M: f64 = 0.5;
const CLUSTER_RADIUS_DIAMETERS: f64 = 0.75;

/// Places for rocks of these diameters (in descending order) on the square of side `extent` about `middle`,
/// wherever `is_free` allows a rock of that diameter.
///
/// CHOICE: the law does not give places. The largest rocks lie anywhere. Of the others [`CLUSTERED_SHARE`] lie about one
/// of these, as pieces of a broken block or of one impact do. A rock avoids earlier rocks if one of its first
/// tries finds a clear place; otherwise it overlaps them. The number of rocks does not depend on this.
pub(super) fn place_rocks(
    diameters: &[f64],
    middle: DVec2,
    extent: f64,
    seed: u64,
    is_free: impl Fn(DVec2, f64) -> bool,
) -> Vec<RockSite> {
    const MAX_TRIES_PER_ROCK: usize = 24;
    let mut random = RandomStream::new(seed, StreamPurpose::RockPlaces);
    let centres = (CENTRES_PER_M2 * extent * extent).ceil().max(1.0) as usize;
    // Cells as large as the largest rock: two rocks that touch lie in the same cell or in neighbouring cells.
    let cell = diameters.first().copied().unwrap_or(1.0);
    let cell_of = |place: DVec2| ((place - middle) / cell).floor().to_array().map(|index| index as i64);
    let mut sites: Vec<RockSite> = Vec::with_capacity(diameters.len());
    let mut taken: BTreeMap<[i64; 2], Vec<u32>> = BTreeMap::new();
    for &diameter in diameters {
        let mut chosen = None;
        let clustered = random.uniform() < CLUSTERED_SHARE && sites.len() >= centres;
        let parent = clustered.then(|| sites[random.index_below(centres)]);
        for _ in 0..MAX_TRIES_PER_ROCK {
            let place = match parent {
                Some(parent) => about(&parent, &mut random),
                None => {
                    let half = 0.5 * extent;
                    middle + DVec2::new(random.between(-half, half), random.between(-half, half))
                }
            };
            if !is_free(place, diameter) {
                continue;
            }
            chosen = Some(place);
            let [i, j] = cell_of(place);
            let near = (i - 1..=i + 1).flat_map(|i| (j - 1..=j + 1).map(move |j| [i, j]));
            let clear = near.filter_map(|cell| taken.get(&cell)).flatten().all(|&other| {
                let other = sites[other as usize];
                place.distance(other.place) > 0.5 * (diameter + other.diameter)
            });
            if clear {
                break;
            }
        }
        // A ground that is nowhere free (all start area or crevasse) gets no rock.
        let Some(place) = chosen else { continue };
        taken.entry(cell_of(place)).or_default().push(sites.len() as u32);
        sites.push(RockSite { place, diameter });
    }
    sites
}

/// A place about the rock in the centre of a cluster.
fn about(parent: &RockSite, random: &mut RandomStream) -> DVec2 {
    let mean = CLUSTER_RADIUS_M + CLUSTER_RADIUS_DIAMETERS * parent.diameter;
    let distance = 0.5 * parent.diameter + mean * random.exponential();
    let (sin, cos) = libm::sincos(random.between(0.0, std::f64::consts::TAU));
    parent.place + DVec2::new(cos, sin) * distance
}

#[cfg(test)]
#[path = "../../tests/unit/mars/rock_places.rs"]
mod tests;
