//! Contacts of two fruit, compiled once for each law.

use crate::contact::{Moment, Outcome, Parcel, encounter, event_of_pair, parted, too_deep};
use crate::error::{Error, fruit_name};
use crate::event::Encounter;
use crate::interaction::Interaction;
use crate::neighbours::{Bodies, NONE};
use crate::pair_forces::{Batch, Hot, PairForce};
use crate::react::{History, dot, surface_velocity};
use crate::vector::{Vector, length, plus_scaled, scaled, subtract, turned_back};
use windfall_contact::effective::effective_radius;
use windfall_contact::law::ContactLaw;
use windfall_contact::law_kind as laws;
use windfall_contact::law_kind::Law;
use windfall_numerics::real_vector::with_four_lanes;

/// The entries of one block and one interaction.
pub(crate) struct Part<'a> {
    pub bodies: &'a Bodies,
    pub first: &'a [u32],
    pub second: &'a [u32],
    pub slot: &'a mut [u32],
    /// Force and moment of pairs on the bodies of the block, and the first of them.
    pub loads: &'a mut [[f64; 8]],
    pub base: usize,
    pub out: &'a mut [PairForce],
    /// Moment against rolling on the first body; N m. Empty where nothing resists it.
    pub rolling: &'a mut [Vector],
}

/// Contacts of one block and one interaction.
pub(crate) trait PairContacts: Send + Sync {
    /// Forces of all entries, one step on.
    fn advance(&mut self, part: Part, surface: &Interaction, now: &Moment, outcome: &mut Outcome);
    /// Number of contacts.
    fn count(&self) -> usize;
    /// Takes over a contact; its number.
    fn adopt(&mut self, entry: u32, law: &Law, parcel: Parcel) -> u32;
    /// The entry, law and memory of a contact.
    fn at(&self, contact: usize) -> (u32, Law, Parcel);
}

/// New contacts under the law of an interaction.
pub(crate) fn pair_contacts(law: &Law) -> Box<dyn PairContacts> {
    macro_rules! of {
        ($($variant:ident)*) => {
            match law {
                $(Law::$variant(_) => Box::new(Contacts::<laws::$variant, _>::default()),)*
                Law::User(_) => Box::new(Contacts::<windfall_contact::law_user::UserLaw, _>::default()),
            }
        };
    }
    of! {
        Hertz KelvinVoigt KuwabaraKono PowerLaw HuntCrossley LankaraniNikravesh Flores
        HerbertMcWhannell Tsuji AdamsImpact WaltonBraun Thornton
    }
}

/// A law that is one of the registry's variants.
trait Variant: Copy {
    fn of(law: &Law) -> Option<Self>;
    fn law(self) -> Law;
}

macro_rules! variants {
    ($($variant:ident: $type:ty,)*) => {
        $(impl Variant for $type {
            fn of(law: &Law) -> Option<Self> {
                match law {
                    Law::$variant(own) => Some(*own),
                    _ => None,
                }
            }

            fn law(self) -> Law {
                Law::$variant(self)
            }
        })*
    };
}

variants! {
    Hertz: laws::Hertz,
    KelvinVoigt: laws::KelvinVoigt,
    KuwabaraKono: laws::KuwabaraKono,
    PowerLaw: laws::PowerLaw,
    HuntCrossley: laws::HuntCrossley,
    LankaraniNikravesh: laws::LankaraniNikravesh,
    Flores: laws::Flores,
    HerbertMcWhannell: laws::HerbertMcWhannell,
    Tsuji: laws::Tsuji,
    AdamsImpact: laws::AdamsImpact,
    WaltonBraun: laws::WaltonBraun,
    Thornton: laws::Thornton,
    User: windfall_contact::law_user::UserLaw,
}

/// Contacts under one law; what is needed in every step stands apart from the rest.
struct Contacts<L, const N: usize> {
    hot: Vec<Hot<L>>,
    /// Moments against rolling; N m.
    rolling: Vec<Vector>,
    encounters: Vec<Encounter>,
    entries: Vec<u32>,
    /// Entries that overlap in the present step.
    touching: Vec<u32>,
    /// Entries that do so no more.
    parting: Vec<u32>,
}

