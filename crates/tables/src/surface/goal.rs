//! What is wanted of responses, as text.

use windfall_files::error::Error;
use windfall_files::option_value::unusable;
use windfall_statistics::surface::desirability::{Goal, Wanted};

/// `RESPONSE = target 11.3, low 7.6, high 18.3, weight 1, importance 3` → the
/// response and its goal.
///
/// * `observed`: range of a response, which limits it where no limits are given;
///   `None` for an unknown response
///
/// # Errors
/// The text cannot be used; says what was expected.
pub fn goal(
    text: &str,
    observed: &dyn Fn(&str) -> Option<(f64, f64)>,
) -> Result<(String, Goal), Error> {
    let option = format!("--goal {text:?}");
    let wrong = |problem: String| unusable(option.clone(), problem);
    let Some((name, wishes)) = text.split_once('=') else {
        return Err(wrong(
            "expected RESPONSE = target 11.3, or maximum, minimum or range; then low, high, \
             weight and importance where they differ from the usual"
                .to_owned(),
        ));
    };
    let name = name.trim().to_owned();
    let Some((low, high)) = observed(&name) else {
        return Err(wrong(format!("{name:?} is none of the responses")));
    };
    let mut goal = Goal {
        wanted: Wanted::Range,
        low,
        high,
        weight_low: 1.0,
        weight_high: 1.0,
        importance: 3.0,
    };
    let mut wanted = None;
    for wish in wishes.split(',') {
        let (key, value) = wish.trim().split_once(' ').unwrap_or((wish.trim(), ""));
        let number = || {
            let value = value.trim();
            let parsed: Option<f64> = value.parse().ok().filter(|n: &f64| n.is_finite());
            parsed.ok_or_else(|| wrong(format!("{key:?} needs a number, and {value:?} is none")))
        };
        let positive = || {
            number().and_then(|n| match n > 0.0 {
                true => Ok(n),
                false => Err(wrong(format!("{key:?} must be positive"))),
            })
        };
        match key {
            "target" => wanted = Some(Wanted::Target(number()?)),
            "maximum" | "max" => wanted = Some(Wanted::Maximum),
            "minimum" | "min" => wanted = Some(Wanted::Minimum),
            "range" => wanted = Some(Wanted::Range),
            "low" => goal.low = number()?,
            "high" => goal.high = number()?,
            "weight" => {
                goal.weight_low = positive()?;
                goal.weight_high = goal.weight_low;
            }
            "weight_low" => goal.weight_low = positive()?,
            "weight_high" => goal.weight_high = positive()?,
            "importance" => goal.importance = positive()?,
            other => return Err(wrong(format!("{other:?} is not known"))),
        }
    }
    let Some(wanted) = wanted else {
        return Err(wrong(
            "say what is wanted: target and a number, maximum, minimum or range".to_owned(),
        ));
    };
    goal.wanted = wanted;
    let (low, high) = (goal.low, goal.high);
    match goal.wanted {
        Wanted::Target(target) if !(low < target && target < high) => Err(wrong(format!(
            "the target {target} must lie between low ({low}) and high ({high}), which are the \
             observed ends unless they are given"
        ))),
        _ if low >= high => Err(wrong(format!("low ({low}) must be below high ({high})"))),
        _ => Ok((name, goal)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_goals_in_words() {
        let observed = |name: &str| (name == "force").then_some((7.6, 18.3));
        let (name, found) = goal(
            "force = target 11.3, weight_high 2, importance 5",
            &observed,
        )
        .unwrap();
        assert_eq!(name, "force");
        assert_eq!(found.wanted, Wanted::Target(11.3));
        assert_eq!((found.low, found.high, found.weight_low), (7.6, 18.3, 1.0));
        assert_eq!((found.weight_high, found.importance), (2.0, 5.0));
        let (_, found) = goal("force=max, high 30", &observed).unwrap();
        assert_eq!((found.wanted, found.high), (Wanted::Maximum, 30.0));
    }

    #[test]
    fn rejects_goals_that_cannot_be() {
        let observed = |name: &str| (name == "force").then_some((7.6, 18.3));
        for text in [
            "force",
            "interval = target 3",
            "force = target 30",
            "force = target",
            "force = low 3",
            "force = max, low 20",
            "force = max, weight 0",
            "force = best",
        ] {
            assert!(goal(text, &observed).is_err(), "{text}");
        }
    }
}
