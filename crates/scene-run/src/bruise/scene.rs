//! Bruises of a scene: from the contacts of each fruit to the share that is bruised.

use crate::file::bruise::BruisePlan;
use crate::file::key::FRUIT;
use serde::Serialize;
use std::collections::BTreeMap;
use std::io::{Read, Result as IoResult, Write};
use windfall_files::found::FindingOutcome;
use windfall_scene::binary::{Binary, no_value};
use windfall_scene::bruise::damage::{Blow, Bruise, variance_ratio};
use windfall_scene::draws::{normal_of, normals};
use windfall_scene::event::{Event, Partner};
use windfall_scene::scene::Scene;

/// Contacts that may bruise, of each fruit, as they come.
#[derive(Clone, Debug)]
pub struct Blows {
    plan: BruisePlan,
    shares: BTreeMap<(usize, usize), f64>,
    /// How each fruit differs.
    draws: Vec<(f64, f64)>,
    /// Contacts that bruise outside of the range of a regression, and all that do.
    outside: [usize; 2],
    /// Contacts of each fruit, and what each was with: the number of a wall, or that of a fruit
    /// after all walls.
    of: Vec<Vec<Blow>>,
    with: Vec<Vec<usize>>,
    /// Volumes of their bruises, by the model as it is; m³.
    volumes: Vec<Vec<f64>>,
    /// Whether each fruit is an instrument, which does not bruise and does not count.
    probes: Vec<bool>,
    /// Contacts that bruise, but were too many for a fruit, and weaker than all that are kept of it.
    crowded: u64,
}

/// How many fruit are bruised, and where.
#[derive(Clone, Debug, Serialize, utoipa::ToSchema)]
pub struct BruiseOutcome {
    /// Fruit that count: all but probes.
    pub fruit: usize,
    /// Share of fruit whose largest bruise exceeds each limit.
    pub limits: Vec<LimitOutcome>,
    /// Mean over these fruit of the volume of the largest bruise; m³.
    pub mean_largest: f64,
    /// What made bruises, the worst first.
    pub places: Vec<PlaceOutcome>,
}

/// Share of fruit above a limit.
#[derive(Clone, Copy, Debug, Serialize, utoipa::ToSchema)]
pub struct LimitOutcome {
    /// Volume of the largest bruise; m³.
    pub limit: f64,
    /// Share of fruit above it; 1.
    pub share: f64,
    /// Ends of the 95 % interval: other fruit, and the uncertainty of the coefficients.
    pub interval: [f64; 2],
}

/// Bruises made by one wall, or by other fruit.
#[derive(Clone, Debug, Serialize, utoipa::ToSchema)]
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

/// Contacts that are kept of a fruit: so many bruises are beyond all counting, and memory has
/// a bound.
pub const MOST_BLOWS: usize = 64;
/// Draws of an interval, and their seed.
const DRAWS: (usize, u64) = (1000, 1);
/// Stream of the seed for how fruit differ in their bruises.
const STREAM: u64 = 1 << 33;
/// Level of intervals; 1.
const LEVEL: f64 = 0.95;

/// That contacts were more than are kept.
pub fn finding_of_blows(blows: &Blows) -> Option<FindingOutcome> {
    let crowded = blows.crowded();
    (crowded > 0).then(|| {
        FindingOutcome::new(
            "many-blows",
            format!(
                "of fruit with more than {MOST_BLOWS} contacts that bruise only the {MOST_BLOWS} \
                 hardest count; {crowded} were left out. A larger threshold leaves out what does \
                 not bruise"
            ),
        )
    })
}

/// The largest bruise.
fn worst(bruises: &[Bruise]) -> Option<&Bruise> {
    bruises.iter().max_by(|a, b| a.volume.total_cmp(&b.volume))
}

impl Blows {
    /// Empty.
    ///
    /// * `shares`: part of the absorbed energy that a fruit takes, by the pair of materials;
    ///   half of it where two fruit meet, all of it on a wall, where nothing is said
    /// * `is_probe`: whether a fruit is an instrument, which does not bruise
    pub fn new(
        plan: &BruisePlan,
        scene: &Scene,
        shares: &BTreeMap<(usize, usize), f64>,
        is_probe: impl Fn(u32) -> bool,
    ) -> Self {
        let count = scene.fruit.len();
        let draws = [0, 1].map(|place| normals(plan.seed, STREAM + place, count));
        let [thresholds, volumes] = draws;
        Self {
            plan: plan.clone(),
            shares: shares.clone(),
            draws: thresholds.into_iter().zip(volumes).collect(),
            of: vec![Vec::new(); count],
            with: vec![Vec::new(); count],
            volumes: vec![Vec::new(); count],
            probes: (0..count).map(|own| is_probe(own as u32)).collect(),
            outside: [0; 2],
            crowded: 0,
        }
    }

