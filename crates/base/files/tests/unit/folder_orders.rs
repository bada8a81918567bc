//! Two runs in one tree, in the orders of their steps. Each step of the real code waits until it is let go on, so an order is a list
//! of who goes first; the orders are walked through by depth.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Condvar, Mutex};

use tempfile::TempDir;

use crate::watch::{play_process, process};
use crate::{
    FolderError, GrowingFile, Operation, OutputFolder, SharedFolder, begin_output_folder, create_folder,
    watch, write_atomically,
};

/// Where a run writes, and what: files of the folder, in order, with its mark last.
#[derive(Debug, Clone, Copy)]
struct Run {
    folder: &'static str,
    files: &'static [&'static str],
    /// Whether it shares its folder.
    is_shared: bool,
}

fn word(process: usize) -> String {
    format!("of run {process}")
}

impl Run {
    fn work(self, tree: &Path, number: usize) -> Result<(), FolderError> {
        let folder = tree.join(self.folder);
        let text = word(number);
        let (output, _shared) = match self.is_shared {
            true => (None, Some(SharedFolder::begin(&folder)?)),
            false => (Some(OutputFolder::begin(&folder)?), None),
        };
        let mark = begin_output_folder(&folder, "summary.json")?;
        for name in self.files {
            let path = folder.join(name);
            create_folder(path.parent().unwrap())?;
            let mut file = GrowingFile::create(&path)?;
            file.add(&text)?;
            file.finish()?;
        }
        write_atomically(mark, |file| file.write_all(text.as_bytes()))?;
        output.map_or(Ok(()), OutputFolder::finish)
    }
}

/// Who waits, who may go on, and who is done.
#[derive(Debug, Default)]
struct State {
    waits: [bool; 2],
    may_go: Option<usize>,
    done: Vec<(usize, Result<(), String>)>,
}

#[derive(Default)]
struct Turns {
    state: Mutex<State>,
    changed: Condvar,
}

impl Turns {
    /// A step of a run: waits for its turn.
    fn wait(&self, run: usize) {
        let mut state = self.state.lock().unwrap();
        state.waits[run] = true;
        self.changed.notify_all();
        while state.may_go != Some(run) {
            state = self.changed.wait(state).unwrap();
        }
        state.may_go = None;
        state.waits[run] = false;
    }

    fn end(&self, run: usize, result: Result<(), FolderError>) {
        self.state.lock().unwrap().done.push((run, result.map_err(|error| error.to_string())));
        self.changed.notify_all();
    }

    /// Who could go on, once each run waits or is done.
    fn ready(&self) -> Vec<usize> {
        let mut state = self.state.lock().unwrap();
        loop {
            let is_done = |run: usize| state.done.iter().any(|(done, _)| *done == run);
            let waits = |run: usize| state.waits[run] && state.may_go.is_none();
            if (0..2).all(|run| is_done(run) || waits(run)) {
                return (0..2).filter(|run| !is_done(*run)).collect();
            }
            state = self.changed.wait(state).unwrap();
        }
    }

    fn let_go(&self, run: usize) {
        self.state.lock().unwrap().may_go = Some(run);
        self.changed.notify_all();
    }
}

/// The choices of an order: who went, and whether the other could have.
type Choices = Vec<(usize, bool)>;

/// Which run ended, and how, in the order of their ends.
type Ends = Vec<(usize, Result<(), String>)>;

/// Both runs, in the order that begins so and then goes on with whoever went last. Returns the choices, and who ended when, how.
fn in_order(tree: &Path, runs: [Run; 2], begin: &[usize]) -> (Choices, Ends) {
    let turns = Arc::new(Turns::default());
    let waiting = turns.clone();
    let watcher = move |_: Operation, _: &Path| {
        // Nobody but the two threads works below this folder.
        waiting.wait(process() as usize - 1);
        Ok(())
    };
    let watch = watch(tree, Arc::new(watcher));
    let choices = std::thread::scope(|scope| {
        for (number, run) in runs.into_iter().enumerate() {
            let turns = &turns;
            scope.spawn(move || {
                play_process(number as u64 + 1);
                turns.wait(number);
                turns.end(number, run.work(tree, number));
            });
        }
        let mut choices = Choices::new();
        loop {
            let ready = turns.ready();
            let Some(first) = ready.first() else { break choices };
            let last = choices.last().map_or(0, |(run, _)| *run);
            let asked = begin.get(choices.len()).copied().unwrap_or(last);
            let run = if ready.contains(&asked) { asked } else { *first };
            choices.push((run, ready.len() > 1));
            turns.let_go(run);
        }
    });
    drop(watch);
    let done = std::mem::take(&mut turns.state.lock().unwrap().done);
    (choices, done)
}

fn files(tree: &Path) -> BTreeMap<PathBuf, String> {
    let mut found = BTreeMap::new();
    let mut folders = vec![tree.to_path_buf()];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else {
                let text = String::from_utf8_lossy(&std::fs::read(&path).unwrap()).into_owned();
                found.insert(path.strip_prefix(tree).unwrap().to_path_buf(), text);
            }
        }
    }
    found
}

