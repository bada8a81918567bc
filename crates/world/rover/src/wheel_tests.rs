//! Traversability of a point, mended: the ground under wheels and belly instead of seven points.
//!
//! The printed tests look at the points below the wheels' centres and at one point under the belly. A rock between the
//! centre line and a wheel's track meets none of them, and a wheel touches an edge a good part of its radius before its
//! centre is there. Here each wheel is a disc over its width that rests on the highest of the measured points below it,
//! and the belly is a surface. Slopes are those between the wheels' centres, with the limits of the printed tests.
//!
//! *Obstacle* is said only by measured points, beyond their errors. *Clear* needs every cell under the vehicle to be
//! measured, or to be a gap that [`GapRule`](crate::GapRule) lets pass with its highest possible ground, and slopes that
//! stay below their limits by more than the errors. All else is *unknown*.

use glam::{DVec2, DVec3};

use crate::bend::{bend_down, bend_up, top_of};
use crate::elevation_map::{ElevationMap, ElevationSource, GridPoint, is_measured};
use crate::gap::MapWithShadows;
use crate::traversability::{
    Missing, MissingReason, RISE_ROUNDING_M, Traversability, TraversabilityRules, TraversabilityTest,
    VehiclePart,
};
use crate::vehicle::Vehicle;

/// Half of the eight neighbours of a grid point: each pair of neighbours is met once.
const FORWARD_NEIGHBOURS: [(i64, i64); 4] = [(1, 0), (0, 1), (1, 1), (1, -1)];

/// Rounding of a place on a border, metres: coordinates within 1e4 m have rounding errors of 2e-12 m, and a clipped point
/// a few of these.
const BORDER_ROUNDING_M: f64 = 1e-11;

/// What is known of the ground at a grid point.
enum Known {
    /// A measured point, global, metres, and the variance of its elevation, square metres.
    Measured(DVec3, f64),
    /// Ground that was never measured, where the vehicle stood or could have turned: the plane of its wheels then, global,
    /// metres.
    Stood(DVec3),
    /// Ground at most this high, global, metres.
    AtMost(DVec3),
    Nothing(Missing),
}

/// A wheel's centre on the ground.
#[derive(Debug, Clone, Copy)]
struct Hub {
    /// Global, metres.
    height: f64,
    /// Variance of the height, square metres: the mean of the measured points below the wheel.
    variance: f64,
    /// Sum of the corrections of the vehicle's elevation until its stripes measured these points, metres, in the mean. `None`
    /// if they measured none.
    corrected: Option<f64>,
}

/// A wheel on the ground: its hub by measured points alone, by these and the ground that the vehicle stood on, and by all
/// that may be there.
struct WheelOnMap {
    measured: Option<Hub>,
    supported: Option<Hub>,
    /// The same by the means of the cells alone, without the highest point of any frame: those lie above the ground by their
    /// errors.
    lowest: Option<Hub>,
    highest: Option<Hub>,
    missing: Option<Missing>,
    /// First grid point under the wheel with ground that the vehicle stood on, and that was never measured.
    stood: Option<Missing>,
}

impl WheelOnMap {
    /// The hubs that every point of the cells' ground carries.
    fn all(&mut self) -> [&mut Option<Hub>; 4] {
        [&mut self.measured, &mut self.supported, &mut self.lowest, &mut self.highest]
    }

    /// Whether all ground under the wheel is measured or bounded.
    fn is_known(&self) -> bool {
        self.missing.is_none()
    }
}

/// The plane through the hubs of four wheels, and the underside of the body that hangs on them.
struct HubPlane {
    /// Height of its middle, global, metres.
    middle: f64,
    /// Rise along and across, over distance.
    slopes: DVec2,
    /// Of the middle of the hubs' plane above the underside, along z, metres.
    drop: f64,
    /// Variances of the hubs' heights, square metres: front left, front right, rear left, rear right.
    variances: [f64; 4],
    wheelbase: f64,
    track: f64,
}

impl HubPlane {
    /// The plane of least squares through the corners of a rectangle.
    fn through([a, b, c, d]: [Hub; 4], vehicle: &Vehicle) -> Self {
        let Vehicle { wheelbase, track, wheel_radius, clearance, .. } = *vehicle;
        let along = (a.height + b.height - c.height - d.height) / (2.0 * wheelbase);
        let across = (a.height - b.height + c.height - d.height) / (2.0 * track);
        // The underside lies `wheel_radius - clearance` below the hubs, measured square to their plane.
        let drop = (wheel_radius - clearance) * (1.0 + along * along + across * across).sqrt();
        Self {
            middle: (a.height + b.height + c.height + d.height) * 0.25,
            slopes: DVec2::new(along, across),
            drop,
            variances: [a, b, c, d].map(|hub| hub.variance),
            wheelbase,
            track,
        }
    }

