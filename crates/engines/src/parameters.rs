//! The contacts of a scene in the terms of other engines, pair by pair of materials.

use std::fmt::Write;
use windfall_contact::granular_law::Damping;
use windfall_contact::law::ContactLaw;
use windfall_contact::laws::kind::Law;
use windfall_contact::with_law;
use windfall_files::text::quote::{comment_text, string_text};
use windfall_scene::interaction::{Draws, Interaction};
use windfall_scene::scene::Scene;

/// An engine whose contacts windfall can write, but which it does not run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Other {
    /// MSC Adams.
    Adams,
    /// YADE.
    Yade,
    /// MercuryDPM.
    MercuryDpm,
    /// Altair EDEM.
    Edem,
    /// Project Chrono, smooth contacts.
    Chrono,
}

/// One contact in another engine's terms.
#[derive(Clone, Debug, serde::Serialize)]
pub struct ContactTerms {
    /// The two materials.
    pub between: [String; 2],
    /// What the engine is given.
    pub given: String,
    /// What is the law itself there.
    pub exact: String,
    /// What is not.
    pub approximate: String,
}

/// A pair of materials with bodies of mean size.
struct Pair<'a> {
    names: [&'a str; 2],
    interaction: &'a Interaction,
    /// The law at the R* of mean fruit.
    law: Law,
    /// R*; m.
    radius: f64,
    /// Effective mass; kg.
    mass: f64,
    /// Impact speed at which approximate damping is right; m/s.
    speed: f64,
}

impl Other {
    /// Its name, for people.
    pub fn title(self) -> &'static str {
        match self {
            Self::Adams => "Adams",
            Self::Yade => "YADE",
            Self::MercuryDpm => "MercuryDPM",
            Self::Edem => "EDEM",
            Self::Chrono => "Chrono",
        }
    }

    /// Name of the file that is written, and what begins a comment in it.
    pub fn file(self) -> (&'static str, &'static str) {
        match self {
            Self::Adams => ("contacts.adm", "! "),
            Self::Yade => ("contacts.py", "# "),
            Self::MercuryDpm => ("contacts_mercury.cpp", "// "),
            Self::Edem => ("contacts_edem.txt", ""),
            Self::Chrono => ("contacts_chrono.cpp", "// "),
        }
    }
}

/// Contacts that fruit of a scene can have, in the terms of an engine.
///
/// * `speed`: impact speed at which damping that is not the law's takes the same energy; m/s
pub fn contact_terms(other: Other, scene: &Scene, speed: f64) -> Vec<ContactTerms> {
    let mut all = Vec::new();
    for (&(a, b), interaction) in &scene.interactions {
        let Some((radius, mass)) = scene.mean_contact((a, b)) else {
            continue;
        };
        // Of the median fruit.
        let law = interaction.law_of(radius, &Draws::default(), None);
        let law = law.unwrap_or(interaction.law);
        let names = [scene.materials[a].as_str(), scene.materials[b].as_str()];
        let pair = Pair {
            names,
            interaction,
            law,
            radius,
            mass,
            speed,
        };
        let (given, exact, mut approximate) = match other {
            Other::Adams => adams(&pair),
            Other::Yade => yade(&pair),
            Other::MercuryDpm => mercury(&pair),
            Other::Edem => edem(&pair),
            Other::Chrono => chrono(&pair),
        };
        // Friction in Adams is another one anyway.
        let sheared = interaction.friction > 0.0 && !matches!(other, Other::Adams);
        if interaction.annuli > 1 && sheared && !given.is_empty() {
            let annuli = interaction.annuli;
            let friction = format!("friction has one spring there, here {annuli} annuli");
            approximate = joined(&[&approximate, &friction]);
        }
        all.push(ContactTerms {
            between: names.map(str::to_owned),
            given,
            exact,
            approximate,
        });
    }
    all
}

