//! The law of independence: who may depend on whom, what `scene` may hold, and that no renderer lets `scene`
//! do its geometry. (ARCHITECTURE.md)

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use cargo_metadata::{DependencyKind, MetadataCommand, Package};
use quote::ToTokens;
use syn::visit::{self, Visit};

/// The root of the workspace.
fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("tests/ is in the workspace").to_path_buf()
}

// ---- Who depends on whom ----------------------------------------------------------------------------

/// Every crate by its folder, its floor, and what it may stand on. A crate of a floor of its own would be said
/// here first.
const HOUSE: &[(&str, u32, &[&str])] = &[
    ("scene", 0, &[]),
    ("scanline", 1, &["scene"]),
    ("tracer", 1, &["scene"]),
    ("referee", 1, &["scene"]),
    ("sensor", 1, &["scene"]),
    ("terrain", 1, &["scene"]),
    ("scene-io", 2, &["scene", "sensor", "terrain"]),
    ("rover", 2, &["scene", "sensor", "terrain"]),
    ("harness", 3, &["scene", "scanline", "tracer", "referee", "sensor", "terrain", "scene-io", "rover"]),
    (
        "cli",
        4,
        &["scene", "scanline", "tracer", "referee", "sensor", "terrain", "scene-io", "rover", "harness"],
    ),
];

/// These may not even share test code: for their tests they have `terrain`, as data.
const EVALUATIONS: &[&str] = &["scanline", "tracer", "referee"];

/// Our crates by folder.
fn house() -> BTreeMap<String, Package> {
    // Without dependencies nothing has to be fetched.
    let metadata = MetadataCommand::new()
        .manifest_path(root().join("Cargo.toml"))
        .no_deps()
        .exec()
        .expect("cargo metadata");
    let folder = |package: &Package| {
        let folder = package.manifest_path.parent().expect("a manifest is in a folder");
        folder.file_name().expect("it has a name").to_string()
    };
    let crates = metadata.packages.into_iter().map(|package| (folder(&package), package));
    crates.filter(|(folder, _)| folder != "tests").collect()
}

/// The crates of this house that a package depends on, by folder: normal ones (and of build scripts), and
/// those of its tests.
fn stands_on(package: &Package, house: &BTreeMap<String, Package>) -> [BTreeSet<String>; 2] {
    let mut found = [BTreeSet::new(), BTreeSet::new()];
    for dependency in &package.dependencies {
        let of_house = house.iter().find(|(_, other)| *other.name == *dependency.name);
        if let Some((folder, _)) = of_house {
            found[usize::from(dependency.kind == DependencyKind::Development)].insert(folder.clone());
        }
    }
    found
}

#[test]
fn every_crate_is_on_a_floor() {
    for folder in house().keys() {
        assert!(HOUSE.iter().any(|(name, ..)| name == folder), "crates/{folder} has no floor in HOUSE");
    }
    let present = house();
    for name in ["scene", "scanline", "tracer", "terrain", "scene-io", "harness"] {
        assert!(present.contains_key(name), "crates/{name} is gone, or cargo metadata does not see it");
    }
}

#[test]
fn crates_stand_on_lower_floors_only() {
    let floor = |name: &str| HOUSE.iter().find(|(of, ..)| *of == name).map(|(_, floor, _)| *floor);
    // The table itself keeps to the rule.
    for (name, level, may) in HOUSE {
        assert!(
            may.iter().all(|below| floor(below) < Some(*level)),
            "{name} stands on its own floor or above"
        );
    }
    let house = house();
    for (name, package) in &house {
        let Some((_, level, may)) = HOUSE.iter().find(|(of, ..)| of == name) else { continue };
        let [normal, of_tests] = stands_on(package, &house);
        for other in &normal {
            assert!(may.contains(&other.as_str()), "{name} must not depend on {other}");
        }
        for other in &of_tests {
            // Tests may reach sideways for data, not up.
            assert!(floor(other) <= Some(*level), "the tests of {name} must not depend on {other}");
        }
    }
}

