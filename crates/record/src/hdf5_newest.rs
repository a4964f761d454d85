//! Files of HDF5 2.0, made legible to a reader of the versions before.
//!
//! A file that is written for HDF5 2.0 alone says so in one byte of each dataset: version 5 of the
//! message on its layout. All that the version adds is a field of 8 bytes for the length of a packed
//! chunk, and the index of the chunks says itself how wide that field is. So the byte becomes 4, and
//! the check sum of the block around it is made anew. Only blocks whose check sum was right are
//! touched: a block is never taken for one by mistake.
//!
//! ```text
//! object header:  OHDR, version, flags, [16 bytes], [4 bytes], size, messages, sum
//! continuation:   OCHK, messages, sum
//! message:        type (1), size (2), flags (1), [2 bytes], body
//! ```
//!
//! (HDF5 File Format Specification 4.0, IV.A.1.b, IV.A.2.i and q.)

const SIGNATURE: &[u8] = b"\x89HDF\r\n\x1a\n";
const HEADER: &[u8] = b"OHDR";
const CONTINUATION: &[u8] = b"OCHK";
/// Types of messages: on the layout, and on a continuation.
const LAYOUT: u8 = 8;
const CONTINUED: u8 = 16;
/// The version of a layout that came with HDF5 2.0, and the one before.
const NEWEST: u8 = 5;
const KNOWN: u8 = 4;
/// Blocks are looked at until so many times the length of the file is summed up.
const MOST_SUMS: usize = 4;

/// Marks the layouts of datasets as of the version before, where nothing else is new in them.
pub(crate) fn as_known(bytes: &mut [u8]) {
    // MATLAB puts up to some hundred bytes before the file.
    let bases = [0_usize, 512, 1024, 2048];
    let is_base = |base: &usize| bytes.get(*base..base + 8) == Some(SIGNATURE);
    let Some(base) = bases.into_iter().find(is_base) else {
        return;
    };
    // Headers with signatures came with version 2 of the superblock; sizes are of 8 bytes by habit.
    let is_new = matches!(bytes.get(base + 8..base + 11), Some(&[version, 8, 8]) if version >= 2);
    if !is_new {
        return;
    }
    let mut left = MOST_SUMS * bytes.len();
    let mut at = base;
    while let Some(found) = find(&bytes[at..]) {
        at += found;
        let mut blocks: Vec<Block> = Block::header(bytes, at).into_iter().collect();
        while let Some(block) = blocks.pop() {
            let size = block.end - block.start;
            if size > left {
                return;
            }
            left -= size;
            if let Some(further) = block.mark(bytes, base) {
                blocks.extend(further);
            }
        }
        at += HEADER.len();
    }
}

fn find(bytes: &[u8]) -> Option<usize> {
    let mut at = 0;
    loop {
        at += bytes
            .get(at..)?
            .iter()
            .position(|&byte| byte == HEADER[0])?;
        if bytes[at..].starts_with(HEADER) {
            return Some(at);
        }
        at += 1;
    }
}

/// A block of messages, from its signature to its check sum.
struct Block {
    start: usize,
    first: usize,
    end: usize,
    /// Whether messages are numbered.
    is_ordered: bool,
}

impl Block {
    fn header(bytes: &[u8], start: usize) -> Option<Block> {
        let flags = *bytes.get(start + 5)?;
        let times = if flags & 0x20 == 0 { 0 } else { 16 };
        let phases = if flags & 0x10 == 0 { 0 } else { 4 };
        let first = start + 6 + times + phases;
        let width = 1_usize << (flags & 3);
        let size = number(bytes.get(first..first + width)?)?;
        let first = first + width;
        Some(Block {
            start,
            first,
            end: first.checked_add(size)?,
            is_ordered: flags & 4 != 0,
        })
    }

    /// Where a message says that its block goes on.
    fn continued(&self, bytes: &[u8], base: usize, body: usize) -> Option<Block> {
        let start = base.checked_add(number(bytes.get(body..body + 8)?)?)?;
        let size = number(bytes.get(body + 8..body + 16)?)?;
        let end = start.checked_add(size)?.checked_sub(4)?;
        let first = start + CONTINUATION.len();
        let is_one = first <= end && bytes.get(start..first) == Some(CONTINUATION);
        is_one.then_some(Block {
            start,
            first,
            end,
            is_ordered: self.is_ordered,
        })
    }

