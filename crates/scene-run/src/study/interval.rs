//! Shares of bruised fruit over replicates, and their differences, with intervals.

use windfall_distribution::tail::{normal_quantile, t_upper_quantile};

/// Level of the intervals; 1.
const LEVEL: f64 = 0.95;

/// Fruit above a limit in one variant: of each replicate by the bruise model as it is, then by
/// the drawn ones.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Counts {
    /// Replicates, then models.
    pub above: Vec<Vec<usize>>,
    /// Fruit in a replicate.
    pub fruit: usize,
    /// Variance of a share over that of independent fruit, as one replicate tells it; 1.
    pub variance_ratio: f64,
}

/// A number with the ends of its interval; 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// The number.
    pub value: f64,
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

/// Share of fruit above a limit that another batch of as many would have.
///
/// On the scale q = ln(p/(1 − p)), with half a fruit added on either side:
///
/// `half² = max(t² s² (1 + 1/R), z² b/R) + z² c`
///
/// s²: variance of q between replicates, R of them, which have other fruit, other places and
/// resampled laws; t: Student's quantile with R − 1 degrees of freedom; b: variance of q that
/// chance alone gives to one batch of independent fruit; c: variance of q between bruise models
/// drawn from the uncertainty of their coefficients; z: the normal quantile. A machine treats
/// fruit more evenly than chance, or less: what replicates show takes the place of b, which only
/// keeps equal replicates from an interval of no width. Of one replicate only b and c are known,
/// and its first term is 2 z² v b: of this batch and of another one, with the ratio v of
/// variances that pairs of fruit show which bruised each other.
pub fn share(counts: &Counts) -> Estimate {
    let n = counts.fruit as f64;
    let scale = |above: usize| {
        let p = (above as f64 + 0.5) / (n + 1.0);
        (p / (1.0 - p)).ln()
    };
    let rows: Vec<Vec<f64>> = counts
        .above
        .iter()
        .map(|own| own.iter().map(|above| scale(*above)).collect())
        .collect();
    let own = counts.above.iter().map(|own| own[0] as f64 / n);
    let value = mean(&own.collect::<Vec<f64>>());
    let centre = mean(&rows.iter().map(|own| own[0]).collect::<Vec<f64>>());
    // One fruit more on either side: where none is bruised, half a one would tell of nothing.
    let p = ((n + 1.0) / (1.0 + (-centre).exp()) + 0.5) / (n + 2.0);
    let chance = 1.0 / ((n + 2.0) * p * (1.0 - p));
    let half = half_width(&rows, chance, counts.variance_ratio);
    let back = |q: f64| 1.0 / (1.0 + (-q).exp());
    // Half a fruit must not put the share itself outside.
    Estimate {
        value,
        low: back(centre - half).min(value),
        high: back(centre + half).max(value),
    }
}

/// Difference of the shares of pairs of variants, the mean over the pairs; the interval as of
/// [`share`], on the scale of the shares themselves.
///
/// Replicates of both variants have the same seeds, laws and bruise models, so that what these
/// do to both alike is no uncertainty of the difference.
///
/// * `pairs`: the variants compared, the second less the first
pub fn difference(pairs: &[(&Counts, &Counts)]) -> Option<Estimate> {
    let (first, _) = pairs.first()?;
    let share = |own: &Counts, replicate: usize, model: usize| {
        own.above[replicate][model] as f64 / own.fruit as f64
    };
    let replicates = first.above.len();
    let rows: Vec<Vec<f64>> = (0..replicates)
        .map(|replicate| {
            let models = 0..first.above[replicate].len();
            let of = |model: usize| {
                let each = pairs
                    .iter()
                    .map(|(a, b)| share(b, replicate, model) - share(a, replicate, model));
                mean(&each.collect::<Vec<f64>>())
            };
            models.map(of).collect()
        })
        .collect();
    let value = mean(&rows.iter().map(|own| own[0]).collect::<Vec<f64>>());
    // More than one replicate tells of itself how far fruit are not independent.
    let one = |own: &Counts| {
        if replicates > 1 {
            1.0
        } else {
            own.variance_ratio
        }
    };
    let of_one = |own: &Counts| {
        let shares = (0..replicates).map(|replicate| share(own, replicate, 0));
        let p = mean(&shares.collect::<Vec<f64>>());
        let p = (p * own.fruit as f64 + 0.5) / (own.fruit as f64 + 1.0);
        p * (1.0 - p) / own.fruit as f64 * one(own)
    };
    let chance = pairs.iter().map(|(a, b)| of_one(a) + of_one(b));
    let chance = chance.sum::<f64>() / (pairs.len() * pairs.len()) as f64;
    let half = half_width(&rows, chance, 1.0);
    Some(Estimate {
        value,
        low: value - half,
        high: value + half,
    })
}

