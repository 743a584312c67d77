//! Scales of TDMS channels, from raw to physical values.
//!
//! # Source
//! Property names as written by NI software: National Instruments, "TDMS file format
//! internal structure" and the help of "TDMS Create Scaling Information".

use crate::tdms::metadata::Property;
use std::collections::BTreeMap;

/// Input number that denotes the raw values.
pub const RAW: u32 = u32::MAX;

const MOST_SCALES: u32 = 1000;

/// Most steps to evaluate the last scale.
const MOST_STEPS: u32 = 500;

/// A scale; inputs are numbers of other scales or of raw values.
#[derive(Clone, Debug, PartialEq)]
pub enum Scale {
    /// Identity.
    Same { input: u32 },
    /// slope · x + intercept.
    Linear {
        input: u32,
        slope: f64,
        intercept: f64,
    },
    /// `Σ coefficients[i] · xⁱ`.
    Polynomial { input: u32, coefficients: Vec<f64> },
    /// Linear interpolation, with rising `before`; constant outside.
    Table {
        input: u32,
        before: Vec<f64>,
        after: Vec<f64>,
    },
    /// left + right, or right − left.
    Sum {
        left: u32,
        right: u32,
        subtract: bool,
    },
}

/// The scales of a channel by number; the last one yields the physical value.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Scales {
    scales: BTreeMap<u32, Scale>,
}

impl Scales {
    /// Numbers of the raw inputs of the channel.
    pub fn raw_inputs(&self) -> Vec<u32> {
        let mut found = Vec::new();
        self.collect(self.last(), &mut found);
        found.sort_unstable();
        found.dedup();
        found
    }

    /// Number of the scale that yields the physical value.
    fn last(&self) -> u32 {
        self.scales.last_key_value().map_or(RAW, |(last, _)| *last)
    }

    fn collect(&self, number: u32, found: &mut Vec<u32>) {
        match self.scales.get(&number) {
            None => found.push(number),
            Some(scale) => inputs(scale)
                .iter()
                .for_each(|input| self.collect(*input, found)),
        }
    }

    /// Whether evaluation ends: damaged scales may form cycles or grow exponentially.
    pub fn ends(&self) -> bool {
        let mut budget = MOST_STEPS;
        self.within(self.last(), &mut budget)
    }

    fn within(&self, number: u32, budget: &mut u32) -> bool {
        if *budget == 0 {
            return false;
        }
        *budget -= 1;
        let Some(scale) = self.scales.get(&number) else {
            return true;
        };
        inputs(scale)
            .into_iter()
            .all(|input| self.within(input, budget))
    }

    /// Names of the scales for display.
    pub fn describe(&self) -> String {
        let names = self.scales.values().map(|scale| match scale {
            Scale::Same { .. } => "no scale",
            Scale::Linear { .. } => "linear scale",
            Scale::Polynomial { .. } => "polynomial scale",
            Scale::Table { .. } => "table scale",
            Scale::Sum { .. } => "sum of scales",
        });
        names.map(|name| format!(", {name}")).collect()
    }

    /// Applies the scales; `raw` has the values of each of [`Scales::raw_inputs`].
    pub fn apply(&self, raw: &[(u32, &[f64])], out: &mut [f64]) {
        self.value(self.last(), raw, out);
    }

    /// Applies the scales in place to a channel with a single raw input.
    pub fn apply_in_place(&self, values: &mut [f64]) {
        if self
            .scales
            .values()
            .any(|scale| matches!(scale, Scale::Sum { .. }))
        {
            let raw = values.to_vec();
            self.value(self.last(), &[(RAW, &raw)], values);
        } else {
            // The innermost scale finds the raw values in place.
            self.value(self.last(), &[], values);
        }
    }

    fn value(&self, number: u32, raw: &[(u32, &[f64])], out: &mut [f64]) {
        let Some(scale) = self.scales.get(&number) else {
            let found = raw
                .iter()
                .find(|(known, _)| *known == number)
                .or(raw.first());
            if let Some((_, values)) = found {
                out.copy_from_slice(values);
            }
            return;
        };
        self.value(inputs(scale)[0], raw, out);
        match scale {
            Scale::Same { .. } => {}
            Scale::Linear {
                slope, intercept, ..
            } => out.iter_mut().for_each(|x| *x = *x * slope + intercept),
            Scale::Polynomial { coefficients, .. } => {
                let polynomial = |x: f64| {
                    let mut rest = coefficients.iter().rev();
                    let highest = rest.next().copied().unwrap_or(0.0);
                    rest.fold(highest, |sum, c| c + sum * x)
                };
                out.iter_mut().for_each(|x| *x = polynomial(*x));
            }
            Scale::Table { before, after, .. } => {
                out.iter_mut()
                    .for_each(|x| *x = interpolated(*x, before, after));
            }
            Scale::Sum {
                right, subtract, ..
            } => {
                let mut other = vec![0.0; out.len()];
                self.value(*right, raw, &mut other);
                let sign = if *subtract { -1.0 } else { 1.0 };
                out.iter_mut()
                    .zip(&other)
                    .for_each(|(x, y)| *x = sign * *x + y);
            }
        }
    }
}

