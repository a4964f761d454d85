//! What a ZIP archive unpacks to, before a reader of another crate unpacks it.
//!
//! Deflate makes a thousand bytes of one, and the sizes in an archive are claims. So every entry is
//! unpacked once, into nothing, up to the limit.

use std::io::Read as _;

use flate2::read::DeflateDecoder;

use crate::MAX_FILE_BYTES;
use crate::bytes::Bytes;
use crate::faults::FormatFault;

/// First bytes of an entry, of a line of the directory and of the end of the directory.
const ENTRY: &[u8] = b"PK\x03\x04";
const LISTED: &[u8] = b"PK\x01\x02";
const END: &[u8] = b"PK\x05\x06";
/// The end of the directory, with its longest comment.
const END_BYTES: usize = 22 + (1 << 16);
/// Entries that are looked at.
const MOST_ENTRIES: usize = 10_000;
const DEFLATED: u16 = 8;

/// Refuses an archive that unpacks to more than is read.
pub(crate) fn check(bytes: &[u8]) -> Result<(), FormatFault> {
    let tail = bytes.len().saturating_sub(END_BYTES);
    let end = bytes[tail..].windows(4).rposition(|window| window == END);
    let end = end.ok_or_else(|| damaged("it has no directory"))? + tail;
    let mut head = Bytes::new(&bytes[end..], end as u64, false);
    head.take(16, "the end of the directory")?;
    let start = usize::try_from(head.u32("the end of the directory")?).unwrap_or(usize::MAX);
    let listed = bytes
        .get(start..end)
        .ok_or_else(|| damaged("its directory lies beyond it"))?;
    let mut directory = Bytes::new(listed, start as u64, false);
    let (mut unpacked, mut entries) = (0_u64, 0);
    while directory.left() >= 46 {
        const WHAT: &str = "the directory of the archive";
        if directory.take(4, WHAT)? != LISTED {
            break;
        }
        entries += 1;
        if entries > MOST_ENTRIES {
            return Err(FormatFault::TooMuch {
                most: MOST_ENTRIES as u64,
                what: "entries of an archive",
            });
        }
        directory.take(6, WHAT)?;
        let method = directory.u16(WHAT)?;
        directory.take(8, WHAT)?;
        let packed = directory.u32(WHAT)?;
        directory.take(4, WHAT)?;
        let (name, extra, comment) = (
            directory.u16(WHAT)?,
            directory.u16(WHAT)?,
            directory.u16(WHAT)?,
        );
        directory.take(8, WHAT)?;
        let at = directory.u32(WHAT)?;
        let rest = u64::from(name) + u64::from(extra) + u64::from(comment);
        directory.take(rest, WHAT)?;
        unpacked = unpacked.saturating_add(size_of_entry(bytes, at, packed, method, unpacked)?);
        if unpacked > MAX_FILE_BYTES {
            return Err(FormatFault::TooMuch {
                most: MAX_FILE_BYTES,
                what: "unpacked bytes",
            });
        }
    }
    Ok(())
}

fn size_of_entry(
    bytes: &[u8],
    at: u32,
    packed: u32,
    method: u16,
    so_far: u64,
) -> Result<u64, FormatFault> {
    const WHAT: &str = "an entry of the archive";
    let start = usize::try_from(at).ok().filter(|&at| at < bytes.len());
    let start = start.ok_or_else(|| damaged("an entry lies beyond it"))?;
    let mut entry = Bytes::new(&bytes[start..], u64::from(at), false);
    if entry.take(4, WHAT)? != ENTRY {
        return Err(damaged("an entry is not where its directory says"));
    }
    entry.take(22, WHAT)?;
    let (name, extra) = (entry.u16(WHAT)?, entry.u16(WHAT)?);
    entry.take(u64::from(name) + u64::from(extra), WHAT)?;
    let data = entry.take(u64::from(packed), WHAT)?;
    if method != DEFLATED {
        return Ok(data.len() as u64);
    }
    let most = MAX_FILE_BYTES.saturating_sub(so_far) + 1;
    let mut unpacked = DeflateDecoder::new(data).take(most);
    std::io::copy(&mut unpacked, &mut std::io::sink()).map_err(|error| FormatFault::Damaged {
        what: WHAT.to_owned(),
        reason: crate::foreign::one_line(&error.to_string()),
    })
}

fn damaged(reason: &str) -> FormatFault {
    FormatFault::Damaged {
        what: "the archive".to_owned(),
        reason: reason.to_owned(),
    }
}
