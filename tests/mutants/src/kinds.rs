//! The kinds of changes: other operators, and values that a function gives at once.

use quote::ToTokens;
use syn::{BinOp, GenericArgument, PathArguments, ReturnType, Type};

/// The operators that take the place of a binary one.
pub(crate) fn other_operators(operator: &BinOp) -> &'static [&'static str] {
    match operator {
        BinOp::Add(_) => &["-", "*"],
        BinOp::Sub(_) => &["+", "/"],
        BinOp::Mul(_) => &["+", "/"],
        BinOp::Div(_) => &["%", "*"],
        BinOp::Rem(_) => &["/", "+"],
        BinOp::And(_) => &["||"],
        BinOp::Or(_) => &["&&"],
        BinOp::BitXor(_) => &["|", "&"],
        BinOp::BitAnd(_) => &["|", "^"],
        BinOp::BitOr(_) => &["&", "^"],
        BinOp::Shl(_) => &[">>"],
        BinOp::Shr(_) => &["<<"],
        BinOp::Eq(_) => &["!="],
        BinOp::Ne(_) => &["=="],
        BinOp::Lt(_) => &["<=", "==", ">"],
        BinOp::Le(_) => &["<", ">"],
        BinOp::Gt(_) => &[">=", "==", "<"],
        BinOp::Ge(_) => &[">", "<"],
        BinOp::AddAssign(_) => &["-=", "*="],
        BinOp::SubAssign(_) => &["+=", "/="],
        BinOp::MulAssign(_) => &["+=", "/="],
        BinOp::DivAssign(_) => &["%=", "*="],
        BinOp::RemAssign(_) => &["/=", "+="],
        BinOp::BitXorAssign(_) => &["|=", "&="],
        BinOp::BitAndAssign(_) => &["|=", "^="],
        BinOp::BitOrAssign(_) => &["&=", "^="],
        BinOp::ShlAssign(_) => &[">>="],
        BinOp::ShrAssign(_) => &["<<="],
        _ => &[],
    }
}

/// The values that a function of this type can give at once. Those that the type does not have after all are found by the
/// compiler.
pub(crate) fn values(output: &ReturnType) -> Vec<String> {
    match output {
        ReturnType::Default => vec!["()".into()],
        ReturnType::Type(_, kind) => values_of(kind),
    }
}

fn values_of(kind: &Type) -> Vec<String> {
    let list = |texts: &[&str]| texts.iter().map(|text| text.to_string()).collect();
    match kind {
        Type::Paren(inner) => values_of(&inner.elem),
        Type::Tuple(tuple) => {
            // The first value of each place, then the second of each, and so on.
            let places: Vec<Vec<String>> = tuple.elems.iter().map(values_of).collect();
            if places.iter().any(Vec::is_empty) {
                return vec![];
            }
            let most = places.iter().map(Vec::len).max().unwrap_or(1);
            let row =
                |k: usize| places.iter().map(|of| format!("{}, ", of[k % of.len()])).collect::<String>();
            (0..most).map(|k| format!("({})", row(k))).collect()
        }
        Type::Array(array) => {
            let len = array.len.to_token_stream();
            values_of(&array.elem).into_iter().map(|value| format!("[{value}; {len}]")).collect()
        }
        Type::Reference(reference) => match (&*reference.elem, reference.mutability) {
            (Type::Slice(_), _) => list(&["Default::default()"]),
            (Type::Path(path), None) if path.path.is_ident("str") => list(&["\"\"", "\"xyzzy\""]),
            _ => vec![],
        },
        Type::Path(path) => {
            let Some(last) = path.path.segments.last() else { return vec![] };
            let first = match &last.arguments {
                PathArguments::AngleBracketed(all) => all.args.iter().find_map(|argument| match argument {
                    GenericArgument::Type(kind) => Some(kind),
                    _ => None,
                }),
                _ => None,
            };
            let inside = || first.map_or(list(&["Default::default()"]), values_of);
            let within = |name: &str| -> Vec<String> {
                inside().into_iter().map(|value| format!("{name}({value})")).collect()
            };
            match last.ident.to_string().as_str() {
                "bool" => list(&["true", "false"]),
                "u8" | "u16" | "u32" | "u64" | "u128" | "usize" => list(&["0", "1"]),
                "i8" | "i16" | "i32" | "i64" | "i128" | "isize" => list(&["0", "1", "-1"]),
                "f32" | "f64" => list(&["0.0", "1.0", "-1.0"]),
                "String" => list(&["String::new()", "\"xyzzy\".into()"]),
                "Option" => [vec!["None".to_string()], within("Some")].concat(),
                "Result" => within("Ok"),
                "Vec" => {
                    let one = inside().into_iter().map(|value| format!("vec![{value}]"));
                    ["vec![]".to_string()].into_iter().chain(one).collect()
                }
                "Box" => within("Box::new"),
                "Arc" => within("std::sync::Arc::new"),
                _ => list(&["Default::default()"]),
            }
        }
        _ => vec![],
    }
}
