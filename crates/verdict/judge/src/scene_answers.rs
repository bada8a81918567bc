//! All answers to the rays of a scene: of a renderer or recording, or of the referee, correctly rounded.

use raypencil_referee::{CertifiedMap, CertifiedReturns, Format, Referee};
use raypencil_scene::{
    FluxModel, Image, Progress, Quantities, RenderOutput, Returns, Sampling, Scene, SensorId, SensorMap,
};

/// Answers to all rays of a scene. Every quantity is optional.
#[derive(Debug, Clone)]
pub struct Answers {
    /// The maps of each sensor, the camera first.
    pub maps: Vec<SensorMap>,
    /// The returns of each beam.
    pub light: Vec<BeamLight>,
}

/// The returns of one beam to the camera.
#[derive(Debug, Clone)]
pub struct BeamLight {
    /// The return of each pencil, its flux by the scene's model.
    pub returns: Returns,
    /// The flux on the camera's image by the scene's model.
    pub image: Option<Image<f64>>,
    /// The flux of the pencils by the other model.
    pub other_flux: Option<Image<f64>>,
    /// The flux on the camera's image by the other model.
    pub other_image: Option<Image<f64>>,
}

impl Answers {
    /// Answers without any channel.
    pub(crate) fn none(scene: &Scene) -> Self {
        let maps = scene.sensors().map(|sensor| {
            let (width, height) = scene.size(sensor).expect("a sensor of this scene");
            SensorMap::empty(sensor, width, height, Quantities::NONE)
        });
        let light = scene.beams().iter().map(|beam| BeamLight {
            returns: Returns::unsupported(beam.sensor.columns, beam.sensor.rows),
            image: None,
            other_flux: None,
            other_image: None,
        });
        Self { maps: maps.collect(), light: light.collect() }
    }

    /// The answers of a renderer's output.
    pub fn of_output(scene: &Scene, output: &RenderOutput) -> Self {
        let mut answers = Self::none(scene);
        for (mine, sensor) in answers.maps.iter_mut().zip(scene.sensors()) {
            if let Some(map) = output.map(sensor) {
                *mine = map.clone();
            }
        }
        for (index, light) in answers.light.iter_mut().enumerate() {
            if let Some(returns) = output.returns.get(index) {
                light.returns = returns.clone();
            }
            light.image = output.flux.get(index).cloned();
        }
        answers
    }

    /// The answers as a renderer's output. That has no place for a missing image, so that images end before the first
    /// beam without one.
    pub(crate) fn to_output(&self) -> RenderOutput {
        RenderOutput {
            camera: self.maps.first().cloned(),
            beams: self.maps.iter().skip(1).cloned().collect(),
            returns: self.light.iter().map(|light| light.returns.clone()).collect(),
            flux: self.light.iter().map_while(|light| light.image.clone()).collect(),
            stages: Vec::new(),
        }
    }

    /// The maps of a sensor.
    pub fn map(&self, sensor: SensorId) -> &SensorMap {
        match sensor {
            SensorId::Camera => &self.maps[0],
            SensorId::Beam(index) => &self.maps[index + 1],
        }
    }
}

/// The referee's answers to all rays of a scene, correctly rounded.
#[derive(Debug)]
pub struct Certified {
    maps: Vec<CertifiedMap>,
    light: Vec<CertifiedReturns>,
}

impl Certified {
    /// Asks the referee about every ray.
    pub fn new(scene: &Scene, progress: &dyn Progress) -> Self {
        let referee = Referee::new(scene);
        let (mut maps, mut light) = (Vec::new(), Vec::new());
        for sensor in scene.sensors() {
            progress.stage(&format!("{sensor}: exact values"));
            maps.extend(referee.certified_map(sensor, Sampling::Centres));
        }
        for beam in 0..scene.beams().len() {
            progress.stage(&format!("{}: exact flux", SensorId::Beam(beam)));
            light.extend(referee.certified_returns(beam, Sampling::Centres));
        }
        Self { maps, light }
    }

    /// The answers in one format, the flux of the returns by `model`.
    pub fn in_format(&self, format: Format, model: FluxModel) -> Answers {
        let light = self.light.iter().map(|light| BeamLight {
            returns: light.returns_in(format, model),
            image: Some(light.image_in(format, model)),
            other_flux: light.returns_in(format, model.other()).flux,
            other_image: Some(light.image_in(format, model.other())),
        });
        Answers {
            maps: self.maps.iter().map(|map| map.in_format(format, Quantities::ALL)).collect(),
            light: light.collect(),
        }
    }

    /// Number of values that the budget of bits did not decide.
    pub fn undecided(&self) -> usize {
        self.light.iter().map(CertifiedReturns::undecided).sum()
    }
}
