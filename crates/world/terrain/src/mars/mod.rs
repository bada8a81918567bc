//! Mars-like ground: relief at every scale, craters, crevasses and rocks, each by its own published law.
//!
//! ```text
//! fractal                           posts by stochastic interpolation between coarse posts
//! craters                           bowls, rims and ejecta: old craters first, and young ones over them
//! relief                            the posts of a whole ground, closer near its middle
//! crevasses, corridor               the courses of cracks and their openings; the cells that they touch
//! sheet -> cut, sheet_posts         the faces over the posts; those about the crevasses, and their walls
//! rocks, rock_places, rock_bodies   rocks
//! presets                           grounds by name, with a source for every number
//! ```

mod corridor;
mod craters;
mod crevasses;
mod cut;
mod fractal;
mod presets;
mod relief;
mod rock_bodies;
mod rock_places;
mod rocks;
mod sheet;
mod sheet_posts;

use glam::{DVec2, DVec3};
use raypencil_scene::{Material, SceneError};

use crate::{Ground, HeightGrid};
use relief::Relief;

pub use craters::{Crater, Craters, Rim};
pub use crevasses::Crevasses;
pub use fractal::Roughness;
pub use presets::PRESET_NAMES;
pub use rocks::Rocks;

/// How much longer than asked a side may become, by whole post spacings.
const MAX_LONGER: f64 = 1.05;

/// Maximum expected number of faces: the limit of the files, 2^25.
const MAX_FACES: f64 = (1 << 25) as f64;

/// Settings of a generated ground. Start from [`MarsGround::preset`] and change fields. The same fields give the
/// same bytes on every machine.
///
/// The middle of the square, up to 1.5 m from its centre, is free of rocks and crevasses, so that a rover can
/// stand there.
///
/// ```
/// use raypencil_terrain::{Craters, Crevasses, MarsGround, Rocks};
///
/// let preset = MarsGround::preset("viking1", 7).expect("a preset name");
/// // Relief alone: 12 m in steps of 0.2 m are 60 x 60 cells of two faces.
/// let mars = MarsGround {
///     extent: 12.0,
///     post_spacing: 0.2,
///     fine_radius: 0.0,
///     rocks: Rocks { coverage: 0.0, ..preset.rocks },
///     craters: Craters { density: 0.0, ..preset.craters },
///     crevasses: Crevasses { count: 0, ..preset.crevasses },
///     ..preset
/// };
/// assert_eq!(mars.build()?.faces.len(), 2 * 60 * 60);
/// # Ok::<(), raypencil_scene::SceneError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct MarsGround {
    /// Seed: another seed gives another ground with the same settings.
    pub seed: u64,
    /// Side of the square, metres, rounded up to whole cells. Ignored if `coarse` is given.
    pub extent: f64,
    /// Distance between posts, metres; an upper limit if `coarse` is given.
    pub post_spacing: f64,
    /// Posts that the surface passes through before craters and crevasses are added. Without them the relief
    /// starts from four posts at the corners of a square at least as large as the ground.
    pub coarse: Option<HeightGrid>,
    /// Roughness of the relief.
    pub roughness: Roughness,
    /// Rocks; none if the coverage is 0.
    pub rocks: Rocks,
    /// Craters; none if the density is 0.
    pub craters: Craters,
    /// Crevasses; none if the count is 0.
    pub crevasses: Crevasses,
    /// Within this distance of the middle, metres, posts stand at a quarter of `post_spacing`, and within 2.5 times of
    /// it at half: from near, soil shows no triangles. 0 for posts of one spacing.
    pub fine_radius: f64,
    /// Translation of all vertices, metres.
    pub offset: DVec3,
}

/// Maximum expected number of craters.
const MAX_CRATERS: f64 = 1e5;

/// Maximum number of crevasses.
const MAX_CREVASSES: u32 = 1000;

/// Distance of rocks and crevasses from the middle, metres.
const FREE_RADIUS_M: f64 = 1.5;

impl MarsGround {
    /// Builds the ground.
    ///
    /// # Errors
    /// As [`MarsGround::validate`].
    pub fn build(&self) -> Result<Ground, SceneError> {
        self.validate()?;
        let relief = self.relief();
        let crevasses = self.crevasses.draw(&self.field(), self.seed);
        let mut ground = Ground { materials: materials(), ..Ground::default() };
        sheet::add(
            &mut ground,
            &relief,
            &crevasses,
            &sheet_posts::SheetMaterials { soil: SOIL_MATERIAL, wall: WALL_MATERIAL },
            self.seed,
        );
        self.add_rocks(&mut ground, &relief, &crevasses);
        if self.offset != DVec3::ZERO {
            for vertex in &mut ground.vertices {
                *vertex += self.offset;
            }
        }
        Ok(ground)
    }

