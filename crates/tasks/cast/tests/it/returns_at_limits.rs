//! Returns of beams where rounding may change them, from both sides of each limit. Every beam is a bundle of parallel rays along x before
//! plates that stand across it, so that ranges are the places of the plates and the light of a ray is its weight over their square.

use std::path::PathBuf;

use glam::DVec3;
use raypencil_cast::{CastSource, CloudFrame, RayPackChecked, check_ray_pack, write_scan_pack};
use raypencil_referee::ExactCast;
use raypencil_scene::pattern::{EchoLight, Keep, Mounting, PatternRays, Returns};
use raypencil_scene::{CastRay, FaceId, NamedRaySet, Precision, Sides, Silent, Triangles};

use super::cloud_trial::{expect, of_frame};
use super::kept_packs::put_pack;

const U: f64 = Precision::F32.unit_roundoff;

/// A plate at a distance, which the rays from one number to before another meet if nothing is before it.
#[derive(Debug, Clone, Copy)]
struct Plate {
    x: f64,
    from: usize,
    to: usize,
}

fn plate(x: f64, from: usize, to: usize) -> Plate {
    Plate { x, from, to }
}

/// Beams before their plates.
struct Bundle {
    weights: Vec<f64>,
    returns: Returns,
    echo: EchoLight,
    /// Longest and shortest range, metres.
    ends: [f64; 2],
    /// The plates of each beam.
    beams: Vec<Vec<Plate>>,
    /// Between two rays, metres.
    pitch: f64,
    /// Half the height of the plates, metres.
    half: f64,
    /// How far from the mesh's origin the rays begin, across them.
    aside: f64,
}

impl Bundle {
    fn new(weights: &[f64], keep: Keep, beams: &[&[Plate]]) -> Self {
        Self {
            weights: weights.to_vec(),
            returns: Returns { keep, separation_m: 0.5 },
            echo: EchoLight::default(),
            ends: [100.0, 0.0],
            beams: beams.iter().map(|plates| plates.to_vec()).collect(),
            pitch: 0.5 / weights.len() as f64,
            half: 4.0,
            aside: 0.0,
        }
    }

    fn origin(&self, beam: usize, ray: usize) -> DVec3 {
        DVec3::new(0.0, self.aside + self.pitch * ray as f64, 10.0 * beam as f64)
    }

    /// Directions are two metres long: t counts in other units than ranges.
    fn rays(&self) -> Vec<CastRay> {
        let [longest, shortest] = self.ends;
        let ray = |beam: usize, ray: usize| CastRay {
            t_max: 0.5 * longest,
            t_blind: 0.5 * shortest,
            ..CastRay::new(self.origin(beam, ray), 2.0 * DVec3::X)
        };
        (0..self.beams.len()).flat_map(|beam| (0..self.weights.len()).map(move |k| ray(beam, k))).collect()
    }

    /// Two faces for each plate. No ray is at their diagonal.
    fn mesh(&self) -> Triangles {
        let (mut vertices, mut faces) = (Vec::new(), Vec::new());
        for (beam, plates) in self.beams.iter().enumerate() {
            for plate in plates {
                let edge = |ray: usize| {
                    let beyond = if ray == 0 { -self.half } else { 0.0 };
                    let beyond = if ray == self.weights.len() { self.half } else { beyond };
                    self.origin(beam, 0).y + self.pitch * (ray as f64 - 0.5) + beyond
                };
                let (low, high) = (edge(plate.from), edge(plate.to));
                let middle = self.origin(beam, 0).z;
                let (bottom, top) = (middle - 0.9 * self.half, middle + 1.1 * self.half);
                let first = vertices.len() as u32;
                vertices.extend(
                    [[low, bottom], [high, bottom], [high, top], [low, top]].map(|[y, z]| [plate.x, y, z]),
                );
                faces.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
            }
        }
        Triangles::new(vertices, faces).expect("plates")
    }

