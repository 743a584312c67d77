//! Stiffness and damping of a plate from how it rings, and the table of damping
//! ratios over drop heights.

use crate::uncertain::Uncertain;
use std::f64::consts::TAU;

/// A plate on spring and damper.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlateDynamics {
    /// Damped angular frequency, ω_d = 2π/T_d; rad/s.
    pub damped_frequency: Uncertain,
    /// Undamped angular frequency, ω_n = ω_d/√(1 − ζ²); rad/s.
    pub natural_frequency: Uncertain,
    /// Stiffness, k = m ω_n²; N/m.
    pub stiffness: Uncertain,
    /// Damping, c = 2 ζ m ω_n; N s/m.
    pub damping: Uncertain,
}

/// Stiffness and damping of a plate:
///
/// ```text
/// ω_d = 2π/T_d,   ω_n = ω_d/√(1 − ζ²),   k = m ω_n²,   c = 2 ζ m ω_n
/// ```
///
/// * `period`: damped, T_d; s
/// * `damping_ratio`: ζ; 1
/// * `mass`: m, of the plate and what moves with it; kg
///
/// # Source
/// Kang et al. (2023), INMATEH 71:763, eqs. 4 to 6. Differences: they use ω_d in
/// place of ω_n, which makes k smaller by ζ².
pub fn plate_dynamics(
    period: Uncertain,
    damping_ratio: Uncertain,
    mass: Uncertain,
) -> PlateDynamics {
    let (zeta, m) = (damping_ratio.value, mass.value);
    let rest = 1.0 - zeta * zeta;
    let damped = TAU / period.value;
    let natural = damped / rest.sqrt();
    let (stiffness, damping) = (m * natural * natural, 2.0 * zeta * m * natural);
    // Relative uncertainties, with d ln ω_n/dζ = ζ/(1 − ζ²).
    let of_period = period.sd / period.value;
    let of_mass = mass.sd / m;
    let by_ratio = damping_ratio.sd * zeta / rest;
    let for_damping = if zeta > 0.0 {
        damping_ratio.sd / (zeta * rest)
    } else {
        0.0
    };
    let uncertain = |value: f64, relative: f64| Uncertain::new(value, value * relative);
    PlateDynamics {
        damped_frequency: uncertain(damped, of_period),
        natural_frequency: uncertain(natural, of_period.hypot(by_ratio)),
        stiffness: uncertain(
            stiffness,
            of_mass.hypot(2.0 * of_period).hypot(2.0 * by_ratio),
        ),
        damping: uncertain(damping, of_mass.hypot(of_period).hypot(for_damping)),
    }
}

/// One row of a table over drop heights.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeightRow {
    /// Drop height; m.
    pub height: f64,
    /// Mean over the drops.
    pub mean: f64,
    /// Standard deviation over the drops; `None` of one.
    pub sd: Option<f64>,
    /// Drops.
    pub count: usize,
}

/// A quantity of the rig over drop heights, as in Table 1 of the study.
#[derive(Clone, Debug, PartialEq)]
pub struct HeightTable {
    /// Heights in ascending order.
    pub rows: Vec<HeightRow>,
    /// Mean of the heights' means: every height counts alike.
    pub mean_of_means: f64,
    /// Mean of all drops.
    pub mean: f64,
    /// Standard deviation of all drops; `None` of one.
    pub sd: Option<f64>,
    /// Mean of the heights' standard deviations, which is what the study prints
    /// as the overall one; `None` if no height has one.
    pub mean_of_sds: Option<f64>,
    /// Standard deviation within heights, pooled; `None` if no height has one.
    pub within_sd: Option<f64>,
    /// Drops.
    pub count: usize,
}

