//! What every command says in its results: estimates, spreads, findings, failures.
//!
//! The names of the fields are the keys of the JSON that scripts rely on.
//! All numbers are SI.

use crate::name::Name;
use crate::named::{Named, grouped};
use crate::severity::Severity;
use serde::{Deserialize, Serialize};
use windfall_distribution::quantile::median;

/// One estimated or held value.
#[derive(Clone, Debug, PartialEq, Serialize, utoipa::ToSchema, Deserialize)]
pub struct EstimateOutcome {
    /// Value.
    pub value: f64,
    /// Standard deviation; `None` for a value that was held, or when the data
    /// cannot tell.
    pub sd: Option<f64>,
    /// Lower end of the 95 % interval.
    pub low: Option<f64>,
    /// Upper end of the 95 % interval.
    pub high: Option<f64>,
    /// SI unit.
    #[schema(value_type = String)]
    pub unit: Name,
    /// Whether the value was held, not estimated.
    pub held: bool,
}

impl EstimateOutcome {
    /// The 95 % interval, where the data can tell one.
    pub fn interval(&self) -> Option<(f64, f64)> {
        self.low.zip(self.high)
    }
}

/// Something that a reader of the result must know.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, utoipa::ToSchema, Deserialize)]
#[serde(from = "StoredFinding")]
pub struct FindingOutcome {
    /// Short name for scripts.
    #[schema(value_type = String)]
    pub code: Name,
    /// How grave it is: that of its code.
    pub severity: Severity,
    /// A sentence.
    pub message: String,
    /// The channel, or the quantity of the fit, that is meant; null where it is not one alone.
    #[schema(value_type = Option<String>)]
    pub channel: Option<Name>,
}

/// A finding as files hold it. Its severity is the graver of what is stored and what its code has
/// today.
#[derive(Deserialize)]
struct StoredFinding {
    code: Name,
    severity: Option<Severity>,
    message: String,
    #[serde(default)]
    channel: Option<Name>,
}

impl From<StoredFinding> for FindingOutcome {
    fn from(stored: StoredFinding) -> Self {
        let today = Severity::of(&stored.code);
        Self {
            severity: stored.severity.map_or(today, |own| own.min(today)),
            channel: stored.channel,
            ..Self::new(&stored.code, stored.message)
        }
    }
}

impl FindingOutcome {
    /// A finding under its code.
    pub fn new(code: &str, message: impl Into<String>) -> Self {
        let mut message = message.into();
        message.shrink_to_fit();
        Self {
            code: code.into(),
            severity: Severity::of(code),
            message,
            channel: None,
        }
    }

    /// Itself, as one of a channel or of a quantity of the fit.
    #[must_use]
    pub fn of_channel(self, channel: Option<&str>) -> Self {
        Self {
            channel: channel.map(Name::from),
            ..self
        }
    }
}

/// An impact that could not be fitted.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, utoipa::ToSchema, Deserialize)]
pub struct FailureOutcome {
    /// Id of the impact.
    pub id: String,
    /// Id of the specimen.
    pub specimen: String,
    /// The recording, as impacts.csv names it.
    pub file: String,
    /// The law, where the failure concerns one law only.
    pub law: Option<String>,
    /// What is wrong and what to do.
    pub message: String,
    /// What was found before it failed: contacts, zero, and what a reader must know of them.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub findings: Vec<FindingOutcome>,
}

impl FailureOutcome {
    /// Itself without what was found before, which the store does not keep.
    pub fn bare(&self) -> Self {
        Self {
            findings: Vec::new(),
            ..self.clone()
        }
    }
}

/// Spread of one quantity over impacts.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, utoipa::ToSchema, Deserialize)]
pub struct SpreadOutcome {
    /// Mean.
    pub mean: f64,
    /// Standard deviation between impacts (n − 1); `None` for one impact.
    pub sd: Option<f64>,
    /// Number of impacts.
    pub n: usize,
    /// Coefficient of variation, sd / |mean|.
    pub cv: Option<f64>,
    /// Median.
    #[serde(default)]
    #[schema(required)]
    pub median: f64,
    /// Median absolute deviation, scaled to the standard deviation of a normal distribution;
    /// `None` for one impact.
    #[serde(default)]
    pub robust_sd: Option<f64>,
    /// Standard uncertainty that all values share, as from the bench: no number of impacts
    /// makes it smaller. `None` where nothing is known of it.
    #[serde(default)]
    pub common_sd: Option<f64>,
}

