//! A wrong renderer that is drawn, and whether what is told of it is true.

use super::*;

/// A wrong renderer.
pub struct Wrong {
    pub candidate: Recorded,
    /// What was made of which sensor, in words.
    pub made: Vec<(SensorId, &'static str)>,
    /// What is true of each sensor.
    truth: Vec<(SensorId, Vec<Mistake>)>,
}

/// The hits alone: light follows them in ways of its own.
pub fn hits_of(bench: &Bench) -> Recorded {
    let mut candidate = bench.exact.clone();
    let is_hit = |quantity: Quantity| {
        matches!(
            quantity,
            Quantity::Face
                | Quantity::Range
                | Quantity::Depth
                | Quantity::Point
                | Quantity::Normal
                | Quantity::CosIncidence
        )
    };
    candidate.storage.retain(|(_, item), _| is_hit(item.quantity));
    for light in &mut candidate.answers.light {
        (light.image, light.other_image, light.other_flux) = (None, None, None);
        let (columns, rows) = (light.returns.columns, light.returns.rows);
        light.returns = raypencil_scene::Returns::unsupported(columns, rows);
    }
    candidate
}

impl Wrong {
    pub fn right(bench: &Bench) -> Self {
        Self { candidate: hits_of(bench), made: Vec::new(), truth: Vec::new() }
    }

    /// Leaves a quantity out.
    pub fn without(&mut self, quantity: Quantity) {
        self.candidate.storage.retain(|(_, item), _| item.quantity != quantity);
        for map in &mut self.candidate.answers.maps {
            match quantity {
                Quantity::Face => map.face = None,
                Quantity::Range => map.range = None,
                Quantity::Depth => map.depth = None,
                Quantity::Point => map.point = None,
                Quantity::Normal => map.normal = None,
                _ => map.cos_incidence = None,
            }
        }
    }

    /// Makes a mistake in a sensor. Rays that are cast otherwise forget what was made before: they come first.
    pub fn make(&mut self, bench: &Bench, (name, make): Make, sensor: SensorId, random: &mut Random) {
        let index = match sensor {
            SensorId::Camera => 0,
            SensorId::Beam(beam) => beam + 1,
        };
        let map = &mut self.candidate.answers.maps[index];
        let true_of_it = make(&mut Making { bench, sensor, map, random });
        self.made.push((sensor, name));
        self.truth.push((sensor, true_of_it));
    }

    /// The candidate as a file of single precision.
    pub fn store_single(&mut self) {
        self.candidate = super::super::candidates::stored_single(&self.candidate);
    }

    /// The first reason that is not true; `None` if all are.
    pub fn false_reason(&self, found: Option<&Diagnosis>) -> Option<String> {
        let is_false = |reason: &&Reason| {
            !reason.sensors.iter().all(|sensor| {
                reason.mistakes.iter().all(|told| {
                    let of_sensor = self.truth.iter().filter(|(of, _)| of == sensor);
                    of_sensor.clone().flat_map(|(_, all)| all).any(|one| is_same(one, told))
                        || is_sum(of_sensor.clone().map(|(_, all)| all.as_slice()), told)
                        || is_turn_of_all(of_sensor.clone().map(|(_, all)| all.as_slice()), told)
                        || is_line_of_all(of_sensor.clone().map(|(_, all)| all.as_slice()), told)
                        || is_alike(of_sensor.clone().map(|(_, all)| all.as_slice()), reason, told)
                        || is_copied_plane(of_sensor.map(|(_, all)| all.as_slice()), told)
                })
            })
        };
        let reason = found?.reasons.iter().find(is_false)?;
        Some(format!("made {:?}, told: {}", self.made, reason.sentence()))
    }
}

/// By how many cells the rays are off, of mistakes that say so.
fn cells_off(mistake: &Mistake) -> Option<[f64; 2]> {
    match mistake {
        Mistake::Shifted { columns, rows } => Some([-f64::from(*columns), -f64::from(*rows)]),
        Mistake::PrincipalPoint { stated, truth } => Some([truth[0] - stated[0], truth[1] - stated[1]]),
        Mistake::CornerRays { columns, rows } => Some([*columns, *rows]),
        _ => None,
    }
}

/// Whether what is told is all that several mistakes come to: a shift and another principal point are a third one.
fn is_sum<'m>(made: impl Iterator<Item = &'m [Mistake]>, told: &Mistake) -> bool {
    let mut sum = [0.0; 2];
    for [dx, dy] in made.filter_map(|all| all.iter().find_map(cells_off)) {
        sum = [sum[0] + dx, sum[1] + dy];
    }
    cells_off(told).is_some_and(|told| (0..2).all(|k| (told[k] - sum[k]).abs() < 1e-3))
}

