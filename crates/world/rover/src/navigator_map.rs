//! The local navigator map: labelled vectors between the ends of neighbouring sectors. (Paper, §7)

use glam::DVec2;
use raypencil_scene::{SceneError, check_range};

use crate::obstacle_map::{Label, ObstacleMap, SectorEnd};
use crate::vehicle::Vehicle;

/// Thresholds for the difference of two radii. The paper says "not large" and "small", without numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VectorRules {
    /// A difference above this is large, metres.
    pub large: f64,
    /// A difference up to this is small, metres.
    pub small: f64,
}

impl VectorRules {
    /// Thresholds for a vehicle.
    ///
    /// CHOICE: a large difference is more than the overall width of the vehicle (1.25 m by default): the vehicle does
    /// not fit into a narrower opening between an obstacle and the end of the next sector. Small is half of that.
    pub fn for_vehicle(vehicle: &Vehicle) -> Self {
        Self { large: vehicle.width(), small: 0.5 * vehicle.width() }
    }

    /// Label of the vector between the ends of two neighbouring sectors.
    pub fn label(&self, a: &SectorEnd, b: &SectorEnd) -> Label {
        let difference = (a.radius - b.radius).abs();
        let either = |label| a.label == label || b.label == label;
        if a.label == b.label {
            // "If a vector joins two points with the same label, that vector is labelled with that same label."
            a.label
        } else if either(Label::Obstacle) && difference <= self.large {
            // "The label of a vector joining two points is 'obstacle' if one of the points is labelled 'obstacle' and
            // if the difference in radial distances between the two points is not large."
            Label::Obstacle
        } else if either(Label::Visibility) && difference <= self.small {
            // "Otherwise, if one of the points is labelled 'visibility' and the radial difference between the points is
            // small than the vector is labelled 'visibility.'"
            Label::Visibility
        } else {
            // "If none of these conditions hold, the vector is labelled 'unknown.'"
            Label::Unknown
        }
    }

    /// Checks every field. The error names the first one that is out of range.
    pub fn validate(&self, field: &str) -> Result<(), SceneError> {
        check_range(|| format!("{field}.large"), self.large, 0.0, 1e3, "m")?;
        check_range(|| format!("{field}.small"), self.small, 0.0, 1e3, "m")?;
        check_range(|| format!("{field}.large"), self.large, self.small, 1e3, "m (from `small`)")
    }
}

/// A labelled vector of the navigator map; global x and y, metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LabelledVector {
    /// Start: the end of a sector.
    pub from: DVec2,
    /// End: the end of the next sector to the left.
    pub to: DVec2,
    /// Label, by the labels and radii of both sectors.
    pub label: Label,
}

/// Navigator map of an obstacle map: the vectors from right to left, one fewer than there are sectors.
///
/// "The Local Navigator Map is a list of labelled global vectors, and is used by the intelligent control and piloting
/// module, the Navigator. The radial grid is converted into the map by basically connecting the labelled points on each
/// sector of the radial grid by vectors." (§7)
///
/// ```
/// use glam::DVec2;
/// use raypencil_rover::{Label, ObstacleMap, SectorEnd, VectorRules, navigator_map};
///
/// // An obstacle at 2 m next to a visibility limit at 5 m. The difference of 3 m is large, so that the vector is no
/// // obstacle, and it is not small, so that the vector is no visibility limit either.
/// let end = |radius, label| SectorEnd {
///     direction: 0.0, radius, point: DVec2::new(radius, 0.0), label, failed: None, missing: None,
/// };
/// let sectors = vec![end(2.0, Label::Obstacle), end(5.0, Label::Visibility)];
/// let obstacles = ObstacleMap { centre: DVec2::ZERO, sectors };
/// let vectors = navigator_map(&obstacles, &VectorRules { large: 1.25, small: 0.625 });
/// assert_eq!((vectors.len(), vectors[0].label), (1, Label::Unknown));
/// ```
pub fn navigator_map(obstacles: &ObstacleMap, rules: &VectorRules) -> Vec<LabelledVector> {
    let vector = |pair: &[SectorEnd]| LabelledVector {
        from: pair[0].point,
        to: pair[1].point,
        label: rules.label(&pair[0], &pair[1]),
    };
    obstacles.sectors.windows(2).map(vector).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn end(radius: f64, label: Label) -> SectorEnd {
        SectorEnd {
            direction: 0.0,
            radius,
            point: DVec2::new(radius, 0.0),
            label,
            failed: None,
            missing: None,
        }
    }

    #[test]
    fn every_rule_of_vectors() {
        use Label::{Obstacle, Unknown, Visibility};
        // Large is above 1.25 m, small up to 0.625 m for the default vehicle.
        let rules = VectorRules::for_vehicle(&Vehicle::default());
        assert_eq!((rules.large, rules.small), (1.25, 0.625));
        for (a, b, difference, expected) in [
            // The same label, at any distance.
            (Obstacle, Obstacle, 3.0, Obstacle),
            (Unknown, Unknown, 0.0, Unknown),
            (Visibility, Visibility, 0.0, Visibility),
            // One obstacle, not large: an obstacle, with any other label.
            (Obstacle, Unknown, 1.25, Obstacle),
            (Obstacle, Visibility, 0.25, Obstacle),
            // One obstacle, large: unknown. The visibility rule needs a small difference, and a large one is not small.
            (Obstacle, Unknown, 1.5, Unknown),
            (Obstacle, Visibility, 1.5, Unknown),
            // No obstacle, one visibility limit: small, and not small.
            (Unknown, Visibility, 0.625, Visibility),
            (Unknown, Visibility, 0.75, Unknown),
        ] {
            let (near, far) = (end(2.0, a), end(2.0 + difference, b));
            assert_eq!(rules.label(&near, &far), expected, "{a:?} {b:?} {difference}");
            assert_eq!(rules.label(&far, &near), expected, "{b:?} {a:?} {difference}");
        }
    }

    #[test]
    fn with_small_above_large_an_obstacle_may_become_a_visibility_limit() {
        // The rules apply in the paper's order: an obstacle with a large difference goes on to the next rule.
        let rules = VectorRules { large: 0.5, small: 1.0 };
        let (a, b) = (end(2.0, Label::Obstacle), end(2.75, Label::Visibility));
        assert_eq!(rules.label(&a, &b), Label::Visibility);
    }

    #[test]
    fn vectors_join_neighbouring_sectors() {
        let sectors = vec![end(1.0, Label::Obstacle), end(1.5, Label::Unknown), end(4.0, Label::Unknown)];
        let obstacles = ObstacleMap { centre: DVec2::ZERO, sectors };
        let vectors = navigator_map(&obstacles, &VectorRules::for_vehicle(&Vehicle::default()));
        let labels: Vec<Label> = vectors.iter().map(|vector| vector.label).collect();
        assert_eq!(labels, [Label::Obstacle, Label::Unknown]);
        assert_eq!((vectors[0].to, vectors[1].from), (DVec2::new(1.5, 0.0), DVec2::new(1.5, 0.0)));
        assert!(VectorRules { small: f64::NAN, large: 1.0 }.validate("vectors").is_err());
        let rules =
            |large, small| VectorRules { large, small }.validate("vectors").map_err(|error| error.field);
        assert_eq!((rules(1.0, 1.0), rules(0.99, 1.0)), (Ok(()), Err("vectors.large".into())));
    }
}
