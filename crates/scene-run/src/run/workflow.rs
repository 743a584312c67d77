//! A scene from its file to the contacts of each fruit.

use crate::bruise::scene::{Blows, finding_of_blows};
use crate::file::engine_kind::Engine;
use crate::file::read::{ScenePlan, read_changed_scene};
use crate::file::step::checked_step;
use crate::file_error::{make_directory, write_json};
use crate::run::advance::{Mover, Own, SceneRun};
use crate::run::fallen::finding_of_fallen;
use crate::run::frame_format::FRAMES_FILE;
use crate::run::frames::remove_frames;
use crate::run::histogram::{HistogramOutcome, figure_of_histograms, histogram};
use crate::run::outcome::{PartnerOutcome, SceneOutcome, StepOutcome, Tally, findings_of_range};
use crate::run::sensors::figure::figure_of_sensors;
use crate::run::sensors::watch::Sensors;
use crate::run::start::{find_start, remove_end, save_end};
use crate::run::stopped::SceneStart;
use crate::run::tables::fruit_table;
use crate::run_error::stopped_scene as stopped;
use std::path::{Path, PathBuf};
use windfall_draw::files::{FigureFolder, write_figure};
use windfall_files::error::Error;
use windfall_files::found::FindingOutcome;
use windfall_files::on_threads::on_threads;
use windfall_files::progress::Progress;
use windfall_files::write_file::{check_target, write_whole};
use windfall_scene::bruise::damage::Bruise;
use windfall_scene::energy::Energy;
use windfall_scene::interaction::Interaction;
use windfall_scene::motion::time_step::{Impact, SHORTER, SHORTEST, Shaking, StepError};
use windfall_scene::scene::Scene;
use windfall_scene::shape::motion::How;
use windfall_scene::shape::wall::Wall;
use windfall_scene::vector::{add, dot, length, turned};

/// Options of a run besides the file.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct SceneRequest {
    /// Directory to write into
    #[cfg_attr(feature = "clap", arg(long, value_name = "DIR", value_hint = clap::ValueHint::DirPath))]
    pub out: Option<PathBuf>,
    /// Number of threads; all cores if left out. It never changes a result
    #[cfg_attr(feature = "clap", arg(long, value_name = "N"))]
    pub threads: Option<usize>,
    /// Another value than the file has, such as walls.edge.material=foam (repeatable)
    #[cfg_attr(feature = "clap", arg(long, value_name = "KEY=VALUE"))]
    pub set: Vec<String>,
    /// What to do with a run that was stopped
    #[cfg_attr(feature = "clap", arg(skip))]
    pub start: SceneStart,
}

/// What moves the fruit, and what to report about it.
pub struct Moved<'a> {
    /// The engine.
    pub mover: &'a mut dyn Mover,
    /// Its time step.
    pub step: StepOutcome,
    /// Its name and version.
    pub engine: String,
    /// What a reader must know of it.
    pub findings: Vec<FindingOutcome>,
    /// Lack of the energy account that is worth a word, where it is; 1.
    pub large_closure: Option<f64>,
}

/// Runs a scene and writes the contacts and the fruit into a directory.
///
/// * `progress`: steps done, and all; when it cancels, the last checkpoint is kept
///
/// # Errors
/// The file cannot be used; the result would mean nothing; the directory cannot be written,
/// or holds a run that was stopped.
pub fn run_scene(
    path: &Path,
    request: &SceneRequest,
    progress: Progress,
) -> Result<SceneOutcome, Error> {
    let plan = read_changed_scene(path, &request.set)?;
    let out = directory_of(path, request);
    on_threads(request.threads, || {
        Ok(run_plan(plan, &out, request.start, progress)?.outcome)
    })
}

/// Where the results of a scene go.
pub fn directory_of(path: &Path, request: &SceneRequest) -> PathBuf {
    let out = request.out.clone();
    out.unwrap_or_else(|| path.with_extension("run"))
}

/// Results of a scene, with the contacts that bruise.
pub struct RunOfScene {
    /// The result.
    pub outcome: SceneOutcome,
    /// Contacts that bruise, where the scene says what does.
    pub blows: Option<Blows>,
}

/// Runs a scene that is read already, and writes what comes of it.
///
/// * `out`: directory to write into
pub fn run_plan(
    mut plan: ScenePlan,
    out: &Path,
    start: SceneStart,
    progress: Progress,
) -> Result<RunOfScene, Error> {
    let mut step = time_step(&mut plan)?;
    find_start(&mut plan, out)?;
    step.time_step = plan.scene.time_step;
    let moved = Moved {
        mover: &mut Own,
        step,
        engine: Engine::Windfall.title().to_owned(),
        findings: Vec::new(),
        large_closure: None,
    };
    run_moved(&plan, moved, out, start, progress)
}

