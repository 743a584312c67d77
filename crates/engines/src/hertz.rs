//! Laws as Hertz's contact with a constant restitution.

use crate::delivered::{Ends, Force};
use crate::pair::{Given, Pair, elastic, sizes};
use windfall_contact::granular_law::Damping;
use windfall_contact::laws::kind::Law;

/// Hertz's contact with a constant restitution, in engines that have it.
pub(crate) struct HertzWithRestitution<'a> {
    /// E*; Pa.
    pub modulus: f64,
    /// 1
    pub restitution: f64,
    pub exact: String,
    pub approximate: String,
    pub force: Force<'a>,
}

impl<'a> HertzWithRestitution<'a> {
    pub(crate) fn given(self, given: String, exact: String, approximate: String) -> Given<'a> {
        Given {
            words: (given, exact, approximate),
            felt: Some((self.force, Ends::Gap)),
        }
    }
}

/// A law as Hertz's contact with a constant restitution. Such engines let damping pull until the
/// bodies part (Tsuji, Tanaka and Ishida 1992, Powder Technol. 71, 239): then their coefficient
/// is what they deliver, at every speed.
pub(crate) fn hertz<'a>(pair: &Pair<'a>) -> Option<HertzWithRestitution<'a>> {
    let (k, n) = elastic(&pair.law)?;
    if n != 1.5 {
        return None;
    }
    let elastic = matches!(
        pair.law.granular().map(|own| own.damping),
        Ok(Damping::None)
    );
    // One that is given a restitution, too; but it ends with its force.
    let constant = matches!(pair.law, Law::Tsuji(own) if (own.mass / pair.mass - 1.0).abs() < 0.01);
    let e = if elastic {
        1.0
    } else {
        pair.restitution(pair.speed)
    };
    let approximate = match (elastic, constant) {
        (true, _) => String::new(),
        (false, true) => "damping, which pulls there before bodies part".to_owned(),
        (false, false) => pair.same_restitution(),
    };
    let what = match (elastic, constant) {
        (true, _) => "the normal force",
        (false, true) => "the elastic force and the restitution",
        (false, false) => "the elastic force",
    };
    let damping = match elastic {
        true => 0.0,
        false => damping_ratio(e) * (pair.mass * k).sqrt(),
    };
    Some(HertzWithRestitution {
        modulus: 0.75 * k / pair.radius.sqrt(),
        restitution: e,
        exact: format!("{what}{}", sizes(pair)),
        approximate,
        force: Box::new(move |d: f64, v: f64| k * d.powf(1.5) + damping * d.powf(0.25) * v),
    })
}

/// Damping ratio of a constant restitution.
pub(crate) fn damping_ratio(e: f64) -> f64 {
    let log = e.max(1e-12).ln();
    let pi = std::f64::consts::PI;
    -(5.0_f64.sqrt()) * log / (log * log + pi * pi).sqrt()
}
