//! Files of single fits for other programs: samples, residuals, weights, covariance and draws.
//!
//! The layout is that of `arviz.from_json`: groups of variables with the names of their
//! dimensions. All numbers are SI.

use crate::impacts::fit::{law_problem, options_of};
use crate::recording::extract::extract_recording;
use crate::result::outcome::CampaignOutcome;
use crate::settings::model::{ImpactCampaign, ImpactEntry};
use rayon::prelude::*;
use serde_json::{Map, Value, json};
use std::path::Path;
use windfall_contact::expression::LawExpression;
use windfall_draw::files::file_name;
use windfall_files::error::Error;
use windfall_files::provenance::VERSION;
use windfall_files::write_file::{make_directory, write_whole};
use windfall_identify::fit::detail::{FitDetail, FittedSeries, fit_in_detail};
use windfall_identify::fit::interval::{IntervalDetail, Posterior};
use windfall_identify::fit::result::Estimate;
use windfall_identify::rig::kind::Rig;
use windfall_signal::impact::Impact;

/// Version of the layout: raised when a key changes its meaning or goes.
const LAYOUT: u32 = 1;

/// Writes ID-LAW.json for every fit of `outcome` into a directory. Files of the same names are
/// replaced. Each impact is fitted once more, with the same bits.
///
/// # Errors
/// A recording can no longer be read, or a file cannot be written.
pub(crate) fn write_details(
    campaign: &ImpactCampaign,
    rig: &Rig,
    outcome: &CampaignOutcome,
    folder: &Path,
) -> Result<(), Error> {
    make_directory(folder)?;
    campaign.shared.entries.par_iter().try_for_each(|entry| {
        let fitted = |law: &&LawExpression| {
            let mut impacts = outcome.impacts.iter();
            impacts.any(|own| own.id == entry.id && own.law == law.kind.name())
        };
        let laws: Vec<&LawExpression> = campaign.fit.laws.iter().filter(fitted).collect();
        if laws.is_empty() {
            return Ok(());
        }
        let (impact, _) = extract_recording(campaign, entry, Some(rig.effective_mass()))?;
        laws.into_iter().try_for_each(|law| {
            let detail = detail_of_law((campaign, rig), entry, &impact, law)?;
            let text = format!("{detail}\n");
            let name = law.kind.name();
            let file = format!("{}.json", file_name(&format!("{}-{name}", entry.id)));
            write_whole(&folder.join(file), text.as_bytes())
        })
    })
}

/// Samples, residuals, weights, covariance and draws of one fit.
///
/// # Errors
/// The law cannot be fitted.
pub(crate) fn detail_of_law(
    (campaign, rig): (&ImpactCampaign, &Rig),
    entry: &ImpactEntry,
    impact: &Impact,
    law: &LawExpression,
) -> Result<Value, Error> {
    let name = law.kind.name();
    let problem = law_problem(law, &campaign.fit);
    let options = options_of(campaign, entry);
    let detail = fit_in_detail(impact, rig, &problem, &options)
        .map_err(|source| Error::identify(name, source))?;
    Ok(document(entry, name, &detail))
}

/// Variables of a group and the dimensions of all.
#[derive(Default)]
struct Layout {
    observed: Map<String, Value>,
    constant: Map<String, Value>,
    coordinates: Map<String, Value>,
    dimensions: Map<String, Value>,
}

impl Layout {
    /// A variable that is not observed; one that is not finite throughout is left out.
    fn constant(&mut self, name: &str, values: &[f64], dimension: &str) {
        if values.iter().all(|value| value.is_finite()) {
            self.constant.insert(name.to_owned(), json!(values));
            self.dimensions.insert(name.to_owned(), json!([dimension]));
        }
    }

