//! The plate of a drop rig from the ringing of all drops.

use crate::evaluate::height_text;
use crate::measured::{Known, MeasuredDrop, MeasuredRinging};
use crate::read::{DropCampaign, PlatePlan};
use windfall_drop_rig::rig::Plate;
use windfall_files::error::Error;
use windfall_files::found::FindingOutcome;
use windfall_files::named::Named;
use windfall_measure::measured::{MeasuredItem, plain_value, value_with_sd};
use windfall_signal::ringing::plate::{HeightTable, PlateDynamics, height_table, plate_dynamics};
use windfall_signal::uncertain::Uncertain;

/// Method of the table over heights.
const BY_HEIGHT: &str = "ringing of the plate by drop height";
/// Method of stiffness and damping.
const PLATE: &str = "plate";

/// A given value contradicts the ringing beyond this many standard uncertainties …; 1
const DIFFERS: f64 = 4.0;
/// … and by more than this part; 1.
const MATERIAL: f64 = 0.02;

/// Plate of a campaign with its uncertainties.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlateEstimate {
    /// Mass; kg.
    pub mass: Uncertain,
    /// Stiffness; N/m.
    pub stiffness: Uncertain,
    /// Damping; N s/m.
    pub damping: Uncertain,
}

/// Ringing of all drops together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PooledPlate {
    /// Damped period; s.
    pub period: Uncertain,
    /// Damping ratio; 1.
    pub damping_ratio: Uncertain,
    /// Drops that it comes from.
    pub drops: usize,
}

impl From<PlateEstimate> for Plate {
    fn from(from: PlateEstimate) -> Self {
        Self {
            mass: from.mass.value,
            stiffness: from.stiffness.value,
            damping: from.damping.value,
        }
    }
}

/// The plate as given, and otherwise from the ringing of all drops; `None` if rigid.
///
/// # Errors
/// Stiffness or damping is not given and no drop rings.
pub fn plate_of(
    campaign: &DropCampaign,
    drops: &[MeasuredDrop],
) -> Result<Option<PlateEstimate>, Error> {
    let PlatePlan::Sprung {
        mass,
        stiffness,
        damping,
    } = campaign.rig.plate
    else {
        return Ok(None);
    };
    let heard = pooled(drops).map(|pooled| dynamics(&pooled, mass));
    let unknown = |name: &str| {
        let missing = format!("no drop tells the {name} of the plate: none rings above the noise");
        let advice = format!("add plate_{name} to [rig] of campaign.toml, or plate = \"rigid\"");
        Error::not_known(&campaign.shared.title, missing, advice)
    };
    let pick = |given: Option<Uncertain>, heard: Option<Uncertain>, name: &str| {
        given.or(heard).ok_or_else(|| unknown(name))
    };
    Ok(Some(PlateEstimate {
        mass,
        stiffness: pick(stiffness, heard.map(|h| h.stiffness), "stiffness")?,
        damping: pick(damping, heard.map(|h| h.damping), "damping")?,
    }))
}

fn dynamics(pooled: &PooledPlate, mass: Uncertain) -> PlateDynamics {
    plate_dynamics(pooled.period, pooled.damping_ratio, mass)
}

/// Mean over the drops with its standard error; of one drop its own uncertainty.
pub fn pooled(drops: &[MeasuredDrop]) -> Option<PooledPlate> {
    let rings: Vec<_> = drops.iter().filter_map(|drop| drop.ringing).collect();
    let mean = |of: fn(&MeasuredRinging) -> Known| -> Uncertain {
        let values: Vec<Known> = rings.iter().map(of).collect();
        let n = values.len() as f64;
        let mean = values.iter().map(|v| v.value).sum::<f64>() / n;
        let square: f64 = values.iter().map(|v| (v.value - mean).powi(2)).sum();
        let sd = match values.len() {
            1 => values[0].sd,
            _ => (square / (n - 1.0) / n).sqrt(),
        };
        Uncertain { value: mean, sd }
    };
    (!rings.is_empty()).then(|| PooledPlate {
        period: mean(|ringing| ringing.period),
        damping_ratio: mean(|ringing| ringing.damping_ratio),
        drops: rings.len(),
    })
}

