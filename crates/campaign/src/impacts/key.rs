//! What a result depends on, as one digest: equal keys mean equal results.

use crate::recording::pendulum_angles::angles_of_entry;
use crate::settings::files::fill_placeholders;
use crate::settings::model::{ImpactCampaign, ImpactEntry, TimePlan};
use serde_json::{Map, Value, json};
use windfall_contact::expression::LawExpression;
use windfall_files::provenance::{REVISION, digest_text};
use windfall_identify::fit::problem::Known;
use windfall_identify::rig::kind::Rig;

/// What the keys of all impacts of a campaign have in common, as JSON: written once, since
/// writing it takes longer than the digest.
pub struct CommonKey {
    contact: String,
    fit: String,
    open: String,
    rig: String,
    time_scale: String,
}

impl CommonKey {
    /// Of a campaign on its rig.
    pub fn of(campaign: &ImpactCampaign, rig: &Rig) -> Self {
        let files = &campaign.shared.files;
        Self {
            contact: json!(campaign.contact).to_string(),
            fit: json!(campaign.fit.options).to_string(),
            open: json!(format!("{:?}", files.open)).to_string(),
            rig: json!(format!("{rig:?}")).to_string(),
            time_scale: json!(format!("{:?}", files.time_scale)).to_string(),
        }
    }
}

/// SHA-256 over everything that the fit of one law to one impact depends on.
///
/// * `digest`: SHA-256 of the recording
///
/// Numbers enter with all their digits. Titles, groups and other columns of the
/// tables do not enter: changing them keeps the results.
pub fn impact_key(
    campaign: &ImpactCampaign,
    entry: &ImpactEntry,
    law: &LawExpression,
    common: &CommonKey,
    digest: &str,
) -> String {
    let filled = |text: &str| fill_placeholders(text, &entry.cells).unwrap_or_default();
    let channels: Vec<String> = campaign
        .shared
        .files
        .channels
        .iter()
        .map(|plan| {
            let time = match (&plan.time, &campaign.shared.files.time) {
                (Some(own), _) => filled(own),
                (None, TimePlan::Column(shared)) => filled(shared),
                (None, TimePlan::Rate(rate)) => format!("{rate:?} Hz"),
                (None, TimePlan::OfChannels | TimePlan::OfFile) => String::new(),
            };
            let (quantity, column) = (plan.quantity, filled(&plan.column));
            format!(
                "{quantity:?} {column:?} {time:?} {:?} {:?} {:?}",
                plan.scale, plan.offset, plan.delay
            )
        })
        .collect();
    let free: Vec<&String> = campaign
        .fit
        .free
        .iter()
        .filter(|name| {
            law.kind
                .describe()
                .parameters
                .iter()
                .any(|p| p.name == name.as_str())
        })
        .collect();
    let known = campaign.fit.known.iter();
    let known: Vec<&Known> = known
        .filter(|(kind, _)| *kind == law.kind)
        .map(|(_, known)| known)
        .collect();
    // An object with its names in alphabetical order.
    let everything = [
        (
            "angles",
            json!(format!("{:?}", angles_of_entry(campaign, entry).ok())).to_string(),
        ),
        ("channels", json!(channels).to_string()),
        ("contact", common.contact.clone()),
        ("fit", common.fit.clone()),
        ("free", json!(free).to_string()),
        (
            "impact",
            json!([entry.id, entry.specimen, entry.file]).to_string(),
        ),
        ("known", json!(format!("{known:?}")).to_string()),
        ("law", json!(format!("{law:?}")).to_string()),
        ("open", common.open.clone()),
        (
            "range",
            json!(format!("{:?} {:?}", entry.from, entry.to)).to_string(),
        ),
        ("recording", json!(digest).to_string()),
        ("revision", json!(REVISION).to_string()),
        ("rig", common.rig.clone()),
        ("time_scale", common.time_scale.clone()),
    ];
    let pairs = everything.map(|(name, text)| format!("\"{name}\":{text}"));
    digest_text(&format!("{{{}}}", pairs.join(",")))
}

/// Options of a run beside campaign.toml: what was fitted in the end.
pub fn run_options(campaign: &ImpactCampaign) -> Map<String, Value> {
    let fit = &campaign.fit;
    let laws: Vec<String> = fit.laws.iter().map(ToString::to_string).collect();
    let options = [
        ("laws", json!(laws)),
        ("free", json!(fit.free)),
        ("known", json!(fit.known_texts)),
        ("contact", json!(campaign.contact)),
        ("fit", json!(fit.options)),
    ];
    options
        .map(|(name, option)| (name.to_owned(), option))
        .into_iter()
        .collect()
}
