//! scene.toml → a scene.

use crate::file::bruise::{BruisePlan, bruise_of};
use crate::file::change::set_value;
use crate::file::contacts::contacts_of;
use crate::file::fruit::fruit_of;
use crate::file::key::{Section, check_names};
use crate::file::moves::add_moves;
use crate::file::periodic::{check_periodic, periodic_of};
use crate::file::properties::{in_order, with_properties};
use crate::file::record::{RecordPlan, record_of};
use crate::file::room::{check_room, drawn_fruit};
use crate::file::scene::{AirFile, GravityFile, SceneFile};
use crate::file::sensors::{Kinds, SensorsPlan, sensors_of};
use crate::file::walls::wall_of;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use toml_edit::{DocumentMut, TomlError};
use windfall_campaign::settings::files::check_format;
use windfall_campaign::settings::rig::STANDARD_GRAVITY;
use windfall_cards::law_card::LawCard;
use windfall_files::confined::named_beside;
use windfall_files::error::{Error, Place};
use windfall_files::found::FindingOutcome;
use windfall_files::option_value::unusable;
use windfall_files::text::spanned::Spanned;
use windfall_files::text::toml_source::{TomlSource, parse_source, place_at, read_piped_source};
use windfall_scene::scene::{Air, Scene, Sink};
use windfall_scene::vector::{Vector, scaled};

/// A scene as its file says, ready to run but for an automatic time step.
#[derive(Clone, Debug)]
pub struct ScenePlan {
    /// Title.
    pub title: String,
    /// The scene; its time step is 0 where it is automatic.
    pub scene: Scene,
    /// Names of the kinds of fruit, and how many of each.
    pub kinds: Vec<(String, usize)>,
    /// Law cards by the pair of materials, where laws come from cards.
    pub cards: BTreeMap<(usize, usize), LawCard>,
    /// Part of the absorbed energy that a fruit takes, by the pair of materials, where the
    /// file says so; 1.
    pub fruit_shares: BTreeMap<(usize, usize), f64>,
    /// Error that an automatic time step may make; 1.
    pub time_step_error: f64,
    /// When it ends; s.
    pub end: f64,
    /// Contacts with a smaller peak force are counted, not written; N.
    pub least_peak_force: f64,
    /// Recorded frames.
    pub record: RecordPlan,
    /// What looks at the fruit.
    pub sensors: SensorsPlan,
    /// How contacts bruise, where the file says so.
    pub bruise: Option<BruisePlan>,
    /// The time step of the file, and its place.
    pub given_step: Option<(Place, String)>,
    /// Findings before the run.
    pub findings: Vec<FindingOutcome>,
    /// Time of the scene between checkpoints, where there are any; s.
    pub checkpoint: Option<f64>,
    /// Seed of all draws.
    pub seed: u64,
    /// The run at whose end it begins, where it does.
    pub start: Option<StartPlan>,
}

impl ScenePlan {
    /// Time steps between checkpoints, where there are any.
    pub fn checkpoint_steps(&self) -> Option<u64> {
        let steps = |own: f64| (own / self.scene.time_step).round().max(1.0) as u64;
        self.checkpoint.map(steps)
    }
}

/// The end of a run, where another one begins.
#[derive(Clone, Debug)]
pub struct StartPlan {
    /// As the file has it.
    pub name: String,
    /// Where the file names it.
    pub place: Place,
    /// The directory of that run.
    pub directory: PathBuf,
    /// When that run ended; s. 0 until it is read.
    pub time: f64,
}

/// Reads a scene and draws its fruit.
///
/// # Errors
/// The file cannot be read, says something that cannot be, or lacks what is needed; the
/// message names file, line and key.
pub fn read_scene(path: &Path) -> Result<ScenePlan, Error> {
    scene_of(&read_piped_source(
        path,
        "`windfall new scene DIR` writes a template",
    )?)
}

/// [`read_scene`] with other values than the file has; what was changed is a finding.
///
/// * `set`: each as KEY=VALUE, such as "walls.edge.material=foam"; a value that is no TOML is a text
///
/// # Errors
/// Those of [`read_scene`]; a change has no such key, or leads to a scene that cannot be.
pub fn read_changed_scene(path: &Path, set: &[String]) -> Result<ScenePlan, Error> {
    let mut source = read_piped_source(path, "`windfall new scene DIR` writes a template")?;
    if set.is_empty() {
        return scene_of(&source);
    }
    // What is no scene at all is told with its line, before anything is changed.
    let _: SceneFile = parse_source(&source)?;
    let refused = |change: &str, problem: String| unusable(format!("--set {change}"), problem);
    let mut document: DocumentMut = source
        .text
        .parse()
        .map_err(|error: TomlError| refused(&set.join(" "), error.to_string()))?;
    for change in set {
        let Some((key, text)) = change.split_once('=') else {
            let problem = "expected KEY=VALUE, such as scene.seed=7 or walls.floor.material=foam";
            return Err(refused(change, problem.to_owned()));
        };
        set_value(&mut document, key.trim(), &value_of(text.trim()))
            .map_err(|problem| refused(change, problem))?;
    }
    source.text = document.to_string();
    let mut plan =
        scene_of(&source).map_err(|error| refused(&set.join(" --set "), error.to_string()))?;
    let changes = set.join(", ");
    let message = format!("the scene is not as its file says: {changes} (--set)");
    plan.findings
        .push(FindingOutcome::new("changed-scene", message));
    Ok(plan)
}

