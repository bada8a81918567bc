//! Heights that lie far from all others: constants that nobody declared as "no data", and spikes.
//!
//! The rules hold for any constant; none is known by its name. `docs/formats/terrain.md` has them in words.

use glam::DVec2;

/// How far from a constant posts may be mixtures with it, in columns and rows. Programs that resample a model mix the four to
/// sixteen posts around a place; more are mixed where it becomes finer at the same time.
const MIXED_POSTS: usize = 3;

/// A step between neighbouring posts that is steeper than this is no slope, whatever the spacing.
const MAX_SLOPE: f64 = 10.0;

/// A step of this height, metres, without a single post on its way is no cliff.
const MAX_CLIFF_M: f64 = 500.0;

/// A height that many posts share, far from all others.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Constant {
    pub height: f64,
    /// Number of its posts.
    pub count: usize,
    /// Distance to the nearest of the others, which are heights.
    pub gap: f64,
    /// Difference of the highest and the lowest of these.
    pub span: f64,
    pub is_below: bool,
}

/// Posts that stand out by more than the rest of the model is high.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spikes {
    /// Number of these posts.
    pub count: usize,
    /// Place among the posts of the one that is farthest from the rest: row by row, the southernmost first.
    pub worst: usize,
    /// How far it is above the rest, metres; negative if it is below.
    pub stands_out: f64,
    /// Difference of the highest and the lowest of the rest, metres.
    pub rest: f64,
}

/// Posts row by row; NaN where the height is not known.
#[derive(Clone, Copy)]
pub(super) struct Posts<'a> {
    pub heights: &'a [f64],
    pub columns: usize,
    /// Distances between columns and between rows, in the unit of the heights.
    pub spacing: DVec2,
    /// A metre in that unit.
    pub metre: f64,
}

