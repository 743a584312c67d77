//! Bias, spread and coverage of the seven cost functions on simulated rubber
//! impacts, with the onset free and with it held at the force threshold.
//!
//! `cargo run --release -p windfall-identify --example cost_functions [IMPACTS]`

use windfall_contact::expression::parse_law;
use windfall_contact::law::EndRule;
use windfall_identify::fit::fit_impact;
use windfall_identify::problem::{FitOptions, LawProblem, Quantities, Treatment, Weighting};
use windfall_identify::rig::{Pendulum, Rig};
use windfall_identify::samples::Quantity;
use windfall_identify::simulate::trajectory;
use windfall_signal::extract::extract_impact;
use windfall_signal::impact::Impact;
use windfall_signal::instrument::{Trajectory, calibrated, pendulum_instrument, record};
use windfall_signal::kinematics::Encoder;
use windfall_signal::options::ExtractOptions;
use windfall_signal::trigger::{Threshold, TriggerOptions};

const K: f64 = 394_931.0;
const C: f64 = 681.0;
const VELOCITY: f64 = 0.388;

fn rig() -> Rig {
    Rig::Pendulum(Pendulum {
        inertia: 0.01435,
        arm: 0.505,
        mass: 0.08,
        centre_of_mass: 0.35,
        gravity: 9.806_65,
    })
}

fn impact(seed: u64) -> Impact {
    let law = parse_law(&format!("kuwabara-kono(k={K}, c={C})"));
    let law = law.and_then(|l| l.complete()).expect("a law");
    let times: Vec<f64> = (0..2400).map(|i| -3e-3 + 5e-6 * f64::from(i)).collect();
    let motion = trajectory(&law, &rig(), VELOCITY, &times, EndRule::ForceZero).expect("motion");
    let motion = Trajectory {
        times: motion.times,
        displacement: motion.displacement,
        rate: motion.rate,
        force: motion.force,
        acceleration: motion.acceleration,
    };
    let instrument = pendulum_instrument();
    let raw = record(&motion, &instrument, seed).expect("recording");
    let recording = calibrated("simulated", &raw, &instrument);
    let options = ExtractOptions {
        trigger: TriggerOptions {
            threshold: Threshold::Fixed(1.0),
            ..TriggerOptions::default()
        },
        encoder: Some(Encoder::Rotary {
            counts_per_revolution: 360_000.0,
        }),
        arm: Some(0.505),
        effective_mass: Some(rig().effective_mass()),
        ..ExtractOptions::default()
    };
    extract_impact(&recording, &options).expect("an impact").0
}

fn main() {
    let count = std::env::args()
        .nth(1)
        .and_then(|a| a.parse().ok())
        .unwrap_or(200);
    let first: u64 = std::env::args().nth(2).and_then(|a| a.parse().ok()).unwrap_or(0);
    let impacts: Vec<Impact> = (first..first + count).map(impact).collect();
    println!("{:?}", impacts[0].measured);
    println!(
        "noise {:?} {:?} {:?}",
        impacts[0].displacement.as_ref().map(|s| s.noise),
        impacts[0].rate.as_ref().map(|s| s.noise),
        impacts[0].force.as_ref().map(|s| s.noise)
    );
    use Quantity::{Displacement as X, Force as F, Rate as V};
    let costs: [&[Quantity]; 7] = [&[X], &[V], &[F], &[X, V], &[X, F], &[V, F], &[X, V, F]];
    let problem = LawProblem::from_expression(&parse_law("kuwabara-kono").expect("a law"));
    for weighting in [Weighting::InverseVariance, Weighting::InverseMean] {
        for onset in [Treatment::Free, Treatment::Fixed] {
            println!("{weighting:?}, onset {onset:?}");
            for cost in costs {
                let options = FitOptions {
                    quantities: Quantities::of(cost),
                    weighting,
                    onset,
                    displacement_offset: if onset == Treatment::Fixed {
                        Treatment::Fixed
                    } else {
                        Treatment::Auto
                    },
                    ..FitOptions::default()
                };
                let begin = std::time::Instant::now();
                let fits: Vec<_> = impacts
                    .iter()
                    .map(|i| fit_impact(i, &rig(), &problem, &options))
                    .collect();
                let seconds = begin.elapsed().as_secs_f64() / count as f64;
                let failed = fits.iter().filter(|f| f.is_err()).count();
                let fits: Vec<_> = fits.into_iter().flatten().collect();
                let converged = fits.iter().filter(|f| f.converged).count();
                let names: Vec<_> = cost.iter().map(|q| q.name()).collect();
                print!(
                    "  {:28} fail {failed} conv {converged} {:.2} ms",
                    names.join("+"),
                    seconds * 1e3
                );
                for (p, truth) in [(0, K), (1, C)] {
                    let n = fits.len() as f64;
                    let mean = fits.iter().map(|f| f.parameters[p].value).sum::<f64>() / n;
                    let sd = (fits
                        .iter()
                        .map(|f| (f.parameters[p].value - mean).powi(2))
                        .sum::<f64>()
                        / (n - 1.0))
                        .sqrt();
                    let told = fits.iter().map(|f| f.parameters[p].sd).sum::<f64>() / n;
                    let covered = fits
                        .iter()
                        .filter(|f| f.parameters[p].low <= truth && truth <= f.parameters[p].high)
                        .count();
                    print!(
                        " | bias {:+.3} % ({:+.1} se) sd {:.3} % told {:.3} % cover {:.3}",
                        100.0 * (mean / truth - 1.0),
                        (mean - truth) / (sd / n.sqrt()),
                        100.0 * sd / truth,
                        100.0 * told / truth,
                        covered as f64 / n
                    );
                }
                println!();
            }
        }
    }
}
