//! A command that writes a folder, with a fault at each of its operations on the disk: one fails, or the process dies there. After
//! that nothing of somebody else's may be touched, the mark must be true, and the next run must leave what it leaves alone.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};

use raypencil::harness::contender;
use raypencil::io::{Operation, watch};

/// What happens to the operation of a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Fault {
    /// Nothing.
    None,
    /// It fails.
    Fails(usize),
    /// The process dies before it.
    Dies(usize),
}

/// A command that writes into a folder.
#[derive(Debug, Clone, Copy)]
pub struct Walked<'a> {
    /// Its name.
    pub name: &'static str,
    /// Its words after that. `OUT`, at the start of a path too, and the names of [`INPUTS`] stand for paths.
    pub words: &'a str,
    /// The file that is written last, and says that all others are there.
    pub mark: Option<&'static str>,
    /// Folder whose files belong to no single run.
    pub shared: Option<&'static str>,
    /// Whether a run goes on where an earlier one ended: then none comes before it here.
    pub is_resumed: bool,
}

/// What stands for inputs in the words of a command, and their paths in the tree.
const INPUTS: [(&str, &str); 6] = [
    ("SCENE", "scene.toml"),
    ("MESH", "mesh.obj"),
    ("RAYS", "rays.csv"),
    ("SETS", "rays.toml"),
    ("PACK", "pack"),
    ("MINE", "mine"),
];

/// A command whose run begins with the removal of an earlier one's mark.
const fn marked(name: &'static str, words: &'static str, mark: &'static str) -> Walked<'static> {
    Walked { name, words, mark: Some(mark), shared: None, is_resumed: false }
}

/// A command that writes files of the same names each time.
const fn plain(name: &'static str, words: &'static str) -> Walked<'static> {
    Walked { name, words, mark: None, shared: None, is_resumed: false }
}

/// The commands.
pub const WALKED: [Walked<'static>; 24] = [
    marked("validate", "SCENE -o OUT", "summary.json"),
    marked("render", "SCENE --with tracer --format exr-each -o OUT", "summary.json"),
    marked("render", "SCENE --with tracer --format npz -o OUT", "summary.json"),
    marked("render", "SCENE --with tracer --format zarr -o OUT", "summary.json"),
    marked("drive", "SCENE --record png,points,maps -o OUT", "summary.json"),
    marked("drive", "SCENE --record all -o OUT", "summary.json"),
    Walked {
        shared: Some("runs"),
        ..plain("sweep", "SCENE --set camera.pitch_down_deg=30,40 --do render -o OUT")
    },
    marked("cast", "MESH RAYS --any -o OUT", "summary.json"),
    marked("cast", "MESH SETS -o OUT", "summary.json"),
    marked("cast", "MESH SETS --scans 1 -o OUT", "summary.json"),
    marked("pack", "SCENE --no-bench -o OUT", "manifest.json"),
    marked("pack", "MESH --rays RAYS -o OUT", "raypack.json"),
    marked("pack", "--input -o OUT", "input.json"),
    marked("check", "PACK MINE -o OUT", "check.json"),
    marked("diff", "PACK MINE -o OUT", "summary.json"),
    plain(
        "minimise",
        "facets --with scanline-paper,tracer --class approximation --set camera.width_px=64 --set camera.height_px=48 \
         --set camera.pixel_pitch_um=144 --set beam.columns=128 --set beam.rows=4 -o OUT",
    ),
    Walked { is_resumed: true, ..plain("campaign", "--terrains 1 --max-faces 200 -o OUT") },
    plain("campaign", "replay --seed 1 --terrain 0 -o OUT"),
    plain(
        "terrain",
        "generate --preset smooth --extent 4 --post-spacing 1 --fine-radius 0 -o OUT/ground.glb",
    ),
    plain("terrain", "import MESH -o OUT/ground.glb"),
    plain("terrain", "inspect MESH --repair -o OUT/ground.glb"),
    plain("scene", "show SCENE -o OUT/scene.svg"),
    // What is there is refused.
    Walked { is_resumed: true, ..plain("scene", "init OUT/new.toml") },
    plain("reference", "-o OUT"),
];

/// Somebody else's files, in the folder of the runs and beside it.
const FOREIGN: [&str; 5] = [
    "beside.txt",
    "out/notes.txt",
    "out/beam-9.exr",
    "out/maps/theirs.exr",
    "out/recording/images/000001-theirs.png",
];

/// Files by their paths in a folder.
type Files = BTreeMap<PathBuf, Vec<u8>>;

/// Runs a command once under a fault: its exit code, and its operations in order. `None` for the code of one that died.
pub type Run<'a> = &'a dyn Fn(&Path, &[String], Fault) -> (Option<u8>, Vec<String>);

/// What a walk has met.
#[derive(Debug, Default)]
pub struct Figures {
    /// Operations of one run.
    pub operations: usize,
    /// Runs with a fault.
    pub states: usize,
    /// What did not hold.
    pub broken: Vec<String>,
}

