//! The page of a drive: at its last frame the map is the one of the files, and each sector has its reason.

use raypencil::drive::{DriveJob, DriveRun, drive, write_drive};
use raypencil::io::load_text;
use raypencil::{Scanline, Silent};
use tempfile::TempDir;

use super::browser::open;

/// A short drive with a small camera: 7 frames, obstacle maps in frames 0, 3 and 6.
const SCENE: &str = "version = 1
    vehicle = { position_m = [-0.6, 0] }
    camera = { width_px = 96, height_px = 96, pixel_pitch_um = 96 }
    beam = [{ rows = 2 }, { rows = 2 }]
    terrain = { builtin = 'pyramids' }
    drive = { waypoints_m = [[0.6, 0]], frames_per_s = 3, obstacles_every_frames = 3, scans = false }";

/// The drive in a folder.
pub fn small() -> (TempDir, DriveRun) {
    let loaded = load_text(SCENE, "small").expect("a scene");
    let job = DriveJob::new(&loaded, None, "small.toml".into()).expect("a drive");
    let run = drive(&job, &[&Scanline::default()], &Silent).expect("a drive");
    let folder = tempfile::tempdir().expect("a folder");
    write_drive(&job, &run, folder.path(), &Silent).expect("files");
    (folder, run)
}

#[test]
fn the_time_line_ends_with_the_map_of_the_files() {
    let (folder, run) = small();
    let Some(page) = open(&folder.path().join("report.html"), "#frame/6", (1280, 1000)) else { return };
    page.wait("document.querySelector('[data-drive]')?.dataset.state === 'ready'");
    page.wait("document.querySelector('[data-drive]').dataset.frame === '6'");
    // As many cells are known as in the map at the end.
    let known = run.map.points().filter(|point| run.map.elevation(*point).is_some()).count();
    assert!(known > 20, "{known} cells");
    let counts = page.text("document.querySelector('[data-drive]').textContent");
    let words = known.to_string();
    let grouped = raypencil::report::count(known as u64);
    assert!(counts.contains(&words) || counts.contains(&grouped), "{known} cells are not told");
    // Every sector of the last obstacle map, with its label.
    let (frame, obstacles, _) = run.obstacles.as_ref().expect("obstacle maps");
    assert_eq!(*frame, 6);
    let rows = page.ask("[...document.querySelectorAll('tr[data-drive-sector]')].map(row => [row.dataset.label, row.textContent])");
    let rows = rows.as_array().expect("rows");
    assert_eq!(rows.len(), obstacles.sectors.len());
    for (row, end) in rows.iter().zip(&obstacles.sectors) {
        let label = format!("{:?}", end.label).to_lowercase();
        assert_eq!(row[0], label.as_str());
        assert!(row[1].as_str().expect("text").len() > 20, "{row}");
    }
    // Back to the first frame by the key, which has fewer cells.
    page.ask("document.querySelector('[data-drive-slider]').focus()");
    page.press("Home");
    page.wait("document.querySelector('[data-drive]').dataset.frame === '0'");
    page.assert_quiet();
}
