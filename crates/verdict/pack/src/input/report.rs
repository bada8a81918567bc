//! A check of a loader's triangles in the form of every check.

use raypencil_judge::Class;
use raypencil_report::{DefectLine, Document, counted};
use serde_json::json;

use crate::check_report::{BundleFindings, CheckFindings, ItemFindings, PackForm, Said, WrongRay};
use crate::input::check::{InputChecked, WrongFace};
use crate::input::clause::LoadingClause;
use crate::published::PackLabel;

/// Wrong faces that are listed, at most.
const MAX_LISTED: usize = 40;

impl InputChecked {
    /// The check for every report.
    pub fn document(&self) -> Document {
        findings(self).document()
    }
}

fn findings(checked: &InputChecked) -> CheckFindings {
    let item = |clause: &LoadingClause| {
        let (faces, wrong) = checked.of(*clause);
        let mut by_class = [0; Class::COUNT];
        by_class[Class::Defect as usize] = wrong as u64;
        by_class[Class::Agree as usize] = faces.saturating_sub(wrong) as u64;
        ItemFindings {
            key: clause.key().into(),
            name: clause.key().into(),
            unit: "",
            storage: None,
            not_given: None,
            by_class,
            not_compared: 0,
            worst_ulp: None,
            worst_error: None,
            worst_ratio: None,
        }
    };
    let items: Vec<ItemFindings> = LoadingClause::ALL.iter().map(item).collect();
    let by_class = std::array::from_fn(|k| items.iter().map(|item| item.by_class[k]).sum());
    // The first wrong face of each clause, then the others: a mistake shows in what it breaks.
    let is_first = |(index, wrong): &(usize, &WrongFace)| {
        checked.wrong[..*index].iter().all(|earlier| earlier.truth.clause != wrong.truth.clause)
    };
    let (first, later): (Vec<_>, Vec<_>) = checked.wrong.iter().enumerate().partition(is_first);
    let listed: Vec<WrongRay> =
        first.into_iter().chain(later).take(MAX_LISTED).map(|(_, wrong)| wrong_face(wrong)).collect();
    let bundle = BundleFindings {
        name: "triangles".into(),
        // Triangles are given, whatever they are.
        hits_anything: true,
        must_hit: false,
        by_class,
        not_compared: 0,
        ruled: checked.wrong.len() as u64,
        items: items.clone(),
        listed: listed.clone(),
        why: None,
        coarseness: None,
    };
    let reflectivity = match checked.has_reflectivity {
        true => None,
        false => Some("Reflectivities are not given.".to_string()),
    };
    let triangles = json!({
        "faces": checked.faces, "given": checked.given, "reflectivity_given": checked.has_reflectivity,
    });
    CheckFindings {
        form: PackForm::Triangles,
        pack: "input".into(),
        pack_remark: "",
        pack_sha256: checked.pack_sha256.clone(),
        label: PackLabel::NONE,
        is_published: false,
        has_answers: false,
        candidate: checked.name.clone(),
        arithmetic: None,
        bundles: vec![bundle],
        totals: items,
        worst: listed.into_iter().map(|wrong| wrong.line).collect(),
        coarseness: None,
        headline: Some(headline(checked)),
        why: None,
        notes: reflectivity.into_iter().collect(),
        sharpness: None,
        sizes: None,
        facts: vec![("Faces given", checked.given.to_string())],
        of_form: [("triangles".to_string(), triangles)].into_iter().collect(),
        pictures: String::new(),
        explorer: String::new(),
    }
}

/// A wrong face, for people and for programs.
fn wrong_face(wrong: &WrongFace) -> WrongRay {
    let WrongFace { face, truth, corners, reflectivity } = wrong;
    let (said, exact) = match (corners, reflectivity) {
        (None, _) => ("nothing".to_string(), format!("{:?}", truth.corners)),
        (Some(_), Some(said)) => (format!("the reflectivity {said}"), truth.reflectivity.to_string()),
        (Some(said), None) => (format!("{said:?}"), format!("{:?}", truth.corners)),
    };
    let (key, what) = (truth.clause.key(), truth.clause.sentence());
    let line = DefectLine {
        place: format!("face {face}"),
        quantity: key.into(),
        words: format!("is given as {said}; true is {exact}"),
        what: what.into(),
        ..DefectLine::default()
    };
    let said = Said { who: "given", value: said, exact: Some(exact), what, ..Said::default() };
    WrongRay::of_list("triangles", *face, key, &said, line)
}

/// The verdict in one sentence.
fn headline(checked: &InputChecked) -> String {
    let faces = counted(checked.faces as u64, "face", "faces");
    match (checked.wrong.len(), checked.given == checked.faces) {
        (0, true) => format!("{faces}: all are right."),
        (0, false) => format!("{faces} are right, and there are {} in all.", checked.given),
        (wrong, _) => format!("{wrong} of {faces} are wrong; {} are given.", checked.given),
    }
}