    fn set(&self) -> NamedRaySet {
        let count = self.weights.len();
        let pattern = PatternRays {
            shape: vec![self.beams.len() as u64, 1, count as u64],
            rays: self.rays(),
            times: Some((0..self.beams.len() * count).map(|k| 0.01 * (k / count) as f64).collect()),
            weights: Some(self.weights.clone()),
            returns: Some(self.returns),
            elevations_deg: Some(vec![0.0]),
            mounting: Mounting::HERE,
        };
        let set = NamedRaySet::new("beams", pattern, Sides::Both).expect("a set");
        NamedRaySet { echo: self.echo, ..set }
    }

    /// Judges the points that a program tells of each beam: their rays and distances.
    fn judge(&self, told: &[&[(usize, f64)]], precision: Precision) -> RayPackChecked {
        self.judge_numbered(told, None, precision)
    }

    /// The same by ring, time and the numbers of returns.
    fn judge_numbered(
        &self,
        told: &[&[(usize, f64)]],
        numbers: Option<&[&[u8]]>,
        precision: Precision,
    ) -> RayPackChecked {
        let folder = tempfile::tempdir().expect("a folder");
        let pack = folder.path().join("pack");
        let (mesh, set) = (self.mesh(), self.set());
        put_pack(&pack, &(&mesh, &set), |pack| {
            write_scan_pack(pack, (&mesh, &set, Sides::Both), &CastSource::default(), &Silent)
                .expect("a pack");
        });
        let file = self.write(folder.path().join("theirs.pcd"), told, numbers);
        check_ray_pack(&pack, &file, precision, of_frame(CloudFrame::Mesh), &Silent).expect("a check")
    }

    fn write(&self, path: PathBuf, told: &[&[(usize, f64)]], numbers: Option<&[&[u8]]>) -> PathBuf {
        let most = if let Keep::UpTo(most) = self.returns.keep { most as usize } else { 1 };
        let (mut count, mut data) = (0, Vec::new());
        for (beam, points) in told.iter().enumerate() {
            for place in 0..most {
                let point = points.get(place).map(|&(ray, x)| self.origin(beam, ray) + DVec3::X * x);
                if point.is_none() && numbers.is_some() {
                    continue;
                }
                count += 1;
                let point = point.unwrap_or(DVec3::NAN);
                point.to_array().iter().for_each(|part| data.extend(part.to_le_bytes()));
                if let Some(numbers) = numbers {
                    data.extend(0_u16.to_le_bytes());
                    data.extend((0.01 * beam as f64).to_le_bytes());
                    data.push(numbers[beam][place]);
                }
            }
        }
        let (names, sizes, kinds) = match numbers {
            None => ("", "", ""),
            Some(_) => (" ring time return", " 2 8 1", " U F U"),
        };
        let head = format!(
            "VERSION 0.7\nFIELDS x y z{names}\nSIZE 8 8 8{sizes}\nTYPE F F F{kinds}\nWIDTH {count}\nHEIGHT 1\nPOINTS {count}\nDATA binary\n"
        );
        std::fs::write(&path, [head.as_bytes(), &data].concat()).expect("a file");
        path
    }

    /// The wrong places of what a program of single precision tells.
    fn wrong(&self, told: &[&[(usize, f64)]]) -> Vec<usize> {
        let checked = self.judge(told, Precision::F32);
        checked.comparison.wrong().map(|(place, _)| place).collect()
    }

    /// How far rounding may move the range of a face of the first beam, metres.
    fn range_error(&self, face: u32) -> f64 {
        ExactCast::new(&self.mesh()).range_error(&self.rays()[0], FaceId(face), Precision::F32)
    }
}