/// Ringing by drop height (Kang et al. 2023, Table 1), and the plate's stiffness and damping.
pub fn plate_items(campaign: &DropCampaign, drops: &[MeasuredDrop]) -> Vec<MeasuredItem> {
    let PlatePlan::Sprung {
        mass,
        stiffness,
        damping,
    } = campaign.rig.plate
    else {
        return Vec::new();
    };
    let mut items = by_height(drops);
    let heard = pooled(drops).map(|pooled| (pooled, dynamics(&pooled, mass)));
    if let Some((pooled, plate)) = &heard {
        items.push(from_ringing(pooled, plate, mass));
    }
    if stiffness.is_some() || damping.is_some() {
        let mut given = MeasuredItem::named("as given in campaign.toml", PLATE);
        let value = |value: Uncertain, unit: &str| value_with_sd(value.value, value.sd, unit);
        given.derived.push("plate_mass", value(mass, "kg"));
        let plate = heard.map(|(_, plate)| plate);
        let pairs = [
            (
                "plate_stiffness",
                stiffness,
                "N/m",
                plate.map(|p| p.stiffness),
            ),
            ("plate_damping", damping, "N s/m", plate.map(|p| p.damping)),
        ];
        for (name, told, unit, heard) in pairs {
            let Some(told) = told else { continue };
            given.derived.push(name, value(told, unit));
            let finding = heard.and_then(|heard| differs(name, told, heard, unit));
            given.findings.extend(finding);
        }
        items.push(given);
    }
    items
}

/// A finding where what is given is not what rings.
fn differs(name: &str, told: Uncertain, heard: Uncertain, unit: &str) -> Option<FindingOutcome> {
    let difference = (told.value - heard.value).abs();
    let significant = difference > DIFFERS * told.sd.hypot(heard.sd);
    (significant && difference > MATERIAL * told.value).then(|| {
        let message = format!(
            "{name} is given as {:.5} {unit} and the plate rings as if it were {:.5} ± {:.2} {unit}: \
             check plate_mass and the given value, or leave it out to take that of the ringing",
            told.value, heard.value, heard.sd
        );
        FindingOutcome::new("plate_rings_otherwise", message)
    })
}

fn from_ringing(pooled: &PooledPlate, plate: &PlateDynamics, mass: Uncertain) -> MeasuredItem {
    let values = [
        ("plate_mass", mass, "kg"),
        ("damped_period", pooled.period, "s"),
        ("damping_ratio", pooled.damping_ratio, "1"),
        ("damped_frequency", plate.damped_frequency, "rad/s"),
        ("natural_frequency", plate.natural_frequency, "rad/s"),
        ("plate_stiffness", plate.stiffness, "N/m"),
        ("plate_damping", plate.damping, "N s/m"),
    ];
    let values = values.map(|(name, v, unit)| (name, value_with_sd(v.value, v.sd, unit)));
    MeasuredItem {
        file: format!("{} drops", pooled.drops),
        derived: Named::of(values),
        ..MeasuredItem::named("from the ringing", PLATE)
    }
}

/// A quantity of a drop whose means stand in the table.
type OfDrop<'a> = (&'a str, &'a str, &'a dyn Fn(&MeasuredDrop) -> Option<f64>);

fn by_height(drops: &[MeasuredDrop]) -> Vec<MeasuredItem> {
    let quantities: [OfDrop; 3] = [
        ("damping_ratio_by_decrement", "1", &|drop| {
            Some(drop.decrement?.damping_ratio.value)
        }),
        ("damping_ratio", "1", &|drop| {
            Some(drop.ringing?.damping_ratio.value)
        }),
        ("damped_period", "s", &|drop| {
            Some(drop.ringing?.period.value)
        }),
    ];
    let table = |(name, unit, of): &OfDrop<'static>| {
        let pairs = drops
            .iter()
            .filter_map(|drop| Some((drop.height.value, of(drop)?)));
        Some((*name, *unit, height_table(&pairs.collect::<Vec<_>>())?))
    };
    let tables: Vec<(&str, &str, HeightTable)> = quantities.iter().filter_map(table).collect();
    let rows = tables.iter().flat_map(|(.., table)| &table.rows);
    let mut heights: Vec<f64> = rows.map(|row| row.height).collect();
    heights.sort_by(f64::total_cmp);
    heights.dedup();
    let row = |height: &f64| {
        let mut item = MeasuredItem::named(&height_text(*height), BY_HEIGHT);
        for (name, unit, table) in &tables {
            if let Some(row) = table.rows.iter().find(|row| row.height == *height) {
                push_mean(&mut item, (name, unit), (row.mean, row.sd), row.count);
            }
        }
        item
    };
    let mut items: Vec<MeasuredItem> = heights.iter().map(row).collect();
    if items.len() > 1 {
        let mut all = MeasuredItem::named("all drops", BY_HEIGHT);
        for (name, unit, table) in &tables {
            push_mean(&mut all, (name, unit), (table.mean, table.sd), table.count);
        }
        items.push(all);
    }
    items
}

/// Adds a mean over drops and the standard deviation of one drop.
fn push_mean(
    item: &mut MeasuredItem,
    (name, unit): (&str, &str),
    (mean, sd): (f64, Option<f64>),
    drops: usize,
) {
    item.derived.push(name, plain_value(mean, unit));
    if let Some(sd) = sd {
        item.derived
            .push(format!("{name}_spread"), plain_value(sd, unit));
    }
    item.file = format!("{drops} drops");
    item.words = Named::of([("drops", drops.to_string())]);
}
