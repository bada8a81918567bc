use std::sync::Arc;
use raypencil_scene::*;
use raypencil_harness::*;
use glam::DVec3;
fn main() {
    let arg = std::env::args().nth(1).unwrap_or("pyramids".into());
    let ground = match arg.parse::<usize>() { Ok(n) => {
        let seed = std::env::args().nth(2).and_then(|s| s.parse().ok()).unwrap_or(1);
        if std::env::args().nth(3).is_some() { raypencil_terrain::RandomGround::nasty(seed, n).build() } else { raypencil_terrain::RandomGround::plain(seed, n, 40.0).build() } }
        Err(_) => raypencil_terrain::builtin(&arg, 0.25).unwrap() };
    let mesh = Arc::new(ground.into_mesh().unwrap());
    let z = raypencil_terrain::height_at(&mesh, 0.0, 0.0).unwrap();
    let vehicle = Pose::from_position(DVec3::new(0.0, 0.0, z) - mesh.origin());
    let mount = |p: DVec3, down: f64| vehicle * (Pose::from_position(p) * Pose::from_axis_angle(DVec3::Y, down.to_radians()) * Pose::VEHICLE_FROM_FORWARD_SENSOR);
    let camera = Mounted { scene_from_sensor: mount(DVec3::new(0.3,0.0,1.5), 20.0), sensor: Camera { width: 1024, height: 1024, pixel_pitch: [9e-6;2], focal_length: 8e-3, principal_point: [512.0;2], aperture: 2e-3, max_range: 20.0 } };
    let beam = |h: f64, d: f64| Mounted { scene_from_sensor: mount(DVec3::new(0.3,0.0,h), d), sensor: Beam { columns: 1024, rows: 16, thickness: 5e-3, grid_distance: 0.1, half_width: Beam::half_width_of(0.1, 60f64.to_radians()), max_range: 20.0, power: 1.0, wavelength: 810e-9, profile: Profile::Paper } };
    let scene = Scene::new(mesh, camera, vec![beam(1.8, 31.0), beam(2.0, 22.0)], Atmosphere { attenuation: 0.0 }, FluxModel::Radiometric).unwrap();
    let subject = Subject { scene, name: arg.clone(), arguments: arg, sha256: String::new() };
    let (s, t) = (renderer("scanline").unwrap(), renderer("tracer").unwrap());
    let v = validate(subject, &[&*s, &*t], &Silent);
    println!("{:?}", v.counts());
    for stage in &v.stages { println!("  {:40} {:?}", stage.name, stage.time); }
    for s in &v.pairs[0].sensors {
        println!("{} hits {}", s.sensor, s.range_difference.as_ref().unwrap().cells().iter().filter(|c| c.get().is_some()).count());
        for (q, t) in &s.quantities { println!("   {q} {:?} {:?} {:?}", t.by_class, t.worst_error.map(|w| w.value), t.worst_ratio.map(|w| w.value)); }
        for d in s.defects.iter().take(5) { println!("   {} {}: {}", d.place, d.quantity, d.what); }
    }
    // camera map bench
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let request = Request { camera: true, beams: false, quantities: Quantities::RANGE_MAP };
    pool.install(|| for r in [&s, &t] { for _ in 0..5 { let st = std::time::Instant::now(); let f = r.render(&v.subject.scene, &request); println!("{} {:?}", r.name(), st.elapsed()); std::hint::black_box(f); } });
}
