//! Image formation: kernels, convolution, splats, and the balance of the flux.

use glam::DVec3;
use raypencil_scene::{Camera, Image, Lens};
use raypencil_sensor::{
    Dust, ImageLength, Kernel, NoiseSource, NoiseStream, Optics, PointSource, Psf, Speckle, ThinLens,
    airy_pattern, binned, convolve, encircled_energy, splat, splat_defocused,
};

/// The default camera, small.
fn camera(width: u32, height: u32) -> Camera {
    Camera {
        width,
        height,
        pixel_pitch: [9e-6, 9e-6],
        focal_length: 8e-3,
        principal_point: [f64::from(width) / 2.0, f64::from(height) / 2.0],
        aperture: 2e-3,
        lens: Lens::CLEAR,
        max_range: 20.0,
    }
}

fn sum(image: &Image<f64>) -> f64 {
    image.cells().iter().sum()
}

/// Image with half of its cells dark and random light in the others.
fn speckle(width: u32, height: u32) -> Image<f64> {
    let mut stream = NoiseStream::new(1, NoiseSource::Shot, 0, 0);
    let cells = (0..width * height).map(|_| (stream.uniform() - 0.5).max(0.0)).collect();
    Image::from_cells(width, height, cells)
}

fn direct_sum(image: &Image<f64>, kernel: &Kernel) -> Image<f64> {
    let (width, height) = (image.width() as i32, image.height() as i32);
    let mut out = Image::filled(image.width(), image.height(), 0.0);
    for j in 0..height {
        for i in 0..width {
            let mut total = 0.0;
            for from_j in 0..height {
                for from_i in 0..width {
                    let value = image.at(from_i as u32, from_j as u32);
                    total += value * kernel.weight(i - from_i, j - from_j);
                }
            }
            out.set(i as u32, j as u32, total);
        }
    }
    out
}

fn kernels() -> Vec<Kernel> {
    let lopsided: Vec<f64> = (0..15).map(|index| f64::from(index % 7) + 0.25).collect();
    vec![
        Kernel::identity(),
        Kernel::gaussian([1.3, 0.4]),
        Kernel::airy(810e-9, 4.0, 3, [2.25e-6, 3e-6]),
        Kernel::from_weights(5, 3, &lopsided).expect("a kernel"),
        // Kernels larger than the image.
        Kernel::gaussian([9.0, 7.0]),
        Kernel::from_weights(41, 1, &[1.0; 41]).expect("a kernel"),
    ]
}

#[test]
fn convolution_is_the_direct_sum() {
    let image = speckle(17, 13);
    for kernel in kernels() {
        let (fast, slow) = (convolve(&image, &kernel).image, direct_sum(&image, &kernel));
        for (a, b) in fast.cells().iter().zip(slow.cells()) {
            // Some 200 roundings of sums up to 1.
            assert!((a - b).abs() < 1e-13, "{a} {b}");
        }
    }
}

#[test]
fn convolution_conserves_energy() {
    let image = speckle(17, 13);
    for kernel in kernels() {
        let out = convolve(&image, &kernel);
        let (before, after) = (sum(&image), sum(&out.image) + out.lost);
        assert!((before - after).abs() < 1e-12 * before, "{before} {after}");
        assert!(out.lost >= 0.0);
    }
    // Far from the sides no light is lost.
    let mut point = Image::filled(101, 101, 0.0);
    point.set(50, 50, 3.0);
    let out = convolve(&point, &Kernel::gaussian([2.0, 2.0]));
    assert_eq!(out.lost, 0.0);
    assert!((sum(&out.image) - 3.0).abs() < 3e-12);
}

/// Sum of weights, and second moments across and down.
fn moments(kernel: &Kernel) -> (f64, f64, f64) {
    let half = kernel.half_widths().map(|half| half as i32);
    let (mut all, mut across, mut down) = (0.0, 0.0, 0.0);
    for j in -half[1]..=half[1] {
        for i in -half[0]..=half[0] {
            let weight = kernel.weight(i, j);
            all += weight;
            across += weight * f64::from(i * i);
            down += weight * f64::from(j * j);
        }
    }
    (all, across, down)
}

#[test]
fn a_gaussian_has_its_second_moment() {
    for sigma in [[3.0, 1.0], [0.7, 12.0]] {
        let (all, across, down) = moments(&Kernel::gaussian(sigma));
        assert!((all - 1.0).abs() < 1e-14);
        // The second moment is sigma^2 + 1/12, since light is known to cells only. The cut at 6 sigma removes
        // 2e-7 of it. Sheppard's correction is off by 16 pi^2 sigma^2 exp(-2 pi^2 sigma^2), 5e-3 at 0.7.
        for (moment, sigma) in [(across, sigma[0]), (down, sigma[1])] {
            let bound = 2e-7 * sigma * sigma + 160.0 * sigma * sigma * libm::exp(-19.7 * sigma * sigma);
            assert!((moment - sigma * sigma - 1.0 / 12.0).abs() < bound, "{moment} for {sigma}");
        }
    }
    // However narrow the Gaussian is, its light stays.
    assert!((Kernel::gaussian([1e-3, 1e-300]).weight(0, 0) - 1.0).abs() < 1e-15);
    assert_eq!(Kernel::gaussian([0.0, 0.0]), Kernel::identity());
}

