//! Wrong renderers, made on purpose: some sixty mistakes with random numbers, each in one sensor or in all, alone or beside
//! another one. Each says what is true of it, so that a reason that is told can be held to it.

use std::sync::Arc;

use glam::DVec3;
use raypencil_diagnosis::{AngleUnit, CutBy, Diagnosis, Held, Length, LengthUnit, Mistake, Reason, Turn};
use raypencil_judge::{Quantity, Recorded};
use raypencil_referee::ExactRenderer;
use raypencil_scene::{FaceId, Maybe, Mesh, Pose, Renderer, Request, Scene, SensorId, SensorMap};

use super::candidates::Bench;

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
    vec![mistake]
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

/// Hits beyond a length that half of the hits reach are lost, or have this length.
fn clipped(making: &mut Making<'_>, by: CutBy, is_above: bool, share: f64, clamps: bool) -> Vec<Mistake> {
    let lengths = if by == CutBy::Range { &making.map.range } else { &making.map.depth };
    let Some(lengths) = lengths.clone() else { return Vec::new() };
    let mut all: Vec<f64> = lengths.cells().iter().filter_map(|cell| cell.get()).collect();
    if all.is_empty() {
        return Vec::new();
    }
    all.sort_by(f64::total_cmp);
    let at = all[((all.len() - 1) as f64 * share) as usize];
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
    vec![Mistake::Cut { by, is_above, at, lines: 0, held }]
}

