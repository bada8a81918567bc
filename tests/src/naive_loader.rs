//! A glTF loader by 4 x 4 matrices, without checks, into which mistakes can be put: the wrong loaders that an input pack
//! must fail. It shares nothing with the loader of `mesh-io`.

use raypencil::pack::LoadingClause;
use serde_json::Value;

/// Defines the faults in one list: each with the clause that it breaks and what the loader does.
macro_rules! faults {
    ($($name:ident: $clause:ident, $sentence:literal;)*) => {
        /// A mistake of a loader.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
        pub enum LoadingFault {
            $(#[doc = $sentence] $name,)*
        }

        impl LoadingFault {
            /// All faults.
            pub const ALL: &'static [Self] = &[$(Self::$name,)*];

            /// The clause that it breaks.
            pub fn clause(self) -> LoadingClause {
                match self {
                    $(Self::$name => LoadingClause::$clause,)*
                }
            }
        }
    };
}

faults! {
    AxesOfTheFile: Axes, "The file's axes are taken as those of the scene.";
    AxesLeftHanded: Axes, "y and z change places.";
    TranslationIgnored: Translation, "Nodes are not moved.";
    RotationIgnored: Rotation, "Nodes are not turned.";
    RotationReversed: Rotation, "Nodes are turned the other way.";
    RotationFromW: Rotation, "Quaternions are read as (w, x, y, z).";
    ScaleIgnored: Scale, "Nodes are not scaled.";
    ScaleOfX: Scale, "The first number scales all axes.";
    ScaledAfterTurning: PartsOfATransform, "A node turns first, then scales.";
    MovedBeforeTurning: PartsOfATransform, "A node moves first, then turns.";
    ParentsIgnored: Parents, "Only a node's own transform is used.";
    ParentsFirst: Parents, "The transform of a parent applies before that of its child.";
    MatrixByRows: Matrix, "A matrix is read row by row.";
    MatrixIgnored: Matrix, "A matrix is not read.";
    MirrorsInsideOut: Mirroring, "Corners keep their order in a mirror.";
    MirrorOfTheNodeAlone: MirroredTwice, "Corners change their order if the node's own transform mirrors.";
    MeshesOnce: Instances, "A mesh is drawn for the first node that has it.";
    AllScenes: Scene, "The nodes of all scenes are drawn.";
    FirstScene: Scene, "The first scene is drawn.";
    NodesByNumber: OrderOfNodes, "Nodes are drawn in the order of their numbers.";
    ChildrenFirst: OrderOfNodes, "A node is drawn after its children.";
    StripUnturned: Strip, "All triangles of a strip have the order of its vertices.";
    StripAsList: Strip, "A strip is read as a list of triangles.";
    FanAsStrip: Fan, "A fan is read as a strip.";
    MeshesWithoutIndicesDropped: WithoutIndices, "A primitive without indices is not drawn.";
    CountIgnored: WithoutIndices, "Vertices are read to the end of their view.";
    ByteIndicesDropped: ByteIndices, "A primitive with byte indices is not drawn.";
    IntsAsShorts: IntIndices, "Unsigned ints are read as unsigned shorts.";
    StrideIgnored: Interleaved, "Vertices are read one after the other.";
    OffsetIgnored: Interleaved, "Vertices are read from the beginning of their view.";
    FirstPrimitive: Primitives, "Only the first primitive of a mesh is drawn.";
    LinesAsTriangles: Primitives, "Lines are read as triangles.";
    FacesWithoutAreaDropped: FacesWithoutArea, "Faces without area are left out.";
    TransformsInSinglePrecision: Decimals, "The numbers of a transform are rounded to single precision.";
    MaterialOfTheFirst: Reflectivity, "All faces have the first material.";
    ColourIgnored: Reflectivity, "Colours are not read: such faces have 0.25.";
    StatedIgnored: Reflectivity, "A stated reflectivity is not read.";
}

/// A face as the loader gives it: its corners in the scene's axes, and its reflectivity.
pub type LoadedFace = ([[f64; 3]; 3], f64);

/// Rows of a 4 x 4 matrix.
type Matrix = [[f64; 4]; 4];

fn product(a: &Matrix, b: &Matrix) -> Matrix {
    std::array::from_fn(|row| std::array::from_fn(|column| (0..4).map(|k| a[row][k] * b[k][column]).sum()))
}

fn determinant(m: &Matrix) -> f64 {
    let minor = |r: [usize; 2], c: [usize; 2]| m[r[0]][c[0]] * m[r[1]][c[1]] - m[r[0]][c[1]] * m[r[1]][c[0]];
    m[0][0] * minor([1, 2], [1, 2]) - m[0][1] * minor([1, 2], [0, 2]) + m[0][2] * minor([1, 2], [0, 1])
}

fn diagonal([x, y, z]: [f64; 3]) -> Matrix {
    [[x, 0., 0., 0.], [0., y, 0., 0.], [0., 0., z, 0.], [0., 0., 0., 1.]]
}

fn index(value: &Value) -> usize {
    value.as_u64().expect("an index") as usize
}

/// A list of numbers of the file's JSON, or a default one.
fn numbers<const N: usize>(value: &Value, default: [f64; N]) -> [f64; N] {
    value.as_array().map_or(default, |list| std::array::from_fn(|k| list[k].as_f64().expect("a number")))
}

/// A loader of the GLB of an input pack.
pub struct NaiveLoader<'a> {
    json: Value,
    binary: &'a [u8],
    fault: Option<LoadingFault>,
    drawn: Vec<bool>,
    faces: Vec<LoadedFace>,
}

