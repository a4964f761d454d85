//! Pages of a Parquet column, unpacked here and not by the crate `parquet`.
//!
//! The crate unpacks a page to whatever size it says, and gzip to whatever it gives. So the crate is
//! told that nothing is packed, and its pages are unpacked on the way, all of a file to no
//! more than [`MAX_FILE_BYTES`]. What the crate takes on trust in a page is checked here too.

use std::io::Read;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use bytes::Bytes;
use flate2::read::MultiGzDecoder;
use parquet::basic::{CompressionCodec, Encoding, Type};
use parquet::column::page::{Page, PageMetadata, PageReader};
use parquet::errors::ParquetError;
use parquet::file::serialized_reader::SerializedPageReader;
use ruzstd::decoding::StreamingDecoder;

use crate::MAX_FILE_BYTES;

/// Snappy repeats at most 64 bytes with 3.
const MOST_OF_SNAPPY: usize = 32;

type Result<T> = std::result::Result<T, ParquetError>;

/// Whether pages packed so can be unpacked.
pub(crate) fn is_known(codec: CompressionCodec) -> bool {
    use CompressionCodec::{GZIP, SNAPPY, UNCOMPRESSED, ZSTD};
    matches!(codec, UNCOMPRESSED | SNAPPY | GZIP | ZSTD)
}

/// Bytes unpacked so far, of all columns of a file.
#[derive(Debug, Clone, Default)]
pub(crate) struct Unpacked(Arc<AtomicU64>);

impl Unpacked {
    pub(crate) fn is_too_much(&self) -> bool {
        self.0.load(Ordering::Relaxed) > MAX_FILE_BYTES
    }

    fn left(&self) -> u64 {
        MAX_FILE_BYTES.saturating_sub(self.0.load(Ordering::Relaxed))
    }

    fn add(&self, bytes: u64) -> Result<()> {
        self.0.fetch_add(bytes, Ordering::Relaxed);
        if self.is_too_much() {
            return fault("more bytes than are unpacked");
        }
        Ok(())
    }
}

/// The pages of a column chunk, unpacked.
pub(crate) struct Pages {
    /// Reads the pages as they stand in the file.
    pub(crate) packed: SerializedPageReader<Bytes>,
    pub(crate) codec: CompressionCodec,
    pub(crate) kind: Type,
    /// Whether pages say which values are missing.
    pub(crate) leveled: bool,
    pub(crate) unpacked: Unpacked,
    /// Whether a dictionary came already.
    pub(crate) dictionary: bool,
}

impl Pages {
    fn unpack(&mut self, page: &mut Page) -> Result<()> {
        let by_dictionary = [Encoding::RLE_DICTIONARY, Encoding::PLAIN_DICTIONARY];
        if page.is_dictionary_page() {
            self.dictionary = true;
        } else if !self.dictionary && by_dictionary.contains(&page.encoding()) {
            return fault("a page whose dictionary is missing");
        }
        match page {
            Page::DataPage {
                buf,
                def_level_encoding,
                ..
            } => {
                *buf = unpacked_from(self.codec, buf, 0, &self.unpacked)?;
                // Other lengths than that of RLE are not checked by the crate.
                if self.leveled && *def_level_encoding != Encoding::RLE {
                    return fault("missing values marked in a form that is out of use");
                }
            }
            Page::DataPageV2 {
                buf,
                def_levels_byte_len,
                rep_levels_byte_len,
                is_compressed,
                ..
            } => {
                let levels = u64::from(*def_levels_byte_len) + u64::from(*rep_levels_byte_len);
                if levels > buf.len() as u64 {
                    return fault("a page shorter than its levels");
                }
                if *is_compressed {
                    *buf = unpacked_from(self.codec, buf, levels as usize, &self.unpacked)?;
                }
            }
            Page::DictionaryPage {
                buf, num_values, ..
            } => {
                *buf = unpacked_from(self.codec, buf, 0, &self.unpacked)?;
                // The crate makes room for as many.
                if u64::from(*num_values) * width(self.kind) > buf.len() as u64 {
                    return fault("a dictionary shorter than it says");
                }
            }
        }
        Ok(())
    }
}

/// The bytes before `start` as they are, those after it unpacked.
fn unpacked_from(
    codec: CompressionCodec,
    bytes: &Bytes,
    start: usize,
    unpacked: &Unpacked,
) -> Result<Bytes> {
    let (kept, packed) = bytes.split_at(start);
    if codec == CompressionCodec::UNCOMPRESSED || packed.is_empty() {
        return Ok(bytes.clone());
    }
    let mut all = kept.to_vec();
    let most = unpacked.left();
    let count = match codec {
        CompressionCodec::SNAPPY => unpack_snappy(packed, most, &mut all)?,
        CompressionCodec::GZIP => read_most(MultiGzDecoder::new(packed), most, &mut all)?,
        CompressionCodec::ZSTD => {
            let decoder = StreamingDecoder::new(packed).map_err(external)?;
            read_most(decoder, most, &mut all)?
        }
        _ => return fault("a compression that is not read"),
    };
    unpacked.add(count)?;
    Ok(all.into())
}