/// A value of TOML; any other text is one.
fn value_of(text: &str) -> toml::Value {
    let table = toml::from_str::<toml::Table>(&format!("value = {text}"));
    let table = table.ok().filter(|own| own.len() == 1);
    let value = table.and_then(|mut own| own.remove("value"));
    value.unwrap_or_else(|| toml::Value::String(text.to_owned()))
}

/// [`read_scene`] of a text; files that it names lie beside its path.
pub fn scene_of(source: &TomlSource) -> Result<ScenePlan, Error> {
    let file: SceneFile = parse_source(source)?;
    check_names(source)?;
    check_format(source, file.format.as_ref())?;
    let whole = section(source, "the file");
    let materials = materials(&whole, &file)?;
    let contacts = contacts_of(source, &file.contacts, &materials)?;
    let mut kinds = Vec::new();
    let mut names = Vec::new();
    for fruit in &file.fruit {
        let (name, kind) = fruit_of(source, fruit, &materials)?;
        names.push((name, kind.count));
        kinds.push(kind);
    }
    if kinds.is_empty() {
        return Err(whole.lacks("[[fruit]]", "which fruit come, and how", "[[fruit]]"));
    }
    let (mut walls, mut findings) = (Vec::new(), Vec::new());
    for wall in &file.walls {
        let wall = wall_of(source, wall, (&materials, &walls), &mut findings)?;
        walls.push(wall);
    }
    let seed = file.scene.seed.unwrap_or(1);
    let fruit = drawn_fruit(source, &file, &kinds, seed)?;
    // In the order in which they come, which is that of their numbers.
    let (fruit, kind_of) = in_order(fruit, &kinds);
    let table = section(source, "[scene]");
    let timing = timing(&table, &file)?;
    add_moves(source, &file.moves, &mut walls, timing.end)?;
    let bruise = file.bruise.as_ref().map(|bruise| {
        let plan = bruise_of(source, bruise, &file.fruit, seed)?;
        with_properties(source, &file, plan, &kind_of)
    });
    let bruise = bruise.transpose()?;
    let scene = Scene {
        materials,
        interactions: contacts.interactions,
        walls,
        fruit,
        sinks: sinks(&file),
        gravity: gravity(&table, file.scene.gravity.as_ref())?,
        air: file
            .air
            .as_ref()
            .map(|air| air_of(source, air))
            .transpose()?,
        periodic: periodic_of(&table, &file)?,
        time_step: timing.step,
    };
    check_periodic(&table, &file, &scene)?;
    // An automatic step is found later.
    let checked = Scene {
        time_step: if timing.step == 0.0 { 1.0 } else { timing.step },
        ..scene.clone()
    };
    checked.check().map_err(|problem| Error::Refused {
        place: place_at(source, &file.materials.span()),
        problem: problem.to_string(),
    })?;
    check_room(source, &file, &scene, &names)?;
    let of_kinds = Kinds {
        names: &names,
        kind_of: &kind_of,
        fruit: &scene.fruit,
    };
    let sensors = sensors_of(source, &file.sensors, &of_kinds, timing.end)?;
    let title = file.scene.title.clone();
    Ok(ScenePlan {
        title: title.unwrap_or_else(|| source.path.display().to_string()),
        scene,
        kinds: names,
        cards: contacts.cards,
        fruit_shares: contacts.fruit_shares,
        time_step_error: timing.error,
        end: timing.end,
        least_peak_force: timing.least_peak_force,
        record: record_of(source, &file.record)?,
        sensors,
        bruise,
        given_step: timing.given,
        findings,
        checkpoint: checkpoint(&table, &file)?,
        seed,
        start: file
            .scene
            .start
            .as_ref()
            .map(|own| start_of(&table, own))
            .transpose()?,
    })
}

/// Name in the directory of a run of the state at its end.
pub const END_FILE: &str = "end.bin";

fn start_of(table: &Section, name: &Spanned<String>) -> Result<StartPlan, Error> {
    let text = name.get_ref();
    let directory = table.source.path.with_file_name(text);
    let wrong = |problem: String| table.refused(&name.span(), "start", text, problem);
    if !directory.join(END_FILE).exists() {
        return Err(wrong(format!(
            "{} holds no end of a run ({END_FILE}): it is the directory of results of another scene, \
             which `windfall scene run` writes unless that scene has checkpoint = \"never\"",
            directory.display()
        )));
    }
    named_beside(&table.source.path, &format!("{text}/{END_FILE}")).map_err(wrong)?;
    Ok(StartPlan {
        name: text.clone(),
        place: place_at(table.source, &name.span()),
        directory,
        time: 0.0,
    })
}

