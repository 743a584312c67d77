//! Plans with an exact answer.

use crate::closed::groups::GroupsQuestion;
use crate::closed::request::{DifferenceRequest, GroupsRequest, MeanRequest, SlopeRequest};
use crate::closed::t_test::{Estimate, TQuestion};
use crate::options::PlanOptions;
use crate::outcome::PlanOutcome;
use crate::parse::{finite, numbers, positive};
use crate::run::plan;
use crate::scatter::{KnownScatter, Scatter, known_scatter};
use crate::text::percent;
use windfall_files::error::Error;
use windfall_files::option_value::unusable;
use windfall_files::text::number::plain;

/// Plans a mean.
///
/// # Errors
/// An option cannot be used; no study tells what is wanted.
pub fn plan_mean(request: &MeanRequest) -> Result<PlanOutcome, Error> {
    let effect = effect("--difference", request.difference)?;
    let scatter = known_scatter(&request.scatter, 1, &request.reading)?;
    let first = match effect {
        Some(effect) => format!("mean that differs from a reference by {}", plain(effect)),
        None => "mean of a group of fruit".to_owned(),
    };
    let about = vec![
        first,
        scatter.words.clone(),
        tested("t test of the means of fruit", &request.plan),
    ];
    let question = TQuestion {
        name: "mean",
        estimate: Estimate::Mean,
        effect,
        scatter,
        about,
    };
    plan(&question, &request.plan)
}

/// Plans a difference of two groups, or of two treatments of the same fruit.
///
/// # Errors
/// An option cannot be used; no study tells what is wanted.
pub fn plan_difference(request: &DifferenceRequest) -> Result<PlanOutcome, Error> {
    let effect = effect("--difference", request.difference)?;
    positive("--ratio", request.ratio)?;
    if !(0.01..=100.0).contains(&request.ratio) {
        let problem = format!("{} is not between 0.01 and 100", request.ratio);
        return Err(unusable("--ratio", problem));
    }
    let groups = if request.same_fruit { 1 } else { 2 };
    let scatter = known_scatter(&request.scatter, groups, &request.reading)?;
    let (estimate, test) = estimate_of_difference(request, &scatter.scatter)?;
    let of = effect
        .map(|effect| format!(" of {}", plain(effect)))
        .unwrap_or_default();
    let between = match request.same_fruit {
        true => "two treatments of every fruit",
        false => "two groups of fruit",
    };
    let mut about = vec![
        format!("difference{of} between {between}"),
        scatter.words.clone(),
    ];
    if let Some(sd) = request.effect_sd {
        about.push(format!("SD of the difference between fruit {}", plain(sd)));
    }
    about.push(tested(test, &request.plan));
    let question = TQuestion {
        name: "difference",
        estimate,
        effect,
        scatter,
        about,
    };
    plan(&question, &request.plan)
}

fn estimate_of_difference(
    request: &DifferenceRequest,
    scatter: &Scatter,
) -> Result<(Estimate, &'static str), Error> {
    if request.same_fruit {
        if request.pooled {
            let problem = "with --same-fruit there is one group of fruit: leave it out";
            return Err(unusable("--pooled", problem));
        }
        if let Some(sd) = request.effect_sd {
            positive("--effect-sd", sd)?;
        }
        let test = match (scatter, request.effect_sd) {
            (Scatter::Fruit(_), Some(_)) => {
                let problem = "--sd holds it already: it is that of the differences of a fruit";
                return Err(unusable("--effect-sd", problem));
            }
            (Scatter::Fruit(_), None) => "paired t test",
            (Scatter::Nested { .. }, None) => {
                "t test of a mixed model, y ~ treatment + (1 | fruit)"
            }
            (Scatter::Nested { .. }, Some(_)) => "paired t test of the differences of the fruit",
        };
        let effect_sd = request.effect_sd;
        return Ok((Estimate::SameFruit { effect_sd }, test));
    }
    if request.pooled && scatter.differs() {
        let problem = "one variance for both groups, and two are stated: leave out --pooled";
        return Err(unusable("--pooled", problem));
    }
    let nested = scatter.within().is_some();
    let pooled = request.pooled || nested && !scatter.differs();
    let test = match (pooled, nested) {
        (true, true) => "t test of a mixed model, y ~ group + (1 | fruit)",
        (true, false) => "Student's t test",
        (false, true) => "Welch's t test of the means of fruit",
        (false, false) => "Welch's t test",
    };
    let ratio = request.ratio;
    Ok((Estimate::Groups { ratio, pooled }, test))
}