    /// Counts a contact.
    pub fn count(&mut self, scene: &Scene, event: &Event) {
        let mass = |fruit: u32| scene.fruit[fruit as usize].mass;
        let own = mass(event.fruit);
        let after_walls = |fruit: u32| scene.walls.len() + fruit as usize;
        let (place, usual, mass) = match event.partner {
            Partner::Fruit(fruit) => {
                let other = mass(fruit);
                (after_walls(fruit), 0.5, own * other / (own + other))
            }
            Partner::Wall(wall) => (wall as usize, 1.0, own),
        };
        let share = self.shares.get(&scene.materials_of(event));
        let share = share.copied().unwrap_or(usual);
        let impact_energy = 0.5 * mass * event.normal_speed * event.normal_speed;
        let felt = |place| (share, impact_energy, place);
        self.strike(scene, event, (event.fruit, false), felt(place));
        if let Partner::Fruit(other) = event.partner {
            let place = after_walls(event.fruit);
            self.strike(scene, event, (other, true), felt(place));
        }
    }

    fn strike(
        &mut self,
        scene: &Scene,
        event: &Event,
        (fruit, other): (u32, bool),
        (share, impact_energy, place): (f64, f64, usize),
    ) {
        let number = fruit as usize;
        if self.probes[number] {
            return;
        }
        let (radius, mass) = (scene.fruit[number].mean_radius(), scene.fruit[number].mass);
        let mut blow = Blow::of(event, radius, other, share);
        let (threshold, volume) = self.draws[number];
        blow.fruit_draws = [threshold, volume];
        let mut outside = false;
        if let Some(regression) = &self.plan.regression {
            let contact = [
                blow.absorbed_energy,
                share * impact_energy,
                event.peak_force,
                event.normal_speed,
                event.duration,
                event.largest_displacement,
                radius,
                2.0 * radius,
                mass,
            ];
            let columns = regression.columns_of(&contact, &self.plan.properties[number]);
            outside = regression.is_outside(&columns);
            blow.terms = regression.terms_of(&columns);
            // Of the contact alone: whatever else happens, the draw is the same.
            let words = [self.plan.seed, u64::from(fruit), event.time.to_bits()];
            let with = match event.partner {
                Partner::Fruit(own) => u64::from(own),
                Partner::Wall(own) => u64::MAX - u64::from(own),
            };
            blow.draw = normal_of(&[words[0], words[1], words[2], with]);
        }
        if self.plan.model.may_bruise(&blow) {
            let volume = self.plan.model.volume(&blow);
            let bruises = volume > 0.0;
            self.outside[0] += usize::from(bruises && outside);
            self.outside[1] += usize::from(bruises);
            self.of[number].push(blow);
            self.with[number].push(place);
            self.volumes[number].push(volume);
        }
        if self.of[number].len() > MOST_BLOWS {
            let volumes = self.volumes[number].iter().enumerate();
            if let Some((weakest, _)) = volumes.min_by(|a, b| a.1.total_cmp(b.1)) {
                self.of[number].remove(weakest);
                self.with[number].remove(weakest);
                let bruised = self.volumes[number].remove(weakest) > 0.0;
                self.crowded += u64::from(bruised);
            }
        }
    }

    /// Contacts that bruise and are not kept: of a fruit that has more than [`MOST_BLOWS`] the
    /// weakest.
    pub fn crowded(&self) -> u64 {
        self.crowded
    }

    /// Writes what was counted.
    pub fn save(&self, to: &mut dyn Write) -> IoResult<()> {
        self.of.write(to)?;
        self.with.write(to)?;
        self.outside.write(to)?;
        self.crowded.write(to)
    }

    /// Takes up what [`Blows::save`] wrote of the same scene.
    ///
    /// # Errors
    /// Those of the reader; it is of another scene.
    pub fn take_up(&mut self, from: &mut dyn Read) -> IoResult<()> {
        let fruit = self.draws.len();
        self.of = Binary::read(from)?;
        self.with = Binary::read(from)?;
        self.outside = Binary::read(from)?;
        self.crowded = Binary::read(from)?;
        let volumes = |own: &Vec<Blow>| own.iter().map(|own| self.plan.model.volume(own)).collect();
        self.volumes = self.of.iter().map(volumes).collect();
        match self.of.len() == fruit && self.with.len() == fruit {
            true => Ok(()),
            false => Err(no_value("bruises of this scene")),
        }
    }