/// The mistakes, each with what is true of it; those with nothing that is true have no reason.
pub const MISTAKES: &[Make] = &[
    ("rows reversed", |m| {
        m.moved(|_, h, i, j| (i, h - 1 - j));
        vec![Mistake::RowsReversed]
    }),
    ("columns reversed", |m| {
        m.moved(|w, _, i, j| (w - 1 - i, j));
        vec![Mistake::ColumnsReversed]
    }),
    ("column by column", |m| {
        m.moved(|w, h, i, j| ((j * w + i) / h, (j * w + i) % h));
        vec![Mistake::Transposed]
    }),
    ("one column right", |m| shifted(m, 1, 0)),
    ("one column left", |m| shifted(m, -1, 0)),
    ("one row down", |m| shifted(m, 0, 1)),
    ("one row up", |m| shifted(m, 0, -1)),
    ("faces from 1", |m| {
        m.faces(|face| face + 1);
        vec![Mistake::FacesShifted(1)]
    }),
    ("faces in an own order", |m| {
        let count = m.bench.scene.mesh().faces().len() as u32;
        // 11 and 137 have no divisor in common with 6 or 224.
        m.faces(|face| (if count == 6 { 11 } else { 137 } * face + 5) % count);
        vec![Mistake::FacesReordered]
    }),
    ("depth for range", |m| {
        m.map.range = m.map.depth.clone();
        vec![Mistake::DepthForRange]
    }),
    ("range for depth", |m| {
        m.map.depth = m.map.range.clone();
        vec![Mistake::RangeForDepth]
    }),
    ("t for range", |m| {
        let lengths: Vec<f64> = m.cells().map(|(i, j)| m.length(i, j)).collect();
        let width = m.size().0;
        m.lengths(Length::Range, |i, j, x| x / lengths[(j * width + i) as usize]);
        vec![Mistake::ParameterForRange]
    }),
    ("t for depth", |m| {
        let axis = m.axis();
        m.lengths(Length::Depth, |_, _, x| x / axis);
        vec![
            Mistake::ParameterForDepth,
            Mistake::Affine { of: Length::Depth, factor: 1.0 / axis, offset: 0.0 },
        ]
    }),
    ("millimetres", |m| units(m, LengthUnit::Millimetres, 1e3)),
    ("centimetres", |m| units(m, LengthUnit::Centimetres, 1e2)),
    ("kilometres", |m| units(m, LengthUnit::Kilometres, 1e-3)),
    ("feet", |m| units(m, LengthUnit::Feet, 1.0 / 0.3048)),
    ("y up", |m| turned(m, Mistake::AxesYUp)),
    ("y up twice", |m| turned(m, Mistake::AxesYUpInverse)),
    ("left-handed", |m| turned(m, Mistake::Axes { from: [0, 1, 2], sign: [1, -1, 1] })),
    ("axes turned", |m| turned(m, Mistake::Axes { from: [2, 0, 1], sign: [1; 3] })),
    ("sensor's frame", |m| {
        let pose = m.pose();
        m.vectors(true, |_, _, p| pose.inverse() * p);
        m.vectors(false, |_, _, n| pose.inverse().rotate(n));
        if pose == Pose::IDENTITY { Vec::new() } else { vec![Mistake::SensorFrame] }
    }),
    ("normals inward", |m| {
        m.vectors(false, |_, _, n| -n);
        vec![Mistake::NormalsReversed, Mistake::Axes { from: [0, 1, 2], sign: [-1; 3] }]
    }),
    ("normals not unit", |m| {
        m.vectors(false, |i, j, n| n * (1.5 + f64::from((i + j) % 7)));
        vec![Mistake::NormalsNotUnit]
    }),
    ("cosines negated", |m| {
        m.cosines(|x| -x);
        vec![Mistake::CosinesNegated]
    }),
    ("radians", |m| {
        m.cosines(|x| libm::acos(x.min(1.0)));
        vec![Mistake::AngleForCosine(AngleUnit::Radians)]
    }),
    ("degrees", |m| {
        m.cosines(|x| libm::acos(x.min(1.0)).to_degrees());
        vec![Mistake::AngleForCosine(AngleUnit::Degrees)]
    }),
    ("single precision", |m| {
        m.lengths(Length::All, |i, j, x| {
            let single = x as f32;
            f64::from(if (i + j) % 2 == 0 { single.next_up() } else { single })
        });
        vec![Mistake::SinglePrecision]
    }),
    ("backs hit", |m| {
        let mesh = m.bench.scene.mesh();
        let count = mesh.faces().len() as u32;
        let faces = mesh.faces().iter().copied().chain(mesh.faces().iter().map(|[a, b, c]| [*a, *c, *b]));
        let scene = m.other_mesh(m.mesh_of(mesh.vertices().to_vec(), faces.collect()));
        *m.map = m.rendered(&scene);
        m.faces(|face| face % count);
        vec![Mistake::BacksHit]
    }),
    ("near plane ignored", |m| {
        // The plane is a hundred times nearer and all that lies in it smaller: the same rays.
        if m.sensor != SensorId::Camera {
            return Vec::new();
        }
        let scene = m.other_sensor(|numbers| {
            *numbers.focal_length *= 1e-2;
            numbers.pitch.iter_mut().for_each(|pitch| *pitch *= 1e-2);
        });
        *m.map = m.rendered(&scene);
        vec![Mistake::NearPlaneIgnored]
    }),
    ("nearest t is 1.3", |m| {
        if m.sensor != SensorId::Camera {
            return Vec::new();
        }
        let scene = m.other_sensor(|numbers| {
            *numbers.focal_length *= 1.3;
            numbers.pitch.iter_mut().for_each(|pitch| *pitch *= 1.3);
        });
        *m.map = m.rendered(&scene);
        vec![Mistake::NearLimit(1.3)]
    }),
    ("maximum range ignored", |m| {
        let scene = m.other_sensor(|numbers| *numbers.max_range = 1e6);
        *m.map = m.rendered(&scene);
        vec![Mistake::MaximumRangeIgnored]
    }),
    ("maximum range as depth", |m| {
        let most = m.bench.scene.max_range(m.sensor).unwrap();
        let scene = m.other_sensor(|numbers| *numbers.max_range = 1e6);
        *m.map = m.rendered(&scene);
        let depths = m.map.depth.clone().unwrap();
        for (i, j) in m.cells().filter(|(i, j)| depths.at(*i, *j).get().is_some_and(|depth| depth > most)) {
            m.lose(i, j);
        }
        // Where no hit is deeper than that, the limit is ignored: it says the same of every ray.
        vec![Mistake::MaximumRangeAsDepth, Mistake::MaximumRangeIgnored]
    }),
    ("top left corner", |m| offset(m, [-0.5, -0.5])),
    ("bottom right corner", |m| offset(m, [0.5, 0.5])),
    ("half a pixel in x", |m| offset(m, [0.5, 0.0])),
    ("half a pixel in y", |m| offset(m, [0.0, -0.5])),
    ("cx", |m| {
        let by = m.random.number(0.05, 3.0);
        offset(m, [by, 0.0])
    }),
    ("cy", |m| {
        let by = m.random.number(0.05, 3.0);
        offset(m, [0.0, by])
    }),
    ("principal point", |m| {
        let by = [0; 2].map(|_| m.random.number(0.05, 3.0));
        offset(m, by)
    }),
    ("focal length", |m| {
        if m.sensor != SensorId::Camera {
            return Vec::new();
        }
        let factor = 1.0 + m.random.number(2e-4, 2e-2);
        let truth = m.bench.scene.camera().sensor.focal_length;
        let scene = m.other_sensor(|numbers| *numbers.focal_length *= factor);
        *m.map = m.rendered(&scene);
        vec![Mistake::FocalLength { stated: truth * factor, truth }]
    }),
    ("fan", |m| {
        let SensorId::Beam(beam) = m.sensor else { return Vec::new() };
        let factor = 1.0 + m.random.number(1e-3, 3e-2);
        let scene = m.other_sensor(|numbers| *numbers.half_width *= factor);
        *m.map = m.rendered(&scene);
        let beam = &m.bench.scene.beams()[beam].sensor;
        let angle =
            |factor: f64| 2.0 * libm::atan(factor * beam.half_width / beam.grid_distance).to_degrees();
        vec![Mistake::Fan { stated: angle(factor), truth: angle(1.0) }]
    }),
    ("pitch", |m| {
        let by = m.random.number(0.01, 1.0);
        posed(m, [by, 0.0, 0.0], [0.0; 3])
    }),
    ("yaw", |m| {
        let by = m.random.number(0.01, 1.0);
        posed(m, [0.0, by, 0.0], [0.0; 3])
    }),
    ("roll", |m| {
        let by = m.random.number(0.05, 1.0);
        posed(m, [0.0, 0.0, by], [0.0; 3])
    }),
    ("height", |m| {
        let by = m.random.number(1e-3, 5e-2);
        posed(m, [0.0; 3], [0.0, 0.0, by])
    }),
    ("ahead", |m| {
        let by = m.random.number(1e-3, 5e-2);
        posed(m, [0.0; 3], [by, 0.0, 0.0])
    }),
    ("place", |m| {
        let by = [0; 3].map(|_| m.random.number(1e-3, 5e-2));
        posed(m, [0.0; 3], by)
    }),
    ("rotation", |m| {
        let by = [0; 3].map(|_| m.random.number(0.02, 0.5));
        posed(m, by, [0.0; 3])
    }),
    ("pose", |m| {
        let turns = [0; 3].map(|_| m.random.number(0.02, 0.5));
        let by = [0; 3].map(|_| m.random.number(1e-3, 5e-2));
        posed(m, turns, by)
    }),
    ("range scaled", |m| {
        let factor = 1.0 + m.random.number(1e-6, 1e-1);
        affine(m, Length::Range, factor, 0.0)
    }),
    ("range offset", |m| {
        let offset = m.random.number(1e-5, 1e-1);
        affine(m, Length::Range, 1.0, offset)
    }),
    ("range scaled and offset", |m| {
        let [factor, offset] = [m.random.number(1e-4, 1e-1), m.random.number(1e-3, 1e-1)];
        affine(m, Length::Range, 1.0 + factor, offset)
    }),
    ("lengths scaled", |m| {
        let factor = 1.0 + m.random.number(1e-6, 1e-1);
        m.vectors(true, |_, _, p| factor * p);
        affine(m, Length::All, factor, 0.0)
    }),
    ("lengths offset", |m| {
        let offset = m.random.number(1e-5, 1e-1);
        affine(m, Length::All, 1.0, offset)
    }),
    ("depth offset", |m| {
        let offset = m.random.number(1e-5, 1e-1);
        affine(m, Length::Depth, 1.0, offset)
    }),
    ("range from the plane", |m| {
        let lengths: Vec<f64> = m.cells().map(|(i, j)| m.length(i, j)).collect();
        let width = m.size().0;
        m.lengths(Length::Range, |i, j, x| x - lengths[(j * width + i) as usize]);
        vec![Mistake::FromPlane(Length::Range)]
    }),
    ("depth from the plane", |m| {
        let axis = m.axis();
        m.lengths(Length::Depth, |_, _, x| x - axis);
        vec![
            Mistake::FromPlane(Length::Depth),
            Mistake::Affine { of: Length::Depth, factor: 1.0, offset: -axis },
        ]
    }),
    ("range rounded", |m| {
        let quantum = [1e-3, 1e-2, 5e-3, 1.0 / 256.0, 1e-4][m.random.below(5)];
        rounded(m, Length::Range, quantum, false)
    }),
    ("range rounded down", |m| {
        let quantum = [1e-3, 1e-2, 5e-3, 1.0 / 256.0, 1e-4][m.random.below(5)];
        rounded(m, Length::Range, quantum, true)
    }),
    ("lengths rounded", |m| rounded(m, Length::All, 1e-3, false)),
    ("far hits lost", |m| {
        let share = 0.5 + 0.45 * m.random.share();
        clipped(m, CutBy::Range, true, share, false)
    }),
    ("far ranges clamped", |m| {
        let share = 0.5 + 0.45 * m.random.share();
        clipped(m, CutBy::Range, true, share, true)
    }),
    ("deep hits lost", |m| {
        let share = 0.5 + 0.45 * m.random.share();
        clipped(m, CutBy::Depth, true, share, false)
    }),
    ("near hits lost", |m| {
        let share = 0.05 + 0.4 * m.random.share();
        clipped(m, CutBy::Range, false, share, false)
    }),
    ("last row lost", |m| lines(m, CutBy::Row, true, 1, Held::NoHit)),
    ("last row 0", |m| lines(m, CutBy::Row, true, 1, Held::Constant(0.0))),
    ("last row twice", |m| lines(m, CutBy::Row, true, 1, Held::Neighbour)),
    ("first row lost", |m| lines(m, CutBy::Row, false, 1, Held::NoHit)),
    ("last column lost", |m| lines(m, CutBy::Column, true, 1, Held::NoHit)),
    ("last column 0", |m| lines(m, CutBy::Column, true, 1, Held::Constant(0.0))),
    ("last column twice", |m| lines(m, CutBy::Column, true, 1, Held::Neighbour)),
    ("last columns lost", |m| lines(m, CutBy::Column, true, 5, Held::NoHit)),
    // What follows has no reason that is known.
    ("noise", |m| {
        let size = m.random.number(1e-9, 1e-2).abs();
        let mut random = Random(m.random.next());
        m.lengths(Length::Range, |_, _, x| x * (1.0 + size * (2.0 * random.share() - 1.0)));
        // Noise as small as that is single precision, as far as anyone can see in a file of single precision.
        if size < 1e-6 { vec![Mistake::SinglePrecision] } else { Vec::new() }
    }),
    ("some noise", |m| {
        let mut random = Random(m.random.next());
        m.lengths(
            Length::Range,
            |_, _, x| {
                if random.below(10) == 0 { x * (0.9 + 0.2 * random.share()) } else { x }
            },
        );
        Vec::new()
    }),
    ("any faces", |m| {
        let count = m.bench.scene.mesh().faces().len();
        let mut random = Random(m.random.next());
        m.faces(|_| random.below(count) as u32);
        Vec::new()
    }),
    ("one wrong face in a thousand", |m| {
        let count = m.bench.scene.mesh().faces().len() as u32;
        let mut random = Random(m.random.next());
        m.faces(|face| if random.below(1000) == 0 { (face + 1) % count } else { face });
        Vec::new()
    }),
    ("a face is not there", |m| {
        let mesh = m.bench.scene.mesh();
        let faces: Vec<u32> = m
            .map
            .face
            .iter()
            .flat_map(|image| image.cells())
            .filter_map(|cell| Some(cell.get()?.0))
            .collect();
        if faces.is_empty() {
            return Vec::new();
        }
        let lost = faces[m.random.below(faces.len())];
        let mut others = mesh.faces().to_vec();
        // Three times the same corner: nothing can meet it.
        others[lost as usize] = [others[lost as usize][0]; 3];
        let scene = m.other_mesh(m.mesh_of(mesh.vertices().to_vec(), others));
        *m.map = m.rendered(&scene);
        Vec::new()
    }),
    ("a corner is elsewhere", |m| {
        let mesh = m.bench.scene.mesh();
        let mut vertices = mesh.vertices().to_vec();
        let count = vertices.len();
        vertices[m.random.below(count)][2] += 0.25;
        let scene = m.other_mesh(m.mesh_of(vertices, mesh.faces().to_vec()));
        *m.map = m.rendered(&scene);
        Vec::new()
    }),
    ("a block is lost", |m| {
        let (width, height) = m.size();
        let [left, top] = [m.random.below(width as usize / 2), m.random.below(height as usize / 2)];
        let inside = |k: u32, from: usize, of: u32| (from as u32 + 1..from as u32 + 1 + of / 3).contains(&k);
        let lost: Vec<_> =
            m.cells().filter(|(i, j)| inside(*i, left, width) && inside(*j, top, height)).collect();
        lost.into_iter().for_each(|(i, j)| m.lose(i, j));
        Vec::new()
    }),
    ("every fifth is lost", |m| {
        let lost: Vec<_> = m.cells().filter(|(i, j)| (i + 3 * j) % 5 == 0).collect();
        lost.into_iter().for_each(|(i, j)| m.lose(i, j));
        Vec::new()
    }),
    ("error grows with the square", |m| {
        let size = m.random.number(1e-5, 1e-2);
        m.lengths(Length::Range, |_, _, x| x + size * x * x);
        Vec::new()
    }),
    ("error by column", |m| {
        let size = m.random.number(1e-4, 1e-2);
        m.lengths(Length::Range, |i, _, x| x + size * libm::sin(f64::from(i)));
        Vec::new()
    }),
    ("ranges smoothed", |m| {
        let Some(old) = m.map.range.clone() else { return Vec::new() };
        m.lengths(Length::Range, |i, j, x| match old.at((i + 1).min(old.width() - 1), j).get() {
            Some(other) => 0.5 * (x + other),
            None => x,
        });
        Vec::new()
    }),
];