/// A scene of a few rays, which has one beam less with each phase; a mesh, and rays.
fn inputs(tree: &Path, phase: usize) {
    let beam = "[[beam]]\ncolumns = 8\nrows = 2\n".repeat(3 - phase);
    let scene = format!(
        "version = 1\n[vehicle]\nposition_m = [-0.6, 0]\n[camera]\nwidth_px = 8\nheight_px = 6\npixel_pitch_um = 1000\n\
         pitch_down_deg = 40\n[terrain]\nbuiltin = \"pyramids\"\n[drive]\nwaypoints_m = [[0.2, 0]]\nframes_per_s = 2\n\
         scans = false\n{beam}"
    );
    fs::write(tree.join("scene.toml"), scene).unwrap();
    fs::write(tree.join("mesh.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").unwrap();
    let rays: String = (0..3 - phase).map(|ray| format!("0.{},0.1,1,0,0,-1,0,9\n", ray + 1)).collect();
    fs::write(tree.join("rays.csv"), format!("ox,oy,oz,dx,dy,dz,t_min,t_max\n{rays}")).unwrap();
    let sets: String = (0..3 - phase)
        .map(|set| {
            format!(
                "[[rays]]\nname = \"s{set}\"\nposition_m = [0.2, 0.2, 1]\npitch_down_deg = 90\n\
                 spinning = {{ preset = \"vlp-16\", steps = 2 }}\n"
            )
        })
        .collect();
    fs::write(tree.join("rays.toml"), sets).unwrap();
    let note = format!("{{\"format\": 1, \"program\": \"P {phase}\", \"arithmetic\": \"f64\"}}");
    if tree.join("mine").is_dir() {
        fs::write(tree.join("mine/candidate.json"), note).unwrap();
    }
}

/// The files of the inputs that a command itself has made: a pack, and answers to it.
fn made_inputs(walked: &Walked<'_>, tree: &Path, run: Run<'_>) -> Files {
    if !walked.words.contains("MINE") {
        return Files::new();
    }
    begin(tree, &Files::new());
    inputs(tree, 0);
    for (name, words) in
        [("pack", "SCENE --no-bench -o OUT/../pack"), ("render", "SCENE --with scanline -o OUT/../mine")]
    {
        let (code, _) = run(tree, &words_of(name, words, tree), Fault::None);
        assert_eq!(code, Some(0), "{name}");
    }
    let made = |folder: &str| {
        let files = files(&tree.join(folder)).into_iter();
        files.map(move |(name, bytes)| (Path::new(folder).join(name), bytes)).collect::<Vec<_>>()
    };
    [made("pack"), made("mine")].concat().into_iter().collect()
}

/// The tree anew, at the same place: reports name it.
fn begin(tree: &Path, made: &Files) {
    let _ = fs::remove_dir_all(tree);
    let foreign = FOREIGN.map(|name| (Path::new(name), b"mine".as_slice()));
    let made = made.iter().map(|(name, bytes)| (name.as_path(), bytes.as_slice()));
    for (name, bytes) in foreign.into_iter().chain(made) {
        let path = tree.join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, bytes).unwrap();
    }
}

/// The arguments of a command.
fn words_of(name: &str, words: &str, tree: &Path) -> Vec<String> {
    let path = |word: &str| {
        let input = INPUTS.iter().find(|(input, _)| *input == word).map(|(_, name)| *name);
        let output = word.strip_prefix("OUT").map(|rest| format!("out{rest}"));
        let name = input.map(String::from).or(output);
        name.map_or(word.to_string(), |name| tree.join(name).display().to_string())
    };
    let given = words.split(' ').map(path);
    ["raypencil", name].map(String::from).into_iter().chain(given).chain(["--threads=1".into()]).collect()
}

/// The files in the folder of the runs. Of a list only its begin differs, which names the folder.
fn files(out: &Path) -> Files {
    let mut found = Files::new();
    let mut folders = vec![out.to_path_buf()];
    while let Some(folder) = folders.pop() {
        for path in fs::read_dir(folder).into_iter().flatten().map(|entry| entry.unwrap().path()) {
            if path.is_dir() {
                folders.push(path);
                continue;
            }
            let mut bytes = fs::read(&path).unwrap();
            if path.ends_with(".raypencil-made") {
                // Digests of files that say how long something took differ, too.
                bytes.clear();
            }
            found.insert(path.strip_prefix(out).unwrap().to_path_buf(), bytes);
        }
    }
    found
}

/// What a command leaves alone, and which of its files say how long it took.
struct Alone {
    files: Files,
    varying: BTreeSet<PathBuf>,
}

impl Alone {
    /// The first file that is not there as it is when the command runs alone.
    fn first_other(&self, found: &Files) -> Option<&PathBuf> {
        let is_as = |(name, bytes): &(&PathBuf, &Vec<u8>)| {
            found.get(*name).is_some_and(|found| found == *bytes || self.varying.contains(*name))
        };
        self.files.iter().find(|file| !is_as(file)).map(|(name, _)| name)
    }
}

/// Whether a file is a note of a run on its own files, which it could not remove: the list of a pack, or the lock of a folder within
/// the folder of the run. Nobody holds that lock, and the next run takes it.
fn is_note(name: &Path) -> bool {
    name == Path::new(".raypencil-made") || name.ends_with(".raypencil-lock")
}