/// Runs a scene whose fruit something moves, and writes what comes of it.
pub fn run_moved(
    plan: &ScenePlan,
    moved: Moved,
    out: &Path,
    start: SceneStart,
    progress: Progress,
) -> Result<RunOfScene, Error> {
    make_directory(out)?;
    // Before an hour of steps.
    for name in [
        "fruit.csv",
        "scene.json",
        "histograms.csv",
        "histograms.svg",
        FRAMES_FILE,
    ] {
        check_target(&out.join(name))?;
    }
    Sensors::check_figure(&plan.sensors, out)?;
    let mut run = SceneRun::begin(plan, out, start, moved.mover)?;
    run.run_to_end(moved.mover, progress)?;
    let last = moved.mover.step(&mut run.simulation)?;
    for event in moved.mover.lasting(&run.simulation) {
        run.count(&event).map_err(|error| run.told(error))?;
    }
    let written = write_results(plan, &mut run, (&moved, &last), out);
    let outcome = written.map_err(|error| run.told(error))?;
    let blows = run.blows.take();
    run.finish()?;
    moved.mover.finish();
    Ok(RunOfScene { outcome, blows })
}

/// Writes all but the table of contacts, whose name is the sign that all is there; what came
/// of the run.
fn write_results(
    plan: &ScenePlan,
    run: &mut SceneRun,
    (moved, last): (&Moved, &Energy),
    out: &Path,
) -> Result<SceneOutcome, Error> {
    run.table.sync()?;
    let frames = run.frames.whole(&run.simulation, &run.tally)?;
    if frames.is_none() {
        remove_frames(out)?;
    }
    let sensor_tables = run.sensors.finish(&run.simulation, out)?;
    let (simulation, tally) = (&run.simulation, &run.tally);
    let bruised = plan.bruise.as_ref().zip(run.blows.as_ref());
    let bruises = bruised.map(|(bruise, blows)| blows.bruises(bruise));
    let [events, fruit, summary] =
        ["events.csv", "fruit.csv", "scene.json"].map(|name| out.join(name));
    let table = fruit_table(plan, tally, &simulation.fruit(), bruises.as_deref())?;
    write_whole(&fruit, table.as_bytes())?;
    let histograms = histograms_of(tally, bruises.as_deref());
    let mut files = vec![events, fruit];
    files.extend(frames);
    match run.keeps_states() {
        true => files.push(save_end(plan, &mut run.simulation, &run.tally, out)?),
        false => remove_end(out)?,
    }
    let (simulation, tally) = (&run.simulation, &run.tally);
    files.push(summary.clone());
    files.extend(sensor_tables);
    let figure = figure_of_histograms(&plan.title, &histograms);
    files.extend(write_figure(&FigureFolder::of(out), "histograms", &figure)?);
    if let Some(figure) = figure_of_sensors(&plan.title, &run.sensors) {
        files.extend(write_figure(&FigureFolder::of(out), "sensors", &figure)?);
    }
    let energy_closure = last.relative_closure(run.first_closure);
    let outcome = SceneOutcome {
        title: plan.title.clone(),
        start: plan.start.as_ref().map(|own| own.time),
        end: plan.end,
        engine: moved.engine.clone(),
        step: moved.step.clone(),
        steps: (simulation.steps() - 1 - run.before) * moved.mover.steps(),
        fruit: plan.scene.fruit.len(),
        waiting: simulation.waiting(),
        left: tally.left(),
        contacts: tally.contacts,
        written: run.table.written(),
        partners: PartnerOutcome::of(&plan.scene, tally),
        histograms,
        sensors: run.sensors.outcomes(simulation),
        bruise: bruised.map(|(bruise, blows)| blows.outcome(bruise, &plan.scene)),
        energy: *last,
        energy_closure,
        findings: findings_of(plan, run, moved, energy_closure),
        files,
    };
    write_json(&summary, &plan.title, &outcome)?;
    Ok(outcome)
}

/// All findings of a run.
fn findings_of(
    plan: &ScenePlan,
    run: &SceneRun,
    moved: &Moved,
    closure: f64,
) -> Vec<FindingOutcome> {
    let mut findings = plan.findings.clone();
    findings.extend(moved.findings.iter().cloned());
    findings.extend(findings_of_range(
        plan,
        &run.tally,
        run.simulation.waiting(),
    ));
    findings.extend(finding_of_fallen(&run.simulation));
    findings.extend(run.sensors.findings(plan));
    if let Some(blows) = &run.blows {
        findings.extend(finding_of_blows(blows));
        findings.extend(blows.finding_of_range());
    }
    findings.extend(finding_of_account(closure, moved.large_closure));
    findings
}

