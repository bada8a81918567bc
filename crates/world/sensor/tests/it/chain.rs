//! The whole chain: a pixel by hand, the sun, pairs of frames, presets, and the same bits on any number of threads.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_6, LN_2, PI};

use glam::DVec3;
use raypencil_scene::{Camera, Filter, Image, Lens, Maybe};
use raypencil_sensor::{
    DarkCurrent, DigitalImage, ImageSensor, MARS_SEMI_MAJOR_AXIS_AU, Optics, PLANCK_CONSTANT, PRESET_NAMES,
    PointSource, SOLAR_IRRADIANCE_810_NM, SPEED_OF_LIGHT, Sunlight, VisibleSurface, difference,
    photon_energy, preset,
};

fn camera(width: u32, height: u32, filter: Filter) -> Camera {
    Camera {
        width,
        height,
        pixel_pitch: [9e-6, 9e-6],
        focal_length: 8e-3,
        principal_point: [f64::from(width) / 2.0, f64::from(height) / 2.0],
        aperture: 2e-3,
        lens: Lens { transmission: 0.8, filter },
        max_range: 20.0,
    }
}

const FILTER: Filter = Filter::Interference { centre: 810e-9, width: 10e-9, index: 2.0 };

#[test]
fn one_pixel_by_hand() {
    // A photon of 810 nm has 6.62607015e-34 * 299792458 / 810e-9 = 2.452402e-19 J.
    assert!((photon_energy(810e-9) - 2.452_402e-19).abs() < 1e-25);
    // 1e-12 W for 2 ms are 2e-15 J or 8155.27 photons; at eta = 0.5, 4077.64 electrons. The dark current of 100
    // per second at 273.15 K doubles twice to 287.15 K: 0.8 electrons in 2 ms. 12 + 0.1 (4077.64 + 0.8) = 419.84,
    // so 420 DN.
    let sensor = ImageSensor {
        exposure: 2e-3,
        quantum_efficiency: 0.5,
        dark_current: DarkCurrent {
            rate: 100.0,
            reference_temperature: 273.15,
            doubling_kelvins: 7.0,
            temperature: 287.15,
        },
        gain: 0.1,
        bias: 12.0,
        bits: 12,
        ..ImageSensor::ideal()
    };
    let frame = sensor.expose(&Image::filled(1, 1, 1e-12), None, 0);
    assert!((frame.expected.at(0, 0) - 4078.44).abs() < 0.01, "{}", frame.expected.at(0, 0));
    assert_eq!(frame.electrons, frame.expected);
    assert!((frame.signal.at(0, 0) - 419.844).abs() < 0.001);
    assert_eq!(frame.numbers.at(0, 0), 420);
    // The same light, half of it as background.
    let half = Image::filled(1, 1, 0.5e-12);
    assert_eq!(sensor.expose(&half, Some(&half), 0).numbers.at(0, 0), 420);
}

#[test]
fn the_sun_on_one_pixel_by_hand() {
    // The pass band is 10 nm sqrt(pi / (4 ln 2)) = 10.64467 nm. The sun at 30 degrees on level ground: n.s = 1/2.
    // E = (0.5e9 / 2 + 0.05e9) 10.64467e-9 = 3.193401 W/m^2, L = 0.25 / pi E = 0.2541228, flux = pi / 4 L (2 /
    // 8)^2 (9e-6)^2 0.8 = 8.083296e-13 W.
    let camera = camera(1, 1, FILTER);
    let sun = Sunlight {
        elevation: FRAC_PI_6,
        azimuth: 1.0,
        direct: 0.5e9,
        sky: 0.05e9,
        reference: 810e-9,
        slope: -0.0021e9,
        open_band: 600e-9,
    };
    let of = |normal: Option<DVec3>, sunlit: bool, attenuation: f64| {
        let normal = Image::filled(1, 1, Maybe::from(normal));
        let range = Image::filled(1, 1, Maybe::some(3.0));
        let (reflectivity, sunlit) = (Image::filled(1, 1, 0.25), Image::filled(1, 1, sunlit));
        let ground =
            VisibleSurface { normal: &normal, range: &range, reflectivity: &reflectivity, sunlit: &sunlit };
        sun.flux(&camera, attenuation, &ground).at(0, 0)
    };
    let near =
        |found: f64, expected: f64| assert!((found / expected - 1.0).abs() < 1e-6, "{found} {expected}");
    near(of(Some(DVec3::Z), true, 0.0), 8.083_296e-13);
    // In shadow only the sky shines, a sixth. The same holds on a face that is turned away.
    near(of(Some(DVec3::Z), false, 0.0), 8.083_296e-13 / 6.0);
    near(of(Some(-DVec3::Z), true, 0.0), 8.083_296e-13 / 6.0);
    // A face perpendicular to the sunlight has (0.5 + 0.05) / 0.3 of it.
    near(of(Some(sun.direction()), true, 0.0), 8.083_296e-13 * 0.55 / 0.3);
    // Attenuation over 3 m of air.
    near(of(Some(DVec3::Z), true, 0.1), 8.083_296e-13 * libm::exp(-0.3));
    // No ground: the sky itself, 4 times as bright as ground of r_d = 1/4 under it.
    near(of(None, true, 0.1), 8.083_296e-13 / 6.0 * 4.0);
}