#[test]
fn two_plates_are_one_return_as_far_as_the_ranges_of_both_may_round() {
    // The first plate is before ray 0 alone.
    let bundle = |far: f64| Bundle::new(&[0.5; 2], Keep::UpTo(2), &[&[plate(5.0, 0, 1), plate(far, 0, 2)]]);
    let both = bundle(5.5).range_error(0) + bundle(5.5).range_error(2);
    // Three quarters of the sum is more than each of them, and they are alike.
    let [inside, outside] = [0.75 * both, 1.25 * both];
    // Exactly two returns. As one it has the point of ray 0.
    for (by, wrong) in [(inside, &[][..]), (outside, &[1])] {
        let apart = bundle(5.5 + by);
        assert!(apart.judge(&[&[(0, 5.0), (1, 5.5 + by)]], Precision::F64).passes());
        assert_eq!(apart.wrong(&[&[(0, 5.0)]]), wrong, "{by}");
        // In double precision they are two.
        assert_eq!(apart.judge(&[&[(0, 5.0)]], Precision::F64).comparison.counts().wrong, 1);
    }
    // Exactly one return.
    for (by, wrong) in [(inside, &[][..]), (outside, &[1])] {
        let joined = bundle(5.5 - by);
        assert!(joined.judge(&[&[(0, 5.0)]], Precision::F64).passes());
        assert_eq!(joined.wrong(&[&[(0, 5.0), (1, 5.5 - by)]]), wrong, "{by}");
    }
    // The middle of the beam meets the far plate: gaps are those between ranges, and not between rays.
    let far = 5.5 + inside;
    let middle = Bundle::new(&[0.5; 2], Keep::UpTo(2), &[&[plate(5.0, 1, 2), plate(far, 0, 2)]]);
    assert!(middle.judge(&[&[(1, 5.0), (0, far)]], Precision::F64).passes());
    assert!(middle.wrong(&[&[(0, far)]]).is_empty());
}

#[test]
fn a_plate_at_either_end_of_the_ranges_may_be_a_return() {
    let bundle = |x: f64, ends: [f64; 2]| Bundle {
        ends,
        ..Bundle::new(&[0.5; 2], Keep::UpTo(2), &[&[plate(x, 1, 2), plate(5.0, 0, 1)]])
    };
    let error = bundle(20.0, [100.0, 0.0]).range_error(0);
    for (by, wrong) in [(0.5 * error, 0), (1.5 * error, 1)] {
        // Just beyond the longest range: whoever finds it finds it at that range.
        let far = bundle(20.0 + by, [20.0, 0.0]);
        let told: [&[(usize, f64)]; 1] = [&[(0, 5.0), (1, 20.0)]];
        assert!(far.judge(&[&[(0, 5.0)]], Precision::F64).passes());
        assert_eq!(far.wrong(&told).len(), wrong, "{by}");
        assert_eq!(far.judge(&told, Precision::F64).comparison.counts().wrong, 1);
    }
    let error = bundle(2.0, [100.0, 0.0]).range_error(0);
    for (by, wrong) in [(0.5 * error, 0), (1.5 * error, 2)] {
        // Just before the shortest one.
        let near = bundle(2.0 - by, [100.0, 2.0]);
        let told: [&[(usize, f64)]; 1] = [&[(1, 2.0), (0, 5.0)]];
        assert!(near.judge(&[&[(0, 5.0)]], Precision::F64).passes());
        assert_eq!(near.wrong(&told).len(), wrong, "{by}");
        assert_eq!(near.judge(&told, Precision::F64).comparison.counts().wrong, 2);
    }
}

/// A plate at 5 m before the first half of the rays, and at 10 m one before the others, where the light is the same: a ray of the second
/// half has four times the weight. There it is farther by a part, by which the light is less: (1 + part)^-2, so that the difference of the
/// strengths over their sum is the part.
fn equal(rays: usize, keep: Keep, part: f64) -> Bundle {
    let weights: Vec<f64> = (0..rays).map(|k| if k < rays / 2 { 1.0 } else { 4.0 }).collect();
    let all: f64 = weights.iter().sum();
    let weights: Vec<f64> = weights.iter().map(|weight| weight / all).collect();
    Bundle::new(&weights, keep, &[&[plate(5.0, 0, rays / 2), plate(10.0 * (1.0 + part), rays / 2, rays)]])
}

