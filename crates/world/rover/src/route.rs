//! The commanded route: waypoints, speed, and the pose of the vehicle in each frame.

use glam::DVec2;
use raypencil_scene::{SceneError, check_range};

/// A route of straight legs from a start over waypoints.
///
/// CHOICE: the vehicle turns on the spot at a waypoint; the paper does not describe steering. The route ignores the
/// maps: in the paper's samples "the vehicle was forced to travel its path regardless of unknown
/// areas and obstacles" (§8).
#[derive(Debug, Clone, PartialEq)]
pub struct Route {
    /// Start, global x and y, metres.
    pub start: DVec2,
    /// Heading at the start, radians to the left of the global x axis.
    pub heading: f64,
    /// Waypoints in order, global x and y, metres.
    pub waypoints: Vec<DVec2>,
    /// Speed along a leg, metres per second.
    pub speed: f64,
    /// Rate of a turn on the spot, radians per second.
    pub turn_rate: f64,
    /// Camera frames per second. The paper's: 10, "every tenth of a second" (§7).
    pub frame_rate: f64,
}

/// Commanded pose of the vehicle in one frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RoutePose {
    /// Centre of the vehicle, global x and y, metres.
    pub place: DVec2,
    /// Heading, radians to the left of the global x axis.
    pub heading: f64,
    /// Distance driven since the start, metres.
    pub driven: f64,
}

impl Route {
    /// A route at 0.3 m/s, 0.3 rad/s and 10 frames per second. The heading at the start points to the first waypoint.
    ///
    /// CHOICE: at 0.3 m/s the stripes on level ground move by 3 cm per frame, so that each grid spacing of 0.1 m is
    /// measured three times.
    pub fn through(start: DVec2, waypoints: Vec<DVec2>) -> Self {
        let heading = waypoints.first().map_or(0.0, |&first| direction(first - start).unwrap_or(0.0));
        Self { start, heading, waypoints, speed: 0.3, turn_rate: 0.3, frame_rate: 10.0 }
    }

    /// Pose in frame `index`. `None` after the last frame, which is at the last waypoint. The pose is computed from the
    /// index alone, so that no error adds up.
    ///
    /// ```
    /// use glam::DVec2;
    /// use raypencil_rover::Route;
    ///
    /// // 3 m at 0.3 m/s take 10 s: at 10 frames per second, frame 50 is half way and frame 100 is the last.
    /// let route = Route::through(DVec2::ZERO, vec![DVec2::new(3.0, 0.0)]);
    /// assert!((route.frame(50).unwrap().driven - 1.5).abs() < 1e-12);
    /// assert_eq!(route.frame(100).unwrap().place, DVec2::new(3.0, 0.0));
    /// assert_eq!(route.frame(101), None);
    /// ```
    pub fn frame(&self, index: u64) -> Option<RoutePose> {
        let (pose, over) = self.walk(index as f64 / self.frame_rate);
        // The last frame is the first one at or after the end. 1e-6 of a frame keeps rounding from adding another.
        let frames_over = over * self.frame_rate;
        (frames_over < 1.0 - 1e-6).then_some(pose)
    }

    /// Pose at a time, seconds since frame 0. The vehicle stands at the start before it, and at the last waypoint after it.
    ///
    /// ```
    /// use glam::DVec2;
    /// use raypencil_rover::Route;
    ///
    /// let route = Route::through(DVec2::ZERO, vec![DVec2::new(3.0, 0.0)]);
    /// assert_eq!(Some(route.at(5.0)), route.frame(50));
    /// assert!((route.at(0.001).driven - 3e-4).abs() < 1e-15);
    /// assert_eq!((route.at(-1.0).driven, route.at(99.0).driven), (0.0, 3.0));
    /// ```
    pub fn at(&self, time: f64) -> RoutePose {
        self.walk(time.max(0.0)).0
    }

    /// Pose at a time of at least 0, and the time since the end of the route; below 0 on the way.
    fn walk(&self, mut time: f64) -> (RoutePose, f64) {
        let (mut place, mut heading, mut driven) = (self.start, self.heading, 0.0);
        for &waypoint in &self.waypoints {
            let leg = waypoint - place;
            let Some(towards) = direction(leg) else { continue };
            let turn = shortest_turn(towards - heading);
            let turning = turn.abs() / self.turn_rate;
            if time < turning {
                let turned = time * self.turn_rate;
                let heading = heading + if turn < 0.0 { -turned } else { turned };
                return (RoutePose { place, heading, driven }, -1.0);
            }
            time -= turning;
            heading = towards;
            let driving = leg.length() / self.speed;
            if time < driving {
                let along = time * self.speed;
                let place = place + leg * (along / leg.length());
                return (RoutePose { place, heading, driven: driven + along }, -1.0);
            }
            time -= driving;
            driven += leg.length();
            place = waypoint;
        }
        (RoutePose { place, heading, driven }, time)
    }