impl<L, const N: usize> Default for Contacts<L, N> {
    fn default() -> Self {
        Self {
            hot: Vec::new(),
            rolling: Vec::new(),
            encounters: Vec::new(),
            entries: Vec::new(),
            touching: Vec::new(),
            parting: Vec::new(),
        }
    }
}

/// Overlap over the smaller radius above which a law of two spheres means nothing.
pub(crate) const LARGEST_OVERLAP: f64 = 0.3;

impl<L: ContactLaw<N> + Variant, const N: usize> PairContacts for Contacts<L, N> {
    fn advance(&mut self, part: Part, surface: &Interaction, now: &Moment, outcome: &mut Outcome) {
        let Part {
            bodies,
            first,
            second,
            slot,
            loads,
            base,
            out,
            rolling,
        } = part;
        self.sort_out(first, second, slot, bodies);
        for place in 0..self.parting.len() {
            let entry = self.parting[place] as usize;
            let (i, j) = (first[entry] as usize, second[entry] as usize);
            let gap = -overlap(bodies, i, j);
            let fruit = (bodies.fruit[i], bodies.fruit[j]);
            self.finish(entry, slot, fruit, gap, now, outcome);
        }
        for place in 0..self.touching.len() {
            let entry = self.touching[place] as usize;
            if slot[entry] == NONE {
                let pair = (first[entry] as usize, second[entry] as usize);
                match self.begin(entry, pair, bodies, (surface, now)) {
                    Ok(own) => slot[entry] = own,
                    Err(problem) => {
                        outcome.problem.get_or_insert(problem);
                        return;
                    }
                }
            }
        }
        let multiples = surface.spread.is_none();
        let deepest = with_four_lanes(Batch::<L, N> {
            median: if multiples { L::of(&surface.law) } else { None },
            bodies,
            first,
            second,
            slot,
            loads,
            base,
            out,
            rolling_out: rolling,
            touching: &self.touching,
            hot: &mut self.hot,
            rolling: &mut self.rolling,
            surface,
            clock: now.clock,
        });
        if deepest > LARGEST_OVERLAP {
            outcome
                .problem
                .get_or_insert_with(|| self.deepest(first, second, bodies, now));
        }
    }

    fn count(&self) -> usize {
        self.hot.len()
    }

    fn adopt(&mut self, entry: u32, law: &Law, parcel: Parcel) -> u32 {
        // The law of an interaction keeps its kind.
        if let Some(law) = L::of(law) {
            let (scale, history) = (parcel.scale, parcel.history);
            self.hot.push(Hot {
                law,
                scale,
                history,
            });
            self.rolling.push(parcel.rolling);
            self.encounters.push(parcel.encounter);
            self.entries.push(entry);
        }
        (self.hot.len() - 1) as u32
    }

    fn at(&self, contact: usize) -> (u32, Law, Parcel) {
        let law = self.hot[contact].law.law();
        (self.entries[contact], law, self.parcel(contact))
    }
}

impl<L: ContactLaw<N> + Variant, const N: usize> Contacts<L, N> {
    fn parcel(&self, contact: usize) -> Parcel {
        Parcel {
            scale: self.hot[contact].scale,
            history: self.hot[contact].history,
            rolling: self.rolling[contact],
            encounter: self.encounters[contact],
        }
    }

    /// Which entries touch, and which did and do no more. Without a branch on what follows
    /// no pattern; not less is also what is no number.
    fn sort_out(&mut self, first: &[u32], second: &[u32], slot: &[u32], bodies: &Bodies) {
        self.touching.resize(first.len(), 0);
        self.parting.clear();
        let mut count = 0;
        for entry in 0..first.len() {
            let a = &bodies.place[first[entry] as usize];
            let b = &bodies.place[second[entry] as usize];
            let between = [b[0] - a[0], b[1] - a[1], b[2] - a[2]];
            let reach = a[3] + b[3];
            let apart = dot(between, between) >= reach * reach;
            self.touching[count] = entry as u32;
            count += usize::from(!apart);
            if apart && slot[entry] != NONE {
                self.parting.push(entry as u32);
            }
        }
        self.touching.truncate(count);
    }

