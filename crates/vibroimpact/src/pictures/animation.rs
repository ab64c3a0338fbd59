//! The motion of beam and ball as an animated SVG document, which a browser plays without a script.

use std::fmt::Write;

use contact_models::ContactLaw;
use vibroimpact_sim::modal::{History, Sample};

use crate::deflection::Deflection;
use crate::text::{quantity, significant};

/// Width and height (px), the ends of the beam, and the line of the beam at rest.
const SIZE: [f64; 2] = [760.0, 380.0];
const ENDS: [f64; 2] = [76.0, 736.0];
const REST: f64 = 160.0;
/// Height of the largest displacement, and radius of the ball (px).
const LARGEST: f64 = 75.0;
const BALL: f64 = 22.0;
/// The force: its base line and the height of its peak (px).
const FORCE: [f64; 2] = [345.0, 80.0];
/// Equal intervals of the force, beside every step in contact.
const INTERVALS: usize = 200;
/// Duration of the animation (s).
const SHOWN_S: f64 = 10.0;

/// Smaller deflections (m) are not enlarged.
const STILL_M: f64 = 1e-30;

/// Beam or string with the ball that strikes it at the location `location_m`, above the contact force, as a repeated animation in
/// slow motion. The displacements of both bodies are enlarged by the same stated factor.
///
/// The text of the document consists of the title and the scales only.
pub fn animation<L: ContactLaw>(title: &str, location_m: f64, deflection: &Deflection, history: &History<L>) -> String {
    let Deflection { location_m: places, time_s, structure_m, striker_m, .. } = deflection;
    let length_m = places.last().copied().unwrap_or(1.0);
    let until_s = time_s.last().copied().unwrap_or(0.0);
    let x = |place_m: f64| ENDS[0] + (ENDS[1] - ENDS[0]) * place_m / length_m;
    // a contact is shorter than the interval between two frames, and is drawn step by step
    let samples: Vec<Sample> = history.times(until_s, INTERVALS).into_iter().map(|t| history.at(t)).collect();
    let largest = |values: &mut dyn Iterator<Item = f64>| values.map(f64::abs).fold(0.0, f64::max);
    // Everything fits that moves in the picture: the beam, also between the frames, and the ball while it pushes the beam in, which
    // in a short time is much more. The ball may leave the picture upwards.
    let frames_m = structure_m.iter().flatten().copied();
    let between_m = samples.iter().map(|sample| sample.structure_displacement_m);
    let inwards_m = striker_m.iter().map(|u| u.min(0.0));
    let largest_m = largest(&mut frames_m.chain(between_m).chain(inwards_m));
    let moves = largest_m > STILL_M;
    let enlarged = if moves { LARGEST / largest_m } else { 1.0 };
    // results count displacements positive towards the ball, which is above
    let y = |displacement_m: f64| REST - enlarged * displacement_m;
    let lines: Vec<String> = structure_m
        .iter()
        .map(|row| {
            let points: Vec<String> =
                places.iter().zip(row).map(|(p, w)| format!("{:.0},{:.1}", x(*p), y(*w))).collect();
            format!("M{}", points.join("L"))
        })
        .collect();
    let balls: Vec<String> =
        striker_m.iter().map(|u| format!("{:.1}", (y(*u) - BALL - 2.0).max(-2.0 * BALL))).collect();
    let peak_n = largest(&mut samples.iter().map(|sample| sample.force_n));
    let share = |force_n: f64| if peak_n > 0.0 { force_n / peak_n } else { 0.0 };
    let force: Vec<String> = samples
        .iter()
        .map(|s| format!("{:.1},{:.1}", x(length_m * (s.time_s / until_s)), FORCE[0] - FORCE[1] * share(s.force_n)))
        .collect();
    let times = |attribute: &str, values: &[String]| {
        let values = values.join(";");
        format!(
            "<animate attributeName=\"{attribute}\" dur=\"{SHOWN_S}s\" repeatCount=\"indefinite\" values=\"{values}\"/>"
        )
    };
    let deflection = match moves {
        true => format!("deflection enlarged {} times", significant(enlarged * length_m / (ENDS[1] - ENDS[0]), 3)),
        false => "no deflection".to_owned(),
    };
    let [width, height] = SIZE;
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" height=\"{height}\" \
         font-family=\"DejaVu Sans, sans-serif\" font-size=\"13\">\n<rect width=\"{width}\" height=\"{height}\" fill=\"#fff\"/>\n"
    );
    let mut text = |x: f64, y: f64, anchor: &str, words: &str| {
        let words = words.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;");
        let _ = writeln!(svg, "<text x=\"{x}\" y=\"{y}\" text-anchor=\"{anchor}\" fill=\"#222\">{words}</text>");
    };
    text(12.0, 22.0, "start", title);
    text(12.0, 42.0, "start", &format!("{} in {SHOWN_S} s; {deflection}", quantity(until_s, "s")));
    text(ENDS[0] - 6.0, FORCE[0] - FORCE[1] + 4.0, "end", &quantity(peak_n, "N"));
    text(ENDS[0], FORCE[0] + 18.0, "middle", "0");
    text(ENDS[1], FORCE[0] + 18.0, "end", &quantity(until_s, "s"));
    let rest = lines.first().map_or("", String::as_str);
    let _ = write!(
        svg,
        "<path d=\"M{0},{REST}H{1}\" stroke=\"#bbb\" stroke-dasharray=\"4 4\"/>\n\
         <path d=\"{rest}\" fill=\"none\" stroke=\"#d55e00\" stroke-width=\"4\">{2}</path>\n\
         <circle cx=\"{3:.1}\" cy=\"{4:.1}\" r=\"{BALL}\" fill=\"#0072b2\">{5}</circle>\n\
         <path d=\"M{0},{6}V{7}H{1}\" fill=\"none\" stroke=\"#888\"/>\n\
         <path d=\"M{8}\" fill=\"none\" stroke=\"#222\" stroke-width=\"1.3\"/>\n\
         <path d=\"M{0},{6}V{7}\" stroke=\"#0072b2\"><animateTransform attributeName=\"transform\" type=\"translate\" dur=\"{SHOWN_S}s\" \
         repeatCount=\"indefinite\" from=\"0 0\" to=\"{9} 0\"/></path>\n</svg>\n",
        ENDS[0],
        ENDS[1],
        times("d", &lines),
        x(location_m),
        REST - BALL - 2.0,
        times("cy", &balls),
        FORCE[0] - FORCE[1],
        FORCE[0],
        force.join("L"),
        ENDS[1] - ENDS[0],
    );
    svg
}
