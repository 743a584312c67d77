//! `[fit]` of campaign.toml.

use crate::settings::file::{FitFile, QuantityText};
use crate::settings::known::known_of;
use crate::settings::model::{FitPlan, KnownKind, KnownText};
use windfall_contact::expression::{LawExpression, parse_law_among};
use windfall_contact::law::EndRule;
use windfall_contact::laws::kind::LawKind;
use windfall_files::error::Error;
use windfall_files::text::spanned::Spanned;
use windfall_files::text::toml_source::{
    Needed, TomlSource, choice, invalid, missing, refused, suggestion,
};
use windfall_identify::fit::interval::{IntervalMethod, IntervalOptions};
use windfall_identify::fit::problem::{FitOptions, NoiseModel, Quantities, Treatment, Weighting};
use windfall_identify::samples::{QUANTITIES, Quantity};
use windfall_numerics::unit::quantity::parse_as;

const TABLE: &str = "[fit]";

/// Words for the weights of a cost function.
pub const WEIGHTS: [(&str, Weighting); 2] = [
    ("inverse-variance", Weighting::InverseVariance),
    ("inverse-mean", Weighting::InverseMean),
];

/// Words for what is taken for the noise of the channels.
pub const NOISES: [(&str, NoiseModel); 2] = [
    ("automatic", NoiseModel::Automatic),
    ("white", NoiseModel::White),
];

/// Words for how intervals are made.
pub const INTERVALS: [(&str, IntervalMethod); 4] = [
    ("asymptotic", IntervalMethod::Asymptotic),
    ("profile", IntervalMethod::Profile),
    ("bootstrap", IntervalMethod::Bootstrap),
    ("posterior", IntervalMethod::Posterior),
];

/// Words for the end of contact.
pub const ENDS: [(&str, EndRule); 2] = [
    ("force-zero", EndRule::ForceZero),
    ("gap-zero", EndRule::GapZero),
];

/// Words for what is done about a quantity that is not of interest in itself.
pub const TREATMENTS: [(&str, Treatment); 3] = [
    ("auto", Treatment::Auto),
    ("free", Treatment::Free),
    ("fixed", Treatment::Fixed),
];

/// What a campaign fits.
///
/// * `noise_sd`: noise that channels are given
/// * `user`: the user's own laws
///
/// # Errors
/// No law is named, or a word is not known.
pub fn fit_plan(
    source: &TomlSource,
    file: &FitFile,
    noise_sd: [Option<f64>; QUANTITIES],
    user: Vec<LawKind>,
) -> Result<FitPlan, Error> {
    let keys = LawKeys {
        law: file.law.as_ref(),
        laws: file.laws.as_deref(),
        free: file.free.as_deref(),
    };
    let laws = law_expressions(source, &keys, &user)?;
    let free = free_names(source, &keys, &laws)?;
    let mut options = FitOptions::default();
    if let Some(words) = &file.quantities {
        options.quantities = quantities(source, words)?;
    }
    let weights = choice(source, file.weights.as_ref(), (TABLE, "weights"), &WEIGHTS)?;
    options.weighting = weights.unwrap_or(options.weighting);
    options.noise_sd = noise_sd;
    if let (Some(word), Err(problem)) = (&file.weights, noise_counts(&options)) {
        return Err(refused(source, word, (TABLE, "weights"), problem));
    }
    let noise = choice(source, file.noise.as_ref(), (TABLE, "noise"), &NOISES)?;
    options.noise = noise.unwrap_or(options.noise);
    interval_options(source, file, &mut options.intervals)?;
    let end = choice(source, file.end.as_ref(), (TABLE, "end"), &ENDS)?;
    options.end = end.unwrap_or(options.end);
    let treatment = |value: Option<&Spanned<String>>, key| -> Result<Treatment, Error> {
        Ok(choice(source, value, (TABLE, key), &TREATMENTS)?.unwrap_or(Treatment::Auto))
    };
    let velocity = file.initial_velocity.as_ref();
    match velocity.and_then(|value| known_velocity(value.get_ref())) {
        Some(known) => hold_velocity(&mut options, known),
        None => options.initial_velocity = treatment(velocity, "initial_velocity")?,
    }
    options.onset = treatment(file.onset.as_ref(), "onset")?;
    options.displacement_offset =
        treatment(file.displacement_offset.as_ref(), "displacement_offset")?;
    let mut plan = FitPlan {
        laws,
        free,
        known_texts: Vec::new(),
        known: Vec::new(),
        user,
        options,
    };
    known(source, file, &mut plan)?;
    Ok(plan)
}

