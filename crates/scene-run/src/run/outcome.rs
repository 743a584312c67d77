//! Results of a scene.

use crate::bruise::scene::BruiseOutcome;
use crate::file::key::FRUIT;
use crate::file::read::ScenePlan;
use crate::run::histogram::HistogramOutcome;
use crate::run::levels::Levels;
use crate::run::sensors::outcome::SensorOutcome;
use crate::run::static_load::StaticLoads;
use serde::Serialize;
use std::collections::BTreeMap;
use std::io::{Read, Result as IoResult, Write};
use std::path::PathBuf;
use windfall_files::found::FindingOutcome;
use windfall_scene::binary;
use windfall_scene::binary::{Binary, no_value};
use windfall_scene::energy::Energy;
use windfall_scene::event::{Event, Partner};
use windfall_scene::motion::simulation::Leaving;
use windfall_scene::scene::Scene;

/// Results of a scene; SI throughout.
#[derive(Clone, Debug, Serialize, utoipa::ToSchema)]
pub struct SceneOutcome {
    /// Title.
    pub title: String,
    /// When it began, where it began at the end of another run; s.
    pub start: Option<f64>,
    /// When it ended; s.
    pub end: f64,
    /// The engine that moved the fruit, with its version.
    pub engine: String,
    /// The time step, and what it does.
    pub step: StepOutcome,
    /// Steps.
    pub steps: u64,
    /// Fruit in all.
    pub fruit: usize,
    /// Fruit that found no room to come in.
    pub waiting: usize,
    /// Fruit that left through a sink.
    pub left: usize,
    /// Contacts that ended, or were there at the end.
    pub contacts: u64,
    /// Those of them that were written.
    pub written: u64,
    /// Contacts by what was touched.
    pub partners: Vec<PartnerOutcome>,
    /// How fruit are distributed over the hardest that each suffered.
    pub histograms: Vec<HistogramOutcome>,
    /// What each sensor saw.
    pub sensors: Vec<SensorOutcome>,
    /// How many fruit are bruised, and where; where the scene says what bruises.
    pub bruise: Option<BruiseOutcome>,
    /// Energies at the end.
    pub energy: Energy,
    /// What the energy account lacks, over what was lost in contacts; 1.
    pub energy_closure: f64,
    /// Findings.
    pub findings: Vec<FindingOutcome>,
    /// Files written.
    #[schema(value_type = Vec<String>)]
    pub files: Vec<PathBuf>,
}

/// A time step, and what it does to the contact that suffers most.
#[derive(Clone, Debug, Default, Serialize, utoipa::ToSchema)]
#[schema(as = SceneStep)]
pub struct StepOutcome {
    /// Time step; s.
    pub time_step: f64,
    /// Materials of that contact.
    pub between: [String; 2],
    /// Impact speed at which it was looked at; m/s.
    pub speed: f64,
    /// Contact duration there; s.
    pub contact_duration: f64,
    /// Relative error of its peak force; 1.
    pub peak_force_error: f64,
    /// Error of its absorbed energy over the impact energy; 1.
    pub energy_error: f64,
}

/// Contacts with one wall, or of fruit with fruit.
#[derive(Clone, Debug, Serialize, utoipa::ToSchema)]
pub struct PartnerOutcome {
    /// The wall, or "fruit".
    pub name: String,
    /// Contacts that were impacts.
    pub contacts: usize,
    /// Fruit that had one.
    pub fruit: usize,
    /// Contacts that were static loads: much longer than an impact, or there at the end.
    pub static_loads: usize,
    /// Fruit that had one.
    pub static_fruit: usize,
    /// Largest force of them; N.
    pub largest_static_force: f64,
    /// Peak forces that half and 95 % of the impacts stay below, and the largest; N.
    pub peak_force: [f64; 3],
    /// The same of impact speeds; m/s.
    pub impact_speed: [f64; 3],
    /// The same of absorbed energies; J.
    pub absorbed_energy: [f64; 3],
}

