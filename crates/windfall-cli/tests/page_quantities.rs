//! The page's list of quantities is made from their declaration.
//! `WINDFALL_PAGE=write cargo test -p windfall-cli page_quantities` writes it anew.

#![allow(clippy::unwrap_used)]

use std::path::Path;
use windfall_campaign::result::quantity::QUANTITIES;

#[test]
fn reference_the_page_names_quantities_as_they_are_declared() {
    let path = "../windfall-web/page/src/lib/quantities.ts";
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(path);
    let mut expected = "\
/** Names, symbols and units of what an impact gives.
 *  Generated from crates/campaign/src/result/quantity.rs: do not edit. */

export interface Meaning {
  label: string;
  symbol: string;
  unit: string;
}

export const DERIVED: Record<string, Meaning> = {
"
    .to_owned();
    for quantity in &QUANTITIES {
        expected += &format!(
            "  {}: {{ label: {:?}, symbol: {:?}, unit: {:?} }},\n",
            quantity.name, quantity.label, quantity.symbol, quantity.unit
        );
    }
    expected += "};\n";
    if std::env::var("WINDFALL_PAGE").is_ok_and(|word| word == "write") {
        std::fs::write(&path, &expected).unwrap();
    }
    let found = std::fs::read_to_string(&path).unwrap();
    assert!(
        found == expected,
        "quantities.ts is stale: run this test with WINDFALL_PAGE=write, then scripts/test-page --update"
    );
}
