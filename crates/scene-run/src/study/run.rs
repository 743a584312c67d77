//! `windfall scene study`: variants of a scene, run several times each, side by side.

use crate::file::read::scene_of;
use crate::file_error::{access, make_directory, write_json};
use crate::frames::view::{PictureRequest, draw_scene, open_frames};
use crate::run::checkpoint::{check_checkpoint, checkpoint_path};
use crate::run::stopped::SceneStart;
use crate::run::workflow::run_plan;
use crate::study::laws::{certain_laws, draw_laws};
use crate::study::outcome::{Replicate, StudyOutcome, effects, variant};
use crate::study::read::{StudyPlan, read_study};
use crate::study::text::{csv_of_study, write_page};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use windfall_draw::files::file_name;
use windfall_files::error::Error;
use windfall_files::found::FindingOutcome;
use windfall_files::on_threads::on_threads;
use windfall_files::option_value::unusable;
use windfall_files::progress::Progress;
use windfall_files::provenance::{VERSION, digest_file, time_now};
use windfall_files::text::toml_source::TomlSource;
use windfall_files::write_file::write_whole;
use windfall_files::written::{check_written, is_own_file};

/// Options of a study besides the file.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct StudyRequest {
    /// Directory to write into
    #[cfg_attr(feature = "clap", arg(long, value_name = "DIR", value_hint = clap::ValueHint::DirPath))]
    pub out: Option<PathBuf>,
    /// Number of threads, over which runs are spread; all cores if left out. It never changes a result
    #[cfg_attr(feature = "clap", arg(long, value_name = "N"))]
    pub threads: Option<usize>,
}

/// Directory of the runs in that of the study.
const VARIANTS: &str = "variants";
/// Those of an earlier study, until all of this one are there.
const EARLIER: &str = "variants.earlier";
/// Those of an earlier study, once all of this one are there.
const REPLACED: &str = "variants.replaced";
/// File by which that directory is known as a study's.
const MARK: &str = "made_by_a_study.txt";
/// Bruise models drawn from the uncertainty of their coefficients, and their seed: the same
/// for all runs.
const MODELS: (usize, u64) = (200, 1);
/// Steps in which the progress of a run is reported.
const PARTS: usize = 100;

/// Runs every variant of a study several times, and writes each run, a table, a page and a
/// figure. A variant that fails is reported and takes nothing from the others. Results of an
/// earlier study stay until those of this one are there.
///
/// * `progress`: parts of runs done, and all
///
/// # Errors
/// The study cannot be read; no variant has a result; the directory cannot be written.
pub fn run_study(
    path: &Path,
    request: &StudyRequest,
    progress: Progress,
) -> Result<StudyOutcome, Error> {
    let plan = read_study(path)?;
    let out = request.out.clone();
    let out = out.unwrap_or_else(|| path.with_extension("study"));
    set_aside(&out)?;
    let runs = run_all(&plan, &out, request.threads, progress).and_then(|runs| {
        let Some(Err(first)) = runs.iter().all(Result::is_err).then(|| &runs[0]) else {
            return Ok(runs);
        };
        let problem = format!("all {} variants failed; the first: {first}", runs.len());
        Err(unusable(path.display().to_string(), problem))
    });
    let runs = runs.inspect_err(|_| put_back(&out))?;
    let variants = plan.variants.iter().zip(&runs).enumerate();
    let variants = variants.map(|(number, (own, run))| {
        variant(
            &own.name,
            Path::new(VARIANTS).join(directory_of(number, &own.name)),
            run,
        )
    });
    let mut outcome = StudyOutcome {
        title: plan.title.clone(),
        made: [VERSION.to_owned(), time_now()],
        digests: [digest_file(path)?, digest_file(&plan.scene)?],
        replicates: plan.replicates,
        factors: plan.factors.clone(),
        variants: variants.collect(),
        effects: effects(&plan, &runs),
        findings: findings(&plan, &runs),
        files: ["study.json", "study.csv"]
            .map(|name| out.join(name))
            .into(),
    };
    let first = outcome.variants.iter().find(|own| own.failed.is_none());
    if let Some(first) = first.map(|own| out.join(&own.directory).join(replicate_name(0))) {
        draw_run(&first)?;
    }
    let [earlier, replaced] = [EARLIER, REPLACED].map(|name| out.join(name));
    if earlier.exists() {
        std::fs::rename(&earlier, &replaced).map_err(access(&earlier, "replace"))?;
    }
    outcome.files.extend(write_page(&outcome, &out)?);
    write_whole(&out.join("study.csv"), csv_of_study(&outcome)?.as_bytes())?;
    write_json(&out.join("study.json"), &outcome.title, &outcome)?;
    remove(&replaced)?;
    Ok(outcome)
}

