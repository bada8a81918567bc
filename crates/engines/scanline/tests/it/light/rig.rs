//! Scenes for these tests: a wall at z = 2 m, pencils across it, and a camera that looks at it.

use std::sync::Arc;

use glam::{DQuat, DVec3};
use raypencil_scanline::{Scanline, ScanlineOptions};
use raypencil_scene::{
    Atmosphere, Beam, Camera, FluxModel, Image, Lens, Material, Mesh, Mounted, Pose, Profile, RenderOutput,
    Renderer, Request, Return, Scene,
};
use raypencil_terrain::{Ground, height_at};

pub(crate) type Face = [[f32; 3]; 3];

/// The numbers of a scene, to be changed and then rendered.
#[derive(Clone)]
pub(crate) struct Rig {
    pub(crate) faces: Vec<Face>,
    /// Reflectivities; the k-th face has the k-th, cyclically.
    pub(crate) reflectivities: Vec<f64>,
    pub(crate) camera: Camera,
    pub(crate) scene_from_camera: Pose,
    pub(crate) beams: Vec<Mounted<Beam>>,
    pub(crate) attenuation: f64,
    pub(crate) model: FluxModel,
}

/// A camera whose screen reaches from about -2 to 2 in x/z and y/z. Pixel (i, j) begins at x/z = (i - 128.25)/64.
pub(crate) fn camera() -> Camera {
    Camera {
        width: 256,
        height: 256,
        pixel_pitch: [1.0 / 8192.0; 2],
        focal_length: 1.0 / 128.0,
        principal_point: [128.25; 2],
        aperture: 2e-3,
        lens: Lens { transmission: 0.9, ..Lens::CLEAR },
        max_range: 20.0,
    }
}

/// A beam of four pencils in one row, at x/z = -3/4, -1/4, 1/4, 3/4. Its grid is 1/8 m away.
pub(crate) fn four_pencils() -> Beam {
    Beam {
        columns: 4,
        rows: 1,
        thickness: 5e-3,
        grid_distance: 0.125,
        half_width: 0.125,
        max_range: 20.0,
        power: 4.0,
        wavelength: 810e-9,
        profile: Profile::Paper,
    }
}

/// A beam of one pencil along its axis.
pub(crate) fn one_pencil() -> Beam {
    Beam { columns: 1, power: 1.0, ..four_pencils() }
}

/// A wall at `z`, its front towards -z.
pub(crate) fn wall(z: f32) -> Face {
    [[-40.0, -40.0, z], [0.0, 40.0, z], [40.0, -40.0, z]]
}

/// The same face with front and back exchanged.
pub(crate) fn reversed([a, b, c]: Face) -> Face {
    [a, c, b]
}

pub(crate) fn at<S>(x: f64, y: f64, z: f64, sensor: S) -> Mounted<S> {
    Mounted { scene_from_sensor: Pose::from_position(DVec3::new(x, y, z)), sensor }
}

impl Rig {
    /// A camera at (0, -2, 0) and four pencils from (-1/2, 0, 0), all looking along z at a wall at 2 m. The last
    /// pencil runs at x/z = 3/4 and hits (1, 0, 2), which is (1, 2, 2) in the camera's frame.
    pub(crate) fn new() -> Self {
        Self {
            faces: vec![wall(2.0)],
            reflectivities: vec![0.25],
            camera: camera(),
            scene_from_camera: Pose::from_position(DVec3::new(0.0, -2.0, 0.0)),
            beams: vec![at(-0.5, 0.0, 0.0, four_pencils())],
            attenuation: 0.0,
            model: FluxModel::Radiometric,
        }
    }

    /// Adds faces.
    pub(crate) fn with(mut self, faces: &[Face]) -> Self {
        self.faces.extend(faces);
        self
    }

