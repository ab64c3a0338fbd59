//! The palette and the colour maps.

use plotters::style::RGBColor;

/// A colour of the palette of Okabe and Ito (2008), in the order in which series take them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Colour {
    /// First choice.
    Blue,
    /// Second choice; used as red.
    Vermilion,
    /// Third choice.
    Green,
    /// Fourth choice.
    Orange,
    /// Fifth choice.
    Purple,
    /// Sixth choice.
    Sky,
    /// For data with which the others are compared.
    Black,
    /// For guides.
    Grey,
}

impl Colour {
    const CYCLE: [Colour; 6] =
        [Colour::Blue, Colour::Vermilion, Colour::Green, Colour::Orange, Colour::Purple, Colour::Sky];

    /// The colour of the series with this number, if it does not name one.
    pub fn of_series(number: usize) -> Colour {
        Colour::CYCLE[number % Colour::CYCLE.len()]
    }

    pub(super) fn rgb(self) -> RGBColor {
        match self {
            Colour::Blue => RGBColor(0, 114, 178),
            Colour::Vermilion => RGBColor(213, 94, 0),
            Colour::Green => RGBColor(0, 158, 115),
            Colour::Orange => RGBColor(230, 159, 0),
            Colour::Purple => RGBColor(170, 85, 140),
            Colour::Sky => RGBColor(86, 180, 233),
            Colour::Black => RGBColor(20, 20, 20),
            Colour::Grey => RGBColor(130, 130, 130),
        }
    }
}

/// Viridis (van der Walt and Smith, 2015) at nine equidistant places.
const VIRIDIS: [[f64; 3]; 9] = [
    [68.0, 1.0, 84.0],
    [72.0, 40.0, 120.0],
    [62.0, 74.0, 137.0],
    [49.0, 104.0, 142.0],
    [38.0, 130.0, 142.0],
    [31.0, 158.0, 137.0],
    [53.0, 183.0, 121.0],
    [109.0, 205.0, 89.0],
    [253.0, 231.0, 37.0],
];

/// Blue over white to red (RdBu of ColorBrewer, Brewer 2003, safe for colour-blind readers), for values on both sides
/// of zero.
const BLUE_RED: [[f64; 3]; 9] = [
    [33.0, 102.0, 172.0],
    [67.0, 147.0, 195.0],
    [146.0, 197.0, 222.0],
    [209.0, 229.0, 240.0],
    [247.0, 247.0, 247.0],
    [253.0, 219.0, 199.0],
    [244.0, 165.0, 130.0],
    [214.0, 96.0, 77.0],
    [178.0, 24.0, 43.0],
];

/// The colour at `fraction` of viridis, from 0 (dark) to 1 (bright).
pub(super) fn viridis(fraction: f64) -> RGBColor {
    between(&VIRIDIS, fraction)
}

/// The colour at `fraction` of a scale with zero in its middle.
pub(super) fn blue_red(fraction: f64) -> RGBColor {
    between(&BLUE_RED, fraction)
}

fn between(map: &[[f64; 3]; 9], fraction: f64) -> RGBColor {
    let place = fraction.clamp(0.0, 1.0) * (map.len() - 1) as f64;
    let below = (place as usize).min(map.len() - 2);
    let part = place - below as f64;
    let [r, g, b] = [0, 1, 2].map(|c| map[below][c] + part * (map[below + 1][c] - map[below][c]));
    RGBColor(r.round() as u8, g.round() as u8, b.round() as u8)
}
