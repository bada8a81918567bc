//! Packs of rays: what contradicts itself is wrong; what is not read is named or refused.

use std::path::Path;

use raypencil_cast::{CandidateConventions, check_ray_pack, compare, comparison_text, read_stated};
use raypencil_files::{read_npy_numbers, write_npy_numbers};
use raypencil_scene::{Precision, Sides, Silent};

use super::pack_trial::{Folders, cube, rays};

/// One array says that a ray hits, another that it does not.
#[test]
fn answers_that_disagree_with_themselves_are_wrong_whatever_is_right() {
    let right = Folders::right;
    let t = right().of("t");
    let misses: Vec<usize> = (0..t.len()).filter(|&ray| t[ray].is_infinite()).collect();
    let hits: Vec<usize> = (0..t.len()).filter(|&ray| t[ray].is_finite()).collect();
    let (miss, hit) = (misses[2], hits[5]);
    let at = |name: &str, ray: usize, parts: usize, number: f64| {
        right().change(name, move |index, value| if index / parts == ray { number } else { value })
    };
    let (mesh, asked) = (cube(), rays());
    let wrong = |folders: &Folders, ray: usize, words: &str| {
        let path = folders.candidate.path();
        let stated = read_stated(path, &asked.shape, CandidateConventions::default()).unwrap();
        let compared = compare(&mesh, &asked.rays, Sides::Both, &stated, Precision::F64, &Silent);
        let found: Vec<_> = compared.wrong().collect();
        assert!(!compared.passes() && found.len() == 1 && found[0].0 == ray, "{words}: {found:?}");
        let text = comparison_text("mine", &compared, |_| String::new());
        assert!(text.contains(words), "{words}: {text}");
    };
    // A value where the face, or else the first distance, says that nothing is hit.
    for (name, parts, number) in [
        ("t", 1, 5.0),
        ("range", 1, 5.0),
        ("side", 1, -1.0),
        ("point", 3, 0.0),
        ("normal", 3, 0.5),
        ("barycentric", 3, 0.25),
        ("cos_incidence", 1, 0.5),
    ] {
        let words = format!("face says that nothing is hit, and {name} is {number}");
        wrong(&at(name, miss, parts, number), miss, &words);
        // `t` leads where there is no face.
        if name != "t" {
            let words = format!("t says that nothing is hit, and {name} is {number}");
            wrong(&at(name, miss, parts, number).without(&["face"]), miss, &words);
        }
        // Of two arrays too.
        let two = at(name, miss, parts, number);
        let all = ["t", "range", "side", "point", "normal", "barycentric", "cos_incidence"];
        let others: Vec<&str> = all.into_iter().filter(|other| *other != name).collect();
        wrong(&two.without(&others), miss, "face says that nothing is hit");
    }
    // A face whose distance says that nothing is hit.
    for (name, number) in [("t", f64::INFINITY), ("range", f64::NAN), ("t", f64::NEG_INFINITY)] {
        let said = if number.is_nan() { f64::INFINITY } else { number };
        wrong(
            &at(name, hit, 1, number),
            hit,
            &format!("face says that something is hit, and {name} is {said}"),
        );
    }
    // No normal and no weights are (0, 0, 0).
    let none = at("normal", miss, 3, 0.0);
    let weights = at("barycentric", miss, 3, 0.0).of("barycentric");
    let none = none.change("barycentric", move |index, _| weights[index]);
    assert!(
        none.change("cos_incidence", move |index, cos| if index == miss { 0.0 } else { cos })
            .check()
            .passes()
    );
    // Nor do the weights of u = v = 0, or a t that is the ray's end beside a face, say that something is hit.
    let of_corner = at("barycentric", miss, 3, 0.0);
    assert!(
        of_corner
            .change("barycentric", move |index, w| if index == 3 * miss { 1.0 } else { w })
            .check()
            .passes()
    );
    let of_edge = at("barycentric", miss, 3, 0.0).change("barycentric", move |index, w| match index {
        index if index / 3 == miss && index % 3 < 2 => 0.5,
        _ => w,
    });
    wrong(&of_edge, miss, "barycentric is 0.5");
    // A number that is declared is none, as it is stored; another one is.
    let all = ["t", "range", "point", "normal", "barycentric", "cos_incidence"];
    for (number, is_single) in [(7.5, false), (0.1, true), (0.0, false)] {
        let filled = all.iter().fold(right(), |folders, name| {
            folders.change(name, move |_, value| if value.is_finite() { value } else { number })
        });
        let filled = if is_single { filled.store(false, 0, &all) } else { filled };
        let declared = |miss| CandidateConventions { miss: Some(miss), ..CandidateConventions::default() };
        let checked = filled.check_by(Precision::F64, declared(number));
        assert!(checked.passes(), "{number}: {:?}", checked.comparison.wrong().next());
        assert!(!filled.check_by(Precision::F64, declared(8.5)).passes());
        let words = format!("if {number} means no hit: declare --miss {number}");
        // Single precision has another number, which is not 0.1.
        if !is_single {
            filled.expect_why(&["100.0000 %", &words]);
        }
    }
}