    pub(crate) fn scene(&self) -> Scene {
        let vertices = self.faces.iter().flatten().copied().collect();
        let indices: Vec<_> = (0..self.faces.len() as u32).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
        let kinds = self.reflectivities.len() as u16;
        let materials = (0..indices.len() as u16).map(|k| k % kinds).collect();
        let kind = |&reflectivity| Material { name: "ground".into(), reflectivity };
        let kinds = self.reflectivities.iter().map(kind).collect();
        let mesh = Mesh::new(DVec3::ZERO, vertices, indices, materials, kinds).expect("a valid mesh");
        let camera = Mounted { scene_from_sensor: self.scene_from_camera, sensor: self.camera };
        let air = Atmosphere { attenuation: self.attenuation };
        Scene::new(Arc::new(mesh), camera, self.beams.clone(), air, self.model).expect("a valid scene")
    }

    pub(crate) fn render(&self) -> RenderOutput {
        Scanline::exact().render(&self.scene(), &Request::EVERYTHING)
    }

    /// The return of one pencil of the first beam.
    pub(crate) fn pencil_return(&self, i: u32) -> Return {
        return_at(&self.render(), 0, i, 0).expect("a hit")
    }
}

/// The return of pencil (i, j), or `None` if it has no hit.
pub(crate) fn return_at(frame: &RenderOutput, beam: usize, i: u32, j: u32) -> Option<Return> {
    let returns = &frame.returns[beam];
    Some(Return {
        depth: returns.depth.as_ref()?.at(i, j).get()?,
        visible: returns.visible.as_ref()?.at(i, j),
        pixel: returns.pixel.as_ref()?.at(i, j).get(),
        cos_off_axis: returns.cos_off_axis.as_ref()?.at(i, j).get()?,
        cos_view: returns.cos_view.as_ref()?.at(i, j).get()?,
        flux: returns.flux.as_ref()?.at(i, j),
    })
}

/// The default rig on a ground, with rasters four times coarser and sheets of that thickness, metres.
pub(crate) fn rig_on(ground: Ground, thickness: f64) -> Scene {
    let mesh = Arc::new(ground.into_mesh().expect("a valid ground"));
    let z = height_at(&mesh, 0.0, 0.0).expect("ground under the vehicle");
    let scene_from_vehicle = Pose::from_position(DVec3::new(0.0, 0.0, z) - mesh.origin());
    let mount = |height: f64, pitch_down_deg: f64| {
        scene_from_vehicle
            * Pose::from_position(DVec3::new(0.3, 0.0, height))
            * Pose::from_axis_angle(DVec3::Y, pitch_down_deg.to_radians())
            * Pose::VEHICLE_FROM_FORWARD_SENSOR
    };
    let camera = Camera {
        pixel_pitch: [36e-6; 2],
        focal_length: 8e-3,
        principal_point: [128.0; 2],
        max_range: 20.0,
        ..camera()
    };
    let beam = Beam {
        columns: 256,
        rows: 4,
        thickness,
        grid_distance: 0.1,
        half_width: Beam::half_width_of(0.1, 60_f64.to_radians()),
        ..four_pencils()
    };
    let camera = Mounted { scene_from_sensor: mount(1.5, 20.0), sensor: camera };
    let beams = [(1.8, 31.0), (2.0, 22.0)]
        .map(|(height, down)| Mounted { scene_from_sensor: mount(height, down), sensor: beam });
    let air = Atmosphere { attenuation: 1e-2 };
    Scene::new(mesh, camera, beams.to_vec(), air, FluxModel::Radiometric).expect("a valid scene")
}

/// Renders everything with these options.
pub(crate) fn render(scene: &Scene, options: ScanlineOptions) -> RenderOutput {
    Scanline::new(options).render(scene, &Request::EVERYTHING)
}

/// Pseudo-random numbers in -1..1, from a linear congruential generator (D. Knuth's MMIX).
pub(crate) struct RandomNumbers(pub(crate) u64);

impl RandomNumbers {
    pub(crate) fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    pub(crate) fn vector(&mut self) -> DVec3 {
        DVec3::new(self.next(), self.next(), self.next())
    }

    /// A rotation by a small angle; the quaternion is not a unit.
    pub(crate) fn rotation(&mut self) -> DQuat {
        DQuat::from_xyzw(0.2 * self.next(), 0.2 * self.next(), 0.2 * self.next(), 1.0)
    }
}

/// The sum of all cells.
pub(crate) fn sum(image: &Image<f64>) -> f64 {
    image.cells().iter().sum()
}
