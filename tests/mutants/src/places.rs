//! The places of a crate that can be changed, and what they are changed to.

use std::collections::{BTreeSet, HashMap};
use std::fs;
use std::ops::Range;
use std::path::{Path, PathBuf};

use proc_macro2::Span;
use quote::ToTokens;
use syn::spanned::Spanned;
use syn::visit::{self, Visit};
use syn::{Attribute, BinOp, Expr, ImplItemFn, ItemFn, Meta, Pat, Signature, TraitItemFn, UnOp};

use crate::kinds::{other_operators, values};

/// How a place is written with its changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Form {
    /// A `match` of the number of now around an expression.
    Expression,
    /// A `match` that returns, behind the brace that opens a function.
    Body,
    /// A condition behind the pattern of an arm.
    Arm,
    /// A condition before the guard of an arm.
    Guarded,
}

/// One change of a place.
#[derive(Clone, Debug)]
pub(crate) struct Change {
    /// What is changed to what, in words.
    pub(crate) words: String,
    /// The code that takes the place of the old one.
    pub(crate) code: String,
}

/// A place of a file that can be changed.
#[derive(Clone, Debug)]
pub(crate) struct Place {
    /// Its bytes in the file.
    pub(crate) bytes: Range<usize>,
    /// Its line and column, counted from 1.
    pub(crate) at: [usize; 2],
    /// The function that it is in.
    pub(crate) function: String,
    /// The code of now, on one line.
    pub(crate) text: String,
    pub(crate) form: Form,
    pub(crate) changes: Vec<Change>,
}

/// A source file of the crate.
#[derive(Clone, Debug)]
pub(crate) struct Source {
    /// Its path from the root of the repository.
    pub(crate) name: String,
    pub(crate) text: String,
    /// An outer place stands before those inside it.
    pub(crate) places: Vec<Place>,
}

/// The configuration that the compiler has: names, and `name="value"`.
pub(crate) type Configuration = BTreeSet<String>;

/// The source files of a crate, from its `src/lib.rs` on; those of its tests are left out.
pub(crate) fn sources(root: &Path, folder: &Path, cfg: &Configuration) -> Result<Vec<Source>, String> {
    let src = root.join(folder).join("src");
    let mut found = Vec::new();
    read_module(root, &src.join("lib.rs"), &src, cfg, &mut found)?;
    Ok(found)
}

fn read_module(
    root: &Path,
    path: &Path,
    children: &Path,
    cfg: &Configuration,
    found: &mut Vec<Source>,
) -> Result<(), String> {
    let name = path.strip_prefix(root).unwrap_or(path).display().to_string();
    let text = fs::read_to_string(path).map_err(|error| format!("{name}: {error}"))?;
    let file = syn::parse_file(&text).map_err(|error| format!("{name}: {error}"))?;
    let mut finder =
        Finder { cfg, text: &text, within: vec![], modules: vec![], folders: vec![], places: vec![] };
    finder.visit_file(&file);
    let (modules, places) = (finder.modules, finder.places);
    found.push(Source { name: name.clone(), text, places });
    for Module { folders, name: module, path: stated } in modules {
        let children = folders.iter().fold(children.to_path_buf(), |folder, inner| folder.join(inner));
        let (path, its_children) = match stated {
            Some(stated) => {
                let path = path.parent().unwrap_or(root).join(stated);
                let folder = path.parent().unwrap_or(root).to_path_buf();
                (path, folder)
            }
            None => {
                let folder = children.join(&module);
                let [flat, inside] = [children.join(format!("{module}.rs")), folder.join("mod.rs")];
                (if flat.exists() { flat } else { inside }, folder)
            }
        };
        if !path.exists() {
            return Err(format!("{name}: the file of the module `{module}` is not there"));
        }
        read_module(root, &path, &its_children, cfg, found)?;
    }
    Ok(())
}

/// A module in a file of its own.
struct Module {
    /// The modules around its declaration in the same file.
    folders: Vec<String>,
    name: String,
    /// What `#[path]` states.
    path: Option<PathBuf>,
}

struct Finder<'a> {
    cfg: &'a Configuration,
    /// The text of the file.
    text: &'a str,
    /// The types and functions around.
    within: Vec<String>,
    modules: Vec<Module>,
    folders: Vec<String>,
    places: Vec<Place>,
}

