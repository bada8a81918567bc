//! The corrections to try: those with fixed numbers, and those whose numbers are found from the recording.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::agree::is_near;
use crate::case::Case;
use crate::channel::{Channel, Value};
use crate::correction::{Correction, FluxFactors, Table, corrected};
use crate::forward::is_rounded;
use crate::lengths::{MAX_COSINE_OF_TWO_PLANES, are_several_multiples, lengths, rounded_to};
use crate::mistake::{AngleUnit, Cosine, FrameAxes, Leg, Length, LengthUnit, Mistake, Vectors};
use crate::numbers::{middle, plainest};
use crate::tally::{MIN_CONFIRMING_RAYS, MIN_WRONG_RAYS};
use raypencil_files::Storage;
use raypencil_judge::Quantity;
use raypencil_scene::{FluxModel, HitQuantity, Image, Place, SensorId};

/// Share of the rays whose stated index must stand for its one true face. Tuned: a tie or an edge may say otherwise.
const MIN_CONSISTENT_SHARE: f64 = 0.98;

/// Rays for each stated index, on average. Tuned: with fewer, an order of faces fits anything.
const MIN_RAYS_PER_INDEX: usize = 3;

/// Rays from which an order of faces or a constant is found, at most.
const MAX_FITTED_RAYS: u64 = 1 << 17;

/// Cells with one and the same length, from which it may stand for "no hit". Tuned.
const MIN_CELLS_OF_CONSTANT: usize = 8;

/// Cells that say "no hit" beside a constant that means it: at most one for so many of these. Tuned: a NaN may be an error.
const EMPTY_ONE_IN: usize = 50;

/// Values from which a factor is found, at least; and the relative width of their middle half, at most. Tuned: the
/// values of single precision differ by less.
const MIN_VALUES_OF_FACTOR: usize = 8;
const MAX_SPREAD_OF_FACTOR: f64 = 1e-4;

/// Corrections with fixed numbers, the plainest first.
pub(crate) fn fixed(case: Case<'_>) -> Vec<Correction> {
    let scene = case.truth.scene();
    let mut mistakes = vec![Mistake::RowsReversed, Mistake::ColumnsReversed, Mistake::Transposed];
    let shifts = [(1, 0), (-1, 0), (0, 1), (0, -1)];
    mistakes.extend(shifts.map(|(columns, rows)| Mistake::Shifted { columns, rows }));
    mistakes.extend(constants(case));
    mistakes.extend([
        Mistake::FacesShifted(1),
        Mistake::FacesShifted(-1),
        Mistake::DepthForRange,
        Mistake::ParameterForRange,
        Mistake::RangeForDepth,
        Mistake::ParameterForDepth,
        Mistake::FromPlane(Length::All),
        Mistake::FromPlane(Length::Range),
        Mistake::FromPlane(Length::Depth),
        Mistake::Unit(LengthUnit::Millimetres),
        Mistake::Unit(LengthUnit::Centimetres),
        Mistake::Unit(LengthUnit::Kilometres),
        Mistake::Unit(LengthUnit::Feet),
        Mistake::Inverse(Length::All),
        Mistake::Inverse(Length::Range),
        Mistake::Inverse(Length::Depth),
        Mistake::Squared(Length::All),
        Mistake::Squared(Length::Range),
        Mistake::Squared(Length::Depth),
        Mistake::DistanceForView,
        Mistake::NormalsReversed,
        Mistake::NormalsNotUnit,
        Mistake::CosinesNegated,
        Mistake::AngleForCosine(AngleUnit::Radians),
        Mistake::AngleForCosine(AngleUnit::Degrees),
        Mistake::PixelRowsFromBottom,
        Mistake::PixelColumnsFromRight,
        Mistake::PixelsExchanged,
        Mistake::OtherFluxModel,
        Mistake::NoShadowTest,
        Mistake::HitsVisible,
        Mistake::PointsFromSensor,
    ]);
    if is_reversed_both_ways(case) {
        mistakes.push(Mistake::VisibleReversed);
    }
    mistakes.extend(other_beams(case));
    if scene.mesh().origin() != glam::DVec3::ZERO {
        mistakes.push(Mistake::GlobalFrame);
    }
    for axes in FrameAxes::ALL {
        let of = [Vectors::Both, Vectors::Points, Vectors::Normals];
        mistakes.extend(of.map(|of| Mistake::SensorFrame { of, axes }));
    }
    mistakes.extend(moved_points(case));
    mistakes.extend(rounded_points(case));
    let [incidence, off_axis, emission] = Cosine::ALL;
    for held in [
        [emission, off_axis, incidence],
        [off_axis, incidence, emission],
        [incidence, emission, off_axis],
        [off_axis, emission, incidence],
        [emission, incidence, off_axis],
    ] {
        mistakes.push(Mistake::CosinesExchanged(held));
    }
    let mut corrections: Vec<Correction> = mistakes.into_iter().map(Correction::from).collect();
    if scene.atmosphere().attenuation > 0.0 {
        for leg in [Leg::Out, Leg::Back, Leg::Neither] {
            let table = Table::Flux(Arc::new(attenuation(case, leg)));
            corrections.push(Correction { mistake: Mistake::AttenuationOn(leg), table });
        }
    }
    let channels = case.channels();
    corrections.retain(|one| {
        let touched = channels.iter().filter(|channel| one.touches(**channel));
        // Of all lengths, or of both vectors, is said only what is true of several.
        let mut quantities: Vec<Quantity> = touched.map(|channel| channel.item.quantity).collect();
        quantities.sort_unstable();
        quantities.dedup();
        quantities.len() > usize::from(one.is_of_all_lengths() || one.is_of_both_vectors())
    });
    corrections
}

