//! Equal boxes of faces, found by a table of their bits.

use obvhs::aabb::Aabb;

/// Places of the table that are tried for a box. In a table that is half full hardly any box needs a dozen. A repetition
/// that is not found has an entry of its own, so that no choice of boxes makes the search slow.
const MAX_PLACES_TRIED: usize = 64;

/// Some boxes without repetitions, in the order in which they come first.
pub(crate) struct Distinct {
    pub(crate) boxes: Vec<Aabb>,
    /// Where the k-th box was among those given, in that order: `members[first_member[k]..first_member[k + 1]]`.
    members: Vec<u32>,
    first_member: Vec<u32>,
}

impl Distinct {
    /// The different ones of `boxes`.
    pub(crate) fn of(boxes: Vec<Aabb>) -> Self {
        const FREE: u32 = u32::MAX;
        let places = (2 * boxes.len()).next_power_of_two();
        let mut table = vec![FREE; places];
        // For each box the first one that equals it.
        let mut leaders: Vec<u32> = Vec::with_capacity(boxes.len());
        for (at, bounds) in boxes.iter().enumerate() {
            let start = (hash(bounds) >> 32) as usize;
            let mut leader = at as u32;
            for place in (start..start + MAX_PLACES_TRIED).map(|place| place & (places - 1)) {
                let other = table[place];
                if other == FREE {
                    table[place] = leader;
                    break;
                }
                if bits(&boxes[other as usize]) == bits(bounds) {
                    leader = other;
                    break;
                }
            }
            leaders.push(leader);
        }
        if leaders.iter().enumerate().all(|(at, leader)| *leader == at as u32) {
            let first_member = (0..=boxes.len() as u32).collect();
            return Self { boxes, members: leaders, first_member };
        }
        let mut members: Vec<u32> = (0..boxes.len() as u32).collect();
        // The sort is stable: members of one box stay in their order.
        members.sort_by_key(|&at| leaders[at as usize]);
        let is_first =
            |&at: &usize| at == 0 || leaders[members[at] as usize] != leaders[members[at - 1] as usize];
        let mut first_member: Vec<u32> = (0..members.len()).filter(is_first).map(|at| at as u32).collect();
        let boxes = first_member.iter().map(|&at| boxes[members[at as usize] as usize]).collect();
        first_member.push(members.len() as u32);
        Self { boxes, members, first_member }
    }

    /// Where the k-th box was among those given.
    pub(crate) fn members(&self, k: usize) -> &[u32] {
        &self.members[self.first_member[k] as usize..self.first_member[k + 1] as usize]
    }
}

fn bits(bounds: &Aabb) -> [u32; 6] {
    let Aabb { min, max } = bounds;
    [min.x, min.y, min.z, max.x, max.y, max.z].map(f32::to_bits)
}

/// A hash of a box's bits, by the finaliser of SplitMix64 (Steele, Lea, Flood 2014).
fn hash(bounds: &Aabb) -> u64 {
    let [a, b, c, d, e, f] = bits(bounds).map(u64::from);
    let mixed = |z: u64| {
        let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    };
    mixed(mixed(mixed(a << 32 | b) ^ (c << 32 | d)) ^ (e << 32 | f))
}

#[cfg(test)]
#[path = "../tests/unit/distinct.rs"]
mod tests;