fn inputs(scale: &Scale) -> Vec<u32> {
    match scale {
        Scale::Same { input }
        | Scale::Linear { input, .. }
        | Scale::Polynomial { input, .. }
        | Scale::Table { input, .. } => vec![*input],
        Scale::Sum { left, right, .. } => vec![*left, *right],
    }
}

/// Linear interpolation at `x`.
fn interpolated(x: f64, before: &[f64], after: &[f64]) -> f64 {
    let place = before.partition_point(|known| *known <= x);
    match place {
        _ if x.is_nan() => x,
        0 => after[0],
        place if place == before.len() => after[place - 1],
        place => {
            let (x0, x1) = (before[place - 1], before[place]);
            let (y0, y1) = (after[place - 1], after[place]);
            (y1 - y0) / (x1 - x0) * (x - x0) + y0
        }
    }
}

/// The scales described by properties of a channel, group or file.
pub fn scales_of(properties: &BTreeMap<String, Property>) -> Result<Scales, String> {
    let mut scales = Scales::default();
    let count = properties.get("NI_Number_Of_Scales");
    let count = count.and_then(Property::number);
    let unscaled = properties
        .get("NI_Scaling_Status")
        .and_then(Property::text)
        .is_none_or(|status| status != "scaled");
    let Some(count) = count.filter(|_| unscaled) else {
        return Ok(scales);
    };
    let count = (count as u32).min(MOST_SCALES);
    for number in 0..count {
        // A scale without a type denotes NI-DAQmx raw values.
        let prefix = format!("NI_Scale[{number}]_");
        let Some(kind) = properties
            .get(&format!("{prefix}Scale_Type"))
            .and_then(Property::text)
        else {
            continue;
        };
        scales
            .scales
            .insert(number, scale(properties, &prefix, kind)?);
    }
    match scales.ends() {
        true => Ok(scales),
        false => Err("its scales are cyclic or too deeply nested".to_owned()),
    }
}

fn scale(
    properties: &BTreeMap<String, Property>,
    prefix: &str,
    kind: &str,
) -> Result<Scale, String> {
    let optional = |name: &str| {
        properties
            .get(&format!("{prefix}{name}"))
            .and_then(Property::number)
    };
    let number = |name: &str| {
        optional(name).ok_or_else(|| format!("the property {prefix}{name} is missing"))
    };
    let input = |name: &str| optional(name).map_or(RAW, |input| input as u32);
    let list = |name: &str, count: usize| {
        (0..count)
            .map(|i| number(&format!("{name}[{i}]")))
            .collect::<Result<Vec<f64>, String>>()
    };
    match kind {
        "Linear" => Ok(Scale::Linear {
            input: input("Linear_Input_Source"),
            slope: number("Linear_Slope")?,
            intercept: number("Linear_Y_Intercept")?,
        }),
        "Polynomial" => {
            let count = optional("Polynomial_Coefficients_Size").unwrap_or(4.0) as usize;
            Ok(Scale::Polynomial {
                input: input("Polynomial_Input_Source"),
                coefficients: list("Polynomial_Coefficients", count)?,
            })
        }
        "Table" => {
            let count = number("Table_Pre_Scaled_Values_Size")? as usize;
            if number("Table_Scaled_Values_Size")? as usize != count || count == 0 {
                return Err("the two columns of its table differ in length".to_owned());
            }
            let mut before = list("Table_Pre_Scaled_Values", count)?;
            let mut after = list("Table_Scaled_Values", count)?;
            let rises = |values: &[f64]| values.windows(2).all(|pair| pair[0] < pair[1]);
            if !rises(&before) {
                before.reverse();
                after.reverse();
            }
            match rises(&before) {
                true => Ok(Scale::Table {
                    input: input("Table_Input_Source"),
                    before,
                    after,
                }),
                false => Err("its table neither rises nor falls".to_owned()),
            }
        }
        "Add" | "Subtract" => Ok(Scale::Sum {
            left: number(&format!("{kind}_Left_Operand_Input_Source"))? as u32,
            right: number(&format!("{kind}_Right_Operand_Input_Source"))? as u32,
            subtract: kind == "Subtract",
        }),
        "AdvancedAPI" => Ok(Scale::Same {
            input: input("AdvancedAPI_Input_Source"),
        }),
        other => Err(format!("windfall does not read its scale \"{other}\"")),
    }
}