/// Whether what is told is the factor and the offset that several of them come to.
fn is_line_of_all<'m>(made: impl Iterator<Item = &'m [Mistake]>, told: &Mistake) -> bool {
    let line = |mistake: &Mistake| match mistake {
        Mistake::Affine { factor, offset, .. } => Some([*factor, *offset]),
        _ => None,
    };
    let then = |[f, o]: [f64; 2], [factor, offset]: [f64; 2]| [factor * f, factor * o + offset];
    let [factor, offset] = made.filter_map(|all| all.iter().find_map(line)).fold([1.0, 0.0], then);
    let is_near = |a: f64, b: f64| (a - b).abs() <= 0.01 * b.abs();
    // A hundredth of what it is off by.
    line(told).is_some_and(|[f, o]| {
        is_near(f - 1.0, factor - 1.0) && (is_near(o, offset) || (o - offset).abs() < 1e-9)
    })
}

/// Whether what is told says the same in other words of all that was made, and each wrong ray agrees.
///
/// Within one power of two half precision is a grid. Half a quantum more and rounding down is rounding to the nearest. The depth is a
/// number times the ray's t, so that a line of one is a line of the other. One row up and one row down leave a border that is doubled.
fn is_alike<'m>(made: impl Iterator<Item = &'m [Mistake]> + Clone, reason: &Reason, told: &Mistake) -> bool {
    let has = |is: &dyn Fn(&Mistake) -> bool| made.clone().flatten().any(is);
    let is_whole = reason.explained == reason.wrong && reason.broken == 0;
    // Another unit is a factor, too.
    let is_line = |one: &Mistake| matches!(one, Mistake::Affine { of: Length::Range, .. } | Mistake::Unit(_));
    let shifts = made.clone().filter_map(|all| all.iter().find_map(cells_off));
    match told {
        Mistake::Rounded { quantum, .. } if has(&|one| matches!(one, Mistake::HalfPrecision(_))) => {
            let in_units = made.clone().flatten().filter_map(|one| match one {
                Mistake::Unit(unit) => Some(quantum / unit.to_metres(1.0)),
                _ => None,
            });
            let mut quanta = in_units.chain([*quantum]);
            is_whole && quanta.any(|quantum| quantum.to_bits().trailing_zeros() >= 52)
        }
        // What another beam holds is what this one would, stood where that one stands.
        Mistake::Posed { .. } => is_whole && has(&|one| matches!(one, Mistake::HoldsBeam(_))),
        // Lengths in another unit, which were rounded to a quantum of that unit.
        Mistake::Rounded { of, quantum, down }
            if made.clone().flatten().any(|one| matches!(one, Mistake::Unit(_))) =>
        {
            let units = made.clone().flatten().filter_map(|one| match one {
                Mistake::Unit(unit) => Some(*unit),
                _ => None,
            });
            is_whole
                && units.clone().any(|unit| {
                    has(&|one| {
                        matches!(one, Mistake::Rounded { of: other, quantum: own, down: way }
                            if other == of && way == down && (unit.to_metres(*own) - quantum).abs() <= 1e-9 * quantum)
                    })
                })
        }
        Mistake::Rounded { of, quantum, down: false } => {
            let is_down = |one: &Mistake| matches!(one, Mistake::Rounded { of: other, quantum: own, down: true } if (other, own) == (of, quantum));
            let is_half = |one: &Mistake| {
                matches!(one, Mistake::Affine { of: other, factor: 1.0, offset }
                    if other == of && (offset - 0.5 * quantum).abs() < 0.05 * quantum)
            };
            has(&is_down) && has(&is_half)
        }
        // One row down and then reversed is reversed and then one row up: a recording does not say which came first.
        Mistake::Shifted { columns, rows } => {
            let is_turned = |turn: Mistake, other: Mistake| {
                reason.mistakes.contains(&turn) && has(&|one| *one == turn) && has(&|one| *one == other)
            };
            is_whole
                && (is_turned(Mistake::RowsReversed, Mistake::Shifted { columns: *columns, rows: -rows })
                    || is_turned(
                        Mistake::ColumnsReversed,
                        Mistake::Shifted { columns: -columns, rows: *rows },
                    ))
        }
        Mistake::DepthForRange => {
            is_whole
                && has(&|one| *one == Mistake::ParameterForRange)
                && (has(&is_line) || has(&|one| *one == Mistake::RangeForDepth))
        }
        Mistake::Affine { of: Length::Range | Length::All, .. } => {
            is_whole
                && reason.mistakes.contains(&Mistake::DepthForRange)
                && has(&|one| *one == Mistake::ParameterForRange)
        }
        Mistake::Cut { by: CutBy::Row | CutBy::Column, held: Held::Neighbour, lines: 1, .. } => {
            let sum = shifts.clone().fold([0.0; 2], |sum: [f64; 2], [dx, dy]| [sum[0] + dx, sum[1] + dy]);
            is_whole && shifts.count() > 1 && sum == [0.0; 2]
        }
        _ => false,
    }
}

