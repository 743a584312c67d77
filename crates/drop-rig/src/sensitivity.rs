//! What a drop shows, with exact derivatives by law, fruit and rig.

use crate::event::DropSeeds;
use crate::rig::DropRig;
use crate::simulate::{drop_event, tally_drop};
use crate::tally::ImpactTally;
use windfall_contact::law::EndRule;
use windfall_contact::laws::any_law::LARGEST_PARAMETERS;
use windfall_contact::laws::kind::Law;
use windfall_identify::error::{Error, check_positive};
use windfall_numerics::real::Lanes;

/// Relative accuracy of the integration for features: far below what any bench
/// measures.
pub(crate) const FEATURE_ACCURACY: f64 = 1e-10;

/// Quantities that a drop is differentiated by, at most at once.
pub const MOST_FREE: usize = 11;

/// A quantity that a drop depends on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DropQuantity {
    /// A parameter of the law, by its place.
    Law(usize),
    /// Acceleration between impacts.
    Gravity,
    /// A quantity of the rig.
    Rig(RigQuantity),
}

/// Quantities of the rig that features depend on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RigQuantity {
    /// Mass of the fruit; kg.
    Mass,
    /// Drop height; m.
    Height,
    /// Effective mass factor; 1.
    EffectiveMassFactor,
    /// Mass of the plate; kg.
    PlateMass,
    /// Stiffness of its support; N/m.
    PlateStiffness,
    /// Damping of its support; N s/m.
    PlateDamping,
}

impl RigQuantity {
    /// All of them, in the order of derivatives.
    pub const ALL: [Self; 6] = [
        Self::Mass,
        Self::Height,
        Self::EffectiveMassFactor,
        Self::PlateMass,
        Self::PlateStiffness,
        Self::PlateDamping,
    ];

    pub(crate) fn get(self, rig: &DropRig, height: f64) -> Option<f64> {
        Some(match self {
            Self::Mass => rig.mass,
            Self::Height => height,
            Self::EffectiveMassFactor => rig.effective_mass_factor,
            Self::PlateMass => rig.plate?.mass,
            Self::PlateStiffness => rig.plate?.stiffness,
            Self::PlateDamping => rig.plate?.damping,
        })
    }

    /// Replaces the value in a rig or height.
    pub fn put(self, rig: &mut DropRig, height: &mut f64, value: f64) {
        match (self, rig.plate.as_mut()) {
            (Self::Mass, _) => rig.mass = value,
            (Self::Height, _) => *height = value,
            (Self::EffectiveMassFactor, _) => rig.effective_mass_factor = value,
            (Self::PlateMass, Some(plate)) => plate.mass = value,
            (Self::PlateStiffness, Some(plate)) => plate.stiffness = value,
            (Self::PlateDamping, Some(plate)) => plate.damping = value,
            (_, None) => {}
        }
    }
}

/// A value with its derivatives by the free quantities.
#[derive(Clone, Debug, PartialEq)]
pub struct Differentiated {
    /// The value; SI.
    pub value: f64,
    /// Its derivative by each free quantity, in their order; SI.
    pub by: Vec<f64>,
}

/// One impact of a drop, times from the release.
#[derive(Clone, Debug, PartialEq)]
pub struct ImpactFeatures {
    /// First touch; s.
    pub onset_time: Differentiated,
    /// Largest force between fruit and plate; N.
    pub peak_contact_force: Differentiated,
    /// Largest force on the support; N.
    pub peak_support_force: Differentiated,
    /// Largest indentation; m.
    pub max_displacement: Differentiated,
    /// From first touch until the force is back at zero; s. `None` where the
    /// fruit stays.
    pub contact_duration: Option<Differentiated>,
    /// The gap opens; s. `None` where the fruit stays.
    pub separation_time: Option<Differentiated>,
    /// Velocity of the fruit then, up positive; m/s.
    pub separation_velocity: Option<Differentiated>,
}

/// The impacts of a drop with derivatives.
#[derive(Clone, Debug, PartialEq)]
pub struct DropFeatures {
    /// In order of time; fewer than requested where the fruit comes to rest.
    pub impacts: Vec<ImpactFeatures>,
    /// From onset to onset, the last to the first touch after `impacts`; s.
    pub intervals: Vec<Differentiated>,
}

/// Seeds with a one in the lane of each free quantity, for derivatives by the
/// quantities themselves.
pub(crate) fn seeds_of<const W: usize>(
    free: &[DropQuantity],
    rig: &DropRig,
    velocity: f64,
) -> DropSeeds<LARGEST_PARAMETERS, W> {
    let mut seeds = DropSeeds::NONE;
    for (i, &quantity) in free.iter().enumerate() {
        let one = |slope: f64| Lanes::unit(i + 1, slope);
        match quantity {
            DropQuantity::Law(parameter) => seeds.parameters[parameter] += one(1.0),
            DropQuantity::Gravity => {
                seeds.gravity += one(1.0);
                seeds.velocity += one(0.5 * velocity / rig.gravity);
            }
            DropQuantity::Rig(quantity) => match quantity {
                RigQuantity::Height => seeds.velocity += one(rig.gravity / velocity),
                RigQuantity::Mass => seeds.mass += one(1.0),
                RigQuantity::EffectiveMassFactor => seeds.effective_mass_factor += one(1.0),
                RigQuantity::PlateMass => seeds.plate_mass += one(1.0),
                RigQuantity::PlateStiffness => seeds.plate_stiffness += one(1.0),
                RigQuantity::PlateDamping => seeds.plate_damping += one(1.0),
            },
        }
    }
    seeds
}

