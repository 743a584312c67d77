//! The part of the font that the text of a PDF needs.

use crate::png::FONT;
use pdf_writer::types::{CidFontType, FontFlags, SystemInfo, UnicodeCmap};
use pdf_writer::{Filter, Finish, Name, Pdf, Rect, Ref, Str};
use skrifa::instance::{LocationRef, Size};
use skrifa::{FontRef, GlyphId, MetadataProvider};
use std::collections::BTreeMap;
use subsetter::GlyphRemapper;

/// A name with the six letters that mark a part of a font.
const NAME: Name = Name(b"WINDFA+LiberationSans");

/// Names of the objects of the file that a font consists of.
pub struct FontRefs {
    pub font: Ref,
    pub descendant: Ref,
    pub descriptor: Ref,
    pub file: Ref,
    pub letters: Ref,
}

/// Glyphs of a text, numbered anew, with the letters that they stand for.
#[derive(Default)]
pub struct Glyphs {
    numbers: GlyphRemapper,
    letters: BTreeMap<u16, String>,
}

impl Glyphs {
    /// The number of a glyph in the part of the font.
    pub fn number(&mut self, glyph: u16, letters: &str) -> u16 {
        let number = self.numbers.remap(glyph);
        self.letters
            .entry(number)
            .or_insert_with(|| letters.to_owned());
        number
    }

    /// Writes the part of the font into the file.
    ///
    /// # Errors
    /// The font cannot be read; in words.
    pub fn write(&self, pdf: &mut Pdf, refs: &FontRefs) -> Result<(), String> {
        let font = FontRef::new(FONT).map_err(|error| error.to_string())?;
        let part = subsetter::subset(FONT, 0, &self.numbers).map_err(|error| error.to_string())?;
        let metrics = font.metrics(Size::unscaled(), LocationRef::default());
        let widths = font.glyph_metrics(Size::unscaled(), LocationRef::default());
        let scale = 1e3 / f32::from(metrics.units_per_em);
        let system = SystemInfo {
            registry: Str(b"Adobe"),
            ordering: Str(b"Identity"),
            supplement: 0,
        };

        pdf.type0_font(refs.font)
            .base_font(NAME)
            .encoding_predefined(Name(b"Identity-H"))
            .descendant_font(refs.descendant)
            .to_unicode(refs.letters);
        let mut descendant = pdf.cid_font(refs.descendant);
        descendant
            .subtype(CidFontType::Type2)
            .base_font(NAME)
            .system_info(system)
            .font_descriptor(refs.descriptor)
            .default_width(0.0)
            .cid_to_gid_map_predefined(Name(b"Identity"));
        let advance = |glyph| widths.advance_width(GlyphId::from(glyph)).unwrap_or(0.0) * scale;
        let advances = self.numbers.remapped_gids().map(advance);
        descendant.widths().consecutive(0, advances);
        descendant.finish();

        let bounds = metrics.bounds.unwrap_or_default();
        pdf.font_descriptor(refs.descriptor)
            .name(NAME)
            .flags(FontFlags::NON_SYMBOLIC)
            .bbox(Rect::new(
                bounds.x_min * scale,
                bounds.y_min * scale,
                bounds.x_max * scale,
                bounds.y_max * scale,
            ))
            .italic_angle(0.0)
            .ascent(metrics.ascent * scale)
            .descent(metrics.descent * scale)
            .cap_height(metrics.cap_height.unwrap_or(metrics.ascent) * scale)
            .stem_v(80.0)
            .font_file2(refs.file);
        let packed = super::packed::packed(&part);
        let mut file = pdf.stream(refs.file, &packed);
        file.filter(Filter::FlateDecode).pair(
            Name(b"Length1"),
            i32::try_from(part.len()).unwrap_or(i32::MAX),
        );
        file.finish();

        let mut letters = UnicodeCmap::new(Name(b"Letters"), system);
        for (number, own) in &self.letters {
            letters.pair_with_multiple(*number, own.chars());
        }
        pdf.cmap(refs.letters, &letters.finish());
        Ok(())
    }
}
