//! Unit tests of `rays`: the tiles of a sensor whose sides are no multiples of theirs.

use raypencil_scene::{Lens, Profile};

use super::*;

fn at_the_origin<T>(sensor: T) -> Mounted<T> {
    Mounted { scene_from_sensor: Pose::from_position(DVec3::new(1.0, 2.0, 3.0)), sensor }
}

/// A camera of 19 x 13 pixels.
fn camera() -> SensorRays {
    SensorRays::of_camera(&at_the_origin(Camera {
        width: 19,
        height: 13,
        pixel_pitch: [1e-3, 2e-3],
        focal_length: 1e-2,
        principal_point: [7.0, 5.0],
        aperture: 1e-3,
        lens: Lens::CLEAR,
        max_range: 10.0,
    }))
}

/// A beam of 150 x 3 pencils.
fn beam() -> SensorRays {
    let beam = Beam {
        columns: 150,
        rows: 3,
        thickness: 0.5,
        grid_distance: 0.1,
        half_width: 0.1,
        max_range: 10.0,
        power: 1.0,
        wavelength: 8e-7,
        profile: Profile::Paper,
    };
    SensorRays::of_beam(&at_the_origin(beam), PencilGrid::new(beam, 0, Sampling::Centres))
}

#[test]
fn a_lane_has_the_ray_of_its_cell_and_one_beyond_that_of_the_last() {
    for rays in [camera(), beam()] {
        let ((width, height), [columns, rows]) = (rays.size(), rays.tile_size().unwrap());
        for (first_i, first_j) in (0..height)
            .step_by(rows as usize)
            .flat_map(|j| (0..width).step_by(columns as usize).map(move |i| (i, j)))
        {
            let mut tile = Tile::EMPTY;
            let active = rays.fill(&mut tile, first_i, first_j);
            for lane in 0..TILE as u32 {
                let (i, j) = (first_i + lane % columns, first_j + lane / columns);
                assert_eq!(active >> lane & 1 == 1, i < width && j < height, "{i}, {j}");
                let ray = rays.ray(i.min(width - 1), j.min(height - 1));
                assert_eq!((tile.q(lane as usize), tile.origin), (ray.direction, ray.origin), "{i}, {j}");
            }
        }
    }
}
