//! Wrong renderers, made on purpose: some eighty mistakes with random numbers, each in one sensor or in all, alone or beside
//! another one. Each says what is true of it, so that a reason that is told can be held to it.

use std::sync::Arc;

use glam::DVec3;
use raypencil_diagnosis::{
    AngleUnit, CutBy, Diagnosis, FrameAxes, Held, Length, LengthUnit, Mistake, Reason, Turn, Vectors,
};
use raypencil_judge::{Quantity, Recorded};
use raypencil_referee::ExactRenderer;
use raypencil_scene::{FaceId, Maybe, Mesh, Pose, Renderer, Request, Scene, SensorId, SensorMap};

use super::candidates::Bench;

mod mistakes;
pub mod wrong;

pub use mistakes::MISTAKES;

/// Random numbers by a counter: SplitMix64.
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ z >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ z >> 31
    }

    /// From 0 to 1.
    pub fn share(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub fn below(&mut self, count: usize) -> usize {
        (self.next() % count as u64) as usize
    }

    /// A size between two, evenly over their orders, with any sign.
    pub fn size(&mut self, least: f64, most: f64) -> f64 {
        let size = least * libm::exp(self.share() * libm::log(most / least));
        if self.next() & 1 == 0 { size } else { -size }
    }

    /// The same, half of the time with two digits.
    pub fn number(&mut self, least: f64, most: f64) -> f64 {
        let size = self.size(least, most);
        if self.next() & 1 == 0 { size } else { format!("{size:.1e}").parse().unwrap() }
    }
}

/// A candidate in the making: the hits of some sensors change.
pub struct Making<'t> {
    pub bench: &'t Bench,
    pub sensor: SensorId,
    pub map: &'t mut SensorMap,
    pub random: &'t mut Random,
}

/// A mistake: what it is called here, and what makes it. It gives what is true of it: any of these may be told.
pub type Make = (&'static str, fn(&mut Making<'_>) -> Vec<Mistake>);