/// Whether noise that is given can weigh in the cost.
///
/// # Errors
/// Why it cannot.
pub fn noise_counts(options: &FitOptions) -> Result<(), String> {
    let given = options.noise_sd.iter().any(Option::is_some);
    match options.weighting == Weighting::InverseMean && given {
        true => Err(
            "these weights know no noise, and a channel is given one (noise_sd): remove \
                     one of the two"
                .to_owned(),
        ),
        false => Ok(()),
    }
}

/// Priors and bounds.
fn known(source: &TomlSource, file: &FitFile, plan: &mut FitPlan) -> Result<(), Error> {
    let priors = file.prior.iter().map(|own| (KnownKind::Prior, own));
    let bounds = file.bounds.iter().map(|own| (KnownKind::Bounds, own));
    let all: Vec<_> = priors.chain(bounds).collect();
    let text = |(kind, (name, text)): &(KnownKind, (&String, &Spanned<QuantityText>))| KnownText {
        kind: *kind,
        name: (*name).clone(),
        text: text.get_ref().0.clone(),
    };
    plan.known_texts = all.iter().map(text).collect();
    plan.known = known_of(plan).map_err(|(index, problem)| {
        let (kind, (name, text)) = all[index];
        let table = format!("[fit.{}]", kind.name());
        refused(source, text, (&table, name), problem)
    })?;
    Ok(())
}

/// Fewest replicates, draws and chains that an interval can be read from.
pub const LEAST_WORK: [(&str, usize); 3] = [("replicates", 100), ("draws", 100), ("chains", 2)];

/// Whether there is enough work for an interval; what was expected, if not.
///
/// # Errors
/// What was expected.
pub fn enough_work(name: &str, value: usize) -> Result<usize, String> {
    let least = LEAST_WORK.iter().find(|(known, _)| *known == name);
    match least {
        Some((_, least)) if value < *least => Err(format!(
            "{value} are too few to read an interval from; give at least {least}"
        )),
        _ => Ok(value),
    }
}

fn interval_options(
    source: &TomlSource,
    file: &FitFile,
    options: &mut IntervalOptions,
) -> Result<(), Error> {
    let place = (TABLE, "intervals");
    let method = choice(source, file.intervals.as_ref(), place, &INTERVALS)?;
    options.method = method.unwrap_or(options.method);
    let numbers = [
        ("replicates", &file.replicates, &mut options.replicates),
        ("draws", &file.draws, &mut options.draws),
        ("chains", &file.chains, &mut options.chains),
    ];
    for (key, given, place) in numbers {
        if let Some(value) = given {
            let number = usize::try_from(*value.get_ref()).unwrap_or(usize::MAX);
            *place = enough_work(key, number)
                .map_err(|problem| refused(source, value, (TABLE, key), problem))?;
        }
    }
    if let Some(seed) = &file.seed {
        options.seed = *seed.get_ref();
    }
    Ok(())
}

/// A velocity given in place of a treatment, told from a word by its unit: "0.35 m/s".
pub fn known_velocity(text: &str) -> Option<f64> {
    let value = parse_as(text, "m/s").ok()?;
    (value.is_finite() && value > 0.0).then_some(value)
}

/// Holds the velocity at first touch at a given value; m/s.
pub fn hold_velocity(options: &mut FitOptions, velocity: f64) {
    options.initial_velocity = Treatment::Fixed;
    options.known_velocity = Some(velocity);
}

