//! The law card of a calibration.

use crate::calibrate::outcome::{CalibrateOutcome, CalibratedParameter};
use crate::calibrate::waveform_outcome::WaveformOutcome;
use crate::read::{DropCampaign, PlatePlan};
use std::collections::{BTreeMap, BTreeSet};
use windfall_campaign::impacts::card::card_origin;
use windfall_cards::law_card::{
    CARD_FORMAT, CardBodies, CardCovariance, CardParameter, CardRange, LawCard, labels_of,
    range_of_values,
};
use windfall_cards::law_use::{complete_law_among, end_name};
use windfall_cards::read_card::card_definition;
use windfall_contact::law::EndRule;
use windfall_contact::laws::kind::Law;
use windfall_drop_rig::rig::{DropRig, Plate};
use windfall_drop_rig::simulate::{DropImpact, simulate_drop};
use windfall_files::error::Error;

/// The law of a calibration as a card: by waveforms, or else by features.
///
/// # Errors
/// There is no single law: the features leave a family, or neither way was
/// asked for.
pub fn card_of_calibration(
    campaign: &DropCampaign,
    outcome: &CalibrateOutcome,
) -> Result<LawCard, Error> {
    let found = match (&outcome.waveform, &outcome.features) {
        (Some(waveform), _) => from_waveform(waveform),
        (None, Some(features)) if features.rank == features.parameters.len() => Found {
            expression: features.law.clone(),
            parameters: features.parameters.iter().map(card_parameter).collect(),
            covariance: None,
            method: "features of drops (peaks and intervals)",
        },
        _ => {
            let missing = "there is no one law for a card: what was measured leaves a family";
            let advice =
                "calibrate on waveforms (--way waveform), or add drops from another height";
            return Err(Error::not_known(&campaign.shared.title, missing, advice));
        }
    };
    let law = complete_law_among(&found.expression, &campaign.calibrate.user)?;
    let own = campaign.calibrate.law.as_ref();
    let end = own.map_or(EndRule::ForceZero, |law| law.end);
    let specimens: BTreeSet<&str> = outcome.drops.iter().map(|d| d.specimen.as_str()).collect();
    Ok(LawCard {
        format: CARD_FORMAT,
        title: campaign.shared.title.clone(),
        law: law.kind().name().to_owned(),
        expression: found.expression,
        end: end_name(end).to_owned(),
        cautions: outcome.findings.iter().map(|f| f.message.clone()).collect(),
        parameters: all_parameters(&law, &found.parameters),
        covariance: found.covariance,
        range: range_of(campaign, outcome, &law, end),
        bodies: CardBodies {
            impactor: "fruit".to_owned(),
            target: match campaign.rig.plate {
                PlatePlan::Rigid => "rigid plate".to_owned(),
                PlatePlan::Sprung { .. } => "plate on spring and damper".to_owned(),
            },
            effective_mass_factor: campaign.rig.effective_mass_factor,
            specimens: specimens.len(),
            recordings: outcome.drops.len(),
            radius: campaign.calibrate.hertz.map(|hertz| hertz.radius),
        },
        origin: card_origin(&campaign.shared, found.method)?,
        contact: None,
        population: None,
        definition: card_definition(law.kind()),
    })
}

fn card_parameter(parameter: &CalibratedParameter) -> (String, CardParameter) {
    let card = CardParameter {
        value: parameter.value,
        unit: parameter.unit.clone(),
        sd: parameter.sd,
        interval: None,
    };
    (parameter.name.clone(), card)
}

/// A law with what is known of its free parameters.
struct Found {
    expression: String,
    parameters: BTreeMap<String, CardParameter>,
    covariance: Option<CardCovariance>,
    method: &'static str,
}

fn from_waveform(waveform: &WaveformOutcome) -> Found {
    let parameters = waveform.parameters.iter().map(|parameter| {
        let value = &parameter.value;
        let card = CardParameter {
            value: value.value,
            unit: value.unit.clone(),
            sd: value.sd,
            interval: value.low.zip(value.high).map(|(low, high)| [low, high]),
        };
        (parameter.name.clone(), card)
    });
    let names = waveform.parameters.iter().map(|p| p.name.clone());
    let names: Vec<String> = names.collect();
    Found {
        expression: waveform.law.clone(),
        parameters: parameters.collect(),
        covariance: Some(CardCovariance {
            of: labels_of(&names, &waveform.logarithmic),
            matrix: waveform.covariance.clone(),
            of_what: match waveform.by_scatter {
                true => "the mean, by the scatter from drop to drop".to_owned(),
                false => "the estimate, by the noise of the recordings".to_owned(),
            },
        }),
        method: "waveforms of drops",
    }
}

/// Every parameter of the law: as found, or as held.
fn all_parameters(
    law: &Law,
    found: &BTreeMap<String, CardParameter>,
) -> BTreeMap<String, CardParameter> {
    let parameters = law.kind().describe().parameters.iter();
    let parameters = parameters.zip(law.parameters()).enumerate();
    parameters
        .map(|(place, (parameter, value))| {
            let card = found.get(parameter.name).cloned().unwrap_or(CardParameter {
                value,
                unit: law.unit_of(place),
                sd: None,
                interval: None,
            });
            (parameter.name.to_owned(), card)
        })
        .collect()
}

/// In what the law was seen: the drops as it has them.
fn range_of(
    campaign: &DropCampaign,
    outcome: &CalibrateOutcome,
    law: &Law,
    end: EndRule,
) -> CardRange {
    let plate = |name: &str| outcome.plate.get(name).map(|value| value.value);
    let plate = match (plate("mass"), plate("stiffness"), plate("damping")) {
        (Some(mass), Some(stiffness), Some(damping)) => Some(Plate {
            mass,
            stiffness,
            damping,
        }),
        _ => None,
    };
    let mut impacts = Vec::new();
    for drop in &outcome.drops {
        let rig = DropRig {
            mass: drop.mass.value,
            effective_mass_factor: campaign.rig.effective_mass_factor,
            gravity: campaign.rig.gravity,
            plate,
        };
        let bounces = campaign.calibrate.bounces;
        if let Ok(simulated) = simulate_drop(law, &rig, drop.height.value, bounces, end) {
            impacts.extend(simulated.impacts);
        }
    }
    let range = |of: fn(&DropImpact) -> f64| range_of_values(impacts.iter().map(of));
    CardRange {
        impact_velocity: range(|impact| impact.impact_velocity),
        peak_force: range(|impact| impact.peak_contact_force),
        displacement: range(|impact| impact.max_displacement),
        mass: range_of_values(outcome.drops.iter().map(|drop| drop.mass.value)),
    }
}
