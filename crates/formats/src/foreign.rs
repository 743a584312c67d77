//! Files that windfall does not read, by their first bytes: what they are, and the way to a
//! format that it reads.
//!
//! # Source
//! The formats' own documents: ASAM MDF, RFC 9639 (FLAC), AIFF 1.3, Apache Parquet, Unidata
//! netCDF classic, LeCroy template LECROY_2_3, Tektronix 077-0220 (.wfm), SoMat
//! SIE, imc2 (FAMOS); for the rest PRONOM of the National Archives (UK).

use windfall_source::error::Error;
use windfall_source::source::Source;

/// Bytes at the end of an archive in which the names of its members stand.
const DIRECTORY: u64 = 1 << 16;

/// First byte of the signature, signature, what the file is, and what to do.
type Signature = (usize, &'static [u8], &'static str, &'static str);

const UNPACK: &str = "unpack it first";
const NOT_DATA: &str = "name the recording itself";
const TO_SCOPE_CSV: &str = "save the waveform as CSV on the oscilloscope";
const TO_WAV: &str = "convert it to WAV, for example: ffmpeg -i FILE recording.wav";
const LOSSY: &str = "compressed sound has lost what a fit needs; record as WAV";
const FROM_OLD_OFFICE: &str = "save it as .xlsx, or save the sheet with the samples as CSV";
const FROM_MDF: &str = "convert it with asammdf (free; in Python: asammdf.MDF(\"FILE\")\
                        .export(\"csv\", \"recording.csv\", add_units=True), which writes a file for \
                        each group of channels), or export it as MAT or CSV in the program that \
                        recorded it";
const FROM_PARQUET: &str = "save it as CSV, in Python: \
                            pandas.read_parquet(\"FILE\").to_csv(\"recording.csv\", index=False)";

/// Signatures; a longer one stands before its beginning.
const SIGNATURES: &[Signature] = &[
    (0, b"MDF     4", "an MDF 4 measurement (.mf4)", FROM_MDF),
    (0, b"MDF     ", "an MDF measurement (.mdf, .dat)", FROM_MDF),
    (
        0,
        b"UnFinMF ",
        "an MDF measurement that was not finished",
        FROM_MDF,
    ),
    (0, b"fLaC", "a FLAC sound", TO_WAV),
    (8, b"AIFF", "an AIFF sound", TO_WAV),
    (8, b"AIFC", "an AIFF-C sound", TO_WAV),
    (0, b"caff", "a Core Audio sound (.caf)", TO_WAV),
    (0, b"riff\x2e\x91\xcf\x11", "a Wave64 sound (.w64)", TO_WAV),
    (0, b".snd", "a Sun sound (.au)", TO_WAV),
    (0, b"ID3\x03", "an MP3 sound", LOSSY),
    (0, b"ID3\x04", "an MP3 sound", LOSSY),
    (0, b"\xff\xfb", "an MP3 sound", LOSSY),
    (0, b"\xff\xfa", "an MP3 sound", LOSSY),
    (0, b"\xff\xf3", "an MP3 sound", LOSSY),
    (0, b"\xff\xf2", "an MP3 sound", LOSSY),
    (0, b"OggS", "an Ogg sound", LOSSY),
    (
        8,
        b"AVI LIST",
        "a film (.avi)",
        "extract its sound: ffmpeg -i FILE recording.wav",
    ),
    (4, b"ftyp", "a film or sound (.mp4, .m4a, .mov)", LOSSY),
    (
        0,
        b"|CF,",
        "an imc FAMOS file (.raw, .dat)",
        "export it as CSV or MAT with imc FAMOS or imc STUDIO",
    ),
    (2, b":WFM#", "a Tektronix waveform (.wfm)", TO_SCOPE_CSV),
    (0, b":WFMP", "a Tektronix waveform (.isf)", TO_SCOPE_CSV),
    (
        0,
        b"\xa5\xa5\x00\x00",
        "a Rigol waveform (.wfm)",
        TO_SCOPE_CSV,
    ),
    (
        0,
        b"\xa5\xa5\x38\x00",
        "a Rigol waveform (.wfm)",
        TO_SCOPE_CSV,
    ),
    (
        0,
        b"\x1aE\xdf\xa3",
        "an EBML file, such as an enDAQ recording (.ide)",
        "export the channels as CSV or MAT with the software of the recorder",
    ),
    (0, b"PAR1", "a Parquet table", FROM_PARQUET),
    (
        0,
        b"ARROW1",
        "an Arrow table (.feather)",
        "save it as CSV, in Python: \
      pandas.read_feather(\"FILE\").to_csv(\"recording.csv\", index=False)",
    ),
    (
        0,
        b"CDF\x01",
        "a classic netCDF file",
        "convert it to netCDF-4, which is HDF5: nccopy -k nc4 FILE recording.nc",
    ),
    (
        0,
        b"CDF\x02",
        "a classic netCDF file",
        "convert it to netCDF-4, which is HDF5: nccopy -k nc4 FILE recording.nc",
    ),
    (0, b"SQLite format 3", "a database", NOT_DATA),
    (0, b"\x1f\x8b", "a gzip archive", "unpack it (gunzip)"),
    (0, b"BZh", "a bzip2 archive", UNPACK),
    (0, b"\xfd7zXZ", "an xz archive", UNPACK),
    (0, b"\x28\xb5\x2f\xfd", "a zstd archive", UNPACK),
    (0, b"7z\xbc\xaf\x27\x1c", "a 7z archive", UNPACK),
    (0, b"Rar!\x1a\x07", "a RAR archive", UNPACK),
    (
        0,
        b"\xd0\xcf\x11\xe0",
        "an old or encrypted Office file (.xls)",
        FROM_OLD_OFFICE,
    ),
    (0, b"%PDF", "a PDF", NOT_DATA),
    (0, b"\x89PNG", "a picture", NOT_DATA),
    (0, b"\xff\xd8\xff", "a picture", NOT_DATA),
    (0, b"GIF8", "a picture", NOT_DATA),
    (0, b"II*\x00", "a picture", NOT_DATA),
    (0, b"MM\x00*", "a picture", NOT_DATA),
];

/// Signatures that may stand anywhere in the first bytes behind another: beginning, words.
const WORDS: &[(&[u8], &[u8], &str, &str)] = &[
    (b"", b"WAVEDESC", "a LeCroy waveform (.trc)", TO_SCOPE_CSV),
    (
        b"<?xml",
        b"usi:tdm",
        "a TDM file",
        "save it as TDMS in DIAdem or LabVIEW",
    ),
    (
        b"<?xml",
        b"<SIE",
        "a SoMat SIE file",
        "export it as ASCII or UFF58 with the software of the recorder",
    ),
    (b"<?xml", b"", "an XML file", NOT_DATA),
    (
        b"<",
        b"<html",
        "a web page",
        "download the recording itself",
    ),
];

/// Members of archives that are documents.
const MEMBERS: &[(&[u8], &str, &str)] = &[
    (
        b"xl/workbook.bin",
        "a binary Excel workbook (.xlsb)",
        "save it as .xlsx, or save the sheet with the samples as CSV",
    ),
    (b"word/document.xml", "a Word document", NOT_DATA),
    (b"ppt/presentation.xml", "a presentation", NOT_DATA),
    (b"opendocument.text", "an OpenDocument file", NOT_DATA),
    (
        b"opendocument.presentation",
        "an OpenDocument file",
        NOT_DATA,
    ),
    (b"opendocument.graphics", "an OpenDocument file", NOT_DATA),
];

/// Refuses what is known and not read.
///
/// * `head`: the first bytes
///
/// # Errors
/// It is; or the file cannot be read.
pub fn refuse_foreign(source: &Source, head: &[u8]) -> Result<(), Error> {
    let begins = |(at, signature, ..): &&Signature| {
        head.get(*at..)
            .is_some_and(|rest| rest.starts_with(signature))
    };
    let first = SIGNATURES.iter().find(begins);
    let mut found = first.map(|(_, _, what, advice)| (*what, *advice));
    let has = |bytes: &[u8], word: &[u8]| memchr::memmem::find(bytes, word).is_some();
    if found.is_none() {
        let lower = head.to_ascii_lowercase();
        let words = WORDS.iter().find(|(begin, word, ..)| {
            head.starts_with(begin) && (has(head, word) || has(&lower, word))
        });
        found = words.map(|(_, _, what, advice)| (*what, *advice));
    }
    if head.starts_with(b"PK\x03\x04") {
        let start = source.length().saturating_sub(DIRECTORY);
        let tail = source.bytes_at(start, source.length() - start)?;
        let member = MEMBERS
            .iter()
            .find(|(name, ..)| has(&tail, name) || has(head, name));
        found = member.map(|(_, what, advice)| (*what, *advice));
    }
    match found {
        Some((what, advice)) => Err(source.unknown(
            format!("this is {what}, which windfall does not read"),
            advice,
        )),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::open::tell_format;

    fn message(bytes: &[u8]) -> String {
        let source = Source::from_bytes("f", bytes.to_vec());
        tell_format(&source).unwrap_err().to_string()
    }

    #[test]
    fn rejects_every_signature_with_its_name_and_a_way_out() {
        for (at, signature, what, advice) in SIGNATURES {
            let mut bytes = vec![b'R'; *at];
            bytes.extend_from_slice(signature);
            bytes.extend([0; 64]);
            let told = message(&bytes);
            let expected = format!("f: this is {what}, which windfall does not read; {advice}");
            assert_eq!(told, expected, "{signature:?}");
        }
        for (begin, word, what, _) in WORDS {
            let mut bytes = begin.to_vec();
            bytes.extend(b" #9000012345");
            bytes.extend_from_slice(word);
            assert!(message(&bytes).contains(what), "{}", message(&bytes));
        }
    }

    #[test]
    fn closed_form_tables_and_recordings_are_not_foreign() {
        for text in [
            &b"MDF;1\n2;3\n"[..],
            b"ID;3\n1;2\n",
            b"t,F\n0,1\n",
            b"<t>,F\n0,1\n",
        ] {
            let source = Source::from_bytes("f", text.to_vec());
            assert!(tell_format(&source).is_ok(), "{text:?}");
        }
    }
}
