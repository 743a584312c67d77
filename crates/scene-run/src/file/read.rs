//! scene.toml → a scene.

use crate::file::bruise::{BruisePlan, bruise_of};
use crate::file::card::spread_of_card;
use crate::file::fruit::fruit_of;
use crate::file::key::{material, needed};
use crate::file::properties::{in_order, with_properties};
use crate::file::record::{RecordPlan, record_of};
use crate::file::room::{check_room, drawn_fruit};
use crate::file::scene::{AirFile, ContactFile, GravityFile, SceneFile};
use crate::file::walls::wall_of;
use std::collections::BTreeMap;
use std::path::Path;
use toml::Spanned;
use windfall_campaign::settings::files::check_format;
use windfall_campaign::settings::rig::STANDARD_GRAVITY;
use windfall_cards::law_card::LawCard;
use windfall_cards::law_use::complete_law_among;
use windfall_cards::read_card::{law_of_card, read_card};
use windfall_files::error::{Error, Place};
use windfall_files::found::FindingOutcome;
use windfall_files::text::toml_source::{
    TomlSource, invalid, missing, optional_quantity, parse_source, place_at, read_source,
};
use windfall_scene::annuli::MOST_ANNULI;
use windfall_scene::interaction::{Interaction, mindlin_ratio};
use windfall_scene::scene::{Air, Scene, Sink};
use windfall_scene::shape::wall::Wall;
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
    /// What is kept to be seen.
    pub record: RecordPlan,
    /// How contacts bruise, where the file says so.
    pub bruise: Option<BruisePlan>,
    /// Where the file gives a time step, and what stands there.
    pub given_step: Option<(Place, String)>,
    /// What is to be known of the scene before it runs.
    pub findings: Vec<FindingOutcome>,
    /// Time of the scene between checkpoints, where there are any; s.
    pub checkpoint: Option<f64>,
    /// Seed of all draws.
    pub seed: u64,
}

/// Reads a scene and draws its fruit.
///
/// # Errors
/// The file cannot be read, says something that cannot be, or lacks what is needed; the
/// message names file, line and key.
pub fn read_scene(path: &Path) -> Result<ScenePlan, Error> {
    scene_of(&read_source(
        path,
        "`windfall new scene DIR` writes a template",
    )?)
}

/// [`read_scene`] of a text; files that it names lie beside its path.
///
/// # Errors
/// As [`read_scene`].
pub fn scene_of(source: &TomlSource) -> Result<ScenePlan, Error> {
    let file: SceneFile = parse_source(source)?;
    check_format(source, file.format.as_ref())?;
    let materials = materials(source, &file)?;
    let contacts = contacts(source, &file, &materials)?;
    let mut kinds = Vec::new();
    let mut names = Vec::new();
    for fruit in &file.fruit {
        let (name, kind) = fruit_of(source, fruit, &materials)?;
        names.push((name, kind.count));
        kinds.push(kind);
    }
    if kinds.is_empty() {
        let fruit = needed(
            "the file",
            "[[fruit]]",
            "which fruit come, and how",
            "",
            "[[fruit]]",
        );
        return Err(missing(source, &(0..0), &fruit, fruit.table.to_owned()));
    }
    let walls = file.walls.iter();
    let mut findings = Vec::new();
    let walls = walls.map(|wall| wall_of(source, wall, &materials, &mut findings));
    let walls: Vec<Wall> = walls.collect::<Result<_, _>>()?;
    let seed = file.scene.seed.unwrap_or(1);
    let fruit = drawn_fruit(source, &file, &kinds, seed)?;
    // In the order in which they come, which is that of their numbers.
    let (fruit, kind_of) = in_order(fruit, &kinds);
    let timing = timing(source, &file)?;
    let bruise = file
        .bruise
        .as_ref()
        .map(|bruise| bruise_of(source, bruise, &file.fruit, seed))
        .transpose()?;
    let bruise = match bruise {
        Some(plan) => Some(with_properties(source, &file, plan, &kind_of)?),
        None => None,
    };
    let scene = Scene {
        materials,
        interactions: contacts.interactions,
        walls,
        fruit,
        sinks: sinks(&file),
        gravity: gravity(source, file.scene.gravity.as_ref())?,
        air: file
            .air
            .as_ref()
            .map(|air| air_of(source, air))
            .transpose()?,
        time_step: timing.step,
    };
    // An automatic step is found later.
    let checked = Scene {
        time_step: if timing.step == 0.0 { 1.0 } else { timing.step },
        ..scene.clone()
    };
    checked
        .check()
        .map_err(|problem| scene_error(source, &file, &problem))?;
    check_room(source, &file, &scene, &names)?;
    Ok(ScenePlan {
        title: file
            .scene
            .title
            .clone()
            .unwrap_or_else(|| source.path.display().to_string()),
        scene,
        kinds: names,
        cards: contacts.cards,
        fruit_shares: contacts.fruit_shares,
        time_step_error: timing.error,
        end: timing.end,
        least_peak_force: timing.least_peak_force,
        record: record_of(source, &file.record)?,
        bruise,
        given_step: timing.given,
        findings,
        checkpoint: checkpoint(source, &file)?,
        seed,
    })
}