/// Name of the directory of a replicate.
fn replicate_name(replicate: usize) -> String {
    format!("replicate_{}", replicate + 1)
}

/// Draws a run at half time, if it has frames: the page shows it.
fn draw_run(run: &Path) -> Result<(), Error> {
    let Some(last) = open_frames(run)
        .ok()
        .and_then(|own| own.frames.last().map(|own| own.time))
    else {
        return Ok(());
    };
    let request = PictureRequest {
        time: Some(0.5 * last),
        ..PictureRequest::default()
    };
    draw_scene(run, &request).map(|_| ())
}

/// Sets the runs of an earlier study aside, and makes room for those of this one. Files that
/// windfall did not write are refused.
fn set_aside(out: &Path) -> Result<(), Error> {
    for name in ["study.json", "study.csv", "study.html"] {
        check_written(&out.join(name), None)?;
    }
    let [variants, earlier, replaced] = [VARIANTS, EARLIER, REPLACED].map(|name| out.join(name));
    for folder in [&variants, &earlier, &replaced] {
        check_folder(folder)?;
    }
    remove(&replaced)?;
    // Beside whole ones that were set aside lie those of a study that was killed.
    match earlier.exists() {
        true => remove(&variants)?,
        false if variants.exists() => {
            std::fs::rename(&variants, &earlier).map_err(access(&variants, "replace"))?;
        }
        false => {}
    }
    make_directory(&variants)?;
    write_whole(
        &variants.join(MARK),
        b"Runs of windfall scene study; the next one replaces them.\n",
    )
}

/// Puts the runs of an earlier study back in the place of those that came to nothing.
fn put_back(out: &Path) {
    let [variants, earlier] = [VARIANTS, EARLIER].map(|name| out.join(name));
    // What cannot be put back now is put aside by the next study.
    if remove(&variants).is_ok() && earlier.exists() {
        let _ = std::fs::rename(&earlier, &variants);
    }
}

fn remove(folder: &Path) -> Result<(), Error> {
    match std::fs::remove_dir_all(folder) {
        Err(error) if error.kind() != std::io::ErrorKind::NotFound => {
            Err(access(folder, "replace")(error))
        }
        _ => Ok(()),
    }
}

/// Refuses a folder of runs in which somebody else put a file.
fn check_folder(folder: &Path) -> Result<(), Error> {
    let failed = |source| Error::access(folder, "read", source);
    if !folder.exists() {
        return Ok(());
    }
    for entry in std::fs::read_dir(folder).map_err(failed)? {
        let path = entry.map_err(failed)?.path();
        let unfinished = path.extension().is_some_and(|own| own == "partial");
        match path.symlink_metadata().is_ok_and(|own| own.is_dir()) {
            true => check_folder(&path)?,
            false if unfinished || is_own_file(&path) => {}
            false if path == checkpoint_path(folder) => check_checkpoint(&path)?,
            false => check_written(&path, None)?,
        }
    }
    Ok(())
}

fn directory_of(number: usize, name: &str) -> String {
    format!("{:02}_{}", number + 1, file_name(name))
}

/// The runs of each variant, or why one of them failed.
type Runs = Vec<Result<Vec<Replicate>, String>>;

/// All runs, each on its own thread as far as there are threads for all.
fn run_all(
    plan: &StudyPlan,
    out: &Path,
    threads: Option<usize>,
    progress: Progress,
) -> Result<Runs, Error> {
    let all = plan.variants.len() * plan.replicates;
    let cores = || std::thread::available_parallelism().map_or(1, usize::from);
    let threads = threads.filter(|own| *own > 0).unwrap_or_else(cores);
    let workers = threads.min(all).max(1);
    let each = (threads / workers).max(1);
    let (next, done, stopped) = (
        AtomicUsize::new(0),
        AtomicUsize::new(0),
        AtomicBool::new(false),
    );
    let results: Mutex<Vec<Option<Result<Replicate, String>>>> = Mutex::new(vec![None; all]);
    let work = || {
        loop {
            let job = next.fetch_add(1, Ordering::Relaxed);
            if job >= all || stopped.load(Ordering::Relaxed) {
                return;
            }
            if progress(done.load(Ordering::Relaxed), PARTS * all).is_break() {
                stopped.store(true, Ordering::Relaxed);
                return;
            }
            let told = AtomicUsize::new(0);
            let tell = |steps: usize, of: usize| {
                let part = PARTS * steps / of.max(1);
                let before = told.swap(part, Ordering::Relaxed);
                let sum = done.fetch_add(part - before.min(part), Ordering::Relaxed);
                let sum = sum + part - before.min(part);
                if progress(sum, PARTS * all).is_break() {
                    stopped.store(true, Ordering::Relaxed);
                }
                match stopped.load(Ordering::Relaxed) {
                    true => ControlFlow::Break(()),
                    false => ControlFlow::Continue(()),
                }
            };
            let result = on_threads(Some(each), || run_one(plan, out, job, &tell));
            let result = result.map_err(|error| error.to_string());
            if let Ok(mut results) = results.lock() {
                results[job] = Some(result);
            }
        }
    };
    std::thread::scope(|scope| {
        for _ in 0..workers {
            scope.spawn(work);
        }
    });
    let results = results.into_inner().unwrap_or_default();
    let runs = results.chunks(plan.replicates).map(|own| {
        let own = own
            .iter()
            .cloned()
            .map(|run| run.unwrap_or_else(|| Err("it did not run".to_owned())));
        own.collect::<Result<Vec<Replicate>, String>>()
    });
    match stopped.into_inner() {
        true => Err(Error::Cancelled),
        false => Ok(runs.collect()),
    }
}

