//! Colours with a fixed meaning, after the palette of Okabe and Ito, which stays distinct for
//! readers with colour-blindness (OkabeIto2008).

use plotters::style::RGBColor;

/// What a series or a bar stands for; decides its colour and weight in every chart.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Role {
    /// As measured: near black, the heaviest line.
    Measured,
    /// The model as given: orange.
    Nominal,
    /// The model with its parameters re-estimated: green.
    Recalibrated,
    /// The model with the named effects: blue.
    Corrected,
    /// A limit or a floor: grey.
    Reference,
    /// Anything else: four further colours in turn.
    Other(u8),
}

/// The colour of one role on white and on a dark page.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RoleColour {
    /// As written in the SVG, such as `#0072B2`.
    pub light: &'static str,
    /// The counterpart for a dark background; a page may map one to the other.
    pub dark: &'static str,
}

/// Every colour used by a [`Role`], in a fixed order.
pub const ROLE_COLOURS: [RoleColour; 9] = [
    colour("#1F2328", "#E6EDF3"),
    colour("#D55E00", "#FF9A4D"),
    colour("#009E73", "#3FD0A4"),
    colour("#0072B2", "#5CB8F2"),
    colour("#767C85", "#9AA3AD"),
    colour("#B8588F", "#E394C0"),
    colour("#3D8FBF", "#8CCBEF"),
    colour("#B07C00", "#E6B84A"),
    colour("#5D3A9B", "#B59AE8"),
];

/// Colours without a role: text, lesser text, frame, grid, fill behind bars and stretches.
pub const NEUTRAL_COLOURS: [RoleColour; 5] = [
    colour(INK, "#D5DAE0"),
    colour(SOFT_INK, "#A3ABB5"),
    colour(FRAME, "#6E7681"),
    colour(GRID, "#2C333B"),
    colour(SHADE, "#242B33"),
];

/// Text.
pub(crate) const INK: &str = "#24292F";
/// Lesser text.
pub(crate) const SOFT_INK: &str = "#57606A";
/// Frames.
pub(crate) const FRAME: &str = "#8C959F";
/// Grid lines.
pub(crate) const GRID: &str = "#E1E5EA";
/// Behind highlighted stretches and bars.
pub(crate) const SHADE: &str = "#E9EEF4";

const fn colour(light: &'static str, dark: &'static str) -> RoleColour {
    RoleColour { light, dark }
}

impl Role {
    fn index(self) -> usize {
        match self {
            Role::Measured => 0,
            Role::Nominal => 1,
            Role::Recalibrated => 2,
            Role::Corrected => 3,
            Role::Reference => 4,
            Role::Other(n) => 5 + usize::from(n % 4),
        }
    }

    /// The colour of this role.
    #[must_use]
    pub fn colour(self) -> RoleColour {
        ROLE_COLOURS[self.index()]
    }

    /// Width of its lines in tenths of a pixel. Measured is drawn heavier, so that it still shows
    /// as a rim when a good prediction lies on it.
    pub(crate) fn line_width(self) -> u32 {
        match self {
            Role::Measured => 24,
            Role::Reference => 14,
            _ => 16,
        }
    }

    pub(crate) fn rgb(self) -> RGBColor {
        parse_rgb(self.colour().light)
    }
}

/// The colour of `#RRGGBB`; black for anything else.
pub(crate) fn parse_rgb(hex: &str) -> RGBColor {
    let part = |i: usize| {
        hex.get(i..i + 2)
            .and_then(|s| u8::from_str_radix(s, 16).ok())
            .unwrap_or(0)
    };
    RGBColor(part(1), part(3), part(5))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_every_colour_is_six_upper_case_digits() {
        for c in ROLE_COLOURS
            .iter()
            .chain(&NEUTRAL_COLOURS)
            .flat_map(|c| [c.light, c.dark])
        {
            let RGBColor(r, g, b) = parse_rgb(c);
            assert_eq!(format!("#{r:02X}{g:02X}{b:02X}"), c);
        }
    }

    #[test]
    fn verify_roles_have_colours_of_their_own() {
        let all = || ROLE_COLOURS.iter().chain(&NEUTRAL_COLOURS);
        let mut seen: Vec<&str> = all().map(|c| c.light).collect();
        seen.sort_unstable();
        seen.dedup();
        assert_eq!(seen.len(), all().count());
        assert_eq!(Role::Other(0).colour(), Role::Other(4).colour());
    }
}