/// A wrong renderer.
pub struct Wrong {
    pub candidate: Recorded,
    /// What was made of which sensor, in words.
    pub made: Vec<(SensorId, &'static str)>,
    /// What is true of each sensor.
    truth: Vec<(SensorId, Vec<Mistake>)>,
}

/// The hits alone: light follows them in ways of its own.
pub fn hits_of(bench: &Bench) -> Recorded {
    let mut candidate = bench.exact.clone();
    let is_hit = |quantity: Quantity| {
        matches!(
            quantity,
            Quantity::Face
                | Quantity::Range
                | Quantity::Depth
                | Quantity::Point
                | Quantity::Normal
                | Quantity::CosIncidence
        )
    };
    candidate.storage.retain(|(_, item), _| is_hit(item.quantity));
    for light in &mut candidate.answers.light {
        (light.image, light.other_image, light.other_flux) = (None, None, None);
        let (columns, rows) = (light.returns.columns, light.returns.rows);
        light.returns = raypencil_scene::Returns::unsupported(columns, rows);
    }
    candidate
}

impl Wrong {
    pub fn right(bench: &Bench) -> Self {
        Self { candidate: hits_of(bench), made: Vec::new(), truth: Vec::new() }
    }

    /// Leaves a quantity out.
    pub fn without(&mut self, quantity: Quantity) {
        self.candidate.storage.retain(|(_, item), _| item.quantity != quantity);
        for map in &mut self.candidate.answers.maps {
            match quantity {
                Quantity::Face => map.face = None,
                Quantity::Range => map.range = None,
                Quantity::Depth => map.depth = None,
                Quantity::Point => map.point = None,
                Quantity::Normal => map.normal = None,
                _ => map.cos_incidence = None,
            }
        }
    }

