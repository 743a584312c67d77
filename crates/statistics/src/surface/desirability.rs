//! Desirability of responses and the settings that are best for all of them
//! (Derringer, G. & Suich, R. (1980), J. Quality Technology 12, 214-219).

use crate::surface::analysis::Surface;

/// What is wanted of a response.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Goal {
    /// What is best.
    pub wanted: Wanted,
    /// At or below this the response is useless, unless it is to be small.
    pub low: f64,
    /// At or above this it is useless, unless it is to be large.
    pub high: f64,
    /// Exponent below the target: above 1 asks to be close, below 1 is content.
    pub weight_low: f64,
    /// Exponent above the target.
    pub weight_high: f64,
    /// Importance beside the other responses, 1 to 5.
    pub importance: f64,
}

/// What is best.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Wanted {
    /// This value.
    Target(f64),
    /// As large as can be: from `high` on it is perfect.
    Maximum,
    /// As small as can be: down to `low` it is perfect.
    Minimum,
    /// Anywhere between the limits.
    Range,
}

/// Desirability of one response, from 0 to 1.
pub fn desirability(goal: &Goal, value: f64) -> f64 {
    let part = |from: f64, to: f64, weight: f64| {
        ((value - from) / (to - from)).clamp(0.0, 1.0).powf(weight)
    };
    match goal.wanted {
        Wanted::Maximum => part(goal.low, goal.high, goal.weight_low),
        Wanted::Minimum => part(goal.high, goal.low, goal.weight_high),
        Wanted::Range => f64::from(u8::from(value >= goal.low && value <= goal.high)),
        Wanted::Target(target) if value <= target => match value == target {
            true => 1.0,
            false => part(goal.low, target, goal.weight_low),
        },
        Wanted::Target(target) => part(goal.high, target, goal.weight_high),
    }
}

/// Overall desirability: the geometric mean weighted by importance; 0 if any is 0.
pub fn overall(goals: &[Goal], values: &[f64]) -> f64 {
    let (mut sum, mut weights) = (0.0, 0.0);
    for (goal, value) in goals.iter().zip(values) {
        let own = desirability(goal, *value);
        if own == 0.0 {
            return 0.0;
        }
        sum += goal.importance * own.ln();
        weights += goal.importance;
    }
    (sum / weights).exp()
}

/// Settings with their desirability.
#[derive(Clone, Debug, PartialEq)]
pub struct Optimum {
    /// Coded settings.
    pub point: Vec<f64>,
    /// Responses there.
    pub values: Vec<f64>,
    /// Desirability.
    pub desirability: f64,
}

/// Where the factors may be, in coded units.
#[derive(Clone, Debug, PartialEq)]
pub struct Region {
    /// Lowest settings.
    pub low: Vec<f64>,
    /// Highest settings; equal to the lowest where a factor is held.
    pub high: Vec<f64>,
    /// Largest distance from the centre, if there is one.
    pub radius: Option<f64>,
}

impl Region {
    fn contains(&self, point: &[f64]) -> bool {
        let inside = |(place, value): (usize, &f64)| {
            *value >= self.low[place] - 1e-12 && *value <= self.high[place] + 1e-12
        };
        let distance = point.iter().map(|value| value * value).sum::<f64>().sqrt();
        point.iter().enumerate().all(inside)
            && self.radius.is_none_or(|radius| distance <= radius + 1e-12)
    }

    /// The nearest point within, by the limits first and the radius then.
    fn within(&self, point: &mut [f64]) {
        for (place, value) in point.iter_mut().enumerate() {
            *value = value.clamp(self.low[place], self.high[place]);
        }
        let distance = point.iter().map(|value| value * value).sum::<f64>().sqrt();
        if let Some(radius) = self.radius.filter(|radius| distance > *radius) {
            point
                .iter_mut()
                .for_each(|value| *value *= radius / distance);
        }
    }

    fn free(&self) -> Vec<usize> {
        let places = 0..self.low.len();
        places
            .filter(|place| self.low[*place] < self.high[*place])
            .collect()
    }
}

struct Search<'a> {
    surfaces: &'a [Surface],
    goals: &'a [Goal],
    region: &'a Region,
}

