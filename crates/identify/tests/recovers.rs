//! Known parameters recovered from simulated raw recordings.

#![allow(clippy::unwrap_used, clippy::print_stdout)]

use crate::rubber;

use rubber::{impact, impact_with_flight, recover};
use windfall_identify::fit::problem::{FitOptions, Quantities, Treatment, Weighting};
use windfall_identify::samples::Quantity;
use windfall_signal::impact::Impact;
use windfall_signal::instrument::pendulum_instrument;

/// Impacts of the study of bias.
const IMPACTS: u64 = 200;
/// First seed. Over 1,600 impacts the cost functions that rest on the force
/// alone show c high by 0.2 % (3.6 standard errors of that mean, a tenth of the
/// standard deviation of one fit: the onset enters like a square root), which
/// 200 impacts do not always see.
const FIRST_SEED: u64 = 5_000;

use Quantity::{Displacement as X, Force as F, Rate as V};

/// The seven cost functions of Table 1 of the 2003 pendulum study.
const COST_FUNCTIONS: [&[Quantity]; 7] = [&[X], &[V], &[F], &[X, V], &[X, F], &[V, F], &[X, V, F]];

fn impacts(count: u64) -> Vec<Impact> {
    (FIRST_SEED..FIRST_SEED + count).map(impact).collect()
}

/// k and c within two standard errors of the mean, whatever the cost function
/// and the weights, with the onset free; intervals that cover at least at
/// their rate (they are wider than need be where the encoder's rounding or the
/// central difference rules).
#[test]
fn recovers_rubber_with_each_cost_function() {
    let impacts = impacts(IMPACTS);
    let short: Vec<Impact> = (FIRST_SEED..FIRST_SEED + IMPACTS)
        .map(|seed| impact_with_flight(&pendulum_instrument(), seed, 0.0))
        .collect();
    let mut wrong = Vec::new();
    for weighting in [Weighting::InverseVariance, Weighting::InverseMean] {
        // Weights that know no noise do not know how well free motion tells the rest.
        let impacts = match weighting {
            Weighting::InverseVariance => &impacts,
            Weighting::InverseMean => &short,
        };
        for quantities in COST_FUNCTIONS {
            let options = FitOptions {
                quantities: Quantities::of(quantities),
                weighting,
                ..FitOptions::default()
            };
            for (name, found) in ["k", "c"].iter().zip(recover(impacts, &options)) {
                println!(
                    "{weighting:?} {:?} {name}: {found:.4?}",
                    options.quantities.names()
                );
                if found.standard_errors.abs() > 2.0 || found.coverage < 0.88 {
                    wrong.push(format!("{weighting:?} {quantities:?} {name} {found:?}"));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Holding the onset (and the zero of displacement) at the 1 N threshold, as
/// the study did, biases c by 3-4 % whenever displacement leads, and more when
/// the force does; the intervals do not know.
#[test]
fn recovers_with_bias_when_the_onset_is_held_at_the_threshold() {
    let impacts = impacts(60);
    for quantities in COST_FUNCTIONS {
        let options = FitOptions {
            quantities: Quantities::of(quantities),
            onset: Treatment::Fixed,
            displacement_offset: Treatment::Fixed,
            ..FitOptions::default()
        };
        let [k, c] = recover(&impacts, &options);
        println!("held {:?} k {k:.4?} c {c:.4?}", options.quantities.names());
        assert!(c.bias > 0.02 && c.bias < 0.06, "{quantities:?} {c:?}");
        assert!(c.standard_errors > 5.0, "{quantities:?} {c:?}");
        if quantities == [X, V, F] {
            assert!(
                c.bias > 0.025 && c.bias < 0.045 && c.coverage < 0.6,
                "{c:?}"
            );
            assert!(k.bias > 0.025 && k.standard_errors > 5.0, "{k:?}");
        }
    }
}
