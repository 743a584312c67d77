//! Quantities with units: values that can be checked by hand, and what is said
//! about the ones that cannot be read.

use std::f64::consts::{PI, TAU};
use windfall_numerics::unit::quantity::{UnitError, parse_as, parse_quantity, parse_unit};

#[test]
fn closed_form_conversions() {
    // Text, SI unit, exact SI value (conversion by hand).
    let cases = [
        ("0.505 m", "m", 0.505),
        ("8 mm", "m", 0.008),
        ("0.001 mm", "m", 1e-6),
        ("7 µm", "m", 7e-6),
        ("7 μm", "m", 7e-6),
        ("7um", "m", 7e-6),
        ("4.8 g", "kg", 0.0048),
        ("0.2 kg", "kg", 0.2),
        ("200 kHz", "Hz", 200_000.0),
        ("200 kHz", "1/s", 200_000.0),
        ("11 mV/N", "V/N", 0.011),
        ("1.5 min", "s", 90.0),
        ("2 h", "s", 7200.0),
        ("5 mm/ms", "m/s", 5.0),
        ("10 deg", "rad", PI / 18.0),
        ("10°", "rad", PI / 18.0),
        ("1 rev", "rad", TAU),
        ("360000 counts/rev", "count/rad", 360_000.0 / TAU),
        ("2500 lines/rev", "line/rad", 2500.0 / TAU),
        ("20 %", "1", 0.2),
        ("0.35", "1", 0.35),
        ("1 g0", "m/s^2", 9.80665),
        ("2 gn", "m/s²", 19.6133),
        ("9.81 m/s2", "m/s^2", 9.81),
        ("9.81 m s^-2", "m/s^2", 9.81),
        ("9.81 m·s⁻²", "m/s^2", 9.81),
        ("0.01435 kg·m²", "kg m^2", 0.01435),
        ("681 N*s/m^1.5", "kg m^-0.5 s^-1", 681.0),
        ("681 N s/m**1.5", "kg/m^(1/2)/s", 681.0),
        ("3 N/(m s)", "kg s^-3", 3.0),
        ("3 (N/m)^2", "N^2/m^2", 3.0),
        ("3 /s", "Hz", 3.0),
        ("5.56e-4 N s/mm", "N s/m", 0.556),
        ("0.3 MPa", "Pa", 3e5),
        ("0.3 MPa", "N/m^2", 3e5),
        ("20 degC", "K", 293.15),
        ("-5 °C", "K", 268.15),
        ("1.5 kg m^2/s^2", "J", 1.5),
        ("1.5 N m", "J", 1.5),
        ("753599", "N/m^1.5", 753_599.0),
        ("-2.5e3 N", "N", -2500.0),
        (" 1E-3 s ", "s", 0.001),
        (".5 m", "m", 0.5),
    ];
    for (text, unit, expected) in cases {
        let value = parse_as(text, unit).unwrap();
        let error = ((value - expected) / expected).abs();
        assert!(error < 4e-16, "{text}: {value} instead of {expected}");
    }
}

/// Prefixes divide rather than multiply by a rounded power of ten, so a value
/// is the same double as its SI literal.
/// NIST SP 811 (2008), appendix B.8, in which these are exact: the nearest doubles.
#[test]
fn reference_units_of_testing_machines() {
    for (text, unit, expected) in [
        ("1 lbf", "N", 4.4482216152605),
        ("16 ozf", "N", 4.4482216152605),
        ("1 ozf", "N", 0.278_013_850_953_781_2),
        ("1 kgf", "N", 9.80665),
        ("1 kp", "N", 9.80665),
        ("1 gf", "N", 0.00980665),
        ("1 in", "m", 0.0254),
        ("1 \"", "m", 0.0254),
        ("3 inches", "m", 0.0762),
        ("1 mil", "m", 0.0000254),
        ("1 thou", "m", 0.0000254),
        ("1 ft", "m", 0.3048),
        ("1 in/min", "m/s", 0.0254 / 60.0),
        ("1 lbf/in", "N/m", 4.4482216152605 / 0.0254),
    ] {
        assert_eq!(parse_as(text, unit).unwrap(), expected, "{text}");
    }
}