impl Making<'_> {
    fn size(&self) -> (u32, u32) {
        self.bench.scene.size(self.sensor).unwrap()
    }

    fn cells(&self) -> impl Iterator<Item = (u32, u32)> + use<> {
        let (width, height) = self.size();
        (0..height).flat_map(move |j| (0..width).map(move |i| (i, j)))
    }

    fn axis(&self) -> f64 {
        match self.sensor {
            SensorId::Camera => self.bench.scene.camera().sensor.focal_length,
            SensorId::Beam(beam) => self.bench.scene.beams()[beam].sensor.grid_distance,
        }
    }

    fn length(&self, i: u32, j: u32) -> f64 {
        self.bench.scene.ray(self.sensor, i, j).unwrap().direction.length()
    }

    fn pose(&self) -> Pose {
        match self.sensor {
            SensorId::Camera => self.bench.scene.camera().scene_from_sensor,
            SensorId::Beam(beam) => self.bench.scene.beams()[beam].scene_from_sensor,
        }
    }

    fn moved(&mut self, from: impl Fn(u32, u32, u32, u32) -> (u32, u32)) {
        fn one<T: Copy>(
            image: &mut Option<raypencil_scene::Image<T>>,
            from: &impl Fn(u32, u32, u32, u32) -> (u32, u32),
        ) {
            let Some(image) = image else { return };
            let old = image.clone();
            let (width, height) = (old.width(), old.height());
            for j in 0..height {
                for i in 0..width {
                    let (a, b) = from(width, height, i, j);
                    image.set(i, j, old.at(a, b));
                }
            }
        }
        one(&mut self.map.face, &from);
        one(&mut self.map.range, &from);
        one(&mut self.map.depth, &from);
        one(&mut self.map.point, &from);
        one(&mut self.map.normal, &from);
        one(&mut self.map.cos_incidence, &from);
    }

    /// Changes ranges, or depths, each by its cell.
    fn lengths(&mut self, of: Length, mut change: impl FnMut(u32, u32, f64) -> f64) {
        let Self { map, .. } = self;
        let wanted = [of != Length::Depth, of != Length::Range];
        for (image, _) in [&mut map.range, &mut map.depth].into_iter().zip(wanted).filter(|(_, is)| *is) {
            let Some(image) = image else { continue };
            for j in 0..image.height() {
                for i in 0..image.width() {
                    image.set(i, j, image.at(i, j).get().map(|x| change(i, j, x)).into());
                }
            }
        }
    }

    fn vectors(&mut self, is_point: bool, change: impl Fn(u32, u32, DVec3) -> DVec3) {
        let image = if is_point { &mut self.map.point } else { &mut self.map.normal };
        let Some(image) = image else { return };
        for j in 0..image.height() {
            for i in 0..image.width() {
                image.set(i, j, image.at(i, j).get().map(|v| change(i, j, v)).into());
            }
        }
    }

    fn cosines(&mut self, change: impl Fn(f64) -> f64) {
        let Some(image) = &mut self.map.cos_incidence else { return };
        image.cells_mut().iter_mut().for_each(|cell| *cell = cell.get().map(&change).into());
    }

    fn faces(&mut self, mut change: impl FnMut(u32) -> u32) {
        let Some(image) = &mut self.map.face else { return };
        image
            .cells_mut()
            .iter_mut()
            .for_each(|cell| *cell = cell.get().map(|face| FaceId(change(face.0))).into());
    }

    /// Says "no hit" in a cell.
    fn lose(&mut self, i: u32, j: u32) {
        let Self { map, .. } = self;
        map.face.iter_mut().for_each(|image| image.set(i, j, Maybe::NONE));
        for image in [&mut map.range, &mut map.depth, &mut map.cos_incidence].into_iter().flatten() {
            image.set(i, j, Maybe::NONE);
        }
        for image in [&mut map.point, &mut map.normal].into_iter().flatten() {
            image.set(i, j, Maybe::NONE);
        }
    }

    /// Says 0 in a cell.
    fn zero(&mut self, i: u32, j: u32) {
        let Self { map, .. } = self;
        map.face.iter_mut().for_each(|image| image.set(i, j, Maybe::some(FaceId(0))));
        for image in [&mut map.range, &mut map.depth, &mut map.cos_incidence].into_iter().flatten() {
            image.set(i, j, Maybe::some(0.0));
        }
        for image in [&mut map.point, &mut map.normal].into_iter().flatten() {
            image.set(i, j, Maybe::some(DVec3::ZERO));
        }
    }

    /// The hits of this sensor in another scene.
    fn rendered(&self, scene: &Scene) -> SensorMap {
        let output = ExactRenderer.render(scene, &Request::MAPS);
        output.map(self.sensor).unwrap().clone()
    }

    /// The sensor with other numbers.
    fn other_sensor(&self, change: impl Fn(&mut Numbers)) -> Scene {
        let scene = self.bench.scene;
        let (mut camera, mut beams) = (*scene.camera(), scene.beams().to_vec());
        match self.sensor {
            SensorId::Camera => change(&mut Numbers {
                pose: &mut camera.scene_from_sensor,
                principal_point: &mut camera.sensor.principal_point,
                focal_length: &mut camera.sensor.focal_length,
                pitch: &mut camera.sensor.pixel_pitch,
                half_width: &mut 0.0,
                max_range: &mut camera.sensor.max_range,
            }),
            SensorId::Beam(beam) => {
                let beam = &mut beams[beam];
                let mut width = [beam.sensor.half_width, beam.sensor.thickness];
                let mut half_width = width[0];
                change(&mut Numbers {
                    pose: &mut beam.scene_from_sensor,
                    principal_point: &mut [0.0; 2],
                    focal_length: &mut beam.sensor.grid_distance,
                    pitch: &mut width,
                    half_width: &mut half_width,
                    max_range: &mut beam.sensor.max_range,
                });
                beam.sensor.half_width =
                    if width[0] == beam.sensor.half_width { half_width } else { width[0] };
                beam.sensor.thickness = width[1];
            }
        }
        Scene::new(Arc::clone(scene.mesh()), camera, beams, scene.atmosphere(), scene.flux_model()).unwrap()
    }

    fn other_mesh(&self, mesh: Mesh) -> Scene {
        let scene = self.bench.scene;
        let (camera, beams) = (*scene.camera(), scene.beams().to_vec());
        Scene::new(Arc::new(mesh), camera, beams, scene.atmosphere(), scene.flux_model()).unwrap()
    }

    /// Another face for each corner: the mesh with other faces.
    fn mesh_of(&self, vertices: Vec<[f32; 3]>, faces: Vec<[u32; 3]>) -> Mesh {
        let mesh = self.bench.scene.mesh();
        let materials = vec![0; faces.len()];
        Mesh::new(mesh.origin(), vertices, faces, materials, mesh.materials().to_vec()).unwrap()
    }
}

/// Numbers of a sensor that may be wrong.
struct Numbers<'n> {
    pose: &'n mut Pose,
    principal_point: &'n mut [f64; 2],
    focal_length: &'n mut f64,
    pitch: &'n mut [f64; 2],
    half_width: &'n mut f64,
    max_range: &'n mut f64,
}

