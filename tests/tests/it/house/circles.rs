//! No circle of files inside a crate: if a file names an item of another one, that one never names, directly or by a
//! longer way, an item of the first.
//!
//! A file names an item by a path: in a `use`, in code or within a macro. `mod`, re-exports and code for tests do not
//! count. A path through a re-export leads to the file that defines the item.

use std::collections::{BTreeMap, BTreeSet};

use proc_macro2::{TokenStream, TokenTree};
use quote::ToTokens;
use syn::{Item, UseTree, Visibility};

use super::source::{crates, is_for_tests, root, sources};

/// A module's path below the crate, `compare::ray` as `["compare", "ray"]`; also the path of an item.
type Path = Vec<String>;

/// One file of a crate, as far as its names go.
#[derive(Default)]
struct File {
    /// Items that it defines.
    defines: BTreeSet<String>,
    /// Names that it re-exports, and the path that each stands for, as it is written there.
    re_exports: BTreeMap<String, Path>,
    /// Names that it imports for itself, likewise.
    imports: BTreeMap<String, Path>,
    /// Paths of its code outside tests.
    paths: Vec<Path>,
}

/// The leaves of a use tree: the name in scope and its path.
fn leaves(tree: &UseTree, before: &[String], found: &mut Vec<(String, Path)>) {
    match tree {
        UseTree::Path(path) => {
            let before: Path = before.iter().cloned().chain([path.ident.to_string()]).collect();
            leaves(&path.tree, &before, found);
        }
        UseTree::Group(group) => group.items.iter().for_each(|tree| leaves(tree, before, found)),
        UseTree::Name(name) if name.ident == "self" => {
            found.push((before.last().cloned().unwrap_or_default(), before.to_vec()));
        }
        UseTree::Name(name) => {
            let name = name.ident.to_string();
            found.push((name.clone(), before.iter().cloned().chain([name]).collect()));
        }
        UseTree::Rename(rename) => {
            let path = before.iter().cloned().chain([rename.ident.to_string()]);
            // `use a::self as b` stands for `a`.
            let path = path.filter(|name| name != "self").collect();
            found.push((rename.rename.to_string(), path));
        }
        // What a glob brings in cannot be told from here; none of ours is imported so.
        UseTree::Glob(_) => found.push(("*".into(), before.to_vec())),
    }
}

/// Adds the paths of at least two names, `a::b`, in some tokens.
fn paths_in(tokens: TokenStream, found: &mut Vec<Path>) {
    let mut current: Path = Vec::new();
    // Whether the last token was an identifier, and how many colons followed; after a dot a name is a method's.
    let (mut colons, mut after_dot) = (0, false);
    let mut finish = |current: &mut Path| {
        if current.len() > 1 {
            found.push(std::mem::take(current));
        }
        current.clear();
    };
    let mut groups = Vec::new();
    for token in tokens {
        match token {
            TokenTree::Ident(name) => {
                if colons != 2 {
                    finish(&mut current);
                }
                if !after_dot && (colons == 2 || current.is_empty()) {
                    current.push(name.to_string());
                }
                (colons, after_dot) = (0, false);
            }
            TokenTree::Punct(mark) if mark.as_char() == ':' && !current.is_empty() => colons += 1,
            other => {
                finish(&mut current);
                colons = 0;
                after_dot = matches!(&other, TokenTree::Punct(mark) if mark.as_char() == '.');
                if let TokenTree::Group(group) = other {
                    groups.push(group.stream());
                }
            }
        }
    }
    finish(&mut current);
    groups.into_iter().for_each(|group| paths_in(group, found));
}

fn attributes(item: &Item) -> &[syn::Attribute] {
    match item {
        Item::Const(item) => &item.attrs,
        Item::Enum(item) => &item.attrs,
        Item::Fn(item) => &item.attrs,
        Item::Impl(item) => &item.attrs,
        Item::Macro(item) => &item.attrs,
        Item::Mod(item) => &item.attrs,
        Item::Static(item) => &item.attrs,
        Item::Struct(item) => &item.attrs,
        Item::Trait(item) => &item.attrs,
        Item::Type(item) => &item.attrs,
        Item::Union(item) => &item.attrs,
        Item::Use(item) => &item.attrs,
        _ => &[],
    }
}

