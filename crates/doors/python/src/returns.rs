//! The returns of beams with a width.

use numpy::PyReadonlyArray2;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use raypencil::cast::{BeamReturn, BeamReturns, FirstHit};
use raypencil::pattern::{EchoLight, Keep, Returns};
use raypencil::{FaceId, Reading, Side};

use crate::array::Arrays;
use crate::failure::Failure;
use crate::watch::watched;

/// Which returns are told: a word, or how many of the strongest.
#[derive(FromPyObject)]
pub(crate) enum KeepArgument {
    Count(u64),
    Word(String),
}

impl KeepArgument {
    fn keep(self) -> Result<Keep, Failure> {
        match self {
            Self::Count(most) => Ok(Keep::UpTo(most)),
            Self::Word(word) => match word.as_str() {
                "first" => Ok(Keep::First),
                "strongest" => Ok(Keep::Strongest),
                "last" => Ok(Keep::Last),
                _ => Err(Failure::new(format!(
                    "keep is {word:?}: expected \"first\", \"strongest\", \"last\", or 1 to {}",
                    Returns::MAX
                ))),
            },
        }
    }
}

/// The returns of beams, from the ranges and cosines of their rays, (beams, rays of a beam): arrays by the names of the command's files
/// without `return.`. `beams` is the shape of the beams; `light` the reflectivity of surfaces and the extinction of the air, 1/m.
#[pyfunction]
pub(crate) fn beam_returns<'py>(
    py: Python<'py>,
    ranges: PyReadonlyArray2<'py, f64>,
    cosines: PyReadonlyArray2<'py, f64>,
    weights: Vec<f64>,
    beams: Vec<usize>,
    keep: KeepArgument,
    separation_m: f64,
    light: (f64, f64),
) -> PyResult<Bound<'py, PyDict>> {
    let failed = |failure: Failure| failure.into_exception(py);
    let wanted = Returns { keep: keep.keep().map_err(failed)?, separation_m };
    wanted.validate("returns").map_err(|error| failed(error.into()))?;
    let echo = EchoLight { reflectivity: light.0, extinction_per_m: light.1 };
    echo.validate("light").map_err(|error| failed(error.into()))?;
    let [ranges, cosines] =
        [ranges.as_array(), cosines.as_array()].map(|array| array.iter().copied().collect::<Vec<f64>>());
    if weights.is_empty() || ranges.len() != cosines.len() || ranges.len() % weights.len() != 0 {
        let text = format!(
            "{} ranges, {} cosines, {} weights of a beam",
            ranges.len(),
            cosines.len(),
            weights.len()
        );
        return Err(failed(Failure::new(text)));
    }
    let returns = watched(py, None, move |_| {
        let first: Vec<Reading<FirstHit>> =
            ranges.iter().zip(&cosines).map(|(&range, &cos)| read(range, cos)).collect();
        Ok(BeamReturns::of_first(&first, wanted, (&weights, &echo)))
    })?;
    arrays_of(&returns, &beams).into_dict(py)
}

/// What is read at a range. Returns follow from ranges and cosines alone.
fn read(range: f64, cos_incidence: f64) -> Reading<FirstHit> {
    if range == f64::NEG_INFINITY {
        return Reading::TooNear;
    }
    if !range.is_finite() {
        return Reading::Miss;
    }
    Reading::Hit(FirstHit {
        face: FaceId(0),
        side: Side::Front,
        ties: 1,
        t: range,
        range,
        point: glam::DVec3::ZERO,
        normal: glam::DVec3::ZERO,
        barycentric: [0.0; 3],
        cos_incidence,
    })
}

fn arrays_of(returns: &BeamReturns, beams: &[usize]) -> Arrays {
    let with = |last: usize| -> Vec<usize> { beams.iter().copied().chain([last]).collect() };
    let (of_rays, places) = (with(returns.rays_of_beam()), with(returns.most()));
    let footprints = returns.footprints();
    let mut arrays = Arrays::default();
    arrays.add("of_ray", &of_rays, returns.of_rays().to_vec());
    arrays.add("count", beams, footprints.iter().map(|beam| beam.returns).collect::<Vec<u32>>());
    arrays.add("mixed", beams, footprints.iter().map(|beam| beam.is_mixed()).collect::<Vec<bool>>());
    arrays.add(
        "share_missed",
        beams,
        footprints.iter().map(|beam| returns.missed(beam)).collect::<Vec<f64>>(),
    );
    let wholes = |of: &dyn Fn(&BeamReturn) -> u32, none: u32| -> Vec<u32> {
        returns.told().iter().map(|told| told.as_ref().map_or(none, of)).collect()
    };
    let reals = |of: &dyn Fn(&BeamReturn) -> f64, none: f64| -> Vec<f64> {
        returns.told().iter().map(|told| told.as_ref().map_or(none, of)).collect()
    };
    let rays = returns.rays_of_beam();
    arrays.add("number", &places, wholes(&|told| told.number, 0));
    arrays.add("ray", &places, wholes(&|told| (told.ray % rays) as u32, u32::MAX));
    arrays.add("range", &places, reals(&|told| told.range, f64::INFINITY));
    arrays.add("mean_range", &places, reals(&|told| told.mean_range, f64::INFINITY));
    arrays.add("strength", &places, reals(&|told| told.strength, 0.0));
    arrays.add("share", &places, reals(&|told| returns.share(told.rays), 0.0));
    let other = returns.told().iter().enumerate().map(|(place, told)| {
        let rays = told.as_ref().map_or(0, |told| told.rays);
        returns.share(footprints[place / returns.most()].hits - rays)
    });
    arrays.add("share_other", &places, other.collect::<Vec<f64>>());
    arrays
}