/// Contacts as the text of a file, with what is exact and what is not in its comments.
pub fn text_of_terms(other: Other, title: &str, terms: &[ContactTerms]) -> String {
    let (_, comment) = other.file();
    // Python would take the encoding from a title that names one.
    let first = match other {
        Other::Yade => "# -*- coding: utf-8 -*-\n",
        _ => "",
    };
    let mut text = format!(
        "{first}{comment}{}\n{comment}Contacts for {}, written by windfall. SI where no unit is named.\n",
        comment_text(title),
        other.title()
    );
    for own in terms {
        let [a, b] = &own.between;
        let _ = write!(
            text,
            "\n{comment}{} and {}\n{comment}exact: {}\n{comment}approximate: {}\n{}\n",
            comment_text(a),
            comment_text(b),
            own.exact,
            own.approximate,
            own.given
        );
    }
    text
}

type Words = (String, String, String);

/// What cannot be put at all.
fn nothing(pair: &Pair) -> Words {
    (
        String::new(),
        "nothing".to_owned(),
        format!(
            "{} has no counterpart there: fit a law that has to the same recordings",
            pair.law.kind().name()
        ),
    )
}

/// k and n of the elastic part of a law k d^n.
fn elastic(law: &Law) -> Option<(f64, f64)> {
    if let Ok(found) = law.granular() {
        return Some((found.k, if found.hertzian { 1.5 } else { 1.0 }));
    }
    let description = law.kind().describe();
    let values = law.parameters();
    let known: Vec<_> = values.iter().copied().map(Some).collect();
    let exponent = description.elastic_exponent(&known)?;
    Some((values[description.index_of("k")?], exponent))
}

fn adams(pair: &Pair) -> Words {
    let Some((k, n)) = elastic(&pair.law) else {
        return nothing(pair);
    };
    let (c, depth, exact, approximate) = match (pair.law, pair.law.granular()) {
        (Law::AdamsImpact(own), _) => (own.c, own.d, true, String::new()),
        (Law::PowerLaw(own), _) if own.p == 0.0 || own.c == 0.0 => {
            (own.c, ABRUPT, true, String::new())
        }
        (_, Ok(own)) if own.damping == Damping::None => (0.0, ABRUPT, true, String::new()),
        (Law::KelvinVoigt(own), _) => (own.c, ABRUPT, true, String::new()),
        _ => {
            let depth = RAMP * depth_of(pair, k, n);
            let like = |c: f64| {
                let ramp = move |d: f64| {
                    let u = (d / depth).min(1.0);
                    u * u * (3.0 - 2.0 * u)
                };
                move |d: f64, v: f64| k * d.powf(n) + c * ramp(d) * v
            };
            let c = matched(pair, like);
            (c, depth, false, same_restitution(pair))
        }
    };
    let mm = 1000.0_f64;
    let given = format!(
        "IMPACT(GAP, GAP_RATE, 0.0, {}, {n}, {}, {})",
        k / mm.powf(n),
        c / mm,
        depth * mm
    );
    let size = sizes(pair);
    let exact = match exact {
        true => format!("the normal force, in mm, N and s{size}"),
        false => format!("the elastic force, in mm, N and s{size}"),
    };
    (
        given,
        exact,
        joined(&[approximate.as_str(), "friction is Adams's own"]),
    )
}

/// Penetration at which damping is whole where it is whole at once; m.
const ABRUPT: f64 = 1e-8;
/// The same where damping grows with the penetration, over the largest one; 1.
const RAMP: f64 = 0.5;

