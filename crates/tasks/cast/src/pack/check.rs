//! A candidate against a pack of rays.

use std::collections::BTreeMap;
use std::path::Path;

use raypencil_files::{Fault, FileError, Limits, RayArray, quoted, ray_rows, read_npy_numbers};
use raypencil_referee::ExactCast;
use raypencil_scene::{CastRay, FaceId, Precision, Progress, Sides, Triangles};

use super::PACK_NAME;
use super::arrays::{axes, constants, orders};
use super::candidate::{CandidateConventions, read_candidate};
use super::clouds::{BeamQuestion, CloudCase, CloudFacts, is_cloud, of_cloud, read_cloud_of};
use super::decimals::decimals;
use super::explain::explain;
use super::kept_answers::{MAX_COUNTED, refuse_other_answers};
use super::lengths::lengths;
use super::mistakes::OfArrays;
use super::moved::shifts;
use super::read::RayPack;
use super::scan::Scan;
use super::trial::Trial;
use super::unread::unread;
use super::write::RayPackCounts;
use crate::answers::{Answers, Questions, cast_with};
use crate::comparison::{Comparison, Stated, Wrong, compare_with};

/// A candidate, checked.
#[derive(Debug, Clone, PartialEq)]
pub struct RayPackChecked {
    /// The candidate's name: that of its folder.
    pub name: String,
    /// The folder of the pack, as it was given; of a scene without a pack its name.
    pub pack: String,
    /// SHA-256 of its `raypack.json`, which has the digest of every other file; of a scene without a pack that of the scene.
    pub pack_sha256: String,
    /// The command that asks rays on the mesh; `--ray` follows.
    pub cast_command: String,
    /// What became of its rays.
    pub comparison: Comparison,
    /// What explains why it is wrong, as one sentence. It changes no verdict.
    pub why: Option<String>,
    /// The mesh of the pack; `None`: the rays are asked of a scene without a pack.
    pub mesh: Option<Triangles>,
    /// What is known of a sensor's scan; `None`: the rays are of no set.
    pub(in crate::pack) scan: Option<Scan>,
    /// The rays of the pack.
    pub rays: RayArray,
    /// The exact answers.
    pub answers: Answers,
    /// What the candidate says.
    pub stated: Stated,
    /// Whether only fronts of faces are asked for.
    pub fronts_only: bool,
    /// What was read of a point cloud; `None`: the candidate is a folder of arrays.
    pub cloud: Option<CloudFacts>,
    /// Arrays of the folder that were not read, in words.
    pub unread: Vec<String>,
}

impl RayPackChecked {
    /// Whether no ray is wrong, and some ray meets something, and each point of a cloud belongs to a ray by
    /// all that the cloud says of it.
    pub fn passes(&self) -> bool {
        self.comparison.passes()
            && self.cloud.as_ref().is_none_or(|cloud| {
                cloud.strays.is_empty() && cloud.wrong_keys.is_empty() && cloud.wrong_numbers.is_empty()
            })
    }

    /// The command that shows everything about the ray with this index.
    pub fn ray_command(&self, index: usize) -> String {
        let (_, numbers) = ray_rows(&self.rays.rays[index..=index]);
        let numbers: Vec<String> = numbers.iter().map(f64::to_string).collect();
        let fronts = if self.fronts_only { " --fronts-only" } else { "" };
        format!("{} --ray={}{fronts} --all --margins", self.cast_command, numbers.join(","))
    }
}

/// A mesh with the trees of its exact answers, and which of its sides are hit.
#[derive(Debug, Clone, Copy)]
pub struct CastGround<'a> {
    /// The mesh.
    pub mesh: &'a Triangles,
    /// Exact answers on that mesh.
    pub exact: &'a ExactCast<'a>,
    /// Which sides of a face are hit.
    pub sides: Sides,
}

/// Who asks rays.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct AskedBy {
    /// See [`RayPackChecked::pack`].
    pub name: String,
    /// See [`RayPackChecked::pack_sha256`].
    pub sha256: String,
    /// See [`RayPackChecked::cast_command`].
    pub cast_command: String,
}