impl Search<'_> {
    fn at(&self, point: &[f64]) -> Optimum {
        let values: Vec<f64> = self.surfaces.iter().map(|s| s.value(point)).collect();
        Optimum {
            desirability: overall(self.goals, &values),
            values,
            point: point.to_vec(),
        }
    }

    /// Distance of the responses from desirable values, to climb where the product is zero.
    fn shortfall(&self, optimum: &Optimum) -> f64 {
        let pairs = self.goals.iter().zip(&optimum.values);
        pairs
            .map(|(goal, value)| {
                let span = (goal.high - goal.low).max(f64::MIN_POSITIVE);
                let (low, high) = match goal.wanted {
                    Wanted::Maximum => (goal.low, f64::INFINITY),
                    Wanted::Minimum => (f64::NEG_INFINITY, goal.high),
                    Wanted::Target(_) | Wanted::Range => (goal.low, goal.high),
                };
                ((low - value).max(value - high).max(0.0)) / span
            })
            .sum()
    }

    fn better(&self, a: &Optimum, b: &Optimum) -> bool {
        match a.desirability == 0.0 && b.desirability == 0.0 {
            true => self.shortfall(a) < self.shortfall(b),
            false => a.desirability > b.desirability,
        }
    }

    /// Tries steps along factors and pairs of them, halving when none helps.
    fn climb(&self, start: Optimum, finest: f64) -> Optimum {
        let free = self.region.free();
        let mut best = start;
        let mut step = 0.25;
        while step > finest {
            let mut moved = false;
            for (place, first) in free.iter().enumerate() {
                for second in &free[place..] {
                    for (a, b) in [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)] {
                        let mut point = best.point.clone();
                        point[*first] += a * step;
                        if second != first {
                            point[*second] += b * step;
                        }
                        self.region.within(&mut point);
                        let found = self.at(&point);
                        if self.better(&found, &best) {
                            best = found;
                            moved = true;
                        }
                    }
                }
            }
            if !moved {
                step *= 0.5;
            }
        }
        best
    }

    /// Gauss-Newton steps of least length to where every target is met, if within reach.
    fn polish(&self, start: &Optimum) -> Optimum {
        let free = self.region.free();
        let targets: Vec<(usize, f64)> = self
            .goals
            .iter()
            .enumerate()
            .filter_map(|(place, goal)| match goal.wanted {
                Wanted::Target(target) => Some((place, target)),
                _ => None,
            })
            .collect();
        let mut best = start.clone();
        if targets.is_empty() || free.is_empty() {
            return best;
        }
        for _ in 0..30 {
            let jacobian = nalgebra::DMatrix::from_fn(targets.len(), free.len(), |row, column| {
                self.surfaces[targets[row].0].slopes(&best.point)[free[column]]
            });
            let missing = nalgebra::DVector::from_fn(targets.len(), |row, _| {
                targets[row].1 - best.values[targets[row].0]
            });
            let decomposed = jacobian.svd(true, true);
            let largest = decomposed.singular_values.max();
            let Ok(step) = decomposed.solve(&missing, 1e-10 * largest) else {
                break;
            };
            let mut point = best.point.clone();
            for (place, change) in free.iter().zip(step.iter()) {
                point[*place] += change;
            }
            if !self.region.contains(&point) {
                break;
            }
            let found = self.at(&point);
            // Rounding alone is left.
            let done = step.amax() < 1e-14;
            if found.desirability + 1e-9 < best.desirability {
                break;
            }
            best = found;
            if done {
                break;
            }
        }
        if best.desirability > 1.0 - 1e-9 || best.desirability >= start.desirability {
            best
        } else {
            start.clone()
        }
    }

    /// Points spread over the region by van der Corput sequences (Halton 1960).
    fn starts(&self, count: usize) -> Vec<Vec<f64>> {
        const PRIMES: [u32; 12] = [2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37];
        let corput = |mut index: usize, base: u32| {
            let (mut value, mut part) = (0.0, 1.0);
            while index > 0 {
                part /= f64::from(base);
                value += part * (index % base as usize) as f64;
                index /= base as usize;
            }
            value
        };
        let point = |index: usize| {
            let mut point: Vec<f64> = (0..self.region.low.len())
                .map(|place| {
                    let part = corput(index, PRIMES[place % PRIMES.len()]);
                    let (low, high) = (self.region.low[place], self.region.high[place]);
                    low + part * (high - low)
                })
                .collect();
            self.region.within(&mut point);
            point
        };
        (0..count).map(point).collect()
    }
}

/// How thoroughly settings are searched for.
struct Effort {
    /// Points that are tried.
    starts: usize,
    /// The best of them that are climbed from.
    climbs: usize,
}

/// Finds the most desirable settings.
///
/// * `surfaces`, `goals`: the responses with what is wanted of them, as many
/// * `region`: where the factors may be
pub fn best_settings(surfaces: &[Surface], goals: &[Goal], region: &Region) -> Optimum {
    let effort = Effort {
        starts: 2000,
        climbs: 12,
    };
    searched(surfaces, goals, region, &effort)
}

