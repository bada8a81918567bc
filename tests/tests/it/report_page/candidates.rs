//! Rays of another program: each that does not agree has its words, in the page of `check` and in that of `validate`.

use std::path::Path;

use raypencil::harness::{Candidate, Contender, contender, validate, write_validation};
use raypencil::judge::JudgeShare;
use raypencil::pack::{PackLabel, check_pack, write_document, write_pack};
use raypencil::{Maybe, Precision, RenderOutput, Renderer, Request, Scene, Silent, Tracer};
use raypencil_tests::fixtures;

use super::Written;
use super::browser::open;

/// The row of pixels that the program gets wrong.
const ROW: u32 = 30;

/// The tracer, whose ranges are a millimetre too long in one row of pixels.
struct RowWrong(Tracer);

impl Renderer for RowWrong {
    fn name(&self) -> &str {
        "row-wrong"
    }

    fn precision(&self) -> Precision {
        self.0.precision()
    }

    fn render(&self, scene: &Scene, request: &Request) -> RenderOutput {
        let mut output = self.0.render(scene, request);
        if let Some(range) = output.camera.as_mut().and_then(|map| map.range.as_mut()) {
            for i in 0..range.width() {
                if let Some(right) = range.at(i, ROW).get() {
                    range.set(i, ROW, Maybe::some(right + 1e-3));
                }
            }
        }
        output
    }
}

/// The program's recording in the folder `row-wrong` of a validation.
fn recorded() -> Written {
    let contenders = [Contender::from(RowWrong(Tracer::new()))];
    Written::new(validate(fixtures::subject(), &contenders, JudgeShare::Sample, &Silent))
}

/// Goes from ray to ray by the key `n`. Each has words in which the program has its line.
fn assert_each_has_words(page: &Path, rays: usize, command: &str) {
    let Some(page) = open(page, "", (1280, 1000)) else { return };
    page.wait("!document.getElementById('explorer').hidden");
    page.wait(&format!(
        "Number(document.querySelector('[data-ray-table]')?.getAttribute('aria-rowcount')) === {rays} + 1"
    ));
    let said = page.text("document.querySelector('[data-ray-table]').parentElement.textContent");
    assert!(said.contains(&format!("described in full: {rays}.")), "{said}");
    page.ask("document.querySelector('canvas[data-panel]').focus()");
    for _ in 0..rays {
        let before = page.ask("document.querySelector('[data-detail]')?.dataset.cell ?? null");
        page.press("n");
        page.wait(&format!(
            "(d => d && d.dataset.cell !== {before} && d.querySelector('[data-detail-probe]') !== null)\
             (document.querySelector('[data-detail]'))"
        ));
        let words = page.text("document.querySelector('[data-detail]').textContent");
        for part in ["row-wrong (candidate): defect", "range: says ", "times its bound: defect", command] {
            assert!(words.contains(part), "{part} is not in {words}");
        }
    }
    page.assert_quiet();
}

#[test]
fn every_wrong_ray_of_a_candidate_has_its_words() {
    let mut written = recorded();
    let width = written.validation.subject.scene.camera().sensor.width as usize;
    // More than the lists of the worst rays have.
    assert!(width > 20, "{width}");
    let folder = written.folder.path().join("row-wrong");

    // In `validate`.
    let candidate = Candidate::read(&folder, &written.validation.subject.scene).expect("a candidate");
    let contenders = ["scanline", "tracer"].map(|name| contender(name).expect("a renderer"));
    written.validation = validate(fixtures::subject(), &contenders, JudgeShare::Sample, &Silent);
    written.validation.evaluate(vec![candidate], &Silent);
    let pages = tempfile::tempdir().expect("a folder");
    write_validation(&written.validation, pages.path(), &Silent).expect("a report");
    assert_each_has_words(&pages.path().join("report.html"), width, "--candidate ");

    // In `check`.
    let pack = tempfile::tempdir().expect("a folder");
    write_pack(&written.validation.subject, None, &PackLabel::NONE, pack.path(), &Silent).expect("a pack");
    let checked = check_pack(pack.path(), &folder, Some(Precision::F64), &Silent);
    let checked = checked.expect("a check");
    assert!(!checked.passes());
    let pages = tempfile::tempdir().expect("a folder");
    let document = checked.document_with_pictures().expect("pictures");
    write_document(&document, pages.path()).expect("a report");
    assert_each_has_words(&pages.path().join("report.html"), width, "raypencil probe ");
}