/// Asserts what two runs may leave.
fn assert_holds(tree: &Path, runs: [Run; 2], done: &[(usize, Result<(), String>)], what: &str) {
    let found = files(tree);
    for name in ["out/mine", "out/sub/mine"] {
        assert_eq!(found.get(Path::new(name)).map(String::as_str), Some("mine"), "{what}: {name}");
    }
    for name in found.keys() {
        let name = name.to_string_lossy();
        assert!(!name.ends_with(".part") && !name.ends_with("-lock"), "{what}: {name} is left");
    }
    // Of two that begin at once in one tree, each may be refused because of the other: safe, and said.
    for (_, result) in done {
        let is_expected = |why: &String| why.contains("another run is writing into");
        assert!(result.as_ref().err().is_none_or(is_expected), "{what}: {result:?}");
    }
    // A mark is true: whoever wrote it has all of its files there.
    for folder in ["out", "out/sub"] {
        let Some(mark) = found.get(&Path::new(folder).join("summary.json")) else { continue };
        for (number, run) in runs.iter().enumerate().filter(|(number, _)| *mark == word(*number)) {
            // Another run's file may be in the place of one, if it came last.
            let other = done.last().filter(|(last, result)| *last != number && result.is_ok());
            for name in run.files {
                let path = Path::new(run.folder).join(name);
                let is_replaced = other.is_some_and(|(other, _)| {
                    let places =
                        runs[*other].files.iter().map(|name| Path::new(runs[*other].folder).join(name));
                    places.into_iter().any(|place| place == path)
                });
                let text = found.get(&path).map(String::as_str);
                assert!(
                    text == Some(&word(number)) || is_replaced && text.is_some(),
                    "{what}: {}: {text:?}",
                    path.display()
                );
            }
        }
    }
    // The run that ended last and well has its mark.
    if let Some((last, _)) = done.iter().rev().find(|(_, result)| result.is_ok()) {
        let run = runs[*last];
        let mark = found.get(&Path::new(run.folder).join("summary.json"));
        assert_eq!(mark, Some(&word(*last)), "{what}: {done:?}");
    }
}

/// A tree in which an earlier run made the same files, and somebody else some.
fn tree() -> TempDir {
    let tree = TempDir::new().unwrap();
    let earlier = Run { folder: "out", files: &["a", "sub/a", "sub/b"], is_shared: false };
    earlier.work(tree.path(), 7).unwrap();
    for name in ["out/mine", "out/sub/mine"] {
        std::fs::write(tree.path().join(name), "mine").unwrap();
    }
    tree
}

/// Walks through all orders of at most so many changes from a run that could go on to the other. Returns how many there are.
fn walk(runs: [Run; 2], most_changes: usize) -> usize {
    let mut orders = 0;
    let mut begins: Vec<Vec<usize>> = vec![vec![0], vec![1]];
    while let Some(begin) = begins.pop() {
        let tree = tree();
        let (choices, done) = in_order(tree.path(), runs, &begin);
        orders += 1;
        let order: Vec<usize> = choices.iter().map(|(run, _)| *run).collect();
        assert_holds(tree.path(), runs, &done, &format!("{runs:?} in the order {order:?}"));
        let changes = |order: &[usize], choices: &Choices| {
            (1..order.len()).filter(|&at| order[at] != order[at - 1] && choices[at].1).count()
        };
        for at in begin.len()..choices.len() {
            let mut other = order[..at].to_vec();
            other.push(1 - order[at]);
            if choices[at].1 && changes(&other, &choices) <= most_changes {
                begins.push(other);
            }
        }
    }
    orders
}

const ABOVE: Run = Run { folder: "out", files: &["a", "sub/a"], is_shared: false };
const BELOW: Run = Run { folder: "out/sub", files: &["a", "c"], is_shared: false };
const SHARED: Run = Run { folder: "out/sub", files: &["a", "c"], is_shared: true };
const OTHER_SHARED: Run = Run { files: &["b", "d"], ..SHARED };

#[test]
fn two_runs_in_one_tree_disturb_nobody_in_any_order() {
    // More for the figures of docs/theory/folders.md.
    let most_changes = std::env::var("RAYPENCIL_ORDERS").map_or(1, |text| text.parse().expect("a number"));
    for runs in [[ABOVE, ABOVE], [ABOVE, BELOW], [ABOVE, SHARED], [SHARED, BELOW], [SHARED, OTHER_SHARED]] {
        let orders = walk(runs, most_changes);
        println!("{:?}: {orders} orders", runs.map(|run| (run.folder, run.is_shared)));
        assert!(orders > 30, "{orders}");
    }
}

#[test]
fn a_run_that_begins_just_before_one_above_sees_it() {
    // Two changes: the run below has looked above and goes on when the other has nearly ended.
    for (before, above) in (2..8).flat_map(|before| (18..28).map(move |above| (before, above))) {
        let tree = tree();
        let order = [vec![1; before], vec![0; above], vec![1; 60]].concat();
        let (_, done) = in_order(tree.path(), [ABOVE, BELOW], &order);
        let what = format!("{before} steps of a run below, {above} of one above");
        assert_holds(tree.path(), [ABOVE, BELOW], &done, &what);
    }
}
