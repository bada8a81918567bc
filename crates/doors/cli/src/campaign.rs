//! `raypencil campaign`: validations of many random terrains, in shards; `merge` and `replay`.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

use indicatif::ProgressBar;
use raypencil::Progress;
use raypencil::campaign::{
    Campaign, CampaignProgress, Merged, OwnScenes, PartName, Shard, campaign_document, merge, run_shard,
    scene_of, write_campaign,
};
use raypencil::io::{MIN_ABANDONED_AGE, SharedFolder, begin_files, remove_abandoned, write_resolved};

use crate::args::{self, CampaignCommand, CampaignMerge, CampaignReplay, CampaignRun};
use crate::console::{Spinner, progress_bar, say};
use crate::lines::Lines;
use crate::overwriting::{ask_campaign, ask_replay};
use crate::{Outcome, Trouble};

pub(crate) fn campaign(command: &args::Campaign, json: bool) -> Result<Outcome, Trouble> {
    match &command.command {
        None => run(&command.run, json),
        Some(CampaignCommand::Merge(command)) => merged(command, json),
        Some(CampaignCommand::Replay(command)) => replay(command),
    }
}

/// Progress bar: finished terrains, rays per second, time left. If standard error is no terminal, a line now and then.
struct Bar {
    bar: ProgressBar,
    start: Instant,
    done: Arc<Done>,
    /// Until it is dropped.
    _lines: Lines,
}

/// What is done so far.
#[derive(Default)]
struct Done {
    terrains: AtomicU64,
    /// Rays of this run; those of an interrupted earlier run do not count.
    rays: AtomicU64,
}

impl Bar {
    fn new(terrains: u64) -> Self {
        let bar =
            progress_bar(terrains, "{bar:30} {pos}/{len} terrains  {elapsed} elapsed, {eta} left  {msg}");
        let (start, done) = (Instant::now(), Arc::new(Done::default()));
        let of_lines = Arc::clone(&done);
        let lines = Lines::begin(move || {
            let Done { terrains: finished, rays } = &*of_lines;
            let (finished, rays) = (finished.load(Ordering::Relaxed), rays.load(Ordering::Relaxed));
            let seconds = start.elapsed().as_secs();
            format!("campaign: {finished} of {terrains} terrains, {rays} rays, {seconds} s")
        });
        Self { bar, start, done, _lines: lines }
    }
}

impl CampaignProgress for Bar {
    fn done(&self, terrains: u64, _of: u64, rays: u64) {
        self.done.terrains.store(terrains, Ordering::Relaxed);
        self.done.rays.store(rays, Ordering::Relaxed);
        self.bar.set_position(terrains);
        let rate = rays as f64 / self.start.elapsed().as_secs_f64().max(1e-3);
        self.bar.set_message(format!("{:.2} million rays/s", rate / 1e6));
    }
}

fn run(command: &CampaignRun, json: bool) -> Result<Outcome, Trouble> {
    let mut campaign = Campaign::new(command.seed, command.terrains).of_commit(crate::commit());
    if let Some(folder) = &command.scenes {
        campaign = campaign.over(OwnScenes::read(folder, command.rig.as_deref())?);
    }
    if let Some(words) = &command.candidate_command {
        campaign = campaign.hunting(words)?;
        campaign.candidate_ms = command.timeout;
        campaign.partial = command.partial;
        campaign.arithmetic = command.arithmetic;
    }
    campaign.max_faces = command.max_faces;
    let campaign = campaign.with_parts(&command.parts)?;
    let bar = Bar::new(command.shard.terrains(&campaign).count() as u64);
    let start = Instant::now();
    ask_campaign(&command.output)?;
    let _shared = SharedFolder::begin(&command.output)?;
    remove_abandoned(&command.output, MIN_ABANDONED_AGE);
    let result = run_shard(&campaign, command.shard, &command.output, &bar)?;
    bar.bar.finish_and_clear();
    let rays = bar.done.rays.load(Ordering::Relaxed);
    drop(bar);
    if command.shard != Shard::WHOLE {
        // One shard has no summary of its own: the campaign is all shards together.
        let text = match json {
            true => format!("{:#}\n", serde_json::json!({ "result": result.display().to_string() })),
            false => format!(
                "{}: finished in {:.1} s; merge all shards with `raypencil campaign merge`\n",
                result.display(),
                start.elapsed().as_secs_f64()
            ),
        };
        say(&text);
        return Ok(Outcome::Fine);
    }
    let mut merged = merge(std::slice::from_ref(&command.output), crate::commit())?;
    // The same campaign, which knows where its scenes lie.
    merged.campaign = campaign;
    write_campaign(&merged, &command.output)?;
    let seconds = start.elapsed().as_secs_f64();
    let rate = rays as f64 / seconds / 1e6;
    let before = merged.compared() - rays;
    let before = if before > 0 { format!(" ({before} rays from earlier runs)") } else { String::new() };
    let commit = crate::commit().map_or(String::new(), |commit| format!(", commit {commit}"));
    let time = format!("seed {}{commit}; {seconds:.1} s, {rate:.2} million rays/s{before}\n", command.seed);
    tell(&merged, json, &time)
}

fn merged(command: &CampaignMerge, json: bool) -> Result<Outcome, Trouble> {
    let merged = merge(&command.folders, crate::commit())?;
    if let Some(folder) = &command.output {
        ask_campaign(folder)?;
        write_campaign(&merged, folder)?;
    }
    tell(&merged, json, "")
}

/// Prints the result and tells the exit code.
fn tell(merged: &Merged, json: bool, time: &str) -> Result<Outcome, Trouble> {
    let document = campaign_document(merged, |_| false);
    say(&if json { document.json() } else { document.screen() + time });
    Ok(if merged.passes() { Outcome::Fine } else { Outcome::Differs })
}

fn replay(command: &CampaignReplay) -> Result<Outcome, Trouble> {
    let spinner = Spinner::new();
    spinner.stage(&format!("terrain {}", command.terrain));
    // A terrain does not depend on the number of terrains.
    let mut campaign = Campaign::new(command.seed, command.terrain.saturating_add(1));
    if let Some(folder) = &command.scenes {
        campaign = campaign.over(OwnScenes::read(folder, command.rig.as_deref())?);
        if command.terrain >= campaign.terrains {
            let (given, most) = (command.terrain, campaign.terrains - 1);
            return Err(Trouble::Usage(format!(
                "--terrain {given}: expected 0 to {most}, the scenes of the folder"
            )));
        }
        if command.part == PartName::Lattice {
            return Err(Trouble::Usage(
                "--part lattice: scenes of one's own have no lattice; expected own or aimed".into(),
            ));
        }
    }
    let scene = scene_of(&campaign, command.terrain, command.part)?;
    let folder = &command.output;
    ask_replay(folder)?;
    begin_files(folder)?;
    let file = folder.join("scene.toml");
    write_resolved(&file, &scene, "terrain.glb")?;
    drop(spinner);
    say(&format!("{}\n", file.display()));
    Ok(Outcome::Fine)
}