/// One run: a variant with another seed, and with resampled laws where there are several.
fn run_one(
    plan: &StudyPlan,
    out: &Path,
    job: usize,
    progress: Progress,
) -> Result<Replicate, Error> {
    let (number, replicate) = (job / plan.replicates, job % plan.replicates);
    let own = &plan.variants[number];
    let folder = out.join(VARIANTS).join(directory_of(number, &own.name));
    let folder = folder.join(replicate_name(replicate));
    make_directory(&folder)?;
    let text = with_seed(&own.text, replicate as u64);
    write_whole(&folder.join("scene.toml"), text.as_bytes())?;
    let mut scene = scene_of(&TomlSource {
        path: plan.scene.clone(),
        text,
    })?;
    if plan.replicates > 1 {
        draw_laws(&mut scene, replicate as u64 + 1)?;
    }
    let limits = scene.bruise.as_ref().map(|own| own.limits.clone());
    let walls = scene.scene.walls.len();
    let run = run_plan(scene, &folder, SceneStart::Restart, progress)?;
    Ok(Replicate {
        above: run.blows.as_ref().map_or_else(
            || vec![Vec::new(); MODELS.0 + 1],
            |blows| blows.counts_above(MODELS),
        ),
        limits: limits.unwrap_or_default(),
        variance_ratios: run
            .blows
            .as_ref()
            .map_or_else(Vec::new, |blows| blows.variance_ratios(walls)),
        scene: run.outcome,
    })
}

/// The text with the seed of a replicate: the scene's own, and those that follow it.
fn with_seed(text: &str, replicate: u64) -> String {
    let Ok(mut document) = text.parse::<toml_edit::DocumentMut>() else {
        return text.to_owned();
    };
    let table = document.entry("scene").or_insert_with(toml_edit::table);
    let seed = table.get("seed").and_then(toml_edit::Item::as_integer);
    let seed = seed.unwrap_or(1).saturating_add_unsigned(replicate);
    if let Some(table) = table.as_table_like_mut() {
        table.insert("seed", toml_edit::value(seed));
    }
    document.to_string()
}

/// Findings of all runs, each code once for a variant, and those of the study.
fn findings(plan: &StudyPlan, runs: &[Result<Vec<Replicate>, String>]) -> Vec<FindingOutcome> {
    let mut all: Vec<FindingOutcome> = Vec::new();
    let tell = |code: &str, message: String| FindingOutcome::new(code, message);
    for (own, run) in plan.variants.iter().zip(runs) {
        match run {
            Err(problem) => all.push(tell("variant-failed", format!("{}: {problem}", own.name))),
            Ok(replicates) => {
                let first = replicates.first();
                for of in first.into_iter().flat_map(|own| &own.scene.findings) {
                    // Each code once, of the first variant that has it; the runs have all.
                    if all.iter().any(|known| known.code == of.code) {
                        continue;
                    }
                    let message = format!("{}, for one: {}", own.name, of.message);
                    all.push(tell(&of.code, message));
                }
            }
        }
    }
    if plan.replicates == 1 {
        all.push(tell(
            "one-replicate",
            "each variant ran once: that laws are uncertain, and that other places and paths \
             would have come, is not in the intervals; set replicates to 4 or more"
                .to_owned(),
        ));
    }
    let text = plan.variants.first().map(|own| own.text.clone());
    let scene = text.and_then(|text| {
        let path = plan.scene.clone();
        scene_of(&TomlSource { path, text }).ok()
    });
    let certain = scene.as_ref().map_or_else(Vec::new, certain_laws);
    if !certain.is_empty() {
        all.push(tell(
            "law-certain",
            format!(
                "the law of {} has no stated uncertainty (no card, or one without covariance): \
                 the intervals take it as certain",
                certain.join("; of ")
            ),
        ));
    }
    all
}