    /// Marks the layouts in this block, and says where it goes on.
    fn mark(&self, bytes: &mut [u8], base: usize) -> Option<Vec<Block>> {
        let end = self.end;
        let sum = number(bytes.get(end..end.checked_add(4)?)?)?;
        if sum != lookup3(bytes.get(self.start..end)?) as usize {
            return None;
        }
        let head = if self.is_ordered { 6 } else { 4 };
        let (mut at, mut is_changed, mut further) = (self.first, false, vec![]);
        while at + head <= end {
            let kind = bytes[at];
            let size = number(&bytes[at + 1..at + 3])?;
            let body = at + head;
            if kind == LAYOUT && size > 0 && bytes.get(body) == Some(&NEWEST) {
                bytes[body] = KNOWN;
                is_changed = true;
            }
            if kind == CONTINUED {
                further.extend(self.continued(bytes, base, body));
            }
            at = body + size;
        }
        if is_changed {
            let sum = lookup3(&bytes[self.start..end]);
            bytes[end..end + 4].copy_from_slice(&sum.to_le_bytes());
        }
        Some(further)
    }
}

/// Up to eight bytes, the least first.
fn number(bytes: &[u8]) -> Option<usize> {
    let digits = bytes.iter().rev();
    let value = digits.fold(0_u64, |value, &byte| value << 8 | u64::from(byte));
    usize::try_from(value).ok()
}

/// Jenkins' hash `lookup3`, which HDF5 takes for its check sums.
fn lookup3(key: &[u8]) -> u32 {
    let seed = 0xdead_beef_u32.wrapping_add(key.len() as u32);
    let [mut a, mut b, mut c] = [seed; 3];
    let mut rest = key;
    while rest.len() > 12 {
        let (now, later) = rest.split_at(12);
        add(now, [&mut a, &mut b, &mut c]);
        (a, c) = (a.wrapping_sub(c) ^ c.rotate_left(4), c.wrapping_add(b));
        (b, a) = (b.wrapping_sub(a) ^ a.rotate_left(6), a.wrapping_add(c));
        (c, b) = (c.wrapping_sub(b) ^ b.rotate_left(8), b.wrapping_add(a));
        (a, c) = (a.wrapping_sub(c) ^ c.rotate_left(16), c.wrapping_add(b));
        (b, a) = (b.wrapping_sub(a) ^ a.rotate_left(19), a.wrapping_add(c));
        (c, b) = (c.wrapping_sub(b) ^ b.rotate_left(4), b.wrapping_add(a));
        rest = later;
    }
    if rest.is_empty() {
        return c;
    }
    add(rest, [&mut a, &mut b, &mut c]);
    c = (c ^ b).wrapping_sub(b.rotate_left(14));
    a = (a ^ c).wrapping_sub(c.rotate_left(11));
    b = (b ^ a).wrapping_sub(a.rotate_left(25));
    c = (c ^ b).wrapping_sub(b.rotate_left(16));
    a = (a ^ c).wrapping_sub(c.rotate_left(4));
    b = (b ^ a).wrapping_sub(a.rotate_left(14));
    (c ^ b).wrapping_sub(b.rotate_left(24))
}

/// Adds twelve bytes as three words; those that are not there are zero.
fn add(bytes: &[u8], words: [&mut u32; 3]) {
    for (k, word) in words.into_iter().enumerate() {
        let mut four = [0; 4];
        for (to, from) in four.iter_mut().zip(bytes.iter().skip(4 * k)) {
            *to = *from;
        }
        *word = word.wrapping_add(u32::from_le_bytes(four));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What the author of the hash prints of it (`driver5` of lookup3.c).
    #[test]
    fn val_jenkins_values_of_the_hash() {
        assert_eq!(lookup3(b""), 0xdead_beef);
        assert_eq!(lookup3(b"Four score and seven years ago"), 0x1777_0551);
    }

    #[test]
    fn verify_damaged_blocks_are_left_alone() {
        let mut bytes = SIGNATURE.to_vec();
        bytes.extend([3, 8, 8]);
        bytes.extend(b"OHDR\x02\x00\x08\x08\x02\x00\x00\x05\x01sum.");
        let before = bytes.clone();
        as_known(&mut bytes);
        assert_eq!(bytes, before);
        for length in 0..before.len() {
            as_known(&mut before[..length].to_vec());
        }
    }
}