    /// Makes a mistake in a sensor. Rays that are cast otherwise forget what was made before: they come first.
    pub fn make(&mut self, bench: &Bench, (name, make): Make, sensor: SensorId, random: &mut Random) {
        let index = match sensor {
            SensorId::Camera => 0,
            SensorId::Beam(beam) => beam + 1,
        };
        let map = &mut self.candidate.answers.maps[index];
        let true_of_it = make(&mut Making { bench, sensor, map, random });
        self.made.push((sensor, name));
        self.truth.push((sensor, true_of_it));
    }

    /// The candidate as a file of single precision.
    pub fn store_single(&mut self) {
        self.candidate = super::candidates::stored_single(&self.candidate);
    }

    /// The first reason that is not true; `None` if all are.
    pub fn false_reason(&self, found: Option<&Diagnosis>) -> Option<String> {
        let is_false = |reason: &&Reason| {
            !reason.sensors.iter().all(|sensor| {
                reason.mistakes.iter().all(|told| {
                    let of_sensor = self.truth.iter().filter(|(of, _)| of == sensor);
                    of_sensor.clone().flat_map(|(_, all)| all).any(|one| is_same(one, told))
                        || is_sum(of_sensor.map(|(_, all)| all.as_slice()), told)
                })
            })
        };
        let reason = found?.reasons.iter().find(is_false)?;
        Some(format!("made {:?}, told: {}", self.made, reason.sentence()))
    }
}

/// By how many cells the rays are off, of mistakes that say so.
fn cells_off(mistake: &Mistake) -> Option<[f64; 2]> {
    match mistake {
        Mistake::Shifted { columns, rows } => Some([-f64::from(*columns), -f64::from(*rows)]),
        Mistake::PrincipalPoint { stated, truth } => Some([truth[0] - stated[0], truth[1] - stated[1]]),
        Mistake::CornerRays { columns, rows } => Some([*columns, *rows]),
        _ => None,
    }
}

/// Whether what is told is all that several mistakes come to: a shift and another principal point are a third one.
fn is_sum<'m>(made: impl Iterator<Item = &'m [Mistake]>, told: &Mistake) -> bool {
    let mut sum = [0.0; 2];
    for [dx, dy] in made.filter_map(|all| all.iter().find_map(cells_off)) {
        sum = [sum[0] + dx, sum[1] + dy];
    }
    cells_off(told).is_some_and(|told| (0..2).all(|k| (told[k] - sum[k]).abs() < 1e-3))
}