/// A table of which there is one; messages name the beginning of the file.
fn section<'a>(source: &'a TomlSource, name: &'static str) -> Section<'a> {
    let at = 0..0;
    Section { source, name, at }
}

/// Time between checkpoints where the file does not say; s.
const DEFAULT_CHECKPOINT: f64 = 0.5;

fn checkpoint(table: &Section, file: &SceneFile) -> Result<Option<f64>, Error> {
    let Some(value) = &file.scene.checkpoint else {
        return Ok(Some(DEFAULT_CHECKPOINT));
    };
    let text = value.get_ref().0.trim();
    if text == "never" {
        return Ok(None);
    }
    let time = table.given(value, "checkpoint", "s")?;
    match time > 0.0 && time.is_finite() {
        true => Ok(Some(time)),
        false => {
            let problem = "it must be a time above zero, or \"never\"";
            Err(table.refused(&value.span(), "checkpoint", text, problem))
        }
    }
}

/// When a scene ends, its step, and what is written.
struct Timing {
    /// 0 where it is automatic; s.
    step: f64,
    /// Where it stands, and how.
    given: Option<(Place, String)>,
    error: f64,
    end: f64,
    least_peak_force: f64,
}

fn timing(table: &Section, file: &SceneFile) -> Result<Timing, Error> {
    let source = table.source;
    let step = file.scene.time_step.as_ref();
    let step = step.filter(|step| step.get_ref().0.trim() != "auto");
    let given = step.map(|own| (place_at(source, &own.span()), own.get_ref().0.clone()));
    let step = table
        .above_zero(&step.cloned(), "time_step", "s")?
        .unwrap_or(0.0);
    let Some(end) = table.above_zero(&file.scene.end, "end", "s")? else {
        return Err(table.lacks("end", "when the scene ends", "end = \"3 s\""));
    };
    let error = table.above_zero(&file.scene.time_step_error, "time_step_error", "1")?;
    let least = &file.events.least_peak_force;
    let least = section(source, "[events]").at_least_zero(least, "least_peak_force", "N")?;
    Ok(Timing {
        step,
        given,
        error: error.unwrap_or(DEFAULT_ERROR),
        end,
        least_peak_force: least.unwrap_or(0.0),
    })
}

/// Error that an automatic time step may make where the file does not say; 1.
const DEFAULT_ERROR: f64 = 2e-3;

fn materials(whole: &Section, file: &SceneFile) -> Result<Vec<String>, Error> {
    let mut names: Vec<String> = Vec::new();
    for name in file.materials.get_ref() {
        let own = name.get_ref();
        if names.contains(own) {
            let problem = "this name stands there twice";
            return Err(whole.refused(&name.span(), "materials", own, problem));
        }
        names.push(own.clone());
    }
    Ok(names)
}

fn sinks(file: &SceneFile) -> Vec<Sink> {
    let sink = |(number, sink): (usize, &Spanned<crate::file::scene::SinkFile>)| {
        let own = sink.get_ref();
        Sink {
            name: own
                .name
                .clone()
                .unwrap_or_else(|| format!("sink {}", number + 1)),
            low: own.low,
            high: own.high,
        }
    };
    file.sinks.iter().enumerate().map(sink).collect()
}

fn gravity(table: &Section, file: Option<&Spanned<GravityFile>>) -> Result<Vector, Error> {
    let Some(file) = file else {
        return Ok([0.0, 0.0, -STANDARD_GRAVITY]);
    };
    match file.get_ref() {
        GravityFile::Vector(own) => Ok(*own),
        GravityFile::Down(text) => {
            let text = Some(Spanned::new(file.span(), text.clone()));
            let size = table.optional(&text, "gravity", "m/s^2")?.unwrap_or(0.0);
            match size >= 0.0 {
                true => Ok(scaled([0.0, 0.0, -1.0], size)),
                false => {
                    let problem = "a number is the size of a gravity that points down; another \
                                   direction is a vector, such as [0, 0, 9.8]";
                    Err(table.refused(&file.span(), "gravity", size, problem))
                }
            }
        }
    }
}

fn air_of(source: &TomlSource, air: &Spanned<AirFile>) -> Result<Air, Error> {
    let file = air.get_ref();
    let table = section(source, "[air]");
    let density = table.at_least_zero(&file.density, "density", "kg/m^3")?;
    let drag = table.number_from_zero(&file.drag_coefficient, "drag_coefficient")?;
    Ok(Air {
        density: density.unwrap_or(1.2),
        drag_coefficient: drag.unwrap_or(0.47),
    })
}
