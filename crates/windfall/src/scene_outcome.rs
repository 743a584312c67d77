//! What came of a scene.

use crate::outcome::FindingOutcome;
use crate::read_scene::ScenePlan;
use crate::scene_bruise::BruiseOutcome;
use crate::scene_key::FRUIT;
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::PathBuf;
use windfall_scene::energy::Energy;
use windfall_scene::event::{Event, Partner};
use windfall_scene::scene::Scene;
use windfall_scene::simulation::Leaving;

/// What came of a scene; SI throughout.
#[derive(Clone, Debug, Serialize)]
pub struct SceneOutcome {
    /// Title.
    pub title: String,
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
    /// How many fruit are bruised, and where; where the scene says what bruises.
    pub bruise: Option<BruiseOutcome>,
    /// Energies at the end.
    pub energy: EnergyOutcome,
    /// What the energy account lacks, over what was lost in contacts; 1.
    pub energy_closure: f64,
    /// What is to be known of the result.
    pub findings: Vec<FindingOutcome>,
    /// Files written.
    pub files: Vec<PathBuf>,
}

/// A time step, and what it does to the contact that suffers most.
#[derive(Clone, Debug, Default, Serialize)]
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
#[derive(Clone, Debug, Serialize)]
pub struct PartnerOutcome {
    /// The wall, or "fruit".
    pub name: String,
    /// Contacts.
    pub contacts: usize,
    /// Fruit that had one.
    pub fruit: usize,
    /// Peak forces that half and 95 % of the contacts stay below, and the largest; N.
    pub peak_force: [f64; 3],
    /// The same of impact speeds; m/s.
    pub impact_speed: [f64; 3],
    /// The same of absorbed energies; J.
    pub absorbed_energy: [f64; 3],
}

/// Energies; J.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct EnergyOutcome {
    /// Of translation.
    pub kinetic: f64,
    /// Of rotation.
    pub rotational: f64,
    /// In gravity.
    pub potential: f64,
    /// Held or lost in contacts that last.
    pub in_contacts: f64,
    /// Held or lost by friction of contacts that last.
    pub in_friction: f64,
    /// Lost in contacts that are over.
    pub lost_in_contacts: f64,
    /// Lost by friction and rolling.
    pub lost_by_friction: f64,
    /// Lost by drag.
    pub lost_by_drag: f64,
    /// Done by moving walls.
    pub done_by_walls: f64,
}

impl From<&Energy> for EnergyOutcome {
    fn from(own: &Energy) -> Self {
        Self {
            kinetic: own.kinetic,
            rotational: own.rotational,
            potential: own.potential,
            in_contacts: own.in_contacts,
            in_friction: own.in_friction,
            lost_in_contacts: own.lost_in_contacts,
            lost_by_friction: own.lost_by_friction,
            lost_by_drag: own.lost_by_drag,
            done_by_walls: own.done_by_walls,
        }
    }
}

/// What one fruit went through.
#[derive(Clone, Debug, Default)]
pub struct FruitTally {
    /// Contacts.
    pub contacts: u64,
    /// The one with the largest peak force.
    pub hardest: Option<Event>,
    /// Largest absorbed energy of a contact, and of all; J.
    pub absorbed: [f64; 2],
    /// When it left, and through which sink.
    pub left: Option<Leaving>,
}

/// What happened, counted as it happens.
#[derive(Clone, Debug)]
pub struct Tally {
    /// Of each fruit.
    pub fruit: Vec<FruitTally>,
    /// Contacts in all.
    pub contacts: u64,
    /// Of each wall, by number; of fruit with fruit behind them: fruit, peak force (N),
    /// impact speed (m/s), absorbed energy (J).
    pub partners: Vec<Vec<(u32, [f32; 3])>>,
    /// Impact speeds of pairs of materials, and how often: for the range of cards.
    speeds: BTreeMap<(usize, usize), Vec<f32>>,
    materials: Vec<usize>,
    walls: Vec<usize>,
}

impl Tally {
    /// Nothing yet.
    #[must_use]
    pub fn new(scene: &Scene) -> Self {
        Self {
            fruit: vec![FruitTally::default(); scene.fruit.len()],
            contacts: 0,
            partners: vec![Vec::new(); scene.walls.len() + 1],
            speeds: BTreeMap::new(),
            materials: scene.fruit.iter().map(|fruit| fruit.material).collect(),
            walls: scene.walls.iter().map(|wall| wall.material).collect(),
        }
    }