/// The vector by which all points are off, where they lie in several planes: in one plane another place of the sensor says the same.
fn moved_points(case: Case<'_>) -> Option<Mistake> {
    let (mut off, mut ulp, mut largest) = ([const { Vec::new() }; 3], 0.0_f64, 0.0_f64);
    let (mut first_normal, mut has_planes) = (None, false);
    for channel in case.channels().into_iter().filter(|channel| channel.item.quantity == Quantity::Point) {
        let storage = case.recorded.storage.get(&(channel.sensor, channel.item)).copied();
        for place in rays(case, channel.sensor) {
            let [stated, exact] =
                [&case.recorded.answers, case.truth.answers()].map(|answers| channel.at(answers, place));
            let (Value::Vector(stated), Value::Vector(exact), Some(hit)) =
                (stated, exact, case.truth.hit(place))
            else {
                continue;
            };
            let first = *first_normal.get_or_insert(hit.normal);
            has_planes |= first.dot(hit.normal) < MAX_COSINE_OF_TWO_PLANES;
            for k in 0..3 {
                off[k].push(stated[k] - exact[k]);
                ulp = ulp.max(storage.map_or(0.0, |storage| storage.ulp(stated[k])));
                largest = largest.max(exact[k].abs()).max(stated[k].abs());
            }
        }
    }
    let rounding = ulp + 8.0 * f64::EPSILON * largest;
    let mut by = [0.0; 3];
    for (by, off) in by.iter_mut().zip(&mut off) {
        let (median, spread) = middle(off, MIN_WRONG_RAYS as usize)?;
        if spread > 2.0 * rounding {
            return None;
        }
        *by = plainest(median, 2.0 * rounding);
    }
    (has_planes && by != [0.0; 3]).then_some(Mistake::PointsMoved(by))
}