#[test]
fn closed_form_decimal_prefixes_are_exact() {
    for i in 1..2000_u32 {
        let written: f64 = format!("0.{i:06}").parse().unwrap();
        let whole = format!("{}", f64::from(i));
        assert_eq!(
            parse_as(&format!("{whole} mm"), "m").unwrap(),
            f64::from(i) / 1e3
        );
        assert_eq!(parse_as(&format!("{whole} mg"), "kg").unwrap(), written);
        assert_eq!(parse_as(&format!("{written} kg"), "kg").unwrap(), written);
    }
}

/// windfall reference tables, check_values.json, adams_impact k_SI: k[N m^-n] = k[N mm^-n] 1000^n.
#[test]
fn reference_stiffness_of_fractional_power() {
    let value = parse_as("0.868 N/mm^1.91", "N/m^1.91").unwrap();
    assert!(
        (value / 466_143.599_249_379_07 - 1.0).abs() < 1e-15,
        "{value}"
    );
    let negative = parse_as("0.868 N mm^-1.91", "N/m^1.91").unwrap();
    assert!((negative / value - 1.0).abs() < 1e-15);
}

#[test]
fn closed_form_number_alone_has_no_dimension() {
    let quantity = parse_quantity("12.5").unwrap();
    assert_eq!(quantity.value, 12.5);
    assert_eq!(quantity.dimension.to_string(), "1");
}

#[test]
fn closed_form_dimension_text() {
    let cases = [
        ("N s/m^1.5", "m^-0.5 kg s^-1"),
        ("V", "m^2 kg s^-3 A^-1"),
        ("counts/rev", "rad^-1 count"),
        ("m/m", "1"),
    ];
    for (unit, expected) in cases {
        assert_eq!(parse_unit(unit).unwrap().dimension.to_string(), expected);
    }
}

/// Every prefix on every unit that takes one keeps its meaning.
#[test]
fn closed_form_prefixes() {
    let cases = [
        ("1 pA", "A", 1e-12),
        ("1 nm", "m", 1e-9),
        ("1 us", "s", 1e-6),
        ("1 mN", "N", 1e-3),
        ("1 cm", "m", 1e-2),
        ("1 dm", "m", 1e-1),
        ("1 hPa", "Pa", 1e2),
        ("1 kN", "N", 1e3),
        ("1 MHz", "Hz", 1e6),
        ("1 GPa", "Pa", 1e9),
    ];
    for (text, unit, expected) in cases {
        assert_eq!(parse_as(text, unit).unwrap(), expected, "{text}");
    }
}

