//! Parameters of a waveform calibration: what the minimiser moves ↔ law, rig
//! and seeds of the motion.

use crate::arrow_system::{OWN, SHARED};
use crate::event::DropSeeds;
use crate::rig::{DropRig, Plate};
use crate::waveform::{DropRecord, Knowledge, WaveformProblem};
use windfall_contact::laws::any_law::LARGEST_PARAMETERS;
use windfall_contact::laws::kind::Law;
use windfall_identify::error::Error;
use windfall_numerics::real::Lanes;

/// Places of the rig's quantities among the shared parameters.
pub(crate) const STIFFNESS: usize = LARGEST_PARAMETERS;
pub(crate) const DAMPING: usize = STIFFNESS + 1;
pub(crate) const PLATE_MASS: usize = STIFFNESS + 2;
pub(crate) const FACTOR: usize = STIFFNESS + 3;
/// Places of a record's own parameters.
pub(crate) const ONSET: usize = 0;
pub(crate) const VELOCITY: usize = 1;
pub(crate) const MASS: usize = 2;
pub(crate) const LEVEL: usize = 3;

/// Upper bound over start value above which a parameter is moved by its
/// logarithm.
const WIDE: f64 = 1e5;

/// Where the minimiser stands.
#[derive(Clone, Debug)]
pub(crate) struct Point {
    /// What is moved of the shared parameters.
    pub shared: [f64; SHARED],
    /// Parameters of each record: onset, logarithms of velocity and mass, level.
    pub own: Vec<[f64; OWN]>,
}

/// A shared parameter as the minimiser sees it.
#[derive(Clone, Debug)]
pub(crate) struct SharedParameter {
    /// Its place.
    pub place: usize,
    /// Its name.
    pub name: String,
    /// Whether its logarithm is moved.
    pub logarithmic: bool,
    /// Exponents of the law that are free and stand in its unit, by place: the
    /// minimiser moves ln p + Σ exponent ln(reference), the logarithm of a force
    /// at the reference displacement, which the exponent does not drag along.
    pub exponents: Vec<usize>,
    /// Legal values.
    pub bounds: (f64, f64),
    /// Standard uncertainty known beforehand, of what is moved, and its value.
    pub prior: Option<(f64, f64)>,
}

/// How parameters are moved.
#[derive(Clone, Debug)]
pub(crate) struct Parameters {
    /// What is shared and moves.
    pub shared: Vec<SharedParameter>,
    /// Logarithm of the reference displacement; m.
    pub reference: f64,
    /// Values of the shared parameters, moved or not; SI.
    pub start: [f64; SHARED],
    /// Whether the rig has a plate that moves.
    pub plate: bool,
    /// Acceleration between impacts; m/s².
    pub gravity: f64,
    /// Kind of law and its number of parameters.
    pub law: Law,
}

/// What a record begins with.
pub(crate) fn own_start(record: &DropRecord) -> [f64; OWN] {
    [
        record.onsets.first().copied().unwrap_or(0.0),
        record.velocity.start().ln(),
        record.mass.start().ln(),
        0.0,
    ]
}

/// Prior on the logarithm of a positive quantity.
pub(crate) fn log_prior(knowledge: Knowledge) -> Option<(f64, f64)> {
    match knowledge {
        Knowledge::Prior(known) => Some((known.value.ln(), known.sd / known.value)),
        _ => None,
    }
}

/// Plans the parameters of a problem.
///
/// * `reference`: displacement that the impacts reach, about; m
pub(crate) fn plan(problem: &WaveformProblem, reference: f64) -> Result<Parameters, Error> {
    let law = problem.law;
    let description = law.kind().describe();
    if problem.free.is_empty() {
        return Err(Error::NothingToFit {
            law: description.name,
        });
    }
    let mut start = [1.0; SHARED];
    for (place, value) in law.parameters().into_iter().enumerate() {
        start[place] = value;
    }
    let mut shared = Vec::new();
    for &place in &problem.free {
        let parameter = &description.parameters[place];
        let exponents = problem.free.iter().copied().filter(|&other| {
            let name = description.parameters[other].name;
            let unit = parameter.unit;
            other != place
                && (unit.contains(&format!("^{name}")) || unit.contains(&format!("^({name}")))
        });
        shared.push(SharedParameter {
            place,
            name: parameter.name.to_owned(),
            logarithmic: start[place] > 0.0 && parameter.upper > WIDE * start[place],
            exponents: exponents.collect(),
            bounds: (parameter.lower, parameter.upper),
            prior: None,
        });
    }
    let mut of_rig = |place: usize, name: &str, knowledge: Knowledge| {
        start[place] = knowledge.start();
        if !matches!(knowledge, Knowledge::Fixed(_)) {
            shared.push(SharedParameter {
                place,
                name: name.to_owned(),
                logarithmic: true,
                exponents: Vec::new(),
                bounds: (f64::MIN_POSITIVE, f64::INFINITY),
                prior: log_prior(knowledge),
            });
        }
    };
    if let Some(plate) = &problem.rig.plate {
        of_rig(STIFFNESS, "plate_stiffness", plate.stiffness);
        of_rig(DAMPING, "plate_damping", plate.damping);
        of_rig(PLATE_MASS, "plate_mass", plate.mass);
    }
    let factor = problem.rig.effective_mass_factor;
    of_rig(FACTOR, "effective_mass_factor", factor);
    Ok(Parameters {
        shared,
        reference: reference.ln(),
        start,
        plate: problem.rig.plate.is_some(),
        gravity: problem.rig.gravity,
        law,
    })
}

