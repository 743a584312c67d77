//! `[rig]` of campaign.toml.

use crate::settings::file::{QuantityText, RigFile};
use crate::settings::model::{MassPlan, RigPlan};
use std::ops::Range;
use windfall_files::error::Error;
use windfall_files::text::spanned::Spanned;
use windfall_files::text::toml_source::{
    Needed, TomlSource, choice, missing, needed_quantity, quantity_from_zero, refused,
    uncertain_quantity, uncertainty,
};
use windfall_identify::rig::bench::{BenchQuantity, BenchSd};
use windfall_identify::rig::kind::Pendulum;

/// Standard acceleration of gravity, where the campaign gives none; m/s².
///
/// # Source
/// 3rd General Conference on Weights and Measures (1901).
pub const STANDARD_GRAVITY: f64 = 9.80665;

/// Text that asks for the mass from impulse and change of velocity.
pub const FROM_IMPULSE: &str = "from impulse";

const TABLE: &str = "[rig]";

/// Largest uncertainty of a quantity above zero, as a part of it; 1.
const LARGEST_UNCERTAINTY: f64 = 0.3;

const KIND: Needed = Needed::of(
    TABLE,
    "kind",
    "the kind of rig",
    "",
    "kind = \"pendulum\"   or   kind = \"carriage\"",
);
const INERTIA: Needed = Needed::of(
    TABLE,
    "inertia",
    "moment of inertia of arm and impactor about the pivot",
    "kg m^2",
    "inertia = \"0.01435 kg m^2\"",
);
const ARM: Needed = Needed::of(
    TABLE,
    "arm",
    "distance from pivot to point of contact",
    "m",
    "arm = \"0.505 m\"",
);
const PENDULUM_MASS: Needed = Needed::of(
    TABLE,
    "mass",
    "mass of arm and impactor together",
    "kg",
    "mass = \"0.11 kg\"",
);
const CENTRE: Needed = Needed::of(
    TABLE,
    "centre_of_mass",
    "distance from pivot to the centre of mass",
    "m",
    "centre_of_mass = \"0.35 m\"",
);
const GRAVITY: Needed = Needed::of(
    TABLE,
    "gravity",
    "acceleration of gravity",
    "m/s^2",
    "gravity = \"9.81 m/s^2\"",
);
const CARRIAGE_MASS: Needed = Needed::of(
    TABLE,
    "mass",
    "mass of the moving body",
    "kg",
    "mass = \"0.5 kg\"   or   mass = \"from impulse\"",
);
const MASS_SD: Needed = Needed::of(
    TABLE,
    "mass_sd",
    "standard uncertainty of the mass",
    "kg",
    "mass_sd = \"0.5 g\"",
);
const DRIVING: Needed = Needed::of(
    TABLE,
    "driving_acceleration",
    "acceleration towards the fruit when nothing touches: g0 for a free fall, 0 on a level track",
    "m/s^2",
    "driving_acceleration = \"0 m/s^2\"",
);

const DRIVING_SD: Needed = Needed::of(
    TABLE,
    "driving_acceleration_sd",
    "standard uncertainty of the driving acceleration",
    "m/s^2",
    "driving_acceleration_sd = \"0.02 m/s^2\"",
);

/// Rigs of single impacts.
#[derive(Clone, Copy)]
pub(crate) enum Kind {
    Pendulum,
    Carriage,
}

/// Words of `[rig] kind`.
pub(crate) const KINDS: [(&str, Kind); 2] =
    [("pendulum", Kind::Pendulum), ("carriage", Kind::Carriage)];

/// The rig of a campaign, and the uncertainties that stand behind its values.
///
/// # Errors
/// A value is left out, is no such quantity, or is out of range.
pub fn rig_plan(
    source: &TomlSource,
    rig: Option<&Spanned<RigFile>>,
) -> Result<(RigPlan, BenchSd), Error> {
    let Some(rig) = rig else {
        return Err(missing(source, &(0..0), &KIND, TABLE.to_owned()));
    };
    let (at, rig) = (rig.span(), rig.get_ref());
    match choice(source, rig.kind.as_ref(), (TABLE, "kind"), &KINDS)? {
        None => Err(missing(source, &at, &KIND, TABLE.to_owned())),
        Some(Kind::Pendulum) => pendulum(source, &at, rig),
        Some(Kind::Carriage) => carriage(source, &at, rig),
    }
}