#[test]
fn the_evaluations_share_definitions_and_no_kernels() {
    let house = house();
    for name in EVALUATIONS {
        let Some(package) = house.get(*name) else { continue };
        let [normal, of_tests] = stands_on(package, &house);
        let of_tests: Vec<&String> = of_tests.difference(&normal).collect();
        assert_eq!(normal, BTreeSet::from(["scene".to_string()]), "{name} depends on scene alone");
        assert!(
            of_tests.iter().all(|other| *other == "terrain"),
            "{name}'s tests use terrain alone: {of_tests:?}"
        );
    }
}

#[test]
fn there_is_one_glam() {
    // obvhs speaks glam too; two versions would be two types.
    let lock = fs::read_to_string(root().join("Cargo.lock")).expect("Cargo.lock");
    let versions: Vec<&str> = lock
        .split("[[package]]")
        .filter(|package| package.contains("\nname = \"glam\"\n"))
        .filter_map(|package| package.split("version = \"").nth(1)?.split('"').next())
        .collect();
    assert!(versions.len() == 1 && versions[0].starts_with("0.34."), "glam in Cargo.lock: {versions:?}");
}

// ---- What `scene` holds -----------------------------------------------------------------------------

/// The Rust files of a crate, with their names.
fn sources(of: &str) -> Vec<(String, syn::File)> {
    fn collect(folder: &Path, files: &mut Vec<PathBuf>) {
        for entry in fs::read_dir(folder).expect("a folder of sources") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                collect(&path, files);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                files.push(path);
            }
        }
    }
    let folder = root().join("crates").join(of).join("src");
    let mut files = Vec::new();
    collect(&folder, &mut files);
    files.sort();
    assert!(!files.is_empty(), "crates/{of} has no sources");
    let read = |path: PathBuf| {
        let name = path.strip_prefix(root()).expect("in the workspace").display().to_string();
        let text = fs::read_to_string(&path).expect("a source file");
        let file = syn::parse_file(&text).unwrap_or_else(|error| panic!("{name}: {error}"));
        (name, file)
    };
    files.into_iter().map(read).collect()
}

/// Whether an item is compiled for tests alone.
fn is_for_tests(attributes: &[syn::Attribute]) -> bool {
    attributes.iter().any(|attribute| {
        attribute.path().is_ident("cfg") && attribute.to_token_stream().to_string().contains("test")
    })
}

/// Tokens as one would write them.
fn written(tokens: &impl ToTokens) -> String {
    let mut text = tokens.to_token_stream().to_string();
    for (spaced, tight) in [(" :: ", "::"), (" < ", "<"), ("< ", "<"), (" <", "<"), (" >", ">"), ("& ", "&")]
    {
        text = text.replace(spaced, tight);
    }
    text
}

