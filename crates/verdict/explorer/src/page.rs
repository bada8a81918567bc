//! The model of a page: what the script knows. `docs/formats/report-page.md` has its format.

use raypencil_judge::{ApproximationTallies, Quantity};
use raypencil_scene::{FluxModel, Pixel, Place, Pose, Scene, SensorId, Switches};
use serde_json::{Map, Value, json};

use crate::arrays::{Arrays, Change};
use crate::channels::{ChannelPacker, SideMaps};
use crate::pair::{SensorPair, pair_model};
use crate::script::{SCRIPT, STYLE};
use crate::sensor::{RayMargins, sensor_model};
use crate::switch_words::switch_words;

/// What the rays of one side come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SideKind {
    /// A renderer of this project.
    Renderer,
    /// Files of another program.
    Candidate,
    /// The referee's answers.
    Exact,
}

impl SideKind {
    /// The kind's name in the page model.
    pub(crate) fn key(self) -> &'static str {
        match self {
            Self::Renderer => "renderer",
            Self::Candidate => "candidate",
            Self::Exact => "exact",
        }
    }
}

/// A ray that the page describes in full.
#[derive(Debug, Clone)]
pub struct DescribedRay {
    /// The ray.
    pub place: Place,
    /// Index of the pair of its sensor that it belongs to.
    pub pair: usize,
    /// All that `raypencil probe` prints of it.
    pub text: String,
    /// Faces that the ray exactly meets first.
    pub faces: Vec<u32>,
    /// The exact hit: point in the scene frame and range, metres.
    pub hit: Option<([f64; 3], f64)>,
    /// Whether the camera exactly sees it, and the pixel in which it lands; `None` for the camera's own rays.
    pub visible: Option<(bool, Option<Pixel>)>,
    /// Displacements in cells of a ray with other nearest faces, with another surface, with another visibility.
    pub witnesses: [Option<[f64; 2]>; 3],
}

impl DescribedRay {
    fn model(&self, sensor: usize, width: u32) -> Value {
        let [face, surface, visibility] = self.witnesses;
        let seen = self.visible.as_ref();
        json!({
            "sensor": sensor,
            "cell": self.place.j * width + self.place.i,
            "pair": self.pair,
            "text": self.text,
            "exact": {
                "faces": self.faces,
                "point": self.hit.map(|(point, _)| point),
                "range": self.hit.map(|(_, range)| range),
                "visible": seen.map(|(visible, _)| *visible),
                "pixel": seen.and_then(|(_, pixel)| pixel.map(|pixel| [pixel.i, pixel.j])),
            },
            "witness": { "face": face, "surface": surface, "visibility": visibility },
        })
    }
}

/// A page while it is put together.
///
/// ```
/// # use glam::DVec3;
/// # use raypencil_scene::{Atmosphere, FluxModel, Request, Renderer, Scene, SensorId, rig};
/// # use raypencil_referee::ExactRenderer;
/// use raypencil_explorer::{ExplorerPage, SideKind, SideMaps};
///
/// # let mesh = raypencil_terrain::builtin("pyramids", 0.25).expect("a built-in name").into_mesh()?;
/// # let (camera, beams) = rig::default_rig(64, DVec3::ZERO, 0.0);
/// # let air = Atmosphere { attenuation: 0.0 };
/// # let scene = Scene::new(mesh.into(), camera, beams, air, FluxModel::Radiometric)?;
/// let output = ExactRenderer.render(&scene, &Request::MAPS);
/// let mut page = ExplorerPage::new("validate", &scene, "a scene named <script>", "raypencil probe scene.toml");
/// page.add_side("referee", SideKind::Exact, "correctly rounded");
/// let map = output.map(SensorId::Camera).expect("maps were asked for");
/// let side = SideMaps { map, returns: None, flux: &[] };
/// page.add_sensor(SensorId::Camera, &[Some(side)], &[], None);
///
/// let html = page.html();
/// // Text of the model never ends the element that holds it.
/// assert!(html.contains(r"a scene named \u003cscript>"));
/// # Ok::<(), raypencil_scene::SceneError>(())
/// ```
#[derive(Debug)]
pub struct ExplorerPage<'s> {
    scene: &'s Scene,
    arrays: Arrays,
    model: Map<String, Value>,
    sides: Vec<Value>,
    sensors: Vec<Value>,
    causes: Vec<Switches>,
}