#[test]
fn an_airy_kernel_is_the_pattern() {
    // Ten cells per lambda N: the first dark ring is at 12.197 cells.
    let (wavelength, f_number) = (810e-9, 4.0);
    let unit = wavelength * f_number;
    let kernel = Kernel::airy(wavelength, f_number, 8, [0.1 * unit, 0.1 * unit]);
    let darkest = (5..16).min_by(|a, b| kernel.weight(*a, 0).total_cmp(&kernel.weight(*b, 0)));
    assert_eq!(darkest, Some(12));
    for k in [0, 3, 7, 16] {
        let expected = airy_pattern(f64::from(k) * 0.1 * unit, wavelength, f_number);
        let found = kernel.weight(k, 0) / kernel.weight(0, 0);
        // The mean of a cell differs from its middle by the cell's second moment, 0.01 lambda^2 N^2 / 12, times
        // half the curvature.
        assert!((found - expected).abs() < 0.01, "{k}: {found} {expected}");
        for turned in [kernel.weight(-k, 0), kernel.weight(0, k), kernel.weight(0, -k)] {
            assert!((turned - kernel.weight(k, 0)).abs() < 1e-15);
        }
    }
    // The first dark ring encloses 83.8 % of all light, hence 0.838 / 0.975 of the kernel's.
    let mut within = 0.0;
    for j in -13..=13 {
        for i in -13..=13 {
            if i * i + j * j < 149 {
                within += kernel.weight(i, j);
            }
        }
    }
    let held = encircled_energy(8.25 * unit, wavelength, f_number);
    assert!((held - 0.975).abs() < 1e-3, "{held}");
    assert!((within - 0.8378 / held).abs() < 1e-3, "{within}");
}

#[test]
fn kernels_of_numbers_are_checked() {
    assert!(Kernel::from_weights(2, 1, &[1.0, 1.0]).is_err());
    assert!(Kernel::from_weights(3, 1, &[1.0, 1.0]).is_err());
    assert!(Kernel::from_weights(3, 1, &[1.0, -1.0, 1.0]).is_err());
    assert!(Kernel::from_weights(1, 1, &[f64::NAN]).is_err());
    assert!(Kernel::from_weights(1, 1, &[0.0]).is_err());
    // At most 512 cells from the middle to an end: sides of 2 * 512 + 1.
    for (columns, rows) in [(1025, 1), (1, 1025)] {
        assert!(Kernel::from_weights(columns, rows, &[1.0; 1025]).is_ok());
    }
    for (columns, rows) in [(1027, 1), (1, 1027)] {
        assert!(Kernel::from_weights(columns, rows, &[1.0; 1027]).is_err());
    }
    let kernel = Kernel::from_weights(3, 1, &[1.0, 2.0, 5.0]).expect("a kernel");
    // Weights right of the middle move light to the right.
    let mut point = Image::filled(5, 1, 0.0);
    point.set(2, 0, 8.0);
    assert_eq!(convolve(&point, &kernel).image.cells(), &[0.0, 1.0, 2.0, 5.0, 0.0]);
}

#[test]
fn defocus_by_hand() {
    let camera = camera(8, 8);
    let lens = ThinLens { aperture: 2e-3, focal_length: 8e-3, focus: 4.0 };
    // D f |z - z_f| / (z (z_f - f)) = 2e-3 8e-3 2 / (2 3.992) = 4.008016e-6 m at z = 2.
    assert!((lens.blur_diameter(2.0) - 4.008_016e-6).abs() < 1e-12);
    assert_eq!(lens.blur_diameter(4.0), 0.0);
    // Focus at infinity: D f / z.
    let far = ThinLens { focus: f64::INFINITY, ..lens };
    assert!((far.blur_diameter(2.0) - 8e-6).abs() < 1e-18);
    // With f from the camera's image distance it is D f_c |1/z - 1/z_f| = 2e-3 8e-3 / 4.
    let of_camera = ThinLens::for_camera(&camera, 4.0);
    assert!((of_camera.blur_diameter(2.0) - 4e-6).abs() < 1e-18);
    assert!((1.0 / of_camera.focal_length - 1.0 / 8e-3 - 1.0 / 4.0).abs() < 1e-12);
    assert!(of_camera.validate("lens").is_ok() && far.validate("lens").is_ok());
    assert!(ThinLens { focus: 7e-3, ..lens }.validate("lens").is_err());
}

