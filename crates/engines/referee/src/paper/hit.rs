//! Explanations of wrong hits: whether an approximation of the paper accounts for an answer against the contract.
//!
//! A renderer that clips a beam's faces to the stripe, draws straight sides, and skips faces by the rules as printed
//! (§4, §5) loses some faces at some pencils and adds others. Its answer is *explained* if
//!
//! * the face that it names, where the ray does not meet it, is one that the approximations add here, and
//! * every face that the ray does meet before that one is lost by them here,
//!
//! each for a [`Reason`](crate::Reason).

use raypencil_scene::{FaceId, SensorId};

use crate::hits::face::{ExactRay, Face};
use crate::hits::ruling::Tolerance;
use crate::hits::verdict::{Referee, bundle};
use crate::paper::approximations::{Approximations, Explained};
use crate::paper::raster::PaperRay;
use crate::rays::ray::{Aim, MountedSensor};

impl Referee<'_> {
    /// Explains `answer`, a face or a miss, to the ray of cell (i, j) by the approximations it was made with; `None`
    /// if they do not explain it.
    pub fn explain(
        &self,
        sensor: SensorId,
        i: u32,
        j: u32,
        answer: Option<FaceId>,
        with: Approximations,
        tolerance: Tolerance,
    ) -> Option<Vec<Explained>> {
        let sensor = MountedSensor::of(self.scene, sensor)?;
        let (width, height) = sensor.size();
        let mesh = self.scene.mesh();
        if i >= width || j >= height || answer.is_some_and(|id| id.0 as usize >= mesh.faces().len()) {
            return None;
        }
        let aim = Aim { i, j, dx: 0.0, dy: 0.0 };
        let (ray, max_range) = (ExactRay::new(&sensor, aim), sensor.max_range());
        let mut met: Vec<&Face> = Vec::new();
        self.bvh.visit(&bundle(&sensor, aim, 0.0), |face| {
            if face.is_met_by(&ray, max_range) {
                met.push(face);
            }
            max_range
        });
        met.sort_by_key(|face| face.id);

        let pencil = PaperRay::new(&sensor, aim, with, tolerance);
        let answer = answer.map(|id| Face::of(mesh, id));
        let mut explained = Vec::new();
        if let Some(face) = &answer
            && !met.iter().any(|kept| kept.id == face.id)
        {
            explained.push(Explained { face: face.id, added: true, reasons: pencil.adds(face) });
        }
        for face in met {
            let is_before = answer.as_ref().is_none_or(|answer| {
                answer.id != face.id && face.range(&ray) < answer.range(&ray) - tolerance.depth
            });
            if is_before {
                explained.push(Explained { face: face.id, added: false, reasons: pencil.loses(face) });
            }
        }
        let all = !explained.is_empty() && explained.iter().all(|one| !one.reasons.is_empty());
        all.then_some(explained)
    }
}
