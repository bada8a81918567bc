//! The tests of this crate by its public items, one program together with its unit tests.

mod clouds;
mod dem;
// The file alone: as a dependency, `raypencil-tests` would build the whole workspace first.
#[path = "../../../../../tests/src/glb.rs"]
mod glb;
mod gltf;
// The file alone: it counts what a reader asks for.
#[path = "../../../../base/files/tests/it/formats/memory.rs"]
mod memory;
mod terrain;
mod triangles;
