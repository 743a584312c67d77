//! Contacts and fruit of a scene as tables.

use crate::bruise::scene::{BruiseOutcome, LimitOutcome, PlaceOutcome};
use crate::file::engine_kind::Engine;
use crate::file::key::FRUIT;
use crate::file::read::ScenePlan;
use crate::run::columns::SceneTable;
use crate::run::growing::{GrowingFile, partial_of};
use crate::run::outcome::{PartnerOutcome, SceneOutcome, Tally};
use crate::run::sensors::text::text_of_sensors;
use crate::run_error::SceneRunError;
use std::fs::{File, TryLockError};
use std::path::{Path, PathBuf};
use windfall_files::error::Error;
use windfall_files::table::write::{csv_cell, csv_header, csv_text};
use windfall_files::text::columns::{Column, cells_of_rows, csv_of_rows, text_of_rows};
use windfall_files::text::statistic::number;
use windfall_files::text::table::{Cells, finding_lines, page_tables};
use windfall_scene::bruise::damage::Bruise;
use windfall_scene::event::{Event, Partner};
use windfall_scene::motion::simulation::FruitState;
use windfall_scene::scene::Scene;

/// A table of contacts that grows with the scene; it has its name when it is whole.
pub struct EventFile {
    file: GrowingFile,
    walls: Vec<String>,
    least: f64,
    written: u64,
}

/// State of a partial table: whether a program is writing it; `None` where there is none.
pub fn is_written(path: &Path) -> Option<bool> {
    let file = File::options().write(true).open(partial_of(path)).ok()?;
    Some(matches!(file.try_lock(), Err(TryLockError::WouldBlock)))
}

impl EventFile {
    /// A table without rows.
    ///
    /// * `least`: contacts with a smaller peak force are left out; N
    pub fn create(path: &Path, scene: &Scene, least: f64) -> Result<Self, Error> {
        let mut own = Self::open(path, scene, least, (0, 0))?;
        let schema = SceneTable::Events.schema();
        own.file.write(csv_header(&schema.names())?)?;
        Ok(own)
    }

    /// A resumed table.
    ///
    /// * `length`, `written`: bytes and rows of it that count; what is behind is cut off
    ///
    /// # Errors
    /// It is shorter, or cannot be written.
    pub fn resume(
        path: &Path,
        scene: &Scene,
        least: f64,
        (length, written): (u64, u64),
    ) -> Result<Self, Error> {
        GrowingFile::check_length(path, "the table", length)?;
        Self::open(path, scene, least, (length, written))
    }

    fn open(
        path: &Path,
        scene: &Scene,
        least: f64,
        (length, written): (u64, u64),
    ) -> Result<Self, Error> {
        let mut file = GrowingFile::open(path)?;
        // Two programs would mix their rows.
        if file.is_busy() {
            let path = path.to_path_buf();
            return Err(Error::from(SceneRunError::Busy { path }));
        }
        file.cut(length)?;
        let walls = scene.walls.iter();
        Ok(Self {
            file,
            walls: walls
                .map(|wall| csv_cell(&wall.name))
                .collect::<Result<_, _>>()?,
            least,
            written,
        })
    }

    /// Brings all rows so far to the disk; the bytes of the table.
    pub fn sync(&mut self) -> Result<u64, Error> {
        self.file.sync()
    }

    /// Rows so far.
    pub fn written(&self) -> u64 {
        self.written
    }

    /// Whether the rows so far stay where the table is not finished.
    pub fn keep(&mut self, keep: bool) {
        self.file.keep = keep;
    }

    /// Adds a load.
    ///
    /// * `lasted`: whether it was static
    pub fn write(&mut self, event: &Event, lasted: bool) -> Result<(), Error> {
        if event.peak_force < self.least {
            return Ok(());
        }
        self.written += 1;
        let (partner, number) = match event.partner {
            Partner::Fruit(other) => (FRUIT, (other + 1).to_string()),
            Partner::Wall(wall) => (self.walls[wall as usize].as_str(), String::new()),
        };
        let ([x, y, z], [a, b, c], [d, e, f]) = (event.place, event.spot, event.other_spot);
        self.file.write(format!(
            "{},{partner},{number},{},{},{},{x},{y},{z},{a},{b},{c},{d},{e},{f},{},{},{},{},{},{},{lasted},{}\n",
            event.fruit + 1,
            event.time,
            event.duration,
            event.lasting,
            event.normal_speed,
            event.tangential_speed,
            event.peak_force,
            event.largest_displacement,
            event.absorbed_energy,
            event.friction_energy,
            event.number,
        ))
    }

