//! No renderer lets `scene` do its geometry.

use syn::visit::{self, Visit};

use super::floors::EVALUATIONS;
use super::source::{crates, is_for_tests, sources, written};

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
        if !crates().contains_key(*name) {
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
