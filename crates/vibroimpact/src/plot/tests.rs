use super::axis::{Axis, Scale, full_label};
use super::text::{fixed, width_px, wrapped};
use super::*;
use crate::text::superscript;

/// The coordinates of every polyline of a picture.
fn polylines(svg: &str) -> Vec<Vec<(f64, f64)>> {
    let points = svg.split("points=\"").skip(1).filter_map(|rest| rest.split('"').next());
    let pair = |p: &str| p.split_once(',').map(|(x, y)| (x.parse().unwrap(), y.parse().unwrap()));
    points.map(|list| list.split_whitespace().filter_map(pair).collect()).collect()
}

/// Tags are balanced, no character is left raw, and no coordinate is missing.
fn assert_well_formed(svg: &str) {
    assert!(svg.starts_with("<svg xmlns") && svg.trim_end().ends_with("</svg>"));
    for word in ["NaN", "inf", "nan"] {
        assert!(!svg.contains(&format!("\"{word}")) && !svg.contains(&format!(" {word}")), "{word} in {svg}");
    }
    let mut open = Vec::new();
    for piece in svg.split('<').skip(1) {
        let (tag, text) = piece.split_once('>').expect("a tag ends");
        assert!(!text.contains('>'), "raw > in {text}");
        assert!(text.split('&').skip(1).all(|e| e.contains(';')), "raw & in {text}");
        let name = tag.split_whitespace().next().expect("a tag has a name");
        match name.strip_prefix('/') {
            Some(name) => assert_eq!(open.pop(), Some(name)),
            None if tag.ends_with('/') => {}
            None => open.push(name),
        }
    }
    assert!(open.is_empty());
}

fn line(x: &[f64], y: &[f64]) -> Figure {
    Figure::new("").row([Panel::new(Axis::new("x"), Axis::new("y")).with(Series::line(x, y))])
}

#[test]
fn every_kind_of_mark_is_drawn_the_same_each_time() {
    let (x, y) = ([1.0, 2.0, 3.0], [3.0, 1.0, 2.0]);
    let make = || {
        let panel = Panel::new(Axis::new("x").unit("s").log(), Axis::new("y").unit("N"))
            .with(Series::line(&x, &y).label("line").dashed())
            .with(Series::points(&x, &y, Marker::Circle).label("circle"))
            .with(Series::points(&x, &y, Marker::Cross))
            .with(Series::points(&x, &y, Marker::Plus))
            .with(Series::points(&x, &y, Marker::Square))
            .with(Series::line_points(&x, &y, Marker::Triangle))
            .with(Series::step(&x, &y))
            .with(Series::stem(&x, &y, Marker::Dot))
            .with(Series::band(&x, &y, &[4.0, 4.0, 4.0]))
            .with(Series::error_bars(&x, &y, &[0.1, 0.2, 0.3], Marker::Dot))
            .with(Series::level_error_bars(&x, &y, &[0.1, 0.2, 0.3], Marker::Dot).label("level"))
            .with(Series::spans(&x, &[1.5, 2.0, 9.0]).label("spans"))
            .with(Series::labels(&x, &y, ["a".to_owned(), "b".to_owned(), "c".to_owned()]))
            .with(Series::vertical_rule(2.0))
            .with(Series::horizontal_rule(2.0));
        let map = HeatMap::new(&x, &y, vec![vec![1.0, 2.0, f64::NAN]; 2], Axis::new("e"));
        let beside = Panel::new(Axis::new("x"), Axis::new("y")).map(map);
        Figure::new("all marks").row([panel, beside]).svg().unwrap()
    };
    assert_well_formed(&make());
    assert_eq!(make(), make());
}

#[test]
fn text_is_escaped() {
    let text = "a < b & \"c\" > 'd' \u{0}\u{7}";
    let panel = Panel::new(Axis::new(text).unit(text), Axis::new(text)).title(text);
    let panel = panel.with(Series::line(&[0.0, 1.0], &[0.0, 1.0]).label(text));
    let svg = Figure::new(text).row([panel]).svg().unwrap();
    assert_well_formed(&svg);
    assert!(svg.contains("a &lt; b &amp; ") && !svg.contains('\u{7}'));
}

