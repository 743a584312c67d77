//! What is said of trends over a campaign, with the likeliest causes.

use crate::result::outcome::TrendOutcome;
use crate::result::trend::Over;
use windfall_contact::laws::kind::LawKind;
use windfall_files::found::FindingOutcome;
use windfall_files::text::number::{p_value, value_and_sd};

/// Probability of a chance below which a trend is told; that of one law of a campaign.
const BY_CHANCE: f64 = 0.01;
/// Smallest change over the campaign that is told, as a logarithm; 1.
const LEAST: f64 = 0.01;
/// Change of the gain of the force, over that of a parameter, that explains it; 1.
const EXPLAINS: f64 = 0.3;
/// Correlation above which velocity and order cannot be told apart; 1.
const TOGETHER: f64 = 0.7;

impl TrendOutcome {
    /// Whether there is a trend, and one that matters.
    pub fn is_clear(&self) -> bool {
        self.p < BY_CHANCE && (self.slope * self.range).abs() > LEAST
    }

    fn is_over(&self, over: Over) -> bool {
        self.over == over.name()
    }

    /// "rises by 12 ± 3 %", over a step of x.
    fn change(&self, step: f64) -> String {
        let factor = (self.slope * step).exp();
        let (percent, sd) = (100.0 * (factor - 1.0), 100.0 * factor * self.sd * step);
        let verb = if percent < 0.0 { "falls" } else { "rises" };
        format!("{verb} by {} %", value_and_sd(percent.abs(), Some(sd)))
    }

    fn seen(&self) -> String {
        let within = if self.within_specimens {
            ", within fruit"
        } else {
            ""
        };
        format!(
            "{} impacts on {} fruit{within}, {}",
            self.impacts,
            self.specimens,
            p_value(self.p)
        )
    }
}

/// Findings on trends: `law-velocity-trend`, one for each law, and `order-trend`.
///
/// * `laws`: those that were fitted
/// * `bench_is_off`: whether the bench has a finding of its own
/// * `misfits`: of the residuals
pub fn trend_findings(
    trends: &[TrendOutcome],
    laws: &[LawKind],
    bench_is_off: bool,
    misfits: &[FindingOutcome],
) -> Vec<FindingOutcome> {
    let of_laws = laws.iter().filter_map(|law| {
        let own = trends.iter().filter(|own| own.law == law.name());
        let own = own.filter(|own| own.is_over(Over::Velocity) && own.is_clear());
        let own: Vec<&TrendOutcome> = own.collect();
        let first = own.first()?;
        let changes: Vec<String> = own
            .iter()
            .map(|own| format!("{} {}", own.quantity, own.change(std::f64::consts::LN_2)))
            .collect();
        let misfit = misfits.iter().any(|own| {
            own.message
                .contains(&format!("residuals of {} ", law.name()))
        });
        let told = format!(
            "{}: {} with each doubling of the velocity ({}), where the law says that {}: {}{}",
            law.name(),
            changes.join(", and "),
            first.seen(),
            if own.len() > 1 {
                "they are constant"
            } else {
                "it is constant"
            },
            cause_of_velocity(*law, &own, bench_is_off, misfit),
            if first.order_correlation.abs() > TOGETHER {
                "; velocity and order go together here, so a change of the fruit from impact to \
                 impact would look the same: strike in random order"
            } else {
                ""
            }
        );
        Some(FindingOutcome::new("law-velocity-trend", told))
    });
    of_laws.chain(order_finding(trends)).collect()
}

