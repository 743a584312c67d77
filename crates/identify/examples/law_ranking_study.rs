//! How often the right law is ranked first:
//!
//! ```text
//! cargo run --release -p windfall-identify --example law_ranking_study -- CAMPAIGNS THREADS [--seed S]
//! ```
//!
//! For each of six forms of a law, campaigns of 20 impacts over three velocities
//! on fruit whose parameters differ by 5 % from spot to spot, recorded with the
//! noise of the 2003 pendulum study (360,000 counts a revolution, 1 N, 200 kHz).
//! All six are fitted to each impact. Prints a Markdown table.

#![allow(clippy::print_stdout, clippy::unwrap_used)]

#[path = "shared/pendulum.rs"]
mod pendulum;

use pendulum::{Bench, arguments, bench, on_threads, recorded, rig};
use windfall_contact::expression::parse_law;
use windfall_contact::laws::kind::{Law, LawKind};
use windfall_identify::compare::ranking::{
    LawRanking, LeveledImpact, Verdict, fits_of_impact, rank_laws,
};
use windfall_identify::fit::problem::{FitOptions, LawProblem};
use windfall_signal::noise::gaussian::{NoiseSource, noise_source, normal};

/// Laws with the parameters of a soft rubber ball or of fruit; at 0.388 m/s all
/// have a peak of about 25 to 40 N.
const LAWS: [&str; 6] = [
    "hertz(k=394931)",
    "kelvin-voigt(k=14000, c=12)",
    "kuwabara-kono(k=394931, c=681)",
    "hunt-crossley(k=394931, lambda=400000)",
    "tsuji(k=394931, restitution=0.6, mass=0.0563)",
    "walton-braun(k1=14000, k2=30000)",
];
/// Impact velocities of the three levels; m/s.
const VELOCITIES: [f64; 3] = [0.25, 0.35, 0.5];
/// Impacts of a campaign.
const IMPACTS: usize = 20;
/// Spread of each free parameter from spot to spot; 1.
const SPREAD: f64 = 0.05;

fn drawn(law: Law, problem: &LawProblem, source: &mut NoiseSource) -> Law {
    let mut values = law.parameters();
    for position in problem.free_positions() {
        values[position] *= (SPREAD * normal(source)).exp();
    }
    law.kind().with_parameters(&values).unwrap_or(law)
}

fn campaign(bench: &Bench, truth: Law, problems: &[LawProblem], seed: u64) -> Option<LawRanking> {
    let options = FitOptions::default();
    let mut source = noise_source(seed, 2000);
    let own = problems.iter().find(|p| p.kind == truth.kind())?;
    let (mut impacts, mut fits) = (Vec::new(), Vec::new());
    for i in 0..IMPACTS {
        let level = i % VELOCITIES.len();
        let law = drawn(truth, own, &mut source);
        let velocity = VELOCITIES[level] * (1.0 + 0.01 * normal(&mut source));
        let Some(impact) = recorded(bench, &law, velocity, seed * 100 + i as u64) else {
            continue;
        };
        fits.push(fits_of_impact(&impact, &rig(), problems, &options));
        impacts.push(LeveledImpact { impact, level });
    }
    rank_laws(&impacts, &fits, &rig(), problems, &options).ok()
}

fn main() {
    let (arguments, begin) = arguments();
    let mut arguments = arguments.into_iter();
    let count: u64 = arguments.next().map_or(20, |a| a.parse().unwrap());
    let threads: u64 = arguments.next().map_or(1, |a| a.parse().unwrap());
    let bench = bench("the 2003 study", 360_000.0, 1.0, 0.0);
    let laws = LAWS.map(|text| parse_law(text).unwrap().complete().unwrap());
    let problems: Vec<LawProblem> = laws
        .iter()
        .map(|law| LawProblem::from_expression(&parse_law(law.kind().name()).unwrap()))
        .collect();
    println!("{count} campaigns of {IMPACTS} impacts for each law\n");
    println!(
        "| simulated with | ranked first | called sure | wrong and sure | wrong and called undecided | best rival: ΔAICc, median | prediction error: right law, best rival |"
    );
    println!("|---|---|---|---|---|---|---|");
    for truth in laws {
        let results = on_threads(count, threads, |seed| {
            campaign(&bench, truth, &problems, begin + seed + 1)
        });
        let rankings: Vec<&LawRanking> = results.iter().flatten().collect();
        row(truth.kind(), &rankings, results.len());
    }
}

fn row(truth: LawKind, rankings: &[&LawRanking], all: usize) {
    let first = |r: &LawRanking| r.laws[0].kind == truth;
    let sure = |r: &LawRanking| matches!(r.verdict, Verdict::Sure { .. });
    let share = |n: usize| 100.0 * n as f64 / all as f64;
    let count = |test: &dyn Fn(&LawRanking) -> bool| rankings.iter().filter(|r| test(r)).count();
    let mut margins: Vec<f64> = rankings
        .iter()
        .map(|r| {
            let own = r
                .laws
                .iter()
                .find(|l| l.kind == truth)
                .map_or(f64::NAN, |l| l.aicc);
            let rival = r.laws.iter().filter(|l| l.kind != truth);
            rival.map(|l| l.aicc).fold(f64::INFINITY, f64::min) - own
        })
        .collect();
    margins.sort_by(f64::total_cmp);
    let error = |of: &dyn Fn(&LawRanking) -> f64| {
        100.0 * rankings.iter().map(|r| of(r)).sum::<f64>() / rankings.len().max(1) as f64
    };
    let right = error(&|r| {
        let own = r.laws.iter().find(|l| l.kind == truth);
        own.and_then(|l| l.prediction).unwrap_or(f64::NAN)
    });
    let rival = error(&|r| {
        let others = r.laws.iter().filter(|l| l.kind != truth);
        others
            .filter_map(|l| l.prediction)
            .fold(f64::INFINITY, f64::min)
    });
    println!(
        "| {} | {:.1} % | {:.1} % | {:.1} % | {:.1} % | {:.0} | {right:.2} %, {rival:.2} % |",
        truth.name(),
        share(count(&|r| first(r))),
        share(count(&|r| first(r) && sure(r))),
        share(count(&|r| !first(r) && sure(r))),
        share(count(&|r| !first(r) && !sure(r))),
        margins.get(margins.len() / 2).copied().unwrap_or(f64::NAN),
    );
}