    /// Height of the underside, global, metres, at a place forward and left of the middle.
    fn underside(&self, at: DVec2) -> f64 {
        self.middle - self.drop + self.slopes.dot(at)
    }

    /// Variance of that height, square metres: each hub's, times the square of its share in it.
    fn variance(&self, at: DVec2) -> f64 {
        let (along, across) = (at.x / (2.0 * self.wheelbase), at.y / (2.0 * self.track));
        let shares = [along + across, along - across, across - along, -along - across];
        shares.iter().zip(self.variances).map(|(share, v)| (0.25 + share) * (0.25 + share) * v).sum()
    }
}

/// A rectangle on the map that a part of the vehicle stands over.
struct Rectangle {
    middle: DVec2,
    forward: DVec2,
    half_length: f64,
    half_width: f64,
}

impl Rectangle {
    /// Place in the rectangle's own axes, forward and left, metres. Borders belong to it, within rounding.
    fn within(&self, place: DVec2) -> Option<DVec2> {
        let from = place - self.middle;
        let at = DVec2::new(from.dot(self.forward), from.dot(self.forward.perp()));
        let [length, width] = [self.half_length, self.half_width].map(|half| half + BORDER_ROUNDING_M);
        (at.x.abs() <= length && at.y.abs() <= width).then_some(at)
    }

    /// Points of the straight line between two points of the ground on which a wheel in this rectangle may rest: where the
    /// line enters and leaves the rectangle, and where the wheel's rim touches it between.
    fn highest_on_edge(&self, a: DVec3, b: DVec3, radius: f64) -> impl Iterator<Item = DVec3> + use<> {
        let in_axes = |point: DVec3| {
            let from = point.truncate() - self.middle;
            DVec2::new(from.dot(self.forward), from.dot(self.forward.perp()))
        };
        let (from, to) = (in_axes(a), in_axes(b));
        let along = to - from;
        // The part of the line within both pairs of sides, as shares of it.
        let (mut low, mut high) = (0.0_f64, 1.0_f64);
        for (start, way, half) in [(from.x, along.x, self.half_length), (from.y, along.y, self.half_width)] {
            if way == 0.0 {
                if start.abs() > half {
                    high = -1.0;
                }
                continue;
            }
            let (enter, leave) = ((-half - start) / way, (half - start) / way);
            low = low.max(enter.min(leave));
            high = high.min(enter.max(leave));
        }
        // z + sqrt(R^2 - x^2) is highest where dz/dx = x / sqrt(R^2 - x^2): at x = R m / sqrt(1 + m^2).
        let touch = (along.x != 0.0).then(|| {
            let slope = (b.z - a.z) / along.x;
            (radius * slope / (1.0 + slope * slope).sqrt() - from.x) / along.x
        });
        let shares = [Some(low), Some(high), touch.filter(|share| (low..=high).contains(share))];
        let inside = low <= high;
        shares.into_iter().flatten().filter(move |_| inside).map(move |share| a + (b - a) * share)
    }

    /// Grid points whose cells the rectangle may touch, or a line from their point to that of a neighbour.
    fn grid_points<'a>(&'a self, map: &'a ElevationMap) -> impl Iterator<Item = GridPoint> + use<'a> {
        let left = self.forward.perp();
        let reach = self.forward.abs() * self.half_length + left.abs() * self.half_width;
        // A measured point lies within half a cell of its grid point, and a line may come from the cell beside.
        let reach = reach + DVec2::splat(1.5 * map.size().spacing);
        let (low, high) = (map.nearest(self.middle - reach), map.nearest(self.middle + reach));
        let points = (low.j..=high.j).flat_map(move |j| (low.i..=high.i).map(move |i| GridPoint { i, j }));
        // A neighbour is up to a diagonal away, and its point half a diagonal farther.
        let margin = 1.5 * std::f64::consts::SQRT_2 * map.size().spacing + BORDER_ROUNDING_M;
        points.filter(move |point| {
            let from = map.place(*point) - self.middle;
            from.dot(self.forward).abs() <= self.half_length + margin
                && from.dot(left).abs() <= self.half_width + margin
        })
    }
}