    /// Gives the table its name.
    pub fn finish(mut self) -> Result<(), Error> {
        self.file.finish().map(|_| ())
    }
}

/// One row per fruit: what it is, what it went through, where it is.
pub fn fruit_table(
    plan: &ScenePlan,
    tally: &Tally,
    states: &[FruitState],
    bruises: Option<&[Vec<Bruise>]>,
) -> Result<String, Error> {
    let scene = &plan.scene;
    let mut states = states.iter().peekable();
    let rows = scene
        .fruit
        .iter()
        .zip(&tally.fruit)
        .enumerate()
        .map(|(number, (fruit, own))| {
            let state = states.next_if(|state| state.fruit as usize == number);
            let place = state.map_or([const { String::new() }; 3], |state| {
                state.place.map(|at| at.to_string())
            });
            let bruised = bruises.map(|all| &all[number]);
            let of_bruises =
                |what: &dyn Fn(&Vec<Bruise>) -> String| bruised.map_or(String::new(), what);
            let hardest = own.hardest.as_ref();
            let partner = hardest.map_or(String::new(), |event| match event.partner {
                Partner::Fruit(_) => FRUIT.to_owned(),
                Partner::Wall(wall) => scene.walls[wall as usize].name.clone(),
            });
            let of = |number: Option<f64>| number.map_or(String::new(), |own| own.to_string());
            let [x, y, z] = place;
            vec![
                (number + 1).to_string(),
                scene.materials[fruit.material].clone(),
                fruit.diameter().to_string(),
                fruit.mass.to_string(),
                fruit.time.to_string(),
                of(own.left.map(|left| left.time)),
                own.left
                    .map_or(String::new(), |left| scene.sinks[left.sink].name.clone()),
                x,
                y,
                z,
                own.contacts.to_string(),
                of(hardest.map(|event| event.peak_force)),
                partner,
                of(hardest.map(|event| event.time)),
                of(hardest.map(|event| event.normal_speed)),
                own.absorbed[0].to_string(),
                own.absorbed[1].to_string(),
                of_bruises(&|own| own.len().to_string()),
                of_bruises(&|own| {
                    let volumes = own.iter().map(|bruise| 1e9 * bruise.volume);
                    volumes.fold(0.0, f64::max).to_string()
                }),
                own.static_loads.to_string(),
                own.largest_static_force.to_string(),
            ]
        });
    let rows: Vec<Vec<String>> = rows.collect();
    csv_text(&SceneTable::Fruit.schema().names(), rows)
}

/// Contacts by what was touched, for a terminal.
const PARTNERS: [Column<PartnerOutcome>; 14] = [
    ("touched", |own| own.name.clone()),
    ("impacts", |own| own.contacts.to_string()),
    ("fruit", |own| own.fruit.to_string()),
    ("peak force (N)", |own| number(own.peak_force[0])),
    ("95 %", |own| number(own.peak_force[1])),
    ("largest", |own| number(own.peak_force[2])),
    ("impact speed (m/s)", |own| number(own.impact_speed[0])),
    ("95 %", |own| number(own.impact_speed[1])),
    ("largest", |own| number(own.impact_speed[2])),
    ("absorbed (mJ)", |own| number(1e3 * own.absorbed_energy[0])),
    ("95 %", |own| number(1e3 * own.absorbed_energy[1])),
    ("largest", |own| number(1e3 * own.absorbed_energy[2])),
    ("static loads", |own| own.static_loads.to_string()),
    ("largest (N)", |own| number(own.largest_static_force)),
];