impl<'s> ExplorerPage<'s> {
    /// A page about a scene. `probe` is the command that prints a ray, without the words that name the ray.
    pub fn new(kind: &str, scene: &'s Scene, title: &str, probe: &str) -> Self {
        let mut arrays = Arrays::default();
        let mesh = mesh_model(&mut arrays, scene);
        let mut model = Map::new();
        let model_of = scene.flux_model();
        let quantities: Vec<Value> = Quantity::ALL
            .iter()
            .map(|quantity| json!({ "name": quantity.to_string(), "unit": quantity.unit(model_of) }))
            .collect();
        let unit = match model_of {
            FluxModel::Radiometric => "W",
            FluxModel::Eq1 => "W/m",
        };
        for (key, value) in [
            ("version", json!(1)),
            ("kind", json!(kind)),
            ("title", json!(title)),
            ("probe", json!(probe)),
            ("flux_unit", json!(unit)),
            ("mesh", mesh),
            ("vehicle", Value::Null),
            ("classes", json!(["agree", "tie", "rounding", "approximation", "undecided", "defect"])),
            ("quantities", json!(quantities)),
            ("causes", json!([])),
            ("switches", switch_words()),
            ("rays", Value::Null),
            ("rays_words", json!("")),
        ] {
            model.insert(key.into(), value);
        }
        Self { scene, arrays, model, sides: Vec::new(), sensors: Vec::new(), causes: Vec::new() }
    }

    /// Where the vehicle stands.
    pub fn set_vehicle(&mut self, scene_from_vehicle: &Pose) {
        let axes = [glam::DVec3::X, glam::DVec3::Y, glam::DVec3::Z]
            .map(|axis| scene_from_vehicle.rotate(axis).to_array());
        let vehicle = json!({ "position": scene_from_vehicle.position.to_array(), "axes": axes });
        self.model.insert("vehicle".into(), vehicle);
    }

    /// The arrays of the page, for parts of the model that the caller makes.
    pub fn arrays(&mut self) -> &mut Arrays {
        &mut self.arrays
    }

    /// Adds a part to the model, or replaces it.
    pub fn insert(&mut self, key: &str, part: Value) {
        self.model.insert(key.into(), part);
    }

    /// Adds a side; its index counts from 0.
    pub fn add_side(&mut self, name: &str, kind: SideKind, words: &str) {
        self.sides.push(json!({ "name": name, "kind": kind.key(), "words": words }));
    }

    /// Sets the causes of the rays of class `approximation`. To be called before the sensors are added.
    pub fn set_causes(&mut self, causes: &ApproximationTallies) {
        let sensor_index = |sensor: SensorId| self.scene.sensors().position(|known| known == sensor);
        let models: Vec<Value> = causes
            .iter()
            .map(|(switches, tally)| {
                let names: Vec<&str> = switches
                    .iter()
                    .filter(|(_, fidelity)| *fidelity == raypencil_scene::Fidelity::Paper)
                    .map(|(name, _)| name)
                    .collect();
                let worst = tally.worst_range.as_ref();
                let place = worst.map(|worst| {
                    let Place { sensor, i, j } = worst.place;
                    let width = self.scene.size(sensor).map_or(0, |(width, _)| width);
                    json!({ "sensor": sensor_index(sensor), "cell": j * width + i })
                });
                json!({
                    "switches": names, "rays": tally.rays, "lost": tally.lost, "added": tally.added,
                    "flux_changed": tally.flux_changed,
                    "worst_range": worst.map(|worst| worst.value), "worst_place": place,
                })
            })
            .collect();
        self.model.insert("causes".into(), json!(models));
        self.causes = causes.keys().copied().collect();
    }