impl TraversabilityRules {
    /// Tests the global point `front` by wheels and belly. Arguments as [`TraversabilityRules::classify`].
    ///
    /// CHOICE: wheels are upright, at the places that they have on level ground, as the paper's points are.
    ///
    /// Ground that was never measured leaves a point unknown. Only by [`StartRule::Circle`](crate::StartRule) it is taken to be
    /// the plane of the wheels, in the circle in which the vehicle could turn on the spot now or before: the rear wheels of
    /// the imaginary vehicle are there, beside the real one, when it looks to the side.
    pub(crate) fn classify_wheels(
        &self,
        shadows: &MapWithShadows,
        vehicle: &Vehicle,
        front: DVec2,
        forward: DVec2,
    ) -> Traversability {
        let Vehicle { wheelbase, track, wheel_radius, wheel_width, .. } = *vehicle;
        let (left, map) = (forward.perp(), shadows.map());
        let ground = Ground { rules: self, map, shadows };
        let wheel = |part, behind: f64, aside: f64| {
            let middle = front - forward * behind + left * aside;
            ground.wheel(
                part,
                &Rectangle { middle, forward, half_length: wheel_radius, half_width: 0.5 * wheel_width },
            )
        };
        let axle = |part, behind: f64| [0.5, -0.5].map(|side| wheel(part, behind, side * track));
        let front_wheels = axle(VehiclePart::FrontWheel, 0.0);
        let rear_wheels = axle(VehiclePart::RearWheel, wheelbase);
        let [[front_left, front_right], [rear_left, rear_right]] =
            [&front_wheels, &rear_wheels].map(|[a, b]| [a, b]);
        let tests = [
            (
                TraversabilityTest::Front,
                Rises::between([front_left], [front_right]),
                self.slopes.front * track,
            ),
            (TraversabilityTest::Rear, Rises::between([rear_left], [rear_right]), self.slopes.rear * track),
            (
                TraversabilityTest::Length,
                Rises::between([front_left, front_right], [rear_left, rear_right]),
                self.slopes.length * wheelbase,
            ),
        ];
        // A rise this many standard errors higher is still above its limit.
        let exceeds = |rise: Option<Rise>, errors: f64, limit: f64| {
            rise.is_some_and(|rise| rise.height + errors * rise.standard_error > limit + RISE_ROUNDING_M)
        };
        for (test, rises, limit) in &tests {
            if exceeds(rises.certain, -self.margins.obstacle, *limit) {
                return Traversability::Obstacle(*test);
            }
        }
        let wheels = || front_wheels.iter().chain(&rear_wheels);
        if let Some(missing) = wheels().find_map(|wheel| wheel.missing) {
            return Traversability::Unknown(missing);
        }
        // The lower side may be higher than it looks: it stands partly on ground that was never measured.
        for (_, rises, limit) in &tests {
            if let Some(missing) = rises.stood
                && exceeds(rises.measured, -self.margins.obstacle, *limit)
            {
                return Traversability::Unknown(missing);
            }
        }
        // All wheels are known from here on. What may stand in gaps may still be too high, or the errors too large.
        for (test, rises, limit) in &tests {
            let by_tilt = rises.highest.map(|rise| Rise { height: rise.most(), ..rise });
            if exceeds(by_tilt, self.margins.clear, *limit) {
                let part = match test {
                    TraversabilityTest::Rear => VehiclePart::RearWheel,
                    _ => VehiclePart::FrontWheel,
                };
                let by_gaps = exceeds(rises.highest, 0.0, *limit) && !exceeds(rises.measured, 0.0, *limit);
                let reason = if by_gaps { MissingReason::MayHide } else { MissingReason::NearLimit };
                return Traversability::Unknown(Missing { part, place: front, reason });
            }
        }

        // Through the wheels where they may stand highest, as measured, and where they may stand lowest. A wheel over bridged
        // ground alone has its highest place only.
        let planes = |part: fn(&WheelOnMap) -> Option<Hub>| -> Option<HubPlane> {
            let hubs = [front_left, front_right, rear_left, rear_right].map(part);
            let [Some(a), Some(b), Some(c), Some(d)] = hubs else { return None };
            Some(HubPlane::through([a, b, c, d], vehicle))
        };
        let as_measured = planes(|wheel| wheel.measured.or(wheel.highest));
        let at_least = planes(|wheel| wheel.lowest.or(wheel.highest));
        let (Some(highest), Some(measured), Some(lowest)) =
            (planes(|wheel| wheel.highest), as_measured, at_least)
        else {
            return Traversability::Unknown(Missing {
                part: VehiclePart::FrontWheel,
                place: front,
                reason: MissingReason::NotMeasured,
            });
        };
        let belly = Rectangle {
            middle: front - forward * (0.5 * wheelbase),
            forward,
            half_length: 0.5 * wheelbase,
            half_width: 0.5 * (track - wheel_width).max(0.0),
        };
        let mut missing = None;
        for point in belly.grid_points(map) {
            match ground.under_belly(point) {
                Known::Measured(sample, variance) => {
                    // Points within the rectangle are enough: the belly is far wider than a cell.
                    let top = map.cell(point).top.map(|top| (top.point, map.top_variance(&top)));
                    for (sample, variance) in [Some((sample, variance)), top].into_iter().flatten() {
                        let Some(at) = belly.within(sample.truncate()) else { continue };
                        let reaches = |plane: &HubPlane, errors: f64| {
                            let error = (variance + plane.variance(at)).sqrt();
                            sample.z + errors * error >= plane.underside(at)
                        };
                        // The belly hangs on the wheels: an obstacle is higher than it can hang, and what is clear is lower than
                        // it may hang.
                        if reaches(&highest, -self.margins.obstacle) {
                            return Traversability::Obstacle(TraversabilityTest::Belly);
                        }
                        if missing.is_none() && reaches(&lowest, self.margins.clear) {
                            let by_gaps = reaches(&lowest, 0.0) && !reaches(&measured, 0.0);
                            let reason =
                                if by_gaps { MissingReason::MayHide } else { MissingReason::NearLimit };
                            let (part, place) = (VehiclePart::Belly, sample.truncate());
                            missing = Some(Missing { part, place, reason });
                        }
                    }
                }
                Known::Stood(top) | Known::AtMost(top) => {
                    if belly.within(top.truncate()).is_some_and(|at| top.z >= lowest.underside(at)) {
                        let (part, place) = (VehiclePart::Belly, top.truncate());
                        missing = missing.or(Some(Missing { part, place, reason: MissingReason::MayHide }));
                    }
                }
                Known::Nothing(reason) => {
                    if belly.within(reason.place).is_some() {
                        missing = missing.or(Some(reason));
                    }
                }
            }
        }
        missing.map_or(Traversability::Clear, Traversability::Unknown)
    }
}

