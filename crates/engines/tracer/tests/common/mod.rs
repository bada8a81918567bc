//! Scenes of plain numbers: a camera at the scene's origin that looks along z, with x right and y down; a beam beside
//! it that looks the same way; and screens at right angles to z.

// Each test binary compiles its own copy and uses a part of it.
#![allow(dead_code)]

use std::sync::Arc;

use glam::{DQuat, DVec3};
use raypencil_scene::{
    Atmosphere, Beam, Camera, FluxModel, Image, Lens, Material, Mesh, Mounted, Pose, Profile, RenderOutput,
    Renderer, Request, Return, Returns, Scene,
};
use raypencil_tracer::Tracer;

pub type Corners = [[f32; 3]; 3];

/// The numbers of a scene, to be changed and then rendered.
#[derive(Clone)]
pub struct SceneBuilder {
    pub faces: Vec<Corners>,
    pub reflectivity: f64,
    pub camera: Camera,
    pub beam: Beam,
    /// The beam's pose in the scene.
    pub pose: Pose,
    pub attenuation: f64,
    pub model: FluxModel,
}

impl SceneBuilder {
    /// A screen at z = 2 m and three pencils from (3, 0, 0) along (-3/4, 0, 1), (0, 0, 1) and (3/4, 0, 1): g = 1/4 m,
    /// x_i = w (2i - 2) / 3, w = (9/8) g. They hit at x = 1.5, 3 and 4.5 m. The beam has 3 W.
    ///
    /// The camera has f_c = 1/64 m, pixels of 2^-10 m and an aperture of 1/2 m, so x / z = 1 is 16 pixels wide.
    pub fn new() -> Self {
        let camera = Camera {
            width: 128,
            height: 64,
            pixel_pitch: [1.0 / 1024.0; 2],
            focal_length: 1.0 / 64.0,
            principal_point: [32.25, 32.5],
            aperture: 0.5,
            lens: Lens::CLEAR,
            max_range: 20.0,
        };
        let beam = Beam {
            columns: 3,
            rows: 1,
            thickness: 1.0 / 256.0,
            grid_distance: 0.25,
            half_width: 0.28125,
            max_range: 20.0,
            power: 3.0,
            wavelength: 810e-9,
            profile: Profile::Paper,
        };
        Self {
            faces: screen(2.0, [-16.0, 16.0], [-16.0, 16.0]).to_vec(),
            reflectivity: 0.25,
            camera,
            beam,
            pose: Pose::from_position(DVec3::new(3.0, 0.0, 0.0)),
            attenuation: 0.0,
            model: FluxModel::Radiometric,
        }
    }

    /// Adds faces.
    pub fn with(mut self, faces: impl IntoIterator<Item = Corners>) -> Self {
        self.faces.extend(faces);
        self
    }

    pub fn scene(&self) -> Scene {
        let faces = (0..self.faces.len() as u32).map(|face| [3 * face, 3 * face + 1, 3 * face + 2]).collect();
        let kinds = vec![Material { name: "screen".into(), reflectivity: self.reflectivity }];
        let materials = vec![0; self.faces.len()];
        let mesh = Mesh::new(DVec3::ZERO, self.faces.concat(), faces, materials, kinds).unwrap();
        let camera = Mounted { scene_from_sensor: Pose::IDENTITY, sensor: self.camera };
        let beam = Mounted { scene_from_sensor: self.pose, sensor: self.beam };
        let air = Atmosphere { attenuation: self.attenuation };
        Scene::new(Arc::new(mesh), camera, vec![beam], air, self.model).unwrap()
    }

    pub fn render(&self) -> RenderOutput {
        Tracer::new().render(&self.scene(), &Request::EVERYTHING)
    }

    /// The return of pencil i of row 0.
    pub fn pencil_return(&self, i: u32) -> Return {
        return_at(&self.render().returns[0], i, 0)
    }
}

/// A rectangle in the plane z = `z`: two faces whose fronts look towards the origin.
pub fn screen(z: f32, [left, right]: [f32; 2], [top, bottom]: [f32; 2]) -> [Corners; 2] {
    // Down the left side first: with y down this is counter-clockwise.
    let (a, b, c, d) = ([left, top, z], [left, bottom, z], [right, bottom, z], [right, top, z]);
    [[a, b, c], [a, c, d]]
}

/// The same faces with front and back exchanged.
pub fn reversed<const N: usize>(faces: [Corners; N]) -> [Corners; N] {
    faces.map(|[a, b, c]| [a, c, b])
}

/// The pose of a beam at `position` that looks along -z.
pub fn looking_back(position: DVec3) -> Pose {
    Pose { position, rotation: DQuat::from_xyzw(0.0, 1.0, 0.0, 0.0) }
}

/// The return of pencil (i, j). Panics if the pencil has no hit.
pub fn return_at(returns: &Returns, i: u32, j: u32) -> Return {
    fn of<T: Copy>(raster: &Option<Image<T>>, i: u32, j: u32) -> T {
        raster.as_ref().expect("a quantity").at(i, j)
    }
    Return {
        visible: of(&returns.visible, i, j),
        pixel: of(&returns.pixel, i, j).get(),
        depth: of(&returns.depth, i, j).get().expect("a hit"),
        cos_off_axis: of(&returns.cos_off_axis, i, j).get().expect("a hit"),
        cos_view: of(&returns.cos_view, i, j).get().expect("a hit"),
        flux: of(&returns.flux, i, j),
    }
}

/// Whether two numbers differ by at most `relative` times the second.
pub fn close(a: f64, b: f64, relative: f64) -> bool {
    (a - b).abs() <= relative * b.abs()
}