#[test]
fn the_camera_equation_falls_as_the_fourth_power_of_the_cosine() {
    let camera = Camera { pixel_pitch: [2e-3, 2e-3], ..camera(5, 5, Filter::None) };
    let sun = Sunlight { slope: 0.0, ..Sunlight::mars(1.0, 0.0, 0.5) };
    let none = Image::filled(5, 5, Maybe::NONE);
    let normal = Image::filled(5, 5, Maybe::NONE);
    let (reflectivity, sunlit) = (Image::filled(5, 5, 0.0), Image::filled(5, 5, true));
    let ground =
        VisibleSurface { normal: &normal, range: &none, reflectivity: &reflectivity, sunlit: &sunlit };
    let flux = sun.flux(&camera, 0.0, &ground);
    // Pixel (4, 2) is 4 mm aside: tan(phi) = 1/2, cos^2(phi) = 4/5.
    assert!((flux.at(4, 2) / flux.at(2, 2) - 0.64).abs() < 1e-12);
    assert_eq!(flux.at(0, 2), flux.at(4, 2));
}

#[test]
fn the_pass_band_is_the_integral_of_the_filter() {
    let sun = Sunlight { slope: 0.0, ..Sunlight::mars(1.0, 0.0, 0.5) };
    let sloped = Sunlight::mars(1.0, 0.0, 0.5);
    for sin_squared in [0.0, 0.1, 0.25] {
        // F of docs/theory/radiometry.md, integrated over the wavelength at one angle in steps of 0.01 nm.
        let centre = 810e-9 * (1.0 - sin_squared / 4.0_f64).sqrt();
        let (mut flat, mut line) = (0.0, 0.0);
        for step in -10_000..10_000 {
            let wavelength = centre + 1e-11 * f64::from(step);
            let off = (wavelength - centre) / 10e-9;
            let passed = libm::exp(-4.0 * LN_2 * (off * off)) * 1e-11;
            flat += passed;
            line += passed * (1.0 + sloped.slope * (wavelength - sloped.reference));
        }
        assert!((sun.pass_band(FILTER, sin_squared) / flat - 1.0).abs() < 1e-9);
        assert!((sloped.pass_band(FILTER, sin_squared) / line - 1.0).abs() < 1e-9);
    }
    assert_eq!(sun.pass_band(Filter::None, 0.3), 600e-9);
}

#[test]
fn the_sun_is_where_it_is_said_to_be() {
    let at =
        |elevation, azimuth| Sunlight { elevation, azimuth, ..Sunlight::mars(1.0, 0.0, 0.5) }.direction();
    assert!((at(0.0, 0.0) - DVec3::X).length() < 1e-15);
    assert!((at(0.0, FRAC_PI_2) - DVec3::Y).length() < 1e-15);
    assert!((at(FRAC_PI_2, 2.0) - DVec3::Z).length() < 1e-15);
    assert!((at(0.7, -2.0).length() - 1.0).abs() < 1e-15);
}

