//! What an image writes: text, or a defmt stream that becomes text here.

use defmt_decoder::{DecodeError, Locations, Table};
use std::io::Write;

/// The names and formats that defmt left in the image; nothing if it does not log.
pub(crate) struct Log(Option<(Table, Option<Locations>)>);

impl Log {
    /// Of an image.
    ///
    /// # Errors
    /// When the image logs in a format that this decoder does not know.
    pub(crate) fn of(elf: &[u8]) -> anyhow::Result<Self> {
        let Some(table) = Table::parse(elf)?.filter(|table| !table.is_empty()) else {
            return Ok(Self(None));
        };
        let locations = table
            .get_locations(elf)
            .ok()
            .filter(|locations| table.indices().all(|i| locations.contains_key(&(i as u64))));
        Ok(Self(Some((table, locations))))
    }

    /// Copies `from` to `to`, decoded if there is something to decode, until `from` ends.
    ///
    /// # Errors
    /// When reading or writing fails; when the stream makes no sense.
    pub(crate) fn copy(&self, mut from: impl std::io::Read, mut to: impl Write) -> anyhow::Result<()> {
        let Some((table, locations)) = &self.0 else {
            std::io::copy(&mut from, &mut to)?;
            return Ok(());
        };
        let mut decoder = table.new_stream_decoder();
        let mut bytes = [0; 4096];
        loop {
            let count = from.read(&mut bytes)?;
            if count == 0 {
                return Ok(());
            }
            decoder.received(&bytes[..count]);
            loop {
                let frame = match decoder.decode() {
                    Ok(frame) => frame,
                    Err(DecodeError::UnexpectedEof) => break,
                    Err(DecodeError::Malformed) => anyhow::bail!("its log cannot be decoded"),
                };
                let level = frame.level().map_or("", |level| level.as_str());
                let time = frame.display_timestamp().map(|time| format!("{time} ")).unwrap_or_default();
                let place = locations.as_ref().and_then(|places| places.get(&frame.index()));
                let place = place.map(|place| format!(" ({})", place.module)).unwrap_or_default();
                writeln!(to, "{time}{:5} {}{place}", level.to_uppercase(), frame.display_message())?;
            }
        }
    }
}