/// Why parameters depend on the velocity.
fn cause_of_velocity(
    law: LawKind,
    trends: &[&TrendOutcome],
    bench_is_off: bool,
    misfit: bool,
) -> String {
    if bench_is_off {
        return "the bench is off too, and a delay or a filter matters more the shorter the \
                contact: correct or estimate it first"
            .to_owned();
    }
    let elastic = law.describe().parameters.first().map(|own| own.name);
    let stiffness = trends
        .iter()
        .find(|own| Some(own.quantity.as_str()) == elastic);
    let also = if misfit {
        ", and its residuals share a pattern too"
    } else {
        ""
    };
    let Some(stiffness) = stiffness else {
        return format!(
            "the damping of the fruit depends on velocity or displacement in another way than that of \
             this law{also}; compare with `windfall laws`"
        );
    };
    let exponent = law.describe().elastic_exponent(&[]).map(|n| {
        let (better, sd) = explaining_exponent(n, stiffness.slope, stiffness.sd);
        format!(
            "an exponent of {} in place of {n}",
            value_and_sd(better, Some(sd))
        )
    });
    let other = match stiffness.slope < 0.0 {
        true => "yield (fruit that give way beyond a force or a depth)",
        false => "a stiffness that grows with the rate or the depth",
    };
    let exponent = exponent.map_or_else(String::new, |own| format!("{own}, or "));
    format!("likeliest is {exponent}{other}{also}; compare with `windfall laws`")
}

/// Exponent n' of the force under which the stiffness k of a law F = k xⁿ goes as v^b, and its
/// deviation.
///
/// The largest displacement goes as v^(2/(n' + 1)), and k as its power n' − n, so that
/// b = 2 (n' − n)/(n' + 1) and n' = (2 n + b)/(2 − b).
fn explaining_exponent(n: f64, slope: f64, sd: f64) -> (f64, f64) {
    let rest = 2.0 - slope;
    (
        (2.0 * n + slope) / rest,
        2.0 * (1.0 + n) / (rest * rest) * sd,
    )
}

/// What changes with order or time of day: of each quantity the clearer of both.
fn order_finding(trends: &[TrendOutcome]) -> Option<FindingOutcome> {
    let drifting = |own: &&TrendOutcome| !own.is_over(Over::Velocity) && own.is_clear();
    let mut clear: Vec<&TrendOutcome> = trends.iter().filter(drifting).collect();
    let first = clear.iter().min_by(|a, b| a.p.total_cmp(&b.p)).copied()?;
    clear.retain(|own| own.over == first.over);
    let hours = first.is_over(Over::TimeOfDay);
    let step = if hours { 1.0 } else { first.range };
    let changes: Vec<String> = clear
        .iter()
        .map(|own| match own.quantity.as_str() {
            "force_gain" => format!("the gain of the force {}", own.change(step)),
            "restitution" => format!("the restitution {}", own.change(step)),
            quantity => format!("{quantity} of {} {}", own.law, own.change(step)),
        })
        .collect();
    let way = if hours {
        "with each hour of the day"
    } else {
        "from the first to the last row of impacts.csv"
    };
    let gain = trends
        .iter()
        .find(|own| own.quantity == "force_gain" && own.over == first.over);
    let cause = match gain {
        Some(gain) if gain.is_clear() => {
            "the gain of the force by Newton's law changes with it: the sensor or its amplifier \
             drifts (temperature, supply, mounting)"
                .to_owned()
        }
        Some(gain) if gain.sd < EXPLAINS * first.slope.abs() => {
            let shown = value_and_sd(100.0 * gain.slope * step, Some(100.0 * gain.sd * step));
            format!(
                "the gain of the force changes by {shown} % meanwhile, so that it is not the \
                 sensor: the fruit (ripening, drying, warming, bruised spots), or the order in \
                 which they were chosen"
            )
        }
        _ => "the fruit (ripening, drying, warming, bruised spots), the order in which they were \
              chosen, or a drift of the sensor"
            .to_owned(),
    };
    let told = format!("{} {way} ({}): {cause}", changes.join(", "), first.seen());
    Some(FindingOutcome::new("order-trend", told))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// n' = 1.8 and n = 1.5: b = 2 · 0.3/2.8. By difference: dn'/db.
    #[test]
    fn closed_form_explaining_exponent() {
        let slope = 0.6 / 2.8;
        let (exponent, sd) = explaining_exponent(1.5, slope, 1e-6);
        assert!((exponent - 1.8).abs() < 1e-12);
        let (beyond, _) = explaining_exponent(1.5, slope + 1e-6, 0.0);
        assert!(((beyond - exponent) / sd - 1.0).abs() < 1e-5);
    }
}