#[test]
fn sunlight_on_mars_is_near_its_sources() {
    // A black body of 5772 K with the sun's radius (6.957e8 m), at 1 AU and 810 nm: within 3 % of the standard.
    let wavelength = 810e-9;
    let x = PLANCK_CONSTANT * SPEED_OF_LIGHT / (wavelength * 1.380_649e-23 * 5772.0);
    let fifth = wavelength * wavelength * wavelength * wavelength * wavelength;
    let radiance = 2.0 * PLANCK_CONSTANT * SPEED_OF_LIGHT * SPEED_OF_LIGHT / (fifth * (libm::exp(x) - 1.0));
    let disc = PI * (6.957e8 / 1.495_978_707e11) * (6.957e8 / 1.495_978_707e11);
    assert!((radiance * disc / SOLAR_IRRADIANCE_810_NM - 1.0).abs() < 0.03);
    // 1.110 / 2.3216 = 0.478 W/m^2/nm on Mars.
    let above = SOLAR_IRRADIANCE_810_NM / (MARS_SEMI_MAJOR_AXIS_AU * MARS_SEMI_MAJOR_AXIS_AU);
    assert!((above - 0.4781e9).abs() < 1e5);
    // All light on the ground, relative to that above the atmosphere: table III of Appelbaum and Flood (1990),
    // net flux at an albedo of 0.1, hence divided by 0.9.
    for (depth, zenith, net) in [(0.3, 40.0, 0.826), (0.5, 0.0, 0.810), (0.5, 60.0, 0.708), (1.0, 0.0, 0.732)]
    {
        let elevation = (90.0_f64 - zenith).to_radians();
        let sun = Sunlight::mars(elevation, 0.0, depth);
        let height = libm::sin(elevation);
        let down = (sun.direct * height + sun.sky) / (above * height);
        assert!((down / (net / 0.9) - 1.0).abs() < 0.04, "{depth} {zenith}: {down} {}", net / 0.9);
        assert!(sun.validate("sun").is_ok());
    }
    // At night there is no light.
    let night = Sunlight::mars(-0.1, 0.0, 0.5);
    assert_eq!((night.direct, night.sky), (0.0, 0.0));
}

#[test]
fn subtraction_leaves_the_stripe() {
    let sensor = ImageSensor { seed: 21, ..ImageSensor::ccd_1989() };
    let mut laser = Image::filled(60, 60, 0.0);
    for i in 0..60 {
        laser.set(i, 30, 1e-11);
    }
    let sun = Image::filled(60, 60, 2.5e-12);
    let pair = sensor.expose_pair(&laser, Some(&sun), 3);
    assert_eq!(pair.lit, sensor.expose(&laser, Some(&sun), 6));
    assert_eq!(pair.unlit, sensor.expose(&Image::filled(60, 60, 0.0), Some(&sun), 7));
    assert_eq!(pair.difference, difference(&pair.lit.numbers, &pair.unlit.numbers));
    // The stripe's 1e-11 W are 28,543 electrons in 2 ms, 72 DN. The background is gone, but for noise of both
    // signs.
    let expected = sensor.gain * sensor.photoelectrons(1e-11);
    let row: Vec<i32> = (0..60).map(|i| pair.difference.at(i, 30)).collect();
    let mean = f64::from(row.iter().sum::<i32>()) / 60.0;
    // PRNU of 2 % of 72 and 18 DN, and shot noise: about 1.7 DN, 0.22 in the mean of 60.
    assert!((mean - expected).abs() < 0.9, "{mean} {expected}");
    let background: Vec<i32> = (0..60).map(|i| pair.difference.at(i, 10)).collect();
    assert!(background.iter().all(|value| value.abs() < 6));
    assert!(background.iter().any(|value| *value < 0) && background.iter().any(|value| *value > 0));
}

#[test]
fn numbers_alone_are_those_of_the_whole_chain() {
    // Most pixels dark, some faint, some beyond the full well of every preset; with and without a background.
    let mut light = Image::filled(67, 41, 0.0);
    for (index, watts) in light.cells_mut().iter_mut().enumerate().filter(|(index, _)| index % 7 == 0) {
        *watts = 1e-14 * (index * index) as f64;
    }
    let background = Image::filled(67, 41, 3e-13);
    let dim = DarkCurrent { rate: 5e3, ..DarkCurrent::NONE };
    let presets = PRESET_NAMES.iter().map(|name| preset(name).unwrap().1);
    // A sensor without noise but with dark current, and each kind of noise alone.
    let quiet = ImageSensor { dark_current: dim, bias: 3.0, ..ImageSensor::ideal() };
    let alone = [
        ImageSensor { shot_noise: true, ..quiet },
        ImageSensor { read_noise: 9.0, ..quiet },
        ImageSensor { prnu: 0.1, ..quiet },
        ImageSensor { dsnu: 20.0, ..quiet },
        quiet,
    ];
    for sensor in presets.chain(alone) {
        for background in [None, Some(&background)] {
            assert_eq!(sensor.numbers(&light, background, 5), sensor.expose(&light, background, 5).numbers);
            let difference = sensor.expose_pair(&light, background, 5).difference;
            let pattern = sensor.fixed_pattern(light.width(), light.height());
            for pattern in [None, Some(&pattern)] {
                assert_eq!(sensor.lit_minus_unlit(pattern, &light, [background; 2], 5), difference);
            }
        }
    }
}

