//! Table of unit symbols and SI prefixes.

/// Base units, in the order of the exponents of a dimension.
///
/// Angle, encoder counts and encoder lines have no dimension in the SI. They
/// are kept apart here, so that degrees given for a ratio, or lines given for
/// counts (a factor of four), are noticed.
pub const BASE_UNITS: [&str; 8] = ["m", "kg", "s", "A", "K", "rad", "count", "line"];

/// One unit symbol: `multiply / divide` SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UnitSymbol {
    /// Spellings; the first is preferred.
    pub spellings: &'static [&'static str],
    /// Numerator of the size in SI units.
    pub multiply: f64,
    /// Denominator of the size in SI units. Kept apart so that 4.8 g is the
    /// double nearest to 0.0048.
    pub divide: f64,
    /// Exponents of [`BASE_UNITS`].
    pub exponents: [i8; 8],
    /// Whether SI prefixes may stand before it.
    pub takes_prefix: bool,
}

/// Standard gravity; m/s². Source: 3rd CGPM (1901).
pub const STANDARD_GRAVITY: f64 = 9.80665;

const fn si(spellings: &'static [&'static str], exponents: [i8; 8]) -> UnitSymbol {
    UnitSymbol {
        spellings,
        multiply: 1.0,
        divide: 1.0,
        exponents,
        takes_prefix: true,
    }
}

const fn plain(
    spellings: &'static [&'static str],
    multiply: f64,
    divide: f64,
    exponents: [i8; 8],
) -> UnitSymbol {
    UnitSymbol {
        spellings,
        multiply,
        divide,
        exponents,
        takes_prefix: false,
    }
}

const NONE: [i8; 8] = [0; 8];
const TIME: [i8; 8] = [0, 0, 1, 0, 0, 0, 0, 0];
const LENGTH: [i8; 8] = [1, 0, 0, 0, 0, 0, 0, 0];
const FORCE: [i8; 8] = [1, 1, -2, 0, 0, 0, 0, 0];
const ANGLE: [i8; 8] = [0, 0, 0, 0, 0, 1, 0, 0];

/// Every unit that can be written. Spellings are looked up here before a prefix
/// is split off, so "min" is a minute and "m" never milli alone.
pub const UNIT_SYMBOLS: [UnitSymbol; 32] = [
    plain(&["kg"], 1.0, 1.0, [0, 1, 0, 0, 0, 0, 0, 0]),
    si(&["m"], [1, 0, 0, 0, 0, 0, 0, 0]),
    UnitSymbol {
        spellings: &["g"],
        multiply: 1.0,
        divide: 1000.0,
        exponents: [0, 1, 0, 0, 0, 0, 0, 0],
        takes_prefix: true,
    },
    si(&["s"], TIME),
    si(&["A"], [0, 0, 0, 1, 0, 0, 0, 0]),
    si(&["K"], [0, 0, 0, 0, 1, 0, 0, 0]),
    si(&["N"], [1, 1, -2, 0, 0, 0, 0, 0]),
    si(&["J"], [2, 1, -2, 0, 0, 0, 0, 0]),
    si(&["W"], [2, 1, -3, 0, 0, 0, 0, 0]),
    si(&["Pa"], [-1, 1, -2, 0, 0, 0, 0, 0]),
    si(&["V"], [2, 1, -3, -1, 0, 0, 0, 0]),
    si(&["C"], [0, 0, 1, 1, 0, 0, 0, 0]),
    si(&["Hz"], [0, 0, -1, 0, 0, 0, 0, 0]),
    plain(&["min"], 60.0, 1.0, TIME),
    plain(&["h"], 3600.0, 1.0, TIME),
    si(&["rad"], ANGLE),
    plain(
        &["deg", "°", "degree", "degrees"],
        std::f64::consts::PI,
        180.0,
        ANGLE,
    ),
    plain(
        &["rev", "revs", "revolution", "revolutions"],
        std::f64::consts::TAU,
        1.0,
        ANGLE,
    ),
    plain(
        &["rpm"],
        std::f64::consts::TAU,
        60.0,
        [0, 0, -1, 0, 0, 1, 0, 0],
    ),
    plain(&["count", "counts"], 1.0, 1.0, [0, 0, 0, 0, 0, 0, 1, 0]),
    plain(&["line", "lines"], 1.0, 1.0, [0, 0, 0, 0, 0, 0, 0, 1]),
    plain(
        &["g0", "gn"],
        STANDARD_GRAVITY,
        1.0,
        [1, 0, -2, 0, 0, 0, 0, 0],
    ),
    // Units of testing machines. Source: NIST SP 811 (2008), appendix B.8: all are exact, the
    // pound-force as 0.45359237 kg times standard gravity.
    plain(&["gf"], STANDARD_GRAVITY, 1000.0, FORCE),
    plain(&["kgf", "kp"], STANDARD_GRAVITY, 1.0, FORCE),
    plain(&["lbf"], 44_482_216_152_605.0, 1e13, FORCE),
    plain(&["ozf"], 44_482_216_152_605.0, 16e13, FORCE),
    plain(
        &["in", "inch", "inches", "\"", "\u{2033}"],
        127.0,
        5000.0,
        LENGTH,
    ),
    plain(&["mil", "mils", "thou"], 127.0, 5e6, LENGTH),
    plain(&["ft", "foot", "feet"], 381.0, 1250.0, LENGTH),
    plain(&["bar"], 1e5, 1.0, [-1, 1, -2, 0, 0, 0, 0, 0]),
    plain(&["%", "percent"], 1.0, 100.0, NONE),
    plain(&["1"], 1.0, 1.0, NONE),
];

/// SI prefixes: symbol, numerator, denominator.
pub const PREFIXES: [(char, f64, f64); 12] = [
    ('p', 1.0, 1e12),
    ('n', 1.0, 1e9),
    ('u', 1.0, 1e6),
    ('\u{b5}', 1.0, 1e6),
    ('\u{3bc}', 1.0, 1e6),
    ('m', 1.0, 1e3),
    ('c', 1.0, 1e2),
    ('d', 1.0, 1e1),
    ('h', 1e2, 1.0),
    ('k', 1e3, 1.0),
    ('M', 1e6, 1.0),
    ('G', 1e9, 1.0),
];

/// Temperatures on the Celsius scale: only as the whole unit of a value.
pub const CELSIUS: [&str; 2] = ["degC", "°C"];
/// Zero of the Celsius scale; K.
pub const CELSIUS_ZERO: f64 = 273.15;
