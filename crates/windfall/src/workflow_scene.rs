//! A scene from its file to the contacts of each fruit.

use crate::engine_kind::Engine;
use crate::error::Error;
use crate::on_threads::on_threads;
use crate::outcome::FindingOutcome;
use crate::progress::Progress;
use crate::read_scene::{ScenePlan, read_scene};
use crate::scene_bruise::Blows;
use crate::scene_outcome::{PartnerOutcome, SceneOutcome, StepOutcome, Tally, findings_of_range};
use crate::write_file::write_whole;
use crate::write_scene::{EventFile, fruit_table};
use std::path::{Path, PathBuf};
use windfall_scene::energy::Energy;
use windfall_scene::event::Event;
use windfall_scene::scene::Scene;
use windfall_scene::simulation::Simulation;
use windfall_scene::time_step::Impact;
use windfall_scene::vector::{add, dot, length};
use windfall_scene::wall::Shape;

/// What may be asked for besides the file.
#[derive(Clone, Debug, Default)]
pub struct SceneRequest {
    /// Directory to write into; beside the file where it is left out.
    pub out: Option<PathBuf>,
    /// Number of threads; all cores where it is left out.
    pub threads: Option<usize>,
}

/// What moves the fruit of a scene.
pub(crate) trait Mover {
    /// One step on, or one frame; with energies where they are asked for.
    fn step(&mut self, simulation: &mut Simulation, energy: bool) -> Result<Energy, Error>;

    /// Its own time steps in one.
    fn steps(&self) -> u64;
}

/// The engine of this program.
struct Own;

impl Mover for Own {
    fn step(&mut self, simulation: &mut Simulation, energy: bool) -> Result<Energy, Error> {
        let energy = match energy {
            true => simulation.step_with_energy(),
            false => simulation.step().map(|()| Energy::default()),
        };
        energy.map_err(stopped)
    }

    fn steps(&self) -> u64 {
        1
    }
}

/// What moves the fruit, and what is to be said of it.
pub(crate) struct Moved<'a> {
    pub mover: &'a mut (dyn Mover + Send),
    pub step: StepOutcome,
    pub engine: String,
    pub findings: Vec<FindingOutcome>,
    /// Lack of the energy account that is worth a word, where it is; 1.
    pub large_closure: Option<f64>,
}

/// Steps between looks at events and progress.
const CHUNK: u64 = 64;

/// Runs a scene and writes the contacts and the fruit into a directory.
///
/// * `progress`: steps done, and all; where it does not go on nothing is kept
///
/// # Errors
/// The file cannot be used; the result would mean nothing; the directory cannot be written.
pub fn run_scene(
    path: &Path,
    request: &SceneRequest,
    progress: Progress,
) -> Result<SceneOutcome, Error> {
    let mut plan = read_scene(path)?;
    let step = time_step(&mut plan)?;
    let moved = Moved {
        mover: &mut Own,
        step,
        engine: Engine::Windfall.title().to_owned(),
        findings: Vec::new(),
        large_closure: None,
    };
    on_threads(request.threads, || {
        run_moved(path, plan, moved, request, progress)
    })
}

/// Where the results of a scene go.
pub(crate) fn directory_of(path: &Path, request: &SceneRequest) -> PathBuf {
    let out = request.out.clone();
    out.unwrap_or_else(|| path.with_extension("run"))
}

pub(crate) fn run_moved(
    path: &Path,
    mut plan: ScenePlan,
    moved: Moved,
    request: &SceneRequest,
    progress: Progress,
) -> Result<SceneOutcome, Error> {
    let mover = moved.mover;
    let out = directory_of(path, request);
    std::fs::create_dir_all(&out).map_err(|source| Error::FileAccess {
        path: out.clone(),
        action: "create",
        source,
    })?;
    let mut simulation = Simulation::new(plan.scene.clone()).map_err(stopped)?;
    // Fruit are numbered in the order in which they come.
    plan.scene = simulation.scene().clone();
    let all = (plan.end / plan.scene.time_step).ceil() as u64;
    let mut file = EventFile::create(&out.join("events.csv"), &plan.scene, plan.least_peak_force)?;
    let mut tally = Tally::new(&plan.scene);
    let mut blows = plan
        .bruise
        .as_ref()
        .map(|bruise| Blows::new(bruise, &plan.scene, &plan.fruit_shares));
    let mut count = |event: &Event, tally: &mut Tally, file: &mut EventFile| {
        tally.count(event);
        if let Some(blows) = &mut blows {
            blows.count(event);
        }
        file.write(event)
    };
    let first = mover.step(&mut simulation, true)?;
    while simulation.steps() < all {
        for _ in 0..CHUNK.min(all - simulation.steps()) {
            mover.step(&mut simulation, false)?;
        }
        for event in simulation.take_events() {
            count(&event, &mut tally, &mut file)?;
        }
        for leaving in simulation.take_leavings() {
            tally.leave(&leaving);
        }
        if progress(simulation.steps() as usize, all as usize).is_break() {
            return Err(Error::Cancelled);
        }
    }
    let last = mover.step(&mut simulation, true)?;
    for event in simulation.lasting() {
        count(&event, &mut tally, &mut file)?;
    }
    let written = file.finish()?;
    let fruit = out.join("fruit.csv");
    let states = simulation.fruit();
    let bruised = plan.bruise.as_ref().zip(blows.as_ref());
    let bruises = bruised.map(|(bruise, blows)| blows.bruises(bruise));
    let table = fruit_table(&plan, &tally, &states, bruises.as_deref())?;
    write_whole(&fruit, table.as_bytes())?;
    let energy_closure =
        (last.closure() - first.closure()) / last.lost().abs().max(f64::MIN_POSITIVE);
    let mut findings = moved.findings;
    findings.extend(findings_of_range(&plan, &tally, simulation.waiting()));
    let large = moved.large_closure.unwrap_or(f64::INFINITY);
    if energy_closure.abs() > large {
        findings.push(account(energy_closure));
    }
    let outcome = SceneOutcome {
        title: plan.title.clone(),
        end: plan.end,
        engine: moved.engine,
        step: moved.step,
        steps: all * mover.steps(),
        fruit: plan.scene.fruit.len(),
        waiting: simulation.waiting(),
        left: tally.left(),
        contacts: tally.contacts,
        written,
        partners: PartnerOutcome::of(&plan.scene, &tally),
        bruise: bruised.map(|(bruise, blows)| blows.outcome(bruise, &plan.scene)),
        energy: (&last).into(),
        energy_closure,
        findings,
        files: vec![out.join("events.csv"), fruit, out.join("scene.json")],
    };
    let json = serde_json::to_string_pretty(&outcome).map_err(|error| Error::ResultUnwritable {
        item: plan.title.clone(),
        detail: error.to_string(),
    })?;
    write_whole(&out.join("scene.json"), (json + "\n").as_bytes())?;
    Ok(outcome)
}