    /// One contact more.
    pub fn count(&mut self, event: &Event) {
        self.contacts += 1;
        self.suffer(event.fruit, event);
        let (place, other) = match event.partner {
            Partner::Fruit(other) => {
                self.suffer(other, event);
                (self.walls.len(), self.materials[other as usize])
            }
            Partner::Wall(wall) => (wall as usize, self.walls[wall as usize]),
        };
        let numbers = [event.peak_force, event.normal_speed, event.absorbed_energy];
        self.partners[place].push((event.fruit, numbers.map(|own| own as f32)));
        let own = self.materials[event.fruit as usize];
        let speeds = self
            .speeds
            .entry((own.min(other), own.max(other)))
            .or_default();
        speeds.push(event.normal_speed as f32);
    }

    fn suffer(&mut self, fruit: u32, event: &Event) {
        let own = &mut self.fruit[fruit as usize];
        own.contacts += 1;
        if own
            .hardest
            .is_none_or(|before| before.peak_force < event.peak_force)
        {
            own.hardest = Some(*event);
        }
        own.absorbed[0] = own.absorbed[0].max(event.absorbed_energy);
        own.absorbed[1] += event.absorbed_energy;
    }

    /// One fruit left.
    pub fn leave(&mut self, leaving: &Leaving) {
        self.fruit[leaving.fruit as usize].left = Some(*leaving);
    }

    /// Fruit that left.
    #[must_use]
    pub fn left(&self) -> usize {
        self.fruit.iter().filter(|own| own.left.is_some()).count()
    }
}

impl PartnerOutcome {
    /// Of every wall that was touched, and of fruit.
    #[must_use]
    pub fn of(scene: &Scene, tally: &Tally) -> Vec<Self> {
        let names = scene.walls.iter().map(|wall| wall.name.clone());
        let names = names.chain([FRUIT.to_owned()]);
        let rows = names
            .zip(&tally.partners)
            .filter(|(_, contacts)| !contacts.is_empty());
        rows.map(|(name, contacts)| {
            let mut fruit: Vec<u32> = contacts.iter().map(|own| own.0).collect();
            fruit.sort_unstable();
            fruit.dedup();
            let levels = |place: usize| {
                let mut sorted: Vec<f32> = contacts.iter().map(|own| own.1[place]).collect();
                sorted.sort_by(f32::total_cmp);
                [0.5, 0.95, 1.0].map(|share| {
                    let at = (share * sorted.len() as f64).ceil() as usize;
                    f64::from(sorted[at.clamp(1, sorted.len()) - 1])
                })
            };
            Self {
                name,
                contacts: contacts.len(),
                fruit: fruit.len(),
                peak_force: levels(0),
                impact_speed: levels(1),
                absorbed_energy: levels(2),
            }
        })
        .collect()
    }
}

/// Laws used faster than they were seen, and fruit that found no room.
#[must_use]
pub fn findings_of_range(plan: &ScenePlan, tally: &Tally, waiting: usize) -> Vec<FindingOutcome> {
    let mut findings = Vec::new();
    for (pair, card) in &plan.cards {
        let Some(speeds) = tally.speeds.get(pair) else {
            continue;
        };
        let [_, fastest] = card.range.impact_velocity;
        let beyond = speeds
            .iter()
            .filter(|own| f64::from(**own) > fastest)
            .count();
        if beyond > 0 {
            let share = 100.0 * beyond as f64 / speeds.len() as f64;
            let names = [pair.0, pair.1].map(|own| plan.scene.materials[own].as_str());
            findings.push(FindingOutcome {
                code: "law-range".to_owned(),
                message: format!(
                    "{beyond} contacts of {} and {} ({share:.1} %) are faster than {fastest} m/s, \
                     the fastest impact that the law was seen in",
                    names[0], names[1]
                ),
            });
        }
    }
    if waiting > 0 {
        findings.push(FindingOutcome {
            code: "no-room".to_owned(),
            message: format!("{waiting} fruit found no room where they were to come in"),
        });
    }
    findings
}