/// Whether two mistakes are the same with nearly the same numbers: of numbers that were found, a hundredth may be missing.
fn is_same(made: &Mistake, told: &Mistake) -> bool {
    let parts = |mistake: &Mistake| {
        let text = format!("{mistake:?}");
        let words: Vec<String> = text
            .split(|c: char| !(c.is_ascii_alphanumeric() || matches!(c, '.' | '-' | '_')))
            .filter(|word| !word.is_empty())
            .map(str::to_string)
            .collect();
        words
    };
    // Of several sensors the first is told, whose last row has another number.
    if made.to_string() == told.to_string() {
        return true;
    }
    let (made_parts, told_parts) = (parts(made), parts(told));
    if made_parts.len() != told_parts.len() || made.key() != told.key() {
        return false;
    }
    // How much a number may differ: a hundredth of what it is off by.
    let difference = match (made, told) {
        (Mistake::FocalLength { stated, truth }, _) | (Mistake::Fan { stated, truth }, _) => stated - truth,
        (Mistake::Affine { factor, offset: 0.0, .. }, _) => factor - 1.0,
        // A cut lies somewhere between two hits.
        (Mistake::Cut { .. }, _) => 10.0,
        _ => 1.0,
    };
    made_parts.iter().zip(&told_parts).all(|(a, b)| match (a.parse::<f64>(), b.parse::<f64>()) {
        (Ok(a), Ok(b)) => (a - b).abs() <= 0.01 * difference.abs().min(a.abs().max(1e-3)),
        _ => a == b,
    })
}

