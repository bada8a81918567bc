//! One ray while it is judged: classes, values, and what is known of them, entered into its sensor's result.

use std::borrow::Cow;
use std::fmt::Write;

use crate::class::Class;
use crate::difference::Difference;
use crate::quantity::{Item, Quantity, name_of};
use crate::tally::{Defect, DifferingRay, SensorResult, WrongRay};
use raypencil_scene::{Place, Switches};

/// One ray while it is judged.
pub(crate) struct RayEntry<'r> {
    pub(crate) place: Place,
    result: &'r mut SensorResult,
    /// The worst class so far, and the item that was first entered with it.
    worst: Option<(Class, Item)>,
    /// Whether the referee has ruled on the ray.
    is_judged: bool,
    /// The item that is a defect whatever class is entered for it.
    forced_defect: Option<Item>,
    /// The referee's rulings in words; `None` if they are not kept.
    ruling: Option<Cow<'static, str>>,
    /// What is wrong, in words.
    notes: String,
    /// The last error beyond its bound, as a ratio.
    excess: Option<(Item, f64)>,
}

impl<'r> RayEntry<'r> {
    /// A ray of two renderers that are compared: neither rulings nor lists of places are kept.
    pub(crate) fn compared(place: Place, result: &'r mut SensorResult) -> Self {
        Self {
            place,
            result,
            worst: None,
            is_judged: false,
            forced_defect: None,
            ruling: None,
            notes: String::new(),
            excess: None,
        }
    }

    /// A ray of a recording that is checked: its rulings are kept in words.
    pub(crate) fn checked(place: Place, result: &'r mut SensorResult) -> Self {
        Self { ruling: Some("the true hit".into()), ..Self::compared(place, result) }
    }

    #[inline]
    pub(crate) fn class(&mut self, item: impl Into<Item>, class: Class) {
        let item = item.into();
        let class = if self.forced_defect == Some(item) { Class::Defect } else { class };
        let tally = self.result.tally(item);
        tally.by_class[class as usize] += 1;
        if self.ruling.is_some() && class != Class::Agree {
            tally.others.push((self.place, class));
        }
        if class >= Class::Undecided {
            let ratio = self.excess.filter(|(of, _)| *of == item).map(|(_, ratio)| ratio);
            tally.offer(WrongRay { place: self.place, ratio });
        }
        if self.worst.is_none_or(|(worst, _)| class > worst) {
            self.worst = Some((class, item));
        }
    }

    /// Enters a difference: of `class_within` if rounding explains it, else a defect.
    #[inline]
    pub(crate) fn difference(&mut self, difference: &Difference, class_within: Class) {
        if difference.is_unrepresentable && difference.is_within() {
            // A value that the file cannot hold cannot be compared.
            let tally = self.result.tally(difference.item);
            tally.not_compared += 1;
            tally.unjudged.push(self.place);
            return;
        }
        self.extremes(difference);
        if let (false, Some(ulps)) = (difference.is_within(), difference.ulps) {
            let (name, error) = (name_of(difference.item), difference.error);
            let bound = difference.bound.unwrap_or(0.0);
            self.note(&format!("{name} is off by {error:.3e}, {ulps:.4} ulp; {bound:.3e} is explained"));
        }
        self.class(difference.item, if difference.is_within() { class_within } else { Class::Defect });
    }

    /// Enters a difference into the largest ones only: its class is entered apart.
    #[inline]
    pub(crate) fn extremes(&mut self, difference: &Difference) {
        self.result.tally(difference.item).enter(difference, self.place, self.ruling.as_deref());
        if !difference.is_within() {
            self.excess = difference.ratio().map(|ratio| (difference.item, ratio));
        }
    }

    /// Enters an item that a side does not state.
    pub(crate) fn missing(&mut self, item: impl Into<Item>) {
        self.result.tally(item.into()).not_compared += 1;
    }

    /// Makes an item a defect, now or when it is entered. The first item stays.
    pub(crate) fn force_defect(&mut self, item: Option<Item>) {
        self.forced_defect = self.forced_defect.or(item);
    }

    /// Counts the ray among those that the referee rules on.
    pub(crate) fn judged(&mut self) {
        self.result.judged += u64::from(!self.is_judged);
        self.is_judged = true;
    }

    /// Counts the ray as judged, and keeps the ruling in words.
    pub(crate) fn ruled(&mut self, words: &str) {
        let earlier = self.ruling.as_deref().filter(|_| self.is_judged);
        let ruling = earlier.map_or(words.to_string(), |earlier| format!("{earlier}; {words}"));
        self.ruling = Some(ruling.into());
        self.judged();
    }

    /// The referee's rulings in words; empty if they are not kept.
    pub(crate) fn ruling(&self) -> &str {
        self.ruling.as_deref().unwrap_or_default()
    }

    /// Adds words about what is wrong.
    pub(crate) fn note(&mut self, words: &str) {
        let separator = if self.notes.is_empty() { "" } else { "; " };
        let _ = write!(self.notes, "{separator}{words}");
    }

    /// The worst class so far.
    pub(crate) fn worst(&self) -> Class {
        self.worst.map_or(Class::Agree, |(class, _)| class)
    }

    /// Counts the ray, and describes it if it is a defect or undecided. Its class and its worst item.
    ///
    /// `answers`: the answers in words, where nothing was noted.
    pub(crate) fn finish(mut self, answers: impl FnOnce() -> String) -> (Class, Item) {
        if let Some(item) = self.forced_defect
            && self.worst() < Class::Defect
        {
            // Nothing of that item was compared between the sides.
            self.class(item, Class::Defect);
        }
        let Self { place, result, worst, ruling, notes, .. } = self;
        let Some((class, item)) = worst else {
            result.not_compared += 1;
            return (Class::Agree, Quantity::Hit.into());
        };
        result.by_class[class as usize] += 1;
        if class != Class::Agree {
            let Place { i, j, .. } = place;
            result.differing.push(DifferingRay { i, j, class, item, causes: Switches::EXACT });
        }
        if class >= Class::Undecided {
            result.describe(|| {
                let what = ruling.map_or_else(answers, |ruling| format!("{notes} (referee: {ruling})"));
                Defect { place, item, what }
            });
        }
        (class, item)
    }
}