fn shifted(making: &mut Making<'_>, columns: i32, rows: i32) -> Vec<Mistake> {
    let moved_by = |k: u32, by: i32, n: u32| (k as i32 - by).clamp(0, n as i32 - 1) as u32;
    making.moved(|w, h, i, j| (moved_by(i, columns, w), moved_by(j, rows, h)));
    // A principal point that is a whole pixel off is the same but at the border.
    let offset = [-f64::from(columns), -f64::from(rows)];
    let truth = making.bench.scene.camera().sensor.principal_point;
    let stated = [0, 1].map(|k| truth[k] - offset[k]);
    vec![
        Mistake::Shifted { columns, rows },
        Mistake::CornerRays { columns: offset[0], rows: offset[1] },
        Mistake::PrincipalPoint { stated, truth },
    ]
}

fn units(making: &mut Making<'_>, unit: LengthUnit, factor: f64) -> Vec<Mistake> {
    making.lengths(Length::All, |_, _, x| x * factor);
    making.vectors(true, |_, _, p| p * factor);
    vec![Mistake::Unit(unit), Mistake::Affine { of: Length::All, factor, offset: 0.0 }]
}

fn turned(making: &mut Making<'_>, mistake: Mistake) -> Vec<Mistake> {
    let turn: fn(DVec3) -> DVec3 = match mistake {
        Mistake::AxesYUp => |v| DVec3::new(v.x, v.z, -v.y),
        Mistake::AxesYUpInverse => |v| DVec3::new(v.x, -v.z, v.y),
        Mistake::Axes { sign: [1, -1, 1], .. } => |v| DVec3::new(v.x, -v.y, v.z),
        // x of the recording is y of the scene, and so on.
        _ => |v| DVec3::new(v.y, v.z, v.x),
    };
    making.vectors(true, |_, _, p| turn(p));
    making.vectors(false, |_, _, n| turn(n));
    // A candidate may leave out one of the two.
    let alone = |of| match mistake {
        Mistake::AxesYUp => Mistake::Axes { of, from: [0, 2, 1], sign: [1, -1, 1] },
        Mistake::AxesYUpInverse => Mistake::Axes { of, from: [0, 2, 1], sign: [1, 1, -1] },
        Mistake::Axes { from, sign, .. } => Mistake::Axes { of, from, sign },
        other => other,
    };
    vec![mistake, alone(Vectors::Points), alone(Vectors::Normals)]
}

/// The axes of the points alone, or of the normals.
fn turned_alone(making: &mut Making<'_>, of: Vectors) -> Vec<Mistake> {
    making.vectors(of == Vectors::Points, |_, _, v| DVec3::new(v.y, v.x, -v.z));
    vec![Mistake::Axes { of, from: [1, 0, 2], sign: [1, 1, -1] }]
}

/// Points and normals in the sensor's frame, as other people lay its axes.
fn in_sensor_frame(making: &mut Making<'_>, axes: FrameAxes) -> Vec<Mistake> {
    let pose = making.pose();
    // What is ahead in the contract's axes is z.
    let laid: fn(DVec3) -> DVec3 = match axes {
        FrameAxes::Optical => |v| v,
        FrameAxes::OpenGl => |v| DVec3::new(v.x, -v.y, -v.z),
        FrameAxes::Body => |v| DVec3::new(v.z, -v.x, -v.y),
    };
    making.vectors(true, |_, _, p| laid(pose.inverse() * p));
    making.vectors(false, |_, _, n| laid(pose.inverse().rotate(n)));
    if pose == Pose::IDENTITY && axes == FrameAxes::Optical {
        return Vec::new();
    }
    // A candidate may leave out one of the two.
    [Vectors::Both, Vectors::Points, Vectors::Normals].map(|of| Mistake::SensorFrame { of, axes }).to_vec()
}

/// Another pitch across, or down, or both.
fn pitched(making: &mut Making<'_>, by: [f64; 2]) -> Vec<Mistake> {
    if making.sensor != SensorId::Camera {
        return Vec::new();
    }
    let truth = making.bench.scene.camera().sensor.pixel_pitch;
    let stated = [truth[0] * by[0], truth[1] * by[1]];
    let scene = making.other_sensor(|numbers| *numbers.pitch = stated);
    *making.map = making.rendered(&scene);
    vec![Mistake::PixelPitch { stated, truth }]
}

