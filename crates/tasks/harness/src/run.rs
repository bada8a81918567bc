//! `validate`: renders, judges and compares one scene.

use std::time::Instant;

use raypencil_judge::{Attributions, Judge, JudgeShare, compare_judged};
use raypencil_referee::RefereeTree;
use raypencil_scene::{Progress, Request, Stage, Switches};
use raypencil_scene_io::Subject;
use raypencil_survey::Surveyor;

use crate::ray_sets::answer_ray_sets;
use crate::rendered::Rendered;
use crate::renderers::{Contender, attribute};
use crate::validation::{Pair, Validation, most_hits};

/// Renders `subject` with each of `contenders` and compares every pair of them. The referee rules on every ray whose
/// answers differ, and on `share` of the rays that agree.
///
/// ```
/// # use std::sync::Arc;
/// # use glam::DVec3;
/// use raypencil_harness::{contender, validate};
/// use raypencil_judge::JudgeShare;
/// # use raypencil_scene::{Atmosphere, FluxModel, Scene, Silent, rig};
/// # use raypencil_scene_io::Subject;
///
/// # let mesh = raypencil_terrain::builtin("facets", 0.25).expect("a built-in name").into_mesh()?;
/// # let (camera, beams) = rig::default_rig(64, DVec3::ZERO, 0.0);
/// # let air = Atmosphere { attenuation: 0.0 };
/// # let scene = Scene::new(Arc::new(mesh), camera, beams, air, FluxModel::Radiometric)?;
/// // `scene`: the facets under the default rig, 64 times coarser: 16 x 16 pixels, two beams of 16 x 2 pencils.
/// let subject = Subject {
///     scene,
///     name: "small".into(),
///     arguments: "small.toml".into(),
///     sha256: "0".repeat(64),
///     vehicle: None,
///     file_facts: Default::default(),
/// };
/// let contenders = ["scanline", "tracer", "referee"].map(|name| contender(name).expect("a renderer's name"));
/// let validation = validate(subject, &contenders, JudgeShare::All, &Silent);
/// // Three renderers are three pairs, and each compares 16 x 16 + 2 (16 x 2) = 320 rays.
/// assert_eq!(validation.pairs.len(), 3);
/// assert_eq!(validation.counts().compared, 3 * 320);
/// // All rays were judged, and no renderer is wrong.
/// assert_eq!((validation.counts().judged, validation.counts().defects), (3 * 320, 0));
/// # Ok::<(), raypencil_scene::SceneError>(())
/// ```
pub fn validate(
    subject: Subject,
    contenders: &[Contender],
    share: JudgeShare,
    progress: &dyn Progress,
) -> Validation {
    Validator::default().validate(subject, contenders, share, progress)
}

/// Validates scene after scene. What belongs to a terrain, the referee's hierarchy above all, is kept as long as the next
/// scene has the same terrain in memory; renderers keep theirs themselves.
///
/// ```
/// use raypencil_harness::{Validator, contender};
/// use raypencil_judge::JudgeShare;
/// # use std::sync::Arc;
/// # use glam::DVec3;
/// # use raypencil_scene::{Atmosphere, FluxModel, Scene, Silent, rig};
/// # use raypencil_scene_io::Subject;
///
/// let mesh = Arc::new(raypencil_terrain::builtin("facets", 0.25).expect("a built-in name").into_mesh()?);
/// let contenders = ["scanline", "tracer"].map(|name| contender(name).expect("a renderer's name"));
/// let mut validator = Validator::default();
/// // The default rig, 64 times coarser, drives on by half a metre: 16 x 16 pixels, two beams of 16 x 2 pencils.
/// for place in [0.0, 0.5] {
///     let (camera, beams) = rig::default_rig(64, DVec3::new(place, 0.0, 0.0), 0.0);
///     let air = Atmosphere { attenuation: 0.0 };
///     let scene = Scene::new(Arc::clone(&mesh), camera, beams, air, FluxModel::Radiometric)?;
///     # let (name, arguments, sha256) = ("small".into(), "small.toml".into(), "0".repeat(64));
///     # let subject = Subject { scene, name, arguments, sha256, vehicle: None, file_facts: Default::default() };
///     let validation = validator.validate(subject, &contenders, JudgeShare::Sample, &Silent);
///     assert_eq!((validation.counts().compared, validation.counts().defects), (320, 0));
/// }
/// # Ok::<(), raypencil_scene::SceneError>(())
/// ```
#[derive(Debug, Default)]
pub struct Validator {
    tree: Option<RefereeTree>,
    surveyor: Surveyor,
}