/// Unpacks nothing beyond the limit, which then is told by the count.
fn unpack_snappy(packed: &[u8], most: u64, all: &mut Vec<u8>) -> Result<u64> {
    let claimed = snap::raw::decompress_len(packed).map_err(external)?;
    if claimed / MOST_OF_SNAPPY > packed.len() {
        return fault("a page that claims more than its bytes can hold");
    }
    if claimed as u64 > most {
        return Ok(most + 1);
    }
    let start = all.len();
    all.resize(start + claimed, 0);
    let mut decoder = snap::raw::Decoder::new();
    let count = decoder.decompress(packed, &mut all[start..]);
    Ok(count.map_err(external)? as u64)
}

/// Bytes of a value in a dictionary.
fn width(kind: Type) -> u64 {
    match kind {
        Type::INT32 | Type::FLOAT => 4,
        Type::INT64 | Type::DOUBLE => 8,
        Type::INT96 => 12,
        _ => 1,
    }
}

/// Reads no more than one byte beyond the limit, which then is told by the count.
fn read_most(packed: impl Read, most: u64, all: &mut Vec<u8>) -> Result<u64> {
    let count = packed.take(most + 1).read_to_end(all).map_err(external)?;
    Ok(count as u64)
}

fn external(error: impl std::error::Error + Send + Sync + 'static) -> ParquetError {
    ParquetError::General(error.to_string())
}

fn fault<T>(text: &str) -> Result<T> {
    Err(ParquetError::General(text.to_owned()))
}

impl Iterator for Pages {
    type Item = Result<Page>;

    fn next(&mut self) -> Option<Result<Page>> {
        self.get_next_page().transpose()
    }
}

impl PageReader for Pages {
    fn get_next_page(&mut self) -> Result<Option<Page>> {
        let mut page = self.packed.get_next_page()?;
        if let Some(page) = &mut page {
            self.unpack(page)?;
        }
        Ok(page)
    }

    fn peek_next_page(&mut self) -> Result<Option<PageMetadata>> {
        self.packed.peek_next_page()
    }

    fn skip_next_page(&mut self) -> Result<()> {
        self.packed.skip_next_page()
    }
}

#[cfg(test)]
mod tests {
    use std::io::Write as _;

    use super::*;

    const LENGTH: usize = 1 << 20;

    fn packed(codec: CompressionCodec) -> Bytes {
        use ruzstd::encoding::{CompressionLevel, compress_to_vec};
        let zeros = vec![0; LENGTH];
        let packed = match codec {
            CompressionCodec::GZIP => {
                let mut packer =
                    flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::best());
                packer
                    .write_all(&zeros)
                    .and_then(|()| packer.finish())
                    .unwrap_or_default()
            }
            CompressionCodec::ZSTD => compress_to_vec(&zeros[..], CompressionLevel::Fastest),
            _ => snap::raw::Encoder::new()
                .compress_vec(&zeros)
                .unwrap_or_default(),
        };
        Bytes::from([b"levels".to_vec(), packed].concat())
    }

    #[test]
    fn verify_pages_are_unpacked_up_to_the_limit() {
        use CompressionCodec::{GZIP, SNAPPY, ZSTD};
        for codec in [GZIP, SNAPPY, ZSTD] {
            let page = packed(codec);
            assert!((7..LENGTH / 8).contains(&page.len()), "{codec:?}");
            let so_far = MAX_FILE_BYTES - 2 * LENGTH as u64;
            let unpacked = Unpacked(Arc::new(AtomicU64::new(so_far)));
            for _ in 0..2 {
                let whole = unpacked_from(codec, &page, 6, &unpacked).unwrap_or_default();
                assert_eq!(whole.len(), 6 + LENGTH, "{codec:?}");
                assert!(whole.starts_with(b"levels\0") && !unpacked.is_too_much());
            }
            assert!(unpacked_from(codec, &page, 6, &unpacked).is_err());
            assert!(unpacked.is_too_much(), "{codec:?}");
        }
    }

    #[test]
    fn verify_a_claim_of_snappy_is_not_believed() {
        // 2^29 bytes in six.
        let page = Bytes::from(vec![0x80, 0x80, 0x80, 0x80, 0x02, 0x00]);
        let said = unpacked_from(CompressionCodec::SNAPPY, &page, 0, &Unpacked::default());
        let said = said.map_err(|error| error.to_string());
        assert_eq!(
            said.err().as_deref(),
            Some("Parquet error: a page that claims more than its bytes can hold")
        );
    }
}