/// What a large lack of the account of another engine means.
fn account(closure: f64) -> FindingOutcome {
    FindingOutcome {
        code: "engine-account".to_owned(),
        message: format!(
            "what the engine's motion lost and what the contacts took differ by {:.1} %: frames are \
             too far apart (--frame-steps), or the engine's contacts are not those of the scene",
            100.0 * closure.abs()
        ),
    }
}

pub(crate) fn stopped(problem: windfall_scene::error::Error) -> Error {
    Error::SceneStopped(Box::new(problem))
}

/// Sets the time step where it is automatic; what it does to the stiffest contact.
pub(crate) fn time_step(plan: &mut ScenePlan) -> Result<StepOutcome, Error> {
    let scene = &plan.scene;
    let speed = fastest(scene);
    let given = scene.time_step;
    let mut found = StepOutcome::default();
    for (&(a, b), interaction) in &scene.interactions {
        let smallest = |material: usize| {
            let own = scene
                .fruit
                .iter()
                .filter(|fruit| fruit.material == material);
            own.min_by(|x, y| x.mass.total_cmp(&y.mass))
        };
        // Of two fruit half the mass and half the radius move.
        let Some((fruit, share)) = (match (smallest(a), smallest(b)) {
            (Some(x), Some(y)) => Some((if x.mass < y.mass { x } else { y }, 0.5)),
            (own, None) | (None, own) => own.map(|own| (own, 1.0)),
        }) else {
            continue;
        };
        let impact = Impact {
            interaction,
            radius: share * fruit.radius,
            mass: share * fruit.mass,
            speed,
        };
        let (step, error) = match given > 0.0 {
            true => (given, impact.error_of(given).map_err(stopped)?),
            false => impact.step_for(plan.time_step_error).map_err(stopped)?,
        };
        let own = StepOutcome {
            time_step: step,
            between: [scene.materials[a].clone(), scene.materials[b].clone()],
            speed,
            contact_duration: error.duration,
            peak_force_error: error.peak,
            energy_error: error.energy,
        };
        let worse = match given > 0.0 {
            true => error.peak > found.peak_force_error,
            false => step < found.time_step,
        };
        if found.time_step == 0.0 || worse {
            found = own;
        }
    }
    if found.time_step == 0.0 {
        return Err(stopped(windfall_scene::error::Error::Value {
            what: "the number of contacts that can be",
            value: 0.0,
            problem: "nothing tells a time step: give time_step",
        }));
    }
    plan.scene.time_step = found.time_step;
    Ok(found)
}

/// Slowest impact that a time step is chosen for; m/s.
const LEAST_SPEED: f64 = 0.5;

/// The speed that a fruit can have at most by falling through the scene, or brings along; m/s.
fn fastest(scene: &Scene) -> f64 {
    let gravity = length(scene.gravity);
    let height = |place: [f64; 3]| -dot(scene.gravity, place) / gravity.max(f64::MIN_POSITIVE);
    let top = scene.fruit.iter().map(|fruit| height(fruit.place));
    let top = top.fold(f64::NEG_INFINITY, f64::max);
    let mut bottom = f64::INFINITY;
    for wall in &scene.walls {
        match &wall.shape {
            Shape::Plane { point, .. } => bottom = bottom.min(height(*point)),
            Shape::Plates(plates) => {
                for plate in plates {
                    for corner in plate.corners() {
                        bottom = bottom.min(height(corner));
                    }
                }
            }
            Shape::Cylinder { start, end, .. } => {
                bottom = bottom.min(height(*start)).min(height(*end));
            }
            Shape::Mesh { triangles } => {
                for corner in triangles.iter().flatten() {
                    bottom = bottom.min(height(*corner));
                }
            }
        }
    }
    let fall = match (top - bottom).is_finite() {
        true => (2.0 * gravity * (top - bottom).max(0.0)).sqrt(),
        false => 0.0,
    };
    let brought = scene
        .fruit
        .iter()
        .map(|fruit| length(fruit.velocity))
        .fold(0.0, f64::max);
    let belts = scene
        .walls
        .iter()
        .map(|wall| length(add(wall.motion.velocity, wall.motion.surface_velocity)));
    (fall + brought)
        .max(belts.fold(0.0, f64::max))
        .max(LEAST_SPEED)
}
