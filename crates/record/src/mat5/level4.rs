//! MATLAB level 4, which is recognised and refused.

/// The head of a variable of level 4: its type, which has four digits at most, its sizes, whether
/// it is complex, and the length of its name.
pub(super) fn is_level_4(bytes: &[u8]) -> bool {
    let Some(head) = bytes.get(..20) else {
        return false;
    };
    let number = |k: usize, big: bool| {
        let b = [
            head[4 * k],
            head[4 * k + 1],
            head[4 * k + 2],
            head[4 * k + 3],
        ];
        if big {
            u32::from_be_bytes(b)
        } else {
            u32::from_le_bytes(b)
        }
    };
    [false, true].into_iter().any(|big| {
        let [kind, rows, columns, complex, name] = [0, 1, 2, 3, 4].map(|k| number(k, big));
        kind < 5000 && rows < 1 << 28 && columns < 1 << 28 && complex < 2 && (1..64).contains(&name)
    })
}
