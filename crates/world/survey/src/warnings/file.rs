//! Rules on the polygons and the heights of a terrain's file.

use raypencil_report::{counted, number};

use crate::warning::{Warning, WarningCode};

/// Warns that polygons of a file cross themselves. `first` names the first one.
pub fn polygons_cross(count: u64, first: &str) -> Warning {
    let polygons =
        counted(count, "polygon of the file crosses itself", "polygons of the file cross themselves");
    let sentence = format!(
        "{polygons}, the first is {first}: nobody can say what is inside of it, and a fan around its first corner was taken. Mend \
         it in the program that wrote it."
    );
    Warning::of_scene(WarningCode::PolygonsCross, sentence)
}

/// Warns that polygons of a file are not planar. `worst` names the one that leaves its plane by the largest distance, in units of
/// the file.
pub fn polygons_not_planar(count: u64, worst: &str, distance: f64) -> Warning {
    let polygons = counted(count, "polygon of the file is not planar", "polygons of the file are not planar");
    let sentence = format!(
        "{polygons}; {worst} leaves its plane by {} units of the file: another program may cut it along other lines, and make \
         another surface. Triangles leave no choice.",
        number(distance)
    );
    Warning::of_scene(WarningCode::PolygonsNotPlanar, sentence)
}

/// Warns that heights of an elevation model stand out of it. `found` says which and how far, without a full stop.
pub fn posts_stand_out(found: &str) -> Warning {
    let sentence = format!(
        "{found}: is it ground? Samples that stand for \"not known\" are named by dem_nodata of the scene file or --nodata of terrain \
         import."
    );
    Warning::of_scene(WarningCode::PostsStandOut, sentence)
}

/// Warns that the posts of an elevation model lie very near each other. `found` asks what they are, without its mark.
pub fn posts_too_dense(found: &str) -> Warning {
    let sentence =
        format!("{found}? A program for maps (gdalwarp -t_srs) makes a model in metres of one in degrees.");
    Warning::of_scene(WarningCode::PostsTooDense, sentence)
}