#[test]
fn unusual_data_gives_a_sound_picture() {
    let bad = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, f64::MAX, f64::MIN_POSITIVE, 0.0, -0.0, 5e-324];
    for a in bad {
        for b in bad {
            assert_well_formed(&line(&[0.0, 1.0, a, 3.0, b], &[1.0, a, 2.0, b, 3.0]).svg().unwrap());
            let logarithmic = Panel::new(Axis::new("x").log().limits(a, b), Axis::new("y").log().limits(b, a))
                .with(Series::points(&[a, 1.0, b], &[b, a, 2.0], Marker::Dot))
                .with(Series::band(&[a, 1.0, b], &[b, a, 2.0], &[a, a, b]))
                .with(Series::error_bars(&[a, 1.0], &[b, 2.0], &[a, b], Marker::Dot))
                .with(Series::level_error_bars(&[a, 1.0], &[b, 2.0], &[a, b], Marker::Dot))
                .with(Series::spans(&[a, 1.0, b], &[b, a, 2.0]))
                .with(Series::labels(&[a, 1.0, b], &[b, a, 2.0], (0..3).map(|i| i.to_string())).opacity(a))
                .with(Series::vertical_rule(a))
                .with(Series::horizontal_rule(b))
                .height(a);
            assert_well_formed(&Figure::new("").row([logarithmic]).width(b).svg().unwrap());
        }
    }
    let empty: [f64; 0] = [];
    assert!(line(&empty, &empty).svg().unwrap().contains("no data"));
    let stems =
        Panel::new(Axis::new("x"), Axis::new("y").log()).with(Series::stem(&[1.0, 2.0], &[0.0, 0.0], Marker::Dot));
    assert!(Figure::new("").row([stems]).svg().unwrap().contains("no data"));
    assert_well_formed(&Figure::new("").svg().unwrap());
    assert_well_formed(&Figure::new("").row([]).svg().unwrap());
    let map = HeatMap::new(&empty, &[1.0], vec![], Axis::new("e"));
    assert_well_formed(&Figure::new("").row([Panel::new(Axis::new("x"), Axis::new("y")).map(map)]).svg().unwrap());
}

#[test]
fn a_missing_value_interrupts_a_line_and_limits_cut_it() {
    let whole = polylines(&line(&[0.0, 1.0, 2.0, 3.0], &[0.0, 1.0, 0.0, 1.0]).svg().unwrap());
    assert!(whole.iter().any(|p| p.len() == 4));
    let broken = polylines(&line(&[0.0, 1.0, 2.0, 3.0, 4.0], &[0.0, 1.0, f64::NAN, 1.0, 0.0]).svg().unwrap());
    assert!(broken.iter().all(|p| p.len() != 4));

    // the frame is the only closed line; everything of the series lies inside it
    let mut figure = line(&[0.0, 10.0], &[-100.0, 100.0]);
    figure.rows[0][0].x.limits = Some((4.0, 6.0));
    figure.rows[0][0].y.limits = Some((-5.0, 5.0));
    let lines = polylines(&figure.svg().unwrap());
    let frame = lines.iter().find(|p| p.len() == 5).expect("a frame").clone();
    let (left, right, top, bottom) = (frame[0].0, frame[1].0, frame[0].1, frame[2].1);
    let slanted = lines.iter().find(|p| p.len() == 2 && p[0].0 != p[1].0 && p[0].1 != p[1].1).expect("the series");
    for (x, y) in slanted {
        assert!((left..=right).contains(x) && (top..=bottom).contains(y));
    }
    // y = 20 (x - 5) leaves the limits at x = 4.75 and 5.25
    let expected = left + (4.75 - 4.0) / 2.0 * (right - left);
    assert!((slanted[0].0 - expected).abs() <= 1.0 && (slanted[0].1 - bottom).abs() <= 1.0);
}