/// Spread of some values; `None` when there is none.
///
/// ```text
/// mean = Σx / n,   sd² = Σ(x − mean)² / (n − 1),   cv = sd / |mean|
/// robust sd = 1.4826 median |x − median|
/// ```
///
/// The sums run in the order of the values.
pub fn spread(values: &[f64]) -> Option<SpreadOutcome> {
    if values.is_empty() {
        return None;
    }
    let n = values.len();
    let mean = values.iter().sum::<f64>() / n as f64;
    let squares: f64 = values.iter().map(|x| (x - mean) * (x - mean)).sum();
    let sd = (n > 1).then(|| (squares / (n - 1) as f64).sqrt());
    let cv = sd.filter(|_| mean != 0.0).map(|sd| sd / mean.abs());
    let (median, deviation) = robust_spread(values)?;
    Some(SpreadOutcome {
        common_sd: None,
        mean,
        sd,
        n,
        cv,
        median,
        robust_sd: (n > 1).then_some(deviation),
    })
}

/// Median, and median absolute deviation scaled to the standard deviation of a normal
/// distribution; `None` when there is no value.
///
/// # Source
/// Rousseeuw, P. J., and Croux, C. (1993), Alternatives to the median absolute deviation,
/// J. Am. Stat. Assoc. 88, 1273: 1/Φ⁻¹(3/4) = 1.4826.
pub fn robust_spread(values: &[f64]) -> Option<(f64, f64)> {
    if values.is_empty() {
        return None;
    }
    let middle = median(values);
    let apart: Vec<f64> = values.iter().map(|x| (x - middle).abs()).collect();
    Some((middle, NORMAL_MAD * median(&apart)))
}

/// Standard deviation over median absolute deviation of a normal distribution; 1.
const NORMAL_MAD: f64 = 1.482_602_218_505_602;

/// Spread of the values under each name, names in the order of their first appearance.
pub fn spreads<'a>(values: impl IntoIterator<Item = (&'a str, f64)>) -> Named<SpreadOutcome> {
    let groups = grouped(values).into_iter();
    groups
        .filter_map(|(name, values)| Some((name, spread(&values)?)))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// NIST Statistical Reference Datasets, univariate, `NumAcc1`: certified mean
    /// 10000002, standard deviation 1.
    #[test]
    fn reference_nist_numacc1() {
        let found = spread(&[10000001.0, 10000003.0, 10000002.0]).unwrap();
        assert_eq!((found.mean, found.sd, found.n), (10000002.0, Some(1.0), 3));
    }

    /// Stores of earlier versions hold no severity. A reason that keeps an impact out stays as
    /// grave as it was found.
    #[test]
    fn closed_form_a_stored_finding_is_at_least_as_grave_as_its_code() {
        for text in [
            r#"{"code":"clipped","message":"at 5 V"}"#,
            r#"{"code":"clipped","severity":"note","message":"at 5 V"}"#,
        ] {
            let found: FindingOutcome = serde_json::from_str(text).unwrap();
            assert_eq!(found, FindingOutcome::new("clipped", "at 5 V"));
            assert_eq!(found.severity, Severity::Wrong);
        }
        let graver = r#"{"code":"late-channel","severity":"wrong","message":"80 µs late"}"#;
        let found: FindingOutcome = serde_json::from_str(graver).unwrap();
        assert_eq!(found.severity, Severity::Wrong);
    }

    #[test]
    fn closed_form_one_impact_has_no_spread() {
        let found = spread(&[5.0]).unwrap();
        assert_eq!((found.sd, found.cv), (None, None));
        assert!(spread(&[]).is_none());
    }
}