impl Parameters {
    /// From values of the law and the rig to what is moved.
    pub fn moved(&self, values: &[f64; SHARED]) -> [f64; SHARED] {
        let mut moved = [0.0; SHARED];
        for parameter in &self.shared {
            let value = values[parameter.place];
            moved[parameter.place] = match parameter.logarithmic {
                true => value.ln() + self.dragged(parameter, values),
                false => value,
            };
        }
        moved
    }

    fn dragged(&self, parameter: &SharedParameter, values: &[f64; SHARED]) -> f64 {
        let exponents = parameter.exponents.iter();
        exponents.map(|&place| values[place] * self.reference).sum()
    }

    /// From what is moved to values of the law and the rig, within their bounds.
    pub fn values(&self, moved: &[f64; SHARED]) -> [f64; SHARED] {
        let mut values = self.start;
        // Exponents first: they are plain, and stand in others.
        for parameter in self.shared.iter().filter(|p| !p.logarithmic) {
            let (lower, upper) = parameter.bounds;
            values[parameter.place] = moved[parameter.place].clamp(lower, upper);
        }
        for parameter in self.shared.iter().filter(|p| p.logarithmic) {
            let value = (moved[parameter.place] - self.dragged(parameter, &values)).exp();
            let (lower, upper) = parameter.bounds;
            values[parameter.place] = value.clamp(lower, upper);
        }
        values
    }

    /// The law at values.
    pub fn law(&self, values: &[f64; SHARED]) -> Result<Law, Error> {
        let kind = self.law.kind();
        let count = kind.describe().parameters.len();
        Ok(kind.with_parameters(&values[..count])?)
    }

    /// The rig at values, with a fruit of `mass`.
    pub fn rig(&self, values: &[f64; SHARED], mass: f64) -> DropRig {
        DropRig {
            mass,
            effective_mass_factor: values[FACTOR],
            gravity: self.gravity,
            plate: self.plate.then_some(Plate {
                mass: values[PLATE_MASS],
                stiffness: values[STIFFNESS],
                damping: values[DAMPING],
            }),
        }
    }

    /// Lanes of the motion: first those of the shared parameters, in their
    /// order, then velocity and mass. Derivatives are by what is moved.
    pub fn seeds<const W: usize>(
        &self,
        values: &[f64; SHARED],
        velocity: f64,
        mass: f64,
    ) -> DropSeeds<LARGEST_PARAMETERS, W> {
        let mut seeds = DropSeeds::NONE;
        for (i, parameter) in self.shared.iter().enumerate() {
            let value = values[parameter.place];
            let slope = if parameter.logarithmic { value } else { 1.0 };
            let one = Lanes::unit(i + 1, slope);
            match parameter.place {
                STIFFNESS => seeds.plate_stiffness = one,
                DAMPING => seeds.plate_damping = one,
                PLATE_MASS => seeds.plate_mass = one,
                FACTOR => seeds.effective_mass_factor = one,
                place => seeds.parameters[place] += one,
            }
        }
        // An exponent that moves takes along what is held at the reference.
        for parameter in &self.shared {
            for (j, exponent) in self.shared.iter().enumerate() {
                if parameter.exponents.contains(&exponent.place) {
                    let slope = -values[parameter.place] * self.reference;
                    seeds.parameters[parameter.place] += Lanes::unit(j + 1, slope);
                }
            }
        }
        let own = self.shared.len();
        seeds.velocity = Lanes::unit(own + 1, velocity);
        seeds.mass = Lanes::unit(own + 2, mass);
        seeds
    }
}
