//! Sizes, costs and goals of the options, read and checked.

use crate::options::PlanOptions;
use crate::parse::{Fruit, at_least_zero, fruit, impacts, part, positive};
use crate::power::Sides;
use crate::question::{Levels, Question, Size};
use crate::search::Goal;
use windfall_files::error::Error;
use windfall_files::option_value::unusable;
use windfall_files::text::number::plain;

/// What fruit and impacts cost.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Costs {
    pub fruit: f64,
    pub impact: f64,
    pub budget: Option<f64>,
}

/// What is asked for, read and checked.
pub(crate) struct Asked {
    pub fruit: Fruit,
    pub impacts: Vec<usize>,
    pub goal: Goal,
    pub levels: Levels,
    pub costs: Option<Costs>,
}

/// Reads and checks what is asked for.
///
/// # Errors
/// An option cannot be used.
pub(crate) fn asked(question: &dyn Question, options: &PlanOptions) -> Result<Asked, Error> {
    part("--confidence", options.confidence)?;
    if let Some(assurance) = options.assurance {
        part("--assurance", assurance)?;
        if !question.has_assurance() {
            let problem = "the half-width of this question is simulated, and its mean is planned";
            return Err(unusable("--assurance", problem));
        }
    }
    let costs = costs(options)?;
    let asked = Asked {
        fruit: fruit(options.fruit.as_deref(), options.most_fruit)?,
        impacts: impacts(options.impacts.as_deref(), question.usual_impacts())?,
        goal: goal(options)?,
        levels: Levels {
            confidence: options.confidence,
            sides: match options.one_sided {
                true => Sides::One,
                false => Sides::Two,
            },
            assurance: options.assurance,
        },
        costs,
    };
    let open = matches!(asked.fruit, Fruit::Open(_));
    let budget = asked.costs.is_some_and(|costs| costs.budget.is_some());
    match asked.goal {
        Goal::Open if open && !budget => {
            let problem = "say what is wanted, --power 0.8 or --half-width WIDTH, or how many \
                           fruit there are: --fruit 12";
            Err(unusable("--fruit", problem))
        }
        Goal::Power(_) if open && !budget && !question.has_effect() => {
            let problem = "the effect that is to be found is not stated: say it, or give --fruit \
                           to see the smallest effect that so many find";
            Err(unusable(question.effect_option(), problem))
        }
        _ => Ok(asked),
    }
}

fn goal(options: &PlanOptions) -> Result<Goal, Error> {
    match (options.power, options.half_width) {
        (Some(power), _) => {
            let alpha = 1.0 - options.confidence;
            if part("--power", power)? <= alpha {
                let problem = format!(
                    "{power} is no more than the level of the test, {}, which no fruit at all \
                     would reach: 0.8 and 0.9 are usual",
                    plain(alpha)
                );
                return Err(unusable("--power", problem));
            }
            Ok(Goal::Power(power))
        }
        (None, Some(width)) => Ok(Goal::HalfWidth(positive("--half-width", width)?)),
        (None, None) => Ok(Goal::Open),
    }
}

fn costs(options: &PlanOptions) -> Result<Option<Costs>, Error> {
    let given = |option: &str, cost: Option<f64>| match cost {
        Some(cost) => at_least_zero(option, cost),
        None => Ok(0.0),
    };
    let fruit = given("--cost-fruit", options.cost_fruit)?;
    let impact = given("--cost-impact", options.cost_impact)?;
    if let Some(budget) = options.budget {
        positive("--budget", budget)?;
        if fruit + impact == 0.0 {
            let problem = "a budget needs costs above zero: --cost-fruit, --cost-impact or both";
            return Err(unusable("--budget", problem));
        }
    }
    let stated = options.cost_fruit.is_some() || options.cost_impact.is_some();
    Ok(stated.then_some(Costs {
        fruit,
        impact,
        budget: options.budget,
    }))
}

/// What a study costs, where costs are stated.
pub(crate) fn cost(question: &dyn Question, asked: &Asked, size: Size) -> Option<f64> {
    let count = question.count(size);
    let costs = asked.costs?;
    Some(costs.fruit * count.fruit as f64 + costs.impact * count.impacts as f64)
}