    /// How many fruit have a bruise above each limit, by the model as it is and by drawn ones:
    /// the same models for every scene of the same file.
    pub fn counts_above(&self, draws: (usize, u64)) -> Vec<Vec<usize>> {
        let (model, limits) = (&self.plan.model, &self.plan.limits);
        model.counts_above(&self.of, limits, draws)
    }

    /// A regression used outside of what it was of.
    pub fn finding_of_range(&self) -> Option<FindingOutcome> {
        let [outside, all] = self.outside;
        (outside > 0).then(|| {
            FindingOutcome::new(
                "bruise-range",
                format!(
                    "{outside} of {all} contacts that bruise ({:.1} %) lie outside of what the \
                 regression of bruises was of",
                    100.0 * outside as f64 / all as f64
                ),
            )
        })
    }

    /// Bruises of each fruit, by the model as it is.
    pub fn bruises(&self, plan: &BruisePlan) -> Vec<Vec<Bruise>> {
        self.of.iter().map(|own| plan.model.bruises(own)).collect()
    }

    /// Variance of the share of fruit above each limit over that of independent fruit, as pairs of
    /// fruit show it that bruised each other.
    ///
    /// * `walls`: how many the scene has
    pub fn variance_ratios(&self, walls: usize) -> Vec<f64> {
        let all = self.bruises(&self.plan);
        let limits = self.plan.limits.iter();
        limits
            .map(|limit| self.variance_ratio(&all, *limit, walls))
            .collect()
    }

    fn variance_ratio(&self, all: &[Vec<Bruise>], limit: f64, walls: usize) -> f64 {
        let bad: Vec<Option<&Bruise>> = all
            .iter()
            .map(|own| worst(own).filter(|bruise| bruise.volume > limit))
            .collect();
        let partner = |fruit: usize, own: &Bruise| self.with[fruit][own.contact].checked_sub(walls);
        let pairs = bad.iter().enumerate().filter_map(|(fruit, own)| {
            let other = partner(fruit, (*own)?)?;
            Some((fruit.min(other), fruit.max(other)))
        });
        let mut pairs: Vec<(usize, usize)> = pairs.collect();
        pairs.sort_unstable();
        pairs.dedup();
        // Probes are neither among the fruit nor in pairs.
        let counted: Vec<usize> = (0..bad.len()).filter(|own| !self.probes[*own]).collect();
        let among = |fruit: usize| counted.binary_search(&fruit).ok();
        let pairs = pairs
            .iter()
            .filter_map(|&(a, b)| Some((among(a)?, among(b)?)));
        let pairs: Vec<(usize, usize)> = pairs.collect();
        let bruised: Vec<bool> = counted.iter().map(|own| bad[*own].is_some()).collect();
        variance_ratio(&bruised, &pairs)
    }

    /// The result.
    pub fn outcome(&self, plan: &BruisePlan, scene: &Scene) -> BruiseOutcome {
        let all = self.bruises(plan);
        let walls = scene.walls.len();
        let ratios = self.variance_ratios(walls);
        let limits: Vec<(f64, f64)> = plan.limits.iter().copied().zip(ratios).collect();
        // Probes have no blows.
        let fruit = self.probes.iter().filter(|probe| !**probe).count();
        let model = &plan.model;
        let shares = model.shares_above((&self.of, fruit), &limits, LEVEL, DRAWS);
        let limits = plan.limits.iter().zip(shares);
        let limits = limits.map(|(&limit, found)| LimitOutcome {
            limit,
            share: found.share,
            interval: [found.low, found.high],
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
        let mut largest = 0.0;
        for (bruises, with) in all.iter().zip(&self.with) {
            let place = |bruise: &Bruise| with[bruise.contact].min(walls);
            let worst = worst(bruises);
            for bruise in bruises {
                let own = &mut places[place(bruise)];
                own.bruises += 1;
                own.largest = own.largest.max(bruise.volume);
            }
            if let Some(worst) = worst {
                largest += worst.volume;
                places[place(worst)].fruit += 1;
            }
        }
        places.retain(|own| own.bruises > 0);
        places.sort_by(|a, b| b.fruit.cmp(&a.fruit).then(b.largest.total_cmp(&a.largest)));
        BruiseOutcome {
            fruit,
            limits: limits.collect(),
            mean_largest: largest / fruit.max(1) as f64,
            places,
        }
    }
}