#[test]
fn roundings_of_each_ray_s_light_may_change_the_strongest_return() {
    // Four roundings of each of 2000 rays. Ranges and cosines are 1100 u, all errors together 9100.
    let beam = |by: f64| equal(2000, Keep::Strongest, by * U);
    let far = |by: f64| 10.0 * (1.0 + by * U);
    for (by, wrong) in [(7000.0, 0), (12_000.0, 1)] {
        assert!(beam(by).judge(&[&[(0, 5.0)]], Precision::F64).passes());
        assert_eq!(beam(by).wrong(&[&[(1000, far(by))]]).len(), wrong, "{by}");
    }
    // The air takes four more, however thin it is.
    let thin =
        Bundle { echo: EchoLight { extinction_per_m: 1e-12, ..EchoLight::default() }, ..beam(12_000.0) };
    assert!(thin.wrong(&[&[(1000, far(12_000.0))]]).is_empty());
    // The farther one is the stronger by as much.
    assert!(beam(-7000.0).judge(&[&[(1000, far(-7000.0))]], Precision::F64).passes());
    assert!(beam(-7000.0).wrong(&[&[(0, 5.0)]]).is_empty());
    assert_eq!(beam(-12_000.0).wrong(&[&[(0, 5.0)]]), [0]);
}

#[test]
fn errors_of_ranges_cosines_and_air_may_change_the_strongest_return() {
    // A kilometre from the mesh's origin the range of a plate at 5 m may be off by a part of 72 u 1000 / 5, and its square by twice that.
    let part = 2.0 * 72.0 * U * 1000.0 / 5.0;
    for (by, wrong) in [(0.9 * part, 0), (8.0 * part, 1)] {
        let away = Bundle { aside: 1000.0, ..equal(2, Keep::Strongest, by) };
        assert!(away.judge(&[&[(0, 5.0)]], Precision::F64).passes());
        assert_eq!(away.wrong(&[&[(1, 10.0 * (1.0 + by))]]).len(), wrong, "{by}");
    }
    // The normal of a plate of 2 cm may be off by 16 u of its mesh's size over that, which is more than what ranges are off by.
    let small = |by: f64| Bundle { pitch: 0.02, half: 0.01, ..equal(2, Keep::Strongest, by) };
    let part = 16.0 * U * 10.0 / 0.02;
    for (by, wrong) in [(0.9 * part, 0), (4.0 * part, 1)] {
        assert!(small(by).judge(&[&[(0, 5.0)]], Precision::F64).passes());
        assert_eq!(small(by).wrong(&[&[(1, 10.0 * (1.0 + by))]]).len(), wrong, "{by}");
    }
}

#[test]
fn in_thick_air_a_range_that_rounds_may_change_the_strongest_return() {
    // e^(-2 sigma R) of 20 / m: where R is off by e, it is by a part of 40 e, which is a hundred times what 1 / R^2 is off by.
    let (sigma, near) = (20.0, 5.0);
    let beam = |by: f64| {
        let far = 5.6 + by;
        let light = |x: f64| libm::exp(-2.0 * sigma * x) / (x * x);
        let ratio = light(near) / light(5.6);
        let weights = [1.0 / (1.0 + ratio), ratio / (1.0 + ratio)];
        let bundle = Bundle::new(&weights, Keep::Strongest, &[&[plate(near, 0, 1), plate(far, 1, 2)]]);
        Bundle { echo: EchoLight { reflectivity: 1.0, extinction_per_m: sigma }, ..bundle }
    };
    let error = beam(0.0).range_error(0).max(beam(0.0).range_error(2));
    for (by, wrong) in [(0.9 * error, 0), (4.0 * error, 1)] {
        assert!(beam(by).judge(&[&[(0, near)]], Precision::F64).passes());
        assert_eq!(beam(by).wrong(&[&[(1, 5.6 + by)]]).len(), wrong, "{by}");
    }
}

