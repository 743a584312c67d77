//! How intervals came about, as results are saved and shown.

use serde::{Deserialize, Serialize};
use windfall_files::name::Name;
use windfall_files::named::Named;
use windfall_identify::fit::interval::{IntervalDetail, ProfileCurve};
use windfall_identify::fit::result::Fit;

/// Draws of a posterior that are kept, to be looked at.
const KEPT: usize = 500;

/// How the intervals of a fit came about.
#[derive(Clone, Debug, Default, PartialEq, Serialize, utoipa::ToSchema, Deserialize)]
pub struct IntervalOutcome {
    /// "asymptotic", "profile", "bootstrap" or "posterior".
    #[schema(value_type = String)]
    pub method: Name,
    /// Resampled recordings of a bootstrap.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(nullable = false)]
    pub replicates: Option<usize>,
    /// How many of them could not be fitted.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(nullable = false)]
    pub failed: Option<usize>,
    /// Chains of a posterior.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(nullable = false)]
    pub chains: Option<usize>,
    /// Draws of all chains.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(nullable = false)]
    pub draws: Option<usize>,
    /// Draws at which the sampler broke down.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(nullable = false)]
    pub divergences: Option<usize>,
    /// How well the chains of each parameter agree.
    #[serde(default = "nothing", skip_serializing_if = "is_empty")]
    pub mixing: Named<MixingOutcome>,
    /// Some draws of each parameter, evenly spaced among all; SI.
    #[serde(default = "nothing", skip_serializing_if = "is_empty")]
    pub drawn: Named<Vec<f64>>,
    /// Profile of each parameter.
    #[serde(default = "nothing", skip_serializing_if = "is_empty")]
    pub profiles: Named<ProfileOutcome>,
}

/// How well the chains of one parameter agree.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, utoipa::ToSchema, Deserialize)]
pub struct MixingOutcome {
    /// Spread of all chains over that within chains; `None` when they stand
    /// still.
    pub r_hat: Option<f64>,
    /// Independent draws for the centre.
    pub bulk_draws: f64,
    /// Independent draws for the ends.
    pub tail_draws: f64,
}

/// Profile of one parameter.
#[derive(Clone, Debug, Default, PartialEq, Serialize, utoipa::ToSchema, Deserialize)]
pub struct ProfileOutcome {
    /// Values looked at; SI.
    pub values: Vec<f64>,
    /// −2 ln of the likelihood relative to its maximum.
    pub rises: Vec<f64>,
    /// "lower", "upper" or "both" where no end was found.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(nullable = false)]
    pub open: Option<String>,
}

fn nothing<T>() -> Named<T> {
    Named::default()
}

fn is_empty<T>(named: &Named<T>) -> bool {
    named.0.is_empty()
}

/// How the intervals of `fit` came about.
pub fn interval_outcome(fit: &Fit) -> IntervalOutcome {
    let names = || {
        fit.parameters
            .iter()
            .chain(&fit.nuisances)
            .map(|e| e.name.clone())
    };
    let method = |name: &str| IntervalOutcome {
        method: name.into(),
        ..IntervalOutcome::default()
    };
    match &fit.intervals {
        IntervalDetail::Asymptotic => method("asymptotic"),
        IntervalDetail::Profile(curves) => IntervalOutcome {
            profiles: names().zip(curves.iter().map(profile)).collect(),
            ..method("profile")
        },
        IntervalDetail::Bootstrap(found) => IntervalOutcome {
            replicates: Some(found.replicates),
            failed: Some(found.failed),
            ..method("bootstrap")
        },
        IntervalDetail::Posterior(found) => {
            let mixing = found.mixing.iter().map(|m| MixingOutcome {
                r_hat: m.r_hat.is_finite().then_some(m.r_hat),
                bulk_draws: m.bulk_draws,
                tail_draws: m.tail_draws,
            });
            IntervalOutcome {
                chains: Some(found.chains),
                draws: Some(found.draws.first().map_or(0, Vec::len)),
                divergences: Some(found.divergences),
                drawn: names()
                    .zip(found.draws.iter().map(|d| thinned(d)))
                    .collect(),
                mixing: names().zip(mixing).collect(),
                ..method("posterior")
            }
        }
    }
}

/// Draws evenly spaced among all, so that every chain has its share.
fn thinned(draws: &[f64]) -> Vec<f64> {
    let step = draws.len().div_ceil(KEPT).max(1);
    draws.iter().step_by(step).copied().collect()
}

fn profile(curve: &ProfileCurve) -> ProfileOutcome {
    let open = match (curve.open_below, curve.open_above) {
        (false, false) => None,
        (true, false) => Some("lower"),
        (false, true) => Some("upper"),
        (true, true) => Some("both"),
    };
    ProfileOutcome {
        values: curve.values.clone(),
        rises: curve.rises.clone(),
        open: open.map(str::to_owned),
    }
}