/// Quantities of a cost function by their names.
///
/// # Errors
/// The word that is no quantity, with what was expected.
pub fn quantities_named<'a>(
    words: impl IntoIterator<Item = &'a str>,
) -> Result<Quantities, (String, String)> {
    let names = Quantity::ALL.map(Quantity::name);
    let known = names.join(", ");
    let quantity = |word: &str| {
        let found = Quantity::ALL.into_iter().find(|own| own.name() == word);
        found.ok_or_else(|| {
            let hint = suggestion(word, names);
            (word.to_owned(), format!("expected any of {known}{hint}"))
        })
    };
    let chosen: Vec<Quantity> = words.into_iter().map(quantity).collect::<Result<_, _>>()?;
    match chosen.is_empty() {
        false => Ok(Quantities::of(&chosen)),
        true => Err((String::new(), format!("expected at least one of {known}"))),
    }
}

/// The first of `free` that is a parameter of none of the laws, and what was expected.
pub fn unknown_parameter(free: &[String], laws: &[LawExpression]) -> Option<(usize, String)> {
    let parameters = laws.iter().flat_map(|law| law.kind.describe().parameters);
    let names: Vec<&str> = parameters.map(|parameter| parameter.name).collect();
    let mut free_names = free.iter();
    let index = free_names.position(|name| !names.contains(&name.as_str()))?;
    let known = names.join(", ");
    let problem = format!(
        "no law here has a parameter of that name{}; they have: {known}",
        suggestion(&free[index], names.iter().copied())
    );
    Some((index, problem))
}

fn quantities(source: &TomlSource, words: &[Spanned<String>]) -> Result<Quantities, Error> {
    quantities_named(words.iter().map(|word| word.get_ref().as_str())).map_err(|(text, problem)| {
        let word = words.iter().find(|word| *word.get_ref() == text);
        let at = word.map_or(0..0, Spanned::span);
        invalid(source, &at, (TABLE, "quantities"), &text, problem)
    })
}

/// The keys of `[fit]` that name laws and parameters.
#[derive(Clone, Copy)]
pub struct LawKeys<'a> {
    /// One law.
    pub law: Option<&'a Spanned<String>>,
    /// Several laws.
    pub laws: Option<&'a [Spanned<String>]>,
    /// Parameters that are estimated although they have a value.
    pub free: Option<&'a [Spanned<String>]>,
}

/// The laws of a campaign: built-in ones and those of `user`.
///
/// # Errors
/// None is named, one is not known, or one is named twice.
pub fn law_expressions(
    source: &TomlSource,
    keys: &LawKeys,
    user: &[LawKind],
) -> Result<Vec<LawExpression>, Error> {
    let one = keys.law.into_iter().map(|text| ("law", text));
    let several = keys.laws.unwrap_or_default().iter();
    let texts = one.chain(several.map(|text| ("laws", text)));
    let texts: Vec<(&str, &Spanned<String>)> = texts.collect();
    if texts.is_empty() {
        let needed = Needed {
            table: TABLE,
            key: "laws",
            meaning: "the force laws to fit; `windfall card show --laws` lists them",
            unit: "",
            example: "laws = [\"kuwabara-kono\"]",
        };
        return Err(missing(source, &(0..0), &needed, TABLE.to_owned()));
    }
    let mut laws: Vec<LawExpression> = Vec::new();
    for (key, text) in texts {
        let law = parse_law_among(text.get_ref(), user)
            .map_err(|error| refused(source, text, (TABLE, key), error.to_string()))?;
        if laws.iter().any(|known| known.kind == law.kind) {
            let problem = "this law is named twice; each law can be fitted once".to_owned();
            return Err(refused(source, text, (TABLE, key), problem));
        }
        laws.push(law);
    }
    Ok(laws)
}

/// The parameters that a campaign frees by name.
///
/// # Errors
/// A name is no parameter of any of the laws.
pub fn free_names(
    source: &TomlSource,
    keys: &LawKeys,
    laws: &[LawExpression],
) -> Result<Vec<String>, Error> {
    let words = keys.free.unwrap_or_default();
    let names: Vec<String> = words.iter().map(|word| word.get_ref().clone()).collect();
    match unknown_parameter(&names, laws) {
        None => Ok(names),
        Some((index, problem)) => Err(refused(source, &words[index], (TABLE, "free"), problem)),
    }
}