#[test]
fn ticks_are_round_distinct_and_stand_apart() {
    let cases = [(0.0, 1.0), (-3e-5, 7e-5), (0.6, 0.62), (1e6, 9e6), (0.9505, 0.9506), (-1e-12, 1e12), (0.0, 41.0)];
    for (low, high) in cases {
        let axis = Axis::new("x").unit("m").limits(low, high);
        let scale = Scale::new(&axis, None, 0.0, true);
        for (ticks, size) in [(scale.ticks_along(300.0, 11.0).0, 300.0), (scale.ticks_up(190.0, 11.0).0, 190.0)] {
            assert!((2..=12).contains(&ticks.len()), "{ticks:?}");
            for pair in ticks.windows(2) {
                assert!(pair[0].0 < pair[1].0 && pair[0].1 != pair[1].1, "{ticks:?}");
                assert!(pair[0].1.chars().count() <= 10, "{ticks:?}");
                if size == 300.0 {
                    let apart = size * (scale.fraction_of_measure(pair[1].0) - scale.fraction_of_measure(pair[0].0));
                    assert!(apart > 0.5 * (width_px(&pair[0].1, 11.0) + width_px(&pair[1].1, 11.0)), "{ticks:?}");
                }
            }
        }
    }
    let whole = Scale::new(&Axis::new("n").integers().limits(0.0, 2.0), None, 0.0, true).ticks_up(190.0, 11.0).0;
    assert_eq!(whole.iter().map(|t| t.1.as_str()).collect::<Vec<_>>(), ["0", "1", "2"]);
}

#[test]
fn powers_of_ten_move_into_the_label() {
    let axis = Axis::new("compression").unit("m").limits(0.0, 3e-5);
    let (ticks, exponent) = Scale::new(&axis, None, 0.0, true).ticks_up(190.0, 11.0);
    assert_eq!(full_label(&axis, exponent), "compression (µm)");
    assert_eq!(ticks.last().unwrap().1, "30");
    assert_eq!((superscript(-10).as_str(), fixed(-0.5, 1).as_str(), fixed(-0.01, 1).as_str()), ("⁻¹⁰", "−0.5", "0.0"));

    let log = Scale::new(&Axis::new("e").log().limits(1e-12, 1.0), None, 0.0, true).ticks_up(190.0, 11.0).0;
    let labels: Vec<&str> = log.iter().map(|t| t.1.as_str()).filter(|t| !t.is_empty()).collect();
    assert!(labels.contains(&"10⁻⁶") && labels.contains(&"10⁰"), "{labels:?}");
    let few = Scale::new(&Axis::new("v").log().limits(0.1, 10.0), None, 0.0, true).ticks_along(400.0, 11.0).0;
    let labels: Vec<&str> = few.iter().map(|t| t.1.as_str()).filter(|t| !t.is_empty()).collect();
    assert_eq!(labels, ["0.1", "1", "10"]);
}

#[test]
fn panels_with_the_same_legend_share_it() {
    let panel = |label: &str| {
        Panel::new(Axis::new("x"), Axis::new("y")).with(Series::line(&[0.0, 1.0], &[0.0, 1.0]).label(label))
    };
    let count = |a: &str, b: &str| Figure::new("").row([panel(a), panel(b)]).svg().unwrap().matches("damped").count();
    assert_eq!(count("damped", "damped"), 1);
    assert_eq!(count("damped", "undamped"), 2);
}

#[test]
fn units_take_prefixes_where_they_have_them() {
    let label = |unit: &str, low: f64, high: f64| {
        let axis = Axis::new("q").unit(unit).limits(low, high);
        let (ticks, exponent) = Scale::new(&axis, None, 0.0, true).ticks_up(190.0, 11.0);
        (full_label(&axis, exponent), ticks.last().unwrap().1.clone())
    };
    assert_eq!(label("N", 0.0, 2000.0), ("q (kN)".into(), "2.0".into()));
    assert_eq!(label("s", 0.0, 0.03), ("q (ms)".into(), "30".into()));
    assert_eq!(label("m", -0.8, 0.2), ("q (m)".into(), "0.2".into()));
    assert_eq!(label("m/s", 0.0, 2e-5), ("q (µm/s)".into(), "20".into()));
    assert_eq!(label("N", 0.0, 2e24), ("q (10²⁴ N)".into(), "2.0".into()));
    assert_eq!(label("kg^-1/2", 0.0, 2e6), ("q (10⁶ kg^-1/2)".into(), "2.0".into()));
    assert_eq!(label("", 0.0, 2e6), ("q (10⁶)".into(), "2.0".into()));
}