/// Rays through another point of the cell. For a beam, whose rows start at other places, by columns alone.
fn offset(making: &mut Making<'_>, by: [f64; 2]) -> Vec<Mistake> {
    let truth = making.bench.scene.camera().sensor.principal_point;
    let stated = [0, 1].map(|k| truth[k] - by[k]);
    if making.sensor == SensorId::Camera {
        let scene = making.other_sensor(|numbers| *numbers.principal_point = stated);
        *making.map = making.rendered(&scene);
    } else {
        return Vec::new();
    }
    // Off by whole pixels, it is a shift, but at the border.
    let [columns, rows] = by.map(|one| -one.round() as i32);
    vec![
        Mistake::PrincipalPoint { stated, truth },
        Mistake::CornerRays { columns: by[0], rows: by[1] },
        Mistake::Shifted { columns, rows },
    ]
}

fn posed(making: &mut Making<'_>, degrees: [f64; 3], metres: [f64; 3]) -> Vec<Mistake> {
    let turn = DVec3::from_array(degrees.map(f64::to_radians));
    let scene = making.other_sensor(|numbers| {
        if turn != DVec3::ZERO {
            let rotation = Pose::from_axis_angle(turn / turn.length(), turn.length());
            *numbers.pose = *numbers.pose * rotation;
        }
        numbers.pose.position += DVec3::from_array(metres);
    });
    *making.map = making.rendered(&scene);
    let [x, y, z] = degrees;
    let mut all = vec![Mistake::Posed { degrees, metres }];
    match (degrees, metres) {
        ([_, 0.0, 0.0], [0.0, 0.0, 0.0]) => all.push(Mistake::Turned { about: Turn::Pitch, degrees: -x }),
        ([0.0, _, 0.0], [0.0, 0.0, 0.0]) => all.push(Mistake::Turned { about: Turn::Yaw, degrees: y }),
        ([0.0, 0.0, _], [0.0, 0.0, 0.0]) => all.push(Mistake::Turned { about: Turn::Roll, degrees: z }),
        ([0.0, 0.0, 0.0], by) => all.push(Mistake::Moved(by)),
        _ => {}
    }
    all
}

fn parts(of: Length) -> impl Iterator<Item = Length> {
    let all = [Length::All, Length::Range, Length::Depth];
    all.into_iter().filter(move |part| of == Length::All || *part == of)
}

fn affine(making: &mut Making<'_>, of: Length, factor: f64, offset: f64) -> Vec<Mistake> {
    making.lengths(of, |_, _, x| factor * x + offset);
    // A candidate may leave out one of the two.
    parts(of).map(|of| Mistake::Affine { of, factor, offset }).collect()
}

fn rounded(making: &mut Making<'_>, of: Length, quantum: f64, down: bool) -> Vec<Mistake> {
    making.lengths(of, |_, _, x| {
        let steps = x / quantum;
        quantum * if down { steps.floor() } else { steps.round() }
    });
    parts(of).map(|of| Mistake::Rounded { of, quantum, down }).collect()
}

/// Depths as a z-buffer holds them, 0 and 1 at these.
fn z_buffered(making: &mut Making<'_>, zero_at: f64, one_at: f64) -> Vec<Mistake> {
    making.lengths(Length::Depth, |_, _, x| (1.0 / zero_at - 1.0 / x) / (1.0 / zero_at - 1.0 / one_at));
    // A line is known by any two points: it is -1 as far in front of `zero_at`, in 1/depth, as it is 1 behind it.
    let minus_one_at = 1.0 / (2.0 / zero_at - 1.0 / one_at);
    vec![
        Mistake::ZBuffer { low: 0.0, low_at: zero_at, one_at },
        Mistake::ZBuffer { low: -1.0, low_at: minus_one_at, one_at },
    ]
}

/// The nearest number of 11 significant bits.
fn in_half_precision(x: f64) -> f64 {
    let power = f64::from_bits(x.to_bits() & 0x7ff0_0000_0000_0000);
    let ulp = power / 1024.0;
    (x / ulp).round_ties_even() * ulp
}