/// Tokens on one line.
fn line(tokens: &impl ToTokens) -> String {
    tokens.to_token_stream().to_string()
}

/// At most so many letters of a text.
fn shortened(text: &str) -> String {
    const MAX_LETTERS: usize = 60;
    match text.chars().count() > MAX_LETTERS {
        true => text.chars().take(MAX_LETTERS).chain("...".chars()).collect(),
        false => text.to_string(),
    }
}

/// What `#[cfg]` says under a configuration; what depends on `test` is left out either way.
fn holds(meta: &Meta, cfg: &Configuration) -> bool {
    match meta {
        Meta::Path(path) => cfg.contains(&line(path)),
        Meta::NameValue(pair) => cfg.contains(&format!("{}={}", line(&pair.path), line(&pair.value))),
        Meta::List(list) => {
            let parts = list
                .parse_args_with(syn::punctuated::Punctuated::<Meta, syn::Token![,]>::parse_terminated)
                .unwrap_or_default();
            let mut hold = parts.iter().map(|part| holds(part, cfg));
            match line(&list.path).as_str() {
                "all" => hold.all(|holds| holds),
                "any" => hold.any(|holds| holds),
                "not" => !hold.next().unwrap_or(false),
                _ => false,
            }
        }
    }
}

impl Finder<'_> {
    fn is_left_out(&self, attributes: &[Attribute]) -> bool {
        attributes.iter().any(|attribute| match &attribute.meta {
            Meta::Path(path) => path.is_ident("test"),
            Meta::List(list) if list.path.is_ident("cfg") => {
                let words = list.tokens.to_string();
                let depends = words.split(|letter: char| !letter.is_alphanumeric() && letter != '_');
                depends.clone().any(|word| word == "test")
                    || syn::parse2::<Meta>(list.tokens.clone()).is_ok_and(|meta| !holds(&meta, self.cfg))
            }
            _ => false,
        })
    }

    /// Adds a place; `shown` is what its line and its text tell of, where that is not the place itself.
    fn push(&mut self, place: Span, shown: [Span; 2], form: Form, changes: Vec<Change>) {
        let (start, text) = (shown[0].start(), shown[1].byte_range());
        let text = self.text[text].split_whitespace().collect::<Vec<_>>().join(" ");
        self.places.push(Place {
            bytes: place.byte_range(),
            at: [start.line, start.column + 1],
            function: self.within.join("::"),
            text,
            form,
            changes,
        });
    }

    /// A function with its body; `is_default` where it is that of `Default`, which nothing else can stand for.
    fn function(&mut self, signature: &Signature, block: &syn::Block, walk: impl FnOnce(&mut Self)) {
        if signature.constness.is_some() || signature.unsafety.is_some() {
            return;
        }
        self.within.push(signature.ident.to_string());
        let is_default = self.within.last().is_some_and(|name| name == "default");
        let body = line(block);
        let inner = body.trim_start_matches('{').trim_end_matches('}').trim();
        let changes = values(&signature.output)
            .into_iter()
            .filter(|value| inner != value && !inner.is_empty())
            .filter(|value| !(is_default && value == "Default::default()"))
            .map(|value| Change { words: format!("the body is {value}"), code: value })
            .collect::<Vec<_>>();
        if !changes.is_empty() {
            let brace = block.brace_token.span.open();
            let start = signature.fn_token.span.start();
            self.places.push(Place {
                bytes: brace.byte_range().end..brace.byte_range().end,
                at: [start.line, start.column + 1],
                function: self.within.join("::"),
                // The body changes with every edit; the name says which it is.
                text: "{}".into(),
                form: Form::Body,
                changes,
            });
        }
        walk(self);
        self.within.pop();
    }

    /// The changes of an expression itself, without those of its parts.
    fn changes(&mut self, expression: &Expr) {
        match expression {
            Expr::Binary(binary) if binary.attrs.is_empty() => {
                if matches!(binary.op, BinOp::And(_)) && has_let(expression) {
                    return;
                }
                let [left, right] = [line(&binary.left), line(&binary.right)];
                let operator = line(&binary.op);
                let changes = other_operators(&binary.op).iter().map(|other| Change {
                    words: format!("{operator} made {other}"),
                    code: format!("({left}) {other} ({right})"),
                });
                let changes: Vec<_> = changes.collect();
                if !changes.is_empty() {
                    let whole = expression.span();
                    self.push(whole, [binary.op.span(), whole], Form::Expression, changes);
                }
            }
            Expr::Unary(unary) if unary.attrs.is_empty() && !matches!(unary.op, UnOp::Deref(_)) => {
                let words = format!("{} left out", line(&unary.op));
                let changes = vec![Change { words, code: format!("({})", line(&unary.expr)) }];
                let whole = expression.span();
                self.push(whole, [whole; 2], Form::Expression, changes);
            }
            _ => {}
        }
    }
}