fn yade(pair: &Pair) -> Words {
    let [a, b] = pair.names.map(string_text);
    if let Law::KelvinVoigt(own) = pair.law {
        let share = pair.interaction.tangential_ratio;
        // Of two materials the coefficients are in series.
        let given = format!(
            "viscoelastic[({a}, {b})] = dict(kn={}, ks={}, cn={}, cs={}, frictionAngle={})",
            2.0 * own.k,
            2.0 * share * own.k,
            2.0 * own.c,
            2.0 * pair.interaction.tangential_damping * own.c,
            pair.interaction.friction.atan()
        );
        let exact = "the normal force: ViscElMat of both bodies with these numbers (in series \
                     they are the law's), Law2_ScGeom_ViscElPhys_Basic";
        return (given, exact.to_owned(), "rolling".to_owned());
    }
    let Some((modulus, e, exact, approximate)) = hertz(pair) else {
        return nothing(pair);
    };
    let nu = poisson(pair);
    let given = format!(
        "hertz[({a}, {b})] = dict(young={}, poisson={nu}, en={e}, frictionAngle={})",
        2.0 * modulus * (1.0 - nu * nu),
        pair.interaction.friction.atan()
    );
    let exact = format!(
        "{exact}: FrictMat of both bodies with this young, Ip2_FrictMat_FrictMat_MindlinPhys(en=…), \
         Law2_ScGeom_MindlinPhys_Mindlin"
    );
    (
        given,
        exact,
        joined(&[&approximate, "the walls' R* in Yade"]),
    )
}

fn mercury(pair: &Pair) -> Words {
    let of = format!(
        "{{ // {} and {}\n    auto s = speciesHandler.getMixedObject(SPECIES);\n",
        comment_text(pair.names[0]),
        comment_text(pair.names[1])
    );
    let friction = pair.interaction.friction;
    if let Law::KelvinVoigt(own) = pair.law {
        let given = format!(
            "{of}    s->setStiffness({});\n    s->setDissipation({});\n    \
             s->setSlidingStiffness({});\n    s->setSlidingFrictionCoefficient({friction});\n}}",
            own.k,
            own.c,
            pair.interaction.tangential_ratio * own.k
        );
        let exact = "the normal force, of LinearViscoelasticFrictionSpecies";
        return (given, exact.to_owned(), "rolling".to_owned());
    }
    let Some((modulus, e, exact, approximate)) = hertz(pair) else {
        return nothing(pair);
    };
    let given = format!(
        "{of}    s->setEffectiveElasticModulusAndRestitutionCoefficient({modulus}, {e});\n    \
         s->setEffectiveShearModulus({});\n    s->setSlidingFrictionCoefficient({friction});\n}}",
        // k_t/k_n = 8 G*/(2 E*).
        0.25 * pair.interaction.tangential_ratio * modulus
    );
    let exact = format!("{exact}, of HertzianViscoelasticMindlinSpecies");
    (given, exact, joined(&[&approximate, "rolling"]))
}

fn edem(pair: &Pair) -> Words {
    let Some((modulus, e, exact, approximate)) = hertz(pair) else {
        return nothing(pair);
    };
    let nu = poisson(pair);
    // Of two bodies of one material E = 2 E* (1 − ν²), G = E/(2 (1 + ν)).
    let shear = modulus * (1.0 - nu);
    let given = format!(
        "model\tHertz-Mindlin (no slip)\nPoisson's ratio of both\t{nu}\nshear modulus of both (Pa)\t{shear}\n\
         coefficient of restitution\t{e}\ncoefficient of static friction\t{}\n\
         coefficient of rolling friction\t{}",
        pair.interaction.friction, pair.interaction.rolling
    );
    let one = match pair.names[0] == pair.names[1] {
        true => "",
        false => {
            "a shear modulus of both bodies: EDEM keeps one for each material, not for each pair"
        }
    };
    (given, exact, joined(&[&approximate, one]))
}