#[test]
fn presets_are_valid() {
    for name in PRESET_NAMES {
        let (optics, sensor) = preset(name).expect("a preset");
        optics.validate("optics").expect("valid optics");
        sensor.validate("sensor").expect("a valid sensor");
        // A full well fills the converter to its largest number and does not exceed it.
        if sensor.full_well.is_finite() {
            assert_eq!(
                sensor.digitised(sensor.bias + sensor.gain * sensor.full_well),
                sensor.max_number() as u16
            );
        }
        // A stripe of the default rig is well above the dark level and well below saturation.
        let frame = sensor.expose(&Image::filled(8, 8, 1.2e-11), None, 0);
        let mean = frame.numbers.cells().iter().map(|number| f64::from(*number)).sum::<f64>() / 64.0;
        assert!(mean > 0.2 * sensor.max_number() && mean < 0.8 * sensor.max_number(), "{name}: {mean}");
    }
    assert!(preset("film").is_none());
    // Nothing is random in the ideal sensor.
    let ramp = Image::from_cells(100, 1, (0..100).map(|index| f64::from(index) * 1e-13).collect());
    assert_eq!(ImageSensor::ideal().expose(&ramp, None, 0), ImageSensor::ideal().expose(&ramp, None, 1));
}

#[test]
fn sensors_are_checked() {
    let refused = |sensor: ImageSensor| sensor.validate("sensor").expect_err("refused").field;
    let good = ImageSensor::cmos();
    assert_eq!(refused(ImageSensor { exposure: -1.0, ..good }), "sensor.exposure");
    assert_eq!(refused(ImageSensor { quantum_efficiency: 1.1, ..good }), "sensor.quantum_efficiency");
    assert_eq!(refused(ImageSensor { read_noise: f64::NAN, ..good }), "sensor.read_noise");
    assert_eq!(refused(ImageSensor { bits: 17, ..good }), "sensor.bits");
    assert_eq!(refused(ImageSensor { bias: 5000.0, ..good }), "sensor.bias");
    let cold = DarkCurrent { temperature: 0.0, ..good.dark_current };
    assert_eq!(refused(ImageSensor { dark_current: cold, ..good }), "sensor.dark_current.temperature");
}

/// All computations that use several threads.
fn run() -> (Vec<u64>, DigitalImage) {
    let camera = camera(48, 40, FILTER);
    let sources = (0..400).map(|index| {
        let x = f64::from(index) * 0.12;
        PointSource { x, y: 20.0 + libm::sin(x), watts: 1e-12, depth: 2.0 + 0.01 * x }
    });
    let imaged = Optics::dusty().form_image(&camera, sources);
    let normal = Image::filled(48, 40, Maybe::some(DVec3::Z));
    let range = Image::filled(48, 40, Maybe::some(4.0));
    let (reflectivity, sunlit) = (Image::filled(48, 40, 0.25), Image::filled(48, 40, true));
    let ground =
        VisibleSurface { normal: &normal, range: &range, reflectivity: &reflectivity, sunlit: &sunlit };
    let background = Sunlight::mars(0.6, 1.0, 0.5).flux(&camera, 1e-3, &ground);
    let frame =
        ImageSensor { seed: 99, ..ImageSensor::ccd_1989() }.expose(&imaged.optical, Some(&background), 5);
    let budget = imaged.budget;
    let mut bits: Vec<u64> = [imaged.fine.cells(), imaged.optical.cells(), background.cells()]
        .into_iter()
        .flatten()
        .map(|value| value.to_bits())
        .collect();
    bits.extend([budget.blurred_out, budget.scattered_out, budget.arrived].map(f64::to_bits));
    (bits, frame)
}

#[test]
fn the_bits_do_not_depend_on_threads_or_optimisation() {
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        pool.install(run)
    };
    let one = on(1);
    for threads in [2, 8] {
        assert!(on(threads) == one, "{threads} threads");
    }
    assert!(one.1.numbers.cells().iter().any(|number| *number > 20));
    // The bits do not depend on the machine or the optimisation either: one digest of all. (FNV-1a, 64 bits, of
    // words)
    let words = one.0.iter().copied().chain(one.1.numbers.cells().iter().map(|number| u64::from(*number)));
    let digest =
        words.fold(0xcbf2_9ce4_8422_2325_u64, |sum, word| (sum ^ word).wrapping_mul(0x0100_0000_01b3));
    assert_eq!(digest, 0xa1bb_00e8_3058_6a8a, "{digest:#x}");
}
