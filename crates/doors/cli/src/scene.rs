//! `raypencil scene`: shows a scene, and begins a scene file.

use std::path::Path;

use raypencil::Progress as _;
use raypencil::harness::{scene_json, scene_picture, scene_words};
use raypencil::io::{FileError, SCENE_TEMPLATE, begin_files, load, write_atomically};
use raypencil::survey::warnings;

use crate::args::{SceneCommand, SceneInit, SceneShow};
use crate::console::{Spinner, say, warn};
use crate::{Outcome, Trouble};

pub(crate) fn scene(command: &SceneCommand, json: bool) -> Result<Outcome, Trouble> {
    match command {
        SceneCommand::Show(command) => show(command, json),
        SceneCommand::Init(command) => init(command, json),
    }
}

/// How a picture is written, by the ending of its file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Format {
    Svg,
    Png,
}

impl Format {
    fn of(path: &Path) -> Result<Self, Trouble> {
        let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase());
        match ending.as_deref() {
            Some("svg") => Ok(Self::Svg),
            Some("png") => Ok(Self::Png),
            _ => Err(Trouble::Usage(format!(
                "--output {}: expected a file that ends in .svg or .png",
                path.display()
            ))),
        }
    }
}

fn show(command: &SceneShow, json: bool) -> Result<Outcome, Trouble> {
    let spinner = Spinner::new();
    let output = match &command.output {
        Some(path) => Some((path, Format::of(path)?)),
        None => None,
    };
    spinner.stage(&format!("{}: loading", command.scene.scene));
    let loaded = load(&command.scene.scene, &command.scene.overrides())?;
    if let Some((path, format)) = output {
        let drawing = scene_picture(&loaded.scene, &loaded.name, &spinner);
        let bytes = match format {
            Format::Svg => drawing.svg().into_bytes(),
            Format::Png => drawing.png(),
        };
        path.parent().map_or(Ok(()), begin_files)?;
        write_atomically(path, |file| file.write_all(&bytes))?;
    }
    let vehicle = loaded.standing_vehicle();
    let mut warned = loaded.file_warnings();
    warned.extend(warnings(&loaded.scene, vehicle.as_ref(), None));
    drop(spinner);
    warn(&warned);
    let picture = output.map(|(path, _)| path.display().to_string());
    if json {
        let mut document = scene_json(&loaded);
        document["picture"] = picture.into();
        say(&format!("{document:#}\n"));
    } else {
        let picture = picture.map_or(String::new(), |path| format!("picture   {path}\n"));
        say(&(scene_words(&loaded) + &picture));
    }
    Ok(Outcome::Fine)
}

fn init(command: &SceneInit, json: bool) -> Result<Outcome, Trouble> {
    let file = &command.file;
    if file.extension().is_none_or(|ending| !ending.eq_ignore_ascii_case("toml")) {
        return Err(Trouble::Usage(format!("{}: expected a file that ends in .toml", file.display())));
    }
    // What is there may be somebody's work.
    if file.symlink_metadata().is_ok() {
        let error = std::io::Error::other("it is there already; expected the name of a new file");
        return Err(FileError::io(file, "write", error).into());
    }
    file.parent().map_or(Ok(()), begin_files)?;
    write_atomically(file, |out| out.write_all(SCENE_TEMPLATE.as_bytes()))?;
    let name = file.display().to_string();
    say(&match json {
        true => format!("{:#}\n", serde_json::json!({ "scene": name })),
        false => format!("{name}: every key with its meaning; try `raypencil scene show {name}`\n"),
    });
    Ok(Outcome::Fine)
}