/// The largest quantum of which nearly all components of points are the multiples that are next to the true ones.
fn rounded_points(case: Case<'_>) -> Option<Mistake> {
    let mut components = Vec::new();
    for channel in case.channels().into_iter().filter(|channel| channel.item.quantity == Quantity::Point) {
        let storage = case.recorded.storage.get(&(channel.sensor, channel.item)).copied();
        for place in rays(case, channel.sensor) {
            let [stated, exact] =
                [&case.recorded.answers, case.truth.answers()].map(|answers| channel.at(answers, place));
            if let (Value::Vector(stated), Value::Vector(exact)) = (stated, exact) {
                let storage = storage.unwrap_or(Storage::F64);
                components.extend((0..3).map(|k| (storage, stated[k], exact[k])));
            }
        }
    }
    let is_right =
        |(storage, stated, exact): &&(Storage, f64, f64)| (stated - exact).abs() <= storage.ulp(*stated);
    if 2 * components.iter().filter(is_right).count() > components.len() {
        return None;
    }
    let ulp = components.iter().map(|(storage, stated, _)| storage.ulp(*stated)).fold(0.0, f64::max);
    rounded_to(ulp, |quantum| {
        let is = |(storage, stated, exact): &&(Storage, f64, f64)| {
            is_rounded(*storage, *stated, *exact, quantum, false)
        };
        components.iter().filter(is).count() as f64 >= MIN_CONSISTENT_SHARE * components.len().max(1) as f64
            && are_several_multiples(components.iter().filter(is).map(|(_, stated, _)| *stated), quantum)
    })
    .map(Mistake::PointsRounded)
}

/// Whether hidden hits are called visible, and visible ones hidden: else another mistake says the same.
fn is_reversed_both_ways(case: Case<'_>) -> bool {
    let mut ways = [0_u64; 2];
    for channel in case.channels().into_iter().filter(|channel| channel.item.quantity == Quantity::Visible) {
        for place in rays(case, channel.sensor).filter(|place| case.truth.hit(*place).is_some()) {
            let [stated, exact] =
                [&case.recorded.answers, case.truth.answers()].map(|answers| channel.at(answers, place));
            if let (Value::Flag(stated), Value::Flag(exact)) = (stated, exact)
                && stated != exact
            {
                ways[usize::from(stated)] += 1;
            }
        }
    }
    ways.iter().all(|count| *count >= MIN_CONFIRMING_RAYS)
}

/// The beams whose answers the sensor that is asked about may hold: those with as many cells.
fn other_beams(case: Case<'_>) -> Vec<Mistake> {
    let scene = case.truth.scene();
    let beams = scene.beams().len();
    match *case.sensors {
        [SensorId::Camera] if beams == 2 => vec![Mistake::BeamFluxExchanged],
        [SensorId::Beam(own)] => {
            let is_alike =
                |beam: &usize| scene.size(SensorId::Beam(*beam)) == scene.size(SensorId::Beam(own));
            (0..beams).filter(|beam| *beam != own).filter(is_alike).map(Mistake::HoldsBeam).collect()
        }
        _ => Vec::new(),
    }
}

/// Corrections whose numbers are found from the recording, after `base`.
pub(crate) fn fitted(case: Case<'_>, places: &[Place], base: Option<&Correction>) -> Vec<Correction> {
    let turns =
        axes(case, places, base).into_iter().chain(faces(case, base)).chain(factor(case, places, base));
    turns.chain(lengths(case, places, base)).collect()
}

/// All rays of a sensor, or every so many of them.
fn rays(case: Case<'_>, sensor: SensorId) -> impl Iterator<Item = Place> + use<> {
    let (width, height) = case.truth.scene().size(sensor).unwrap_or((1, 1));
    let cells = u64::from(width) * u64::from(height);
    // An odd step visits all columns of an image whose width is a power of two.
    let step = cells.div_ceil(MAX_FITTED_RAYS) | 1;
    (0..cells).step_by(step as usize).map(move |index| Place {
        sensor,
        i: (index % u64::from(width)) as u32,
        j: (index / u64::from(width)) as u32,
    })
}

