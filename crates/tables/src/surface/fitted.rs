//! Fitted response surfaces: their values over two factors and along one.

use windfall_statistics::surface::analysis::Surface;
use windfall_statistics::surface::coding::CodedFactors;
use windfall_statistics::surface::desirability::{Goal, overall};

/// A response with its surface.
#[derive(Clone, Debug)]
pub struct ResponseSurface {
    /// Its name.
    pub name: String,
    /// The surface.
    pub surface: Surface,
    /// What is wanted of it.
    pub goal: Option<Goal>,
}

/// The surfaces of all responses of a table.
#[derive(Clone, Debug)]
pub struct FittedSurfaces {
    /// Factors with the coded values of the runs.
    pub coded: CodedFactors,
    /// Responses in the order in which they were asked for.
    pub responses: Vec<ResponseSurface>,
    /// Coded settings of the factors that a figure does not vary: the optimum, or the centre
    /// with held factors.
    pub reference: Vec<f64>,
    /// Whether `reference` is the optimum.
    pub at_optimum: bool,
    /// Lines of the runs in the file.
    pub lines: Vec<usize>,
}

/// Desirability of all responses at coded settings; `None` where nothing is wanted.
pub fn desirability_at(fitted: &FittedSurfaces, coded: &[f64]) -> Option<f64> {
    let wanted = fitted.responses.iter().filter_map(|response| {
        let goal = response.goal?;
        Some((goal, response.surface.value(coded)))
    });
    let (goals, values): (Vec<Goal>, Vec<f64>) = wanted.unzip();
    (!goals.is_empty()).then(|| overall(&goals, &values))
}

/// Values over two factors, the others at the reference.
#[derive(Clone, Debug, PartialEq)]
pub struct SurfaceGrid {
    /// The two factors by their places.
    pub factors: (usize, usize),
    /// Actual settings of the first, rising.
    pub x: Vec<f64>,
    /// Actual settings of the second, rising.
    pub y: Vec<f64>,
    /// Values, the first factor varying fastest.
    pub values: Vec<f64>,
    /// Standard errors of the mean, where the values are means of a response.
    pub errors: Option<Vec<f64>>,
}

/// What a grid shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shown {
    /// Mean of the response at this place.
    Response(usize),
    /// Desirability of all responses.
    Desirability,
}

/// Values over the range of the runs of two factors, at least 2 `points` along each; the
/// desirability is 0 without goals.
pub fn surface_grid(
    fitted: &FittedSurfaces,
    shown: Shown,
    (first, second): (usize, usize),
    points: usize,
) -> SurfaceGrid {
    let points = points.max(2);
    let along = |factor: usize| -> Vec<f64> {
        let (low, high) = fitted.coded.range(factor);
        let part = |i: usize| i as f64 / (points - 1) as f64;
        (0..points)
            .map(|i| low * (1.0 - part(i)) + high * part(i))
            .collect()
    };
    let (x, y) = (along(first), along(second));
    let settings: Vec<Vec<f64>> = y
        .iter()
        .flat_map(|b| x.iter().map(move |a| (*a, *b)))
        .map(|(a, b)| {
            let mut point = fitted.reference.clone();
            (point[first], point[second]) = (a, b);
            point
        })
        .collect();
    let (values, errors) = match shown {
        Shown::Response(place) => {
            let found = fitted.responses[place].surface.predict(&settings);
            let errors = found.iter().map(|p| p.se).collect();
            (found.iter().map(|p| p.mean).collect(), Some(errors))
        }
        Shown::Desirability => {
            let at = |point: &Vec<f64>| desirability_at(fitted, point).unwrap_or(0.0);
            (settings.iter().map(at).collect(), None)
        }
    };
    let actual = |factor: usize, coded: &[f64]| -> Vec<f64> {
        let own = &fitted.coded.factors[factor];
        coded.iter().map(|value| own.actual(*value)).collect()
    };
    SurfaceGrid {
        factors: (first, second),
        x: actual(first, &x),
        y: actual(second, &y),
        values,
        errors,
    }
}

/// Coded settings over the range of one factor, the others at the reference.
pub fn settings_along(fitted: &FittedSurfaces, factor: usize, points: usize) -> Vec<Vec<f64>> {
    let (low, high) = fitted.coded.range(factor);
    let last = points.max(2) - 1;
    (0..=last)
        .map(|i| {
            let part = i as f64 / last as f64;
            let mut point = fitted.reference.clone();
            point[factor] = low * (1.0 - part) + high * part;
            point
        })
        .collect()
}

/// Every pair of factors, by their places.
pub fn pairs_of_factors(fitted: &FittedSurfaces) -> Vec<(usize, usize)> {
    let count = fitted.coded.factors.len();
    (0..count)
        .flat_map(|a| (a + 1..count).map(move |b| (a, b)))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use windfall_statistics::surface::analysis::fit_surface;
    use windfall_statistics::surface::coding::{FactorCoding, Recognised};
    use windfall_statistics::surface::terms::surface_terms;

    fn fitted(
        factors: Vec<FactorCoding>,
        values: Vec<Vec<f64>>,
        model: &str,
        y: &[f64],
    ) -> FittedSurfaces {
        let names: Vec<String> = factors.iter().map(|f| f.name.clone()).collect();
        let terms = surface_terms(model, &names).unwrap();
        let surface = fit_surface(&factors, &terms, &values, y, 0.95).unwrap();
        FittedSurfaces {
            reference: vec![0.0; factors.len()],
            coded: CodedFactors {
                factors,
                values,
                recognised: Recognised::Given,
            },
            responses: vec![ResponseSurface {
                name: "y".to_owned(),
                surface,
                goal: None,
            }],
            at_optimum: false,
            lines: Vec::new(),
        }
    }

    fn coding(name: &str, centre: f64, half: f64) -> FactorCoding {
        FactorCoding {
            name: name.to_owned(),
            centre,
            half,
        }
    }

    /// On a 3 × 3 factorial y = 10 + 2a − 3b + a² + ab/2 in coded units
    /// is met everywhere between.
    #[test]
    fn closed_form_a_quadratic_over_two_factors() {
        let truth = |a: f64, b: f64| 10.0 + 2.0 * a - 3.0 * b + a * a + 0.5 * a * b;
        let (a, b): (Vec<f64>, Vec<f64>) = (0..9)
            .map(|i| (f64::from(i % 3) - 1.0, f64::from(i / 3) - 1.0))
            .unzip();
        let y: Vec<f64> = a.iter().zip(&b).map(|(a, b)| truth(*a, *b)).collect();
        let factors = vec![coding("p", 50.0, 10.0), coding("q", 0.3, 0.1)];
        let surface = fitted(factors, vec![a, b], "quadratic", &y);
        let grid = surface_grid(&surface, Shown::Response(0), (0, 1), 5);
        assert_eq!((grid.x[0], grid.x[4]), (40.0, 60.0));
        for (index, value) in grid.values.iter().enumerate() {
            let a = (grid.x[index % 5] - 50.0) / 10.0;
            let b = (grid.y[index / 5] - 0.3) / 0.1;
            assert!((value - truth(a, b)).abs() < 1e-10, "{index}");
        }
        let along = settings_along(&surface, 1, 3);
        assert_eq!(along, [[0.0, -1.0], [0.0, 0.0], [0.0, 1.0]]);
        assert_eq!(pairs_of_factors(&surface), [(0, 1)]);
        assert_eq!(desirability_at(&surface, &[0.0, 0.0]), None);
    }
}