    /// Diameters of the rocks, metres, in descending order.
    pub fn rock_diameters(&self) -> Vec<f64> {
        let extent = self.extents();
        self.rocks.diameters(extent.x * extent.y, self.seed)
    }

    /// Craters, the largest first. Those outside the ground whose ejecta reach it are included.
    pub fn crater_list(&self) -> Vec<Crater> {
        let corner = self.coarse.as_ref().map_or(-0.5 * self.extents(), |coarse| coarse.corner);
        let extent = self.extents();
        self.craters.draw(corner + 0.5 * extent, extent.max_element(), self.seed)
    }

    /// Extent along x and y from border to border, metres.
    pub fn extents(&self) -> DVec2 {
        match &self.coarse {
            Some(coarse) => coarse.extent(),
            None => DVec2::splat(f64::from(self.cells()) * self.post_spacing),
        }
    }

    /// Heights of the soil, with the craters.
    fn relief(&self) -> Relief {
        let (posts, octaves) = self.posts();
        Relief::new(posts, self.fine_radius, &self.roughness, octaves, &self.crater_list(), self.seed)
    }

    /// Posts before craters are made, and the number of halvings from which they come.
    fn posts(&self) -> (HeightGrid, u32) {
        if let Some(coarse) = &self.coarse {
            let octaves = octaves(coarse.spacing.max_element(), self.post_spacing);
            return (fractal::refine(coarse.clone(), octaves, &self.roughness, self.seed), octaves);
        }
        let cells = self.cells();
        let octaves = cells.next_power_of_two().ilog2();
        let whole = 1_u32 << octaves;
        let start = fractal::corner_posts(f64::from(whole) * self.post_spacing, &self.roughness, self.seed);
        let posts = fractal::refine(start, octaves, &self.roughness, self.seed);
        // The ground is the part of it about the origin.
        let margin = (whole - cells) / 2;
        let heights = (0..=cells)
            .flat_map(|row| {
                let first = ((margin + row) * posts.columns + margin) as usize;
                posts.heights[first..=first + cells as usize].iter().copied()
            })
            .collect();
        let corner = DVec2::splat(-0.5 * f64::from(cells) * self.post_spacing);
        let spacing = DVec2::splat(self.post_spacing);
        (HeightGrid { columns: cells + 1, rows: cells + 1, corner, spacing, heights }, octaves)
    }

    /// Ground that crevasses are drawn on.
    fn field(&self) -> crevasses::Field {
        let spacing = match &self.coarse {
            None => DVec2::splat(self.post_spacing),
            Some(coarse) => {
                let halvings = octaves(coarse.spacing.max_element(), self.post_spacing);
                coarse.spacing * libm::exp2(-f64::from(halvings))
            }
        };
        crevasses::Field { extent: self.extents(), spacing, free_radius: self.free_radius() }
    }

    /// Distance of rocks and crevasses from the middle, metres.
    fn free_radius(&self) -> f64 {
        FREE_RADIUS_M.min(0.125 * self.extents().min_element())
    }

    /// Cells per side of a ground without coarse posts.
    fn cells(&self) -> u32 {
        // Below 2^13 after validation.
        ((self.extent / self.post_spacing).ceil() as u32).max(2)
    }

    fn add_rocks(&self, ground: &mut Ground, relief: &Relief, crevasses: &[crevasses::Crevasse]) {
        let extent = relief.posts.extent();
        let middle = relief.middle;
        let free_radius = self.free_radius();
        let is_free = |place: DVec2, diameter: f64| {
            let local = place - middle;
            let beyond = local.abs().cmpgt(0.5 * extent).any();
            !beyond
                && local.length() > free_radius + 0.5 * diameter
                && !crevasses.iter().any(|crevasse| crevasse.overlaps_disc(local, 0.6 * diameter))
        };
        let sites = rock_places::place_rocks(
            &self.rock_diameters(),
            middle,
            extent.max_element(),
            self.seed,
            is_free,
        );
        let mut bodies = rock_bodies::RockBodies::new(self.seed);
        for site in sites {
            let at = |x: f64, y: f64| relief.height(site.place + 0.5 * site.diameter * DVec2::new(x, y));
            let gradient =
                DVec2::new(at(1.0, 0.0) - at(-1.0, 0.0), at(0.0, 1.0) - at(0.0, -1.0)) / site.diameter;
            let place = site.place.extend(relief.height(site.place));
            bodies.add(ground, place, gradient, site.diameter, ROCK_MATERIAL);
        }
    }