#[test]
fn discs_share_their_light_by_area() {
    let pitch = [9e-6, 9e-6];
    let lens = ThinLens { aperture: 8e-3, focal_length: 8e-3, focus: 4.0 };
    let source = |x, y, depth| PointSource { x, y, watts: 2.0, depth };
    // At z = 1: c = 8e-3 8e-3 3 / 3.992 = 4.80962e-5 m or 5.34402 pixels. With 4 cells per pixel the radius is
    // 10.68804 cells.
    let radius = 0.5 * lens.blur_diameter(1.0) / 9e-6 * 4.0;
    assert!((radius - 10.688_04).abs() < 1e-4);
    let out = splat_defocused(16, 16, 4, pitch, &lens, [source(8.1, 7.9, 1.0)]);
    assert!((sum(&out.image) - 2.0).abs() < 1e-12);
    assert!(out.lost < 1e-12);
    // A cell within the disc has its fraction of the area; a cell beyond has none.
    let inner = 2.0 / (std::f64::consts::PI * radius * radius);
    assert!((out.image.at(32, 31) - inner).abs() < 1e-13);
    assert_eq!(out.image.at(32 + 12, 31), 0.0);
    // Half of the disc lies beside the image.
    let out = splat_defocused(16, 16, 4, pitch, &lens, [source(0.0, 8.0, 1.0)]);
    assert!((out.lost - 1.0).abs() < 1e-12 && (sum(&out.image) - 1.0).abs() < 1e-12);
    // One disc partly over a corner, one beside the image.
    let out = splat_defocused(16, 16, 4, pitch, &lens, [source(15.0, 15.5, 1.0), source(-9.0, 3.0, 1.0)]);
    assert!((out.lost + sum(&out.image) - 4.0).abs() < 4e-12 && out.lost > 2.0);
    // In focus, the result equals the plain splat.
    let sharp = [source(3.3, 4.7, 4.0), source(-0.1, 3.0, 4.0)];
    assert_eq!(splat_defocused(16, 16, 4, pitch, &lens, sharp), splat(16, 16, 4, sharp));
    // The second moment is R^2 / 4 on each axis.
    let out = splat_defocused(16, 16, 4, pitch, &lens, [source(8.0, 8.0, 1.0)]);
    let mut moment = 0.0;
    for j in 0..64 {
        for i in 0..64 {
            let x = f64::from(i) + 0.5 - 32.0;
            moment += out.image.at(i, j) * x * x / 2.0;
        }
    }
    assert!((moment - radius * radius / 4.0 - 1.0 / 12.0).abs() < 0.05, "{moment}");
}

#[test]
fn a_point_of_space_is_projected_by_the_camera_s_own_numbers() {
    // Pixels 1/64 m wide and 1/32 m high, 1/2 m behind the pinhole; the axis meets the image at (10, 20). The point is
    // 1 m to the right of the axis and 1 m above it (y is down) at 4 m: 1/2 * 1 / (4 / 64) = 8 pixels to the right,
    // and 1/2 * 1 / (4 / 32) = 4 pixels up.
    let camera = Camera {
        pixel_pitch: [1.0 / 64.0, 1.0 / 32.0],
        focal_length: 0.5,
        principal_point: [10.0, 20.0],
        ..camera(32, 32)
    };
    let source = PointSource::project(&camera, DVec3::new(1.0, -1.0, 4.0), 0.25);
    assert_eq!(source, PointSource { x: 18.0, y: 16.0, watts: 0.25, depth: 4.0 });
}

#[test]
fn splats_land_in_their_cells() {
    let at = |x, y, watts| PointSource { x, y, watts, depth: 1.0 };
    // Column 4 x 1.5 = 6, row 4 x 0.26 = 1.04.
    let out =
        splat(2, 1, 4, [at(1.5, 0.26, 1.0), at(1.6, 0.3, 2.0), at(2.0, 0.5, 4.0), at(f64::NAN, 0.0, 8.0)]);
    assert_eq!((out.image.width(), out.image.height()), (8, 4));
    assert_eq!(out.image.at(6, 1), 3.0);
    assert_eq!((sum(&out.image), out.lost), (3.0, 12.0));
    assert_eq!(binned(&out.image, 4).cells(), &[0.0, 3.0]);
    // A point 10 m ahead, 1 m right, 2 m up: 8e-3 / 9e-6 (0.1, -0.2) = (88.89, -177.78) pixels from the middle of
    // 1024.
    let source = PointSource::project(&camera(1024, 1024), DVec3::new(1.0, -2.0, 10.0), 5.0);
    assert!((source.x - 600.888_888).abs() < 1e-5 && (source.y - 334.222_222).abs() < 1e-5);
    assert_eq!((source.watts, source.depth), (5.0, 10.0));
}