fn chrono(pair: &Pair) -> Words {
    let Ok(law) = pair.law.granular() else {
        return nothing(pair);
    };
    let (size, mass) = (pair.radius, pair.mass);
    // With numbers of one's own a force of Hertz's contact is (kn d + gn m_eff v) R* √d.
    let (model, over) = match law.hertzian {
        true => ("Hertz", size),
        false => ("Hooke", 1.0),
    };
    let (damping, approximate) = match (law.hertzian, law.damping) {
        (_, Damping::None) => (0.0, String::new()),
        (true, Damping::Root(c)) | (false, Damping::Constant(c)) => (c, String::new()),
        _ => {
            let like = |c: f64| {
                let k = law.k;
                move |d: f64, v: f64| d.sqrt() * (k * d + c * v)
            };
            (matched(pair, like), same_restitution(pair))
        }
    };
    let (kn, gn) = (law.k / over, damping / (over * mass));
    let exact = if approximate.is_empty() {
        "the normal force"
    } else {
        "the elastic force"
    };
    let given = format!(
        "{{ // {} and {}: UseMaterialProperties(false), SetContactForceModel({model})\n    \
         auto m = chrono_types::make_shared<ChContactMaterialSMC>();\n    m->SetKn({kn});\n    m->SetGn({gn});\n    \
         m->SetKt({});\n    m->SetGt({});\n    m->SetFriction({});\n}}",
        comment_text(pair.names[0]),
        comment_text(pair.names[1]),
        pair.interaction.tangential_ratio * if law.hertzian { 1.5 } else { 1.0 } * kn,
        pair.interaction.tangential_damping * gn,
        pair.interaction.friction
    );
    let sizes = format!(
        "bodies of other sizes than R* {size} m and {mass} kg: k and c go as R* there, and as the mass"
    );
    (
        given,
        exact.to_owned(),
        joined(&[&approximate, &sizes, "rolling"]),
    )
}

/// E*, restitution, what is exact and what is not, in engines of Hertz's contact with a
/// constant restitution.
fn hertz(pair: &Pair) -> Option<(f64, f64, String, String)> {
    let (k, n) = elastic(&pair.law)?;
    if n != 1.5 {
        return None;
    }
    let modulus = 0.75 * k / pair.radius.sqrt();
    let found = pair.law.granular().map(|own| own.damping);
    let (e, exact, approximate) = match (pair.law, found) {
        (_, Ok(Damping::None)) => (1.0, "the normal force", String::new()),
        (Law::Tsuji(own), _) if (own.mass / pair.mass - 1.0).abs() < 0.01 => {
            (own.restitution, "the normal force", String::new())
        }
        _ => {
            let scale = (pair.mass * k).sqrt();
            let like = |e: f64| {
                let ratio = damping_ratio(1.0 - e);
                move |d: f64, v: f64| k * d.powf(1.5) + ratio * scale * d.powf(0.25) * v
            };
            let e = 1.0 - matched_up_to(pair, like, 0.999);
            (e, "the elastic force", same_restitution(pair))
        }
    };
    let size = sizes(pair);
    Some((modulus, e, format!("{exact}{size}"), approximate))
}

/// Damping ratio of a constant restitution.
fn damping_ratio(e: f64) -> f64 {
    let log = e.max(1e-12).ln();
    let pi = std::f64::consts::PI;
    -(5.0_f64.sqrt()) * log / (log * log + pi * pi).sqrt()
}

fn poisson(pair: &Pair) -> f64 {
    // From k_t/k_n = 2 (1 − ν)/(2 − ν).
    let ratio = pair.interaction.tangential_ratio;
    ((2.0 - 2.0 * ratio) / (2.0 - ratio)).clamp(0.0, 0.5)
}

fn sizes(pair: &Pair) -> &'static str {
    match pair.interaction.follows_radii() {
        true => "",
        false => " of bodies of the mean size",
    }
}

fn same_restitution(pair: &Pair) -> String {
    format!(
        "damping: the restitution {:.4} is the law's at {} m/s and {:.4} kg, at other speeds it is not",
        restitution(&|d, v| force(&pair.law, d, v), pair),
        pair.speed,
        pair.mass
    )
}

fn joined(parts: &[&str]) -> String {
    let parts: Vec<&str> = parts
        .iter()
        .copied()
        .filter(|own| !own.is_empty())
        .collect();
    match parts.is_empty() {
        true => "nothing".to_owned(),
        false => parts.join("; "),
    }
}