/// The ground as the map knows it.
struct Ground<'a> {
    rules: &'a TraversabilityRules,
    map: &'a ElevationMap,
    shadows: &'a MapWithShadows<'a>,
}

impl Ground<'_> {
    /// A wheel at rest in its rectangle.
    fn wheel(&self, part: VehiclePart, rectangle: &Rectangle) -> WheelOnMap {
        let mut wheel = WheelOnMap {
            measured: None,
            supported: None,
            lowest: None,
            highest: None,
            missing: None,
            stood: None,
        };
        let radius = rectangle.half_length;
        let rest_on = |point: DVec3, variance: f64, kept: &mut Option<Hub>| {
            let Some(at) = rectangle.within(point.truncate()) else { return };
            let height = point.z + (radius * radius - at.x * at.x).max(0.0).sqrt();
            if kept.is_none_or(|kept| height > kept.height) {
                *kept = Some(Hub { height, variance, corrected: None });
            }
        };
        let (mut inside, mut corrected) = ((0.0, 0_u32), (0.0, 0_u32));
        for point in rectangle.grid_points(self.map) {
            match self.under_wheel(part, point) {
                Known::Measured(sample, variance) => {
                    for hub in wheel.all() {
                        rest_on(sample, variance, hub);
                    }
                    if rectangle.within(sample.truncate()).is_some() {
                        inside = (inside.0 + variance, inside.1 + 1);
                        let cell = self.map.cell(point);
                        if cell.source == ElevationSource::Measured {
                            corrected = (corrected.0 + cell.corrected, corrected.1 + 1);
                        }
                    }
                    // The mean of several frames is lower than what stands in the cell.
                    if let Some(top) = self.map.cell(point).top {
                        let variance = self.map.top_variance(&top);
                        for hub in [&mut wheel.measured, &mut wheel.supported, &mut wheel.highest] {
                            rest_on(top.point, variance, hub);
                        }
                    }
                    // Between neighbouring points the ground is taken to be straight.
                    for (i, j) in FORWARD_NEIGHBOURS {
                        let beside = GridPoint { i: point.i + i, j: point.j + j };
                        if !is_measured(self.map, beside) {
                            continue;
                        }
                        let Some(other) = self.map.sample(beside) else { continue };
                        let variance = variance.max(self.variance(beside));
                        let rest_on_line = |a: DVec3, b: DVec3, hubs: &mut [&mut Option<Hub>]| {
                            for on_edge in rectangle.highest_on_edge(a, b, radius) {
                                for hub in hubs.iter_mut() {
                                    rest_on(on_edge, variance, hub);
                                }
                            }
                        };
                        // A line below the rim of all hubs so far carries none of them.
                        let lifts = |kept: &Option<Hub>, top: f64| {
                            kept.is_none_or(|kept| top + radius > kept.height - BORDER_ROUNDING_M)
                        };
                        let top = sample.z.max(other.z);
                        let WheelOnMap { measured, supported, lowest, highest, .. } = &mut wheel;
                        if [&measured, &supported, &highest].into_iter().any(|kept| lifts(kept, top)) {
                            rest_on_line(sample, other, &mut [measured, supported, highest]);
                        }
                        // Or it bends down, and the wheel stands lower.
                        if lifts(lowest, top) {
                            let bend = bend_down(self.map, point, beside, (i, j)).unwrap_or(other);
                            rest_on_line(sample, bend, &mut [lowest]);
                            rest_on_line(bend, other, &mut [lowest]);
                        }
                        // Or up, and the wheel may stand higher: at most by 45 degrees.
                        let (Some(near), Some(far)) = (top_of(self.map, point), top_of(self.map, beside))
                        else {
                            continue;
                        };
                        let top = near.z.max(far.z) + (far - near).truncate().length();
                        if lifts(highest, top)
                            && let Some(bend) = bend_up(self.map, point, beside, (i, j))
                        {
                            rest_on_line(near, bend, &mut [highest]);
                            rest_on_line(far, bend, &mut [highest]);
                        }
                    }
                }
                Known::Stood(top) => {
                    rest_on(top, 0.0, &mut wheel.supported);
                    rest_on(top, 0.0, &mut wheel.lowest);
                    rest_on(top, 0.0, &mut wheel.highest);
                    if rectangle.within(top.truncate()).is_some() {
                        let (place, reason) = (top.truncate(), MissingReason::NotMeasured);
                        wheel.stood = wheel.stood.or(Some(Missing { part, place, reason }));
                    }
                }
                Known::AtMost(top) => rest_on(top, 0.0, &mut wheel.highest),
                Known::Nothing(missing) => {
                    if rectangle.within(missing.place).is_some() {
                        wheel.missing = wheel.missing.or(Some(missing));
                    }
                }
            }
        }
        // Which of several points carries the wheel can be a matter of rounding, and must not decide the variance.
        if inside.1 > 0 {
            let variance = inside.0 / f64::from(inside.1);
            let corrected = (corrected.1 > 0).then(|| corrected.0 / f64::from(corrected.1));
            for hub in wheel.all().into_iter().flatten() {
                (hub.variance, hub.corrected) = (variance, corrected);
            }
        }
        wheel
    }

    /// Variance of a measured elevation now, square metres. CHOICE: what the proximity sensor measured has none.
    fn variance(&self, point: GridPoint) -> f64 {
        let cell = self.map.cell(point);
        match cell.source {
            ElevationSource::Measured => cell.variance + self.map.ageing_variance(cell),
            _ => 0.0,
        }
    }

    fn under_wheel(&self, part: VehiclePart, point: GridPoint) -> Known {
        self.at(part, point, || match self.rules.gaps {
            Some(gaps) => gaps.upper_estimate(self.shadows, point),
            // Without the rule, a guess counts as ground, as printed.
            None => self.map.elevation(point),
        })
    }

    /// Under the belly a gap may be of any width, if nothing high can hide in it: no wheel sinks into it.
    fn under_belly(&self, point: GridPoint) -> Known {
        self.at(VehiclePart::Belly, point, || match self.rules.gaps {
            Some(gaps) => self.shadows.ceiling(point).or_else(|| gaps.upper_estimate(self.shadows, point)),
            None => self.map.elevation(point),
        })
    }

    fn at(&self, part: VehiclePart, point: GridPoint, upper: impl Fn() -> Option<f64>) -> Known {
        let map = self.map;
        if is_measured(map, point)
            && let Some(sample) = map.sample(point)
        {
            return Known::Measured(sample, self.variance(point));
        }
        let place = map.place(point);
        if let Some(z) = map.cell(point).stood {
            return Known::Stood(place.extend(z));
        }
        if let Some(top) = upper() {
            return Known::AtMost(place.extend(top));
        }
        let reason = if map.contains(point) { MissingReason::NotMeasured } else { MissingReason::BeyondMap };
        Known::Nothing(Missing { part, place, reason })
    }
}