#[test]
fn a_point_lands_in_the_cell_that_holds_it() {
    // Four cells along the side of a pixel: column 4 x 1.7 = 6.8 lies in cell 6, row 4 x 0.45 = 1.8 in cell 1.
    let out = splat(2, 1, 4, [PointSource { x: 1.7, y: 0.45, watts: 1.0, depth: 1.0 }]);
    assert_eq!(out.image.at(6, 1), 1.0);
}

fn sources() -> Vec<PointSource> {
    let mut stream = NoiseStream::new(4, NoiseSource::Shot, 0, 0);
    // Some of the sources lie beside the image.
    let mut number = |from: f64, to: f64| from + (to - from) * stream.uniform();
    (0..500)
        .map(|_| PointSource {
            x: number(-2.0, 34.0),
            y: number(-2.0, 26.0),
            watts: number(0.0, 1e-12),
            depth: number(0.5, 20.0),
        })
        .collect()
}

#[test]
fn the_flux_budget_balances() {
    let camera = camera(32, 24);
    let dust = Dust { transmission: 0.8, halo_share: 0.2, halo_sigma: ImageLength::Pixels(5.0) };
    let all = Optics {
        oversampling: 4,
        focus: Some(3.0),
        blurs: vec![
            Psf::Airy { wavelength: 810e-9, f_number: 4.0, rings: 4 },
            Psf::Gaussian { sigma: ImageLength::Metres(6e-6) },
            Psf::Sampled(Kernel::from_weights(3, 1, &[0.0, 1.0, 1.0]).expect("a kernel")),
        ],
        dust: Some(dust),
        speckle: Some(Speckle::behind(&camera, 810e-9, 1.0)),
    };
    assert!(all.validate("optics").is_ok());
    for optics in [all.clone(), Optics::PERFECT, Optics::dusty(), Optics::diffraction_limited()] {
        let imaged = optics.form_image(&camera, sources());
        let account = imaged.budget;
        let passed = account.absorbed + account.scattered_out + account.arrived;
        let spent = account.missed + account.blurred_out + account.speckled + passed;
        assert_eq!(account.speckled != 0.0, optics.speckle.is_some());
        assert!((account.entered - spent).abs() < 1e-12 * account.entered, "{account:?}");
        assert!(account.missed > 0.0 && (sum(&imaged.optical) - account.arrived).abs() < 1e-24);
    }
    // Perfect optics put each pencil into its pixel.
    let plain = splat(32, 24, 1, sources());
    assert_eq!(Optics::PERFECT.form_image(&camera, sources()).optical, plain.image);
    // Dust on an even image leaves T of it, far from the sides.
    let even = Image::filled(100, 100, 2.0);
    let veiled = all.filter_pixels(&camera, &even);
    assert!((veiled.at(50, 50) - 1.6).abs() < 1e-7);
    // A point keeps T (1 - h) and a little of its own halo.
    let mut point = Image::filled(101, 101, 0.0);
    point.set(50, 50, 1.0);
    let kernel = Kernel::gaussian([5.0, 5.0]);
    let veiled = all.filter_pixels(&camera, &point);
    assert!((veiled.at(50, 50) - 0.64 - 0.16 * kernel.weight(0, 0)).abs() < 1e-15);
    assert!((veiled.at(58, 50) - 0.16 * kernel.weight(8, 0)).abs() < 1e-15);
}

#[test]
fn optics_are_checked() {
    let refused = |optics: Optics| optics.validate("optics").expect_err("refused").field;
    assert_eq!(refused(Optics { oversampling: 0, ..Optics::PERFECT }), "optics.oversampling");
    assert_eq!(refused(Optics { focus: Some(f64::NAN), ..Optics::PERFECT }), "optics.focus");
    let blurs = vec![Psf::Gaussian { sigma: ImageLength::Pixels(-1.0) }];
    assert_eq!(refused(Optics { blurs, ..Optics::PERFECT }), "optics.blurs[0].sigma.pixels");
    let dust = Some(Dust { transmission: 1.5, halo_share: 0.0, halo_sigma: ImageLength::Pixels(1.0) });
    assert_eq!(refused(Optics { dust, ..Optics::PERFECT }), "optics.dust.transmission");
    for (contrast, grain, field) in [(1.1, 1e-6, "contrast"), (-0.1, 1e-6, "contrast"), (1.0, 0.0, "grain")] {
        let speckle = Some(Speckle { contrast, grain });
        assert_eq!(refused(Optics { speckle, ..Optics::PERFECT }), format!("optics.speckle.{field}"));
    }
}