/// Impacts of a drop with exact derivatives by `free`.
///
/// # Errors
/// As [`crate::simulate::simulate_drop`]; [`Error::TooManyFree`] for more
/// than [`MOST_FREE`] quantities.
///
/// # Numerics
/// The derivatives are integrated with the motion and carried over each event;
/// a peak's derivative is that at fixed time, as its slope in time is zero.
/// With [`EndRule::GapZero`] laws that start like √d have no derivatives at the
/// end of contact, and the integration fails.
pub fn drop_features(
    law: &Law,
    rig: &DropRig,
    height: f64,
    impacts: usize,
    end: EndRule,
    free: &[DropQuantity],
) -> Result<DropFeatures, Error> {
    match free.len() {
        0..=3 => features::<4>(law, rig, height, impacts, end, free),
        4..=7 => features::<8>(law, rig, height, impacts, end, free),
        8..=MOST_FREE => features::<12>(law, rig, height, impacts, end, free),
        asked => Err(Error::TooManyFree {
            asked,
            most: MOST_FREE,
        }),
    }
}

fn features<const W: usize>(
    law: &Law,
    rig: &DropRig,
    height: f64,
    impacts: usize,
    end: EndRule,
    free: &[DropQuantity],
) -> Result<DropFeatures, Error> {
    rig.check()?;
    check_positive("height", height)?;
    let velocity = rig.impact_velocity(height);
    let seeds = seeds_of(free, rig, velocity);
    let event = drop_event::<W>(law, rig, velocity, end, (seeds, FEATURE_ACCURACY));
    let found = tally_drop(&event, impacts)?;
    // Release to first touch, v/g.
    let mut fall = event.seeds.velocity * (1.0 / rig.gravity)
        + event.seeds.gravity * (-velocity / (rig.gravity * rig.gravity));
    fall.0[0] = velocity / rig.gravity;
    let plain = |lanes: Lanes<W>| Differentiated {
        value: lanes.0[0],
        by: lanes.0[1..=free.len()].to_vec(),
    };
    let touches = found.impacts.iter().map(|one| one.touch.time);
    let touches: Vec<Lanes<W>> = touches
        .chain(found.beyond.map(|touch| touch.time))
        .collect();
    let intervals = touches.windows(2).map(|pair| plain(pair[1] - pair[0]));
    let one = |tally: &ImpactTally<W>| ImpactFeatures {
        onset_time: plain(fall + tally.touch.time),
        peak_contact_force: plain(tally.contact_force.value),
        peak_support_force: plain(tally.support_force.value),
        max_displacement: plain(tally.displacement.value),
        contact_duration: tally
            .departure
            .map(|left| plain(left.force_end - tally.touch.time)),
        separation_time: tally.departure.map(|left| plain(fall + left.time)),
        separation_velocity: tally.departure.map(|left| plain(left.velocity)),
    };
    Ok(DropFeatures {
        intervals: intervals.collect(),
        impacts: found.impacts.iter().map(one).collect(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rig::Plate;
    use crate::simulate::simulate_drop;
    use windfall_contact::expression::parse_law;

    const FREE: [DropQuantity; 10] = [
        DropQuantity::Law(0),
        DropQuantity::Law(1),
        DropQuantity::Law(2),
        DropQuantity::Gravity,
        DropQuantity::Rig(RigQuantity::Mass),
        DropQuantity::Rig(RigQuantity::Height),
        DropQuantity::Rig(RigQuantity::EffectiveMassFactor),
        DropQuantity::Rig(RigQuantity::PlateMass),
        DropQuantity::Rig(RigQuantity::PlateStiffness),
        DropQuantity::Rig(RigQuantity::PlateDamping),
    ];

    /// Everything that a drop shows, as one row.
    fn row(law: &Law, rig: &DropRig, height: f64, end: EndRule) -> Vec<f64> {
        let found = simulate_drop(law, rig, height, 3, end).unwrap();
        let mut row = found.intervals.clone();
        let last = found.impacts.last().unwrap();
        row.push(found.next_onset.unwrap() - last.onset_time);
        for impact in &found.impacts {
            row.extend([
                impact.onset_time,
                impact.peak_contact_force,
                impact.peak_support_force,
                impact.max_displacement,
                impact.separation_time,
                impact.separation_velocity,
                impact.force_end_time - impact.onset_time,
            ]);
        }
        row
    }

    fn moved(
        law: &Law,
        rig: &DropRig,
        height: f64,
        quantity: DropQuantity,
        by: f64,
    ) -> (Law, DropRig, f64) {
        let (mut law, mut rig, mut height) = (*law, *rig, height);
        match quantity {
            DropQuantity::Law(i) => {
                let mut values = law.parameters().to_vec();
                values[i] *= 1.0 + by;
                law = law.kind().with_parameters(&values).unwrap();
            }
            DropQuantity::Gravity => rig.gravity *= 1.0 + by,
            DropQuantity::Rig(quantity) => {
                let value = quantity.get(&rig, height).unwrap() * (1.0 + by);
                quantity.put(&mut rig, &mut height, value);
            }
        }
        (law, rig, height)
    }

    fn value_of(law: &Law, rig: &DropRig, height: f64, quantity: DropQuantity) -> f64 {
        match quantity {
            DropQuantity::Law(i) => law.parameters()[i],
            DropQuantity::Gravity => rig.gravity,
            DropQuantity::Rig(quantity) => quantity.get(rig, height).unwrap(),
        }
    }

    /// Through three bounces on a plate that still rings, by every quantity:
    /// against differences of the simulation, for laws of every kind.
    #[test]
    fn derivative_of_every_feature() {
        let rig = DropRig {
            mass: 4.8e-3,
            effective_mass_factor: 0.9,
            gravity: 9.80665,
            plate: Some(Plate {
                mass: 0.05,
                stiffness: 4e4,
                damping: 1.5,
            }),
        };
        let laws = [
            ("adams-impact(k=466143.6, e=1.91, c=0.556, d=1e-5)", 3),
            ("kuwabara-kono(k=4e5, c=60)", 2),
            ("kelvin-voigt(k=3e3, c=0.3)", 2),
            ("walton-braun(k1=3e3, k2=4e3)", 2),
            ("hunt-crossley(k=4e5, lambda=2e4)", 2),
        ];
        for (text, parameters) in laws {
            let law = parse_law(text).unwrap().complete().unwrap();
            for end in [EndRule::ForceZero, EndRule::GapZero] {
                // Where the gap opens while a force acts that begins like √d,
                // or with a jump, the derivatives have no limit.
                let singular = ["walton", "kuwabara", "kelvin"]
                    .iter()
                    .any(|l| text.starts_with(l));
                if end == EndRule::GapZero && singular {
                    continue;
                }
                // Where a contact ends with its gap, force and slope break off:
                // the simulation itself is good to ten digits only.
                let tolerance = match end {
                    EndRule::ForceZero => 2e-5,
                    EndRule::GapZero => 5e-4,
                };
                let free: Vec<DropQuantity> = FREE
                    .into_iter()
                    .filter(|q| !matches!(q, DropQuantity::Law(i) if *i >= parameters))
                    .collect();
                let exact = drop_features(&law, &rig, 0.2, 3, end, &free).unwrap();
                assert_eq!(exact.impacts.len(), 3, "{text}");
                let mut all = exact.intervals.clone();
                for impact in exact.impacts {
                    all.extend([
                        impact.onset_time,
                        impact.peak_contact_force,
                        impact.peak_support_force,
                        impact.max_displacement,
                        impact.separation_time.unwrap(),
                        impact.separation_velocity.unwrap(),
                        impact.contact_duration.unwrap(),
                    ]);
                }
                for (column, &quantity) in free.iter().enumerate() {
                    let h = 2e-6;
                    let at = |by: f64| {
                        let (law, rig, height) = moved(&law, &rig, 0.2, quantity, by);
                        row(&law, &rig, height, end)
                    };
                    let [after, before, after2, before2] = [h, -h, 2.0 * h, -2.0 * h].map(at);
                    let scale = value_of(&law, &rig, 0.2, quantity);
                    for (i, feature) in all.iter().enumerate() {
                        let near = (after[i] - before[i]) / (2.0 * h);
                        let far = (after2[i] - before2[i]) / (4.0 * h);
                        let difference = near + (near - far) / 3.0;
                        let found = feature.by[column] * scale;
                        assert!(
                            (found - difference).abs()
                                < tolerance * (difference.abs() + 0.03 * feature.value.abs()),
                            "{text} {end:?} feature {i} by {quantity:?}: {found} {difference}"
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn rejects_more_than_it_can_hold() {
        let law = parse_law("hertz(k=4e5)").unwrap().complete().unwrap();
        let rig = DropRig {
            mass: 4.8e-3,
            effective_mass_factor: 1.0,
            gravity: 9.80665,
            plate: None,
        };
        let free = [DropQuantity::Rig(RigQuantity::Height); 12];
        let error = drop_features(&law, &rig, 0.2, 3, EndRule::ForceZero, &free).unwrap_err();
        assert!(error.to_string().contains("12"), "{error}");
    }
}
