//! Which tables and figures of the documents are older than the rules that they show: `just stale`. With a page and a
//! command the stamps of that command get the digests of now: `just stamp PAGE COMMAND`, after the table was made again.

use std::fs;
use std::path::Path;

use raypencil_tests::stands_on::{stamps, with_new_digests};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let root = Path::new(".");
    if let [page, made_by] = arguments.as_slice() {
        let (text, found) = with_new_digests(&fs::read_to_string(page)?, made_by, root)?;
        if !found {
            return Err(format!("{page} has no stamp of `{made_by}`").into());
        }
        fs::write(page, text)?;
        println!("{page}: what `{made_by}` makes stands on the rules of now");
        return Ok(());
    }
    if !arguments.is_empty() {
        return Err("expected nothing, or a page and the command of a stamp".into());
    }
    for page in glob(&root.join("docs"))? {
        for stamp in stamps(&fs::read_to_string(&page)?)? {
            let newer = stamp.stale(root)?;
            let state =
                if newer.is_empty() { "up to date".into() } else { format!("stale: {}", newer.join("; ")) };
            println!("{page}: `{}`: {state}", stamp.made_by);
        }
    }
    Ok(())
}

/// The pages below a folder.
fn glob(folder: &Path) -> Result<Vec<String>, std::io::Error> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() {
            found.extend(glob(&path)?);
        } else if path.extension().is_some_and(|extension| extension == "md") {
            found.push(path.display().to_string());
        }
    }
    found.sort();
    Ok(found)
}
