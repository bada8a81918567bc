use crate::bounds::Bounds;
use crate::class::{CLASSES, Class, QUANTITIES, Quantity};
use crate::compare::answer::Answer;
use crate::compare::light::PencilLight;
use crate::tally::{ApproximationTallies, Defect, Tally, Worst};
use raypencil_scene::Maybe;
use raypencil_scene::Place;

/// One row's or one sensor's results while they are gathered.
#[derive(Default)]
pub(crate) struct Gathered {
    pub(crate) by_class: [u64; CLASSES],
    pub(crate) judged: u64,
    pub(crate) approximations: ApproximationTallies,
    pub(crate) tallies: [Tally; QUANTITIES],
    /// What pencils deliver that either side says it sees.
    pub(crate) light: Vec<PencilLight>,
    pub(crate) defects: Vec<Defect>,
    pub(crate) differences: Vec<Maybe<f64>>,
}

/// One ray while it is compared.
pub(crate) struct Entry<'r> {
    pub(super) place: Place,
    pub(crate) row: &'r mut Gathered,
    pub(crate) worst: (Class, Quantity),
    /// Whether the referee has ruled on it.
    pub(crate) is_judged: bool,
    /// A quantity of which one side says what its own face does not have: a defect, whatever the other says.
    pub(crate) spoilt: Option<Quantity>,
}

impl Entry<'_> {
    /// Enters the class of one quantity.
    pub(super) fn class(&mut self, quantity: Quantity, class: Class) {
        let class = if self.spoilt == Some(quantity) { Class::Defect } else { class };
        self.row.tallies[quantity as usize].by_class[class as usize] += 1;
        if class > self.worst.0 {
            self.worst = (class, quantity);
        }
    }

    /// Enters a difference and the bound it must keep to; without one only exactness agrees.
    pub(super) fn value(&mut self, quantity: Quantity, difference: f64, bound: Option<f64>) -> Class {
        // The same number agrees even where no bound can be told.
        let agrees = difference == 0.0 || difference <= bound.unwrap_or(0.0);
        let class = if agrees { Class::Agree } else { Class::Defect };
        self.class(quantity, class);
        self.extremes(quantity, difference, bound);
        class
    }

    /// Enters a difference whose class is known.
    pub(super) fn extremes(&mut self, quantity: Quantity, difference: f64, bound: Option<f64>) {
        let tally = &mut self.row.tallies[quantity as usize];
        Worst::keep(&mut tally.worst_error, difference, self.place);
        if let Some(bound) = bound {
            // 0 / 0 is no error at all.
            let ratio = if difference == 0.0 { 0.0 } else { difference / bound };
            Worst::keep(&mut tally.worst_ratio, ratio, self.place);
        }
    }

    /// Enters a quantity that one side does not say.
    pub(super) fn missing(&mut self, quantity: Quantity) {
        self.row.tallies[quantity as usize].not_compared += 1;
    }

    /// Makes a quantity a defect, now or when it is entered.
    pub(super) fn spoil(&mut self, quantity: Option<Quantity>) {
        self.spoilt = self.spoilt.or(quantity);
    }

    /// Counts a ray that the referee rules on.
    pub(super) fn judged(&mut self) {
        self.row.judged += u64::from(!self.is_judged);
        self.is_judged = true;
    }

    /// The worst class so far.
    pub(super) fn worst(&self) -> Class {
        self.worst.0
    }
}

/// What both sides say of a ray's geometry, as far as it concerns their light.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Geometry {
    /// What each side hits.
    pub(super) answers: [Answer; 2],
    /// What came of it.
    pub(super) class: Class,
    /// Whether both name the same face.
    pub(super) same_face: bool,
    /// How far each side may be off.
    pub(super) bounds: Option<[Bounds; 2]>,
}
