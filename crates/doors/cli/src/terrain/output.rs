//! The output file of a terrain command.

use std::path::Path;

use serde_json::Value;

use crate::Trouble;

/// Makes the folder of an output file, without what killed runs have left half-written there.
pub(super) fn create_folder(output: &Path) -> Result<(), Trouble> {
    Ok(output.parent().map_or(Ok(()), raypencil::io::begin_files)?)
}

/// Whether a file's name ends in `.glb`.
pub(super) fn is_glb(output: &Path) -> bool {
    output.extension().is_some_and(|end| end.eq_ignore_ascii_case("glb"))
}

/// Refuses an output file that is not a GLB, before any work is done.
pub(super) fn check_output(output: &Path) -> Result<(), Trouble> {
    if is_glb(output) {
        return Ok(());
    }
    Err(Trouble::Usage(format!("-o {}: expected a file that ends in .glb", output.display())))
}

/// Refuses to overwrite the file that is read.
pub(super) fn refuse_same_file(output: &Path, input: &Path) -> Result<(), Trouble> {
    let same = output.canonicalize().is_ok_and(|out| input.canonicalize().is_ok_and(|input| input == out));
    match same {
        true => Err(Trouble::Usage(format!(
            "--output {}: is the mesh itself; expected another file",
            output.display()
        ))),
        false => Ok(()),
    }
}

/// Adds the keys of one report to another.
pub(super) fn extend(report: &mut Value, more: Value) {
    if let (Value::Object(report), Value::Object(more)) = (report, more) {
        report.extend(more);
    }
}