    /// The samples of a quantity, over their times.
    fn series(&mut self, series: &FittedSeries) {
        let name = series.quantity.name();
        let time = format!("{name}_time");
        self.coordinates.insert(time.clone(), json!(series.times));
        self.dimensions.insert(name.to_owned(), json!([time]));
        self.observed
            .insert(name.to_owned(), json!(series.measured));
        let both = series.measured.iter().zip(&series.residuals);
        let predicted: Vec<f64> = both.map(|(measured, own)| measured + own).collect();
        self.constant(&format!("{name}_predicted"), &predicted, &time);
        self.constant(&format!("{name}_residual"), &series.residuals, &time);
        self.constant(&format!("{name}_weight"), &series.weights, &time);
        let window = [series.times[0], series.times[series.times.len() - 1]];
        self.constant(&format!("{name}_window"), &window, "end");
        let persistence = format!("{name}_persistence");
        self.constant.insert(persistence, json!(series.persistence));
    }

    /// Estimates in their order, with their covariance.
    fn estimates(&mut self, estimates: &[&Estimate], covariance: &[Vec<f64>]) {
        let names: Vec<&str> = estimates.iter().map(|own| own.name.as_str()).collect();
        for dimension in ["parameter", "parameter_2"] {
            self.coordinates.insert(dimension.to_owned(), json!(names));
        }
        let of = |value: fn(&Estimate) -> f64| -> Vec<f64> {
            estimates.iter().map(|own| value(own)).collect()
        };
        self.constant("estimate", &of(|own| own.value), "parameter");
        self.constant("sd", &of(|own| own.sd), "parameter");
        self.constant("low", &of(|own| own.low), "parameter");
        self.constant("high", &of(|own| own.high), "parameter");
        if !covariance.is_empty() {
            self.constant("covariance", &covariance.concat(), "parameter");
            self.constant
                .insert("covariance".to_owned(), json!(covariance));
            let both = json!(["parameter", "parameter_2"]);
            self.dimensions.insert("covariance".to_owned(), both);
        }
    }

    /// How well the chains mix.
    fn mixing(&mut self, posterior: &Posterior) {
        let own = || posterior.mixing.iter();
        let r_hat: Vec<f64> = own().map(|own| own.r_hat).collect();
        let bulk: Vec<f64> = own().map(|own| own.bulk_draws).collect();
        let tail: Vec<f64> = own().map(|own| own.tail_draws).collect();
        self.constant("r_hat", &r_hat, "parameter");
        self.constant("ess_bulk", &bulk, "parameter");
        self.constant("ess_tail", &tail, "parameter");
    }
}

fn document(entry: &ImpactEntry, law: &str, detail: &FitDetail) -> Value {
    let fit = &detail.fit;
    let estimates: Vec<&Estimate> = fit.parameters.iter().chain(&fit.nuisances).collect();
    let mut layout = Layout::default();
    layout
        .coordinates
        .insert("end".to_owned(), json!(["first", "last"]));
    detail.series.iter().for_each(|own| layout.series(own));
    layout.estimates(&estimates, &detail.covariance);
    let units = estimates.iter().map(|own| own.unit.as_str());
    let mut attributes = json!({
        "format": "windfall fit detail",
        "version": LAYOUT,
        "windfall": VERSION,
        "impact": entry.id,
        "specimen": entry.specimen,
        "file": entry.file,
        "law": law,
        "cost": fit.cost,
        "converged": u8::from(fit.converged),
        "parameter_units": units.collect::<Vec<_>>(),
    });
    let mut document = Map::new();
    if let IntervalDetail::Posterior(posterior) = &fit.intervals {
        layout.mixing(posterior);
        let each = posterior.draws.first().map_or(0, Vec::len) / posterior.chains.max(1);
        let draws = estimates.iter().zip(&posterior.draws);
        let draws = draws.map(|(own, draws)| {
            let chains: Vec<&[f64]> = draws.chunks_exact(each.max(1)).collect();
            (own.name.clone(), json!(chains))
        });
        document.insert("posterior".to_owned(), Value::Object(draws.collect()));
        attributes["divergences"] = json!(posterior.divergences);
    }
    document.insert("observed_data".to_owned(), json!(layout.observed));
    document.insert("constant_data".to_owned(), json!(layout.constant));
    document.insert("coords".to_owned(), json!(layout.coordinates));
    document.insert("dims".to_owned(), json!(layout.dimensions));
    document.insert("attrs".to_owned(), attributes);
    Value::Object(document)
}
