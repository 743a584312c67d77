//! The plate of a drop rig from the ringing of all drops.

use crate::evaluate::{Known, MeasuredDrop, height_text};
use crate::read::{DropCampaign, PlatePlan};
use windfall_campaign::measure::measured::{
    MeasuredItem, MeasuredValue, plain_value, value_with_sd,
};
use windfall_drop_rig::rig::Plate;
use windfall_files::error::Error;
use windfall_files::found::FindingOutcome;
use windfall_files::named::Named;
use windfall_signal::ringing::plate::{HeightTable, PlateDynamics, height_table, plate_dynamics};
use windfall_signal::uncertain::Uncertain;

/// Method of the table over heights.
const BY_HEIGHT: &str = "ringing of the plate by drop height";
/// Method of stiffness and damping.
const PLATE: &str = "plate";

/// A given value and one from the ringing differ by more than this many
/// standard uncertainties of the latter …; 1
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

/// The plate of a campaign: as given, and otherwise from the ringing of all
/// drops. `None` where it is rigid.
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
    let unknown = |name: &str| Error::ValueNotKnown {
        item: campaign.shared.title.clone(),
        missing: format!("no drop tells the {name} of the plate: none rings above the noise"),
        advice: format!("plate_{name} to [rig] of campaign.toml, or plate = \"rigid\""),
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

/// Mean over the drops, with the standard error that their spread gives; of one
/// drop its own.
#[must_use]
pub fn pooled(drops: &[MeasuredDrop]) -> Option<PooledPlate> {
    let rings: Vec<_> = drops.iter().filter_map(|drop| drop.ringing).collect();
    let mean = |of: &dyn Fn(usize) -> Known| -> Uncertain {
        let values: Vec<Known> = (0..rings.len()).map(of).collect();
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
        period: mean(&|i| rings[i].period),
        damping_ratio: mean(&|i| rings[i].damping_ratio),
        drops: rings.len(),
    })
}

/// Tables of the ringing: over drop heights, as Table 1 of Kang et al. (2023),
/// and the plate's stiffness and damping.
#[must_use]
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
        let mut given = item("as given in campaign.toml", PLATE);
        let value = |value: Uncertain, unit: &str| value_with_sd(value.value, value.sd, unit);
        given
            .derived
            .0
            .push(("plate_mass".to_owned(), value(mass, "kg")));
        let pairs = [
            (
                "plate_stiffness",
                stiffness,
                "N/m",
                heard.map(|h| h.1.stiffness),
            ),
            (
                "plate_damping",
                damping,
                "N s/m",
                heard.map(|h| h.1.damping),
            ),
        ];
        for (name, told, unit, heard) in pairs {
            let Some(told) = told else { continue };
            given.derived.0.push((name.to_owned(), value(told, unit)));
            given
                .findings
                .extend(heard.and_then(|heard| differs(name, told, heard, unit)));
        }
        items.push(given);
    }
    items
}

/// A finding where what is given is not what rings.
fn differs(name: &str, told: Uncertain, heard: Uncertain, unit: &str) -> Option<FindingOutcome> {
    let difference = (told.value - heard.value).abs();
    let significant = difference > DIFFERS * told.sd.hypot(heard.sd);
    (significant && difference > MATERIAL * told.value).then(|| FindingOutcome {
        code: "plate_rings_otherwise".to_owned(),
        message: format!(
            "{name} is given as {:.5} {unit} and the plate rings as if it were {:.5} ± {:.2} {unit}: \
             check plate_mass and the given value, or leave it out to take that of the ringing",
            told.value, heard.value, heard.sd
        ),
    })
}

fn item(id: &str, law: &str) -> MeasuredItem {
    MeasuredItem {
        id: id.to_owned(),
        specimen: id.to_owned(),
        group: None,
        file: String::new(),
        law: law.to_owned(),
        words: Named(Vec::new()),
        parameters: Named(Vec::new()),
        derived: Named(Vec::new()),
        findings: Vec::new(),
    }
}

fn from_ringing(pooled: &PooledPlate, plate: &PlateDynamics, mass: Uncertain) -> MeasuredItem {
    let mut found = item("from the ringing", PLATE);
    found.file = format!("{} drops", pooled.drops);
    let value = |name: &str, value: Uncertain, unit: &str| {
        (name.to_owned(), value_with_sd(value.value, value.sd, unit))
    };
    found.derived = Named(vec![
        value("plate_mass", mass, "kg"),
        value("damped_period", pooled.period, "s"),
        value("damping_ratio", pooled.damping_ratio, "1"),
        value("damped_frequency", plate.damped_frequency, "rad/s"),
        value("natural_frequency", plate.natural_frequency, "rad/s"),
        value("plate_stiffness", plate.stiffness, "N/m"),
        value("plate_damping", plate.damping, "N s/m"),
    ]);
    found
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
    let tables: Vec<(&str, &str, HeightTable)> = quantities
        .iter()
        .filter_map(|(name, unit, of)| {
            let pairs = drops
                .iter()
                .filter_map(|drop| Some((drop.height.value, of(drop)?)));
            Some((*name, *unit, height_table(&pairs.collect::<Vec<_>>())?))
        })
        .collect();
    let mut heights: Vec<f64> = tables
        .iter()
        .flat_map(|t| t.2.rows.iter().map(|r| r.height))
        .collect();
    heights.sort_by(f64::total_cmp);
    heights.dedup();
    let mut items: Vec<MeasuredItem> = heights
        .iter()
        .map(|height| {
            let mut row = item(&height_text(*height), BY_HEIGHT);
            for (name, unit, table) in &tables {
                if let Some(of) = table.rows.iter().find(|row| row.height == *height) {
                    row.derived
                        .0
                        .extend(mean_and_sd(name, unit, of.mean, of.sd));
                    set_count(&mut row, of.count);
                }
            }
            row
        })
        .collect();
    if items.len() > 1 {
        let mut all = item("all drops", BY_HEIGHT);
        for (name, unit, table) in &tables {
            all.derived
                .0
                .extend(mean_and_sd(name, unit, table.mean, table.sd));
            set_count(&mut all, table.count);
        }
        items.push(all);
    }
    items
}

/// A mean and the standard deviation of one drop.
fn mean_and_sd(name: &str, unit: &str, mean: f64, sd: Option<f64>) -> Vec<(String, MeasuredValue)> {
    let mut values = vec![(name.to_owned(), plain_value(mean, unit))];
    values.extend(sd.map(|sd| (format!("{name}_spread"), plain_value(sd, unit))));
    values
}

fn set_count(row: &mut MeasuredItem, count: usize) {
    row.file = format!("{count} drops");
    row.words = Named(vec![("drops".to_owned(), count.to_string())]);
}
