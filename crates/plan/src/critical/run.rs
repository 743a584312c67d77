//! A distribution of critical energies → a plan by simulation.

use crate::critical::question::CriticalQuestion;
use crate::critical::request::CriticalRequest;
use crate::outcome::PlanOutcome;
use crate::parse::{numbers, positive, simulations};
use crate::run::plan;
use windfall_files::error::Error;
use windfall_files::on_threads::on_threads;
use windfall_files::option_value::unusable;
use windfall_files::text::number::plain;
use windfall_repeat::threshold::Family;

/// Plans how well the energy that half the fruit stand is known.
///
/// # Errors
/// An option cannot be used; no study tells what is wanted.
pub fn plan_critical(request: &CriticalRequest) -> Result<PlanOutcome, Error> {
    simulations(request.simulation.simulations)?;
    positive("--median", request.median)?;
    positive("--spread", request.spread)?;
    let energies = numbers("--energies", &request.energies)?;
    let rising = energies.windows(2).all(|pair| pair[0] < pair[1]);
    if !rising || energies.iter().any(|energy| *energy <= 0.0) {
        let problem = "energies above zero are expected, each larger than the one before it";
        return Err(unusable(
            format!("--energies {}", request.energies),
            problem,
        ));
    }
    if energies.len() < 2 {
        let problem = "too few: one energy cannot tell median and spread apart; give two or more";
        return Err(unusable(
            format!("--energies {}", request.energies),
            problem,
        ));
    }
    if request.plan.impacts.is_some() {
        let problem = "every fruit is struck at --energies until it changes: leave it out";
        return Err(unusable("--impacts", problem));
    }
    if request.plan.power.is_some() || request.plan.one_sided {
        let problem = "an energy has an interval and no test: give --half-width, or --fruit";
        return Err(unusable("--power", problem));
    }
    let mut question = CriticalQuestion {
        family: match request.weibull {
            true => Family::Weibull,
            false => Family::LogNormal,
        },
        median: request.median,
        spread: request.spread,
        energies,
        simulation: request.simulation,
        about: Vec::new(),
    };
    question.about = vec![
        format!(
            "median critical energy, expected {}; {} with a spread of ln energy of {}",
            plain(request.median),
            question.family.name(),
            plain(request.spread)
        ),
        format!(
            "struck at {} until a change: {} impacts on a fruit on average",
            request.energies,
            plain(question.impacts())
        ),
        format!(
            "{} simulated studies of each size (seed {}), intervals of the profile likelihood; \
             half-widths are those of ln energy: 0.1 is about 10 %",
            request.simulation.simulations, request.simulation.seed
        ),
    ];
    on_threads(request.simulation.threads, || {
        plan(&question, &request.plan)
    })
}
