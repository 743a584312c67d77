//! Results of campaigns that fit no impacts: values with uncertainties under
//! names, saved in the store, shown as text, JSON or CSV.

use itertools::Itertools;
use serde::{Deserialize, Serialize};
use windfall_campaign::pipeline::evaluate::Document;
use windfall_campaign::result::outcome::StatusOutcome;
use windfall_campaign::settings::model::{Campaign, ImpactEntry};
use windfall_campaign::store::documents::StoredValue;
use windfall_files::found::{FailureOutcome, FindingOutcome, SpreadOutcome, spreads};
use windfall_files::named::Named;

/// One value; SI.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema, Deserialize)]
pub struct MeasuredValue {
    /// Value.
    pub value: f64,
    /// Standard uncertainty, where known.
    pub sd: Option<f64>,
    /// Lower end of the 95 % interval, where known.
    pub low: Option<f64>,
    /// Upper end of the 95 % interval, where known.
    pub high: Option<f64>,
    /// SI unit; "1" for a number.
    pub unit: String,
}

impl MeasuredValue {
    /// The value as the store keeps it, under a name.
    pub fn stored(&self, name: String) -> StoredValue {
        StoredValue {
            name,
            value: self.value,
            sd: self.sd,
            unit: self.unit.clone(),
        }
    }
}

/// A value without uncertainty.
pub fn plain_value(value: f64, unit: &str) -> MeasuredValue {
    MeasuredValue {
        value,
        sd: None,
        low: None,
        high: None,
        unit: unit.to_owned(),
    }
}

/// A value with its standard uncertainty, where that is finite.
pub fn value_with_sd(value: f64, sd: f64, unit: &str) -> MeasuredValue {
    MeasuredValue {
        sd: sd.is_finite().then_some(sd),
        ..plain_value(value, unit)
    }
}

/// What was found in one recording, or of one specimen.
#[derive(Clone, Debug, Default, PartialEq, Serialize, utoipa::ToSchema, Deserialize)]
pub struct MeasuredItem {
    /// Id of the recording, or of the specimen.
    pub id: String,
    /// Id of the specimen.
    pub specimen: String,
    /// Group of the specimen or recording, where the campaign has groups.
    pub group: Option<String>,
    /// The recording, as impacts.csv names it; of a specimen, how many.
    pub file: String,
    /// Name of the law, or of the method.
    pub law: String,
    /// Words that are no numbers: why a loading ended, how sure a result is.
    pub words: Named<String>,
    /// Parameters of the law.
    pub parameters: Named<MeasuredValue>,
    /// Everything else.
    pub derived: Named<MeasuredValue>,
    /// What a reader must know.
    pub findings: Vec<FindingOutcome>,
}

impl MeasuredItem {
    /// An item of an entry, without values yet.
    pub fn of(campaign: &Campaign, entry: &ImpactEntry, law: &str) -> Self {
        Self {
            id: entry.id.clone(),
            specimen: entry.specimen.clone(),
            group: campaign.group_of(entry),
            file: entry.file.clone(),
            law: law.to_owned(),
            ..Self::default()
        }
    }

    /// An item of no single recording, without values yet.
    pub fn named(id: &str, law: &str) -> Self {
        Self {
            id: id.to_owned(),
            specimen: id.to_owned(),
            law: law.to_owned(),
            ..Self::default()
        }
    }
}

/// Results on one recording: one for each law.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MeasuredItems {
    /// The results.
    pub items: Vec<MeasuredItem>,
}

impl Document for MeasuredItems {
    fn values(&self) -> Vec<StoredValue> {
        let several = self.items.len() > 1;
        let mut values = Vec::new();
        for item in &self.items {
            for (name, value) in item.parameters.0.iter().chain(&item.derived.0) {
                let name = match several {
                    true => format!("{} {name}", item.law),
                    false => name.to_string(),
                };
                values.push(value.stored(name));
            }
        }
        values
    }
}