#[test]
fn equal_strengths_excuse_only_where_one_of_them_is_left_out() {
    // Both are told: neither may be missing.
    let two = equal(2, Keep::UpTo(2), 0.0);
    assert!(two.judge(&[&[(0, 5.0), (1, 10.0)]], Precision::F64).passes());
    assert_eq!(two.wrong(&[&[(0, 5.0)]]), [1]);
    // The last one is the last, whatever its strength; and so is the first.
    for (keep, right, other) in [(Keep::Last, (1, 10.0), (0, 5.0)), (Keep::First, (0, 5.0), (1, 10.0))] {
        let one = equal(2, keep, 0.0);
        assert!(one.judge(&[&[right]], Precision::F64).passes());
        assert_eq!(one.wrong(&[&[other]]), [0], "{keep:?}");
    }
    // A third return that is weaker changes nothing of the two.
    let weights = [1.0, 4.0, 0.5].map(|weight| weight / 5.5);
    let three =
        Bundle::new(&weights, Keep::Strongest, &[&[plate(5.0, 0, 1), plate(10.0, 1, 2), plate(20.0, 2, 3)]]);
    assert!(three.judge(&[&[(0, 5.0)]], Precision::F64).passes());
    assert!(three.wrong(&[&[(1, 10.0)]]).is_empty());
    // Of three the two strongest are asked for: the weaker two are alike.
    let weights = [3.0, 4.0, 16.0].map(|weight| weight / 23.0);
    let two_of_three =
        Bundle::new(&weights, Keep::UpTo(2), &[&[plate(5.0, 0, 1), plate(10.0, 1, 2), plate(20.0, 2, 3)]]);
    assert!(two_of_three.judge(&[&[(0, 5.0), (1, 10.0)]], Precision::F64).passes());
    assert!(two_of_three.wrong(&[&[(0, 5.0), (2, 20.0)]]).is_empty());
}

#[test]
fn a_beam_that_is_too_near_is_so_once_and_a_point_of_it_is_wrong() {
    // A plate at 1 m before all rays; before the first of them alone; and none.
    let far = plate(5.0, 0, 2);
    let near = Bundle {
        ends: [100.0, 2.0],
        ..Bundle::new(&[0.5; 2], Keep::UpTo(2), &[&[plate(1.0, 0, 2), far], &[plate(1.0, 0, 1), far], &[far]])
    };
    let right: [&[(usize, f64)]; 3] = [&[], &[(1, 5.0)], &[(0, 5.0)]];
    let checked = near.judge(&right, Precision::F64);
    assert!(checked.passes());
    let is_too_near: Vec<bool> =
        checked.answers.first.iter().map(|read| matches!(read, raypencil_scene::Reading::TooNear)).collect();
    assert_eq!(is_too_near, [true, false, false, false, false, false]);
    assert_eq!(near.wrong(&[&[(0, 1.0)], right[1], right[2]]), [0]);
    assert_eq!(near.wrong(&[&[(0, 5.0)], right[1], right[2]]), [0]);
    assert_eq!(near.wrong(&[&[], &[(0, 1.0), (1, 5.0)], right[2]]), [2, 3]);
}

