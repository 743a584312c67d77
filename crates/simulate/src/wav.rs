//! WAV files of one channel, 16-bit PCM.

/// Full scale of the samples.
const FULL_SCALE: f64 = 32_767.0;

/// The bytes of a WAV file.
///
/// * `samples`: from −1 to 1; beyond that they are clipped
/// * `rate`: sampling rate; Hz
///
/// # Source
/// IBM and Microsoft (1991), Multimedia Programming Interface and Data
/// Specifications 1.0, "Waveform Audio File Format".
pub fn wav_bytes(samples: &[f64], rate: u32) -> Vec<u8> {
    let data = 2 * samples.len() as u32;
    let mut bytes = Vec::with_capacity(44 + data as usize);
    bytes.extend(b"RIFF");
    bytes.extend((36 + data).to_le_bytes());
    bytes.extend(b"WAVEfmt ");
    // Length of this part, PCM, one channel.
    bytes.extend(16_u32.to_le_bytes());
    bytes.extend(1_u16.to_le_bytes());
    bytes.extend(1_u16.to_le_bytes());
    bytes.extend(rate.to_le_bytes());
    bytes.extend((2 * rate).to_le_bytes());
    // Bytes and bits of a sample.
    bytes.extend(2_u16.to_le_bytes());
    bytes.extend(16_u16.to_le_bytes());
    bytes.extend(b"data");
    bytes.extend(data.to_le_bytes());
    for sample in samples {
        let value = (sample.clamp(-1.0, 1.0) * FULL_SCALE).round() as i16;
        bytes.extend(value.to_le_bytes());
    }
    bytes
}
