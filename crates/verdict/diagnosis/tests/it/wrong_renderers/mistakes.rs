//! The table of mistakes.

use super::*;

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
    ("inverse depth", |m| {
        m.lengths(Length::Depth, |_, _, x| 1.0 / x);
        vec![Mistake::Inverse(Length::Depth)]
    }),
    ("inverse lengths", |m| {
        m.lengths(Length::All, |_, _, x| 1.0 / x);
        parts(Length::All).map(Mistake::Inverse).collect()
    }),
    ("squared range", |m| {
        m.lengths(Length::Range, |_, _, x| x * x);
        vec![Mistake::Squared(Length::Range)]
    }),
    ("z-buffer", |m| {
        let near = 0.125 + m.random.share();
        z_buffered(m, (near * 1e3).round() / 1e3, 50.0)
    }),
    ("reversed z-buffer", |m| z_buffered(m, f64::INFINITY, 0.5)),
    ("another beam", |m| {
        let SensorId::Beam(own) = m.sensor else { return Vec::new() };
        let scene = m.bench.scene;
        let is_alike =
            |beam: &usize| *beam != own && scene.size(SensorId::Beam(*beam)) == scene.size(m.sensor);
        let Some(other) = (0..scene.beams().len()).find(is_alike) else { return Vec::new() };
        let exact = m.bench.exact.answers.map(SensorId::Beam(other)).clone();
        *m.map = SensorMap { sensor: m.sensor, ..exact };
        vec![Mistake::HoldsBeam(other)]
    }),
    ("millimetres", |m| units(m, LengthUnit::Millimetres, 1e3)),
    ("centimetres", |m| units(m, LengthUnit::Centimetres, 1e2)),
    ("kilometres", |m| units(m, LengthUnit::Kilometres, 1e-3)),
    ("feet", |m| units(m, LengthUnit::Feet, 1.0 / 0.3048)),
    ("y up", |m| turned(m, Mistake::AxesYUp)),
    ("y up twice", |m| turned(m, Mistake::AxesYUpInverse)),
    ("left-handed", |m| turned(m, Mistake::Axes { of: Vectors::Both, from: [0, 1, 2], sign: [1, -1, 1] })),
    ("axes turned", |m| turned(m, Mistake::Axes { of: Vectors::Both, from: [2, 0, 1], sign: [1; 3] })),
    ("points' axes", |m| turned_alone(m, Vectors::Points)),
    ("normals' axes", |m| turned_alone(m, Vectors::Normals)),
    ("sensor's frame", |m| in_sensor_frame(m, FrameAxes::Optical)),
    ("view space of OpenGL", |m| in_sensor_frame(m, FrameAxes::OpenGl)),
    ("sensor's frame, x ahead", |m| in_sensor_frame(m, FrameAxes::Body)),
    ("points in the sensor's frame", |m| {
        let pose = m.pose();
        m.vectors(true, |_, _, p| pose.inverse() * p);
        let own = Mistake::SensorFrame { of: Vectors::Points, axes: FrameAxes::Optical };
        if pose == Pose::IDENTITY { Vec::new() } else { vec![own] }
    }),
    ("points rounded", |m| {
        let quantum = [1e-3, 1e-2, 5e-3, 1.0 / 256.0, 1e-4][m.random.below(5)];
        m.vectors(true, |_, _, p| (p / quantum).round() * quantum);
        vec![Mistake::PointsRounded(quantum)]
    }),
    ("points from the sensor", |m| {
        let position = m.pose().position;
        m.vectors(true, |_, _, p| p - position);
        if position == DVec3::ZERO { Vec::new() } else { vec![Mistake::PointsFromSensor] }
    }),
    ("points moved", |m| {
        let by = [0.25 * (m.random.share() * 16.0).floor(), 0.0, 1.5];
        m.vectors(true, |_, _, p| p + DVec3::from_array(by));
        vec![Mistake::PointsMoved(by)]
    }),
    ("normals inward", |m| {
        m.vectors(false, |_, _, n| -n);
        vec![Mistake::NormalsReversed]
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
    ("width of pixels", |m| {
        let by = 1.0 + m.random.number(1e-3, 5e-2);
        pitched(m, [by, 1.0])
    }),
    ("height of pixels", |m| {
        let by = 1.0 + m.random.number(1e-3, 5e-2);
        pitched(m, [1.0, by])
    }),
    ("both sides of pixels", |m| {
        let by = 1.0 + m.random.number(1e-2, 5e-2);
        pitched(m, [by, 1.0 / by])
    }),
    ("thickness", |m| {
        let SensorId::Beam(beam) = m.sensor else { return Vec::new() };
        let truth = m.bench.scene.beams()[beam].sensor.thickness;
        let stated = truth * (1.0 + m.random.number(5e-2, 0.5));
        let scene = m.other_sensor(|numbers| numbers.pitch[1] = stated);
        *m.map = m.rendered(&scene);
        vec![Mistake::Thickness { stated, truth }]
    }),
    ("pose inverted", |m| {
        let scene = m.other_sensor(|numbers| *numbers.pose = numbers.pose.inverse());
        *m.map = m.rendered(&scene);
        vec![Mistake::PoseInverted]
    }),
    ("rotation read as w, x, y, z", |m| {
        let scene = m.other_sensor(|numbers| {
            let [x, y, z, w] = numbers.pose.rotation.to_array();
            numbers.pose.rotation = glam::DQuat::from_xyzw(y, z, w, x);
        });
        *m.map = m.rendered(&scene);
        vec![Mistake::QuaternionOrder]
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
    ("half precision", |m| {
        m.lengths(Length::All, |_, _, x| in_half_precision(x));
        parts(Length::All).map(Mistake::HalfPrecision).collect()
    }),
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
    ("far hits lost, by range and depth alike", |m| {
        share_of_both(m).map_or_else(Vec::new, |share| clipped(m, CutBy::Range, true, share, false))
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