/// Height of one side of the vehicle above the other, metres, and its standard error.
#[derive(Debug, Clone, Copy)]
struct Rise {
    height: f64,
    standard_error: f64,
    /// So much higher it would be without the corrections of the vehicle's elevation between the measurements of both sides.
    by_tilt: f64,
}

impl Rise {
    /// The same, of the other side above this one.
    fn reversed(self) -> Self {
        Self { height: -self.height, by_tilt: -self.by_tilt, ..self }
    }

    /// The same, of the higher side above the lower one.
    fn upwards(self) -> Self {
        if self.height < 0.0 { self.reversed() } else { self }
    }

    /// Height by tilt or by the ground, whichever is higher: they disagree by the corrections, and either may be right.
    fn most(self) -> f64 {
        self.height + self.by_tilt.max(0.0)
    }
}

/// Rise between two sides of the vehicle: the wheels of an axle, one each, or both axles.
struct Rises {
    /// By measured points. `None` if ground under the lower side is not known.
    measured: Option<Rise>,
    /// The same with the lower side also on ground that the vehicle stood on and did not measure. A wheel with measured
    /// points under an end of its rim alone would seem up to a radius too low.
    certain: Option<Rise>,
    /// Where the lower side stands on such ground.
    stood: Option<Missing>,
    /// The larger rise that may be there: one side with all that may stand under it, the other without.
    highest: Option<Rise>,
}