/// That the energy account does not close.
///
/// * `large`: lack that is worth a word, on another engine
fn finding_of_account(closure: f64, large: Option<f64>) -> Option<FindingOutcome> {
    match large {
        Some(large) => (closure.abs() > large).then(|| engine_account(closure)),
        None => (closure.abs() > LARGE_CLOSURE).then(|| own_account(closure)),
    }
}

/// Lack of the account of a scene on windfall's own engine that is worth a word; 1.
const LARGE_CLOSURE: f64 = 0.01;

/// What a large lack of the account of windfall's own engine means.
fn own_account(closure: f64) -> FindingOutcome {
    FindingOutcome::new(
        "energy-account",
        format!(
            "the energy account lacks {:.1} % of what was lost: the time step is too long for this \
             scene; leave time_step out, ask for a smaller time_step_error, or give a shorter \
             time_step",
            100.0 * closure.abs()
        ),
    )
}

/// What a large lack of the account of another engine means.
fn engine_account(closure: f64) -> FindingOutcome {
    FindingOutcome::new(
        "engine-account",
        format!(
            "what the engine's motion lost and what the contacts took differ by {:.1} %: frames are \
             too far apart (--frame-steps), or the engine's contacts are not those of the scene",
            100.0 * closure.abs()
        ),
    )
}

/// Of each fruit the hardest that it suffered.
fn histograms_of(tally: &Tally, bruises: Option<&[Vec<Bruise>]>) -> Vec<HistogramOutcome> {
    let fruit = tally.fruit.iter();
    let forces = fruit
        .clone()
        .map(|own| own.hardest.map_or(0.0, |event| event.peak_force));
    let energies = fruit.map(|own| own.absorbed[0]);
    let mut all = vec![
        histogram(
            "largest peak force of a fruit",
            "N",
            &forces.collect::<Vec<f64>>(),
        ),
        histogram(
            "largest absorbed energy of a contact of a fruit",
            "J",
            &energies.collect::<Vec<f64>>(),
        ),
    ];
    if let Some(bruises) = bruises {
        let largest = |own: &Vec<Bruise>| own.iter().map(|own| own.volume).fold(0.0, f64::max);
        let volumes: Vec<f64> = bruises.iter().map(largest).collect();
        all.push(histogram("largest bruise of a fruit", "m^3", &volumes));
    }
    all.into_iter().flatten().collect()
}

/// Sets the time step where it is automatic; what it does to the stiffest contact, and the largest
/// errors of all.
pub fn time_step(plan: &mut ScenePlan) -> Result<StepOutcome, Error> {
    let scene = &plan.scene;
    let given = scene.time_step;
    let mut found = StepOutcome::default();
    let impacts: Vec<([usize; 2], Impact)> = scene
        .interactions
        .iter()
        .filter_map(|(&(a, b), own)| Some(([a, b], hardest(scene, [a, b], own)?)))
        .collect();
    for (between, impact) in &impacts {
        let (step, error) = match given > 0.0 {
            true => (given, checked_step(plan, impact, given, *between)?),
            false => impact.step_for(plan.time_step_error).map_err(stopped)?,
        };
        let worse = match given > 0.0 {
            true => error.peak > found.peak_force_error,
            false => step < found.time_step,
        };
        if found.time_step == 0.0 || worse {
            found = StepOutcome {
                time_step: step,
                between: between.map(|own| scene.materials[own].clone()),
                speed: impact.speed,
                contact_duration: error.duration,
                peak_force_error: error.peak,
                energy_error: error.energy,
            };
        }
    }
    if found.time_step == 0.0 {
        return Err(stopped(windfall_scene::error::Error::Value {
            what: "the number of contacts that can be",
            value: 0.0,
            problem: "nothing tells a time step: give time_step",
        }));
    }
    loop {
        let errors = impacts.iter().map(|(_, own)| own.error_of(found.time_step));
        let errors: Vec<StepError> = errors.collect::<Result<_, _>>().map_err(stopped)?;
        let largest = |of: fn(&StepError) -> f64| errors.iter().map(of).fold(0.0, f64::max);
        found.peak_force_error = largest(|own| own.peak);
        found.energy_error = largest(|own| own.energy);
        let most = found.peak_force_error.max(found.energy_error);
        // Errors do not fall steadily with the step: peaks lie between its ends.
        let shortest = found.time_step < SHORTEST * found.contact_duration;
        if given > 0.0 || most <= plan.time_step_error || shortest {
            break;
        }
        found.time_step *= SHORTER;
    }
    plan.scene.time_step = found.time_step;
    Ok(found)
}