/// Plans the comparison of several means.
///
/// # Errors
/// An option cannot be used; no study tells what is wanted.
pub fn plan_groups(request: &GroupsRequest) -> Result<PlanOutcome, Error> {
    let means = numbers("--means", &request.means)?;
    let wrong = |problem: &str| unusable(format!("--means {}", request.means), problem);
    let Some((first, rest)) = means.split_first() else {
        return Err(wrong("no means"));
    };
    if rest.is_empty() {
        return Err(wrong(
            "one mean cannot differ from others: give two or more",
        ));
    }
    if rest.iter().all(|mean| mean == first) {
        return Err(wrong(
            "all means are equal: there is no difference to be found",
        ));
    }
    if request.plan.one_sided {
        let problem = "an F test of several means has no sides; plan the difference of two";
        return Err(unusable("--one-sided", problem));
    }
    let scatter = known_scatter(&request.scatter, 1, &request.reading)?;
    if request.same_fruit && scatter.scatter.within().is_none() {
        let problem = "with --same-fruit the impacts of a fruit are compared: give --between and \
                       --within in place of --sd";
        return Err(unusable("--sd", problem));
    }
    let of = match request.same_fruit {
        true => "treatments of every fruit",
        false => "groups of fruit",
    };
    let words: Vec<String> = means.iter().map(|mean| plain(*mean)).collect();
    let about = vec![
        format!("means {} of {} {of}", words.join(", "), means.len()),
        scatter.words.clone(),
        format!(
            "F test that all means are equal, at {}",
            percent(1.0 - request.plan.confidence)
        ),
    ];
    let question = GroupsQuestion {
        means,
        same_fruit: request.same_fruit,
        scatter,
        about,
    };
    plan(&question, &request.plan)
}

/// Plans a slope.
///
/// # Errors
/// An option cannot be used; no study tells what is wanted.
pub fn plan_slope(request: &SlopeRequest) -> Result<PlanOutcome, Error> {
    let effect = effect("--slope", request.slope)?;
    let (spread, values) = spread_of_x(request)?;
    let scatter = known_scatter(&request.scatter, 1, &request.reading)?;
    if let Some(sd) = request.effect_sd {
        positive("--effect-sd", sd)?;
    }
    let (estimate, on, test) = match request.same_fruit {
        true => {
            needs_within(&scatter)?;
            let effect_sd = request.effect_sd;
            let test = match effect_sd {
                None => "t test of a mixed model, y ~ x + (1 | fruit)",
                Some(_) => "t test of the slopes of the fruit",
            };
            let estimate = Estimate::SlopeOnFruit {
                spread,
                values,
                effect_sd,
            };
            (
                estimate,
                "what changes between the impacts of every fruit",
                test,
            )
        }
        false => (
            Estimate::Slope { spread, values },
            "a property of the fruit",
            "t test of the regression of the means of fruit",
        ),
    };
    let of = effect
        .map(|effect| format!(" of {}", plain(effect)))
        .unwrap_or_default();
    let mut about = vec![
        format!(
            "slope{of} on {on}; {}",
            words_of_x(spread, values, request.same_fruit)
        ),
        scatter.words.clone(),
    ];
    if let Some(sd) = request.effect_sd {
        about.push(format!("SD of the slope between fruit {}", plain(sd)));
    }
    about.push(tested(test, &request.plan));
    let question = TQuestion {
        name: "slope",
        estimate,
        effect,
        scatter,
        about,
    };
    plan(&question, &request.plan)
}

/// "SD of x 8, x as they fall".
fn words_of_x(spread: f64, values: Option<usize>, same_fruit: bool) -> String {
    let spread = plain(spread);
    match (values, same_fruit) {
        (None, false) => format!("x as they fall, normal with a standard deviation of {spread}"),
        _ => format!("SD of x {spread}"),
    }
}

fn needs_within(scatter: &KnownScatter) -> Result<(), Error> {
    match scatter.scatter.within() {
        Some(_) => Ok(()),
        None => Err(unusable(
            "--sd",
            "with --same-fruit the impacts of a fruit are compared: give --between and --within \
             in place of --sd",
        )),
    }
}

/// Standard deviation of x, and how many values it has.
fn spread_of_x(request: &SlopeRequest) -> Result<(f64, Option<usize>), Error> {
    if let Some(text) = &request.x {
        let values = numbers("--x", text)?;
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        let squares: f64 = values.iter().map(|x| (x - mean).powi(2)).sum();
        return match squares > 0.0 {
            true => Ok(((squares / n).sqrt(), Some(values.len()))),
            false => {
                let problem = "x has one value: it can explain nothing; give two or more";
                Err(unusable(format!("--x {text}"), problem))
            }
        };
    }
    match request.spread_x {
        Some(spread) => Ok((positive("--spread-x", spread)?, None)),
        None => Err(unusable(
            "--x",
            "give the values that x will have (--x 0.1,0.3,0.5), or their standard deviation \
             (--spread-x)",
        )),
    }
}

/// An effect that is not zero.
fn effect(option: &str, effect: Option<f64>) -> Result<Option<f64>, Error> {
    match effect.map(|effect| finite(option, effect)).transpose()? {
        Some(0.0) => Err(unusable(
            option,
            "0 is no effect: there is nothing to be found; plan the half-width of the interval \
             (--half-width) to show that an effect is small",
        )),
        effect => Ok(effect),
    }
}

/// "t test at 5 %, two-sided".
fn tested(test: &str, options: &PlanOptions) -> String {
    let sides = if options.one_sided {
        "one-sided"
    } else {
        "two-sided"
    };
    format!("{test}, at {}, {sides}", percent(1.0 - options.confidence))
}