fn pendulum(
    source: &TomlSource,
    at: &Range<usize>,
    rig: &RigFile,
) -> Result<(RigPlan, BenchSd), Error> {
    let strangers = [
        (rig.mass_sd.as_ref(), "mass_sd"),
        (rig.driving_acceleration.as_ref(), "driving_acceleration"),
        (
            rig.driving_acceleration_sd.as_ref(),
            "driving_acceleration_sd",
        ),
    ];
    refuse(source, strangers, "a pendulum")?;
    let gravity = quantity_from_zero(source, rig.gravity.as_ref(), &GRAVITY)?;
    let known = |value, needed| positive(source, at, value, needed);
    let (inertia, inertia_sd) = known(rig.inertia.as_ref(), &INERTIA)?;
    let (arm, arm_sd) = known(rig.arm.as_ref(), &ARM)?;
    let (mass, mass_sd) = known(rig.mass.as_ref(), &PENDULUM_MASS)?;
    let centre = uncertain_quantity(source, rig.centre_of_mass.as_ref(), &CENTRE)?;
    let (centre_of_mass, centre_sd) =
        centre.ok_or_else(|| missing(source, at, &CENTRE, TABLE.to_owned()))?;
    let pendulum = Pendulum {
        inertia,
        arm,
        mass,
        centre_of_mass,
        gravity: gravity.unwrap_or(STANDARD_GRAVITY),
    };
    let sd = BenchSd::default()
        .with(BenchQuantity::Inertia, inertia_sd)
        .with(BenchQuantity::Arm, arm_sd)
        .with(BenchQuantity::Mass, mass_sd)
        .with(BenchQuantity::CentreOfMass, centre_sd);
    Ok((RigPlan::Pendulum(pendulum), sd))
}

fn carriage(
    source: &TomlSource,
    at: &Range<usize>,
    rig: &RigFile,
) -> Result<(RigPlan, BenchSd), Error> {
    let strangers = [
        (rig.inertia.as_ref(), "inertia"),
        (rig.arm.as_ref(), "arm"),
        (rig.centre_of_mass.as_ref(), "centre_of_mass"),
        (rig.gravity.as_ref(), "gravity"),
    ];
    refuse(source, strangers, "a carriage")?;
    let mass = rig.mass.as_ref();
    let from_impulse = mass.is_some_and(|mass| mass.get_ref().0 == FROM_IMPULSE);
    let mass = if from_impulse {
        let sd = (rig.mass_sd.as_ref(), "mass_sd");
        refuse(source, [sd], "a mass from impulse")?;
        MassPlan::FromImpulse
    } else {
        let (value, behind) = positive(source, at, rig.mass.as_ref(), &CARRIAGE_MASS)?;
        if let (Some(twice), true) = (&rig.mass_sd, behind > 0.0) {
            let problem = "the mass has its uncertainty behind ±; remove one of them";
            return Err(refused(source, twice, (TABLE, "mass_sd"), problem));
        }
        MassPlan::Given {
            value,
            sd: behind.max(uncertainty(source, rig.mass_sd.as_ref(), &MASS_SD)?),
        }
    };
    let sd = match mass {
        MassPlan::Given { sd, .. } => BenchSd::default().with(BenchQuantity::Mass, sd),
        MassPlan::FromImpulse => BenchSd::default(),
    };
    let driving = rig.driving_acceleration.as_ref();
    let driving_acceleration = needed_quantity(source, at, driving, &DRIVING)?;
    let driving_sd = rig.driving_acceleration_sd.as_ref();
    let driving_sd = uncertainty(source, driving_sd, &DRIVING_SD)?;
    let plan = RigPlan::Carriage {
        mass,
        driving_acceleration,
        driving_acceleration_sd: driving_sd,
    };
    Ok((plan, sd))
}

fn refuse<const N: usize>(
    source: &TomlSource,
    strangers: [(Option<&Spanned<QuantityText>>, &str); N],
    rig: &str,
) -> Result<(), Error> {
    for (value, key) in strangers {
        if let Some(value) = value {
            let problem = format!("{rig} has no such value; remove the line");
            return Err(refused(source, value, (TABLE, key), problem));
        }
    }
    Ok(())
}

fn positive(
    source: &TomlSource,
    at: &Range<usize>,
    value: Option<&Spanned<QuantityText>>,
    needed: &Needed,
) -> Result<(f64, f64), Error> {
    let known = uncertain_quantity(source, value, needed)?;
    match (value, known) {
        (Some(value), Some((number, _))) if number <= 0.0 => {
            let problem = format!("must be above zero, for example: {}", needed.example);
            Err(refused(source, value, (needed.table, needed.key), problem))
        }
        (Some(value), Some((number, sd))) if sd > LARGEST_UNCERTAINTY * number => {
            let problem = format!(
                "an uncertainty of {:.0} % is more than the fits can follow (30 %): measure it, or \
                 have it estimated with `[fit] estimate`",
                100.0 * sd / number
            );
            Err(refused(source, value, (needed.table, needed.key), problem))
        }
        (_, Some(known)) => Ok(known),
        (_, None) => Err(missing(source, at, needed, TABLE.to_owned())),
    }
}
