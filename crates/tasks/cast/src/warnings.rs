//! What looks wrong in rays and their mesh: nothing is hit, another unit or axis, backs, an open mesh.
//!
//! A warning changes no answer. Its numbers are measured; what it asks is for the reader to decide.

use std::collections::HashMap;

use glam::DVec3;
use raypencil_referee::ExactCast;
use raypencil_report::{count, counted, number};
use raypencil_scene::{CastRay, NamedRaySet, Side, Sides, Triangles};
use raypencil_survey::{TerrainShape, Warning, WarningCode, lies_on_its_side, terrain_too_large};

use crate::answers::Answers;
use crate::columns::ReadingCounts;

/// Largest share of backs among the first hits, tuned: one half, as for a sensor.
const MAX_BACK_SHARE: f64 = 0.5;

/// Units that a mesh may be in where its rays are in metres, in metres.
const UNITS: [(&str, f64); 4] =
    [("millimetres", 0.001), ("centimetres", 0.01), ("inches", 0.0254), ("feet", 0.3048)];

/// Least share of the rays, one of so many, that hit with another unit or axis, if it is to be told. Tuned.
const TOLD_SHARE: u64 = 10;

/// Coordinates of rays beyond this are not changed to another unit, in which they would be no rays.
const MAX_CHANGED: f64 = 1e26;

/// Rays that are asked once more, at most, where none hits: with other limits, and against both sides.
const MAX_TRIED_RAYS: usize = 4096;

/// Where a mesh comes from, as far as a warning says what to change there. By default it is a file whose coordinates stay.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct MeshHome {
    /// Whether it is the terrain of a scene file, which has its scale and its up axis.
    pub is_scene: bool,
    /// Where the origin of the mesh's frame lies in its map, metres.
    pub origin: [f64; 3],
}

impl MeshHome {
    /// What multiplies the coordinates of the mesh.
    fn scale_remedy(self, scale: f64) -> String {
        let option = if self.is_scene { "--set terrain.scale=" } else { "--scale " };
        format!("{option}{scale}")
    }

    /// What says that y is up.
    fn up_remedy(self) -> &'static str {
        if self.is_scene { "--set terrain.up=y" } else { "--up y" }
    }
}

/// Warnings about the rays of a set, or of no set, whose answers are known.
///
/// ```
/// use raypencil_cast::{MeshHome, Questions, cast, cast_warnings, rays_from_bytes};
/// use raypencil_scene::{Sides, Silent, Triangles};
///
/// // A wall in millimetres, 2 m before a ray that reaches 100 units.
/// let corners = vec![[2000.0, -4000.0, -4000.0], [2000.0, 4000.0, -4000.0], [2000.0, 0.0, 4000.0]];
/// let mesh = Triangles::new(corners, vec![[0, 1, 2]])?;
/// let rays = rays_from_bytes(b"0,0,0,1,0,0,0,100", "here".as_ref())?.rays;
/// let answers = cast(&mesh, &rays, Sides::Both, Questions::default(), &Silent);
/// let found = cast_warnings((&mesh, MeshHome::default()), &rays, Sides::Both, None, &answers);
/// let sentence = "the ray does not hit the mesh within its limits. Without them 1 of 1 that were tried would, the nearest at \
///                 2000 where the limit is 100: is the mesh in millimetres (--scale 0.001)? 1 of 1 would hit then.";
/// assert_eq!(found[0].to_string(), sentence);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn cast_warnings(
    (mesh, home): (&Triangles, MeshHome),
    rays: &[CastRay],
    sides: Sides,
    set: Option<&NamedRaySet>,
    answers: &Answers,
) -> Vec<Warning> {
    let hits = answers.counts().0 as u64;
    let backs = answers.hits().filter(|hit| hit.side == Side::Back).count() as u64;
    let too_near = answers.too_near() as u64;
    let counts = ReadingCounts { hits, too_near, backs, decided: answers.decided.unwrap_or_default() };
    let seen = CastSeen { counts, open_edges: answers.all.as_ref().map(|_| open_edges(mesh)) };
    cast_warnings_of((mesh, home), || ExactCast::new(mesh), rays, sides, set, seen)
}

/// What warnings are about.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CastSeen {
    /// How many rays read what.
    pub counts: ReadingCounts,
    /// The mesh's [`open_edges`], if all hits are asked for.
    pub open_edges: Option<u64>,
}