/// Spread of the values over a group.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema, Deserialize)]
pub struct MeasuredGroup {
    /// Name of the group; `None` for all together.
    pub group: Option<String>,
    /// Name of the law or method.
    pub law: String,
    /// Recordings.
    pub recordings: usize,
    /// Spread of each value.
    pub values: Named<SpreadOutcome>,
}

/// Columns of the tables that people read.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ShownTables {
    /// Of recordings.
    pub items: &'static [ShownValue],
    /// Of their parts.
    pub parts: &'static [ShownValue],
    /// Of specimens and of the whole.
    pub specimens: &'static [ShownValue],
}

/// A column of the tables that people read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShownValue {
    /// Name among the parameters or the derived values.
    pub name: &'static str,
    /// Heading with the unit that is shown.
    pub heading: &'static str,
    /// That unit per SI unit.
    pub factor: f64,
}

/// Everything that `fit` gives for such a campaign.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema)]
pub struct MeasuredOutcome {
    /// Version of windfall.
    pub windfall: String,
    /// Title of the campaign.
    pub campaign: String,
    /// What it measures.
    pub kind: String,
    /// Label of simulated recordings.
    pub simulated: Option<String>,
    /// Remark on the campaign.
    #[serde(default)]
    pub note: Option<String>,
    /// How the results came about.
    pub status: StatusOutcome,
    /// One entry per recording and law.
    pub impacts: Vec<MeasuredItem>,
    /// Parts of recordings: the bounces of a drop.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub parts: Vec<MeasuredItem>,
    /// What could not be evaluated.
    pub failed: Vec<FailureOutcome>,
    /// Results on whole specimens, from all their recordings.
    pub specimens: Vec<MeasuredItem>,
    /// Results on the whole campaign.
    pub whole: Vec<MeasuredItem>,
    /// Spread over all recordings, of the first law.
    pub summary: Named<SpreadOutcome>,
    /// Spread per group and law.
    pub groups: Vec<MeasuredGroup>,
    /// What a reader of the whole must know.
    pub findings: Vec<FindingOutcome>,
    /// Columns of the tables that people read.
    #[serde(skip)]
    pub shown: ShownTables,
}

/// A column of the tables that people read.
pub const fn shown(name: &'static str, heading: &'static str, factor: f64) -> ShownValue {
    ShownValue {
        name,
        heading,
        factor,
    }
}

/// A value of an item by its name.
pub fn value_of<'a>(item: &'a MeasuredItem, name: &str) -> Option<&'a MeasuredValue> {
    item.parameters.get(name).or_else(|| item.derived.get(name))
}

/// Laws or methods in order of first appearance.
pub fn laws_of(items: &[MeasuredItem]) -> Vec<&str> {
    let laws = items.iter().map(|item| item.law.as_str());
    laws.unique().collect()
}

/// Spread of each value over the items of a law, and of a group where one is
/// named.
pub fn spread_of(items: &[MeasuredItem], law: &str, group: Option<&str>) -> MeasuredGroup {
    let members: Vec<&MeasuredItem> = items
        .iter()
        .filter(|item| item.law == law && (group.is_none() || item.group.as_deref() == group))
        .collect();
    let values = members
        .iter()
        .flat_map(|item| item.parameters.0.iter().chain(&item.derived.0));
    MeasuredGroup {
        group: group.map(str::to_owned),
        law: law.to_owned(),
        recordings: members.len(),
        values: spreads(values.map(|(name, value)| (name.as_str(), value.value))),
    }
}

/// Spread per law and group, in order of first appearance.
pub fn groups_of(items: &[MeasuredItem]) -> Vec<MeasuredGroup> {
    let names: Vec<&str> = items
        .iter()
        .filter_map(|item| item.group.as_deref())
        .unique()
        .collect();
    let mut groups = Vec::new();
    for law in laws_of(items) {
        match names.is_empty() {
            true => groups.push(spread_of(items, law, None)),
            false => groups.extend(names.iter().map(|name| spread_of(items, law, Some(name)))),
        }
    }
    groups
}