    /// Checks every field. The error names the first one that is out of range.
    pub fn validate(&self, field: &str) -> Result<(), SceneError> {
        for (index, point) in std::iter::once(&self.start).chain(&self.waypoints).enumerate() {
            if !point.is_finite() || point.abs().max_element() > 1e12 {
                let name = match index.checked_sub(1) {
                    None => format!("{field}.start"),
                    Some(waypoint) => format!("{field}.waypoints[{waypoint}]"),
                };
                return Err(SceneError::new(name, point, "two numbers from -1e12 to 1e12 m"));
            }
        }
        if let Some(twice) = self.waypoints.windows(2).position(|pair| pair[0] == pair[1]) {
            let name = format!("{field}.waypoints[{}]", twice + 1);
            return Err(SceneError::new(
                name,
                self.waypoints[twice],
                "another place than the waypoint before",
            ));
        }
        check_range(|| format!("{field}.heading"), self.heading, -1e3, 1e3, "rad")?;
        check_range(|| format!("{field}.speed"), self.speed, 1e-4, 1e2, "m/s")?;
        check_range(|| format!("{field}.turn_rate"), self.turn_rate, 1e-4, 1e2, "rad/s")?;
        check_range(|| format!("{field}.frame_rate"), self.frame_rate, 1e-3, 1e4, "1/s")
    }
}

/// Heading of a leg, radians to the left of the x axis; `None` if the leg has no length.
fn direction(leg: DVec2) -> Option<f64> {
    (leg != DVec2::ZERO).then(|| libm::atan2(leg.y, leg.x))
}

/// The turn of at most half a circle, either way, that equals a difference of headings, radians.
fn shortest_turn(turn: f64) -> f64 {
    use std::f64::consts::TAU;
    turn - TAU * (turn / TAU).round()
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use super::*;

    #[test]
    fn a_leg_a_turn_and_a_leg() {
        // 3 m along x at 0.3 m/s: 10 s. A turn of 90 degrees to the left at 0.3 rad/s: 5.236 s. 1.5 m along y: 5 s.
        // Total 20.236 s: frames 0 to 202 are under way, and frame 203 (20.3 s) is at the end.
        let route = Route::through(DVec2::ZERO, vec![DVec2::new(3.0, 0.0), DVec2::new(3.0, 1.5)]);
        assert!(route.validate("route").is_ok());
        let place = route.frame(50).unwrap();
        assert!((place.place - DVec2::new(1.5, 0.0)).length() < 1e-12 && place.heading == 0.0);
        let place = route.frame(110).unwrap();
        assert!((place.place - DVec2::new(3.0, 0.0)).length() < 1e-12 && (place.heading - 0.3).abs() < 1e-12);
        let place = route.frame(200).unwrap();
        assert!((place.heading - FRAC_PI_2).abs() < 1e-12);
        assert!((place.driven - (3.0 + 0.3 * (10.0 - FRAC_PI_2 / 0.3))).abs() < 1e-12);
        let last = route.frame(203).unwrap();
        assert_eq!((last.place, last.driven), (DVec2::new(3.0, 1.5), 4.5));
        assert_eq!(route.frame(204), None);
    }

    #[test]
    fn a_turn_takes_the_shorter_way() {
        // From 170 to -170 degrees the shorter turn is 20 degrees to the left.
        let heading = 170.0_f64.to_radians();
        let far = DVec2::new(libm::cos(heading), -libm::sin(heading)) * 5.0;
        let route = Route { heading, ..Route::through(DVec2::ZERO, vec![far]) };
        assert!((route.frame(1).unwrap().heading - heading - 0.03).abs() < 1e-12);
        let slow = Route { speed: 0.0, ..route };
        assert!(slow.validate("route").unwrap_err().to_string().contains("route.speed"));
    }

    #[test]
    fn a_waypoint_twice_in_a_row_is_refused() {
        let route = |places: &[[f64; 2]]| {
            let waypoints = places.iter().map(|&place| place.into()).collect();
            Route::through(DVec2::ZERO, waypoints).validate("route").map_err(|error| error.field)
        };
        assert_eq!(route(&[[1.0, 0.0], [2.0, 0.0], [1.0, 0.0]]), Ok(()));
        assert_eq!(route(&[[1.0, 0.0], [2.0, 0.0], [2.0, 0.0]]), Err("route.waypoints[2]".into()));
    }

    #[test]
    fn a_turn_may_go_to_the_right() {
        // From 0 to -90 degrees: a quarter to the right, at 0.3 rad/s 0.03 rad in a tenth of a second.
        let route = Route { heading: 0.0, ..Route::through(DVec2::ZERO, vec![DVec2::new(0.0, -5.0)]) };
        assert!((route.frame(1).unwrap().heading + 0.03).abs() < 1e-12);
    }
}