    /// Checks that the ground can be built.
    ///
    /// # Errors
    /// Names the first number out of its range, or the number that makes the ground larger than 2^25 faces.
    pub fn validate(&self) -> Result<(), SceneError> {
        let Self { rocks, craters, crevasses, roughness, .. } = self;
        let ranges = [
            ("extent_m", self.extent, 1.0..=1e5),
            ("post_spacing_m", self.post_spacing, 1e-3..=1e4),
            ("hurst", roughness.hurst, 0.01..=0.99),
            ("roughness_m", roughness.rms_at_1_m, 0.0..=10.0),
            ("rock_coverage", rocks.coverage, 0.0..=0.4),
            ("rock_smallest_m", rocks.smallest, 1e-3..=100.0),
            ("rock_largest_m", rocks.largest, rocks.smallest..=100.0),
            ("crater_density", craters.density, 0.0..=0.5),
            ("crater_smallest_m", craters.smallest, 1e-2..=1e4),
            ("crater_largest_m", craters.largest, craters.smallest..=1e4),
            ("crevasse_width_m", crevasses.width, 1e-3..=100.0),
            ("crevasse_depth_m", crevasses.depth, 1e-3..=1000.0),
            ("crevasse_overhang_m", crevasses.overhang, 0.0..=100.0),
            ("fine_radius_m", self.fine_radius, 0.0..=1e4),
            ("offset_m", self.offset.abs().max_element(), 0.0..=1e7),
        ];
        for (field, value, range) in ranges {
            if !range.contains(&value) {
                let expected = format!("{} to {}", range.start(), range.end());
                return Err(SceneError::new(field, value, expected));
            }
        }
        if rocks.coverage > 0.0 && !rocks.decay().is_finite() {
            return Err(SceneError::new("rock_coverage", rocks.coverage, "0, or 1e-300 to 0.4"));
        }
        if let Some(gain) = roughness.octave_gains.iter().find(|gain| !(0.0..=100.0).contains(*gain)) {
            return Err(SceneError::new("octave_gains", gain, "0 to 100 each"));
        }
        if let Some(coarse) = &self.coarse {
            check_coarse(coarse)?;
        }
        self.check_size()
    }

    /// Refuses a ground with more faces than a file may have.
    fn check_size(&self) -> Result<(), SceneError> {
        let (extent, cells) = match &self.coarse {
            // The real side: whole cells, two at least.
            None => (self.extents(), f64::from(self.cells()) * f64::from(self.cells())),
            Some(coarse) => {
                let finer = libm::exp2(f64::from(octaves(coarse.spacing.max_element(), self.post_spacing)));
                (coarse.extent(), f64::from(coarse.columns - 1) * f64::from(coarse.rows - 1) * finer * finer)
            }
        };
        let asked = self.extent;
        // A whole number of spacings but for rounding, which may add one more.
        let spacings = asked / self.post_spacing;
        let is_whole = (spacings - spacings.round()).abs() < 1e-9 * spacings && spacings > 1.5;
        if self.coarse.is_none() && !is_whole && extent.max_element() > MAX_LONGER * asked {
            let expected = format!(
                "two post spacings of {} m or more, and nearly a whole number of them: {} m",
                self.post_spacing,
                extent.max_element()
            );
            return Err(SceneError::new("extent_m", asked, expected));
        }
        let most = format!("at most {MAX_FACES} faces in all");
        // Asked so that what is no number is refused, too.
        let is_too_many = |faces: f64| !(faces <= MAX_FACES);
        if is_too_many(2.0 * cells) {
            let found = format!("{} m: {} faces", self.post_spacing, 2.0 * cells);
            return Err(SceneError::new("post_spacing_m", found, most));
        }
        let most_fine = self.max_fine_faces(extent, cells);
        if is_too_many(most_fine) {
            let found = format!("{} m: up to {most_fine:.0} faces", self.fine_radius);
            return Err(SceneError::new("fine_radius_m", found, most));
        }
        let rocks = self.rocks.max_expected_faces(extent.x * extent.y);
        if is_too_many(most_fine + rocks) {
            let found = format!("{} m: up to {rocks:.0} faces of rocks", self.rocks.smallest);
            return Err(SceneError::new("rock_smallest_m", found, most));
        }
        let craters = self.craters.expected(extent.max_element());
        if !(craters <= MAX_CRATERS) {
            let found = format!("{} m: {craters:.0} craters", self.craters.smallest);
            return Err(SceneError::new(
                "crater_smallest_m",
                found,
                format!("at most {MAX_CRATERS} craters"),
            ));
        }
        let crevasses = &self.crevasses;
        if crevasses.count > MAX_CREVASSES {
            return Err(SceneError::new("crevasses", crevasses.count, format!("0 to {MAX_CREVASSES}")));
        }
        let found = crevasses.draw(&self.field(), self.seed);
        let walls: f64 = found.iter().map(|crevasse| cut::faces_per_node() * crevasse.last() as f64).sum();
        if is_too_many(most_fine + rocks + walls) {
            let found = format!("{}: {walls:.0} faces of walls", crevasses.count);
            return Err(SceneError::new("crevasses", found, most));
        }
        if found.len() < crevasses.count as usize {
            let expected = format!(
                "at most {}: there is no place for more of {} m on {} x {} m",
                found.len(),
                crevasses.width,
                extent.x,
                extent.y
            );
            return Err(SceneError::new("crevasses", crevasses.count, expected));
        }
        Ok(())
    }