    /// Adds a sensor: the maps of each side, in the order of the sides, and what the judge found of each pair.
    pub fn add_sensor(
        &mut self,
        sensor: SensorId,
        sides: &[Option<SideMaps<'_>>],
        pairs: &[SensorPair<'_>],
        margins: Option<&RayMargins>,
    ) {
        let mut model = sensor_model(self.scene, sensor);
        let mut packer = ChannelPacker::default();
        let sides: Vec<Value> = sides
            .iter()
            .map(|side| {
                side.as_ref().map_or(Value::Null, |side| packer.pack(&mut self.arrays, self.scene, side))
            })
            .collect();
        let pairs: Vec<Value> =
            pairs.iter().map(|pair| pair_model(&mut self.arrays, self.scene, pair, &self.causes)).collect();
        model["sides"] = json!(sides);
        model["pairs"] = json!(pairs);
        model["margins"] = margins.map_or(Value::Null, |margins| margins.model(&mut self.arrays));
        self.sensors.push(model);
    }

    /// Sets the rays that are described in full. `words` says which they are of all that are not `agree`.
    pub fn set_rays(&mut self, rays: &[DescribedRay], words: &str) {
        let models: Vec<Value> = rays
            .iter()
            .filter_map(|ray| {
                let sensor = self.scene.sensors().position(|sensor| sensor == ray.place.sensor)?;
                let (width, _) = self.scene.size(ray.place.sensor)?;
                Some(ray.model(sensor, width))
            })
            .collect();
        let text = json!(models).to_string();
        let reference = self.arrays.u8(text.as_bytes());
        self.model.insert("rays".into(), reference);
        self.model.insert("rays_words".into(), json!(words));
    }

    /// Style, model, arrays and script, to be put into the body of a page behind the element that the script fills:
    /// `<section id="explorer" hidden>`.
    pub fn html(mut self) -> String {
        self.model.insert("sides".into(), json!(self.sides));
        self.model.insert("sensors".into(), json!(self.sensors));
        html_of(&Value::Object(self.model), &self.arrays)
    }
}

/// Comments around the elements of the explorer.
const BEGIN: &str = "<!-- explorer: data, style and script -->\n";
const END: &str = "<!-- end of the explorer -->\n";

/// The page without the explorer's elements: what people see without JavaScript, for programs that read its text.
///
/// ```
/// use raypencil_explorer::{RasterPage, SideKind, without_explorer};
///
/// let of_rasters = RasterPage {
///     kind: "diff",
///     title: "a title",
///     sides: &[("a", SideKind::Candidate), ("b", SideKind::Candidate)],
///     classes: ["equal", "", "", "", "", "differs"],
///     groups: &[],
///     described_words: "",
///     solid: None,
/// };
/// let page = format!("<h1>Title</h1>\n{}<footer></footer>", of_rasters.html());
/// assert_eq!(without_explorer(&page), "<h1>Title</h1>\n<footer></footer>");
/// ```
pub fn without_explorer(page: &str) -> String {
    match page.split_once(BEGIN).and_then(|(before, rest)| Some((before, rest.split_once(END)?.1))) {
        Some((before, after)) => format!("{before}{after}"),
        None => page.to_string(),
    }
}

/// A model, its arrays and the script as elements of a page.
pub(crate) fn html_of(model: &Value, arrays: &Arrays) -> String {
    // `<` would be the only way to end the element.
    let model = model.to_string().replace('<', "\\u003c");
    format!(
        "{BEGIN}<style>\n{STYLE}</style>\n<script type=\"application/json\" id=\"page-model\">{model}</script>\n{arrays}\
         <script type=\"module\">\n{script}</script>\n{END}",
        arrays = arrays.scripts(),
        script = *SCRIPT,
    )
}

/// The terrain: f32 offsets from one origin, as the scene has them.
fn mesh_model(arrays: &mut Arrays, scene: &Scene) -> Value {
    let mesh = scene.mesh();
    let vertices = arrays.f32(mesh.vertices().as_flattened(), Change::Delta).reference;
    let faces = arrays.u32(mesh.faces().as_flattened(), Change::Delta).reference;
    let materials = arrays.u16(mesh.face_materials(), Change::Delta).reference;
    let names: Vec<&str> = mesh.materials().iter().map(|material| material.name.as_str()).collect();
    let reflectivity: Vec<f64> = mesh.materials().iter().map(|material| material.reflectivity).collect();
    json!({
        "origin": mesh.origin().to_array(),
        "vertices": vertices, "faces": faces, "materials": materials,
        "material_names": names, "reflectivity": reflectivity,
    })
}