/// Walks through operations of a command, which are chosen by their number in all. An earlier run has made more files, and a later
/// one makes fewer.
pub fn walk(walked: &Walked<'_>, tree: &Path, run: Run<'_>, choose: &dyn Fn(usize) -> Vec<usize>) -> Figures {
    let go = |phase: usize, fault: Fault| {
        inputs(tree, phase);
        run(tree, &words_of(walked.name, walked.words, tree), fault)
    };
    let made = made_inputs(walked, tree, run);
    // What was there before a run.
    let earlier = || {
        begin(tree, &made);
        if !walked.is_resumed {
            go(0, Fault::None);
        }
    };
    let by_itself = |phase: usize| {
        begin(tree, &made);
        let (code, operations) = go(phase, Fault::None);
        assert!(code.is_some_and(|code| code < 2), "{} by itself: {code:?}", walked.name);
        (files(&tree.join("out")), operations)
    };
    let (last, again) = (by_itself(2).0, by_itself(2).0);
    assert_eq!(last.keys().collect::<Vec<_>>(), again.keys().collect::<Vec<_>>());
    let varies = |name: &&PathBuf| again.get(*name) != last.get(*name);
    let varying: BTreeSet<PathBuf> = last.keys().filter(varies).cloned().collect();
    let (second, first) = (by_itself(1).0, by_itself(0).0);
    let alone = [first, second, last].map(|files| Alone { files, varying: varying.clone() });
    earlier();
    let operations = go(1, Fault::None).1;
    let mut figures = Figures { operations: operations.len(), ..Figures::default() };
    for number in choose(operations.len()) {
        for fault in [Fault::Fails(number), Fault::Dies(number)] {
            earlier();
            let (code, _) = go(1, fault);
            figures.states += 1;
            let operation = operations[number].as_str();
            let mut broken = |what: String| {
                figures
                    .broken
                    .push(format!("{} {}: {fault:?}, {operation}: {what}", walked.name, walked.words));
            };
            // What fails is told of, but where something could not be removed that disturbs nobody.
            let is_removal = operation.starts_with("Remove");
            if matches!(fault, Fault::Fails(_)) && code != Some(2) && !is_removal {
                broken(format!("exit code {code:?}"));
            }
            let found = files(&tree.join("out"));
            if walked.mark.is_some_and(|mark| found.contains_key(Path::new(mark))) {
                let is_locked = found.contains_key(Path::new(".raypencil-lock"));
                let beside = |phase: usize| {
                    let is_own = |name: &&PathBuf| alone[phase].files.contains_key(*name) || is_note(name);
                    found.keys().find(|name| !is_locked && !is_own(name))
                };
                let other = |phase: usize| alone[phase].first_other(&found).or_else(|| beside(phase));
                let others = [0, 1].map(other);
                if let [Some(first), Some(second)] = others {
                    broken(format!("marked, but other are {} and {}", first.display(), second.display()));
                }
            }
            go(2, Fault::None);
            let found = files(&tree.join("out"));
            if let Some(other) = alone[2].first_other(&found) {
                broken(format!("the next run has another {}", other.display()));
            }
            let is_shared = |name: &Path| walked.shared.is_some_and(|shared| name.starts_with(shared));
            for name in found.keys().filter(|name| !alone[2].files.contains_key(*name) && !is_shared(name)) {
                broken(format!("the next run leaves {}", name.display()));
            }
            for name in FOREIGN {
                if fs::read(tree.join(name)).ok().as_deref() != Some(b"mine") {
                    broken(format!("somebody else's {name} is lost"));
                }
            }
        }
    }
    figures
}

/// Runs a command in this process, with a fault. `die` is called where the process dies. If it comes back, death is played: nothing
/// that is done later changes the disk.
pub fn run_until(
    tree: &Path,
    words: &[String],
    fault: Fault,
    die: &'static (dyn Fn() + Sync),
) -> (Option<u8>, Vec<String>) {
    let seen = Arc::new(Mutex::new(Vec::new()));
    let number = AtomicUsize::new(0);
    let (into, root) = (seen.clone(), tree.to_path_buf());
    let watcher = move |operation: Operation, path: &Path| {
        // What is looked at changes nothing.
        if operation == Operation::Look {
            return Ok(());
        }
        let name = path.strip_prefix(&root).unwrap_or(path).display();
        into.lock().unwrap().push(format!("{operation:?} {name}"));
        let number = number.fetch_add(1, Ordering::Relaxed);
        let is_dead = matches!(fault, Fault::Dies(at) if number >= at);
        if is_dead {
            die();
        }
        let is_hit = is_dead || fault == Fault::Fails(number);
        if is_hit { Err(io::Error::from(io::ErrorKind::StorageFull)) } else { Ok(()) }
    };
    let watch = watch(tree, Arc::new(watcher));
    let code = raypencil_cli::run_with(words.iter().map(Into::into), &contender);
    drop(watch);
    let seen = std::mem::take(&mut *seen.lock().unwrap());
    (Some(code), seen)
}