/// The names of one file.
fn read(file: &syn::File) -> File {
    let mut read = File::default();
    for item in file.items.iter().filter(|item| !is_for_tests(attributes(item))) {
        let name = match item {
            Item::Const(item) => Some(&item.ident),
            Item::Enum(item) => Some(&item.ident),
            Item::Fn(item) => Some(&item.sig.ident),
            Item::Static(item) => Some(&item.ident),
            Item::Struct(item) => Some(&item.ident),
            Item::Trait(item) => Some(&item.ident),
            Item::Type(item) => Some(&item.ident),
            Item::Union(item) => Some(&item.ident),
            _ => None,
        };
        read.defines.extend(name.map(ToString::to_string));
        match item {
            Item::Use(item) => {
                let mut found = Vec::new();
                leaves(&item.tree, &[], &mut found);
                let into = match item.vis {
                    Visibility::Inherited => &mut read.imports,
                    _ => &mut read.re_exports,
                };
                into.extend(found);
            }
            Item::Mod(item) if item.content.is_none() => {}
            item => paths_in(item.to_token_stream(), &mut read.paths),
        }
    }
    read
}

/// The files of a crate by the path of their module.
struct Crate(BTreeMap<Path, File>);

impl Crate {
    /// `files`: each with its path below `src`, `compare/ray.rs`.
    fn new(files: impl IntoIterator<Item = (String, syn::File)>) -> Self {
        let module = |name: String| -> Path {
            let mut path: Path = name.trim_end_matches(".rs").split('/').map(ToString::to_string).collect();
            path.pop_if(|last| ["mod", "lib", "main"].contains(&last.as_str()));
            path
        };
        Self(files.into_iter().map(|(name, file)| (module(name), read(&file))).collect())
    }

    /// A path as it is written in a module, from the crate's root; `None` if it leads out of the crate.
    fn absolute(&self, module: &[String], path: &[String]) -> Option<Path> {
        let mut base = match path.first()?.as_str() {
            "crate" => return Some(path[1..].to_vec()),
            "self" | "super" => module.to_vec(),
            first => {
                let child: Path = module.iter().cloned().chain([first.to_string()]).collect();
                return self.0.contains_key(&child).then(|| module.iter().chain(path).cloned().collect());
            }
        };
        let mut rest = path;
        while let Some((first, later)) = rest.split_first() {
            match first.as_str() {
                "self" => {}
                "super" => drop(base.pop()?),
                _ => break,
            }
            rest = later;
        }
        base.extend_from_slice(rest);
        Some(base)
    }

    /// The module that defines the item a path leads to. What follows the item (a method, a variant) is of no matter.
    fn definer(&self, path: &[String], depth: u32) -> Option<Path> {
        // The longest prefix that is a module; the next name is the item.
        let length = (0..=path.len()).rev().find(|&length| self.0.contains_key(&path[..length]))?;
        let (module, item) = (&path[..length], path.get(length)?);
        let file = &self.0[module];
        if file.defines.contains(item) {
            return Some(module.to_vec());
        }
        let through = file.re_exports.get(item)?;
        let absolute = self.absolute(module, through)?;
        (depth < 8).then(|| self.definer(&absolute, depth + 1))?
    }

    /// The files whose items each file names.
    fn arrows(&self) -> BTreeMap<&Path, BTreeSet<Path>> {
        let mut arrows: BTreeMap<&Path, BTreeSet<Path>> = BTreeMap::new();
        for (module, file) in &self.0 {
            let imported = file.imports.values().filter_map(|path| self.absolute(module, path));
            let written = file.paths.iter().filter_map(|path| match file.imports.get(&path[0]) {
                // `cells::compare` after `use crate::cells`.
                Some(import) => {
                    let import = self.absolute(module, import)?;
                    Some(import.into_iter().chain(path[1..].iter().cloned()).collect())
                }
                None => self.absolute(module, path),
            });
            let named = imported.chain(written).filter_map(|path| self.definer(&path, 0));
            arrows.entry(module).or_default().extend(named.filter(|other| other != module));
        }
        arrows
    }

