//! The exact answers to all rays of a scene, and the judge of other answers.

use std::borrow::Cow;

use crate::answer::StatedReturn;
use crate::judge::{Judge, JudgeShare};
use crate::scene_answers::{Answers, Certified};
use rayon::prelude::*;
use raypencil_referee::Format;
use raypencil_scene::{Hit, Pixel, Place, Progress, Return, Returns, Sampling, Scene, SensorId};

/// The exact answers to all rays of a scene, correctly rounded to f64, and the judge of other answers.
#[derive(Debug)]
pub struct GroundTruth<'s> {
    judge: Judge<'s>,
    answers: Cow<'s, Answers>,
}

/// An answer of a ground truth that is not the one that the referee gives now.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct UncertifiedAnswer {
    /// The ray.
    pub place: Place,
    /// The part of its answer, in words.
    pub part: &'static str,
}

impl<'s> GroundTruth<'s> {
    /// Asks the referee about every ray of a scene.
    pub fn certified(scene: &'s Scene, progress: &dyn Progress) -> Self {
        let certified = Certified::new(scene, progress);
        Self::of_answers(scene, certified.in_format(Format::Double, scene.flux_model()))
    }

    /// Takes answers that hold every quantity as the truth.
    pub fn of_answers(scene: &'s Scene, answers: Answers) -> Self {
        Self { judge: Judge::new(scene, JudgeShare::Sample), answers: Cow::Owned(answers) }
    }

    /// The same without taking them.
    pub fn borrowing(scene: &'s Scene, answers: &'s Answers) -> Self {
        Self { judge: Judge::new(scene, JudgeShare::Sample), answers: Cow::Borrowed(answers) }
    }

