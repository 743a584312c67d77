//! A fit allocates for the impact, never per sample, step or evaluation.

#![allow(clippy::unwrap_used, clippy::print_stdout)]

use crate::rubber;

use rubber::{impact, rig};
use windfall_contact::expression::parse_law;
use windfall_contact::law::EndRule;
use windfall_contact::laws::kuwabara_kono::KuwabaraKono;
use windfall_identify::fit::model::{Columns, Model, Sampling};
use windfall_identify::fit::problem::{FitOptions, LawProblem};
use windfall_identify::fit::residual::evaluate;
use windfall_identify::fit::result::fit_impact;
use windfall_identify::rig::impact_event::{ImpactEvent, Seeds};
use windfall_identify::rig::motion::Motion;
use windfall_identify::samples::SampleGroup;
use windfall_numerics::ode::step::Tolerance;
use windfall_numerics::real::Lanes;
use windfall_signal::impact::{Impact, Series};

fn allocations(work: impl FnOnce()) -> u64 {
    allocation_counter::measure(work).count_total
}

/// One evaluation with sensitivities allocates nothing at all.
#[test]
fn pinned_evaluation_allocates_nothing() {
    let times: Vec<f64> = (0..1111).map(|i| 5e-6 * f64::from(i) - 1e-5).collect();
    let values = vec![0.1; times.len()];
    let sampled = Some((values.as_slice(), 1.0));
    let group = SampleGroup::new(&times, [sampled, sampled, sampled, None]);
    let mut seeds = Seeds::<2, 4>::NONE;
    seeds.parameters = [Lanes::unit(1, 4e5), Lanes::unit(2, 700.0)];
    seeds.velocity = Lanes::unit(3, 0.4);
    let model = Model {
        event: ImpactEvent {
            law: KuwabaraKono { k: 4e5, c: 700.0 },
            motion: Motion::from(&rig()),
            velocity: 0.388,
            end: EndRule::ForceZero,
            seeds,
            tolerance: Tolerance {
                relative: 1e-8,
                absolute: [1e-12, 1e-10],
            },
        },
        onset: 0.0,
        offset: 0.0,
        columns: Columns {
            lanes: [1, 2, 3, 0, 0],
            onset: [0.0, 0.0, 0.0, 1e-3, 0.0],
            offset: [0.0, 0.0, 0.0, 0.0, 1e-3],
        },
        sampling: Sampling::Averaged,
    };
    let groups = [group];
    let mut cost = 0.0;
    let count = allocations(|| cost = evaluate(&model, &groups, None).unwrap().cost);
    assert!(cost.is_finite() && cost > 0.0);
    assert_eq!(count, 0);
}

/// The impact with every second sample.
fn thinned(impact: &Impact) -> Impact {
    let thin = |series: &Option<Series>| {
        series.as_ref().map(|s| Series {
            times: s.times.iter().copied().step_by(2).collect(),
            values: s.values.iter().copied().step_by(2).collect(),
            ..s.clone()
        })
    };
    Impact {
        displacement: thin(&impact.displacement),
        rate: thin(&impact.rate),
        force: thin(&impact.force),
        ..impact.clone()
    }
}

/// A whole fit with its report: the number of allocations grows neither with
/// the samples (but for the doubling of a few growing lists) nor with the
/// evaluations.
#[test]
fn pinned_fit_does_not_allocate_per_sample() {
    let full = impact(1);
    let half = thinned(&full);
    let problem = LawProblem::from_expression(&parse_law("kuwabara-kono").unwrap());
    let options = FitOptions::default();
    let count = |impact: &Impact| {
        let mut samples = 0;
        let found = allocations(|| {
            samples = fit_impact(impact, &rig(), &problem, &options)
                .unwrap()
                .samples;
        });
        (samples, found)
    };
    let ((more, of_full), (fewer, of_half)) = (count(&full), count(&half));
    // The edges of the encoder are as many in both.
    assert!(more > fewer + 700 && fewer > 900, "{more} {fewer}");
    println!("{of_full} allocations for {more} samples, {of_half} for {fewer}");
    assert!(of_full < of_half + 40, "{of_full} {of_half}");
    assert!(of_full < 600, "{of_full}");
}