    /// The circles: of each, the files in it.
    fn circles(&self) -> Vec<Vec<String>> {
        let arrows = self.arrows();
        let reachable = |from: &Path| {
            let mut seen: BTreeSet<Path> = BTreeSet::new();
            let mut next: Vec<Path> = arrows[from].iter().cloned().collect();
            while let Some(file) = next.pop() {
                if seen.insert(file.clone()) {
                    next.extend(arrows[&file].iter().cloned());
                }
            }
            seen
        };
        let reach: BTreeMap<&Path, BTreeSet<Path>> =
            self.0.keys().map(|file| (file, reachable(file))).collect();
        let mut circles: BTreeSet<Vec<String>> = BTreeSet::new();
        for (file, reached) in reach.iter().filter(|(file, reached)| reached.contains(**file)) {
            let members = reached.iter().filter(|other| reach[other].contains(*file));
            circles.insert(members.map(|path| format!("/{}", path.join("/"))).collect());
        }
        circles.into_iter().collect()
    }
}

/// The files of a crate, by their paths below its `src`.
fn files_of(name: &str) -> Vec<(String, syn::File)> {
    let below = format!("{}/src/", crates()[name]);
    let named = sources(name).into_iter().map(|(path, file)| {
        let path = path.strip_prefix(&below).expect("a file of that crate").to_string();
        (path, file)
    });
    named.collect()
}

#[test]
fn no_crate_has_a_circle_of_files() {
    let mut found = Vec::new();
    let mut arrows = 0;
    for name in crates().keys() {
        let house = Crate::new(files_of(name));
        arrows += house.arrows().values().map(BTreeSet::len).sum::<usize>();
        found.extend(house.circles().into_iter().map(|circle| format!("{name}: {}", circle.join(", "))));
    }
    assert!(
        found.is_empty(),
        "These files name one another's items in a circle. Move what both need into a file of its own, below both: \
         {found:#?}"
    );
    // A test that sees no arrow sees no circle.
    assert!(arrows > 500, "only {arrows} arrows between files were found");
}

#[test]
fn no_folder_of_the_referee_uses_one_above_it() {
    let lib =
        std::fs::read_to_string(root().join(&crates()["referee"]).join("src/lib.rs")).expect("its page");
    let list = lib.split("//! The folders, from").nth(1).expect("a list of folders");
    let list =
        list.split("//! ```text\n").nth(1).and_then(|rest| rest.split("//! ```").next()).expect("a list");
    let floors: Vec<&str> =
        list.lines().filter_map(|line| line.trim_start_matches("//!").split_whitespace().next()).collect();
    let house = Crate::new(files_of("referee"));
    let folders: BTreeSet<&str> =
        house.0.keys().filter_map(|path| path.first()).map(String::as_str).collect();
    assert_eq!(folders, floors.iter().copied().collect(), "the folders in the list of its first page");
    let floor =
        |path: &Path| floors.iter().position(|floor| path.first().is_some_and(|first| first == floor));
    let mut seen = 0;
    for (from, others) in house.arrows() {
        for to in others.iter().filter(|to| !from.is_empty() && to.first() != from.first()) {
            seen += 1;
            assert!(
                floor(to) < floor(from),
                "{} uses {}, which stands above it",
                from.join("/"),
                to.join("/")
            );
        }
    }
    assert!(seen > 100, "only {seen} arrows between folders");
}

