//! A scene of rays alone: terrain, vehicle and sets of rays, and no camera.
//!
//! A camera and beams need vertices that are `f32` offsets from one origin. Rays given as numbers do not: here a terrain's
//! file is read as it is, in double precision and in its own coordinates.

use std::path::Path;

use glam::DVec3;
use raypencil_files::{Sha256Digest, combined_sha256_hex, sha256};
use raypencil_mesh_io::{DEFAULT_REFLECTIVITY, FileFacts, FileUnits, TerrainFile, read_triangles};
use raypencil_scene::{Material, Mesh, NamedRaySet, Pose, SceneError, Triangles};

use crate::ground::{make_ground, read_ground, terrain_file};
use crate::load::{no_ground, read_toml};
use crate::parse::kind::Kind;
use crate::parse::scene::parse;
use crate::parse::source::Source;
use crate::plan::{MeshPart, ScenePlan, Terrain};
use crate::resolve::extent;
use crate::scene_error::SceneIoError;
use crate::scene_source::MESH_ENDINGS;
use crate::settings::{Setting, changed};

/// Sets of rays on a terrain.
#[derive(Debug, Clone)]
pub struct RayScene {
    /// The terrain. That of a mesh file is in the file's own coordinates, as the file gives them, unless the scene file says
    /// which axis is up or has a scale; any other, which has `f32`
    /// offsets from the start, is in the scene frame.
    pub triangles: Triangles,
    /// Where the origin of the terrain's frame lies in the global frame, which is the map of an elevation model, metres: 0 where
    /// coordinates are those of the file.
    pub origin: [f64; 3],
    /// The sets, in the frame of the terrain: at least one.
    pub sets: Vec<NamedRaySet>,
    /// SHA-256 of the terrain's files, or of its numbers if it has none.
    pub terrain_digests: Vec<Sha256Digest>,
    /// What was found out about the terrain's file.
    pub file_facts: FileFacts,
    /// SHA-256 in hexadecimal of the scene file, followed by the digests of the files that its sets name.
    pub sha256: String,
}

/// Loads the terrain, the vehicle and the sets of rays of a scene file. A camera, beams and their light are checked and
/// not used. `settings` are put into the file's text first.
///
/// ```
/// use raypencil_scene_io::load_ray_scene;
///
/// let folder = tempfile::tempdir()?;
/// // 0.1 is no f32 number: here it stays the nearest f64.
/// std::fs::write(folder.path().join("hill.obj"), "v -1 -1 0.1\nv 1 -1 0.1\nv 0 1 0.1\nf 1 2 3\n")?;
/// let text = "version = 1\n[terrain]\nfile = \"hill.obj\"\n[vehicle]\nposition_m = [0, 0, 2]\n\
///     [[rays]]\nname = \"down\"\nspinning = { elevations_deg = [-90], steps = 1 }\n";
/// let path = folder.path().join("scene.toml");
/// std::fs::write(&path, text)?;
/// let scene = load_ray_scene(&path, &[])?;
/// assert_eq!(scene.triangles.vertices()[0], [-1.0, -1.0, 0.1]);
/// assert_eq!(scene.sets[0].set.rays()[0].origin.to_array(), [0.0, 0.0, 2.0]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// Names the file, the place in it, the value found and the values expected: also for a file without sets of rays.
pub fn load_ray_scene(path: &Path, settings: &[Setting]) -> Result<RayScene, SceneIoError> {
    let text = read_toml(path)?;
    let changed = if settings.is_empty() { None } else { changed(&text, settings)? };
    let file = Source::changed(path, &text, changed.as_ref());
    if matches!(file.kind()?, Kind::Resolved) {
        let message = "a resolved scene has no sets of rays; expected a scene file with tables `[[rays]]`";
        return Err(file.error(0..0, message));
    }
    let plan = parse(&file)?;
    if plan.ray_sets.is_empty() {
        return Err(file.error(0..0, "there is no table `[[rays]]`; expected at least one"));
    }
    let unfit = |error: SceneError| SceneIoError::scene(path.display().to_string(), error);
    let (triangles, origin, vehicle, terrain_digests, file_facts) = match &plan.terrain {
        Terrain::File(MeshPart { file: terrain, frame }) => {
            let terrain = terrain_file(&file, "file", &MESH_ENDINGS, terrain, &plan.terrain_span)?;
            let read = read_triangles(&terrain)?;
            read.require_faces(&terrain)?;
            let triangles = frame.triangles(read.triangles).map_err(unfit)?;
            // A vehicle with a height needs no ground, which may then have any size.
            let ground = match plan.vehicle.height {
                Some(_) => Mesh::from_global(&[], vec![], vec![], vec![]),
                None => ground_of(&triangles),
            };
            let vehicle = stood(&file, &plan, &ground.map_err(unfit)?)?;
            let is_gltf = read.is_gltf;
            let units = Some(FileUnits::Mesh { is_gltf, frame: *frame });
            (triangles, [0.0; 3], vehicle, read.digests, FileFacts { units, polygons: read.polygon_facts })
        }
        _ => {
            let TerrainFile { mesh, digests, facts } = match read_ground(&file, &plan)? {
                Some(read) => read,
                None => {
                    let mesh = make_ground(&plan).map_err(unfit)?;
                    let digest = crate::digest::mesh(&mesh);
                    TerrainFile { mesh, digests: vec![digest], facts: FileFacts::default() }
                }
            };
            let global = stood(&file, &plan, &mesh)?;
            let vehicle = Pose { position: global.position - mesh.origin(), ..global };
            (Triangles::from(&mesh), mesh.origin().to_array(), vehicle, digests, facts)
        }
    };
    let sets = plan.ray_sets.iter().map(|set| set.placed(&vehicle));
    let sets: Vec<NamedRaySet> = sets.collect::<Result<_, _>>().map_err(unfit)?;
    let of_sets = plan.ray_digests.iter().map(|(_, digest)| *digest);
    let parts: Vec<Sha256Digest> = std::iter::once(sha256(file.text.as_bytes())).chain(of_sets).collect();
    Ok(RayScene { triangles, origin, sets, terrain_digests, file_facts, sha256: combined_sha256_hex(&parts) })
}

/// The vehicle's pose in the global frame.
fn stood(file: &Source, plan: &ScenePlan, mesh: &Mesh) -> Result<Pose, SceneIoError> {
    let [x, y] = plan.vehicle.position;
    plan.vehicle
        .global_from_vehicle(mesh)
        .ok_or_else(|| no_ground(file, plan.position_span.clone(), [x, y], &extent(mesh), false))
}

/// The same terrain in `f32` offsets: only the height under the vehicle is taken from it.
fn ground_of(triangles: &Triangles) -> Result<Mesh, SceneError> {
    let vertices: Vec<DVec3> = triangles.vertices().iter().map(|&vertex| DVec3::from(vertex)).collect();
    let materials = vec![Material { name: "ground".into(), reflectivity: DEFAULT_REFLECTIVITY }];
    Mesh::from_global(&vertices, triangles.faces().to_vec(), vec![0; triangles.faces().len()], materials)
}