/// Time between checkpoints where the file does not say; s.
const DEFAULT_CHECKPOINT: f64 = 0.5;

fn checkpoint(source: &TomlSource, file: &SceneFile) -> Result<Option<f64>, Error> {
    let Some(value) = &file.scene.checkpoint else {
        return Ok(Some(DEFAULT_CHECKPOINT));
    };
    let text = value.get_ref().0.trim();
    if text == "never" {
        return Ok(None);
    }
    let key = needed(
        "[scene]",
        "checkpoint",
        "time of the scene between checkpoints",
        "s",
        "checkpoint = \"0.5 s\"   or   \"never\"",
    );
    let time = optional_quantity(source, Some(value), &key)?;
    match time.filter(|time| *time > 0.0 && time.is_finite()) {
        Some(time) => Ok(Some(time)),
        None => {
            let problem = "it must be a time above zero, or \"never\"".to_owned();
            let key = ("[scene]", "checkpoint");
            Err(invalid(source, &value.span(), key, text, problem))
        }
    }
}

/// What `[[contacts]]` say, by the pair of materials.
#[derive(Default)]
struct Contacts {
    interactions: BTreeMap<(usize, usize), Interaction>,
    cards: BTreeMap<(usize, usize), LawCard>,
    fruit_shares: BTreeMap<(usize, usize), f64>,
}

