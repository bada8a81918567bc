//! What a reader found out about the polygons of a file.

use serde::Serialize;

/// What was found out about the polygons of a file that have more than three corners.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct PolygonFacts {
    /// Number of polygons of more than three corners.
    pub count: u64,
    /// Number of those that are not convex: they were cut into triangles that cover them, each point once.
    pub cut: u64,
    /// Those that cross themselves; of these a fan around the first corner was taken.
    pub crossing: Option<CrossingPolygons>,
    /// Those whose corners do not lie in a plane, beyond rounding.
    pub bent: Option<BentPolygons>,
}

/// Polygons that cross themselves.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct CrossingPolygons {
    /// Their number.
    pub count: u64,
    /// The first one.
    pub first: PolygonPlace,
}

/// Polygons whose corners do not lie in a plane.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BentPolygons {
    /// Their number.
    pub count: u64,
    /// The one whose corners are farthest from its plane.
    pub worst: PolygonPlace,
    /// The distance of that corner, in the unit of the file.
    pub distance: f64,
}

/// Place of a polygon in its file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct PolygonPlace {
    /// Its number among all polygons of the file, from 0.
    pub polygon: u32,
    /// Its line, of an OBJ file.
    pub line: Option<usize>,
}

impl std::fmt::Display for PolygonPlace {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self.line {
            Some(line) => write!(f, "polygon {} (line {line})", self.polygon),
            None => write!(f, "polygon {}", self.polygon),
        }
    }
}

impl PolygonFacts {
    pub(super) fn add_crossing(&mut self, polygon: u32) {
        let first = PolygonPlace { polygon, line: None };
        self.crossing.get_or_insert(CrossingPolygons { count: 0, first }).count += 1;
    }

    pub(super) fn add_bent(&mut self, polygon: u32, distance: f64) {
        let worst = PolygonPlace { polygon, line: None };
        let found = self.bent.get_or_insert(BentPolygons { count: 0, worst, distance });
        found.count += 1;
        if distance > found.distance {
            (found.worst, found.distance) = (worst, distance);
        }
    }

    /// Adds the lines of the polygons that are named.
    pub(super) fn with_lines(mut self, line: impl Fn(u32) -> Option<usize>) -> Self {
        let crossing = self.crossing.as_mut().map(|found| &mut found.first);
        let bent = self.bent.as_mut().map(|found| &mut found.worst);
        for place in crossing.into_iter().chain(bent) {
            place.line = line(place.polygon);
        }
        self
    }

    /// The numbers as a sentence without its full stop; empty if every polygon is a triangle.
    pub fn words(&self) -> String {
        let counted =
            |count: u64, one: &str, many: &str| format!("{count} {}", if count == 1 { one } else { many });
        match (self.count, self.cut) {
            (0, _) => String::new(),
            (polygons, 0) => {
                format!("{} of more than three corners", counted(polygons, "polygon", "polygons"))
            }
            (polygons, cut) => format!(
                "{} of more than three corners, {} of them not convex and cut truly",
                counted(polygons, "polygon", "polygons"),
                cut
            ),
        }
    }
}
