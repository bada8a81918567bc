//! What an elevation model does not say itself.

use clap::Args;
use raypencil::io::{DemOptions, HeightUnit, LengthUnit, NoData};

use crate::parsers::{height_unit, length_unit, nodata};

#[derive(Debug, Args)]
pub(crate) struct DemArgs {
    /// Sample of an elevation model that stands for unknown heights, beside the one that the file declares; several are
    /// separated by commas. With `none`, all other samples are heights, however far they lie from the rest.
    #[arg(long, value_name = "VALUE", value_parser = nodata, allow_hyphen_values = true)]
    pub(crate) nodata: Option<NoData>,

    /// Unit of the map of an elevation model, over what the file says: m, ft (0.3048 m), ftUS (1200/3937 m), or the EPSG
    /// code of a unit of length.
    #[arg(long, value_name = "UNIT", value_parser = length_unit)]
    pub(crate) unit: Option<LengthUnit>,

    /// Unit of the heights of an elevation model, over what the file says; with a minus before it for depths, such as -ft.
    #[arg(long, value_name = "UNIT", value_parser = height_unit, allow_hyphen_values = true)]
    pub(crate) z_unit: Option<HeightUnit>,
}

impl DemArgs {
    /// The options of a reader.
    pub(crate) fn options(&self, window: Option<[f64; 4]>) -> DemOptions {
        let nodata = self.nodata.clone().unwrap_or_default();
        DemOptions { window, nodata, unit: self.unit, z_unit: self.z_unit }
    }

    /// The first option that is given.
    pub(crate) fn given(&self) -> Option<&'static str> {
        let given = [
            ("--nodata", self.nodata.is_some()),
            ("--unit", self.unit.is_some()),
            ("--z-unit", self.z_unit.is_some()),
        ];
        given.into_iter().find_map(|(option, is_given)| is_given.then_some(option))
    }
}