/// Lines at a border with something else in them.
fn lines(making: &mut Making<'_>, by: CutBy, is_above: bool, lines: u32, held: Held) -> Vec<Mistake> {
    let (width, height) = making.size();
    let count = if by == CutBy::Row { height } else { width };
    let lines = lines.min(count / 4).max(1);
    let at = if is_above { count - lines } else { lines - 1 };
    let is_beyond = |i: u32, j: u32| {
        let line = if by == CutBy::Row { j } else { i };
        if is_above { line >= at } else { line <= at }
    };
    let beside = if is_above { count - lines - 1 } else { lines };
    match held {
        Held::Neighbour => making.moved(|_, _, i, j| match by {
            CutBy::Row if is_beyond(i, j) => (i, beside),
            CutBy::Column if is_beyond(i, j) => (beside, j),
            _ => (i, j),
        }),
        _ => {
            for (i, j) in making.cells().filter(|(i, j)| is_beyond(*i, *j)) {
                if held == Held::NoHit { making.lose(i, j) } else { making.zero(i, j) }
            }
        }
    }
    let cut = |held| Mistake::Cut { by, is_above, at: f64::from(at), lines, held };
    vec![cut(held), cut(Held::Anything)]
}

/// The share of hits at which a cut by range and one by depth lose the same; `None` if there is no such place among many hits.
fn share_of_both(making: &Making<'_>) -> Option<f64> {
    let (ranges, depths) = (making.map.range.as_ref()?, making.map.depth.as_ref()?);
    let both = |(i, j): (u32, u32)| ranges.at(i, j).get().zip(depths.at(i, j).get());
    let mut all: Vec<(f64, f64)> = making.cells().filter_map(both).collect();
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    let is_both = |index: usize| {
        let (kept, lost) = all.split_at(index + 1);
        let deepest = kept.iter().map(|one| one.1).fold(f64::NEG_INFINITY, f64::max);
        let shallowest = lost.iter().map(|one| one.1).fold(f64::INFINITY, f64::min);
        deepest < shallowest
    };
    let places: Vec<usize> = (20..all.len().saturating_sub(20)).filter(|index| is_both(*index)).collect();
    let index = places.get(places.len() / 2)?;
    Some((*index as f64 + 0.5) / (all.len() - 1) as f64)
}

/// Hits beyond a length that half of the hits reach are lost, or have this length.
fn clipped(making: &mut Making<'_>, by: CutBy, is_above: bool, share: f64, clamps: bool) -> Vec<Mistake> {
    let lengths = if by == CutBy::Range { &making.map.range } else { &making.map.depth };
    let Some(lengths) = lengths.clone() else { return Vec::new() };
    let mut all: Vec<f64> = lengths.cells().iter().filter_map(|cell| cell.get()).collect();
    if all.is_empty() {
        return Vec::new();
    }
    all.sort_by(f64::total_cmp);
    let index = ((all.len() - 1) as f64 * share) as usize;
    let at = all[index];
    // No hit lies between this one and the next that is lost: any number between them is as true.
    let lost = if is_above {
        all[index..].iter().find(|x| **x > at)
    } else {
        all[..index].iter().rfind(|x| **x < at)
    };
    let next = lost.copied().unwrap_or(at);
    // The ranges of what is lost and of what is kept: a cut by range and one by depth may lose the same.
    let ranges = making.map.range.clone();
    let (mut kept, mut gone): (Vec<f64>, Vec<f64>) = (Vec::new(), Vec::new());
    for (i, j) in making.cells() {
        let range = ranges.as_ref().and_then(|ranges| ranges.at(i, j).get());
        if let (Some(length), Some(range)) = (lengths.at(i, j).get(), range) {
            let is_lost = if is_above { length > at } else { length < at };
            if is_lost { &mut gone } else { &mut kept }.push(range);
        }
    }
    for (i, j) in making.cells() {
        if let Some(length) = lengths.at(i, j).get()
            && (if is_above { length > at } else { length < at })
        {
            if clamps {
                let image = if by == CutBy::Range { &mut making.map.range } else { &mut making.map.depth };
                image.as_mut().unwrap().set(i, j, Maybe::some(at));
            } else {
                making.lose(i, j);
            }
        }
    }
    let held = if clamps { Held::Constant(at) } else { Held::NoHit };
    let between = |k: u32| at + (next - at) * f64::from(k) / 16.0;
    let ends = if clamps { 0..=0 } else { 0..=16 };
    let mut found: Vec<Mistake> =
        ends.map(|k| Mistake::Cut { by, is_above, at: between(k), lines: 0, held }).collect();
    kept.sort_by(f64::total_cmp);
    gone.sort_by(f64::total_cmp);
    let border = if is_above { kept.last().zip(gone.first()) } else { gone.last().zip(kept.first()) };
    if let Some((low, high)) = border.filter(|(low, high)| low < high && !clamps) {
        let by = CutBy::RangeOrDepth;
        found.extend((0..=16).map(|k| {
            let at = low + (high - low) * f64::from(k) / 16.0;
            Mistake::Cut { by, is_above, at, lines: 0, held }
        }));
    }
    found
}
