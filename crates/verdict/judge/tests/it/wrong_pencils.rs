//! The light of pencils that are wrong: a pixel is judged by itself, and a flux by the visibility that goes with it.

use raypencil_judge::{Class, GroundTruth, Recorded, check, check_ray};
use raypencil_scene::{FluxModel, Maybe, Place, Precision, RenderOutput, SensorId, Silent};

use super::walls::{exact, map, returns, walls};

#[test]
fn a_right_pixel_stays_right_where_its_pencils_are_wrong() {
    let scene = walls(FluxModel::Radiometric);
    let truth = GroundTruth::certified(&scene, &Silent);
    let mut output = exact(&scene);
    // A program rounds its sums: its light is a few last digits off.
    let image = &mut output.flux[0];
    image.cells_mut().iter_mut().for_each(|flux| *flux *= 1.0 + 2.0 * f64::EPSILON);
    let wrong_pixels = |output: &RenderOutput| {
        let recorded = Recorded::of_output("mine", &scene, output, Precision::F64);
        check(&truth, &recorded, &Silent).sensors[0].of(Class::Defect)
    };
    assert_eq!(wrong_pixels(&output), 0);
    let lit = output.flux[0].cells().iter().filter(|flux| **flux > 0.0).count() as u64;
    assert_ne!(lit, 0);
    // The pencils, which it writes to files of their own, are said to meet nothing, or to be hidden.
    let mut lost = output.clone();
    map(&mut lost).face.as_mut().unwrap().cells_mut().fill(Maybe::NONE);
    map(&mut lost).range.as_mut().unwrap().cells_mut().fill(Maybe::NONE);
    let mut hidden = output.clone();
    returns(&mut hidden).visible.as_mut().unwrap().cells_mut().fill(false);
    // The light is held to the same bound as beside right pencils.
    let brighter = |output: &RenderOutput, by: f64| {
        let mut output = output.clone();
        output.flux[0].cells_mut().iter_mut().for_each(|flux| *flux *= 1.0 + by);
        wrong_pixels(&output)
    };
    // Each a fifth larger than the one before, so that a bound that is a quarter off is noticed.
    let sizes: Vec<f64> =
        std::iter::successors(Some(1e-15), |by| Some(1.2 * by)).take_while(|by| *by < 1e-10).collect();
    let wrong_by_size = |output: &RenderOutput, sizes: &[f64]| -> Vec<u64> {
        sizes.iter().map(|by| brighter(output, *by)).collect()
    };
    let all = wrong_by_size(&output, &sizes);
    assert_eq!((all[0], all[sizes.len() - 1]), (0, lit));
    // Beside wrong pencils, all of which are judged anew for each size: where the first pixels are found wrong, where the last ones
    // are, and between.
    let first = all.iter().position(|wrong| *wrong > 0).expect("a size that is noticed");
    let last = all.iter().position(|wrong| *wrong == lit).expect("a size that all pixels notice");
    let near = [first - 1, first, first.midpoint(last), last - 1, last];
    let (tried, expected): (Vec<f64>, Vec<u64>) = near.into_iter().map(|k| (sizes[k], all[k])).unzip();
    for wrong in [lost, hidden] {
        assert_eq!(wrong_by_size(&wrong, &tried), expected);
    }
}

#[test]
fn flux_that_follows_from_a_wrong_visibility_is_said_to() {
    let scene = walls(FluxModel::Radiometric);
    let mut output = exact(&scene);
    let seen = returns(&mut output).visible.clone().unwrap();
    let (i, j) = (0..seen.height())
        .flat_map(|j| (0..seen.width()).map(move |i| (i, j)))
        .find(|(i, j)| seen.at(*i, *j))
        .expect("a pencil that is seen");
    let text = |output: &RenderOutput| {
        let recorded = Recorded::of_output("mine", &scene, output, Precision::F64);
        check_ray(&scene, &recorded, Place { sensor: SensorId::Beam(0), i, j }).unwrap().text("mine")
    };
    assert!(!text(&output).contains("with its own visibility"));
    // Hidden, and so dark: the visibility alone is wrong.
    returns(&mut output).visible.as_mut().unwrap().set(i, j, false);
    returns(&mut output).flux.as_mut().unwrap().set(i, j, 0.0);
    let hidden = text(&output);
    assert!(hidden.contains("pencil flux: says 0"), "{hidden}");
    assert_eq!(hidden.matches(": agrees with its own visibility").count(), 1, "{hidden}");
    assert_eq!(hidden.matches(": defect\n").count(), 1, "{hidden}");
}

#[test]
fn a_part_of_a_bound_is_told_of_the_error_that_is_shown_alone() {
    let scene = walls(FluxModel::Radiometric);
    let mut output = exact(&scene);
    let (seen, flux) =
        (returns(&mut output).visible.clone().unwrap(), returns(&mut output).flux.clone().unwrap());
    let (i, j) = (0..seen.height())
        .flat_map(|j| (0..seen.width()).map(move |i| (i, j)))
        .find(|(i, j)| seen.at(*i, *j) && flux.at(*i, *j) > 0.0)
        .expect("a pencil that is seen");
    let line_of = |output: &RenderOutput| {
        let recorded = Recorded::of_output("mine", &scene, output, Precision::F64);
        let place = Place { sensor: SensorId::Beam(0), i, j };
        let text = check_ray(&scene, &recorded, place).unwrap().text("mine");
        text.lines().find(|line| line.contains("pencil flux: says")).expect("the flux").to_string()
    };
    returns(&mut output).flux.as_mut().unwrap().set(i, j, 2.0 * flux.at(i, j));
    let twice = line_of(&output);
    assert!(twice.contains(", off by ") && twice.contains(" times its bound"), "{twice}");
    // Hidden by its own word, where no flux is right: what is judged is a thousandth of what is shown.
    returns(&mut output).visible.as_mut().unwrap().set(i, j, false);
    returns(&mut output).flux.as_mut().unwrap().set(i, j, 0.001 * flux.at(i, j));
    let hidden = line_of(&output);
    assert!(hidden.contains(", off by ") && !hidden.contains("times its bound"), "{hidden}");
}
