//! How a picture of a model shows an element.

/// How a picture shows an element.
#[derive(Debug, Clone, PartialEq)]
pub enum Drawing {
    /// Nodes that a plain line joins to the first.
    Rigid(Vec<[String; 2]>),
    /// A symbol between two nodes.
    Member {
        /// The nodes.
        between: [String; 2],
        /// What is drawn.
        glyph: Glyph,
    },
    /// A box below the machine.
    Box {
        /// What goes in, with its sign: an arrow from another box, or a line of text.
        signals: Vec<(&'static str, String)>,
        /// Lines of text below these.
        lines: Vec<String>,
        /// Names whose outputs are written below the box.
        measured: Vec<String>,
        /// Whether it stands at the end of the signals, next to the machine.
        is_last: bool,
    },
}

/// What is drawn between two nodes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Glyph {
    /// A double line.
    Beam,
    /// A piston in its tube.
    Cylinder,
}