impl Posts<'_> {
    /// A step in height that is no ground: more than ten times the spacing, and more than the whole model is long, or 500 m.
    fn smallest_leap(&self) -> f64 {
        let rows = self.heights.len() / self.columns;
        let sides = self.spacing * DVec2::new((self.columns - 1) as f64, (rows - 1) as f64);
        (MAX_SLOPE * self.spacing.max_element()).max(sides.length().min(MAX_CLIFF_M * self.metre))
    }

    /// The lowest and the highest of the known heights.
    fn range(&self) -> Option<[f64; 2]> {
        let known = self.heights.iter().filter(|height| !height.is_nan());
        known.fold(None, |range, &height| {
            let [low, high] = range.unwrap_or([height; 2]);
            Some([low.min(height), high.max(height)])
        })
    }

    /// A constant that can hardly be a height.
    pub fn constant(&self) -> Option<Constant> {
        let body = self.body()?;
        self.constant_outside(&body).or_else(|| self.constant_inside(&body))
    }

    /// The body of the heights; `None` if they all are too near to each other for anything to stand out.
    fn body(&self) -> Option<Body> {
        let leap = self.smallest_leap();
        let [low, high] = self.range()?;
        // Most models need no sorting: what stands out makes the whole range larger.
        if !(high - low > leap) {
            return None;
        }
        let mut sorted: Vec<f64> = self.heights.iter().copied().filter(|height| !height.is_nan()).collect();
        sorted.sort_unstable_by(f64::total_cmp);
        let half = sorted.len().div_ceil(2);
        let length = |first: usize| sorted[first + half - 1] - sorted[first];
        let first = (0..=sorted.len() - half).min_by(|&a, &b| length(a).total_cmp(&length(b)))?;
        let (mut low, mut high) = (first, first + half - 1);
        loop {
            let reach = leap.max(sorted[high] - sorted[low]);
            let below = low.checked_sub(1).map(|at| sorted[low] - sorted[at]).filter(|gap| *gap <= reach);
            let above = sorted.get(high + 1).map(|next| next - sorted[high]).filter(|gap| *gap <= reach);
            match (below, above) {
                (None, None) => break,
                (Some(gap), other) if other.is_none_or(|other| gap <= other) => low -= 1,
                _ => high += 1,
            }
        }
        Some(Body { low, high, sorted })
    }

    /// A constant by the first rule: of the posts that stand out, or of the body.
    fn constant_outside(&self, body: &Body) -> Option<Constant> {
        let [low, high] = body.range();
        let is_out = |height: f64| height < low || height > high;
        let inside = &body.sorted[body.low..=body.high];
        let outside: Vec<f64> = body.sorted.iter().copied().filter(|&height| is_out(height)).collect();
        let ((height, count), (level, of_level)) = (most_frequent(&outside)?, most_frequent(inside)?);
        let is_level = |count: usize, of: usize| 10 * count >= 9 * of;
        let constant = match (is_level(of_level, inside.len()), is_level(count, outside.len())) {
            // Two levels, as of a terrace.
            (true, true) => {
                let constant = Constant::new(height, count, inside);
                return (count >= 2 && constant.gap > MAX_CLIFF_M * self.metre).then_some(constant);
            }
            (true, false) if self.has_cell(is_out) => Constant::new(level, of_level, &outside),
            _ => Constant::new(height, count, inside),
        };
        // Ground of few heights, such as whole metres above a cliff, has others in as many posts beside each.
        let leap = self.smallest_leap();
        let near = body.sorted.iter().filter(|&&other| (other - constant.height).abs() <= leap).count();
        (constant.count >= 2 && near < 3 * constant.count).then_some(constant)
    }

    /// A constant by the second rule: of a half of the body, with mixtures by resampling around it.
    fn constant_inside(&self, body: &Body) -> Option<Constant> {
        let [low, high] = body.range();
        let half = (high - low) / 2.0;
        if !(half > self.smallest_leap()) {
            return None;
        }
        let middle = low + half;
        let sorted = &body.sorted[body.low..=body.high];
        let at = sorted.partition_point(|&height| height < middle);
        let (below, above) = sorted.split_at(at);
        let is_below = |height: f64| low <= height && height < middle;
        let is_above = |height: f64| middle <= height && height <= high;
        self.constant_of(below, above, is_below, is_above)
            .or_else(|| self.constant_of(above, below, is_above, is_below))
    }

    /// The constant of one half of the body; the other half are heights.
    fn constant_of(
        &self,
        half: &[f64],
        other: &[f64],
        is_of_half: impl Fn(f64) -> bool,
        is_of_other: impl Fn(f64) -> bool,
    ) -> Option<Constant> {
        let (height, count) = most_frequent(half)?;
        let is_constant =
            count >= 2 && self.others_are_near(height, is_of_half) && self.has_cell(is_of_other);
        is_constant.then(|| Constant::new(height, count, other))
    }

    /// Whether each post of the half has a post of this height near it.
    fn others_are_near(&self, height: f64, is_of_half: impl Fn(f64) -> bool) -> bool {
        let rows = self.heights.len() / self.columns;
        let around =
            |at: usize, count: usize| at.saturating_sub(MIXED_POSTS)..(at + MIXED_POSTS + 1).min(count);
        self.heights.iter().enumerate().all(|(at, &other)| {
            let (column, row) = (at % self.columns, at / self.columns);
            !is_of_half(other)
                || other == height
                || around(row, rows).any(|row| {
                    around(column, self.columns)
                        .any(|column| self.heights[row * self.columns + column] == height)
                })
        })
    }

    /// Whether the four posts around a cell are all of a kind.
    fn has_cell(&self, is_of_kind: impl Fn(f64) -> bool) -> bool {
        let pairs =
            |row: &[f64]| row.windows(2).map(|pair| pair.iter().all(|&one| is_of_kind(one))).collect();
        let mut rows = self.heights.chunks_exact(self.columns).map(pairs);
        let mut before: Vec<bool> = rows.next().unwrap_or_default();
        rows.any(|row: Vec<bool>| {
            let found = row.iter().zip(&before).any(|(above, below)| *above && *below);
            before = row;
            found
        })
    }

    /// Posts that stand out.
    pub fn spikes(&self) -> Option<Spikes> {
        let body = self.body()?;
        let [low, high] = body.range();
        let above = |height: f64| if height < low { height - low } else { (height - high).max(0.0) };
        let known = self.heights.iter().enumerate().filter(|(_, height)| !height.is_nan());
        let (worst, stands_out) = known
            .map(|(at, &height)| (at, above(height)))
            .fold((0, 0.0_f64), |worst, post| if post.1.abs() > worst.1.abs() { post } else { worst });
        let count = body.sorted.len() - (body.high - body.low + 1);
        (count > 0).then_some(Spikes { count, worst, stands_out, rest: high - low })
    }
}

/// What most posts have in common: the shortest run of the sorted heights that holds half of them. The next height below or
/// above belongs to it as well while the gap to it is no larger than the body is high, or than a step of ground.
struct Body {
    /// All known heights.
    sorted: Vec<f64>,
    /// Its first and its last.
    low: usize,
    high: usize,
}

impl Body {
    fn range(&self) -> [f64; 2] {
        [self.sorted[self.low], self.sorted[self.high]]
    }
}

impl Constant {
    /// A constant far from these heights, which are sorted; from those on the side where most of them are.
    fn new(height: f64, count: usize, others: &[f64]) -> Self {
        let (below, above) = others.split_at(others.partition_point(|&other| other < height));
        let is_below = below.len() <= above.len();
        let others = if is_below { above } else { below };
        let (low, high) = match others {
            [low, .., high] => (*low, *high),
            [one] => (*one, *one),
            [] => (height, height),
        };
        let gap = if is_below { low - height } else { height - high };
        Self { height, count, gap, span: high - low, is_below }
    }
}

/// The height that most of some sorted heights share, the lowest of several, with its number.
fn most_frequent(sorted: &[f64]) -> Option<(f64, usize)> {
    let runs = sorted.chunk_by(|a, b| a == b).map(|run| (run[0], run.len()));
    runs.reduce(|best, run| if run.1 > best.1 { run } else { best })
}

#[cfg(test)]
#[path = "../../tests/unit/outliers.rs"]
mod tests;
