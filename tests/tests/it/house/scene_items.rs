//! The public items of `scene`, held to a list: what is shared no comparison finds wrong.

use std::collections::BTreeSet;

use super::source::{is_for_tests, sources, written};

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
    let listed: Vec<&str> = include_str!("scene_public_items.txt").lines().collect();
    assert!(listed.is_sorted(), "tests/tests/it/house/scene_public_items.txt is to be sorted");
    let known: BTreeSet<String> = listed.iter().map(ToString::to_string).collect();
    let new: Vec<&String> = list.difference(&known).collect();
    let gone: Vec<&String> = known.difference(&list).collect();
    assert!(
        new.is_empty() && gone.is_empty(),
        "The public items of crates/base/scene have changed. Everything there is shared by all renderers and by the \
         referee, and what is shared no comparison can find wrong. A definition may stand there; a kernel (an \
         intersection, a projection, a clip, a cull) must not: write it in each renderer. If it is a definition, \
         add these lines to tests/tests/it/house/scene_public_items.txt, sorted: {new:#?}; and remove these: {gone:#?}"
    );
}
