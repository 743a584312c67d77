//! Properties of the fruit of a scene that a regression of bruises asks for.

use crate::file::bruise::BruisePlan;
use crate::file::scene::SceneFile;
use windfall_files::error::Error;
use windfall_files::text::toml_source::{TomlSource, invalid};
use windfall_scene::draws::normals;
use windfall_scene::population::FruitKind;
use windfall_scene::scene::Fruit;

/// Streams of the seed for properties; those before it are of the fruit themselves.
const STREAM: u64 = 1 << 32;

/// Fruit in the order in which they come, and the kind of each.
pub fn in_order(fruit: Vec<Fruit>, kinds: &[FruitKind]) -> (Vec<Fruit>, Vec<usize>) {
    let kind_of = kinds.iter().enumerate();
    let kind_of = kind_of.flat_map(|(kind, own)| std::iter::repeat_n(kind, own.count));
    let mut all: Vec<(Fruit, usize)> = fruit.into_iter().zip(kind_of).collect();
    all.sort_by(|a, b| a.0.time.total_cmp(&b.0.time));
    all.into_iter().unzip()
}

/// The plan with the properties of each fruit, drawn from the seed.
///
/// * `kind_of`: of each fruit, in the order of the scene
///
/// # Errors
/// A mean or a standard deviation that is none.
pub fn with_properties(
    source: &TomlSource,
    file: &SceneFile,
    mut plan: BruisePlan,
    kind_of: &[usize],
) -> Result<BruisePlan, Error> {
    for kind in &file.fruit {
        for (name, own) in &kind.get_ref().properties {
            let (mean, sd) = (own.get_ref().mean, own.get_ref().sd);
            if !(mean.is_finite() && sd >= 0.0 && sd.is_finite()) {
                let problem = "a mean must be a number, and a standard deviation at or above zero";
                let text = format!("mean = {mean}, sd = {sd}");
                let key = ("[[fruit]] properties", name.as_str());
                return Err(invalid(source, &own.span(), key, &text, problem.to_owned()));
            }
        }
    }
    let asked = plan.regression.as_ref();
    let asked = asked.map_or_else(Vec::new, |own| own.properties());
    plan.properties = vec![Vec::with_capacity(asked.len()); kind_of.len()];
    for (place, name) in asked.iter().enumerate() {
        let draws = normals(plan.seed, STREAM + place as u64, kind_of.len());
        let fruit = plan.properties.iter_mut().zip(kind_of).zip(draws);
        for ((own, kind), draw) in fruit {
            let property = file.fruit[*kind].get_ref().properties.get(name);
            let value = property.map_or(f64::NAN, |property| {
                property.get_ref().mean + draw * property.get_ref().sd
            });
            own.push(value);
        }
    }
    Ok(plan)
}