/// Contacts of one fruit, counted.
#[derive(Clone, Debug, Default)]
pub struct FruitTally {
    /// Contacts.
    pub contacts: u64,
    /// The one with the largest peak force.
    pub hardest: Option<Event>,
    /// Largest absorbed energy of a contact, and of all; J.
    pub absorbed: [f64; 2],
    /// Static loads.
    pub static_loads: u64,
    /// Largest force of them; N.
    pub largest_static_force: f64,
    /// When it left, and through which sink.
    pub left: Option<Leaving>,
}

binary!(FruitTally {
    contacts,
    hardest,
    absorbed,
    static_loads,
    largest_static_force,
    left
});

/// Numbers of fruit, a bit for each.
type FruitSet = Vec<u64>;

fn insert(set: &mut FruitSet, fruit: u32) {
    let (word, bit) = (fruit as usize / 64, fruit % 64);
    if set.len() <= word {
        set.resize(word + 1, 0);
    }
    set[word] |= 1 << bit;
}

fn count(set: &FruitSet) -> usize {
    set.iter().map(|own| own.count_ones() as usize).sum()
}

/// Contacts with one wall, or of fruit with fruit, in memory that does not grow with them.
#[derive(Clone, Debug, Default)]
pub struct PartnerTally {
    /// Impacts.
    pub contacts: u64,
    /// Fruit that had one.
    fruit: FruitSet,
    /// Static loads.
    pub static_loads: u64,
    /// Fruit that had one.
    static_fruit: FruitSet,
    /// Largest force of them; N.
    pub largest_static_force: f64,
    /// Peak forces of impacts; N.
    pub peak_force: Levels,
    /// Impact speeds; m/s.
    pub impact_speed: Levels,
    /// Absorbed energies; J.
    pub absorbed_energy: Levels,
}

binary!(PartnerTally {
    contacts,
    fruit,
    static_loads,
    static_fruit,
    largest_static_force,
    peak_force,
    impact_speed,
    absorbed_energy
});

impl PartnerTally {
    fn count(&mut self, event: &Event, lasted: bool) {
        if lasted {
            self.static_loads += 1;
            insert(&mut self.static_fruit, event.fruit);
            self.largest_static_force = self.largest_static_force.max(event.peak_force);
            return;
        }
        self.contacts += 1;
        insert(&mut self.fruit, event.fruit);
        self.peak_force.add(event.peak_force);
        self.impact_speed.add(event.normal_speed);
        self.absorbed_energy.add(event.absorbed_energy);
    }
}

/// Running counts of a scene.
#[derive(Clone, Debug)]
pub struct Tally {
    /// Of each fruit.
    pub fruit: Vec<FruitTally>,
    /// Contacts in all.
    pub contacts: u64,
    /// Of each wall, by number; of fruit with fruit behind them.
    pub partners: Vec<PartnerTally>,
    loads: StaticLoads,
    /// The fastest impact that the card of a pair of materials has seen; m/s.
    seen: BTreeMap<(usize, usize), f64>,
    /// Contacts of these pairs, and those of them that were faster.
    speeds: BTreeMap<(usize, usize), (u64, u64)>,
}

impl Tally {
    /// Empty counts.
    pub fn new(plan: &ScenePlan) -> Self {
        let scene = &plan.scene;
        let fastest = |card: &windfall_cards::law_card::LawCard| card.range.impact_velocity[1];
        let cards = plan.cards.iter();
        Self {
            fruit: vec![FruitTally::default(); scene.fruit.len()],
            contacts: 0,
            partners: vec![PartnerTally::default(); scene.walls.len() + 1],
            loads: StaticLoads::of(scene),
            seen: cards.map(|(pair, card)| (*pair, fastest(card))).collect(),
            speeds: BTreeMap::new(),
        }
    }

    /// Counts a contact; whether it was a static load.
    pub fn count(&mut self, scene: &Scene, event: &Event) -> bool {
        self.contacts += 1;
        let lasted = self.loads.is_static(scene, event);
        self.suffer(event.fruit, event, lasted);
        let place = match event.partner {
            Partner::Fruit(other) => {
                self.suffer(other, event, lasted);
                scene.walls.len()
            }
            Partner::Wall(wall) => wall as usize,
        };
        self.partners[place].count(event, lasted);
        let pair = scene.materials_of(event);
        if let Some(fastest) = self.seen.get(&pair) {
            let (all, beyond) = self.speeds.entry(pair).or_default();
            *all += 1;
            *beyond += u64::from(event.normal_speed > *fastest);
        }
        lasted
    }