#[test]
fn labels_that_would_overlap_are_raised_or_left_out_and_titles_are_broken() {
    let x: Vec<f64> = (0..400).map(f64::from).collect();
    let panel = Panel::new(Axis::new("x"), Axis::new("y")).with(Series::labels(
        &x,
        &vec![1.0; 400],
        (0..400).map(|i| format!("n{i}")),
    ));
    let svg = Figure::new("word ".repeat(60)).row([panel]).svg().unwrap();
    let drawn = svg.lines().filter(|line| line.starts_with('n')).count();
    // on two lines at most
    assert!((5..120).contains(&drawn), "{drawn}");
    let two = Panel::new(Axis::new("x").limits(0.0, 100.0), Axis::new("y").limits(0.0, 1.0)).with(Series::labels(
        &[50.0, 50.5],
        &[0.5, 0.5],
        ["n1".to_owned(), "n2".to_owned()],
    ));
    let svg = Figure::new("").row([two]).svg().unwrap();
    assert_eq!(svg.lines().filter(|line| line.starts_with('n')).count(), 2);
    assert!(wrapped(&"word ".repeat(60), 14.0, 740.0).len() > 1);
    assert_eq!(wrapped("two\nlines", 14.0, 740.0), ["two", "lines"]);
    // Seven words need two lines, of which neither is a single word.
    let equal = wrapped(&"equal ".repeat(7), 14.0, 6.5 * width_px("equal ", 14.0));
    assert_eq!(equal, ["equal equal equal equal", "equal equal equal"]);
    assert_eq!(wrapped("unbreakable", 14.0, 1.0), ["unbreakable"]);
    assert!(wrapped(" ", 14.0, 740.0).is_empty());
}

/// Width, height and pixels (red, green, blue, alpha) of a PNG file.
#[cfg(feature = "png")]
fn decoded(png: &[u8]) -> (u32, u32, Vec<[u8; 4]>) {
    let picture = resvg::tiny_skia::Pixmap::decode_png(png).unwrap();
    let pixels = picture.pixels().iter().map(|p| [p.red(), p.green(), p.blue(), p.alpha()]).collect();
    (picture.width(), picture.height(), pixels)
}

#[cfg(feature = "png")]
#[test]
fn a_png_has_the_size_asked_for_and_shows_lines_and_text() {
    let figure = |title: &str| {
        let axes = Panel::new(Axis::new("x"), Axis::new("y"));
        let panel = axes.with(Series::line(&[0.0, 1.0], &[0.0, 1.0]).colour(Colour::Vermilion));
        Figure::new(title).row([panel])
    };
    let png = figure("Σ µ ⁻¹ é").png(1.5).unwrap();
    assert_eq!(png, figure("Σ µ ⁻¹ é").png(1.5).unwrap());
    let (width, height, pixels) = decoded(&png);
    assert_eq!(width, 1140);
    assert!(height > 300 && pixels.iter().all(|p| p[3] == 255));
    assert!(pixels.contains(&[255, 255, 255, 255]) && pixels.contains(&[213, 94, 0, 255]));
    // the title is ink where the figure with another title, as high and as wide, has less
    let ink = |title: &str| {
        let (width, _, pixels) = decoded(&figure(title).width(200.0).png(1.5).unwrap());
        pixels[..36 * width as usize].iter().filter(|p| p[0] < 128).count()
    };
    for glyph in ["A", "Σ", "µ", "⁻¹", "é", "−", "×", "±", "²", "√", "δ"] {
        assert!(ink(&format!("A{glyph}")) > ink("A"), "{glyph}");
        // a box stands for a glyph that is missing
        let missing = ink("A\u{e000}");
        assert!(ink(&format!("A{glyph}")) != missing, "{glyph}");
    }
}