fn force(law: &Law, d: f64, v: f64) -> f64 {
    with_law!(law, own => own.evaluate(d, v, d).force)
}

/// Largest penetration of an elastic impact; m.
fn depth_of(pair: &Pair, k: f64, n: f64) -> f64 {
    ((n + 1.0) * pair.mass * pair.speed * pair.speed / (2.0 * k)).powf(1.0 / (n + 1.0))
}

/// The coefficient with which a force gives the restitution of the law.
fn matched<F: Fn(f64, f64) -> f64>(pair: &Pair, like: impl Fn(f64) -> F) -> f64 {
    // Up to where hardly anything comes back.
    let mut high = 1.0;
    while restitution(&like(high), pair) > 0.02 && high < 1e9 {
        high *= 4.0;
    }
    matched_up_to(pair, like, high)
}

fn matched_up_to<F: Fn(f64, f64) -> f64>(
    pair: &Pair,
    like: impl Fn(f64) -> F,
    highest: f64,
) -> f64 {
    let wanted = restitution(&|d, v| force(&pair.law, d, v), pair);
    let (mut low, mut high) = (0.0, highest);
    for _ in 0..50 {
        let middle = 0.5 * (low + high);
        match restitution(&like(middle), pair) > wanted {
            true => low = middle,
            false => high = middle,
        }
    }
    0.5 * (low + high)
}

/// Restitution of an impact that ends at zero force, by Runge and Kutta's method.
fn restitution(force: &dyn Fn(f64, f64) -> f64, pair: &Pair) -> f64 {
    let (mass, speed) = (pair.mass, pair.speed);
    let depth = elastic(&pair.law).map_or(1e-3, |(k, n)| depth_of(pair, k, n));
    let step = depth / speed / STEPS;
    let (mut d, mut v) = (0.0_f64, speed);
    let rate = |d: f64, v: f64| -force(d.max(0.0), v) / mass;
    for _ in 0..(100.0 * STEPS) as usize {
        let a = (v, rate(d, v));
        let b = (
            v + 0.5 * step * a.1,
            rate(d + 0.5 * step * a.0, v + 0.5 * step * a.1),
        );
        let c = (
            v + 0.5 * step * b.1,
            rate(d + 0.5 * step * b.0, v + 0.5 * step * b.1),
        );
        let e = (v + step * c.1, rate(d + step * c.0, v + step * c.1));
        d += step / 6.0 * (a.0 + 2.0 * b.0 + 2.0 * c.0 + e.0);
        v += step / 6.0 * (a.1 + 2.0 * b.1 + 2.0 * c.1 + e.1);
        if v < 0.0 && (d <= 0.0 || force(d, v) <= 0.0) {
            break;
        }
    }
    (-v / speed).max(0.0)
}