/// Whether depths from the plane were copied to the ranges: then both begin there.
fn is_copied_plane<'m>(made: impl Iterator<Item = &'m [Mistake]>, told: &Mistake) -> bool {
    let made: Vec<&Mistake> = made.flatten().collect();
    let parts = [Mistake::FromPlane(Length::Depth), Mistake::DepthForRange];
    *told == Mistake::FromPlane(Length::All) && parts.iter().all(|part| made.contains(&part))
}

/// Whether what is told is the turn that several changes of axes come to.
fn is_turn_of_all<'m>(made: impl Iterator<Item = &'m [Mistake]>, told: &Mistake) -> bool {
    let plain = |mistake: &Mistake| match mistake {
        Mistake::AxesYUp => Some(([0, 2, 1], [1, -1, 1])),
        Mistake::AxesYUpInverse => Some(([0, 2, 1], [1, 1, -1])),
        Mistake::Axes { from, sign, .. } => Some((*from, *sign)),
        Mistake::NormalsReversed => Some(([0, 1, 2], [-1; 3])),
        // A sensor that stands at the scene's origin and looks as the scene's axes do has another frame by its axes alone.
        Mistake::SensorFrame { axes: FrameAxes::OpenGl, .. } => Some(([0, 1, 2], [1, -1, -1])),
        Mistake::SensorFrame { axes: FrameAxes::Body, .. } => Some(([1, 2, 0], [-1, -1, 1])),
        _ => None,
    };
    // Component k of what it was is `sign` times component `from` of what it became.
    let scene = [1.0, 2.0, 3.0];
    let mut stated = scene;
    for (from, sign) in made.filter_map(|all| all.iter().find_map(plain)) {
        let was = stated;
        (0..3).for_each(|k| stated[from[k]] = f64::from(sign[k]) * was[k]);
    }
    plain(told).is_some_and(|(from, sign)| (0..3).all(|k| f64::from(sign[k]) * stated[from[k]] == scene[k]))
}