impl<'a> NaiveLoader<'a> {
    /// The faces of a GLB, as a loader with this fault gives them.
    pub fn faces(glb: &'a [u8], fault: Option<LoadingFault>) -> Vec<LoadedFace> {
        let length = |at: usize| u32::from_le_bytes(glb[at..at + 4].try_into().expect("4 bytes")) as usize;
        let json = length(12);
        let begin = 20 + json + 8;
        let binary = &glb[begin..begin + length(20 + json)];
        let json: Value = serde_json::from_slice(&glb[20..20 + json]).expect("JSON");
        let drawn = vec![false; json["meshes"].as_array().expect("meshes").len()];
        let mut loader = Self { json, binary, fault, drawn, faces: Vec::new() };
        loader.draw();
        loader.faces
    }

    fn has(&self, fault: LoadingFault) -> bool {
        self.fault == Some(fault)
    }

    /// Draws the nodes of the scene.
    fn draw(&mut self) {
        let scenes = self.json["scenes"].as_array().expect("scenes").clone();
        let scenes = match self.fault {
            Some(LoadingFault::AllScenes) => scenes,
            Some(LoadingFault::FirstScene) => vec![scenes[0].clone()],
            _ => vec![scenes[index(&self.json["scene"])].clone()],
        };
        let mut placed = Vec::new();
        for scene in scenes {
            for root in scene["nodes"].as_array().expect("nodes") {
                self.place(index(root), &diagonal([1.0; 3]), &mut placed);
            }
        }
        if self.has(LoadingFault::NodesByNumber) {
            placed.sort_by_key(|(node, _)| *node);
        }
        for (node, transform) in placed {
            self.draw_node(node, &transform);
        }
    }

    /// Lists a node and those below it, each with its transform to the file's axes.
    fn place(&self, node: usize, parent: &Matrix, placed: &mut Vec<(usize, Matrix)>) {
        let own = self.local(node);
        let transform = match self.fault {
            Some(LoadingFault::ParentsIgnored) => own,
            Some(LoadingFault::ParentsFirst) => product(&own, parent),
            _ => product(parent, &own),
        };
        let late = self.has(LoadingFault::ChildrenFirst);
        if !late {
            placed.push((node, transform));
        }
        for child in self.json["nodes"][node]["children"].as_array().into_iter().flatten() {
            self.place(index(child), &transform, placed);
        }
        if late {
            placed.push((node, transform));
        }
    }

    /// A node's own transform.
    fn local(&self, node: usize) -> Matrix {
        let exact = self.exact_local(node);
        match self.has(LoadingFault::TransformsInSinglePrecision) {
            true => exact.map(|row| row.map(|number| f64::from(number as f32))),
            false => exact,
        }
    }

