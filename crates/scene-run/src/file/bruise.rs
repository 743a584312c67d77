//! `[bruise]` of scene.toml.

use crate::file::key::Section;
use crate::file::regression::{RegressionPlan, read_regression};
use crate::file::scene::{BruiseFile, FruitFile};
use windfall_files::error::Error;
use windfall_files::text::spanned::Spanned;
use windfall_files::text::toml_source::{TomlSource, choice, invalid};
use windfall_scene::bruise::damage::{BruiseModel, Predictor, SameSpot, VolumeLaw};

/// Words of `same_spot`.
pub(crate) const SAME_SPOTS: [(&str, SameSpot); 2] =
    [("largest", SameSpot::Largest), ("sum", SameSpot::Sum)];

/// Words of `predictor`.
pub(crate) const PREDICTORS: [(&str, Predictor); 2] = [
    ("absorbed energy", Predictor::AbsorbedEnergy),
    ("peak force", Predictor::PeakForce),
];

/// How contacts bruise, and what counts as bruised.
#[derive(Clone, Debug)]
pub struct BruisePlan {
    pub model: BruiseModel,
    /// Volumes above which a fruit counts as bruised; m³.
    pub limits: Vec<f64>,
    /// What a regression takes of contacts and fruit.
    pub regression: Option<RegressionPlan>,
    /// Properties that the regression asks for, of each fruit in the order of the scene.
    pub properties: Vec<Vec<f64>>,
    /// Seed of how fruit and bruises differ.
    pub seed: u64,
}

const TABLE: &str = "[bruise]";
/// Bruises of a regression that are smaller than this part of the smallest limit are none; 1.
const LEAST_PART: f64 = 0.01;

/// The model of `[bruise]`, without the properties of the fruit.
pub fn bruise_of(
    source: &TomlSource,
    bruise: &Spanned<BruiseFile>,
    fruit: &[Spanned<FruitFile>],
    seed: u64,
) -> Result<BruisePlan, Error> {
    let file = bruise.get_ref();
    let table = Section {
        source,
        name: TABLE,
        at: bruise.span(),
    };
    let predictor = predictor_of(&table, file)?;
    let limits = limits_of(&table, file)?;
    let smallest = limits.iter().copied().fold(f64::INFINITY, f64::min);
    let mut model = threshold_of(&table, file, predictor)?;
    let key = (TABLE, "same_spot");
    model.same_spot =
        choice(source, file.same_spot.as_ref(), key, &SAME_SPOTS)?.unwrap_or(SameSpot::Largest);
    let regression = regression_of(source, file, fruit)?;
    if let Some(own) = &regression {
        model.law = VolumeLaw::Regression(own.regression.clone());
        model.least_volume = LEAST_PART * smallest;
    }
    if let Some(volume) = table.at_least_zero(&file.least_volume, "least_volume", "m^3")? {
        model.least_volume = volume;
    }
    Ok(BruisePlan {
        model,
        limits,
        regression,
        properties: Vec::new(),
        seed,
    })
}

fn predictor_of(table: &Section, file: &BruiseFile) -> Result<Predictor, Error> {
    let key = (TABLE, "predictor");
    match choice(table.source, file.predictor.as_ref(), key, &PREDICTORS)? {
        Some(predictor) => Ok(predictor),
        // A regression knows its columns; without a threshold there is nothing to predict with.
        None if file.regression.is_some() && file.threshold.is_none() => {
            Ok(Predictor::AbsorbedEnergy)
        }
        None => {
            let meaning = "what of a contact tells its bruise";
            Err(table.lacks("predictor", meaning, "predictor = \"absorbed energy\""))
        }
    }
}

fn limits_of(table: &Section, file: &BruiseFile) -> Result<Vec<f64>, Error> {
    let mut limits = Vec::new();
    for limit in &file.limits {
        limits.extend(table.at_least_zero(&Some(limit.clone()), "limits", "m^3")?);
    }
    match limits.is_empty() {
        true => Err(table.lacks(
            "limits",
            "a volume",
            "limits = [\"100 mm^3\", \"500 mm^3\"]",
        )),
        false => Ok(limits),
    }
}

/// Threshold and susceptibility; with a regression the threshold may be left out, and there
/// is no susceptibility.
fn threshold_of(
    table: &Section,
    file: &BruiseFile,
    predictor: Predictor,
) -> Result<BruiseModel, Error> {
    let (unit, per, threshold, volume) = match predictor {
        Predictor::AbsorbedEnergy => (
            "J",
            "m^3/J",
            "threshold = \"50 mJ\"",
            "susceptibility = \"3000 mm^3/J\"",
        ),
        Predictor::PeakForce => (
            "N",
            "m^3/N",
            "threshold = \"40 N\"",
            "susceptibility = \"5 mm^3/N\"",
        ),
    };
    let by_regression = file.regression.is_some();
    let given = file
        .susceptibility
        .as_ref()
        .or(file.susceptibility_sd.as_ref());
    if let (true, Some(given)) = (by_regression, given) {
        let problem = "a regression says the volumes: leave out the susceptibility or the \
                       regression";
        let text = &given.get_ref().0;
        return Err(table.refused(&given.span(), "susceptibility", text, problem));
    }
    let or_none =
        |value, key, unit| Ok::<f64, Error>(table.at_least_zero(value, key, unit)?.unwrap_or(0.0));
    let needed = |value, key, unit, example| {
        let found = table.at_least_zero(value, key, unit)?;
        found.ok_or_else(|| table.lacks(key, "a coefficient of the bruise", example))
    };
    Ok(BruiseModel {
        predictor,
        threshold: match by_regression {
            true => or_none(&file.threshold, "threshold", unit)?,
            false => needed(&file.threshold, "threshold", unit, threshold)?,
        },
        threshold_sd: or_none(&file.threshold_sd, "threshold_sd", unit)?,
        threshold_between_fruit: or_none(
            &file.threshold_between_fruit,
            "threshold_between_fruit",
            unit,
        )?,
        law: VolumeLaw::Proportional {
            susceptibility: match by_regression {
                true => 0.0,
                false => needed(&file.susceptibility, "susceptibility", per, volume)?,
            },
            sd: or_none(&file.susceptibility_sd, "susceptibility_sd", per)?,
        },
        same_spot: SameSpot::Largest,
        least_volume: 0.0,
    })
}

fn regression_of(
    source: &TomlSource,
    file: &BruiseFile,
    fruit: &[Spanned<FruitFile>],
) -> Result<Option<RegressionPlan>, Error> {
    let Some(name) = &file.regression else {
        return Ok(None);
    };
    let every = fruit.iter().flat_map(|own| own.get_ref().properties.keys());
    let mut known: Vec<String> = every.cloned().collect();
    known.sort();
    known.dedup();
    let table = Section {
        source,
        name: TABLE,
        at: 0..0,
    };
    let path = table.named_file("regression", name)?;
    let plan = read_regression(&path, &file.columns, &known)?;
    for own in fruit {
        for property in plan.properties() {
            if !own.get_ref().properties.contains_key(&property) {
                let problem = format!(
                    "the regression asks for {property} of every fruit: add {property} = \
                     {{ mean = …, sd = … }} to its properties"
                );
                let key = ("[[fruit]]", "properties");
                return Err(invalid(source, &own.span(), key, &property, problem));
            }
        }
    }
    Ok(Some(plan))
}