/// One draw: a mistake in one sensor or in all, alone or beside another, in a candidate that has some quantities.
pub fn draw(bench: &Bench, seed: u64) -> Wrong {
    let mut random = Random(seed);
    let mut wrong = Wrong::right(bench);
    let sensors: Vec<SensorId> = bench.scene.sensors().collect();
    let mut makes = vec![MISTAKES[random.below(MISTAKES.len())]];
    if random.below(2) == 0 {
        makes.push(MISTAKES[random.below(MISTAKES.len())]);
    }
    // Those that cast rays again come first.
    let casts =
        ["backs hit", "near plane", "nearest t", "maximum range", "corner", "pixel", "cx", "cy", "principal"];
    let more = [
        "focal", "fan", "pitch", "yaw", "roll", "height", "ahead", "place", "rotation", "pose", "a face",
        "a corner",
    ];
    makes.sort_by_key(|(name, _)| !casts.iter().chain(&more).any(|start| name.contains(start)));
    let at: Vec<usize> = (0..2).map(|_| random.below(sensors.len() + 1)).collect();
    // Two that cast again in one sensor would forget one another.
    for (k, make) in makes.iter().enumerate() {
        match sensors.get(at[k]) {
            Some(sensor) => wrong.make(bench, *make, *sensor, &mut random),
            None => {
                let seed = random.next();
                for sensor in &sensors {
                    // The same numbers in all.
                    wrong.make(bench, *make, *sensor, &mut Random(seed));
                }
            }
        }
    }
    for quantity in [
        Quantity::Face,
        Quantity::Range,
        Quantity::Depth,
        Quantity::Point,
        Quantity::Normal,
        Quantity::CosIncidence,
    ] {
        if quantity != Quantity::Range && random.below(3) == 0 {
            wrong.without(quantity);
        }
    }
    if random.below(3) == 0 {
        wrong.store_single();
    }
    wrong
}