    fn suffer(&mut self, fruit: u32, event: &Event, lasted: bool) {
        let own = &mut self.fruit[fruit as usize];
        own.contacts += 1;
        if lasted {
            own.static_loads += 1;
            own.largest_static_force = own.largest_static_force.max(event.peak_force);
        }
        if own
            .hardest
            .is_none_or(|before| before.peak_force < event.peak_force)
        {
            own.hardest = Some(*event);
        }
        own.absorbed[0] = own.absorbed[0].max(event.absorbed_energy);
        own.absorbed[1] += event.absorbed_energy;
    }

    /// Counts a fruit that left.
    pub fn leave(&mut self, leaving: &Leaving) {
        self.fruit[leaving.fruit as usize].left = Some(*leaving);
    }

    /// Writes what was counted.
    pub fn save(&self, to: &mut dyn Write) -> IoResult<()> {
        self.fruit.write(to)?;
        self.contacts.write(to)?;
        self.partners.write(to)?;
        self.speeds.write(to)
    }

    /// Takes up what [`Tally::save`] wrote of the same scene.
    ///
    /// # Errors
    /// Those of the reader; it is of another scene.
    pub fn take_up(&mut self, from: &mut dyn Read) -> IoResult<()> {
        let own = (self.fruit.len(), self.partners.len());
        self.fruit = Binary::read(from)?;
        self.contacts = Binary::read(from)?;
        self.partners = Binary::read(from)?;
        self.speeds = Binary::read(from)?;
        match own == (self.fruit.len(), self.partners.len()) {
            true => Ok(()),
            false => Err(no_value("tally of this scene")),
        }
    }

    /// Fruit that left.
    pub fn left(&self) -> usize {
        self.fruit.iter().filter(|own| own.left.is_some()).count()
    }
}

impl PartnerOutcome {
    /// Of every wall that was touched, and of fruit.
    pub fn of(scene: &Scene, tally: &Tally) -> Vec<Self> {
        let names = scene.walls.iter().map(|wall| wall.name.clone());
        let names = names.chain([FRUIT.to_owned()]);
        let rows = names
            .zip(&tally.partners)
            .filter(|(_, own)| own.contacts + own.static_loads > 0);
        rows.map(|(name, own)| {
            let levels = |of: &Levels| match own.contacts {
                0 => [0.0; 3],
                _ => [0.5, 0.95, 1.0].map(|share| of.level(share)),
            };
            Self {
                name,
                contacts: own.contacts as usize,
                fruit: count(&own.fruit),
                static_loads: own.static_loads as usize,
                static_fruit: count(&own.static_fruit),
                largest_static_force: own.largest_static_force,
                peak_force: levels(&own.peak_force),
                impact_speed: levels(&own.impact_speed),
                absorbed_energy: levels(&own.absorbed_energy),
            }
        })
        .collect()
    }
}

/// Laws used faster than they were seen, and fruit that found no room.
pub fn findings_of_range(plan: &ScenePlan, tally: &Tally, waiting: usize) -> Vec<FindingOutcome> {
    let mut findings = Vec::new();
    for (pair, card) in &plan.cards {
        let Some(&(all, beyond)) = tally.speeds.get(pair) else {
            continue;
        };
        let [_, fastest] = card.range.impact_velocity;
        if beyond > 0 {
            let share = 100.0 * beyond as f64 / all as f64;
            let names = [pair.0, pair.1].map(|own| plan.scene.materials[own].as_str());
            findings.push(FindingOutcome::new(
                "law-range",
                format!(
                    "{beyond} contacts of {} and {} ({share:.1} %) are faster than {fastest} m/s, \
                     the fastest impact that the law was seen in",
                    names[0], names[1]
                ),
            ));
        }
    }
    if waiting > 0 {
        findings.push(FindingOutcome::new(
            "no-room",
            format!("{waiting} fruit found no room where they were to come in"),
        ));
    }
    findings
}
