//! Bruises of a scene: from the contacts of each fruit to the share that is bruised.

use crate::outcome::FindingOutcome;
use crate::read_scene_bruise::BruisePlan;
use crate::scene_key::FRUIT;
use serde::Serialize;
use std::collections::BTreeMap;
use std::io::{Read, Result as IoResult, Write};
use windfall_scene::binary::{Binary, no_value};
use windfall_scene::bruise::{Blow, Bruise};
use windfall_scene::event::{Event, Partner};
use windfall_scene::scene::{Fruit, Scene};

/// Contacts that may bruise, of each fruit, as they come.
#[derive(Clone, Debug)]
pub struct Blows {
    plan: BruisePlan,
    radii: Vec<f64>,
    materials: Vec<usize>,
    wall_materials: Vec<usize>,
    shares: BTreeMap<(usize, usize), f64>,
    /// Contacts of each fruit, and what each was with: the number of a wall, or of walls in
    /// all for a fruit.
    of: Vec<Vec<Blow>>,
    with: Vec<Vec<usize>>,
    /// Contacts that were too many for a fruit, and weaker than all that are kept of it.
    crowded: u64,
}

/// How many fruit are bruised, and where.
#[derive(Clone, Debug, Serialize)]
pub struct BruiseOutcome {
    /// Share of fruit whose largest bruise exceeds each limit.
    pub limits: Vec<LimitOutcome>,
    /// What made bruises, the worst first.
    pub places: Vec<PlaceOutcome>,
}

/// Share of fruit above a limit.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct LimitOutcome {
    /// Volume of the largest bruise; m³.
    pub limit: f64,
    /// Share of fruit above it; 1.
    pub share: f64,
    /// Ends of the 95 % interval: other fruit, and the uncertainty of the coefficients.
    pub interval: [f64; 2],
}

/// Bruises made by one wall, or by other fruit.
#[derive(Clone, Debug, Serialize)]
pub struct PlaceOutcome {
    /// The wall, or "fruit".
    pub name: String,
    /// Bruises.
    pub bruises: usize,
    /// Fruit whose largest bruise is from there.
    pub fruit: usize,
    /// Volume of the largest; m³.
    pub largest: f64,
}

/// Standard uncertainties below the threshold up to which contacts are kept.
const REACH: f64 = 5.0;
/// Contacts that are kept of a fruit: so many bruises are beyond all counting, and memory has
/// a bound.
pub const MOST_BLOWS: usize = 64;
/// Draws of an interval, and their seed.
const DRAWS: (usize, u64) = (1000, 1);
/// Level of intervals; 1.
const LEVEL: f64 = 0.95;

/// That contacts were more than are kept.
#[must_use]
pub fn finding_of_blows(blows: &Blows) -> Option<FindingOutcome> {
    let crowded = blows.crowded();
    (crowded > 0).then(|| FindingOutcome {
        code: "many-blows".to_owned(),
        message: format!(
            "of fruit with more than {MOST_BLOWS} contacts above the threshold only the \
             {MOST_BLOWS} hardest count; {crowded} were left out. A larger threshold leaves out \
             what does not bruise"
        ),
    })
}

impl Blows {
    /// None yet.
    ///
    /// * `shares`: part of the absorbed energy that a fruit takes, by the pair of materials;
    ///   half of it where two fruit meet, all of it on a wall, where nothing is said
    #[must_use]
    pub fn new(plan: &BruisePlan, scene: &Scene, shares: &BTreeMap<(usize, usize), f64>) -> Self {
        let mut kept = plan.clone();
        // Contacts below the threshold may bruise when the threshold is drawn anew.
        kept.model.threshold = (plan.model.threshold - REACH * plan.model.threshold_sd).max(0.0);
        Self {
            plan: kept,
            radii: scene.fruit.iter().map(Fruit::mean_radius).collect(),
            materials: scene.fruit.iter().map(|fruit| fruit.material).collect(),
            wall_materials: scene.walls.iter().map(|wall| wall.material).collect(),
            shares: shares.clone(),
            of: vec![Vec::new(); scene.fruit.len()],
            with: vec![Vec::new(); scene.fruit.len()],
            crowded: 0,
        }
    }