#[test]
fn circles_are_recognised() {
    let house = |files: &[(&str, &str)]| {
        let parsed =
            files.iter().map(|(name, text)| (name.to_string(), syn::parse_file(text).expect("Rust")));
        Crate::new(parsed).circles()
    };
    let lib = ("lib.rs", "mod a; mod b; pub use a::A; pub use b::B;");
    let both = [["/a", "/b"].map(ToString::to_string).to_vec()];
    // By imports; by a path in code; within a macro; through a re-export; by an imported module.
    for (a, b) in [
        ("use crate::b::B; pub struct A(B);", "use crate::a::A; pub struct B(A);"),
        ("pub struct A(crate::b::B);", "use super::a::A; pub struct B(A);"),
        (
            "pub struct A; fn f() { println!(\"{}\", crate::b::g()); }",
            "use crate::a::A; pub fn g() -> A { A }",
        ),
        ("use crate::B; pub struct A(B);", "pub struct B(Box<crate::A>);"),
        ("use crate::b; pub struct A; fn f() { b::g(); }", "use crate::a::A; pub fn g() -> A { A }"),
    ] {
        assert_eq!(house(&[lib, ("a.rs", a), ("b.rs", b)]), both, "{a} | {b}");
    }
    // A longer way, and a parent that a child needs.
    let long = [
        ("lib.rs", "mod a; mod b; mod c;"),
        ("a.rs", "use crate::b::B; pub struct A(B);"),
        ("b.rs", "use crate::c::C; pub struct B(C);"),
        ("c/mod.rs", "mod d; use crate::a::A; pub struct C(A); fn f() { d::g(); }"),
        ("c/d.rs", "use super::C; pub fn g() -> C { C }"),
    ];
    assert_eq!(house(&long), [["/a", "/b", "/c", "/c/d"].map(ToString::to_string).to_vec()]);
    // No circle: one way only; modules and re-exports; tests.
    for (a, b) in [
        ("use crate::b::B; pub struct A(B);", "pub struct B;"),
        ("pub struct A; pub use crate::b::B;", "use crate::a::A; pub struct B(A);"),
        ("pub struct A; #[cfg(test)] mod tests { use crate::b::B; }", "use crate::a::A; pub struct B(A);"),
        ("pub struct A; fn f(x: X) { x.b::<u8>(); }", "use crate::a::A; pub struct B(A);"),
    ] {
        assert_eq!(house(&[lib, ("a.rs", a), ("b.rs", b)]), Vec::<Vec<String>>::new(), "{a} | {b}");
    }
}

/// The modules that a module of the Python package imports, wherever in it and for whatever reason.
fn imports_of_python(text: &str) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    for line in text.lines().map(str::trim_start) {
        let Some(rest) = line.strip_prefix("from .") else { continue };
        let Some((module, names)) = rest.split_once("import ") else { continue };
        match module.trim() {
            "" => found.extend(names.split(',').map(|name| name.trim().to_string())),
            module => {
                found.insert(module.to_string());
            }
        }
    }
    found
}

/// Modules that import one another, in one step or several.
fn circles_of_python(modules: &BTreeMap<String, BTreeSet<String>>) -> Vec<String> {
    let reaches_itself = |name: &String| {
        let (mut seen, mut due) = (BTreeSet::new(), vec![name]);
        while let Some(module) = due.pop() {
            for other in modules.get(module).into_iter().flatten() {
                if other == name {
                    return true;
                }
                if seen.insert(other) {
                    due.push(other);
                }
            }
        }
        false
    };
    modules.keys().filter(|name| reaches_itself(name)).cloned().collect()
}

#[test]
fn no_modules_of_python_import_one_another_in_a_circle() {
    let folder = root().join(&crates()["python"]).join("python/raypencil");
    let mut modules = BTreeMap::new();
    for entry in std::fs::read_dir(folder).expect("the package") {
        let path = entry.expect("an entry").path();
        // `__init__` imports all of them, and none imports it.
        if path.extension().is_some_and(|ending| ending == "py") && !path.ends_with("__init__.py") {
            let name = path.file_stem().expect("a name").to_string_lossy().into_owned();
            let text = std::fs::read_to_string(&path).expect("a module");
            modules.insert(name, imports_of_python(&text));
        }
    }
    assert!(modules.values().map(BTreeSet::len).sum::<usize>() > 30, "the imports are not seen");
    assert_eq!(circles_of_python(&modules), Vec::<String>::new());
    // Also for types alone, and inside a function.
    let module = |text: &str| imports_of_python(text);
    let circle = [
        ("a".to_string(), module("if TYPE_CHECKING:\n    from .b import B\n")),
        ("b".to_string(), module("def f() -> None:\n    from . import c, os\n")),
        ("c".to_string(), module("from .a import A\n")),
        ("d".to_string(), module("from .a import A\n")),
    ];
    assert_eq!(circles_of_python(&circle.into()), ["a", "b", "c"]);
}