/// Adds the public items among `items`.
fn list_public(items: &[syn::Item], list: &mut BTreeSet<String>) {
    use syn::{ImplItem, Item, TraitItem, Visibility};
    let public = |visibility: &Visibility| matches!(visibility, Visibility::Public(_));
    for item in items {
        let mut simple = |kind: &str, visibility: &Visibility, name: &syn::Ident| {
            if public(visibility) {
                list.insert(format!("{kind} {name}"));
            }
        };
        match item {
            Item::Struct(item) => simple("struct", &item.vis, &item.ident),
            Item::Enum(item) => simple("enum", &item.vis, &item.ident),
            Item::Union(item) => simple("union", &item.vis, &item.ident),
            Item::Type(item) => simple("type", &item.vis, &item.ident),
            Item::Const(item) => simple("const", &item.vis, &item.ident),
            Item::Static(item) => simple("static", &item.vis, &item.ident),
            Item::Fn(item) => simple("fn", &item.vis, &item.sig.ident),
            Item::Trait(item) => simple("trait", &item.vis, &item.ident),
            Item::Mod(item) if !is_for_tests(&item.attrs) => simple("mod", &item.vis, &item.ident),
            _ => {}
        }
        match item {
            Item::Macro(item) => {
                let name = item.ident.as_ref().map_or_else(|| written(&item.mac.path), ToString::to_string);
                list.insert(format!("macro {name}"));
            }
            Item::Trait(item) if public(&item.vis) => {
                for part in &item.items {
                    if let TraitItem::Fn(part) = part {
                        let provided = if part.default.is_some() { " (provided)" } else { "" };
                        list.insert(format!("trait fn {}::{}{provided}", item.ident, part.sig.ident));
                    }
                }
            }
            Item::Mod(item) if !is_for_tests(&item.attrs) => {
                if let Some((_, items)) = &item.content {
                    list_public(items, list);
                }
            }
            Item::Impl(item) if !is_for_tests(&item.attrs) => {
                let of = written(&item.self_ty);
                if let Some((_, implemented, _)) = &item.trait_ {
                    list.insert(format!("impl {} for {of}", written(implemented)));
                    continue;
                }
                for part in &item.items {
                    match part {
                        ImplItem::Fn(part) if public(&part.vis) => {
                            list.insert(format!("fn {of}::{}", part.sig.ident));
                        }
                        ImplItem::Const(part) if public(&part.vis) => {
                            list.insert(format!("const {of}::{}", part.ident));
                        }
                        _ => {}
                    }
                }
            }
            _ => {}
        }
    }
}

#[test]
fn scene_holds_only_what_is_listed() {
    let mut list = BTreeSet::new();
    for (_, file) in sources("scene") {
        list_public(&file.items, &mut list);
    }
    let listed: Vec<&str> = include_str!("../scene_public_items.txt").lines().collect();
    assert!(listed.is_sorted(), "tests/scene_public_items.txt is to be sorted");
    let known: BTreeSet<String> = listed.iter().map(ToString::to_string).collect();
    let new: Vec<&String> = list.difference(&known).collect();
    let gone: Vec<&String> = known.difference(&list).collect();
    assert!(
        new.is_empty() && gone.is_empty(),
        "The public items of crates/scene have changed. Everything there is shared by all renderers and by the \
         referee, and what is shared no comparison can find wrong. A definition may stand there; a kernel (an \
         intersection, a projection, a clip, a cull) must not: write it in each renderer. If it is a definition, \
         add these lines to tests/scene_public_items.txt, sorted: {new:#?}; and remove these: {gone:#?}"
    );
}

// ---- What renderers do themselves -------------------------------------------------------------------

/// Uses of `scene`'s own geometry, by method or operator, in code that is not a test's.
#[derive(Default)]
struct Borrowed {
    found: Vec<String>,
}

/// Methods of `scene` that transform or form a ray. `ray` is one only of a scene: a renderer may have its own.
const GEOMETRY: &[&str] = &["rotate", "inverse", "direction", "origin"];
const GEOMETRY_OF: &[(&str, &str)] = &[
    ("Pose", "rotate"),
    ("Pose", "inverse"),
    ("Scene", "ray"),
    ("Camera", "direction"),
    ("Beam", "direction"),
    ("Beam", "origin"),
];

/// The last name in `scene`, `self.scene`, `output.scene()`, `(*scene)`.
fn last_name(expression: &syn::Expr) -> Option<String> {
    match expression {
        syn::Expr::Path(path) => path.path.segments.last().map(|segment| segment.ident.to_string()),
        syn::Expr::Field(field) => match &field.member {
            syn::Member::Named(name) => Some(name.to_string()),
            syn::Member::Unnamed(_) => None,
        },
        syn::Expr::MethodCall(call) => Some(call.method.to_string()),
        syn::Expr::Paren(inner) => last_name(&inner.expr),
        syn::Expr::Reference(inner) => last_name(&inner.expr),
        syn::Expr::Unary(inner) => last_name(&inner.expr),
        _ => None,
    }
}

