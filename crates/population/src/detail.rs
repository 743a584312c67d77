//! The draws of a population's posterior for other programs.

use crate::outcome::Varying;
use serde_json::{Map, Value, json};
use windfall_files::provenance::VERSION;
use windfall_identify::population::model::PopulationFit;
use windfall_identify::population::posterior::PopulationPosterior;

/// Version of the layout: raised when a key changes its meaning or goes.
const LAYOUT: u32 = 1;

/// The draws in the layout of `arviz.from_json`: chain × draw, and a dimension of names where there
/// are several. Medians in SI; effects and standard deviations on the scale of the model, the
/// logarithm of a stiffness.
pub fn draws_document(
    posterior: &PopulationPosterior,
    fit: &PopulationFit,
    varying: &[Varying],
) -> Value {
    let size = varying.len();
    let names: Vec<&str> = varying.iter().map(|own| own.name.as_str()).collect();
    let pairs: Vec<String> = (0..size)
        .flat_map(|i| (i + 1..size).map(move |j| (i, j)))
        .map(|(i, j)| format!("{}, {}", names[i], names[j]))
        .collect();
    let effects = fit.effects.iter().enumerate();
    let (medians, rest): (Vec<_>, Vec<_>) = effects.partition(|(_, own)| own.covariate.is_none());
    let changes: Vec<String> = rest
        .iter()
        .map(|(_, own)| {
            format!(
                "{} on {}",
                own.parameter,
                own.covariate.as_deref().unwrap_or("")
            )
        })
        .collect();
    let mut group = Group {
        posterior,
        variables: Map::new(),
        dimensions: Map::new(),
    };
    let places = |all: &[(usize, _)]| all.iter().map(|(at, _)| *at).collect::<Vec<usize>>();
    group.add("median", "parameter", &places(&medians), |i, value| {
        varying[i].value(value)
    });
    group.add("effect", "effect", &places(&rest), |_, value| value);
    let mut from = fit.effects.len();
    for (name, level) in [
        ("between", &posterior.between),
        ("within", &posterior.within),
    ] {
        let (sds, correlations) = (level.sds.len(), level.correlations.len());
        let own: Vec<usize> = (from..from + sds).collect();
        group.add(&format!("sd_{name}"), "parameter", &own, |_, value| value);
        let own: Vec<usize> = (from + sds..from + sds + correlations).collect();
        group.add(&format!("correlation_{name}"), "pair", &own, |_, value| {
            value
        });
        from += sds + correlations;
    }
    json!({
        "posterior": group.variables,
        "coords": { "parameter": names, "pair": pairs, "effect": changes },
        "dims": group.dimensions,
        "attrs": {
            "format": "windfall population draws",
            "version": LAYOUT,
            "windfall": VERSION,
            "seed": posterior.drawing.seed,
            "divergences": posterior.divergences,
            "parameter_units": varying.iter().map(|own| own.unit.as_str()).collect::<Vec<_>>(),
            "logarithmic": varying.iter().map(|own| u8::from(own.logarithmic)).collect::<Vec<_>>(),
        },
    })
}

/// Variables with their dimensions.
struct Group<'a> {
    posterior: &'a PopulationPosterior,
    variables: Map<String, Value>,
    dimensions: Map<String, Value>,
}

impl Group<'_> {
    /// A variable of several quantities, if there are any.
    ///
    /// * `places`: of its quantities among the draws
    /// * `scale`: a value for people, of a quantity's index among them
    fn add(
        &mut self,
        name: &str,
        dimension: &str,
        places: &[usize],
        scale: impl Fn(usize, f64) -> f64,
    ) {
        if places.is_empty() {
            return;
        }
        let each = self.posterior.drawing.draws;
        let at = |draw: usize| -> Vec<f64> {
            let own = places.iter().enumerate();
            own.map(|(i, place)| scale(i, self.posterior.draws[*place][draw]))
                .collect()
        };
        let chains: Vec<Vec<Vec<f64>>> = (0..self.posterior.drawing.chains)
            .map(|chain| (chain * each..(chain + 1) * each).map(at).collect())
            .collect();
        self.variables.insert(name.to_owned(), json!(chains));
        self.dimensions.insert(name.to_owned(), json!([dimension]));
    }
}