/// Steps in the time in which an impact would cross its depth.
const STEPS: f64 = 1000.0;

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;
    use windfall_contact::expression::parse_law;
    use windfall_scene::scene::Fruit;

    fn scene(law: &str) -> Scene {
        let law = parse_law(law).unwrap().complete().unwrap();
        let mut fruit = Fruit::sphere(0, 0.04, 840.0, [0.0; 3]);
        fruit.mass = 0.2;
        Scene {
            materials: vec!["apple".into(), "steel".into()],
            interactions: BTreeMap::from([((0, 1), Interaction::frictionless(law))]),
            fruit: vec![fruit],
            ..Scene::default()
        }
    }

    fn given(other: Other, law: &str) -> ContactTerms {
        contact_terms(other, &scene(law), 0.5).remove(0)
    }

    fn numbers(text: &str) -> Vec<f64> {
        let parts = text.split([',', '(', ')', ' ', '=', ';', '\t', '\n']);
        parts.filter_map(|own| own.parse().ok()).collect()
    }

    /// Names that would end a comment or a text, or draw the next line into one.
    #[test]
    fn rejects_names_that_would_be_code() {
        let hostile = [
            "a\\",
            "a??/",
            "a &",
            "a */ system(0); /*",
            "a\"); import os; (\"",
            "a', 'b",
            "a\u{2028}b",
            "\u{200b}quince",
            "a\\\"",
            "🍎\"\\",
        ];
        for other in [
            Other::Adams,
            Other::Yade,
            Other::MercuryDpm,
            Other::Edem,
            Other::Chrono,
        ] {
            let text = |name: &str| {
                let mut scene = scene("kuwabara-kono(k=753599, c=1524)");
                scene.materials[0] = name.to_owned();
                text_of_terms(other, name, &contact_terms(other, &scene, 0.5))
            };
            let plain = text("apple");
            for name in hostile {
                let text = text(name);
                assert_eq!(text.lines().count(), plain.lines().count(), "{text}");
                for (line, wanted) in text.lines().zip(plain.lines()) {
                    let drawn_on = line.ends_with(['\\', '&']) || line.contains("??/");
                    assert!(other == Other::Yade || !drawn_on, "{line}");
                    // The same commands stand before and behind the name.
                    let literal = windfall_files::text::quote::string_text(name);
                    let back = line.replace(&literal, "\"apple\"");
                    let back = back.replace(&comment_text(name), "apple");
                    assert_eq!(back, wanted, "{other:?} {name:?}");
                }
            }
        }
    }

    #[test]
    fn closed_form_units_of_adams() {
        // 0.868 N/mm^1.91 is 466143.5992 N/m^1.91 (DOMAIN.md, section 1.2).
        let law = "adams-impact(k=466143.5992, e=1.91, c=500, d=0.0001)";
        let own = given(Other::Adams, law);
        let numbers = numbers(&own.given);
        for (found, wanted) in numbers.iter().zip([0.0, 0.868, 1.91, 0.5, 0.1]) {
            assert!((found - wanted).abs() < 1e-9, "{}", own.given);
        }
        assert!(own.exact.contains("normal force"));
    }

    #[test]
    fn reference_restitution_of_kuwabara_kono() {
        // DOMAIN.md, section 1.4: e 0.4781431291 of this impact.
        let own = given(Other::Edem, "kuwabara-kono(k=753599, c=1524)");
        assert!(own.approximate.contains("0.4781"), "{}", own.approximate);
        // What EDEM is given delivers it: Tsuji's law with that coefficient.
        let e = own
            .given
            .lines()
            .find(|line| line.contains("restitution"))
            .unwrap();
        let e = numbers(e)[0];
        let tsuji = format!("tsuji(k=753599, restitution={e}, mass=0.2)");
        let back = given(Other::Adams, &tsuji);
        assert!(back.approximate.contains("0.4781"), "{}", back.approximate);
    }

    #[test]
    fn closed_form_numbers_of_chrono_are_kuwabara_kono() {
        let own = given(Other::Chrono, "kuwabara-kono(k=753599, c=1524)");
        let numbers: Vec<f64> = own
            .given
            .lines()
            .filter(|line| line.contains("n("))
            .flat_map(numbers)
            .collect();
        assert!(
            (numbers[0] * 0.04 - 753_599.0).abs() < 1e-6,
            "{}",
            own.given
        );
        assert!(
            (numbers[1] * 0.04 * 0.2 - 1524.0).abs() < 1e-6,
            "{}",
            own.given
        );
    }

    #[test]
    fn rejects_laws_without_counterpart() {
        let law = "power-law(k=466143.6, n=1.91, c=100, p=0)";
        for other in [Other::Yade, Other::MercuryDpm, Other::Edem, Other::Chrono] {
            let own = given(other, law);
            assert!(own.given.is_empty() && own.approximate.contains("no counterpart"));
        }
        assert!(given(Other::Adams, law).exact.contains("normal force"));
    }
}
