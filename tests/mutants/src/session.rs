//! The steps one after the other: a clone, the draw, the build, the tests without a mutant, and those with each.

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

use serde_json::{Value, json};

use crate::Result;
use crate::ask::{Ended, Run, Setting};
use crate::build::{Executable, build, package_name};
use crate::places::{Configuration, Mutant, Source, mutants, sources};
use crate::record::{Outcome, Record, row};

/// Least time that the tests of a mutant get.
const MIN_LIMIT: Duration = Duration::from_secs(10);

/// How many times the time without a mutant they get.
const TIMES: f64 = 4.0;

/// Tests that take no longer than this, in seconds, run together, those of the first length first. Each longer one runs by itself.
const TOGETHER_S: [f64; 3] = [0.02, 0.1, 0.5];

/// How many tests that told the last mutants of the same file are asked first.
const MAX_FAVOURITES: usize = 3;

/// The time for the tests without a mutant.
const BASELINE_LIMIT: Duration = Duration::from_secs(3600);

/// Which mutants are asked about.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Asked {
    /// Those without a result.
    #[default]
    New,
    /// Those that were missed so far.
    Missed,
}

/// What is asked for.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// The crate, by the name of its folder.
    pub name: String,
    /// How many mutants are drawn; without a number all are.
    pub draw: Option<usize>,
    /// Only mutants whose words contain one of these. They are taken without a draw.
    pub only: Vec<String>,
    /// Which of them are asked about.
    pub asked: Asked,
    /// Part K of N, counted from 0: parts can run at the same time.
    pub part: Option<(u32, u32)>,
    /// Parts of names: of tests that are asked, without any all are, and of tests that are left out.
    pub ask: Vec<String>,
    /// See [`ask`](Self::ask).
    pub skip: Vec<String>,
    /// Only so much is done: the build and the tests without a mutant.
    pub only_build: bool,
}

/// Runs a command, and returns its output.
fn output(command: &mut Command) -> Result<String> {
    let output = command.output()?;
    match output.status.success() {
        true => Ok(String::from_utf8(output.stdout)?.trim().to_string()),
        false => Err(format!("{command:?}: {}", String::from_utf8_lossy(&output.stderr)).into()),
    }
}

fn git(folder: &Path, arguments: &[&str]) -> Result<String> {
    output(Command::new("git").current_dir(folder).args(arguments))
}

/// What the compiler says of its target, and that tests have the assertions of a debug build.
fn configuration() -> Result<Configuration> {
    let text = output(Command::new("rustc").args(["--print", "cfg"]))?;
    Ok(text.lines().map(str::to_string).chain(["debug_assertions".into()]).collect())
}

/// The folder of a crate from the root on: `crates/FLOOR/NAME`.
fn folder_of(root: &Path, name: &str) -> Result<PathBuf> {
    for floor in fs::read_dir(root.join("crates"))? {
        let folder = floor?.path().join(name);
        if folder.join("Cargo.toml").exists() {
            return Ok(folder.strip_prefix(root)?.to_path_buf());
        }
    }
    Err(format!("there is no crate `{name}`").into())
}