/// Table of one quantity, for example the damping ratio, over drop heights;
/// `None` of nothing.
///
/// * `drops`: height and value of each drop; heights that are equal are one row
///
/// The study's five printed means (0.069, 0.074, 0.075, 0.076, 0.068) average
/// to 0.0724, where it prints 0.073.
pub fn height_table(drops: &[(f64, f64)]) -> Option<HeightTable> {
    let mut sorted = drops.to_vec();
    sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
    let rows: Vec<HeightRow> = sorted
        .chunk_by(|a, b| a.0 == b.0)
        .map(|group| {
            let values: Vec<f64> = group.iter().map(|drop| drop.1).collect();
            HeightRow {
                height: group[0].0,
                mean: mean(&values),
                sd: deviation(&values),
                count: values.len(),
            }
        })
        .collect();
    if rows.is_empty() {
        return None;
    }
    let all: Vec<f64> = sorted.iter().map(|drop| drop.1).collect();
    let means: Vec<f64> = rows.iter().map(|row| row.mean).collect();
    let sds: Vec<f64> = rows.iter().filter_map(|row| row.sd).collect();
    let freedom: usize = rows.iter().map(|row| row.count - 1).sum();
    let square: f64 = rows
        .iter()
        .filter_map(|row| row.sd.map(|sd| sd * sd * (row.count - 1) as f64))
        .sum();
    Some(HeightTable {
        mean_of_means: mean(&means),
        mean: mean(&all),
        sd: deviation(&all),
        mean_of_sds: (!sds.is_empty()).then(|| mean(&sds)),
        within_sd: (freedom > 0).then(|| (square / freedom as f64).sqrt()),
        count: all.len(),
        rows,
    })
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

fn deviation(values: &[f64]) -> Option<f64> {
    let centre = mean(values);
    let square: f64 = values.iter().map(|v| (v - centre).powi(2)).sum();
    (values.len() > 1).then(|| (square / (values.len() - 1) as f64).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn exact(value: f64) -> Uncertain {
        Uncertain::new(value, 0.0)
    }

    #[test]
    fn reference_plate_of_the_study() {
        // papers.json, Kang2023 Eq4 to Eq6: 3.5 ms, ζ 0.073, 0.2 kg.
        let found = plate_dynamics(exact(3.5e-3), exact(0.073), exact(0.2));
        assert!((found.damped_frequency.value - 1_795.195_802_051_31).abs() < 1e-9);
        assert!((found.stiffness.value - 647_998.779_034).abs() < 1e-5);
        // Without the correction, as if ζ were 0.
        let plain = plate_dynamics(exact(3.5e-3), exact(0.0), exact(0.2));
        assert!((plain.stiffness.value - 644_545.593_540_5).abs() < 1e-5);
        // c = ζ · 2√(mk): the study's 2√(mk) with its k, 645,842 N/m, is 718.80.
        let critical = 2.0 * (0.2_f64 * 645_842.0).sqrt();
        assert!((critical - 718.800_11).abs() < 1e-3);
        let c = 0.073 * 2.0 * (0.2 * 647_998.779_034_f64).sqrt();
        assert!((found.damping.value - c).abs() < 1e-9);
    }

    #[test]
    fn derivative_uncertainties_are_those_of_small_changes() {
        let at = |t: f64, z: f64, m: f64| plate_dynamics(exact(t), exact(z), exact(m));
        let (t, z, m) = (3.5e-3, 0.3, 0.2);
        let with = |u: [f64; 3]| {
            let uncertain = |value, sd| Uncertain::new(value, sd);
            plate_dynamics(uncertain(t, u[0]), uncertain(z, u[1]), uncertain(m, u[2]))
        };
        let h = 1e-6;
        let one = [
            with([h * t, 0.0, 0.0]),
            with([0.0, h * z, 0.0]),
            with([0.0, 0.0, h * m]),
        ];
        let plus = [
            at(t * (1.0 + h), z, m),
            at(t, z * (1.0 + h), m),
            at(t, z, m * (1.0 + h)),
        ];
        let here = at(t, z, m);
        for (one, plus) in one.iter().zip(plus) {
            let pairs = [
                (
                    one.natural_frequency.sd,
                    plus.natural_frequency.value - here.natural_frequency.value,
                ),
                (
                    one.stiffness.sd,
                    plus.stiffness.value - here.stiffness.value,
                ),
                (one.damping.sd, plus.damping.value - here.damping.value),
            ];
            for (sd, change) in pairs {
                assert!(
                    (sd - change.abs()).abs() < 1e-5 * change.abs() + 1e-12,
                    "{sd} {change}"
                );
            }
        }
    }

    #[test]
    fn reference_table_of_the_study() {
        // Kang et al. (2023), Table 1; its overall line prints 0.073 and 0.008.
        let means = [
            (0.1, 0.069),
            (0.2, 0.074),
            (0.3, 0.075),
            (0.4, 0.076),
            (0.5, 0.068),
        ];
        let sds = [0.013, 0.007, 0.006, 0.003, 0.011];
        // Two drops at mean ± sd/√2 have that mean and that sd.
        let drops: Vec<(f64, f64)> = means
            .iter()
            .zip(sds)
            .flat_map(|(m, sd)| [(m.0, m.1 - sd / 2f64.sqrt()), (m.0, m.1 + sd / 2f64.sqrt())])
            .collect();
        let table = height_table(&drops).unwrap();
        assert_eq!((table.rows.len(), table.count), (5, 10));
        assert!((table.rows[3].mean - 0.076).abs() < 1e-15);
        assert!((table.rows[0].sd.unwrap() - 0.013).abs() < 1e-15);
        assert!((table.mean_of_means - 0.0724).abs() < 1e-12);
        assert!((table.mean_of_sds.unwrap() - 0.008).abs() < 1e-12);
        // √((13² + 7² + 6² + 3² + 11²)/5) = √76.8.
        assert!((table.within_sd.unwrap() - 76.8_f64.sqrt() * 1e-3).abs() < 1e-12);
        assert_eq!(height_table(&[]), None);
        assert_eq!(height_table(&[(0.1, 0.07)]).unwrap().sd, None);
    }
}