impl Validator {
    /// Validates one scene, as [`validate`] does.
    pub fn validate(
        &mut self,
        subject: Subject,
        contenders: &[Contender],
        share: JudgeShare,
        progress: &dyn Progress,
    ) -> Validation {
        let mut stages = Vec::new();

        // Render.
        let mut rendered = Vec::new();
        for contender in contenders {
            let renderer = &contender.renderer;
            let name = renderer.name().to_string();
            progress.stage(&format!("{name}: rendering"));
            let start = Instant::now();
            let output = renderer.render(&subject.scene, &Request::EVERYTHING);
            let time = start.elapsed();
            stages.extend(
                output
                    .stages
                    .iter()
                    .map(|stage| Stage { name: format!("{name}: {}", stage.name), ..stage.clone() }),
            );
            rendered.push(Rendered {
                name,
                precision: renderer.precision(),
                approximations: contender.approximations(),
                attributions: Attributions::default(),
                output,
                time,
            });
        }

        // What looks wrong in the scene itself.
        progress.stage("looking at the scene");
        let start = Instant::now();
        let hits = most_hits(&rendered);
        let mut warnings = subject.file_warnings();
        warnings.extend(self.surveyor.warnings(&subject.scene, subject.vehicle.as_ref(), Some(&hits)));
        stages.push(Stage { name: "looking at the scene".into(), time: start.elapsed() });

        // The referee prepares the scene independently of the renderers.
        progress.stage("referee: preparing");
        let start = Instant::now();
        let mesh = subject.scene.mesh();
        let tree = self.tree.take().filter(|tree| tree.fits(mesh)).unwrap_or_else(|| RefereeTree::new(mesh));
        let judge = Judge::on(&subject.scene, &tree, share);
        self.tree = Some(tree.clone());
        stages.push(Stage { name: "referee: preparing".into(), time: start.elapsed() });

        // Attribute errors to the paper's approximations.
        for side in rendered.iter_mut().filter(|side| side.approximations != Switches::EXACT) {
            let what = format!("attributing {}", side.name);
            progress.stage(&what);
            let start = Instant::now();
            side.attributions = attribute(&judge, &side.output, side.approximations, side.precision);
            stages.push(Stage { name: what, time: start.elapsed() });
        }

        // Compare every pair, and judge the differences.
        let mut pairs = Vec::new();
        for a in 0..rendered.len() {
            for b in a + 1..rendered.len() {
                let what = format!("{} against {}: comparing", rendered[a].name, rendered[b].name);
                progress.stage(&what);
                let start = Instant::now();
                let sensors = compare_judged(&judge, rendered[a].side(), rendered[b].side());
                stages.push(Stage { name: what, time: start.elapsed() });
                pairs.push(Pair { a, b, sensors });
            }
        }
        drop(judge);

        // Rays of no sensor.
        let names: Vec<String> = rendered.iter().map(|side| side.name.clone()).collect();
        let start = Instant::now();
        let ray_sets = answer_ray_sets(&subject.scene, &names, progress);
        if !ray_sets.is_empty() {
            stages.push(Stage { name: "sets of rays".into(), time: start.elapsed() });
        }
        let scoreboard = None;
        Validation {
            subject,
            rendered,
            pairs,
            tree,
            ray_sets,
            scoreboard,
            candidates_may_fail: false,
            warnings,
            allow_empty: false,
            stages,
        }
    }
}