impl<'ast> Visit<'ast> for Borrowed {
    fn visit_item(&mut self, item: &'ast syn::Item) {
        let attributes = match item {
            syn::Item::Mod(item) => &item.attrs,
            syn::Item::Fn(item) => &item.attrs,
            syn::Item::Impl(item) => &item.attrs,
            _ => return visit::visit_item(self, item),
        };
        if !is_for_tests(attributes) {
            visit::visit_item(self, item);
        }
    }

    fn visit_expr_method_call(&mut self, call: &'ast syn::ExprMethodCall) {
        let method = call.method.to_string();
        let of_scene = last_name(&call.receiver).is_some_and(|name| name == "scene" || name == "world");
        // `mesh.origin()` is data.
        let of_mesh = method == "origin" && last_name(&call.receiver).is_some_and(|name| name == "mesh");
        if (GEOMETRY.contains(&method.as_str()) && !of_mesh) || (method == "ray" && of_scene) {
            self.found.push(written(call));
        }
        visit::visit_expr_method_call(self, call);
    }

    fn visit_expr_path(&mut self, path: &'ast syn::ExprPath) {
        let names: Vec<String> = path.path.segments.iter().map(|segment| segment.ident.to_string()).collect();
        if let [.., of, what] = names.as_slice()
            && GEOMETRY_OF.contains(&(of.as_str(), what.as_str()))
        {
            self.found.push(written(path));
        }
        visit::visit_expr_path(self, path);
    }

    fn visit_expr_binary(&mut self, product: &'ast syn::ExprBinary) {
        // Poses are named `a_from_b`, or by what they are.
        let is_pose = |side: &syn::Expr| {
            last_name(side)
                .is_some_and(|name| name.contains("_from_") || name == "pose" || name.ends_with("_pose"))
        };
        if matches!(product.op, syn::BinOp::Mul(_)) && (is_pose(&product.left) || is_pose(&product.right)) {
            self.found.push(written(product));
        }
        visit::visit_expr_binary(self, product);
    }
}

fn borrowed(file: &syn::File) -> Vec<String> {
    let mut borrowed = Borrowed::default();
    borrowed.visit_file(file);
    borrowed.found
}

#[test]
fn renderers_form_their_own_transforms_and_rays() {
    for name in EVALUATIONS {
        if !root().join("crates").join(name).exists() {
            continue;
        }
        for (file_name, file) in sources(name) {
            let found = borrowed(&file);
            assert!(
                found.is_empty(),
                "{file_name} lets `scene` do its geometry: {found:#?}. What renderers share no comparison finds wrong."
            );
        }
    }
}

#[test]
fn borrowed_geometry_is_recognised() {
    let code = |body: &str| {
        let text = format!("fn f() {{ {body}; }} #[cfg(test)] mod tests {{ fn g() {{ pose.rotate(v); }} }}");
        borrowed(&syn::parse_file(&text).expect("Rust"))
    };
    for body in [
        "mounted.scene_from_sensor.rotate(v)",
        "camera.scene_from_sensor.inverse()",
        "let p = mounted.scene_from_sensor * v",
        "let p = (*pose) * v",
        "Pose::rotate(&pose, v)",
        "scene.ray(sensor, i, j)",
        "self.scene().ray(sensor, i, j)",
        "camera.sensor.direction(i, j)",
        "beam.origin(j) + x",
        "rows.map(Beam::direction)",
    ] {
        assert_eq!(code(body).len(), 1, "{body}");
    }
    for body in
        ["rays.ray(i, j)", "ray.origin + ray.direction * t", "mesh.origin()", "self.turn.apply(v)", "a * b"]
    {
        assert_eq!(code(body), Vec::<String>::new(), "{body}");
    }
}