/// The length of many cells that truly hold different ones, for each sensor: it may mean "no hit".
fn constants(case: Case<'_>) -> Vec<Mistake> {
    let mut found: Vec<Mistake> = Vec::new();
    for map in case.recorded.answers.maps.iter().filter(|map| case.sensors.contains(&map.sensor)) {
        let Some(raster) = HitQuantity::ALL.into_iter().find_map(|one| map.raster(one)) else { continue };
        let mut cells: BTreeMap<u64, usize> = BTreeMap::new();
        let mut empty = 0_usize;
        for place in rays(case, map.sensor) {
            let value = raster.at(place.i, place.j);
            empty += usize::from(value.is_none());
            if let Some(value) = value
                && value.components().iter().all(|one| *one == value.components()[0])
            {
                *cells.entry(value.components()[0].to_bits()).or_default() += 1;
            }
        }
        let most = cells.into_iter().max_by_key(|(bits, count)| (*count, std::cmp::Reverse(*bits)));
        // Where "no hit" is said otherwise, the constant does not mean it.
        let is_all = |count: usize| count >= MIN_CELLS_OF_CONSTANT && empty * EMPTY_ONE_IN <= count;
        let Some((bits, _)) = most.filter(|(_, count)| is_all(*count)) else { continue };
        let constant = f64::from_bits(bits);
        let max_range = case.truth.scene().max_range(map.sensor).unwrap_or(f64::INFINITY);
        let mistake = match constant {
            // As a file of single precision holds it.
            constant if constant == max_range || constant == f64::from(max_range as f32) => {
                Mistake::MissAtMaximumRange
            }
            constant => Mistake::MissWritten(constant),
        };
        if !found.contains(&mistake) {
            found.push(mistake);
        }
    }
    found
}

/// A change of axes of points and normals; where none helps both, one of each.
fn axes(case: Case<'_>, places: &[Place], base: Option<&Correction>) -> Vec<Correction> {
    let of = |quantity: Quantity| -> Vec<Channel> {
        case.channels().into_iter().filter(|channel| channel.item.quantity == quantity).collect()
    };
    let (points, normals) = (of(Quantity::Point), of(Quantity::Normal));
    let both: Vec<Channel> = points.iter().chain(&normals).copied().collect();
    let off = |channels: &[Channel], turn: Option<Mistake>| -> usize {
        let turn = turn.map(Correction::from);
        let chain: Vec<&Correction> = base.into_iter().chain(&turn).collect();
        let of_channel = |channel: &Channel| {
            let own = places.iter().filter(|place| place.sensor == channel.sensor);
            own.filter(|place| {
                let exact = channel.at(case.truth.answers(), **place);
                let value = corrected(case, *channel, **place, &chain);
                value.is_some_and(|value| !is_near(case, *channel, **place, value, exact))
            })
            .count()
        };
        channels.iter().map(of_channel).sum()
    };
    let mut turns = vec![Mistake::AxesYUp, Mistake::AxesYUpInverse];
    for from in [[0, 1, 2], [1, 0, 2], [0, 2, 1], [2, 1, 0], [1, 2, 0], [2, 0, 1]] {
        for signs in 0..8_u8 {
            let sign = [0, 1, 2].map(|k| if signs >> k & 1 == 1 { -1 } else { 1 });
            // That of all is no change, and that of reversed normals has a name of its own.
            if from != [0, 1, 2] || sign[0] != sign[1] || sign[1] != sign[2] {
                turns.push(Mistake::Axes { of: Vectors::Both, from, sign });
            }
        }
    }
    // The turn that leaves the fewest off, and whether another leaves as few: then nobody knows which it is.
    let best = |channels: &[Channel]| -> Option<(Mistake, bool)> {
        let left: Vec<(usize, Mistake)> =
            turns.iter().map(|turn| (off(channels, Some(*turn)), *turn)).collect();
        let (fewest, turn) = *left.iter().min_by_key(|(left, _)| *left)?;
        let as_few =
            left.iter().filter(|(left, other)| *left == fewest && plain(*other) != plain(turn)).count();
        (fewest < off(channels, None)).then_some((turn, as_few == 0))
    };
    let helps = |turn: Mistake, channels: &[Channel]| {
        channels.is_empty() || off(channels, Some(turn)) < off(channels, None)
    };
    if let Some((turn, _)) = best(&both).filter(|(turn, _)| helps(*turn, &points) && helps(*turn, &normals)) {
        // Of vectors that are not given nothing is said.
        let given = match (points.is_empty(), normals.is_empty()) {
            (false, true) => Vectors::Points,
            (true, false) => Vectors::Normals,
            _ => Vectors::Both,
        };
        let turn = match turn {
            Mistake::Axes { from, sign, .. } => Mistake::Axes { of: given, from, sign },
            by_gltf => by_gltf,
        };
        return vec![turn.into()];
    }
    let alone = |(of, channels): (Vectors, &Vec<Channel>)| {
        let (turn, _) = best(channels).filter(|(_, is_only)| *is_only)?;
        let (from, sign) = plain(turn)?;
        Some(Correction::from(Mistake::Axes { of, from, sign }))
    };
    [(Vectors::Points, &points), (Vectors::Normals, &normals)].into_iter().filter_map(alone).collect()
}