    fn exact_local(&self, node: usize) -> Matrix {
        let node = &self.json["nodes"][node];
        if node["matrix"].is_array() {
            let m = numbers::<16>(&node["matrix"], [0.0; 16]);
            return match self.fault {
                Some(LoadingFault::MatrixIgnored) => diagonal([1.0; 3]),
                Some(LoadingFault::MatrixByRows) => {
                    std::array::from_fn(|r| std::array::from_fn(|c| m[4 * r + c]))
                }
                _ => std::array::from_fn(|r| std::array::from_fn(|c| m[4 * c + r])),
            };
        }
        let [tx, ty, tz] = match self.has(LoadingFault::TranslationIgnored) {
            true => [0.0; 3],
            false => numbers(&node["translation"], [0.0; 3]),
        };
        let moved = [[1., 0., 0., tx], [0., 1., 0., ty], [0., 0., 1., tz], [0., 0., 0., 1.]];
        let given = numbers(&node["rotation"], [0.0, 0.0, 0.0, 1.0]);
        let [x, y, z, w] = match self.fault {
            Some(LoadingFault::RotationIgnored) => [0.0, 0.0, 0.0, 1.0],
            Some(LoadingFault::RotationReversed) => [-given[0], -given[1], -given[2], given[3]],
            Some(LoadingFault::RotationFromW) if node["rotation"].is_array() => {
                [given[1], given[2], given[3], given[0]]
            }
            _ => given,
        };
        let turned = [
            [1. - 2. * (y * y + z * z), 2. * (x * y - w * z), 2. * (x * z + w * y), 0.],
            [2. * (x * y + w * z), 1. - 2. * (x * x + z * z), 2. * (y * z - w * x), 0.],
            [2. * (x * z - w * y), 2. * (y * z + w * x), 1. - 2. * (x * x + y * y), 0.],
            [0., 0., 0., 1.],
        ];
        let given = numbers(&node["scale"], [1.0; 3]);
        let scaled = diagonal(match self.fault {
            Some(LoadingFault::ScaleIgnored) => [1.0; 3],
            Some(LoadingFault::ScaleOfX) => [given[0]; 3],
            _ => given,
        });
        match self.fault {
            Some(LoadingFault::ScaledAfterTurning) => product(&moved, &product(&scaled, &turned)),
            Some(LoadingFault::MovedBeforeTurning) => product(&turned, &product(&moved, &scaled)),
            _ => product(&moved, &product(&turned, &scaled)),
        }
    }