#[cfg(feature = "png")]
#[test]
fn pngs_of_impossible_size_are_refused() {
    for scale in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e9, 1e-9] {
        assert_eq!(line(&[0.0], &[0.0]).png(scale).unwrap_err().kind(), std::io::ErrorKind::InvalidInput, "{scale}");
    }
}

#[test]
fn the_file_holds_the_picture_in_the_format_of_its_name() {
    let folder = tempfile::tempdir().unwrap();
    let figure = line(&[0.0, 1.0], &[0.0, 1.0]);
    let path = folder.path().join("made/line.svg");
    figure.write(&path).unwrap();
    assert_eq!(std::fs::read_to_string(&path).unwrap(), figure.svg().unwrap());
    #[cfg(feature = "png")]
    {
        figure.write(&folder.path().join("line.PNG")).unwrap();
        assert_eq!(std::fs::read(folder.path().join("line.PNG")).unwrap(), figure.png(2.0).unwrap());
    }
    for name in ["line.jpg", "line", "svg", ".svg", "line.svg.gz"] {
        let error = figure.write(&folder.path().join(name)).unwrap_err();
        assert_eq!(error.kind(), std::io::ErrorKind::InvalidInput, "{name}");
        assert!(!folder.path().join(name).exists());
    }
    assert!(figure.write(&path.join("line.svg")).is_err());
}

#[test]
fn a_piece_of_a_decade_still_has_ticks() {
    for (low, high) in [(1050.0, 4900.0), (105.0, 180.0), (0.95, 0.98), (1e-7, 1.00001e-7), (3.0, 4.0)] {
        let axis = Axis::new("x").log().limits(low, high);
        let (ticks, exponent) = Scale::new(&axis, None, 0.0, true).ticks_along(300.0, 11.0);
        let labelled: Vec<_> = ticks.iter().filter(|tick| !tick.1.is_empty()).collect();
        assert!(labelled.len() >= 2, "{low} to {high}: {ticks:?}");
        for (measure, text) in labelled {
            if exponent != 0 {
                let value: f64 = text.parse().unwrap();
                let at = 10f64.powf(*measure);
                assert!((value * 10f64.powi(exponent) / at - 1.0).abs() < 1e-3, "{text} at {at}");
            }
        }
    }
}

#[test]
fn a_map_about_zero_takes_colours_that_part_there() {
    let svg = |low: f64, high: f64| {
        let map = HeatMap::new(&[0.0, 1.0], &[0.0], vec![vec![-1.0, 1.0]], Axis::new("e").limits(low, high));
        Figure::new("").row([Panel::new(Axis::new("x"), Axis::new("y")).map(map)]).svg().unwrap()
    };
    let [blue, red] = ["#2166AC", "#B2182B"];
    assert!(svg(-1.0, 1.0).contains(blue) && svg(-1.0, 1.0).contains(red));
    assert!(!svg(-1.0, 2.0).contains(blue) && !svg(-1.0, 2.0).contains(red));
}

#[test]
fn the_cells_of_a_map_are_drawn_in_any_order() {
    let svg = |x: [f64; 3], y: [f64; 2], rows: [[f64; 3]; 2]| {
        let map = HeatMap::new(&x, &y, rows.map(Vec::from).to_vec(), Axis::new("e"));
        Figure::new("").row([Panel::new(Axis::new("x"), Axis::new("y")).map(map)]).svg().unwrap()
    };
    let ascending = svg([1.0, 2.0, 3.0], [5.0, 7.0], [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]);
    assert_eq!(svg([3.0, 1.0, 2.0], [7.0, 5.0], [[6.0, 4.0, 5.0], [3.0, 1.0, 2.0]]), ascending);
}
