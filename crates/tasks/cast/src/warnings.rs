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

/// Rays that are asked once more, at most, where none hits: with other limits, and against both sides.
const MAX_TRIED_RAYS: usize = 4096;

/// Warnings about the rays of a set, or of no set, whose answers are known.
///
/// ```
/// use raypencil_cast::{Questions, cast, cast_warnings, rays_from_bytes};
/// use raypencil_scene::{Sides, Silent, Triangles};
///
/// // A floor in millimetres, 1.5 m below a ray that reaches 100 units.
/// let corners = vec![[0.0, 0.0, 0.0], [4000.0, 0.0, 0.0], [0.0, 4000.0, 0.0]];
/// let mesh = Triangles::new(corners, vec![[0, 1, 2]])?;
/// let rays = rays_from_bytes(b"100,100,1500,0,0,-1,0,100", "here".as_ref())?.rays;
/// let answers = cast(&mesh, &rays, Sides::Both, Questions::default(), &Silent);
/// let found = cast_warnings(&mesh, &rays, Sides::Both, None, &answers);
/// let sentence = "the ray does not hit the mesh within its limits. Without them 1 of 1 that were tried would, the nearest at \
///                 1500 where the limit is 100: is the mesh in another unit, such as millimetres (--scale 0.001)?";
/// assert_eq!(found[0].to_string(), sentence);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn cast_warnings(
    mesh: &Triangles,
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
    cast_warnings_of(mesh, || ExactCast::new(mesh), rays, sides, set, seen)
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
    mesh: &'t Triangles,
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
        found.push(warning(WarningCode::NoHits, nothing_hit(mesh, &exact(), rays, sides)));
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
            let sentence = "the mesh lies in the plane of x and z and faces along y, but the z axis of the pattern is up: is y up in \
                            its file (--up y)?";
            found.push(warning(WarningCode::TerrainOnItsSide, sentence.into()));
        }
        let reach = rays.iter().map(reach).fold(0.0, f64::max);
        found.extend(
            terrain_too_large(&shape, reach)
                .map(|Warning { code, sentence, .. }| warning(code, format!("{sentence} (--scale 0.001)"))),
        );
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

/// Why no ray hits, as far as asking some of them again can tell. The answers are exact.
fn nothing_hit(mesh: &Triangles, exact: &ExactCast<'_>, rays: &[CastRay], sides: Sides) -> String {
    let none = match rays.len() {
        1 => "the ray does not hit the mesh".to_string(),
        rays => format!("none of the {} rays hits the mesh", count(rays as u64)),
    };
    let step = rays.len().div_ceil(MAX_TRIED_RAYS);
    let tried: Vec<&CastRay> = rays.iter().step_by(step).collect();
    let nearest = |limited: bool, sides: Sides| {
        let mut hits = 0_u64;
        let mut nearest: Option<(f64, &CastRay)> = None;
        for &ray in &tried {
            let asked = if limited {
                *ray
            } else {
                CastRay { t_min: 0.0, t_max: f64::INFINITY, t_blind: 0.0, ..*ray }
            };
            let Some(hit) = exact.first(&asked, sides).first().and_then(|face| exact.values(&asked, *face))
            else {
                continue;
            };
            hits += 1;
            if nearest.is_none_or(|(range, _)| hit.range.double < range) {
                nearest = Some((hit.range.double, ray));
            }
        }
        nearest.map(|(range, ray)| (hits, range, ray))
    };
    let of = tried.len();
    if let Some((hits, range, ray)) = nearest(false, sides) {
        let words = format!(
            "{none} within its limits. Without them {hits} of {of} that were tried would, the nearest at"
        );
        let (range, from, to) =
            (number(range), number(ray.t_min * ray.direction.length()), number(reach(ray)));
        // What lies before the least t is no matter of a unit that is too small.
        return match hit_is_beyond(ray, exact, sides) {
            true => format!(
                "{words} {range} where the limit is {to}: is the mesh in another unit, such as millimetres (--scale 0.001)?"
            ),
            false => format!("{words} {range}, before the {from} from which its hits count (t_min)."),
        };
    }
    if sides == Sides::Fronts
        && let Some((hits, ..)) = nearest(true, Sides::Both)
    {
        return format!(
            "{none} at a front. {hits} of {of} that were tried meet the back of a face, through which they pass: are the faces \
             wound clockwise, or do the rays begin inside?"
        );
    }
    let Some([low, high]) = mesh.bounds() else { return format!("{none}: it has no vertices.") };
    let origins = rays.iter().map(|ray| ray.origin);
    let (first, last) = origins.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), origin| {
        (low.min(origin), high.max(origin))
    });
    let place = |at: DVec3| format!("({}, {}, {})", number(at.x), number(at.y), number(at.z));
    format!(
        "{none}, however far they reach. It lies between {} and {}, and the rays begin between {} and {}: is its unit or its up axis \
         another (--scale, --up)?",
        place(low),
        place(high),
        place(first),
        place(last)
    )
}

/// Whether the first hit of a ray without limits is beyond its greatest t. It hits something, and nothing within its limits.
fn hit_is_beyond(ray: &CastRay, exact: &ExactCast<'_>, sides: Sides) -> bool {
    exact.first(&CastRay { t_min: 0.0, t_blind: 0.0, ..*ray }, sides).is_empty()
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
