//! Groups of impacts by their velocity, each of which is predicted from the others.

/// Velocities that differ by more than this part belong to different levels; 1.
const LEVEL_GAP: f64 = 0.08;
/// Largest variance of ln v within levels, over what k equal parts of evenly spread velocities
/// have, 1/k² of the whole; 1.
const WITHIN: f64 = 0.4;
/// Fewest impacts that are split into thirds.
const FEWEST: usize = 6;
/// Parts into which velocities without levels are split.
const PARTS: usize = 3;

/// How impacts came into groups of velocity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LevelSource {
    /// The levels that the user gave.
    Column,
    /// Velocities that were set: groups with gaps between them.
    Gaps,
    /// Velocities without levels: the slowest, the middle and the fastest third.
    Thirds,
}

/// Groups of velocity.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct VelocityLevels {
    /// Number of the level of each impact.
    pub of: Vec<usize>,
    /// Where they come from.
    pub source: LevelSource,
}

/// Levels of impacts: those that were `given` if they repeat, else those that the velocities
/// show, else thirds of the sorted velocities.
///
/// Velocities show levels where gaps of 8 % between them leave groups that hold two impacts on
/// average and are clearly narrower than equal parts of evenly spread velocities. Fewer than six impacts, and
/// velocities that are all the same within 8 %, are not split into thirds.
///
/// * `velocities`: m/s
/// * `given`: numbers of levels, counted from 0
pub fn velocity_levels(velocities: &[f64], given: Option<Vec<usize>>) -> VelocityLevels {
    let n = velocities.len();
    let repeat = |of: &[usize]| n < FEWEST || 2 * (1 + of.iter().max().unwrap_or(&0)) <= n;
    if let Some(of) = given.filter(|of| repeat(of)) {
        let source = LevelSource::Column;
        return VelocityLevels { of, source };
    }
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|a, b| velocities[*a].total_cmp(&velocities[*b]));
    let mut of = vec![0; n];
    let mut level = 0;
    for pair in order.windows(2) {
        if velocities[pair[1]] > velocities[pair[0]] * (1.0 + LEVEL_GAP) {
            level += 1;
        }
        of[pair[1]] = level;
    }
    let one_velocity = match (order.first(), order.last()) {
        (Some(first), Some(last)) => velocities[*last] <= velocities[*first] * (1.0 + LEVEL_GAP),
        _ => true,
    };
    if n < FEWEST || one_velocity || (repeat(&of) && narrow(velocities, &of)) {
        let source = LevelSource::Gaps;
        return VelocityLevels { of, source };
    }
    for (place, &impact) in order.iter().enumerate() {
        of[impact] = PARTS * place / n;
    }
    let source = LevelSource::Thirds;
    VelocityLevels { of, source }
}

/// Whether levels are narrower than the gaps between them.
fn narrow(velocities: &[f64], of: &[usize]) -> bool {
    let logs: Vec<f64> = velocities.iter().map(|v| v.ln()).collect();
    let square = |own: &[f64]| {
        let mean = own.iter().sum::<f64>() / own.len().max(1) as f64;
        own.iter().map(|y| (y - mean).powi(2)).sum::<f64>()
    };
    let count = 1 + of.iter().copied().max().unwrap_or(0);
    let within = (0..count).map(|level| {
        let own = logs.iter().zip(of).filter(|own| *own.1 == level);
        square(&own.map(|own| *own.0).collect::<Vec<f64>>())
    });
    within.sum::<f64>() * (count * count) as f64 <= WITHIN * square(&logs)
}

#[cfg(test)]
mod tests {
    use super::*;
    use windfall_signal::noise::gaussian::{noise_source, uniform};

    fn continuous(n: usize, seed: u64) -> Vec<f64> {
        let mut source = noise_source(seed, 0);
        (0..n).map(|_| 0.2 + 0.3 * uniform(&mut source)).collect()
    }

    #[test]
    fn continuous_velocities_become_thirds_of_equal_size() {
        for seed in 0..200 {
            let velocities = continuous(40, seed);
            let levels = velocity_levels(&velocities, None);
            assert_eq!(levels.source, LevelSource::Thirds, "{seed}");
            let of = |level: usize| {
                let own = velocities.iter().zip(&levels.of);
                let own: Vec<f64> = own.filter(|o| *o.1 == level).map(|o| *o.0).collect();
                let low = own.iter().copied().fold(f64::INFINITY, f64::min);
                let high = own.iter().copied().fold(0.0, f64::max);
                (own.len(), low, high)
            };
            let (slow, middle, fast) = (of(0), of(1), of(2));
            assert_eq!((slow.0, middle.0, fast.0), (14, 13, 13));
            assert!(slow.2 <= middle.1 && middle.2 <= fast.1);
        }
    }

    #[test]
    fn set_velocities_stay_levels() {
        // By hand: 3 % scatter about 0.2, 0.3 and 0.45 m/s.
        let velocities = [0.2, 0.206, 0.194, 0.3, 0.309, 0.291, 0.45, 0.464, 0.437];
        let levels = velocity_levels(&velocities, None);
        assert_eq!(levels.source, LevelSource::Gaps);
        assert_eq!(levels.of, [0, 0, 0, 1, 1, 1, 2, 2, 2]);
        // One velocity.
        let levels = velocity_levels(&[0.3, 0.302, 0.299, 0.3, 0.301, 0.3], None);
        assert_eq!((levels.source, levels.of), (LevelSource::Gaps, vec![0; 6]));
        // Too few to be split: each level by itself, as before.
        let levels = velocity_levels(&[0.5, 0.2, 0.3, 0.4], None);
        assert_eq!(
            (levels.source, levels.of),
            (LevelSource::Gaps, vec![3, 0, 1, 2])
        );
        assert!(velocity_levels(&[], None).of.is_empty());
    }

    #[test]
    fn a_column_counts_where_its_levels_repeat() {
        let velocities = continuous(8, 3);
        let given = vec![0, 1, 0, 1, 2, 3, 2, 3];
        let levels = velocity_levels(&velocities, Some(given.clone()));
        assert_eq!((levels.source, levels.of), (LevelSource::Column, given));
        let numbered = velocity_levels(&velocities, Some((0..8).collect()));
        assert_eq!(numbered.source, LevelSource::Thirds);
        // One gap by chance makes no levels: 1 and 7 impacts.
        let velocities = [0.2, 0.23, 0.245, 0.26, 0.28, 0.3, 0.32, 0.34];
        let levels = velocity_levels(&velocities, None);
        assert_eq!(levels.source, LevelSource::Thirds);
    }
}
