//! The camera of a drive, steps 6 to 8: a preset, and what the scene file has in its place; and the sun.

use crate::drive::camera_settings::BlurSettings;
use crate::drive::settings::{DriveSettings, SensorWord, SunSettings};
use raypencil_rover::Rig;
use raypencil_scene::SceneError;
use raypencil_sensor::{
    ImageSensor, MARS_SEMI_MAJOR_AXIS_AU, Optics, Psf, SOLAR_IRRADIANCE_810_NM, Sunlight, preset,
};

/// Cells of the fine image on which optics blur: 2 GiB of them.
pub const MOST_FINE_CELLS: u64 = 1 << 28;

/// Steps 6 to 8: the preset, but for what the file says.
pub fn camera_chain(
    settings: &DriveSettings,
    word: SensorWord,
    rig: &Rig,
) -> Result<(Optics, ImageSensor), SceneError> {
    let (mut optics, mut sensor) = preset(word.word()).expect("every word of scene files is a preset");
    let camera = rig.camera.sensor;
    if let Some(beam) = rig.beams.first() {
        sensor.wavelength = beam.sensor.wavelength;
    }

    let given = &settings.optics;
    let airy = |rings| Psf::Airy {
        wavelength: sensor.wavelength,
        f_number: camera.focal_length / camera.aperture,
        rings,
    };
    if let Some(blurs) = &given.blurs {
        let blur = |blur: &BlurSettings| match blur {
            BlurSettings::Airy { rings } => airy(*rings),
            BlurSettings::Gaussian(sigma) => Psf::Gaussian { sigma: *sigma },
            BlurSettings::Kernel(kernel) => Psf::Sampled(kernel.clone()),
        };
        optics.blurs = blurs.iter().map(blur).collect();
    }
    for blur in &mut optics.blurs {
        // A preset's diffraction is that of the camera it is put on.
        if let Psf::Airy { rings, .. } = *blur {
            *blur = airy(rings);
        }
    }
    optics.oversampling = given.oversampling.unwrap_or(optics.oversampling);
    optics.focus = given.focus.or(optics.focus);
    optics.dust = given.dust.or(optics.dust);
    optics.validate("drive.optics")?;
    if let Some(focus) = optics.focus.filter(|&focus| focus <= camera.focal_length) {
        let expected = format!("beyond the focal length, {} m", camera.focal_length);
        return Err(SceneError::new("drive.optics.focus", focus, expected));
    }
    let fine = [camera.width, camera.height].map(|side| u64::from(side) * u64::from(optics.oversampling));
    if fine[0] * fine[1] > MOST_FINE_CELLS {
        let value = format!("{}, an image of {} x {} cells", optics.oversampling, fine[0], fine[1]);
        let expected = format!("an image of at most {MOST_FINE_CELLS} cells");
        return Err(SceneError::new("drive.optics.oversampling", value, expected));
    }

    let given = settings.electronics;
    let dark = &mut sensor.dark_current;
    dark.rate = given.dark_rate.unwrap_or(dark.rate);
    dark.reference_temperature = given.dark_at.unwrap_or(dark.reference_temperature);
    dark.doubling_kelvins = given.dark_doubling.unwrap_or(dark.doubling_kelvins);
    dark.temperature = given.temperature.unwrap_or(dark.temperature);
    sensor.exposure = given.exposure.unwrap_or(sensor.exposure);
    sensor.quantum_efficiency = given.quantum_efficiency.unwrap_or(sensor.quantum_efficiency);
    sensor.shot_noise = given.shot_noise.unwrap_or(sensor.shot_noise);
    sensor.read_noise = given.read_noise.unwrap_or(sensor.read_noise);
    sensor.prnu = given.prnu.unwrap_or(sensor.prnu);
    sensor.dsnu = given.dsnu.unwrap_or(sensor.dsnu);
    sensor.full_well = given.full_well.unwrap_or(sensor.full_well);
    sensor.gain = given.gain.unwrap_or(sensor.gain);
    sensor.bias = given.bias.unwrap_or(sensor.bias);
    sensor.bits = given.bits.unwrap_or(sensor.bits);
    sensor.seed = settings.sensor_seed.unwrap_or(sensor.seed);
    sensor.validate("drive.electronics")?;
    Ok((optics, sensor))
}

/// Light on Mars, its sun as bright as the file says.
pub fn sunlight(settings: SunSettings) -> Sunlight {
    let mars = Sunlight::mars(settings.elevation, settings.azimuth, settings.optical_depth);
    let usual = SOLAR_IRRADIANCE_810_NM / (MARS_SEMI_MAJOR_AXIS_AU * MARS_SEMI_MAJOR_AXIS_AU);
    let share = settings.spectral_irradiance.map_or(1.0, |irradiance| irradiance / usual);
    Sunlight { direct: share * mars.direct, sky: share * mars.sky, ..mars }
}