/// Whether two mistakes are the same with nearly the same numbers: of numbers that were found, a hundredth may be missing.
fn is_same(made: &Mistake, told: &Mistake) -> bool {
    let parts = |mistake: &Mistake| {
        let text = format!("{mistake:?}");
        let words: Vec<String> = text
            .split(|c: char| !(c.is_ascii_alphanumeric() || matches!(c, '.' | '-' | '_')))
            .filter(|word| !word.is_empty())
            .map(str::to_string)
            .collect();
        words
    };
    // Of several sensors the first is told, whose last row has another number.
    if made.to_string() == told.to_string() {
        return true;
    }
    let (made_parts, told_parts) = (parts(made), parts(told));
    if made_parts.len() != told_parts.len() || made.key() != told.key() {
        return false;
    }
    // How much a number may differ: a hundredth of what it is off by.
    let difference = match (made, told) {
        (Mistake::FocalLength { stated, truth }, _)
        | (Mistake::Fan { stated, truth }, _)
        | (Mistake::Thickness { stated, truth }, _) => stated - truth,
        (Mistake::PixelPitch { stated, truth }, _) => {
            (stated[0] - truth[0]).abs().max((stated[1] - truth[1]).abs())
        }
        (Mistake::Affine { factor, offset: 0.0, .. }, _) => factor - 1.0,
        // A cut lies somewhere between two hits.
        (Mistake::Cut { .. }, _) => 10.0,
        _ => 1.0,
    };
    made_parts.iter().zip(&told_parts).all(|(a, b)| match (a.parse::<f64>(), b.parse::<f64>()) {
        (Ok(a), Ok(b)) => (a - b).abs() <= 0.01 * difference.abs().min(a.abs().max(1e-3)),
        _ => a == b,
    })
}

/// One draw: a mistake in one sensor or in all, alone or beside another, in a candidate that has some quantities.
pub fn draw(bench: &Bench, seed: u64) -> Wrong {
    let mut random = Random(seed);
    let mut wrong = Wrong::right(bench);
    let sensors: Vec<SensorId> = bench.scene.sensors().collect();
    let mut makes = vec![MISTAKES[random.below(MISTAKES.len())]];
    if random.below(2) == 0 {
        makes.push(MISTAKES[random.below(MISTAKES.len())]);
    }
    // Those that cast rays again come first.
    let casts =
        ["backs hit", "near plane", "nearest t", "maximum range", "corner", "pixel", "cx", "cy", "principal"];
    let more = [
        "focal",
        "width of",
        "height of",
        "both sides",
        "thickness",
        "fan",
        "another beam",
        "read as",
        "pitch",
        "yaw",
        "roll",
        "height",
        "ahead",
        "place",
        "rotation",
        "pose",
        "a face",
        "a corner",
    ];
    makes.sort_by_key(|(name, _)| !casts.iter().chain(&more).any(|start| name.contains(start)));
    let at: Vec<usize> = (0..2).map(|_| random.below(sensors.len() + 1)).collect();
    // Two that cast again in one sensor would forget one another.
    for (k, make) in makes.iter().enumerate() {
        match sensors.get(at[k]) {
            Some(sensor) => wrong.make(bench, *make, *sensor, &mut random),
            None => {
                let seed = random.next();
                for sensor in &sensors {
                    // The same numbers in all.
                    wrong.make(bench, *make, *sensor, &mut Random(seed));
                }
            }
        }
    }
    for quantity in [
        Quantity::Face,
        Quantity::Range,
        Quantity::Depth,
        Quantity::Point,
        Quantity::Normal,
        Quantity::CosIncidence,
    ] {
        if quantity != Quantity::Range && random.below(3) == 0 {
            wrong.without(quantity);
        }
    }
    if random.below(3) == 0 {
        wrong.store_single();
    }
    wrong
}
