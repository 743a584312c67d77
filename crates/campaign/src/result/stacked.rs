//! Residuals of all impacts laid upon each other: what a law leaves out is the same in each.

use crate::result::outcome::ImpactOutcome;
use itertools::Itertools;
use windfall_distribution::tail::{f_upper, t_two_sided};
use windfall_files::found::FindingOutcome;
use windfall_files::named::grouped;
use windfall_files::text::number::p_value;
use windfall_identify::fit::result::PHASES;
use windfall_numerics::cholesky;

/// Probability of a chance below which what residuals have in common is told.
const BY_CHANCE: f64 = 1e-4;
/// Part of the mean variance by which all variances are enlarged: a direction in which residuals
/// hardly scatter, since the fit takes it up, is no proof; 1.
const FLOOR: f64 = 0.05;
/// Longest time between samples or counts, as a part of the contact: coarser recordings share
/// what the fit makes of the onset between two samples; 1.
const SHARP: f64 = 0.01;
/// Fewest impacts beyond the parts of the contact.
const BEYOND: usize = 4;
/// Quantities that are told, with the words for them.
const QUANTITIES: [(&str, &str); 4] = [
    ("force", "force"),
    ("displacement", "displacement"),
    ("rate", "displacement rate"),
    ("acceleration", "acceleration"),
];

/// Laws whose residuals have in common what noise has not.
///
/// Mean residuals in eight parts of the contact, over the impacts that count, are compared with
/// their own scatter from impact to impact, so that neither the colour of the noise nor the
/// steps of a converter matter:
///
/// ```text
/// T² = n r̄ᵀ S⁻¹ r̄,   F = (n − p) T² / (p (n − 1))
/// ```
///
/// and the part that stands out most by Student's t, times the number of parts; of the two
/// probabilities twice the smaller counts.
///
/// # Source
/// Hotelling, H. (1931), The generalization of Student's ratio, Ann. Math. Statist. 2:360.
pub fn law_misfits(impacts: &[ImpactOutcome], bench_is_off: bool) -> Vec<FindingOutcome> {
    let sharp = |impact: &ImpactOutcome| impact.derived("resolution").is_some_and(|r| r <= SHARP);
    let counted = impacts.iter().filter(|own| own.counts() && sharp(own));
    let by_law = grouped(counted.map(|impact| (impact.law.as_str(), impact)));
    let told = by_law.iter().filter_map(|(law, impacts)| {
        let mut found = QUANTITIES.iter().filter_map(|(name, words)| {
            let own = impacts.iter().filter_map(|impact| impact.residuals.get(name));
            let rows: Vec<[f64; PHASES]> = own.map(|own| own.by_phase).collect();
            let common = in_common(&rows)?;
            (common.chance < BY_CHANCE).then(|| {
                let where_ = 100.0 * (common.phase as f64 + 0.5) / PHASES as f64;
                format!(
                    "a mean {words} residual of {:.2} of its rms at {where_:.0} % of the contact ({})",
                    common.size,
                    p_value(common.chance)
                )
            })
        });
        let found = found.join(", ");
        (!found.is_empty()).then(|| {
            let cause = match bench_is_off {
                true => "the bench is off too, which leaves residuals of its own: correct or estimate it first",
                false => {
                    "the law is not that of this fruit (yield, another exponent, another damping: \
                     compare with `windfall laws`), or the arm or the base moves by itself"
                }
            };
            format!(
                "the residuals of {law} in {} impacts share a pattern that is no noise: {found}; {cause}",
                impacts.len()
            )
        })
    });
    told.map(|told| FindingOutcome::new("law-misfit", told))
        .collect()
}

/// What rows have in common.
struct Common {
    /// Probability of as much by chance.
    chance: f64,
    /// Part in which the mean is largest, in its deviations.
    phase: usize,
    /// The mean there.
    size: f64,
}

fn in_common(rows: &[[f64; PHASES]]) -> Option<Common> {
    let n = rows.len();
    if n < PHASES + BEYOND {
        return None;
    }
    let count = n as f64;
    let mean: [f64; PHASES] =
        std::array::from_fn(|i| rows.iter().map(|row| row[i]).sum::<f64>() / count);
    let mut scatter = [[0.0; PHASES]; PHASES];
    for row in rows {
        for i in 0..PHASES {
            for j in 0..PHASES {
                scatter[i][j] += (row[i] - mean[i]) * (row[j] - mean[j]) / (count - 1.0);
            }
        }
    }
    // Of each mean, in its own deviations.
    let apart = |i: usize| mean[i].abs() / (scatter[i][i] / count).sqrt().max(f64::MIN_POSITIVE);
    let phase = (0..PHASES).max_by(|a, b| apart(*a).total_cmp(&apart(*b)))?;
    let parts = PHASES as f64;
    let of_largest = parts * t_two_sided(apart(phase), count - 1.0);

    let variance: f64 = (0..PHASES).map(|i| scatter[i][i]).sum::<f64>() / parts;
    for (i, row) in scatter.iter_mut().enumerate() {
        row[i] += FLOOR * variance;
    }
    let solved = cholesky::solve(&scatter, &mean)?;
    let square: f64 = count * mean.iter().zip(solved).map(|(a, b)| a * b).sum::<f64>();
    let f = (count - parts) * square / (parts * (count - 1.0));
    Some(Common {
        chance: 2.0 * of_largest.min(f_upper(f, parts, count - parts)),
        phase,
        size: mean[phase],
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use windfall_signal::noise::gaussian::{noise_source, normal};

    fn rows(seed: u64, count: usize, common: f64) -> Vec<[f64; PHASES]> {
        let mut source = noise_source(seed, 0);
        let row = |_| {
            let mut before = 0.0;
            std::array::from_fn(|i| {
                // Parts agree with their neighbours.
                before = 0.7 * before + 0.1 * normal(&mut source);
                before + if i == 3 { common } else { 0.0 }
            })
        };
        (0..count).map(row).collect()
    }

    #[test]
    fn recovers_what_rows_have_in_common_and_nothing_else() {
        let mut by_chance = 0;
        for seed in 0..400 {
            let clean = in_common(&rows(seed, 40, 0.0)).unwrap();
            by_chance += usize::from(clean.chance < 0.05);
            let found = in_common(&rows(seed, 40, 0.2)).unwrap();
            assert!(
                found.chance < BY_CHANCE && found.phase == 3,
                "{}",
                found.chance
            );
        }
        // 20 are expected where nothing is enlarged; fewer here.
        assert!(by_chance < 32, "{by_chance}");
        assert!(in_common(&rows(1, PHASES + BEYOND - 1, 0.2)).is_none());
    }
}
