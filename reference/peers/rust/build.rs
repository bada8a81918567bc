//! Builds tinybvh's header, which the crate tinybvh-rs has among its files.

use std::path::PathBuf;
use std::process::Command;
use std::{env, str};

fn main() {
    let cargo = env::var_os("CARGO").expect("cargo runs this");
    let told = Command::new(cargo)
        .args(["metadata", "--format-version", "1", "--locked"])
        .output()
        .expect("cargo metadata runs");
    let told = str::from_utf8(&told.stdout).expect("cargo writes UTF-8");
    // The manifests of all packages: the one in tinybvh-rs's folder is looked for.
    let manifest = told
        .split("\"manifest_path\":\"")
        .filter_map(|part| part.split('"').next())
        .map(|path| path.replace("\\\\", "\\"))
        .find(|path| path.contains("tinybvh-rs-"))
        .expect("tinybvh-rs is a dependency");
    let header = PathBuf::from(manifest).with_file_name("ffi").join("tinybvh");
    // As tinybvh-rs builds it.
    cc::Build::new()
        .cpp(true)
        .std("c++20")
        .flag("-march=native")
        .warnings(false)
        .include(header)
        .file("src/tinybvh.cpp")
        .compile("tinybvh");
    println!("cargo:rerun-if-changed=src/tinybvh.cpp");
}
