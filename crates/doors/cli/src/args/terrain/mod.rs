//! The commands below `terrain`.

mod dem;
mod generate;
mod import;
mod inspect;

use clap::Subcommand;

pub(crate) use generate::TerrainGenerate;
pub(crate) use import::TerrainImport;
pub(crate) use inspect::TerrainInspect;

#[derive(Debug, Subcommand)]
pub(crate) enum TerrainCommand {
    /// Generate a Mars-like terrain with relief, rocks, craters and crevasses.
    Generate(TerrainGenerate),
    /// Convert an elevation model (GeoTIFF) or a mesh (STL, OBJ, PLY, glTF) to a GLB terrain.
    Import(TerrainImport),
    /// Report the faults of a mesh, and repair those with only one possible repair. Exit code 1: the mesh has faults.
    Inspect(TerrainInspect),
}