/// * `rows`: of each replicate, by the models, the first as it is
/// * `chance`: variance by chance of one batch; `ratio`: of that of one replicate
fn half_width(rows: &[Vec<f64>], chance: f64, ratio: f64) -> f64 {
    let models = rows.iter().map(Vec::len).min().unwrap_or(0);
    let column = |model: usize| rows.iter().map(|row| row[model]).collect::<Vec<f64>>();
    let drawn: Vec<f64> = (1..models).map(|model| mean(&column(model))).collect();
    let coefficients = variance(&drawn);
    let between: Vec<f64> = (0..models).map(|model| variance(&column(model))).collect();
    let count = rows.len() as f64;
    let tail = 0.5 * (1.0 - LEVEL);
    let z = normal_quantile(1.0 - tail);
    let batches = match rows.len() > 1 {
        true => {
            let t = t_upper_quantile(tail, count - 1.0);
            let seen = t * t * mean(&between) * (1.0 + 1.0 / count);
            seen.max(z * z * chance / count)
        }
        false => 2.0 * z * z * ratio * chance,
    };
    (batches + z * z * coefficients).sqrt()
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len().max(1) as f64
}

fn variance(values: &[f64]) -> f64 {
    let centre = mean(values);
    let squares: f64 = values.iter().map(|own| (own - centre).powi(2)).sum();
    squares / (values.len() as f64 - 1.0).max(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use windfall_scene::draws::normals;

    /// Batches of a known share that differs between laws: the interval of a few of them holds
    /// that of another one as often as it says.
    #[test]
    fn recovers_another_batch_at_the_stated_rate() {
        const FRUIT: usize = 500;
        let (studies, replicates) = (400, 4);
        let mut held = 0;
        for study in 0..studies {
            let draws = normals(study, 1, replicates + 1 + (replicates + 1) * FRUIT);
            let batch = |number: usize| {
                let p = 1.0 / (1.0 + (1.4 + 0.3 * draws[number]).exp());
                let threshold = normal_quantile(p);
                let from = replicates + 1 + number * FRUIT;
                let own = draws[from..from + FRUIT].iter();
                own.filter(|z| **z < threshold).count()
            };
            let counts = Counts {
                above: (0..replicates).map(|number| vec![batch(number)]).collect(),
                fruit: FRUIT,
                variance_ratio: 1.0,
            };
            let found = share(&counts);
            let other = batch(replicates) as f64 / FRUIT as f64;
            held += usize::from(other >= found.low && other <= found.high);
        }
        let rate = held as f64 / studies as f64;
        // 95 % with five standard errors of 400 studies below it.
        assert!((0.90..=0.995).contains(&rate), "{rate}");
    }

    #[test]
    fn closed_form_intervals_of_one_replicate_and_of_none_bruised() {
        let one = |above: usize| Counts {
            above: vec![vec![above]],
            fruit: 1000,
            variance_ratio: 1.0,
        };
        let found = share(&one(200));
        // q = ln(0.2/0.8) ± 1.96 √(2/(1000·0.2·0.8)).
        assert!((found.value - 0.2).abs() < 1e-12);
        assert!(
            (found.low - 0.1675).abs() < 2e-4 && (found.high - 0.2377).abs() < 2e-4,
            "{found:?}"
        );
        let together = share(&Counts {
            variance_ratio: 2.0,
            ..one(200)
        });
        assert!(
            (together.low - 0.1553).abs() < 2e-4 && (together.high - 0.2545).abs() < 2e-4,
            "{together:?}"
        );
        let none = share(&one(0));
        assert!(none.value == 0.0 && none.low < 1e-4 && (0.002..0.01).contains(&none.high));
        let found = difference(&[(&one(200), &one(300))]).unwrap();
        // ±1.96 √(2 (0.16/1000 + 0.21/1000)) = ±0.0533.
        assert!((found.value - 0.1).abs() < 1e-12);
        assert!(
            (found.high - found.value - 0.0533).abs() < 3e-4,
            "{found:?}"
        );
        assert!(difference(&[]).is_none());
    }

    /// What laws and models do to both variants alike is not in the difference.
    #[test]
    fn closed_form_what_is_common_cancels() {
        let rows = |shift: usize| Counts {
            above: vec![
                vec![100 + shift, 50 + shift, 300 + shift],
                vec![140 + shift, 60 + shift, 360 + shift],
            ],
            fruit: 10_000,
            variance_ratio: 1.0,
        };
        let (a, b) = (rows(0), rows(1000));
        let found = difference(&[(&a, &b)]).unwrap();
        // Two replicates with the same difference: half of the variance of chance is left.
        let chance = 1.959_964 * (0.5 * (0.012 * 0.988 / 1e4 + 0.112 * 0.888 / 1e4_f64)).sqrt();
        assert!(
            (found.high - found.value - chance).abs() < 1e-4,
            "{found:?} {chance}"
        );
        let alone = share(&b);
        assert!(
            alone.high - alone.low > 3.0 * (found.high - found.low),
            "{alone:?}"
        );
    }
}