#[test]
fn an_array_of_another_name_is_named() {
    let renamed = |from: &str, to: &str| {
        let folders = Folders::right();
        let path = folders.candidate.path();
        // What this program wrote is known to be its own.
        std::fs::remove_file(path.join("summary.json")).unwrap();
        for own in ["ties", "origin", "direction"] {
            let _ = std::fs::remove_file(path.join(format!("{own}.npy")));
        }
        std::fs::rename(path.join(from), path.join(to)).unwrap();
        folders
    };
    for (from, to, words) in [
        ("face.npy", "faces.npy", "faces.npy (meant as face.npy?)"),
        ("normal.npy", "Normals.npy", "Normals.npy (meant as normal.npy?)"),
        ("t.npy", "distance.npy", "distance.npy (meant as t.npy?)"),
        ("point.npy", "Point.npy", "Point.npy (meant as point.npy?)"),
        ("side.npy", "temperature.npy", "temperature.npy"),
        ("barycentric.npy", "barycentrics.npz", "barycentrics.npz (meant as barycentric.npy?)"),
    ] {
        let checked = renamed(from, to).check();
        assert!(checked.passes());
        assert_eq!(checked.unread, [words]);
        let text = checked.document().screen();
        assert!(text.contains(&format!("Not read, for no array has that name: {words}.")), "{text}");
    }
    assert_eq!(Folders::right().check().unread, [""; 0]);
    let only = renamed("face.npy", "faces.npy").without(&["t", "range"]);
    let conventions = CandidateConventions::default();
    let refused =
        check_ray_pack(only.pack.path(), only.candidate.path(), Precision::F64, conventions, &Silent);
    let message = refused.unwrap_err().to_string();
    assert!(
        message.contains("folder: none of them, but faces.npy (meant as face.npy?); expected"),
        "{message}"
    );
}