/// The hardest impact of two materials that a scene may see: of the smallest fruit, as fast as
/// any can be, unless the law means nothing there.
fn hardest<'a>(
    scene: &Scene,
    [a, b]: [usize; 2],
    interaction: &'a Interaction,
) -> Option<Impact<'a>> {
    let smallest = |material: usize| {
        let own = scene.fruit.iter().filter(|own| own.material == material);
        own.min_by(|x, y| x.least_felt_mass().total_cmp(&y.least_felt_mass()))
    };
    // Of two fruit half the mass and half the radius move.
    let (fruit, share) = match (smallest(a), smallest(b)) {
        (Some(x), Some(y)) if x.least_felt_mass() < y.least_felt_mass() => (x, 0.5),
        (Some(_), Some(y)) => (y, 0.5),
        (Some(own), None) | (None, Some(own)) => (own, 1.0),
        (None, None) => return None,
    };
    let mut impact = Impact {
        interaction,
        radius: share * fruit.radius,
        mass: share * fruit.least_felt_mass(),
        speed: fastest(scene),
        shaking: hardest_shaking(scene, [a, b]),
    };
    // A wall may be faster somewhere than where fruit meet it.
    while impact.speed > LEAST_SPEED && !impact.is_shallow() {
        impact.speed = (0.5 * impact.speed).max(LEAST_SPEED);
    }
    Some(impact)
}

/// Of the walls of either material the vibration that accelerates most, as if along the normal.
fn hardest_shaking(scene: &Scene, materials: [usize; 2]) -> Option<Shaking> {
    let walls = scene.walls.iter();
    let moves = walls
        .filter(|own| materials.contains(&own.material))
        .flat_map(|own| &own.motion.moves);
    let shaking = moves.filter_map(|own| match &own.how {
        How::Vibration {
            amplitude,
            frequency,
        } => Some(Shaking {
            amplitude: length(*amplitude),
            frequency: frequency.abs(),
        }),
        _ => None,
    });
    let shakes = |own: &Shaking| own.acceleration() > 0.0;
    shaking
        .filter(shakes)
        .max_by(|x, y| x.acceleration().total_cmp(&y.acceleration()))
}

/// Slowest impact that a time step is chosen for; m/s.
const LEAST_SPEED: f64 = 0.5;

/// The speed at which a fruit can strike at most, by falling through the scene, with what it
/// brings along, and what a wall adds that comes towards it; m/s.
fn fastest(scene: &Scene) -> f64 {
    let gravity = length(scene.gravity);
    let height = |place: [f64; 3]| -dot(scene.gravity, place) / gravity.max(f64::MIN_POSITIVE);
    let top = scene.fruit.iter().map(|fruit| height(fruit.place));
    let top = top.fold(f64::NEG_INFINITY, f64::max);
    let lowest = scene.walls.iter().flat_map(|wall| wall.shape.skeleton().0);
    let bottom = lowest.map(height).fold(f64::INFINITY, f64::min);
    let drop = top - bottom
        + scene
            .walls
            .iter()
            .map(|own| lifted(own, height))
            .fold(0.0, f64::max);
    let fall = match drop.is_finite() {
        true => (2.0 * gravity * drop.max(0.0)).sqrt(),
        false => 0.0,
    };
    let brought = scene
        .fruit
        .iter()
        .map(|fruit| length(fruit.velocity))
        .fold(0.0, f64::max);
    let belts = scene.walls.iter().map(|wall| wall.motion.belt_speed());
    let ever = [f64::NEG_INFINITY, f64::INFINITY];
    let walls = scene.walls.iter().map(|wall| wall.largest_speed(ever));
    (fall + brought + walls.fold(0.0, f64::max))
        .max(belts.fold(0.0, f64::max))
        .max(LEAST_SPEED)
}

/// How far a point of a wall has been lifted at the end of any of its moves; m.
fn lifted(wall: &Wall, height: impl Fn([f64; 3]) -> f64) -> f64 {
    let ends = wall.motion.moves.iter().map(|own| own.when.until);
    let corners = wall.shape.skeleton().0;
    let rises = ends.filter(|own| own.is_finite()).flat_map(|end| {
        let (turn, shift) = wall.motion.pose(end);
        let height = &height;
        let risen = |own: &[f64; 3]| height(add(turned(turn, *own), shift)) - height(*own);
        corners.iter().map(risen).collect::<Vec<f64>>()
    });
    rises.fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_account_that_does_not_close_is_told_on_every_engine() {
        let code = |closure, large| finding_of_account(closure, large).map(|own| own.code);
        for sign in [-1.0, 1.0] {
            assert_eq!(code(0.009 * sign, None), None);
            assert_eq!(code(0.011 * sign, None).as_deref(), Some("energy-account"));
            assert_eq!(code(0.019 * sign, Some(0.02)), None);
            let other = code(0.021 * sign, Some(0.02));
            assert_eq!(other.as_deref(), Some("engine-account"));
        }
    }
}