    #[cold]
    fn begin(
        &mut self,
        entry: usize,
        (i, j): (usize, usize),
        bodies: &Bodies,
        (surface, now): (&Interaction, &Moment),
    ) -> Result<u32, Error> {
        let draws = |body: usize| &now.fruit[bodies.fruit[body] as usize].draws;
        let centre = |body: usize| [0, 1, 2].map(|axis| bodies.place[body][axis]);
        let (a, b) = (bodies.place[i][3], bodies.place[j][3]);
        let radius = effective_radius(a, b);
        let displacement = overlap(bodies, i, j);
        let between = subtract(centre(j), centre(i));
        let normal = scaled(between, 1.0 / length(between));
        let (u, w) = (&bodies.motion[i], &bodies.motion[j]);
        let relative = [u[0] - w[0], u[1] - w[1], u[2] - w[2]];
        let arms = [4, 5, 6].map(|at| a * u[at] + b * w[at]);
        let velocity = surface_velocity(relative, arms, normal);
        let mut encounter = encounter(normal, displacement, velocity, now.clock);
        encounter.place = plus_scaled(centre(i), normal, a - 0.5 * displacement);
        encounter.spot = turned_back(bodies.turn[i], normal);
        encounter.other_spot = turned_back(bodies.turn[j], scaled(normal, -1.0));
        let parcel = Parcel {
            scale: surface.scale(radius),
            history: History::at(now.clock.time, dot(velocity, normal)),
            rolling: [0.0; 3],
            encounter,
        };
        let law = surface.law_of(radius, draws(i), Some(draws(j)))?;
        Ok(self.adopt(entry as u32, &law, parcel))
    }

    /// The pair that overlaps too much.
    #[cold]
    fn deepest(&self, first: &[u32], second: &[u32], bodies: &Bodies, now: &Moment) -> Error {
        let share = |entry: u32| {
            let (i, j) = (
                first[entry as usize] as usize,
                second[entry as usize] as usize,
            );
            let radius = bodies.place[i][3].min(bodies.place[j][3]);
            (overlap(bodies, i, j) / radius, i, j, radius)
        };
        let all = self.touching.iter().map(|&entry| share(entry));
        let (share, i, j, radius) =
            all.fold((0.0, 0, 0, 1.0), |a, b| if b.0 > a.0 { b } else { a });
        let partner = fruit_name(bodies.fruit[j]);
        too_deep(
            now.clock.time,
            bodies.fruit[i],
            partner,
            share * radius,
            radius,
        )
    }

    /// A contact whose bodies part.
    #[cold]
    fn finish(
        &mut self,
        entry: usize,
        slot: &mut [u32],
        fruit: (u32, u32),
        gap: f64,
        now: &Moment,
        outcome: &mut Outcome,
    ) {
        let own = slot[entry] as usize;
        let parted = parted(self.parcel(own), gap, now.clock);
        outcome.events.push(event_of_pair(parted, fruit, false));
        slot[entry] = NONE;
        self.hot.swap_remove(own);
        self.rolling.swap_remove(own);
        self.encounters.swap_remove(own);
        self.entries.swap_remove(own);
        if let Some(&moved) = self.entries.get(own) {
            slot[moved as usize] = own as u32;
        }
    }
}

/// How far two bodies overlap; m.
fn overlap(bodies: &Bodies, i: usize, j: usize) -> f64 {
    let (a, b) = (&bodies.place[i], &bodies.place[j]);
    a[3] + b[3] - length([b[0] - a[0], b[1] - a[1], b[2] - a[2]])
}
