//! Clouds as text: what printing may do is excused, and nothing more. Walls of the room stand at whole coordinates, of which a program
//! prints no decimals.

use glam::DVec3;
use raypencil_cast::{CandidateConventions, CloudFrame};

use super::cloud_trial::{Trial, head, points, still};

/// How a program prints a number.
type Print<'p> = &'p dyn Fn(f64) -> String;

/// So many significant digits, as `%.8g` prints them.
fn significant(digits: usize, number: f64) -> String {
    let rounded: f64 = format!("{number:.*e}", digits - 1).parse().expect("a number");
    rounded.to_string()
}

#[test]
fn a_wrong_point_is_wrong_however_short_one_of_its_coordinates_is() {
    let trial = Trial::new(&head(), &still());
    let right: Vec<DVec3> = points(&trial.set, CloudFrame::Mesh).iter().map(|point| point.place).collect();
    let hits = right.iter().filter(|place| place.is_finite()).count() as u64;
    let on_walls = right
        .iter()
        .filter(|place| [12.0, -7.0].contains(&place.x) || [9.0, -5.0].contains(&place.y))
        .count();
    assert!(hits > 1500 && on_walls > 500, "{on_walls} of {hits}");
    let wrong = |print: Print<'_>, place: &dyn Fn(DVec3) -> DVec3| {
        let mut text = format!(
            "VERSION 0.7\nFIELDS x y z\nSIZE 8 8 8\nTYPE F F F\nWIDTH {count}\nHEIGHT 1\nPOINTS {count}\nDATA ascii\n",
            count = right.len()
        );
        for place in right.iter().map(|right| place(*right)) {
            let [x, y, z] = place.to_array().map(print);
            text += &format!("{x} {y} {z}\n");
        }
        let file = trial.folder.path().join("text.pcd");
        std::fs::write(&file, text).expect("a file");
        let checked = trial.check(&file, CandidateConventions::default()).expect("a check");
        checked.comparison.counts().wrong
    };
    let origin = trial.set.set.rays()[0].origin;
    let formats: [(&str, f64, Print<'_>); 4] = [
        ("shortest", 1e-10, &|number| number.to_string()),
        ("%.8g", 1e-6, &|number| significant(8, number)),
        ("%.4f", 1e-3, &|number| format!("{number:.4}")),
        ("%.4f without zeros at the end", 1e-3, &|number| {
            format!("{number:.4}").trim_end_matches('0').trim_end_matches('.').to_string()
        }),
    ];
    for (name, share, print) in formats {
        assert_eq!(wrong(print, &|place| place), 0, "{name}");
        // Many roundings too far away, each of them.
        assert_eq!(wrong(print, &|place| origin + (place - origin) * (1.0 + share)), hits, "{name}");
    }
}
