//! What the time line says of the map is what the map was, frame by frame.

use std::collections::BTreeMap;

use glam::DVec3;
use raypencil_rover::MapSize;

use super::*;

/// The map after some changes: elevation and source of the known cells.
fn replayed(changes: &[CellChange]) -> BTreeMap<GridPoint, (u32, u8)> {
    let mut cells = BTreeMap::new();
    for CellChange { point, elevation, source } in changes {
        if *source == 0 {
            assert!(cells.remove(point).is_some(), "{point:?} was not known");
        } else {
            let earlier = cells.insert(*point, (elevation.to_bits(), *source));
            assert_ne!(earlier, Some((elevation.to_bits(), *source)), "{point:?} has not changed");
        }
    }
    cells
}

fn known(map: &ElevationMap) -> BTreeMap<GridPoint, (u32, u8)> {
    let cells = map.points().map(|point| (point, content(map, point)));
    cells.filter(|(_, (_, source))| *source != 0).map(|(p, (z, source))| (p, (z.to_bits(), source))).collect()
}

#[test]
fn changes_replay_the_map_as_it_moves_and_is_cleared() {
    let mut map = ElevationMap::new(MapSize { spacing: 0.1, points: 11 }, DVec2::new(3.0, -2.0));
    let mut history = DriveHistory::new(10);
    let mut steps = 0;
    let mut check = |history: &mut DriveHistory, map: &ElevationMap| {
        history.add_changes(map);
        assert_eq!(replayed(&history.changes), known(map));
        steps += 1;
    };
    map.insert([DVec3::new(3.0, -2.0, 0.5), DVec3::new(3.3, -1.8, 0.25)]);
    check(&mut history, &map);
    assert!(!history.changes.is_empty());
    // Nothing new: no change.
    let before = history.changes.len();
    check(&mut history, &map);
    assert_eq!(history.changes.len(), before);
    // The map moves by 4 cells and leaves some behind; new ones come in, one of them where a guess was.
    map.recentre(DVec2::new(3.4, -2.3));
    map.insert([DVec3::new(3.4, -1.8, 0.75), DVec3::new(3.8, -2.7, -0.5)]);
    check(&mut history, &map);
    // So far that nothing is left.
    map.recentre(DVec2::new(9.0, 9.0));
    check(&mut history, &map);
    assert_eq!(known(&map), BTreeMap::new());
    map.insert([DVec3::new(9.1, 9.0, 1.0)]);
    check(&mut history, &map);
    map.clear();
    check(&mut history, &map);
    assert_eq!((steps, history.spacing), (6, 0.1));
}