fn contacts(
    source: &TomlSource,
    file: &SceneFile,
    materials: &[String],
) -> Result<Contacts, Error> {
    let mut all = Contacts::default();
    for contact in &file.contacts {
        let (pair, interaction, card) = contact_of(source, contact, materials)?;
        if all.interactions.insert(pair, interaction).is_some() {
            let problem = "these two materials stand in more than one [[contacts]]".to_owned();
            let names = format!("{}, {}", materials[pair.0], materials[pair.1]);
            let at = contact.span();
            return Err(invalid(
                source,
                &at,
                ("[[contacts]]", "between"),
                &names,
                problem,
            ));
        }
        all.cards.extend(card.map(|card| (pair, card)));
        if let Some(share) = &contact.get_ref().fruit_share {
            let value = *share.get_ref();
            if !(0.0..=1.0).contains(&value) {
                let problem = "a share lies between 0 and 1".to_owned();
                let key = ("[[contacts]]", "fruit_share");
                return Err(invalid(
                    source,
                    &share.span(),
                    key,
                    &value.to_string(),
                    problem,
                ));
            }
            all.fruit_shares.insert(pair, value);
        }
    }
    Ok(all)
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

fn timing(source: &TomlSource, file: &SceneFile) -> Result<Timing, Error> {
    let time = |value, key, meaning, example| {
        optional_quantity(
            source,
            value,
            &needed("[scene]", key, meaning, "s", example),
        )
    };
    let automatic = |step: &&Spanned<_>| {
        let step: &Spanned<windfall_files::text::file_quantity::QuantityText> = step;
        step.get_ref().0.trim() == "auto"
    };
    let step = file
        .scene
        .time_step
        .as_ref()
        .filter(|step| !automatic(step));
    let given = step.map(|own| (place_at(source, &own.span()), own.get_ref().0.clone()));
    let step = time(step, "time_step", "time step", "time_step = \"20 us\"")?.unwrap_or(0.0);
    let end = time(
        file.scene.end.as_ref(),
        "end",
        "when the scene ends",
        "end = \"3 s\"",
    )?;
    let Some(end) = end.filter(|end| *end > 0.0 && end.is_finite()) else {
        let key = needed(
            "[scene]",
            "end",
            "when the scene ends, above zero",
            "s",
            "end = \"3 s\"",
        );
        return Err(missing(source, &(0..0), &key, key.table.to_owned()));
    };
    let share = needed(
        "[scene]",
        "time_step_error",
        "error",
        "1",
        "time_step_error = \"0.2 %\"",
    );
    let error = optional_quantity(source, file.scene.time_step_error.as_ref(), &share)?;
    let force = needed(
        "[events]",
        "least_peak_force",
        "force",
        "N",
        "least_peak_force = \"1 N\"",
    );
    let least = optional_quantity(source, file.events.least_peak_force.as_ref(), &force)?;
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

/// What is wrong with the scene as a whole, told of the file.
fn scene_error(
    source: &TomlSource,
    file: &SceneFile,
    problem: &windfall_scene::error::Error,
) -> Error {
    Error::Refused {
        place: place_at(source, &file.materials.span()),
        problem: problem.to_string(),
    }
}

fn materials(source: &TomlSource, file: &SceneFile) -> Result<Vec<String>, Error> {
    let mut names: Vec<String> = Vec::new();
    for name in file.materials.get_ref() {
        if names.contains(name.get_ref()) {
            let problem = "this name stands there twice".to_owned();
            let at = name.span();
            return Err(invalid(
                source,
                &at,
                ("the file", "materials"),
                name.get_ref(),
                problem,
            ));
        }
        names.push(name.get_ref().clone());
    }
    Ok(names)
}

type Found = ((usize, usize), Interaction, Option<LawCard>);

fn contact_of(
    source: &TomlSource,
    contact: &Spanned<ContactFile>,
    materials: &[String],
) -> Result<Found, Error> {
    const TABLE: &str = "[[contacts]]";
    let (file, at) = (contact.get_ref(), contact.span());
    let Some(between) = &file.between else {
        let key = needed(
            TABLE,
            "between",
            "the two materials",
            "",
            "between = [\"apple\", \"steel\"]",
        );
        return Err(missing(source, &at, &key, TABLE.to_owned()));
    };
    let [a, b] = between.get_ref();
    let own = |name| material(source, &between.span(), (TABLE, "between"), name, materials);
    let (a, b) = (own(a)?, own(b)?);
    let radius = needed(
        TABLE,
        "effective_radius",
        "R*",
        "m",
        "effective_radius = \"37.5 mm\"",
    );
    let mut seen = optional_quantity(source, file.effective_radius.as_ref(), &radius)?;
    let mut card = None;
    let mut spread = None;
    let law = match (&file.card, &file.law) {
        (Some(name), None) => {
            let path = source.path.with_file_name(name.get_ref());
            let own = read_card(&path)?;
            let law = law_of_card(&own, &path)?;
            seen = seen.or(own.contact.as_ref().map(|contact| contact.effective_radius));
            spread = spread_of_card(&own, &law, &path)?;
            card = Some(own);
            law
        }
        (None, Some(law)) => complete_law_among(law.get_ref(), &[]).map_err(|error| {
            invalid(
                source,
                &law.span(),
                (TABLE, "law"),
                law.get_ref(),
                error.to_string(),
            )
        })?,
        _ => {
            let example = "card = \"apple.toml\"   or   law = \"kuwabara-kono(k=753599, c=1524)\"";
            let key = needed(TABLE, "card", "a law card, or a law", "", example);
            return Err(missing(source, &at, &key, TABLE.to_owned()));
        }
    };
    let number = |value: &Option<Spanned<f64>>| value.as_ref().map(|own| *own.get_ref());
    let ratio = match (number(&file.tangential_ratio), number(&file.poisson)) {
        (Some(ratio), None) => ratio,
        (None, Some(poisson)) => mindlin_ratio(poisson),
        (None, None) => mindlin_ratio(DEFAULT_POISSON),
        (Some(_), Some(poisson)) => {
            let problem = "poisson and tangential_ratio say the same: leave one out".to_owned();
            return Err(invalid(
                source,
                &at,
                (TABLE, "poisson"),
                &poisson.to_string(),
                problem,
            ));
        }
    };
    let interaction = Interaction {
        law,
        effective_radius: seen,
        spread,
        friction: number(&file.friction).unwrap_or(0.0),
        tangential_ratio: ratio,
        tangential_damping: number(&file.tangential_damping).unwrap_or(1.0),
        annuli: annuli(source, file)?,
        rolling: number(&file.rolling).unwrap_or(0.0),
    };
    Ok(((a.min(b), a.max(b)), interaction, card))
}

fn annuli(source: &TomlSource, file: &ContactFile) -> Result<usize, Error> {
    let Some(annuli) = &file.annuli else {
        return Ok(DEFAULT_ANNULI);
    };
    match *annuli.get_ref() {
        own @ 1..=MOST_ANNULI => Ok(own),
        own => Err(invalid(
            source,
            &annuli.span(),
            ("[[contacts]]", "annuli"),
            &own.to_string(),
            format!("annuli of a contact area are 1 to {MOST_ANNULI}"),
        )),
    }
}

/// Annuli of a contact area where their number is not given.
const DEFAULT_ANNULI: usize = 4;
/// Poisson's ratio where none is given; 1.
const DEFAULT_POISSON: f64 = 0.3;

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

fn gravity(source: &TomlSource, file: Option<&Spanned<GravityFile>>) -> Result<Vector, Error> {
    let Some(file) = file else {
        return Ok([0.0, 0.0, -STANDARD_GRAVITY]);
    };
    match file.get_ref() {
        GravityFile::Vector(own) => Ok(*own),
        GravityFile::Down(text) => {
            let key = needed(
                "[scene]",
                "gravity",
                "gravity",
                "m/s^2",
                "gravity = \"9.81 m/s^2\"",
            );
            let text = Spanned::new(file.span(), text.clone());
            let size = optional_quantity(source, Some(&text), &key)?.unwrap_or(0.0);
            Ok(scaled([0.0, 0.0, -1.0], size))
        }
    }
}

fn air_of(source: &TomlSource, air: &Spanned<AirFile>) -> Result<Air, Error> {
    let density = needed(
        "[air]",
        "density",
        "density of the air",
        "kg/m^3",
        "density = \"1.2 kg/m^3\"",
    );
    let density = optional_quantity(source, air.get_ref().density.as_ref(), &density)?;
    let drag = air
        .get_ref()
        .drag_coefficient
        .as_ref()
        .map(|own| *own.get_ref());
    Ok(Air {
        density: density.unwrap_or(1.2),
        drag_coefficient: drag.unwrap_or(0.47),
    })
}