    fn draw_node(&mut self, node: usize, transform: &Matrix) {
        let Some(mesh) = self.json["nodes"][node]["mesh"].as_u64() else { return };
        let mesh = mesh as usize;
        if self.has(LoadingFault::MeshesOnce) && self.drawn[mesh] {
            return;
        }
        self.drawn[mesh] = true;
        let mirrors = match self.fault {
            Some(LoadingFault::MirrorsInsideOut) => false,
            Some(LoadingFault::MirrorOfTheNodeAlone) => determinant(&self.local(node)) < 0.0,
            _ => determinant(transform) < 0.0,
        };
        let mut primitives = self.json["meshes"][mesh]["primitives"].as_array().expect("primitives").clone();
        if self.has(LoadingFault::FirstPrimitive) {
            primitives.truncate(1);
        }
        for primitive in &primitives {
            let vertices = self.vertices(index(&primitive["attributes"]["POSITION"]), transform);
            let reflectivity = self.reflectivity(&primitive["material"]);
            for [a, b, c] in self.triangles(primitive, vertices.len()) {
                let [b, c] = if mirrors { [c, b] } else { [b, c] };
                let corners = [vertices[a], vertices[b], vertices[c]];
                let is_line =
                    corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0];
                if !(is_line && self.has(LoadingFault::FacesWithoutAreaDropped)) {
                    self.faces.push((corners, reflectivity));
                }
            }
        }
    }

    /// The bytes of an element of an accessor.
    fn element(&self, accessor: usize, number: usize, size: usize) -> &[u8] {
        let accessor = &self.json["accessors"][accessor];
        let view = &self.json["bufferViews"][index(&accessor["bufferView"])];
        let stride = match self.has(LoadingFault::StrideIgnored) {
            true => size,
            false => view["byteStride"].as_u64().map_or(size, |stride| stride as usize),
        };
        let offset = match self.has(LoadingFault::OffsetIgnored) {
            true => 0,
            false => accessor["byteOffset"].as_u64().unwrap_or(0) as usize,
        };
        let begin = index(&view["byteOffset"]) + offset + number * stride;
        &self.binary[begin..begin + size]
    }

    /// The vertices of an accessor in the scene's axes.
    fn vertices(&self, accessor: usize, transform: &Matrix) -> Vec<[f64; 3]> {
        let of = &self.json["accessors"][accessor];
        let view = &self.json["bufferViews"][index(&of["bufferView"])];
        let count = match self.has(LoadingFault::CountIgnored) && view["byteStride"].is_null() {
            true => index(&view["byteLength"]) / 12,
            false => index(&of["count"]),
        };
        let vertex = |number: usize| {
            let bytes = self.element(accessor, number, 12);
            let local: [f64; 3] = std::array::from_fn(|k| {
                f64::from(f32::from_le_bytes(bytes[4 * k..4 * k + 4].try_into().expect("4 bytes")))
            });
            let [x, y, z]: [f64; 3] = std::array::from_fn(|row| {
                let m = transform[row];
                m[0] * local[0] + m[1] * local[1] + m[2] * local[2] + m[3]
            });
            match self.fault {
                Some(LoadingFault::AxesOfTheFile) => [x, y, z],
                Some(LoadingFault::AxesLeftHanded) => [x, z, y],
                _ => [x, -z, y],
            }
        };
        (0..count).map(vertex).collect()
    }

    /// The corners of a primitive's triangles.
    fn triangles(&self, primitive: &Value, vertices: usize) -> Vec<[usize; 3]> {
        let corners: Vec<usize> = match primitive["indices"].as_u64() {
            None if self.has(LoadingFault::MeshesWithoutIndicesDropped) => Vec::new(),
            None => (0..vertices).collect(),
            Some(accessor) => {
                let accessor = accessor as usize;
                let of = &self.json["accessors"][accessor];
                let size = match of["componentType"].as_u64() {
                    Some(5121) => 1,
                    Some(5123) => 2,
                    _ if self.has(LoadingFault::IntsAsShorts) => 2,
                    _ => 4,
                };
                if size == 1 && self.has(LoadingFault::ByteIndicesDropped) {
                    return Vec::new();
                }
                let number = |number: usize| {
                    let bytes = self.element(accessor, number, size);
                    bytes.iter().rev().fold(0, |value, byte| 256 * value + usize::from(*byte))
                };
                (0..index(&of["count"])).map(number).collect()
            }
        };
        let at = |i: usize| [corners[i], corners[i + 1], corners[i + 2]];
        let strip = || (0..corners.len() - 2).map(at);
        let turned = |(i, [a, b, c]): (usize, [usize; 3])| if i % 2 == 1 { [a, c, b] } else { [a, b, c] };
        let list = || corners.chunks_exact(3).map(|three| [three[0], three[1], three[2]]).collect();
        match primitive["mode"].as_u64().unwrap_or(4) {
            1 if !self.has(LoadingFault::LinesAsTriangles) => Vec::new(),
            5 if self.has(LoadingFault::StripAsList) => list(),
            5 if self.has(LoadingFault::StripUnturned) => strip().collect(),
            5 => strip().enumerate().map(turned).collect(),
            6 if self.has(LoadingFault::FanAsStrip) => strip().enumerate().map(turned).collect(),
            6 => strip().map(|[_, b, c]| [b, c, corners[0]]).collect(),
            _ => list(),
        }
    }

    fn reflectivity(&self, material: &Value) -> f64 {
        let material = match self.has(LoadingFault::MaterialOfTheFirst) {
            true => &self.json["materials"][0],
            false if material.is_null() => return 0.25,
            false => &self.json["materials"][index(material)],
        };
        let stated = material["extras"]["reflectivity"].as_f64();
        let colour = numbers(&material["pbrMetallicRoughness"]["baseColorFactor"], [0.25; 4]);
        match stated {
            Some(stated) if !self.has(LoadingFault::StatedIgnored) => stated,
            _ if self.has(LoadingFault::ColourIgnored) => 0.25,
            _ => 0.2126 * colour[0] + 0.7152 * colour[1] + 0.0722 * colour[2],
        }
    }
}
