//! The models of the nonlinear data sets of NIST StRD, as their files state
//! them, with derivatives with respect to the parameters by hand.

use std::f64::consts::{PI, TAU};

/// Value of a model and its derivatives at the predictors `x`.
pub type Model<const P: usize> = fn(b: &[f64; P], x: &[f64]) -> (f64, [f64; P]);

/// Bennett5: b1 (b2 + x)^(−1/b3)
pub fn bennett(b: &[f64; 3], x: &[f64]) -> (f64, [f64; 3]) {
    let base = b[1] + x[0];
    let power = base.powf(-1.0 / b[2]);
    let value = b[0] * power;
    let by_base = -value / (b[2] * base);
    (value, [power, by_base, value * base.ln() / (b[2] * b[2])])
}

/// Chwirut1, Chwirut2: exp(−b1 x) / (b2 + b3 x)
pub fn chwirut(b: &[f64; 3], x: &[f64]) -> (f64, [f64; 3]) {
    let below = b[1] + b[2] * x[0];
    let value = (-b[0] * x[0]).exp() / below;
    let by_below = -value / below;
    (value, [-x[0] * value, by_below, x[0] * by_below])
}

/// DanWood: b1 x^b2
pub fn danwood(b: &[f64; 2], x: &[f64]) -> (f64, [f64; 2]) {
    let power = x[0].powf(b[1]);
    (b[0] * power, [power, b[0] * power * x[0].ln()])
}

/// Eckerle4: (b1/b2) exp(−½ ((x − b3)/b2)²)
pub fn eckerle(b: &[f64; 3], x: &[f64]) -> (f64, [f64; 3]) {
    let z = (x[0] - b[2]) / b[1];
    let bell = (-0.5 * z * z).exp() / b[1];
    let value = b[0] * bell;
    (
        value,
        [bell, value * (z * z - 1.0) / b[1], value * z / b[1]],
    )
}

/// ENSO: b1 + b2 cos(2πx/12) + b3 sin(2πx/12) + b5 cos(2πx/b4)
/// + b6 sin(2πx/b4) + b8 cos(2πx/b7) + b9 sin(2πx/b7)
pub fn enso(b: &[f64; 9], x: &[f64]) -> (f64, [f64; 9]) {
    let turn = TAU * x[0];
    let (sin_year, cos_year) = (turn / 12.0).sin_cos();
    let (sin_4, cos_4) = (turn / b[3]).sin_cos();
    let (sin_7, cos_7) = (turn / b[6]).sin_cos();
    let value = b[0]
        + b[1] * cos_year
        + b[2] * sin_year
        + b[4] * cos_4
        + b[5] * sin_4
        + b[7] * cos_7
        + b[8] * sin_7;
    let by_period_4 = (b[4] * sin_4 - b[5] * cos_4) * turn / (b[3] * b[3]);
    let by_period_7 = (b[7] * sin_7 - b[8] * cos_7) * turn / (b[6] * b[6]);
    let derivatives = [
        1.0,
        cos_year,
        sin_year,
        by_period_4,
        cos_4,
        sin_4,
        by_period_7,
        cos_7,
        sin_7,
    ];
    (value, derivatives)
}

/// Gauss1, Gauss2, Gauss3:
/// b1 exp(−b2 x) + b3 exp(−(x − b4)²/b5²) + b6 exp(−(x − b7)²/b8²)
pub fn gauss(b: &[f64; 8], x: &[f64]) -> (f64, [f64; 8]) {
    let decay = (-b[1] * x[0]).exp();
    let bell = |height: f64, centre: f64, width: f64| {
        let z = (x[0] - centre) / width;
        let shape = (-z * z).exp();
        let by_centre = height * shape * 2.0 * z / width;
        [shape, by_centre, by_centre * z]
    };
    let (first, second) = (bell(b[2], b[3], b[4]), bell(b[5], b[6], b[7]));
    let value = b[0] * decay + b[2] * first[0] + b[5] * second[0];
    let derivatives = [
        decay,
        -x[0] * b[0] * decay,
        first[0],
        first[1],
        first[2],
        second[0],
        second[1],
        second[2],
    ];
    (value, derivatives)
}

/// Kirby2: (b1 + b2 x + b3 x²) / (1 + b4 x + b5 x²)
pub fn kirby(b: &[f64; 5], x: &[f64]) -> (f64, [f64; 5]) {
    let x = x[0];
    let below = 1.0 + x * (b[3] + x * b[4]);
    let value = (b[0] + x * (b[1] + x * b[2])) / below;
    let (up, down) = (1.0 / below, -value / below);
    (value, [up, up * x, up * x * x, down * x, down * x * x])
}

/// Lanczos1, Lanczos2, Lanczos3:
/// b1 exp(−b2 x) + b3 exp(−b4 x) + b5 exp(−b6 x)
pub fn lanczos(b: &[f64; 6], x: &[f64]) -> (f64, [f64; 6]) {
    let decay = [1, 3, 5].map(|rate| (-b[rate] * x[0]).exp());
    let mut derivatives = [0.0; 6];
    for term in 0..3 {
        derivatives[2 * term] = decay[term];
        derivatives[2 * term + 1] = -x[0] * b[2 * term] * decay[term];
    }
    let value = b[0] * decay[0] + b[2] * decay[1] + b[4] * decay[2];
    (value, derivatives)
}

