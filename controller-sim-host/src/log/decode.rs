//! The text of a log from its bytes.

/// The text in `bytes`: UTF-8, UTF-16 with its mark as spreadsheets save it, else Latin 1, in which old loggers write the
/// signs of their units.
///
/// ```
/// use controller_sim_host::log::decode;
/// assert_eq!(decode(b"T [\xb0C]"), "T [\u{b0}C]");
/// assert_eq!(decode(b"\xff\xfea\0,\0"), "a,");
/// ```
#[must_use]
pub fn decode(bytes: &[u8]) -> String {
    let wide = |order: fn([u8; 2]) -> u16| -> String {
        let units = bytes[2..].chunks_exact(2).map(|pair| order([pair[0], pair[1]]));
        char::decode_utf16(units).map(|c| c.unwrap_or(char::REPLACEMENT_CHARACTER)).collect()
    };
    match (bytes, std::str::from_utf8(bytes)) {
        ([0xff, 0xfe, ..], _) => wide(u16::from_le_bytes),
        ([0xfe, 0xff, ..], _) => wide(u16::from_be_bytes),
        (_, Ok(text)) => text.to_owned(),
        _ => bytes.iter().map(|byte| char::from(*byte)).collect(),
    }
}