/// Checks what the candidate of this name states of rays, by the rule of every pack of rays.
pub fn check_stated_rays(
    asked_by: AskedBy,
    (ground, rays): (CastGround<'_>, RayArray),
    (name, stated): (String, Stated),
    precision: Precision,
    progress: &dyn Progress,
) -> RayPackChecked {
    let judged = judge(ground, &rays, (&stated, None), precision, progress);
    judged.checked(asked_by, (rays, ground.sides), (name, stated), (None, None))
}

/// Checks a candidate against a pack of rays: a folder of arrays, or a point cloud: PCD, PLY or of a bag. The answers are computed again: only the question is read
/// from the pack.
///
/// ```
/// use raypencil_cast::{
///     CandidateConventions, CastSource, check_ray_pack, rays_from_bytes, write_ray_pack,
/// };
/// use raypencil_scene::{Precision, Sides, Silent, Triangles};
///
/// let corners = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
/// let mesh = Triangles::new(corners, vec![[0, 1, 2]])?;
/// let rays = rays_from_bytes(b"0.25,0.25,1,0,0,-1\n2,2,1,0,0,-1", "here".as_ref())?;
/// let source = CastSource { mesh: "mine".into(), rays: "mine".into(), ..CastSource::default() };
/// let folder = tempfile::tempdir()?;
/// let counts = write_ray_pack(folder.path(), (&mesh, &rays, Sides::Both), &source, &Silent)?;
/// assert_eq!((counts.hits, counts.misses, counts.t_min), (1, 1, 0));
/// // A pack is a candidate that is right.
/// let conventions = CandidateConventions::default();
/// let checked = check_ray_pack(folder.path(), folder.path(), Precision::F64, conventions, &Silent)?;
/// assert!(checked.passes());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// A pack whose files are not those that it lists, or whose first hits are not the exact ones; an array that cannot be read or has another shape; a candidate that
/// does not say which rays hit; a cloud that cannot be read, or whose points cannot be laid on the rays.
pub fn check_ray_pack(
    pack: &Path,
    candidate: &Path,
    precision: Precision,
    conventions: CandidateConventions<'_>,
    progress: &dyn Progress,
) -> Result<RayPackChecked, FileError> {
    progress.stage(&format!("{}: reading", pack.display()));
    let RayPack { mesh, rays, sides, scan, counts, sha256: pack_sha256 } = RayPack::read(pack)?;
    let exact = ExactCast::new(&mesh);
    let ground = CastGround { mesh: &mesh, exact: &exact, sides };
    let returns = scan.as_ref().and_then(|scan| Some((scan, scan.returns.as_ref()?)));
    // A cloud of beams with a width is held to their returns.
    let question = match returns.filter(|_| is_cloud(candidate)) {
        None => None,
        Some(returns) => {
            let answers = cast_with(&exact, &rays.rays, sides, Questions::default(), progress);
            refuse_other_answers(pack, &rays, &answers, (&exact, sides), progress)?;
            refuse_other_counts(pack, &counts, (&exact, &rays.rays, sides), &answers)?;
            let question = BeamQuestion::of(&rays, returns, answers.first);
            refuse_other_returns(pack, &question)?;
            Some(question)
        }
    };
    let (asked, beams) = match &question {
        Some(question) => ((&question.rays, Some(&question.scan)), Some(&question.beams)),
        None => ((&rays, scan.as_ref()), None),
    };
    let (asked, of_scan) = asked;
    let mut case = match is_cloud(candidate) {
        true => {
            let of_rays = (asked.shape.as_slice(), asked.rays.as_slice());
            Some(read_cloud_of(candidate, of_rays, (of_scan, beams), conventions)?)
        }
        false => None,
    };
    let mut stated = match &case {
        Some(case) => case.stated(),
        None => read_candidate(candidate, &rays.shape, conventions)?,
    };
    let mut excused = None;
    if let (Some(case), Some(beams)) = (&mut case, beams) {
        let wrong_numbers = &mut case.facts.wrong_numbers;
        *wrong_numbers = beams.closed(wrong_numbers, (&exact, &mesh, sides), precision);
        let comparison = compare_with(&exact, &mesh, case.rays, sides, &stated, precision);
        excused = Some(beams.excused(
            (case.rays, &case.part),
            (&stated, &comparison),
            (&exact, &mesh, sides),
            precision,
        ));
    }
    if let (Some(case), Some(excused)) = (&mut case, &excused) {
        case.rays = excused;
        stated = case.stated();
    }
    let asked = match &excused {
        Some(excused) => RayArray { shape: asked.shape.clone(), rays: excused.clone() },
        None => asked.clone(),
    };
    let judged = judge(ground, &asked, (&stated, case), precision, progress);
    let (rays, scan) = match question {
        Some(question) => (asked, Some(question.scan)),
        None => {
            refuse_other_answers(pack, &rays, &judged.answers, (&exact, sides), progress)?;
            refuse_other_counts(pack, &counts, (&exact, &rays.rays, sides), &judged.answers)?;
            (rays, scan)
        }
    };
    let name = candidate.file_name().map_or_else(|| ".".into(), |name| name.to_string_lossy().into_owned());
    let pack = pack.display().to_string();
    let asked_by = AskedBy {
        cast_command: format!("raypencil cast {}", quoted(&pack)),
        name: pack,
        sha256: pack_sha256,
    };
    let checked = judged.checked(asked_by, (rays, sides), (name, stated), (Some(mesh), scan));
    Ok(RayPackChecked { unread: unread(candidate), ..checked })
}

/// Refuses counts of rays that are not those of the pack. Those of a large pack are compared as far as they follow from its first hits.
fn refuse_other_counts(
    pack: &Path,
    stated: &BTreeMap<String, u64>,
    (exact, rays, sides): (&ExactCast<'_>, &[CastRay], Sides),
    answers: &Answers,
) -> Result<(), FileError> {
    let (counts, known) = match rays.len() <= MAX_COUNTED {
        true => (RayPackCounts::of(exact, rays, sides).by_key(), RayPackCounts::KEYS),
        false => (RayPackCounts::of_first(&answers.first).by_key(), RayPackCounts::KEYS_OF_FIRST),
    };
    let path = pack.join(PACK_NAME);
    let refused = |key: &str, found: u64, expected: String| {
        let fault = Fault::new(format!("counts.{key}"), found.to_string(), expected);
        Err(FileError::Array(fault.in_file(&path)))
    };
    for (key, found) in stated {
        match counts.iter().position(|(own, _)| key == own) {
            None => return refused(key, *found, "no such count".into()),
            Some(at) if at < known && counts[at].1 != *found => {
                return refused(key, *found, format!("{}, as the rays give", counts[at].1));
            }
            Some(_) => {}
        }
    }
    Ok(())
}

/// What was found of rays.
struct Judged {
    comparison: Comparison,
    why: Option<String>,
    answers: Answers,
    cloud: Option<CloudFacts>,
}

impl Judged {
    fn checked(
        self,
        AskedBy { name: pack, sha256: pack_sha256, cast_command }: AskedBy,
        (rays, sides): (RayArray, Sides),
        (name, stated): (String, Stated),
        (mesh, scan): (Option<Triangles>, Option<Scan>),
    ) -> RayPackChecked {
        let Self { comparison, why, answers, cloud } = self;
        let fronts_only = sides == Sides::Fronts;
        RayPackChecked {
            name,
            pack,
            pack_sha256,
            cast_command,
            comparison,
            why,
            mesh,
            scan,
            rays,
            answers,
            stated,
            fronts_only,
            cloud,
            unread: Vec::new(),
        }
    }
}

/// Judges stated answers, and those of a cloud with what the cloud says beside them.
fn judge(
    CastGround { mesh, exact, sides }: CastGround<'_>,
    RayArray { shape, rays }: &RayArray,
    (stated, case): (&Stated, Option<CloudCase<'_>>),
    precision: Precision,
    progress: &dyn Progress,
) -> Judged {
    progress.stage(&format!("comparing {} rays", rays.len()));
    let comparison = compare_with(exact, mesh, rays, sides, stated, precision);
    let wrong: Vec<usize> = comparison.wrong().map(|(index, _)| index).collect();
    // A ray that rightly misses cannot be wrong for saying nothing.
    let is_lost = |wrong: &Wrong| match wrong {
        Wrong::Hit { exact, .. } | Wrong::Something { exact } => exact.hit().is_some(),
        _ => false,
    };
    let is_silent = says_nothing(stated, rays.len()) && comparison.wrong().all(|(_, wrong)| is_lost(&wrong));
    // Truth values alone say too little of each ray: any mistake may explain a few of them.
    let is_telling = [stated.face.is_some(), stated.t.is_some(), stated.range.is_some()].contains(&true);
    // Where rounding may make anything of a length up to its own size, any mistake explains one that is too long.
    let says_where = |&index: &usize| {
        let (ray, read) = (&rays[index], exact.reading(&rays[index], sides));
        let is_needle = |face: FaceId| {
            let range = exact.meeting(ray, face).map_or(f64::INFINITY, |hit| hit.range().double);
            exact.range_error(ray, face, precision) >= range
        };
        !read.hit().is_some_and(|faces| faces.iter().all(|face| is_needle(*face)))
    };
    let is_telling = is_telling && wrong.iter().any(says_where);
    let why = (!wrong.is_empty() && !is_silent && is_telling).then(|| {
        progress.stage("looking for a mistake that explains the wrong rays");
        let of_cloud = case.as_ref().map(|case| of_cloud(case, exact, sides));
        let stated = (stated, of_cloud.as_ref());
        let numbers = |trial: &Trial| {
            let mut found = lengths(trial, exact, sides);
            found.extend(decimals(trial));
            found.extend(shifts(trial, exact));
            found.extend(constants(trial, exact, sides));
            found
        };
        let (orders, axes) = match case {
            None => (orders(stated.0, shape), axes(stated.0)),
            Some(_) => (Vec::new(), Vec::new()),
        };
        let of_arrays = OfArrays { numbers: &numbers, orders: &orders, alone: &axes };
        let explanation = explain(exact, mesh, (rays, sides), stated, &of_arrays, precision, &wrong)?;
        let sentence = explanation.sentence();
        let beside = case.as_ref().zip(stated.1).map_or_else(String::new, |(case, of_cloud)| {
            let is_laid = explanation.mistakes.iter().any(|words| {
                of_cloud.laid.contains(words) || words.contains("channels") || words.contains("returns")
            });
            case.facts.beside(&sentence, is_laid)
        });
        Some(sentence + &beside)
    });
    let answers = cast_with(exact, rays, sides, Questions::default(), progress);
    let cloud = case.map(|case| {
        let bare = (case.facts.steps.is_some() && wrong.is_empty()).then(|| case.stated_as_if_exact());
        let excused = |bare| compare_with(exact, mesh, rays, sides, &bare, precision).counts().wrong;
        CloudFacts { excused: bare.map_or(0, excused), ..case.facts }
    });
    let of_fields = cloud.as_ref().and_then(CloudFacts::why);
    let why = match why {
        // Whatever makes every ray a miss would explain it.
        None if is_silent && !wrong.is_empty() => Some("every ray is a miss: nothing at all is hit".into()),
        Some(sentence) => sentence,
        None => of_fields.map(|words| format!("100.0000 % agree if {words}")),
    };
    Judged { comparison, why, answers, cloud }
}

/// Whether every ray is said to miss.
fn says_nothing(stated: &Stated, count: usize) -> bool {
    let is_near = |ray: usize| {
        [&stated.t, &stated.range].into_iter().flatten().any(|lengths| lengths[ray] == f64::NEG_INFINITY)
    };
    (0..count).all(|ray| !stated.speaks(ray).1 && !is_near(ray))
}

/// Refuses a pack whose own returns are not the exact ones.
fn refuse_other_returns(pack: &Path, question: &BeamQuestion) -> Result<(), FileError> {
    let exact = question.beams.numbers();
    let path = pack.join("return.number.npy");
    let kept = read_npy_numbers(&path, &Limits::default())?.values;
    let is_same = |(kept, exact): (&f64, &u32)| *kept == f64::from(*exact);
    if kept.len() == exact.len() && kept.iter().zip(exact).all(is_same) {
        return Ok(());
    }
    let expected = "the returns that `raypencil pack --rays` writes: make the pack again";
    Err(FileError::Array(Fault::new("returns", "others than the exact ones", expected).in_file(&path)))
}