/// The hash of a text (FNV-1a), mixed once more so that its order says nothing.
fn hash(text: &str) -> u64 {
    let fold = |hash: u64, byte: u8| (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
    let mut hash = text.bytes().fold(0xcbf2_9ce4_8422_2325, fold);
    hash = (hash ^ (hash >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    hash = (hash ^ (hash >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    hash ^ (hash >> 31)
}

/// The mutants that are asked about, in the order of the sources. The seed is the name of the crate, and each mutant has a
/// number of its own from it: a change of one function draws no other mutants elsewhere.
fn drawn(all: Vec<Mutant>, options: &Options) -> Vec<Mutant> {
    if !options.only.is_empty() {
        let is_asked = |of: &Mutant| options.only.iter().any(|text| of.words.contains(text.as_str()));
        return all.into_iter().filter(is_asked).collect();
    }
    let count = options.draw.unwrap_or(all.len());
    let mut order: Vec<usize> = (0..all.len()).collect();
    order.sort_by_key(|&k| hash(&format!("{}\n{}", options.name, all[k].key)));
    let chosen: BTreeSet<usize> = order.into_iter().take(count).collect();
    all.into_iter().enumerate().filter(|(k, _)| chosen.contains(k)).map(|(_, mutant)| mutant).collect()
}

/// All mutants of a crate of the repository at `root`, as its files are now.
pub fn list(root: &Path, options: &Options) -> Result<Vec<Mutant>> {
    let sources = sources(root, &folder_of(root, &options.name)?, &configuration()?)?;
    Ok(drawn(mutants(&sources), options))
}

/// Tests that run together in one process.
#[derive(Clone)]
struct Group {
    executable: Executable,
    tests: Vec<String>,
    /// The seconds that they take without a mutant.
    seconds: f64,
}

impl Group {
    fn of(executable: &Executable, tests: impl IntoIterator<Item = (String, f64)>) -> Option<Self> {
        let (tests, seconds): (Vec<_>, Vec<_>) = tests.into_iter().unzip();
        let seconds = seconds.iter().sum();
        (!tests.is_empty()).then(|| Self { executable: executable.clone(), tests, seconds })
    }

    fn arguments(&self) -> Vec<String> {
        ["--exact".to_string()].into_iter().chain(self.tests.iter().cloned()).collect()
    }
}

/// The build, as it is kept for the next run.
struct Kept {
    executables: Vec<Executable>,
    unviable: BTreeSet<u32>,
    /// Of each executable, its tests and the seconds that they take without a mutant.
    seconds: Vec<BTreeMap<String, f64>>,
}

impl Kept {
    /// What is kept of the build with these mutants at this commit.
    fn read(results: &Path, commit: &str, mutants: &[Mutant], options: &Options) -> Option<Self> {
        let kept: Value = serde_json::from_str(&fs::read_to_string(results.join("build.json")).ok()?).ok()?;
        let keys = kept["mutants"].as_array()?;
        let is_same = keys.len() == mutants.len()
            && keys.iter().zip(mutants).all(|(key, mutant)| *key == mutant.key.as_str());
        if kept["commit"] != commit || kept["tests"] != of_tests(options) || !is_same {
            return None;
        }
        let text = |of: &Value| of.as_str().map(str::to_string);
        let executables = kept["executables"].as_array()?.iter().map(|of| {
            let path = PathBuf::from(text(&of["path"])?);
            let folder = PathBuf::from(text(&of["folder"])?);
            path.exists().then_some(Executable { path, folder, package: text(&of["package"])? })
        });
        let seconds = kept["seconds"].as_array()?.iter().map(|of| {
            let pairs = of.as_object()?.iter();
            pairs.map(|(name, seconds)| Some((name.clone(), seconds.as_f64()?))).collect::<Option<_>>()
        });
        let unviable = kept["unviable"].as_array()?.iter();
        Some(Self {
            executables: executables.collect::<Option<_>>()?,
            unviable: unviable.filter_map(|of| u32::try_from(of.as_u64()?).ok()).collect(),
            seconds: seconds.collect::<Option<_>>()?,
        })
    }

    /// Writes what the next run needs.
    fn write(&self, results: &Path, commit: &str, mutants: &[Mutant], options: &Options) -> Result<()> {
        let executables: Vec<Value> = self
            .executables
            .iter()
            .map(|of| json!({ "path": of.path, "folder": of.folder, "package": of.package }))
            .collect();
        let keys: Vec<&str> = mutants.iter().map(|mutant| mutant.key.as_str()).collect();
        let kept = json!({
            "commit": commit, "mutants": keys, "executables": executables, "unviable": self.unviable,
            "seconds": self.seconds, "tests": of_tests(options),
        });
        fs::write(results.join("build.json"), kept.to_string())?;
        Ok(())
    }
}

/// Which tests are asked.
fn of_tests(options: &Options) -> Value {
    json!([options.ask, options.skip])
}

/// Copies executables: the next build of the same name would write over them.
fn copied(executables: Vec<Executable>, results: &Path) -> Result<Vec<Executable>> {
    let copy = |(k, executable): (usize, Executable)| {
        let path = results.join(format!("tests-{k}"));
        // One that runs cannot be written over.
        let _ = fs::remove_file(&path);
        fs::copy(&executable.path, &path)?;
        Ok(Executable { path, ..executable })
    };
    executables.into_iter().enumerate().map(copy).collect()
}

/// The variables of `[env]` in the configuration of cargo, which sets them for tests.
fn variables(clone: &Path) -> Vec<(String, String)> {
    let text = fs::read_to_string(clone.join(".cargo/config.toml")).unwrap_or_default();
    let lines = text.lines().skip_while(|line| line.trim() != "[env]").skip(1);
    let lines = lines.take_while(|line| !line.starts_with('['));
    let pair = |line: &str| {
        let (name, value) = line.split_once('=')?;
        Some((name.trim().to_string(), value.trim().trim_matches('"').to_string()))
    };
    lines.filter_map(pair).filter(|(name, _)| std::env::var_os(name).is_none()).collect()
}

/// The executables of tests that a package has, as arguments for cargo. What measures memory is left out.
fn targets(clone: &Path, package: &str) -> Result<Vec<String>> {
    let mut command = Command::new("cargo");
    command.current_dir(clone).args(["metadata", "--no-deps", "--format-version=1", "--offline"]);
    let metadata: Value = serde_json::from_str(&output(&mut command)?)?;
    let packages = metadata["packages"].as_array().ok_or("no packages")?;
    let of = packages.iter().find(|of| of["name"] == package).ok_or("the package is not there")?;
    let mut found = Vec::new();
    for target in of["targets"].as_array().into_iter().flatten().filter(|target| target["test"] == true) {
        let kind = target["kind"][0].as_str().unwrap_or_default();
        let name = target["name"].as_str().unwrap_or_default();
        match kind {
            "lib" | "rlib" => found.push("--lib".to_string()),
            "test" if name != "memory" => found.extend(["--test".to_string(), name.to_string()]),
            _ => {}
        }
    }
    Ok(found)
}

/// Asks the tests of a crate about its mutants. The results lie in `out/mutants/CRATE` below `root`, those of mutants that are chosen
/// by hand in `out/mutants/CRATE-chosen`.
pub fn run(root: &Path, options: &Options) -> Result<()> {
    let out = root.join("out/mutants");
    // Those that are chosen by hand are no part of the draw.
    let is_chosen = !options.only.is_empty();
    let results = out.join(format!("{}{}", options.name, if is_chosen { "-chosen" } else { "" }));
    fs::create_dir_all(&results)?;
    let (out, results) = (out.canonicalize()?, results.canonicalize()?);
    let clone = out.join("clone");
    let commit = git(root, &["rev-parse", "HEAD"])?;

    // Parts that run at the same time share the build: the first makes it.
    let lock = File::create(out.join("lock"))?;
    lock.lock()?;
    if !clone.exists() {
        git(root, &["clone", "--quiet", ".", &clone.display().to_string()])?;
    }
    git(&clone, &["fetch", "--quiet", "origin", &commit])?;
    let folder = folder_of(root, &options.name)?;
    let (sources, all) = committed(root, &commit, &folder, &out)?;
    let count = all.len();
    let drawn = drawn(all, options);
    println!("{}: {count} mutants, {} of them are asked about", options.name, drawn.len());
    let lines =
        (1..).zip(&drawn).map(|(number, of): (u32, _)| format!("{number}\t{}\t{}\n", of.key, of.words));
    fs::write(results.join("drawn.tsv"), lines.collect::<String>())?;

    let scratch = results.join(match options.part {
        Some((part, _)) => format!("scratch-{part}"),
        None => "scratch".into(),
    });
    let variables = variables(&clone);
    let setting = Setting { clone: &clone, scratch: &scratch, variables: &variables };
    let kept = match Kept::read(&results, &commit, &drawn, options) {
        Some(kept) => kept,
        None => {
            // A run before has left mutants in the sources.
            git(&clone, &["checkout", "--quiet", "--force", "--detach", &commit])?;
            let manifest = fs::read_to_string(clone.join(&folder).join("Cargo.toml"))?;
            let package = package_name(&manifest).ok_or("a package without a name")?;
            let targets = targets(&clone, &package)?;
            let built = build(&clone, &package, &sources, &drawn, &targets)?;
            let executables = copied(built.executables, &results)?;
            let seconds = without_a_mutant(&setting, &executables, options)?;
            let kept = Kept { executables, unviable: built.unviable, seconds };
            kept.write(&results, &commit, &drawn, options)?;
            kept
        }
    };
    lock.unlock()?;
    let groups = groups(&kept);
    if options.only_build {
        return Ok(());
    }

    let mut record = Record::open(&results)?;
    let numbered: Vec<(u32, &Mutant)> = (1..).zip(&drawn).collect();
    for (number, mutant) in &numbered {
        let is_known = record.of.get(&mutant.key).is_some_and(|(_, last)| *last == Outcome::Unviable);
        if kept.unviable.contains(number) && !is_known {
            record.add(&mutant.key, Outcome::Unviable, "the compiler")?;
        }
    }
    let due: Vec<&(u32, &Mutant)> = numbered
        .iter()
        .filter(|(number, mutant)| {
            let last = record.of.get(&mutant.key).map(|(_, last)| *last);
            let is_due = match options.asked {
                _ if is_chosen => true,
                Asked::New => last.is_none(),
                Asked::Missed => last == Some(Outcome::Missed),
            };
            is_due
                && !kept.unviable.contains(number)
                && options.part.is_none_or(|(part, parts)| number % parts == part)
        })
        .collect();
    println!("{} do not compile, {} are due", kept.unviable.len(), due.len());
    // The tests that told the last mutants of each file.
    let mut favourites: HashMap<usize, Vec<Group>> = HashMap::new();
    for (k, (number, mutant)) in due.iter().enumerate() {
        let first = favourites.entry(mutant.source).or_default();
        let (outcome, test) = ask(&setting, &groups, *number, first)?;
        if outcome != Outcome::Missed {
            forget(&clone.join(&folder));
        }
        record.add(&mutant.key, outcome, &test)?;
        let told = match outcome {
            Outcome::Caught => format!("caught by {test}"),
            Outcome::Timeout => format!("no end of {test}"),
            _ => "MISSED".into(),
        };
        println!("{} of {}: MUTANT={number} {}: {told}", k + 1, due.len(), mutant.words);
    }
    println!("{}", row(&results, &options.name)?);
    Ok(())
}

/// The sources of a crate as they were committed, and all its mutants.
fn committed(root: &Path, commit: &str, folder: &Path, out: &Path) -> Result<(Vec<Source>, Vec<Mutant>)> {
    let plain = out.join("committed");
    let _ = fs::remove_dir_all(&plain);
    let listed = git(root, &["ls-tree", "-r", "--name-only", commit, "--", &folder.display().to_string()])?;
    for name in listed.lines().filter(|name| name.ends_with(".rs")) {
        let path = plain.join(name);
        fs::create_dir_all(path.parent().unwrap_or(&plain))?;
        let shown =
            Command::new("git").current_dir(root).args(["show", &format!("{commit}:{name}")]).output()?;
        fs::write(path, shown.stdout)?;
    }
    let sources = sources(&plain, folder, &configuration()?)?;
    let all = mutants(&sources);
    Ok((sources, all))
}

/// The tests of each executable, and the seconds that they take: without a mutant all pass.
fn without_a_mutant(
    setting: &Setting,
    executables: &[Executable],
    options: &Options,
) -> Result<Vec<BTreeMap<String, f64>>> {
    let skipped = options.skip.iter().flat_map(|name| ["--skip".to_string(), name.clone()]);
    let asked: Vec<String> = options.ask.iter().cloned().chain(skipped).collect();
    let mut all = Vec::new();
    for executable in executables {
        clean(setting.scratch)?;
        let Run { ended, seconds } = setting.run(executable, &asked, 0, BASELINE_LIMIT)?;
        if ended != Ended::Passed {
            return Err(format!("without a mutant the tests do not pass: {ended:?}").into());
        }
        println!("{} tests pass in {:.1} s", seconds.len(), seconds.values().sum::<f64>());
        all.push(seconds);
    }
    Ok(all)
}

/// The tests of the executables, the quicker ones first.
fn groups(kept: &Kept) -> Vec<Group> {
    let mut groups = Vec::new();
    for (executable, seconds) in kept.executables.iter().zip(&kept.seconds) {
        let mut shorter = 0.0;
        for most in TOGETHER_S {
            let those = seconds.iter().filter(|(_, s)| shorter <= **s && **s < most);
            groups.extend(Group::of(executable, those.map(|(name, s)| (name.clone(), *s))));
            shorter = most;
        }
        for (name, s) in seconds.iter().filter(|(_, s)| shorter <= **s) {
            groups.extend(Group::of(executable, [(name.clone(), *s)]));
        }
    }
    groups.sort_by(|one, other| one.seconds.total_cmp(&other.seconds));
    groups
}

/// An empty folder.
fn clean(folder: &Path) -> Result<()> {
    let _ = fs::remove_dir_all(folder);
    fs::create_dir_all(folder)?;
    Ok(())
}

/// Asks the tests about one mutant, up to the first that tells it.
fn ask(
    setting: &Setting,
    groups: &[Group],
    number: u32,
    first: &mut Vec<Group>,
) -> Result<(Outcome, String)> {
    let mut told = (Outcome::Missed, String::new());
    for group in first.iter().chain(groups) {
        clean(setting.scratch)?;
        let limit = Duration::from_secs_f64(TIMES * group.seconds).max(MIN_LIMIT);
        let (outcome, test) = match setting.run(&group.executable, &group.arguments(), number, limit)?.ended {
            Ended::Passed => continue,
            Ended::Failed(test) => (Outcome::Caught, test),
            Ended::TooLong(test) => (Outcome::Timeout, test),
        };
        // The test that told this one is asked first about the next one.
        if group.tests.contains(&test) {
            let seconds =
                if group.tests.len() == 1 { group.seconds } else { group.seconds.min(TOGETHER_S[2]) };
            let alone = Group::of(&group.executable, [(test.clone(), seconds)]);
            first.retain(|of| !of.tests.contains(&test));
            first.splice(0..0, alone);
            first.truncate(MAX_FAVOURITES);
        }
        told = (outcome, test);
        break;
    }
    clean(setting.scratch)?;
    Ok(told)
}

/// What a property test remembers of a failure is no part of the next run.
fn forget(folder: &Path) {
    for pattern in ["*.proptest-regressions", "proptest-regressions"] {
        let _ = git(folder, &["checkout", "--quiet", "--", pattern]);
        let _ = git(folder, &["clean", "-fdq", "--", pattern]);
    }
}