    /// Upper bound on the number of faces of the soil, with its fine part.
    fn max_fine_faces(&self, extent: DVec2, cells: f64) -> f64 {
        let share = |radius: f64| {
            // All cells that a square about the circle touches.
            let side =
                (2.0 * radius / extent + 2.0 * (extent.x * extent.y / cells).sqrt() / extent).min(DVec2::ONE);
            if radius > 0.0 { side.x * side.y } else { 0.0 }
        };
        let [half, quarter] = relief::radii(self.fine_radius).map(share);
        2.0 * cells * (1.0 + 3.0 * half + 12.0 * quarter)
    }
}

fn check_coarse(coarse: &HeightGrid) -> Result<(), SceneError> {
    let (columns, rows) = (coarse.columns as usize, coarse.rows as usize);
    if columns < 2 || rows < 2 || coarse.heights.len() != columns * rows {
        let found = format!("{columns} x {rows} posts, {} heights", coarse.heights.len());
        return Err(SceneError::new("coarse", found, "at least 2 x 2 posts, with a height for each"));
    }
    let finite = |v: DVec2| v.is_finite() && v.abs().max_element() <= 1e12;
    if !(coarse.spacing.min_element() > 0.0 && finite(coarse.spacing) && finite(coarse.corner)) {
        let found = format!("spacing {}, corner {}", coarse.spacing, coarse.corner);
        return Err(SceneError::new("coarse", found, "positive spacings, and coordinates within 1e12 m"));
    }
    if let Some(index) = coarse.heights.iter().position(|height| !(height.abs() <= 1e7)) {
        let found = format!("post ({}, {}) at {} m", index % columns, index / columns, coarse.heights[index]);
        return Err(SceneError::new("coarse", found, "known heights within 1e7 m"));
    }
    Ok(())
}

/// Number of halvings after which the coarse spacing is no larger than the fine one.
fn octaves(coarse: f64, fine: f64) -> u32 {
    let mut octaves = 0;
    let mut spacing = coarse;
    // From at most 1e12 m to at least 1e-3 m: 50 halvings.
    while spacing > fine {
        spacing *= 0.5;
        octaves += 1;
    }
    octaves
}

const SOIL_MATERIAL: u16 = 0;
const ROCK_MATERIAL: u16 = 1;
const WALL_MATERIAL: u16 = 2;

/// CHOICE: soil has the default reflectivity of the scene file. Rocks and fresh walls are darker, because dust is
/// brighter than rock in near-infrared images of the landing sites.
fn materials() -> Vec<Material> {
    [("soil", 0.25), ("rock", 0.16), ("crevasse wall", 0.2)]
        .map(|(name, reflectivity)| Material { name: name.into(), reflectivity })
        .into()
}

#[cfg(test)]
#[path = "../../tests/unit/mars/whole_grounds.rs"]
mod tests;