/// The same as CSV.
const PARTNERS_CSV: [Column<PartnerOutcome>; 15] = [
    ("touched", |own| own.name.clone()),
    ("impacts", |own| own.contacts.to_string()),
    ("fruit", |own| own.fruit.to_string()),
    ("peak_force_median_N", |own| own.peak_force[0].to_string()),
    ("peak_force_p95_N", |own| own.peak_force[1].to_string()),
    ("peak_force_max_N", |own| own.peak_force[2].to_string()),
    ("impact_speed_median_m_s", |own| {
        own.impact_speed[0].to_string()
    }),
    ("impact_speed_p95_m_s", |own| {
        own.impact_speed[1].to_string()
    }),
    ("impact_speed_max_m_s", |own| {
        own.impact_speed[2].to_string()
    }),
    ("absorbed_energy_median_J", |own| {
        own.absorbed_energy[0].to_string()
    }),
    ("absorbed_energy_p95_J", |own| {
        own.absorbed_energy[1].to_string()
    }),
    ("absorbed_energy_max_J", |own| {
        own.absorbed_energy[2].to_string()
    }),
    ("static_loads", |own| own.static_loads.to_string()),
    ("static_fruit", |own| own.static_fruit.to_string()),
    ("largest_static_force_N", |own| {
        own.largest_static_force.to_string()
    }),
];

/// How well the energy account closes.
fn text_of_account(outcome: &SceneOutcome) -> String {
    match outcome.energy.lost() > 0.0 {
        true => format!(
            "The energy account closes to {} % of what was lost.",
            number(100.0 * outcome.energy_closure.abs())
        ),
        false => "No energy was lost.".to_owned(),
    }
}

/// Results of a scene, for a terminal.
pub fn text_of_scene(outcome: &SceneOutcome) -> String {
    let step = &outcome.step;
    let mut text = format!(
        "{}\n\n{} fruit {} {} s in {} steps of {} µs: peak forces of {} and {} at {} m/s err by \
         {} %, absorbed energies by {} % of the impact energy.\n{} contacts, {} of them written; \
         {} fruit left. {}\n\n",
        outcome.title,
        outcome.fruit,
        outcome.start.map_or("over".to_owned(), |own| format!(
            "from {} s to",
            number(own)
        )),
        outcome.end,
        outcome.steps,
        number(1e6 * step.time_step),
        step.between[0],
        step.between[1],
        number(step.speed),
        number(100.0 * step.peak_force_error),
        number(100.0 * step.energy_error),
        outcome.contacts,
        outcome.written,
        outcome.left,
        text_of_account(outcome),
    );
    if outcome.engine != Engine::Windfall.title() {
        text += &format!("Moved by {}.\n\n", outcome.engine);
    }
    text += &text_of_rows(&outcome.partners, &PARTNERS, &[0]);
    if let Some(bruise) = &outcome.bruise {
        text += &text_of_bruises(bruise);
    }
    text += &text_of_sensors(&outcome.sensors);
    for line in finding_lines(&outcome.findings) {
        text += &format!("\n{line}\n");
    }
    text + "\n" + &text_of_files(&outcome.files)
}

/// Bruised fruit, and what bruised them.
fn text_of_bruises(bruise: &BruiseOutcome) -> String {
    let limits: [Column<LimitOutcome>; 3] = [
        ("largest bruise above (mm³)", |own| number(1e9 * own.limit)),
        ("fruit (%)", |own| number(100.0 * own.share)),
        ("95 % interval", |own| {
            let [low, high] = own.interval.map(|end| number(100.0 * end));
            format!("{low} … {high}")
        }),
    ];
    let limits = text_of_rows(&bruise.limits, &limits, &[]);
    let places = cells_of_places(&bruise.places);
    let places = page_tables(&places.header, &places.rows, &[0]);
    format!("\n\n{limits}\n\n{places}\n")
}

/// What bruised, the worst first.
pub(crate) fn cells_of_places(places: &[PlaceOutcome]) -> Cells {
    let columns: [Column<PlaceOutcome>; 4] = [
        ("bruised by", |own| own.name.clone()),
        ("bruises", |own| own.bruises.to_string()),
        ("the largest of so many fruit", |own| own.fruit.to_string()),
        ("largest (mm³)", |own| number(1e9 * own.largest)),
    ];
    cells_of_rows(places, &columns)
}

/// The end of a text: files that were written.
pub fn text_of_files(files: &[PathBuf]) -> String {
    let files: Vec<String> = files.iter().map(|own| own.display().to_string()).collect();
    format!("\nWritten: {}\n", files.join(", "))
}

/// Contacts by what was touched, as CSV.
pub fn csv_of_scene(outcome: &SceneOutcome) -> Result<String, Error> {
    csv_of_rows(&outcome.partners, &PARTNERS_CSV)
}