#[test]
fn rejects_with_a_message_that_says_what_to_do() {
    let cases = [
        (
            "eleven N",
            "N",
            "\"eleven N\" does not begin with a number: write a value and its unit, such as \"0.505 m\"",
        ),
        (
            "",
            "N",
            "\"\" does not begin with a number: write a value and its unit, such as \"0.505 m\"",
        ),
        (
            "nan N",
            "N",
            "\"nan N\" does not begin with a number: write a value and its unit, such as \"0.505 m\"",
        ),
        (
            "inf",
            "1",
            "\"inf\" does not begin with a number: write a value and its unit, such as \"0.505 m\"",
        ),
        (
            "1e999 N",
            "N",
            "\"1e999 N\" is no number below 1e100 in SI units",
        ),
        (
            "1e308 km",
            "m",
            "\"1e308 km\" is no number below 1e100 in SI units",
        ),
        (
            "0,505 m",
            "m",
            "\"0,505 m\" has a decimal comma: write \"0.505 m\"",
        ),
        (
            "3 mater",
            "m",
            "unknown unit \"mater\" in \"3 mater\": known are m, g, s, min, h, N, J, W, Pa, V, A, C, Hz, K, degC, rad, deg, rev, rpm, count, line, g0, %, with SI prefixes p n u m c d h k M G; gf, kgf, lbf, ozf, in, mil, ft",
        ),
        (
            "200 kHZ",
            "Hz",
            "unknown unit \"kHZ\" in \"200 kHZ\": did you mean \"kHz\"?",
        ),
        (
            "3 Nm",
            "J",
            "unknown unit \"Nm\" in \"3 Nm\": did you mean \"N m\" (with a space) or \"nm\"?",
        ),
        (
            "3 kmin",
            "s",
            "unknown unit \"kmin\" in \"3 kmin\": did you mean \"km in\" (with a space) or \"min\"?",
        ),
        (
            "3 N/m s",
            "N s/m",
            "the unit of \"3 N/m s\" multiplies after a \"/\": put what is below the line in parentheses, such as \"N/(m s)\", or the product first, such as \"N s/m\"",
        ),
        (
            "3 W/degC",
            "W/K",
            "\"3 W/degC\" uses degC inside a unit, where its zero has no meaning: write K for differences of temperature",
        ),
        (
            "3 N/",
            "N",
            "the unit of \"3 N/\" is not complete: a unit is written like \"N s/m^1.5\" or \"N/(m s)\"",
        ),
        (
            "3 N/(m s",
            "N",
            "the unit of \"3 N/(m s\" is not complete: a unit is written like \"N s/m^1.5\" or \"N/(m s)\"",
        ),
        (
            "3 m^x",
            "m",
            "unexpected \"x\" in the unit of \"3 m^x\": a unit is written like \"N s/m^1.5\"",
        ),
        (
            "3 m)",
            "m",
            "unexpected \")\" in the unit of \"3 m)\": a unit is written like \"N s/m^1.5\"",
        ),
        (
            "3 $",
            "m",
            "unexpected \"$\" in the unit of \"3 $\": a unit is written like \"N s/m^1.5\"",
        ),
        (
            "8 mm",
            "N",
            "\"8 mm\" is a length (m), but a force in N was expected: write it like \"1 N\"",
        ),
        (
            "0.868 N/mm^1.5",
            "N/m^1.91",
            "\"0.868 N/mm^1.5\" is a stiffness (m^-0.5 kg s^-2), but a stiffness in N/m^1.91 was expected: write it like \"1 N/m^1.91\"",
        ),
        (
            "100 mV/g",
            "V s^2/m",
            "\"100 mV/g\" is a quantity (m^2 s^-3 A^-1), but an acceleration sensitivity in V s^2/m was expected: write it like \"1 V s^2/m\" (\"g\" is the gram; for standard gravity write \"100 mV/g0\")",
        ),
        (
            "360000",
            "counts/rev",
            "\"360000\" has no unit: write it, such as \"360000 counts/rev\"",
        ),
        (
            "2500 lines/rev",
            "count/rev",
            "\"2500 lines/rev\" is a quantity (rad^-1 line), but an encoder resolution in count/rev was expected: write it like \"1 count/rev\"",
        ),
        (
            "10 deg",
            "1",
            "\"10 deg\" is an angle (rad), but a plain number was expected: write it like \"1\"",
        ),
    ];
    for (text, unit, expected) in cases {
        let message = parse_as(text, unit).unwrap_err().to_string();
        assert_eq!(message, expected, "{text}");
    }
}

#[test]
fn rejects_unknown_units_with_their_place() {
    let Err(UnitError::UnknownUnit { offset, symbol, .. }) = parse_quantity("5 N s/zz^1.5") else {
        panic!("an unknown unit was accepted");
    };
    assert_eq!((offset, symbol.as_str()), (6, "zz"));
}

/// No text may make the reader panic.
#[test]
fn rejects_fragments_without_panic() {
    let whole = "−3.5e+ 0.868 N·s/(mm^(1/2)²°µ%g0**)^-1.91⁻";
    let characters: Vec<char> = whole.chars().collect();
    for start in 0..characters.len() {
        for end in start..=characters.len() {
            let fragment: String = characters[start..end].iter().collect();
            let _ = parse_quantity(&fragment);
            let _ = parse_quantity(&format!("1 {fragment}"));
            let _ = parse_unit(&fragment);
        }
    }
}
