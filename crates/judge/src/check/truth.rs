//! The truth about every ray of a scene, and the referee to ask about answers that are not it.

use crate::answers::{Answers, Certified};
use crate::judge::{Judge, JudgeShare};
use raypencil_referee::Format;
use raypencil_scene::Place;
use raypencil_scene::{
    Hit, Image, Maybe, Pixel, Progress, Return, Returns, Sample, Scene, SensorId, SensorMap,
};

/// The exact values of a hit, as f64.
pub(super) fn doubles(hit: &raypencil_referee::RoundedHit) -> Hit {
    hit.in_format(Format::Double)
}

/// Correctly rounded answers to every ray, and the judge of other answers.
#[derive(Debug)]
pub struct Truth<'s> {
    judge: Judge<'s>,
    answers: Answers,
}

/// An answer that is not the referee's own.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NotOurs {
    pub place: Place,
    pub quantity: &'static str,
}

impl<'s> Truth<'s> {
    /// Asks the referee about every ray of a scene.
    pub fn certified(scene: &'s Scene, progress: &dyn Progress) -> Self {
        let certified = Certified::new(scene, progress);
        Self::of_answers(scene, certified.in_format(Format::Double, scene.flux_model()))
    }

    /// Takes answers for the truth that hold every quantity.
    pub fn of_answers(scene: &'s Scene, answers: Answers) -> Self {
        Self { judge: Judge::new(scene, JudgeShare::Sample), answers }
    }

    /// The scene.
    pub fn scene(&self) -> &'s Scene {
        self.judge.scene()
    }

    pub fn judge(&self) -> &Judge<'s> {
        &self.judge
    }

    pub fn answers(&self) -> &Answers {
        &self.answers
    }

    /// What ray (i, j) of a sensor meets, each value correctly rounded.
    pub fn hit_at(&self, sensor: SensorId, i: u32, j: u32) -> Option<Hit> {
        self.hit(Place { sensor, i, j })
    }

    /// What a ray meets.
    pub fn hit(&self, place: Place) -> Option<Hit> {
        hit_of(self.answers.map(place.sensor), place)
    }

    /// Whether the camera sees a pencil's hit, and where that lands.
    pub fn sight(&self, Place { sensor, i, j }: Place) -> (bool, Option<Pixel>) {
        let SensorId::Beam(beam) = sensor else { return (false, None) };
        let returns = &self.answers.light[beam].returns;
        let visible = returns.visible.as_ref().is_some_and(|image| image.at(i, j));
        (visible, returns.pixel.as_ref().and_then(|image| image.at(i, j).get()))
    }

    /// What a pencil delivers, by the scene's model and by the other.
    pub fn flux(&self, Place { sensor, i, j }: Place) -> [f64; 2] {
        let SensorId::Beam(beam) = sensor else { return [0.0; 2] };
        let light = &self.answers.light[beam];
        [&light.returns.flux, &light.other_flux]
            .map(|image| image.as_ref().map_or(0.0, |image| image.at(i, j)))
    }

    /// The first of a sample of rays whose answer is not, bit for bit, what the referee finds here and now.
    pub fn first_not_ours(&self) -> Option<NotOurs> {
        let referee = self.judge.referee();
        let model = self.scene().flux_model();
        for sensor in self.scene().sensors() {
            let (width, height) = self.scene().size(sensor).expect("a sensor of this scene");
            let light = match sensor {
                SensorId::Camera => None,
                SensorId::Beam(beam) => {
                    referee.light(beam, raypencil_scene::Sampling::Centres).zip(Some(beam))
                }
            };
            let places = (0..height).flat_map(|j| (0..width).map(move |i| Place { sensor, i, j }));
            for place in places.filter(|place| self.judge.samples(*place)) {
                let Place { i, j, .. } = place;
                let own = referee.values(sensor, i, j).map(|hit| doubles(&hit));
                if self.hit(place) != own {
                    return Some(NotOurs { place, quantity: "what the ray meets" });
                }
                let Some((light, beam)) = &light else { continue };
                let own = light.returned(i, j);
                let [by_own, by_other] =
                    [model, model.other()].map(|model| own.map(|back| back.in_format(Format::Double, model)));
                let said = back_of(&self.answers.light[*beam].returns, i, j);
                let flux = [by_own, by_other].map(|back| back.map_or(0.0, |back| back.flux));
                if said != by_own || self.flux(place) != flux {
                    return Some(NotOurs { place, quantity: "what comes back of the pencil" });
                }
            }
        }
        (0..self.scene().beams().len()).find_map(|beam| self.first_unlike_sum(beam))
    }

    /// The first pixel whose flux is not, to rounding, the sum of its pencils'.
    fn first_unlike_sum(&self, beam: usize) -> Option<NotOurs> {
        let camera = &self.scene().camera().sensor;
        let light = &self.answers.light[beam];
        let sensor = SensorId::Beam(beam);
        let (columns, rows) = self.scene().size(sensor).expect("a sensor of this scene");
        let cells = camera.width as usize * camera.height as usize;
        let mut sums = vec![([0.0_f64; 2], 0_u32); cells];
        for place in (0..rows).flat_map(|j| (0..columns).map(move |i| Place { sensor, i, j })) {
            if let (true, Some(pixel)) = self.sight(place) {
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
        Some(NotOurs {
            place: Place { sensor: SensorId::Camera, i, j },
            quantity: "the sum over its pencils",
        })
    }
}

/// What comes back by returns that hold every quantity.
fn back_of(returns: &Returns, i: u32, j: u32) -> Option<Return> {
    let value = |image: &Option<Image<Maybe<f64>>>| image.as_ref().and_then(|image| image.at(i, j).get());
    Some(Return {
        visible: returns.visible.as_ref()?.at(i, j),
        pixel: returns.pixel.as_ref()?.at(i, j).get(),
        depth: value(&returns.depth)?,
        cos_off_axis: value(&returns.cos_off_axis)?,
        cos_view: value(&returns.cos_view)?,
        flux: returns.flux.as_ref()?.at(i, j),
    })
}

/// A hit of maps that hold every quantity.
fn hit_of(map: &SensorMap, Place { i, j, .. }: Place) -> Option<Hit> {
    fn at<T: Sample>(image: &Option<Image<Maybe<T>>>, i: u32, j: u32) -> Option<T> {
        image.as_ref().and_then(|image| image.at(i, j).get())
    }
    Some(Hit {
        face: at(&map.face, i, j)?,
        range: at(&map.range, i, j)?,
        point: at(&map.point, i, j)?,
        normal: at(&map.normal, i, j)?,
        depth: at(&map.depth, i, j)?,
        cos_incidence: at(&map.cos_incidence, i, j)?,
    })
}
