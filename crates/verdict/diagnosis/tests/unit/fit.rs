//! Numbers and orders that are found from a recording.

use super::*;
use crate::it::candidates::{only, pyramids};
use raypencil_scene::{FaceId, Maybe};

#[test]
fn an_order_of_faces_needs_three_rays_for_each_index() {
    let bench = pyramids();
    let exact = bench.truth.answers().map(SensorId::Camera).face.as_ref().expect("faces of the camera");
    // Two faces that are met often, in place of each other.
    let mut counts: BTreeMap<u32, usize> = BTreeMap::new();
    exact
        .cells()
        .iter()
        .filter_map(|face| face.get())
        .for_each(|face| *counts.entry(face.0).or_default() += 1);
    let often: Vec<u32> = counts.into_iter().filter(|(_, count)| *count >= 3).map(|(face, _)| face).collect();
    let [a, b] = [often[0], often[1]];
    let found = |rays: [usize; 2]| {
        let mut candidate = only(&bench.exact, &[Quantity::Face]);
        let image = candidate.answers.maps[0].face.as_mut().expect("faces of the camera");
        let mut left = rays;
        for (cell, exact) in image.cells_mut().iter_mut().zip(exact.cells()) {
            let which = exact.get().and_then(|face| [a, b].iter().position(|one| *one == face.0));
            *cell = match which.filter(|which| left[*which] > 0) {
                Some(which) => {
                    left[which] -= 1;
                    Maybe::some(FaceId([b, a][which]))
                }
                None => Maybe::NONE,
            };
        }
        let sensors = [SensorId::Camera];
        let case = Case { truth: &bench.truth, recorded: &candidate, sensors: &sensors, tolerance: 1e-9 };
        faces(case, None).map(|found| found.mistake)
    };
    assert_eq!(found([3, 3]), Some(Mistake::FacesReordered));
    assert_eq!(found([3, 2]), None);
    // One index alone is no order.
    assert_eq!(found([3, 0]), None);
}