/// A change of axes as components and signs.
fn plain(turn: Mistake) -> Option<([usize; 3], [i8; 3])> {
    match turn {
        Mistake::AxesYUp => Some(([0, 2, 1], [1, -1, 1])),
        Mistake::AxesYUpInverse => Some(([0, 2, 1], [1, 1, -1])),
        Mistake::Axes { from, sign, .. } => Some((from, sign)),
        _ => None,
    }
}

/// The true face of each stated index, if each stands for one.
fn faces(case: Case<'_>, base: Option<&Correction>) -> Option<Correction> {
    let corrections: Vec<&Correction> = base.into_iter().collect();
    let mut counts: BTreeMap<u32, BTreeMap<u32, usize>> = BTreeMap::new();
    for channel in case.channels() {
        if channel.item.quantity != Quantity::Face {
            continue;
        }
        for place in rays(case, channel.sensor) {
            let exact = channel.at(case.truth.answers(), place);
            let value = corrected(case, channel, place, &corrections);
            if let (Some(Value::Face(stated)), Value::Face(exact)) = (value, exact) {
                *counts.entry(stated.0).or_default().entry(exact.0).or_default() += 1;
            }
        }
    }
    let (mut rays, mut consistent) = (0, 0);
    let mut own = BTreeMap::new();
    let mut taken = BTreeMap::new();
    for (stated, of) in &counts {
        let (face, count) = of.iter().max_by_key(|(face, count)| (**count, std::cmp::Reverse(**face)))?;
        rays += of.values().sum::<usize>();
        consistent += count;
        own.insert(*stated, *face);
        taken.insert(*face, *stated);
    }
    let is_one_to_one = taken.len() == own.len();
    let is_one_order = consistent as f64 >= MIN_CONSISTENT_SHARE * rays as f64;
    let is_enough = own.len() > 1 && rays >= MIN_RAYS_PER_INDEX * own.len();
    let is_new = own.iter().any(|(stated, face)| stated != face);
    (is_one_to_one && is_one_order && is_enough && is_new)
        .then(|| Correction { mistake: Mistake::FacesReordered, table: Table::Faces(Arc::new(own)) })
}