/// [`cast_warnings`] about rays whose answers are no longer there. Where anything is hit, they need not be there either.
pub fn cast_warnings_of<'t>(
    (mesh, home): (&'t Triangles, MeshHome),
    exact: impl FnOnce() -> ExactCast<'t>,
    rays: &[CastRay],
    sides: Sides,
    set: Option<&NamedRaySet>,
    seen: CastSeen,
) -> Vec<Warning> {
    let of = set.map_or(String::new(), |set| format!("{}: ", set.name));
    let warning = |code, sentence: String| Warning::of_scene(code, format!("{of}{sentence}"));
    let mut found = Vec::new();
    let ReadingCounts { hits, too_near, backs, .. } = seen.counts;
    if hits + too_near == 0 && !rays.is_empty() {
        let (code, sentence) = Misses::new(mesh, home, &exact(), rays, sides).warning();
        found.push(warning(code, sentence));
    }
    if backs as f64 > MAX_BACK_SHARE * hits as f64 {
        let percent = number(100.0 * backs as f64 / hits as f64);
        let sentence = format!(
            "{percent} % of the rays that hit meet the back of a face: are the faces wound clockwise, or do the rays begin inside?"
        );
        found.push(warning(WarningCode::BacksFirst, sentence));
    }
    // The z axis of a pattern is up; rays as numbers may have any axes.
    if let Some(shape) = set.and_then(|_| TerrainShape::of_triangles(mesh)) {
        if lies_on_its_side(&shape) {
            let sentence = format!(
                "the mesh lies in the plane of x and z and faces along y, but the z axis of the pattern is up: is y up in its file \
                 ({})?",
                home.up_remedy()
            );
            found.push(warning(WarningCode::TerrainOnItsSide, sentence));
        }
        let reach = rays.iter().map(reach).fold(0.0, f64::max);
        found.extend(terrain_too_large(&shape, reach).map(|Warning { code, sentence, .. }| {
            warning(code, format!("{sentence} ({})", home.scale_remedy(UNITS[0].1)))
        }));
    }
    if let Some(open) = seen.open_edges.filter(|&open| open > 0) {
        let edges = counted(open, "open edge", "open edges");
        let sentence = format!(
            "the mesh has {edges}: sums of crossings tell its inside from its outside only where it is closed."
        );
        found.push(warning(WarningCode::OpenMesh, sentence));
    }
    found
}

/// The longest range of a ray, in the unit of the mesh.
fn reach(ray: &CastRay) -> f64 {
    ray.t_max * ray.direction.length()
}

/// Rays of which none hits, and what some of them meet if they are asked otherwise.
struct Misses<'a> {
    mesh: &'a Triangles,
    home: MeshHome,
    exact: &'a ExactCast<'a>,
    rays: &'a [CastRay],
    tried: Vec<&'a CastRay>,
    sides: Sides,
}

/// What rays hit that are asked otherwise.
struct Tried<'a> {
    hits: u64,
    /// The nearest of these hits, in the unit of the mesh, and the ray of it as it was given.
    nearest: f64,
    ray: &'a CastRay,
}

impl<'a> Misses<'a> {
    fn new(
        mesh: &'a Triangles,
        home: MeshHome,
        exact: &'a ExactCast<'a>,
        rays: &'a [CastRay],
        sides: Sides,
    ) -> Self {
        let step = rays.len().div_ceil(MAX_TRIED_RAYS);
        Self { mesh, home, exact, rays, tried: rays.iter().step_by(step).collect(), sides }
    }

    /// Why no ray hits, as far as asking some of them again can tell. The answers are exact.
    fn warning(&self) -> (WarningCode, String) {
        let none = match self.rays.len() {
            1 => "the ray does not hit the mesh".to_string(),
            rays => format!("none of the {} rays hits the mesh", count(rays as u64)),
        };
        if let Some(sentence) = self.of_map(&none) {
            return (WarningCode::RaysInMap, sentence);
        }
        let sentence = self
            .of_limits(&none)
            .or_else(|| self.of_sides(&none))
            .or_else(|| self.of_places(&none))
            .unwrap_or_else(|| format!("{none}: it has no vertices."));
        (WarningCode::NoHits, sentence)
    }