    /// One contact more.
    pub fn count(&mut self, event: &Event) {
        let own = self.materials[event.fruit as usize];
        let (place, with, usual) = match event.partner {
            Partner::Fruit(other) => (
                self.wall_materials.len(),
                self.materials[other as usize],
                0.5,
            ),
            Partner::Wall(wall) => (wall as usize, self.wall_materials[wall as usize], 1.0),
        };
        let pair = (own.min(with), own.max(with));
        let share = self.shares.get(&pair).copied().unwrap_or(usual);
        self.strike(event, (event.fruit, false), share, place);
        if let Partner::Fruit(other) = event.partner {
            self.strike(event, (other, true), share, place);
        }
    }

    fn strike(&mut self, event: &Event, (fruit, other): (u32, bool), share: f64, place: usize) {
        let fruit = fruit as usize;
        let blow = Blow::of(event, self.radii[fruit], other, share);
        if self.plan.model.volume(&blow) > 0.0 {
            self.of[fruit].push(blow);
            self.with[fruit].push(place);
        }
        if self.of[fruit].len() > MOST_BLOWS {
            let volumes = self.of[fruit].iter().map(|own| self.plan.model.volume(own));
            let weakest = volumes.enumerate().min_by(|a, b| a.1.total_cmp(&b.1));
            if let Some((weakest, _)) = weakest {
                self.of[fruit].remove(weakest);
                self.with[fruit].remove(weakest);
                self.crowded += 1;
            }
        }
    }

    /// Contacts above the threshold that are not kept: of a fruit that has more than
    /// [`MOST_BLOWS`] the weakest.
    #[must_use]
    pub fn crowded(&self) -> u64 {
        self.crowded
    }

    /// Writes what was counted.
    ///
    /// # Errors
    /// Those of the writer.
    pub fn save(&self, to: &mut dyn Write) -> IoResult<()> {
        self.of.write(to)?;
        self.with.write(to)?;
        self.crowded.write(to)
    }

    /// Takes up what [`Blows::save`] wrote of the same scene.
    ///
    /// # Errors
    /// Those of the reader; it is of another scene.
    pub fn take_up(&mut self, from: &mut dyn Read) -> IoResult<()> {
        let fruit = self.radii.len();
        self.of = Binary::read(from)?;
        self.with = Binary::read(from)?;
        self.crowded = Binary::read(from)?;
        match self.of.len() == fruit && self.with.len() == fruit {
            true => Ok(()),
            false => Err(no_value("bruises of this scene")),
        }
    }

    /// Bruises of each fruit, by the model as it is.
    #[must_use]
    pub fn bruises(&self, plan: &BruisePlan) -> Vec<Vec<Bruise>> {
        self.of.iter().map(|own| plan.model.bruises(own)).collect()
    }

    /// What came of it.
    #[must_use]
    pub fn outcome(&self, plan: &BruisePlan, scene: &Scene) -> BruiseOutcome {
        let limits = plan.limits.iter().map(|&limit| {
            let found = plan.model.share_above(&self.of, limit, LEVEL, DRAWS);
            LimitOutcome {
                limit,
                share: found.share,
                interval: [found.low, found.high],
            }
        });
        let names = scene.walls.iter().map(|wall| wall.name.clone());
        let mut places: Vec<PlaceOutcome> = names
            .chain([FRUIT.to_owned()])
            .map(|name| PlaceOutcome {
                name,
                bruises: 0,
                fruit: 0,
                largest: 0.0,
            })
            .collect();
        for (bruises, with) in self.bruises(plan).iter().zip(&self.with) {
            let worst = bruises.iter().max_by(|a, b| a.volume.total_cmp(&b.volume));
            for bruise in bruises {
                let own = &mut places[with[bruise.contact]];
                own.bruises += 1;
                own.largest = own.largest.max(bruise.volume);
            }
            if let Some(worst) = worst {
                places[with[worst.contact]].fruit += 1;
            }
        }
        places.retain(|own| own.bruises > 0);
        places.sort_by(|a, b| b.fruit.cmp(&a.fruit).then(b.largest.total_cmp(&a.largest)));
        BruiseOutcome {
            limits: limits.collect(),
            places,
        }
    }
}