#[test]
fn a_changed_pack_and_arrays_of_another_shape_are_refused() {
    let refused = |folders: &Folders| -> String {
        let (pack, candidate): (&Path, &Path) = (folders.pack.path(), folders.candidate.path());
        let conventions = CandidateConventions::default();
        check_ray_pack(pack, candidate, Precision::F64, conventions, &Silent).unwrap_err().to_string()
    };
    let folders = Folders::right();
    write_npy_numbers(folders.candidate.path().join("t.npy"), &[20, 10], &[0.0; 200]).unwrap();
    assert!(
        refused(&folders).contains("shape: [20, 10]; expected [10, 20], or flat [200]"),
        "{}",
        refused(&folders)
    );
    let folders = Folders::right().change("face", |_, _| 5.5);
    assert!(refused(&folders).contains("cell 0: 5.5"), "{}", refused(&folders));
    for (number, found) in [(2.0, "2"), (f64::NAN, "NaN"), (-1.0, "-1")] {
        let folders = Folders::right().with_hits(&[true; 200]);
        let folders = folders.change("hit", |ray, hit| if ray == 3 { number } else { hit });
        let words = format!("hit.npy: cell 3: {found}; expected 1 where the ray hits, 0 where it does not");
        assert!(refused(&folders).ends_with(&words), "{}", refused(&folders));
    }
    for (number, shown) in
        [(2.0, "2"), (0.5, "0.5"), (-77.0, "-77"), (1e-300, "1e-300"), (f64::INFINITY, "inf")]
    {
        let folders = Folders::right().change("side", |ray, side| if ray == 3 { number } else { side });
        let words =
            format!("side.npy: cell 3: {shown}; expected 1 for a front, -1 for a back, 0 or NaN where");
        assert!(refused(&folders).contains(&words), "{}", refused(&folders));
    }
    let folders = Folders::right();
    write_npy_numbers(folders.pack.path().join("rays.npy"), &[1, 8], &[1.0; 8]).unwrap();
    assert!(refused(&folders).contains("SHA-256"), "{}", refused(&folders));
    // How many rays test what follows from the pack.
    let folders = Folders::right();
    let listing = folders.pack.path().join("raypack.json");
    let written: serde_json::Value = serde_json::from_slice(&std::fs::read(&listing).unwrap()).unwrap();
    for (key, count) in written["counts"].as_object().unwrap() {
        let mut document = written.clone();
        document["counts"][key] = (count.as_u64().unwrap() + 1).into();
        std::fs::write(&listing, document.to_string()).unwrap();
        let message = refused(&folders);
        assert!(message.contains(&format!("counts.{key}: ")), "{message}");
    }
    let mut document = written;
    document["counts"]["rounded"] = 3.into();
    std::fs::write(&listing, document.to_string()).unwrap();
    assert!(refused(&folders).contains("counts.rounded: 3; expected no such count"), "{}", refused(&folders));
    // An answer is changed; then its digest is too.
    let folders = Folders::right();
    let t = folders.pack.path().join("t.npy");
    let array = read_npy_numbers(&t, &Default::default()).unwrap();
    let mut changed = array.values.clone();
    let hit = changed.iter().position(|t| t.is_finite()).unwrap();
    changed[hit] = changed[hit].next_up();
    write_npy_numbers(&t, &array.shape, &changed).unwrap();
    let message = refused(&folders);
    assert!(message.contains("t.npy") && message.contains("SHA-256"), "{message}");
    let listing = folders.pack.path().join("raypack.json");
    let (old, new) = message
        .split_once("expected ")
        .map(|(found, expected)| {
            let digest = |text: &str| {
                text.split(|c: char| !c.is_ascii_hexdigit())
                    .find(|word| word.len() == 64)
                    .unwrap()
                    .to_string()
            };
            (digest(expected), digest(found))
        })
        .unwrap();
    let text = std::fs::read_to_string(&listing).unwrap().replace(&old, &new);
    std::fs::write(&listing, text).unwrap();
    let message = refused(&folders);
    assert!(message.contains(&format!("ray {hit}: another answer than the exact one")), "{message}");
    std::fs::remove_file(&t).unwrap();
    assert!(refused(&folders).contains("t.npy"), "{}", refused(&folders));
    for (document, expected) in
        [("{", "document"), (r#"{"format":1,"kind":"x","sides":"both","files":[]}"#, "kind")]
    {
        std::fs::write(folders.pack.path().join("raypack.json"), document).unwrap();
        assert!(refused(&folders).contains(expected), "{}", refused(&folders));
    }
}

#[test]
fn a_file_in_place_of_a_folder_is_told_by_its_ending() {
    let folders = Folders::right();
    for (name, found) in [
        ("t.npy", "candidate: one array; expected a folder with face.npy"),
        ("T.NPY", "candidate: one array; "),
        ("hits.csv", "candidate: a file that ends in .csv; "),
        ("hits", "candidate: a file without an ending; "),
    ] {
        let file = folders.candidate.path().join(name);
        std::fs::write(&file, "").unwrap();
        let conventions = CandidateConventions::default();
        let refused = check_ray_pack(folders.pack.path(), &file, Precision::F64, conventions, &Silent);
        let message = refused.unwrap_err().to_string();
        assert!(message.contains(found), "{message}");
    }
}

/// A link that leads nowhere is no array that was left out.
#[cfg(unix)]
#[test]
fn a_link_to_nothing_is_refused() {
    let folders = Folders::right();
    let link = folders.candidate.path().join("t.npy");
    std::fs::remove_file(&link).unwrap();
    assert!(folders.check().passes(), "without t the others are judged");
    std::os::unix::fs::symlink("/nowhere", &link).unwrap();
    let (pack, candidate): (&Path, &Path) = (folders.pack.path(), folders.candidate.path());
    let refused = check_ray_pack(pack, candidate, Precision::F64, CandidateConventions::default(), &Silent);
    let message = refused.unwrap_err().to_string();
    assert!(message.contains("t.npy: cannot read"), "{message}");
}