/// MGH09: b1 (x² + x b2) / (x² + x b3 + b4)
pub fn mgh09(b: &[f64; 4], x: &[f64]) -> (f64, [f64; 4]) {
    let x = x[0];
    let below = x * x + x * b[2] + b[3];
    let shape = (x * x + x * b[1]) / below;
    let down = -b[0] * shape / below;
    (b[0] * shape, [shape, b[0] * x / below, down * x, down])
}

/// MGH10: b1 exp(b2 / (x + b3))
pub fn mgh10(b: &[f64; 3], x: &[f64]) -> (f64, [f64; 3]) {
    let below = x[0] + b[2];
    let growth = (b[1] / below).exp();
    let value = b[0] * growth;
    (
        value,
        [growth, value / below, -value * b[1] / (below * below)],
    )
}

/// MGH17: b1 + b2 exp(−x b4) + b3 exp(−x b5)
pub fn mgh17(b: &[f64; 5], x: &[f64]) -> (f64, [f64; 5]) {
    let (slow, fast) = ((-x[0] * b[3]).exp(), (-x[0] * b[4]).exp());
    let derivatives = [1.0, slow, fast, -x[0] * b[1] * slow, -x[0] * b[2] * fast];
    (b[0] + b[1] * slow + b[2] * fast, derivatives)
}

/// Misra1a, BoxBOD: b1 (1 − exp(−b2 x))
pub fn misra1a(b: &[f64; 2], x: &[f64]) -> (f64, [f64; 2]) {
    let rise = -(-b[1] * x[0]).exp_m1();
    (b[0] * rise, [rise, b[0] * x[0] * (-b[1] * x[0]).exp()])
}

/// Misra1b: b1 (1 − (1 + b2 x/2)⁻²)
pub fn misra1b(b: &[f64; 2], x: &[f64]) -> (f64, [f64; 2]) {
    let base = 1.0 + 0.5 * b[1] * x[0];
    let rise = 1.0 - base.powi(-2);
    (b[0] * rise, [rise, b[0] * x[0] * base.powi(-3)])
}

/// Misra1c: b1 (1 − (1 + 2 b2 x)^−½)
pub fn misra1c(b: &[f64; 2], x: &[f64]) -> (f64, [f64; 2]) {
    let base = 1.0 + 2.0 * b[1] * x[0];
    let rise = 1.0 - base.powf(-0.5);
    (b[0] * rise, [rise, b[0] * x[0] * base.powf(-1.5)])
}

/// Misra1d: b1 b2 x (1 + b2 x)⁻¹
pub fn misra1d(b: &[f64; 2], x: &[f64]) -> (f64, [f64; 2]) {
    let base = 1.0 + b[1] * x[0];
    let rise = b[1] * x[0] / base;
    (b[0] * rise, [rise, b[0] * x[0] / (base * base)])
}

/// Nelson: b1 − b2 x1 exp(−b3 x2), for the logarithm of the response
pub fn nelson(b: &[f64; 3], x: &[f64]) -> (f64, [f64; 3]) {
    let decay = x[0] * (-b[2] * x[1]).exp();
    (b[0] - b[1] * decay, [1.0, -decay, b[1] * x[1] * decay])
}

/// Rat42: b1 / (1 + exp(b2 − b3 x))
pub fn rat42(b: &[f64; 3], x: &[f64]) -> (f64, [f64; 3]) {
    let growth = (b[1] - b[2] * x[0]).exp();
    let value = b[0] / (1.0 + growth);
    let by_exponent = -value * growth / (1.0 + growth);
    (
        value,
        [1.0 / (1.0 + growth), by_exponent, -x[0] * by_exponent],
    )
}

/// Rat43: b1 / (1 + exp(b2 − b3 x))^(1/b4)
pub fn rat43(b: &[f64; 4], x: &[f64]) -> (f64, [f64; 4]) {
    let growth = (b[1] - b[2] * x[0]).exp();
    let shape = (1.0 + growth).powf(-1.0 / b[3]);
    let value = b[0] * shape;
    let by_exponent = -value * growth / (b[3] * (1.0 + growth));
    let by_power = value * growth.ln_1p() / (b[3] * b[3]);
    (value, [shape, by_exponent, -x[0] * by_exponent, by_power])
}

/// Roszman1: b1 − b2 x − arctan(b3 / (x − b4)) / π
pub fn roszman(b: &[f64; 4], x: &[f64]) -> (f64, [f64; 4]) {
    let below = x[0] - b[3];
    let value = b[0] - b[1] * x[0] - (b[2] / below).atan() / PI;
    let scale = PI * (below * below + b[2] * b[2]);
    (value, [1.0, -x[0], -below / scale, -b[2] / scale])
}

/// Thurber, Hahn1: (b1 + b2 x + b3 x² + b4 x³) / (1 + b5 x + b6 x² + b7 x³)
pub fn thurber(b: &[f64; 7], x: &[f64]) -> (f64, [f64; 7]) {
    let x = x[0];
    let below = 1.0 + x * (b[4] + x * (b[5] + x * b[6]));
    let value = (b[0] + x * (b[1] + x * (b[2] + x * b[3]))) / below;
    let powers = [1.0, x, x * x, x * x * x];
    let (up, down) = (1.0 / below, -value / below);
    let derivatives = [
        up,
        up * powers[1],
        up * powers[2],
        up * powers[3],
        down * powers[1],
        down * powers[2],
        down * powers[3],
    ];
    (value, derivatives)
}