impl Rises {
    fn between<const N: usize>(a: [&WheelOnMap; N], b: [&WheelOnMap; N]) -> Self {
        type Part = fn(&WheelOnMap) -> Option<Hub>;
        let middle = |wheels: [&WheelOnMap; N], part: Part| {
            let mut mean = Hub { height: 0.0, variance: 0.0, corrected: Some(0.0) };
            for wheel in wheels {
                let hub = part(wheel)?;
                mean.height += hub.height / N as f64;
                mean.variance += hub.variance / (N * N) as f64;
                mean.corrected =
                    mean.corrected.zip(hub.corrected).map(|(mean, corrected)| mean + corrected / N as f64);
            }
            Some(mean)
        };
        let rise = |of_a: Part, of_b: Part| {
            let (a, b) = (middle(a, of_a)?, middle(b, of_b)?);
            // By tilt alone, as the vehicle was before its corrections, the rise would be higher by this.
            let by_tilt = b.corrected.zip(a.corrected).map_or(0.0, |(b, a)| b - a);
            Some(Rise {
                height: a.height - b.height,
                standard_error: (a.variance + b.variance).sqrt(),
                by_tilt,
            })
        };
        let (measured, supported): (Part, Part) = (|wheel| wheel.measured, |wheel| wheel.supported);
        let (highest, lowest): (Part, Part) = (|wheel| wheel.highest, |wheel| wheel.lowest);
        let is_known = |wheels: [&WheelOnMap; N]| wheels.iter().all(|wheel| wheel.is_known());
        let by_measured =
            rise(measured, measured).filter(|rise| is_known(if rise.height > 0.0 { b } else { a }));
        let a_is_higher = by_measured.is_some_and(|rise| rise.height > 0.0);
        // Below 0 the lower side may be the higher one.
        let certain = by_measured.and_then(|_| match a_is_higher {
            true => rise(measured, supported),
            false => rise(supported, measured).map(Rise::reversed),
        });
        let lower = if a_is_higher { b } else { a };
        Self {
            measured: by_measured.map(Rise::upwards),
            certain,
            stood: lower.iter().find_map(|wheel| wheel.stood),
            highest: [rise(highest, lowest), rise(lowest, highest).map(Rise::reversed)]
                .into_iter()
                .flatten()
                .reduce(|a, b| if b.most() > a.most() { b } else { a })
                .or_else(|| rise(highest, highest).map(Rise::upwards)),
        }
    }
}