/// Whether a condition has a `let` at its top.
fn has_let(expression: &Expr) -> bool {
    match expression {
        Expr::Let(_) => true,
        Expr::Binary(binary) => has_let(&binary.left) || has_let(&binary.right),
        _ => false,
    }
}

impl<'ast> Visit<'ast> for Finder<'_> {
    fn visit_item_fn(&mut self, item: &'ast ItemFn) {
        if !self.is_left_out(&item.attrs) {
            self.function(&item.sig, &item.block, |finder| visit::visit_item_fn(finder, item));
        }
    }

    fn visit_impl_item_fn(&mut self, item: &'ast ImplItemFn) {
        if !self.is_left_out(&item.attrs) {
            self.function(&item.sig, &item.block, |finder| visit::visit_impl_item_fn(finder, item));
        }
    }

    fn visit_trait_item_fn(&mut self, item: &'ast TraitItemFn) {
        let Some(block) = item.default.as_ref().filter(|_| !self.is_left_out(&item.attrs)) else { return };
        self.function(&item.sig, block, |finder| visit::visit_trait_item_fn(finder, item));
    }

    fn visit_item_trait(&mut self, item: &'ast syn::ItemTrait) {
        if !self.is_left_out(&item.attrs) {
            self.within.push(item.ident.to_string());
            visit::visit_item_trait(self, item);
            self.within.pop();
        }
    }

    fn visit_item_impl(&mut self, item: &'ast syn::ItemImpl) {
        let of_trait = item.trait_.as_ref().and_then(|(_, path, _)| path.segments.last());
        let is_debug = of_trait.is_some_and(|segment| segment.ident == "Debug");
        if is_debug || item.unsafety.is_some() || self.is_left_out(&item.attrs) {
            return;
        }
        let name = match &*item.self_ty {
            syn::Type::Path(path) => {
                path.path.segments.last().map_or_else(String::new, |segment| segment.ident.to_string())
            }
            other => line(other),
        };
        self.within.push(match of_trait {
            Some(segment) => format!("<{name} as {}>", segment.ident),
            None => name,
        });
        visit::visit_item_impl(self, item);
        self.within.pop();
    }

    fn visit_item_mod(&mut self, item: &'ast syn::ItemMod) {
        if self.is_left_out(&item.attrs) {
            return;
        }
        let name = item.ident.to_string();
        if item.content.is_none() {
            let stated = item.attrs.iter().find_map(|attribute| match &attribute.meta {
                Meta::NameValue(pair) if pair.path.is_ident("path") => match &pair.value {
                    Expr::Lit(syn::ExprLit { lit: syn::Lit::Str(text), .. }) => Some(text.value().into()),
                    _ => None,
                },
                _ => None,
            });
            self.modules.push(Module { folders: self.folders.clone(), name, path: stated });
            return;
        }
        self.folders.push(name.clone());
        self.within.push(name);
        visit::visit_item_mod(self, item);
        self.within.pop();
        self.folders.pop();
    }

    fn visit_local(&mut self, local: &'ast syn::Local) {
        if !self.is_left_out(&local.attrs) {
            visit::visit_local(self, local);
        }
    }

    fn visit_arm(&mut self, arm: &'ast syn::Arm) {
        if self.is_left_out(&arm.attrs) {
            return;
        }
        if let Some((_, guard)) = &arm.guard
            && !has_let(guard)
        {
            let changes = ["true", "false"]
                .map(|value| Change { words: format!("the guard is {value}"), code: value.into() });
            self.push(guard.span(), [guard.span(); 2], Form::Expression, changes.to_vec());
        }
        visit::visit_arm(self, arm);
    }

    fn visit_expr_match(&mut self, expression: &'ast syn::ExprMatch) {
        // An arm may go where one behind it takes all that is left.
        let is_wild = |arm: &syn::Arm| matches!(arm.pat, Pat::Wild(_)) && arm.guard.is_none();
        let wild = expression.arms.iter().position(is_wild).unwrap_or(0);
        for arm in &expression.arms[..wild] {
            if self.is_left_out(&arm.attrs) {
                continue;
            }
            let change = Change { words: "the arm left out".into(), code: String::new() };
            let pattern = arm.pat.span();
            match &arm.guard {
                None => self.push(pattern, [pattern; 2], Form::Arm, vec![change]),
                Some((_, guard)) if !has_let(guard) => {
                    self.push(guard.span(), [pattern; 2], Form::Guarded, vec![change]);
                }
                Some(_) => {}
            }
        }
        visit::visit_expr_match(self, expression);
    }

    fn visit_expr(&mut self, expression: &'ast Expr) {
        let attributes: &[Attribute] = match expression {
            Expr::Block(block) => &block.attrs,
            Expr::If(condition) => &condition.attrs,
            Expr::Call(call) => &call.attrs,
            Expr::MethodCall(call) => &call.attrs,
            _ => &[],
        };
        if !self.is_left_out(attributes) {
            self.changes(expression);
            visit::visit_expr(self, expression);
        }
    }

    // What the compiler evaluates, patterns, types and macros stay as they are.
    fn visit_item_const(&mut self, _: &'ast syn::ItemConst) {}
    fn visit_item_static(&mut self, _: &'ast syn::ItemStatic) {}
    fn visit_impl_item_const(&mut self, _: &'ast syn::ImplItemConst) {}
    fn visit_trait_item_const(&mut self, _: &'ast syn::TraitItemConst) {}
    fn visit_item_enum(&mut self, _: &'ast syn::ItemEnum) {}
    fn visit_item_struct(&mut self, _: &'ast syn::ItemStruct) {}
    fn visit_item_macro(&mut self, _: &'ast syn::ItemMacro) {}
    fn visit_macro(&mut self, _: &'ast syn::Macro) {}
    fn visit_attribute(&mut self, _: &'ast Attribute) {}
    fn visit_type(&mut self, _: &'ast syn::Type) {}
    fn visit_pat(&mut self, _: &'ast Pat) {}
    fn visit_signature(&mut self, _: &'ast Signature) {}
    fn visit_generics(&mut self, _: &'ast syn::Generics) {}
    fn visit_angle_bracketed_generic_arguments(&mut self, _: &'ast syn::AngleBracketedGenericArguments) {}
    fn visit_expr_const(&mut self, _: &'ast syn::ExprConst) {}
    fn visit_expr_unsafe(&mut self, _: &'ast syn::ExprUnsafe) {}
    fn visit_expr_repeat(&mut self, repeat: &'ast syn::ExprRepeat) {
        self.visit_expr(&repeat.expr);
    }
}

/// One mutant: a place, and one of its changes.
#[derive(Clone, Debug)]
pub struct Mutant {
    /// The file, its place of now, the function, and what is changed, in words.
    pub words: String,
    /// The same without the line: it stays where lines above it come and go.
    pub key: String,
    pub(crate) source: usize,
    pub(crate) place: usize,
    pub(crate) change: usize,
}

/// All mutants of a crate, in the order of its sources.
pub(crate) fn mutants(sources: &[Source]) -> Vec<Mutant> {
    let mut all = Vec::new();
    let mut seen: HashMap<String, usize> = HashMap::new();
    for (source, of) in sources.iter().enumerate() {
        for (place, found) in of.places.iter().enumerate() {
            for (change, made) in found.changes.iter().enumerate() {
                let key = format!("{}: {}: `{}`: {}", of.name, found.function, found.text, made.words);
                let count = seen.entry(key.clone()).or_insert(0);
                *count += 1;
                let key = if *count == 1 { key } else { format!("{key}: {count}") };
                let [line, column] = found.at;
                let text = match found.form {
                    Form::Body => String::new(),
                    _ => format!(" `{}`:", shortened(&found.text)),
                };
                let words = format!("{}:{line}:{column}: {}:{text} {}", of.name, found.function, made.words);
                all.push(Mutant { words, key, source, place, change });
            }
        }
    }
    all
}
