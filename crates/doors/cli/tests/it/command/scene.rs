//! `scene show` and `scene init`.

use std::fs;

use tempfile::TempDir;

use super::{assert_trouble, raypencil, screen};

#[test]
fn a_scene_file_that_was_begun_is_the_default_scene() {
    let folder = TempDir::new().unwrap();
    let folder = folder.path();
    let said = screen(folder, &["scene", "init", "new/my.toml"], 0);
    assert!(said.contains("raypencil scene show new/my.toml"), "{said}");
    let sha256 = |scene: &str| {
        let shown = screen(folder, &["scene", "show", scene, "--json"], 0);
        let json: serde_json::Value = serde_json::from_str(&shown).unwrap();
        json["sha256"].as_str().unwrap().to_string()
    };
    assert_eq!(sha256("new/my.toml"), sha256("pyramids"));
    // Whoever has begun to change it keeps it.
    fs::write(folder.join("new/my.toml"), "mine").unwrap();
    assert_trouble(&raypencil(folder, &["scene", "init", "new/my.toml"]), &["my.toml", "there already"]);
    assert_eq!(fs::read_to_string(folder.join("new/my.toml")).unwrap(), "mine");
    assert_trouble(&raypencil(folder, &["scene", "init", "scene.txt"]), &["ends in .toml"]);
}

#[test]
fn a_scene_is_shown_with_its_units_and_a_picture() {
    let folder = TempDir::new().unwrap();
    let folder = folder.path();
    let said = screen(folder, &["scene", "show", "--set", "camera.pitch_down_deg=35", "-o", "a/p.svg"], 0);
    for word in ["camera    at (0.3, 0, 1.5) m, 35 deg down", "1024 x 1024 pixels", "picture   a/p.svg"] {
        assert!(said.contains(word), "{word} is not in\n{said}");
    }
    let svg = fs::read_to_string(folder.join("a/p.svg")).unwrap();
    assert!(svg.contains("from above") && svg.contains("beam 1"));
    screen(folder, &["scene", "show", "facets", "-o", "p.png"], 0);
    assert!(fs::read(folder.join("p.png")).unwrap().starts_with(b"\x89PNG"));
    assert_trouble(&raypencil(folder, &["scene", "show", "-o", "p.jpg"]), &["p.jpg", ".svg or .png"]);
}

/// A text of a picture: its four corners on the page, and the text.
struct Placed {
    corners: [[f64; 2]; 4],
    text: String,
}

/// The texts of a picture, and the size of its page.
#[allow(clippy::disallowed_methods, reason = "where letters stand, to a hundredth of a pixel")]
fn texts(svg: &str) -> (Vec<Placed>, [f64; 2]) {
    let value = |tag: &str, name: &str| -> Option<String> {
        let from = tag.find(&format!(" {name}=\""))? + name.len() + 3;
        Some(tag[from..].split('"').next()?.to_string())
    };
    let number = |tag: &str, name: &str| value(tag, name).unwrap().parse::<f64>().unwrap();
    let page = svg.split('>').next().unwrap();
    let size = [number(page, "width"), number(page, "height")];
    let placed = svg.split("<text").skip(1).map(|rest| {
        let (tag, rest) = rest.split_once('>').unwrap();
        let text = rest.split('<').next().unwrap().to_string();
        let (x, y, width) = (number(tag, "x"), number(tag, "y"), raypencil::report::text_width(&text));
        let left = match value(tag, "text-anchor").unwrap().as_str() {
            "start" => 0.0,
            "middle" => -0.5 * width,
            _ => -width,
        };
        let turn: f64 = value(tag, "transform").map_or(0.0, |turn| {
            turn.trim_start_matches("rotate(").split(' ').next().unwrap().parse().unwrap()
        });
        let (sin, cos) = turn.to_radians().sin_cos();
        // Letters of 13 pixels reach about 9 above the base line and 2 below it.
        let corners = [[left, -9.0], [left + width, -9.0], [left + width, 2.0], [left, 2.0]];
        let corners = corners.map(|[u, v]| [x + u * cos - v * sin, y + u * sin + v * cos]);
        Placed { corners, text }
    });
    (placed.collect(), size)
}

/// Whether a line parallel to a side of one of two rectangles lies between them.
fn are_apart(a: &Placed, b: &Placed) -> bool {
    [a, b].iter().flat_map(|one| [[0, 1], [1, 2]].map(|[p, q]| (one.corners[p], one.corners[q]))).any(
        |(p, q)| {
            let normal = [q[1] - p[1], p[0] - q[0]];
            let along = |one: &Placed| one.corners.map(|[x, y]| x * normal[0] + y * normal[1]);
            let (a, b) = (along(a), along(b));
            let least = |values: [f64; 4]| values.into_iter().fold(f64::INFINITY, f64::min);
            let most = |values: [f64; 4]| values.into_iter().fold(f64::NEG_INFINITY, f64::max);
            most(a) <= least(b) || most(b) <= least(a)
        },
    )
}

#[test]
fn labels_at_map_coordinates_neither_overlap_nor_leave_the_picture() {
    let folder = TempDir::new().unwrap();
    let folder = folder.path();
    for (x, y) in [(500_000, 3_999_990), (0, 0), (-7_300, 995), (990, 12_345_678)] {
        // A slope of 12 x 10 m, as a mesh at map coordinates. Its vertices are whole metres, which offsets in f32 hold.
        let corner = |u: i64, v: i64, z: i64| format!("v {} {} {z}\n", x + u, y + v);
        let hill = corner(0, 0, 0)
            + &corner(12, 0, 1)
            + &corner(12, 10, 1)
            + &corner(0, 10, 0)
            + "f 1 2 3\nf 1 3 4\n";
        fs::write(folder.join("hill.obj"), hill).unwrap();
        let scene = format!(
            "version = 1\n[vehicle]\nposition_m = [{}, {}]\n[terrain]\nfile = \"hill.obj\"\nup = \"z\"\n\
             [camera]\nwidth_px = 64\nheight_px = 64\npixel_pitch_um = 250\n[[beam]]\ncolumns = 64\nrows = 2\n",
            x + 3,
            y + 5
        );
        fs::write(folder.join("far.toml"), scene).unwrap();
        screen(folder, &["scene", "show", "far.toml", "-o", "p.svg"], 0);
        raypencil(folder, &["drive", "far.toml", "--to", "0.3,0", "-o", "drive", "--force"]);
        for name in ["p.svg", "drive/local-map.svg", "drive/navigator-map.svg"] {
            let (texts, [width, height]) = texts(&fs::read_to_string(folder.join(name)).unwrap());
            assert!(texts.len() > 8, "{name} at {x}, {y}: {}", texts.len());
            for (index, one) in texts.iter().enumerate() {
                let is_inside = |[x, y]: [f64; 2]| (0.0..=width).contains(&x) && (0.0..=height).contains(&y);
                assert!(
                    one.corners.into_iter().all(is_inside),
                    "{name} at {x}, {y}: {} leaves the page",
                    one.text
                );
                for other in &texts[..index] {
                    assert!(are_apart(one, other), "{name} at {x}, {y}: {} on {}", one.text, other.text);
                }
            }
        }
    }
}