    /// Asks the rays that are tried, changed as `change` says.
    fn ask(&self, sides: Sides, change: impl Fn(&CastRay) -> CastRay) -> Option<Tried<'a>> {
        let mut found: Option<Tried<'a>> = None;
        for &ray in &self.tried {
            let asked = change(ray);
            let hit =
                self.exact.first(&asked, sides).first().and_then(|face| self.exact.meeting(&asked, *face));
            let Some(range) = hit.map(|hit| hit.range().double) else { continue };
            let tried = found.get_or_insert(Tried { hits: 0, nearest: range, ray });
            tried.hits += 1;
            if range < tried.nearest {
                (tried.nearest, tried.ray) = (range, ray);
            }
        }
        found
    }

    /// The rays as they would be if they were given in the map, and not in the frame of the mesh.
    fn of_map(&self, none: &str) -> Option<String> {
        let origin = DVec3::from_array(self.home.origin);
        if origin == DVec3::ZERO {
            return None;
        }
        let moved = |ray: &CastRay| CastRay { origin: ray.origin - origin, ..*ray };
        let Tried { hits, .. } = self.ask(self.sides, moved)?;
        Some(format!(
            "{none}. {hits} of {} that were tried would if they began {} less: are they in coordinates of the map? Rays are in \
             the frame of the scene, whose origin lies there in the map.",
            self.tried.len(),
            // With all its digits: it is what to subtract.
            format_args!("({}, {}, {})", origin.x, origin.y, origin.z)
        ))
    }

    /// The rays without their limits.
    fn of_limits(&self, none: &str) -> Option<String> {
        let without = |ray: &CastRay| CastRay { t_min: 0.0, t_max: f64::INFINITY, t_blind: 0.0, ..*ray };
        let Tried { hits, nearest, ray } = self.ask(self.sides, without)?;
        let words = format!(
            "{none} within its limits. Without them {hits} of {} that were tried would, the nearest at {}",
            self.tried.len(),
            number(nearest)
        );
        // What lies before the least t is no matter of a unit that is too small.
        Some(match self.hit_is_beyond(ray) {
            true => format!("{words} where the limit is {}{}", number(reach(ray)), self.question()),
            false => {
                let from = number(ray.t_min * ray.direction.length());
                format!("{words}, before the {from} from which its hits count (t_min).")
            }
        })
    }

    /// Whether the first hit of a ray without limits is beyond its greatest t. It hits something, and nothing within its limits.
    fn hit_is_beyond(&self, ray: &CastRay) -> bool {
        self.exact.first(&CastRay { t_min: 0.0, t_blind: 0.0, ..*ray }, self.sides).is_empty()
    }

    /// The rays on both sides of faces.
    fn of_sides(&self, none: &str) -> Option<String> {
        if self.sides == Sides::Both {
            return None;
        }
        let Tried { hits, .. } = self.ask(Sides::Both, |ray| *ray)?;
        Some(format!(
            "{none} at a front. {hits} of {} that were tried meet the back of a face, through which they pass: are the faces \
             wound clockwise, or do the rays begin inside?",
            self.tried.len()
        ))
    }

    /// Where the mesh lies, and where the rays begin.
    fn of_places(&self, none: &str) -> Option<String> {
        let [low, high] = self.mesh.bounds()?;
        let origins = self.rays.iter().map(|ray| ray.origin);
        let (first, last) = origins.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), origin| {
            (low.min(origin), high.max(origin))
        });
        let (reach, begin) = match self.rays.len() {
            1 => ("it reaches", format!("the ray begins at {}", place(first))),
            _ => ("they reach", format!("the rays begin between {} and {}", place(first), place(last))),
        };
        Some(format!(
            "{none}, however far {reach}. It lies between {} and {}, and {begin}{}",
            place(low),
            place(high),
            self.question()
        ))
    }

    /// Which other unit or axis of the mesh lets rays hit, as the end of a sentence. The rays are changed in place of the mesh.
    fn question(&self) -> String {
        let tried = self.tried.len();
        let asked = |remedy: &str, what: &str, change: &dyn Fn(DVec3) -> DVec3| {
            let changed = |ray: &CastRay| {
                let [origin, direction] = [ray.origin, ray.direction].map(change);
                CastRay { origin, direction, ..*ray }
            };
            let Tried { hits, .. } = self.ask(self.sides, changed)?;
            (TOLD_SHARE * hits >= tried as u64)
                .then(|| format!(": {what} ({remedy})? {hits} of {tried} would hit then."))
        };
        let fits = |ray: &&CastRay| ray.origin.abs().max(ray.direction.abs()).max_element() <= MAX_CHANGED;
        if !self.tried.iter().all(fits) {
            return ".".into();
        }
        let y_up =
            asked(self.home.up_remedy(), "is y up in the mesh's file", &|v| DVec3::new(v.x, v.z, -v.y));
        let of_unit = |(unit, scale): (&str, f64)| {
            asked(&self.home.scale_remedy(scale), &format!("is the mesh in {unit}"), &|v| v / scale)
        };
        y_up.or_else(|| UNITS.into_iter().find_map(of_unit)).unwrap_or_else(|| ".".into())
    }
}

fn place(at: DVec3) -> String {
    format!("({}, {}, {})", number(at.x), number(at.y), number(at.z))
}

/// Number of edges that are not run through once in each direction, after vertices at the same place are taken as one.
pub fn open_edges(mesh: &Triangles) -> u64 {
    let mut known = HashMap::new();
    let places: Vec<u32> = mesh
        .vertices()
        .iter()
        .enumerate()
        // -0 and 0 are one place.
        .map(|(k, vertex)| *known.entry(vertex.map(|part| (part + 0.0).to_bits())).or_insert(k as u32))
        .collect();
    // An edge from the lower to the higher index counts 1, back it counts -1.
    let mut edges: Vec<(u32, u32, i32)> = Vec::with_capacity(3 * mesh.faces().len());
    for face in mesh.faces() {
        let [a, b, c] = face.map(|corner| places[corner as usize]);
        for (from, to) in [(a, b), (b, c), (c, a)] {
            match from.cmp(&to) {
                std::cmp::Ordering::Less => edges.push((from, to, 1)),
                std::cmp::Ordering::Greater => edges.push((to, from, -1)),
                std::cmp::Ordering::Equal => {}
            }
        }
    }
    edges.sort_unstable();
    let of_one_edge = edges.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1));
    of_one_edge.filter(|edge| edge.iter().map(|(.., way)| way).sum::<i32>() != 0).count() as u64
}

#[cfg(test)]
#[path = "../tests/unit/warnings.rs"]
mod tests;