    /// The scene.
    pub fn scene(&self) -> &'s Scene {
        self.judge.scene()
    }

    /// The judge of other answers.
    pub fn judge(&self) -> &Judge<'s> {
        &self.judge
    }

    /// The exact answers.
    pub fn answers(&self) -> &Answers {
        &self.answers
    }

    /// The exact answers alone, without the judge.
    pub fn into_answers(self) -> Answers {
        self.answers.into_owned()
    }

    /// The hit of ray (i, j) of a sensor, each value correctly rounded.
    pub fn hit_at(&self, sensor: SensorId, i: u32, j: u32) -> Option<Hit> {
        self.hit(Place { sensor, i, j })
    }

    /// The hit of a ray.
    pub fn hit(&self, place: Place) -> Option<Hit> {
        self.answers.map(place.sensor).hit(place.i, place.j)
    }

    /// Whether the camera sees a pencil's hit, and the pixel in which the hit lands.
    pub fn visibility(&self, Place { sensor, i, j }: Place) -> (bool, Option<Pixel>) {
        let SensorId::Beam(beam) = sensor else { return (false, None) };
        let returns = &self.answers.light[beam].returns;
        let visible = returns.visible.as_ref().is_some_and(|image| image.at(i, j));
        (visible, returns.pixel.as_ref().and_then(|image| image.at(i, j).get()))
    }

    /// The flux of a pencil by the scene's model and by the other, watts (`eq1`: W/m).
    pub fn flux(&self, Place { sensor, i, j }: Place) -> [f64; 2] {
        let SensorId::Beam(beam) = sensor else { return [0.0; 2] };
        let light = &self.answers.light[beam];
        [&light.returns.flux, &light.other_flux]
            .map(|image| image.as_ref().map_or(0.0, |image| image.at(i, j)))
    }

    /// The first ray of a sample, or of all, whose answer is not, bit for bit, the one that the referee gives now. The sums of
    /// pixels are always looked at. The second number is how many rays were asked.
    pub fn first_uncertified(&self, share: JudgeShare) -> (Option<UncertifiedAnswer>, u64) {
        let is_asked = |place: &Place| share == JudgeShare::All || self.judge.samples(*place);
        let mut asked = 0;
        for sensor in self.scene().sensors() {
            let (width, height) = self.scene().size(sensor).expect("a sensor of this scene");
            let places = (0..height).flat_map(|j| (0..width).map(move |i| Place { sensor, i, j }));
            let places: Vec<Place> = places.filter(is_asked).collect();
            asked += places.len() as u64;
            let found = self.uncertified_among(sensor, &places);
            if found.is_some() {
                return (found, asked);
            }
        }
        ((0..self.scene().beams().len()).find_map(|beam| self.first_unlike_sum(beam)), asked)
    }

    /// The first of these rays of a sensor whose answer is not the one that the referee gives now.
    pub fn uncertified_among(&self, sensor: SensorId, places: &[Place]) -> Option<UncertifiedAnswer> {
        let referee = self.judge.referee();
        let model = self.scene().flux_model();
        let light = match sensor {
            SensorId::Camera => None,
            SensorId::Beam(beam) => referee.light(beam, Sampling::Centres).zip(Some(beam)),
        };
        let fault = |place: &Place| {
            let place = *place;
            let Place { i, j, .. } = place;
            let own = referee.values(sensor, i, j).map(|hit| hit.in_format(Format::Double));
            if self.hit(place) != own {
                return Some(UncertifiedAnswer { place, part: "what the ray meets" });
            }
            let (light, beam) = light.as_ref()?;
            let own = light.returned(i, j);
            let [by_own, by_other] =
                [model, model.other()].map(|model| own.map(|exact| exact.in_format(Format::Double, model)));
            let stated = return_of(&self.answers.light[*beam].returns, i, j);
            let flux = [by_own, by_other].map(|exact| exact.map_or(0.0, |exact| exact.flux));
            let differs = stated != by_own || self.flux(place) != flux;
            differs.then_some(UncertifiedAnswer { place, part: "what comes back of the pencil" })
        };
        places.par_iter().find_map_first(fault)
    }

    /// The first pixel whose flux is not, to rounding, the sum of its pencils'.
    fn first_unlike_sum(&self, beam: usize) -> Option<UncertifiedAnswer> {
        let camera = &self.scene().camera().sensor;
        let light = &self.answers.light[beam];
        let sensor = SensorId::Beam(beam);
        let (columns, rows) = self.scene().size(sensor).expect("a sensor of this scene");
        let cells = camera.width as usize * camera.height as usize;
        let mut sums = vec![([0.0_f64; 2], 0_u32); cells];
        for place in (0..rows).flat_map(|j| (0..columns).map(move |i| Place { sensor, i, j })) {
            if let (true, Some(pixel)) = self.visibility(place) {
                let (sum, count) = &mut sums[pixel.j as usize * camera.width as usize + pixel.i as usize];
                let flux = self.flux(place);
                *sum = [sum[0] + flux[0], sum[1] + flux[1]];
                *count += 1;
            }
        }
        let images = [light.image.as_ref()?, light.other_image.as_ref()?];
        let unlike = sums.iter().enumerate().position(|(index, (sum, count))| {
            (0..2).any(|k| {
                // Each flux and each sum is rounded once.
                let off = (images[k].cells()[index] - sum[k]).abs();
                off > f64::from(2 * count) * f64::EPSILON * sum[k] + f64::from(*count) * f64::MIN_POSITIVE
            })
        })?;
        let (i, j) = (unlike as u32 % camera.width, unlike as u32 / camera.width);
        Some(UncertifiedAnswer {
            place: Place { sensor: SensorId::Camera, i, j },
            part: "the sum over its pencils",
        })
    }
}

/// The return of a pencil, of returns that hold every quantity.
fn return_of(returns: &Returns, i: u32, j: u32) -> Option<Return> {
    let stated = StatedReturn::of(returns, None, i, j);
    Some(Return {
        visible: stated.visible?,
        pixel: stated.pixel?,
        depth: stated.depth?,
        cos_off_axis: stated.cos_off_axis?,
        cos_view: stated.cos_view?,
        flux: stated.flux[0]?,
    })
}
