//! Root of a function of one variable inside a bracket.

/// Evaluations before the bracket's middle is taken as it is: bisection alone
/// would be done by then.
const LARGEST_EVALUATIONS: usize = 150;

/// Root of `function` in `[low, high]`, where it is positive at `low` and not
/// positive at `high`.
///
/// Returns the upper end of the last bracket, no wider than `tolerance`. When
/// the function is not positive at `low` already, `low` is returned; when it
/// is still positive at `high`, `high`.
///
/// # Numerics
/// Regula falsi with the Illinois modification, guarded by bisection; about
/// eight evaluations for a smooth function.
///
/// # Source
/// Dowell and Jarratt (1971), A modified regula falsi method for computing the
/// root of an equation.
///
/// # Example
/// ```
/// use windfall_numerics::root::bracketed_root;
/// let root = bracketed_root(0.0, 2.0, 1e-14, |x| 2.0 - x * x);
/// assert!((root - 2f64.sqrt()).abs() < 1e-14);
/// ```
#[inline(always)]
pub fn bracketed_root(low: f64, high: f64, tolerance: f64, function: impl Fn(f64) -> f64) -> f64 {
    let (mut low, mut high) = (low, high);
    let (mut at_low, mut at_high) = (function(low), function(high));
    if at_low <= 0.0 {
        return low;
    }
    if at_high > 0.0 {
        return high;
    }
    let mut side = 0_i8;
    // Widths one and two evaluations ago: a bracket that does not halve in two
    // is bisected.
    let (mut before, mut earlier) = (f64::INFINITY, f64::INFINITY);
    for _ in 0..LARGEST_EVALUATIONS {
        let width = high - low;
        if width <= tolerance {
            break;
        }
        let secant = low + width * at_low / (at_low - at_high);
        let guarded = secant.clamp(low + 0.5 * tolerance, high - 0.5 * tolerance);
        let middle = if width > 0.5 * earlier || !guarded.is_finite() {
            low + 0.5 * width
        } else {
            guarded
        };
        (before, earlier) = (width, before);
        let value = function(middle);
        if value > 0.0 {
            (low, at_low) = (middle, value);
            if side == 1 {
                at_high *= 0.5;
            }
            side = 1;
        } else {
            (high, at_high) = (middle, value);
            if side == -1 {
                at_low *= 0.5;
            }
            side = -1;
        }
    }
    high
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Steep, flat and discontinuous functions with known roots.
    #[test]
    fn closed_form_roots() {
        let cases: [(f64, f64, f64, fn(f64) -> f64); 4] = [
            (0.0, 1.0, 0.5, |x| 0.5 - x),
            (0.0, 3.0, 2.0, |x| 8.0 - x * x * x),
            (0.0, 1.0, 1e-6, |x| (1e-6 - x).cbrt()),
            (0.0, 1.0, 0.3, |x| if x < 0.3 { 1.0 } else { -1e-9 }),
        ];
        for (low, high, root, function) in cases {
            let found = bracketed_root(low, high, 1e-13, function);
            assert!((found - root).abs() < 1e-12, "{found} {root}");
        }
    }
}
