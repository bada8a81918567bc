//! Answers that say which rays hit, and no more: nothing else of them can be right or wrong.

use raypencil_judge::Class;
use raypencil_pack::ItemFindings;
use raypencil_report::count;

use super::check::RayPackChecked;

/// What a program tells of a hit beside that there is one.
const VALUES: [&str; 3] = ["face", "t", "range"];

impl RayPackChecked {
    /// Whether nothing is stated but which rays hit.
    fn has_only_hits(&self) -> bool {
        let stated = &self.stated;
        let has_value =
            stated.face.is_some() || stated.t.is_some() || stated.range.is_some() || stated.point.is_some();
        stated.hit.is_some() && !has_value && self.cloud.is_none()
    }

    /// That all hits are right and no more is known, as a right hit alone is no exact answer.
    pub(super) fn hits_alone(&self) -> Option<String> {
        if !self.has_only_hits() || !self.comparison.passes() {
            return None;
        }
        let rays = match self.comparison.verdicts.len() as u64 {
            1 => "1 ray hits or misses".to_string(),
            all => format!("{} rays hit or miss", count(all)),
        };
        Some(format!(
            "{rays} as the exact answers say; nothing is known about face, t and range, which were not given."
        ))
    }

    /// What was not compared, as a note.
    pub(super) fn absent_note(&self) -> Option<String> {
        self.has_only_hits().then(|| format!("Not compared, because not given: {}", VALUES.join(", ")))
    }

    /// The same as items, which are otherwise as that of the hits.
    pub(super) fn absent<'a>(&self, hits: &'a ItemFindings) -> impl Iterator<Item = ItemFindings> + use<'a> {
        let names = if self.has_only_hits() { &VALUES[..] } else { &[] };
        names.iter().map(|name| ItemFindings {
            key: (*name).into(),
            name: (*name).into(),
            not_given: Some("not given"),
            by_class: [0; Class::COUNT],
            ..hits.clone()
        })
    }
}