/// The constant factor of all flux.
fn factor(case: Case<'_>, places: &[Place], base: Option<&Correction>) -> Option<Correction> {
    let corrections: Vec<&Correction> = base.into_iter().collect();
    for quantity in [Quantity::PencilFlux, Quantity::PixelFlux] {
        let mut ratios = Vec::new();
        for channel in case.channels() {
            if channel.item.quantity != quantity || channel.item.is_other_model {
                continue;
            }
            for place in places.iter().filter(|place| place.sensor == channel.sensor) {
                let exact = channel.at(case.truth.answers(), *place);
                let value = corrected(case, channel, *place, &corrections);
                if let (Some(Value::Number(stated)), Value::Number(exact)) = (value, exact)
                    && stated > 0.0
                    && exact > 0.0
                {
                    ratios.push(stated / exact);
                }
            }
        }
        let Some((median, spread)) = middle(&mut ratios, MIN_VALUES_OF_FACTOR) else { continue };
        // The plainest number within what the ratios differ by. 1 is none: a factor of 1 is no mistake.
        let uncertainty = spread + 4.0 * f64::EPSILON * median;
        let is_one = spread <= MAX_SPREAD_OF_FACTOR * median && (median - 1.0).abs() > uncertainty;
        return is_one.then(|| Mistake::FluxFactor(plainest(median, uncertainty)).into());
    }
    None
}

/// What is left out of the flux if the air attenuates light on one part of its way alone, as factors.
fn attenuation(case: Case<'_>, leg: Leg) -> FluxFactors {
    let scene = case.truth.scene();
    let sigma = scene.atmosphere().attenuation;
    let (width, height) = scene.size(SensorId::Camera).unwrap_or((1, 1));
    let one_beam = |beam: usize| {
        let sensor = SensorId::Beam(beam);
        let (columns, rows) = scene.size(sensor).unwrap_or((1, 1));
        let light = &case.truth.answers().light[beam];
        [false, true].map(|is_other_model| {
            let model = if is_other_model { scene.flux_model().other() } else { scene.flux_model() };
            let flux = if is_other_model { &light.other_flux } else { &light.returns.flux };
            let image = if is_other_model { &light.other_image } else { &light.image };
            let mut of_pencils = Image::filled(columns, rows, 1.0);
            let mut without = Image::filled(width, height, 0.0);
            for j in 0..rows {
                for i in 0..columns {
                    let place = Place { sensor, i, j };
                    let at = |image: &Option<Image<raypencil_scene::Maybe<f64>>>| {
                        image.as_ref().and_then(|image| image.at(i, j).get())
                    };
                    let range = at(&case.truth.answers().map(sensor).range);
                    let (depth, cosine) = (at(&light.returns.depth), at(&light.returns.cos_off_axis));
                    let (Some(range), Some(depth), Some(cosine)) = (range, depth, cosine) else { continue };
                    let back = if model == FluxModel::Eq1 { depth } else { depth / cosine };
                    let left_out = match leg {
                        Leg::Out => back,
                        Leg::Back => range,
                        Leg::Neither => range + back,
                    };
                    let factor = libm::exp(-sigma * left_out);
                    of_pencils.set(i, j, factor);
                    let (is_visible, pixel) = case.truth.visibility(place);
                    if let (true, Some(pixel), Some(flux)) = (is_visible, pixel, flux) {
                        let sum = without.at(pixel.i, pixel.j) + flux.at(i, j) / factor;
                        without.set(pixel.i, pixel.j, sum);
                    }
                }
            }
            let exact = image.as_ref().map_or(&[][..], Image::cells);
            let ratio = |(sum, exact): (&f64, &f64)| if *sum > 0.0 { exact / sum } else { 1.0 };
            let ratios: Vec<f64> = without.cells().iter().zip(exact).map(ratio).collect();
            let of_image = if ratios.len() == without.cells().len() {
                Image::from_cells(width, height, ratios)
            } else {
                Image::filled(width, height, 1.0)
            };
            [of_pencils, of_image]
        })
    };
    // By pencils or image first, then by model.
    (0..scene.beams().len())
        .map(|beam| {
            let [[a, b], [c, d]] = one_beam(beam);
            [[a, c], [b, d]]
        })
        .collect()
}

#[cfg(test)]
#[path = "../tests/unit/fit.rs"]
mod tests;