fn searched(surfaces: &[Surface], goals: &[Goal], region: &Region, effort: &Effort) -> Optimum {
    let search = Search {
        surfaces,
        goals,
        region,
    };
    let mut starts: Vec<Optimum> = search
        .starts(effort.starts)
        .iter()
        .map(|p| search.at(p))
        .collect();
    starts.sort_by(|a, b| {
        let keys = (b.desirability, a.desirability);
        let by_desirability = keys.0.total_cmp(&keys.1);
        by_desirability.then(search.shortfall(a).total_cmp(&search.shortfall(b)))
    });
    starts.truncate(effort.climbs);
    let mut best: Option<Optimum> = None;
    for start in starts {
        let found = search.polish(&search.climb(start, 1e-9));
        if best
            .as_ref()
            .is_none_or(|known| search.better(&found, known))
        {
            best = Some(found);
        }
        // Nothing is better than perfect.
        if best
            .as_ref()
            .is_some_and(|known| known.desirability > 1.0 - 1e-12)
        {
            break;
        }
    }
    best.unwrap_or_else(|| search.at(&vec![0.0; region.low.len()]))
}

/// Settings that are as good as the best: one dimension of them or more.
#[derive(Clone, Debug, PartialEq)]
pub struct Family {
    /// Number of directions in which settings can change and stay as good.
    pub dimension: usize,
    /// Factor along which the members are given.
    pub along: usize,
    /// Members: the best settings at values of that factor.
    pub members: Vec<Optimum>,
    /// Least and largest value of that factor at which there are such settings.
    pub range: (f64, f64),
}

/// Differences of desirability below this do not matter.
const AS_GOOD: f64 = 1e-6;

/// Finds all settings that are as good as an optimum; `None` where it is alone.
///
/// * `along`: factor at whose values members are given; found out if `None`
/// * `count`: how many values
pub fn equally_good(
    surfaces: &[Surface],
    goals: &[Goal],
    region: &Region,
    best: &Optimum,
    along: Option<usize>,
    count: usize,
) -> Option<Family> {
    let free = region.free();
    let good = |place: usize, value: f64| {
        let mut held = region.clone();
        (held.low[place], held.high[place]) = (value, value);
        let effort = Effort {
            starts: 300,
            climbs: 3,
        };
        let found = searched(surfaces, goals, &held, &effort);
        (found.desirability > best.desirability - AS_GOOD).then_some(found)
    };
    let span = |place: usize| {
        let (low, high) = (region.low[place], region.high[place]);
        let at = |step: usize| low + (high - low) * step as f64 / (count.max(2) - 1) as f64;
        let members: Vec<Optimum> = (0..count.max(2))
            .filter_map(|step| good(place, at(step)))
            .collect();
        members
    };
    let spans = match along {
        Some(place) => vec![(place, span(place))],
        None => free.iter().map(|place| (*place, span(*place))).collect(),
    };
    let (along, members) = spans
        .into_iter()
        .max_by(|a, b| a.1.len().cmp(&b.1.len()).then(b.0.cmp(&a.0)))?;
    if members.len() < 2 {
        return None;
    }
    let step = (region.high[along] - region.low[along]) / (count.max(2) - 1) as f64;
    let ends = (
        members[0].point[along],
        members[members.len() - 1].point[along],
    );
    let range = (
        edge(
            &|value| good(along, value).is_some(),
            ends.0,
            ends.0 - step,
            region.low[along],
        ),
        edge(
            &|value| good(along, value).is_some(),
            ends.1,
            ends.1 + step,
            region.high[along],
        ),
    );
    Some(Family {
        dimension: dimension(surfaces, goals, &free, &members),
        along,
        members,
        range,
    })
}

/// Where settings cease to be good between a good and a bad value.
fn edge(good: &dyn Fn(f64) -> bool, inside: f64, outside: f64, limit: f64) -> f64 {
    if (inside - limit).abs() < 1e-9 {
        return limit;
    }
    let (mut inside, mut outside) = (inside, outside);
    for _ in 0..30 {
        let middle = 0.5 * (inside + outside);
        match good(middle) {
            true => inside = middle,
            false => outside = middle,
        }
    }
    inside
}

/// Free directions less those in which a response that matters changes.
fn dimension(surfaces: &[Surface], goals: &[Goal], free: &[usize], members: &[Optimum]) -> usize {
    let middle = &members[members.len() / 2];
    let matters = |place: &usize| match goals[*place].wanted {
        Wanted::Target(_) => true,
        // Beyond its limit a response may still change.
        Wanted::Maximum => middle.values[*place] < goals[*place].high,
        Wanted::Minimum => middle.values[*place] > goals[*place].low,
        Wanted::Range => false,
    };
    let rows: Vec<usize> = (0..surfaces.len()).filter(matters).collect();
    let jacobian = nalgebra::DMatrix::from_fn(rows.len().max(1), free.len(), |row, column| {
        rows.get(row).map_or(0.0, |place| {
            let surface = &surfaces[*place];
            let scale = surface.fit.total_ss.sqrt();
            surface.slopes(&middle.point)[free[column]] / scale
        })
    });
    free.len() - jacobian.rank(1e-6).min(free.len())
}
