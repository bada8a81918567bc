//! One validation, from a scene to its verdict, as one readable pass.

use std::time::Instant;

use crate::rendered::Rendered;
use crate::renderers::{Contender, attribute};
use crate::validation::{Pair, Validation};
use raypencil_judge::{Attributions, Judge, JudgeShare, compare_judged};
use raypencil_scene::{Progress, Request, Stage, Switches};
use raypencil_scene_io::Subject;

/// Renders `subject` with each of `contenders`, compares every pair, and has the referee judge what differs and
/// that `share` of what agrees.
pub fn validate(
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

    // The referee reads the scene by itself.
    progress.stage("referee: preparing");
    let start = Instant::now();
    let judge = Judge::new(&subject.scene, share);
    stages.push(Stage { name: "referee: preparing".into(), time: start.elapsed() });

    // Find what the paper's approximations did.
    for side in rendered.iter_mut().filter(|side| side.approximations != Switches::EXACT) {
        let what = format!("attributing {}", side.name);
        progress.stage(&what);
        let start = Instant::now();
        side.attributions = attribute(&judge, &side.output, side.approximations, side.precision);
        stages.push(Stage { name: what, time: start.elapsed() });
    }

    // Compare every pair, and judge.
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
    Validation { subject, rendered, pairs, panel: None, stages }
}