/// Beams of one to four returns, the strongest of which is not always the same: 60 of them.
fn mixed(keep: Keep) -> Bundle {
    let weights = [0.1, 0.2, 0.3, 0.4];
    let beam = |k: usize| -> Vec<Plate> {
        let x = |place: usize| 4.0 + 0.03 * k as f64 + (2.0 + 0.01 * k as f64) * place as f64;
        match k % 4 {
            0 => vec![plate(x(0), 0, 4)],
            1 => vec![plate(x(0), 0, 2), plate(x(1), 2, 4)],
            2 => vec![plate(x(0), 0, 1), plate(x(1), 1, 3), plate(x(2), 3, 4)],
            _ => vec![plate(x(0), 2, 4), plate(x(1), 1, 2), plate(x(2), 0, 1)],
        }
    };
    let beams: Vec<Vec<Plate>> = (0..60).map(beam).collect();
    Bundle { beams, ..Bundle::new(&weights, keep, &[]) }
}

/// The returns of a beam, by range: its leading ray, its distance, and its strength.
fn returns_of(bundle: &Bundle, beam: usize) -> Vec<(usize, f64, f64)> {
    let mut all: Vec<(usize, f64, f64)> = bundle.beams[beam]
        .iter()
        .map(|plate| {
            let weight: f64 = bundle.weights[plate.from..plate.to].iter().sum();
            (plate.from, plate.x, weight / (plate.x * plate.x))
        })
        .collect();
    all.sort_by(|a, b| a.1.total_cmp(&b.1));
    all
}

#[test]
fn each_rule_that_a_program_may_follow_is_told_in_its_words() {
    type Rule<'a> = &'a dyn Fn(&[(usize, f64, f64)]) -> Vec<usize>;
    let strongest = |all: &[(usize, f64, f64)], most: usize| -> Vec<usize> {
        let mut order: Vec<usize> = (0..all.len()).collect();
        order.sort_by(|a, b| all[*b].2.total_cmp(&all[*a].2));
        order.truncate(most);
        order.sort_unstable();
        order
    };
    let pair = |a: usize, b: usize| {
        let mut both = vec![a, b];
        both.sort_unstable();
        both.dedup();
        both
    };
    let cases: [(Keep, Rule<'_>, &str); 7] = [
        (
            Keep::UpTo(1),
            &|_| vec![0],
            "if each beam has its first return alone: the strongest one is asked for",
        ),
        (
            Keep::UpTo(1),
            &|all| vec![all.len() - 1],
            "if each beam has its last return alone: the strongest one is asked for",
        ),
        (
            Keep::UpTo(3),
            &|all| strongest(all, 1),
            "if each beam has its strongest return alone: the 3 strongest ones are asked for",
        ),
        (
            Keep::UpTo(3),
            &|all| strongest(all, 2),
            "if each beam has its 2 strongest returns: the 3 strongest ones are asked for",
        ),
        (
            Keep::UpTo(3),
            &|all| pair(0, all.len() - 1),
            "if each beam has its first and its last return: the 3 strongest ones are asked for",
        ),
        (
            Keep::UpTo(3),
            &|all| pair(strongest(all, 1)[0], all.len() - 1),
            "if each beam has its strongest and its last return: the 3 strongest ones are asked for",
        ),
        (
            Keep::UpTo(3),
            &|all| pair(0, strongest(all, 1)[0]),
            "if each beam has its first and its strongest return: the 3 strongest ones are asked for",
        ),
    ];
    for (keep, rule, words) in cases {
        let bundle = mixed(keep);
        let (mut told, mut numbers) = (Vec::new(), Vec::new());
        for beam in 0..bundle.beams.len() {
            let all = returns_of(&bundle, beam);
            let chosen = rule(&all);
            told.push(chosen.iter().map(|&k| (all[k].0, all[k].1)).collect::<Vec<_>>());
            numbers.push(chosen.iter().map(|&k| k as u8 + 1).collect::<Vec<_>>());
        }
        let told: Vec<&[(usize, f64)]> = told.iter().map(Vec::as_slice).collect();
        let numbers: Vec<&[u8]> = numbers.iter().map(Vec::as_slice).collect();
        expect(&bundle.judge(&told, Precision::F64), words);
        expect(&bundle.judge_numbered(&told, Some(&numbers), Precision::F64), words);
    }
}
