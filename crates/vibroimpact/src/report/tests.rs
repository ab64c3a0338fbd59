use super::*;
use crate::plot::{Axis, Figure, Panel, Series};

fn figure() -> Figure {
    let panel = Panel::new(Axis::new("x"), Axis::new("y")).with(Series::line(&[0.0, 1.0], &[0.0, 1.0]));
    Figure::new("A [line]").row([panel])
}

#[test]
fn half_a_unit_of_the_last_printed_digit_decides() {
    let verdict = |printed: &str, ours: f64| Comparison::printed("q", "s", printed, ours).verdict();
    assert_eq!(verdict("0.11027", 0.110274), Verdict::Agrees);
    assert_eq!(verdict("0.11027", 0.110276), Verdict::Differs);
    assert_eq!(verdict("1.7945e10", 1.79454e10), Verdict::Agrees);
    assert_eq!(verdict("1.7945e10", 1.79456e10), Verdict::Differs);
    assert_eq!(verdict("1.0684e-5", 1.06836e-5), Verdict::Agrees);
    assert_eq!(verdict("26", 26.5), Verdict::Agrees);
    assert_eq!(verdict("26", 26.6), Verdict::Differs);
    assert_eq!(verdict("26", f64::NAN), Verdict::Differs);
    assert_eq!(verdict("26", f64::INFINITY), Verdict::Differs);
    assert_eq!(verdict("twenty", 20.0), Verdict::Differs);
}

#[test]
fn limits_are_included_and_a_missing_number_is_outside() {
    let verdict = |ours: f64| Comparison::range("q", "s", "0.1 to 0.6", (0.1, 0.6), ours).verdict();
    assert_eq!(verdict(0.1), Verdict::Agrees);
    assert_eq!(verdict(0.6), Verdict::Agrees);
    assert_eq!(verdict(0.61), Verdict::Differs);
    assert_eq!(verdict(f64::NAN), Verdict::Differs);
    let open = |ours: f64| Comparison::range("q", "s", "at least 2", (2.0, f64::INFINITY), ours);
    assert_eq!(open(5.0).verdict(), Verdict::Agrees);
    assert_eq!(open(1.5).difference(), -0.5);
    assert_eq!(open(f64::INFINITY).verdict(), Verdict::Differs);
    let about = Comparison::about("q", "s", "about 0.95", 0.95, 0.01, 0.9505);
    assert_eq!(about.verdict(), Verdict::Agrees);
}

#[test]
fn numbers_are_short_and_keep_their_digits() {
    let cases = [
        (0.1102699, 4, "0.1103"),
        (1.79449e10, 5, "1.7945×10¹⁰"),
        (-2.5e-7, 2, "−2.5×10⁻⁷"),
        (93598.0, 7, "93598"),
        (0.5, 7, "0.5"),
        (0.0, 3, "0"),
        (12345.678, 2, "12346"),
        (f64::NAN, 3, "not a number"),
        (9.9999999, 3, "10"),
    ];
    for (value, digits, text) in cases {
        assert_eq!(significant(value, digits), text);
    }
}

#[test]
fn the_page_holds_tables_and_figures_and_no_foreign_html() {
    let mut report = Report::new("Impacts & <more>");
    report.heading("First");
    report.text("Some *text* <script>alert(1)</script>");
    report.figure("fig 1/2", &figure(), "**Fig. 1** a line").unwrap();
    report.comparisons(&[Comparison::printed("a | b", "s", "1.0", 1.0).note("why")]);
    let (markdown, html) = (report.markdown(), report.html());
    assert!(markdown.starts_with("# Impacts & <more>\n"));
    assert!(markdown.contains("(figures/fig-1-2.svg)") && markdown.contains("a \\| b"));
    assert!(markdown.contains("1 of 1 statements agree") && markdown.contains("Row 1: why"));
    assert!(html.contains("<title>Impacts &amp; &lt;more&gt;</title>"));
    assert!(html.contains("<svg xmlns") && html.contains("<strong>Fig. 1</strong>") && html.contains("<td>a | b</td>"));
    assert!(!html.contains("<script>") && !html.contains("<img"));
    assert_eq!(html, report.html());
}

#[test]
fn files_are_written_whole() {
    let folder = tempfile::tempdir().unwrap();
    let mut report = Report::new("r");
    report.figure("line", &figure(), "").unwrap();
    let written = report.write(&folder.path().join("out")).unwrap();
    assert_eq!(written.len(), 3);
    for path in &written {
        assert!(std::fs::metadata(path).unwrap().len() > 0);
    }
    let names: Vec<_> = std::fs::read_dir(folder.path().join("out")).unwrap().map(|e| e.unwrap().file_name()).collect();
    assert!(names.iter().all(|n| !n.to_string_lossy().ends_with(".part")));
    assert!(write_whole(Path::new("/"), b"x").is_err());
}

#[test]
fn text_from_outside_stays_text() {
    let hostile = "![x](http://evil/a.png) <img src=//evil> `a` [l](http://evil)\n# h | c ~~~ ``` ````\n\n<script>1</script>\0\u{1b}";
    let mut report = Report::new(literal(hostile));
    report.text(&literal(hostile));
    report.code(hostile);
    let html = report.html();
    for tag in ["<img", "<a ", "<script", "<h1>h", "<h2", "\0", "\u{1b}"] {
        assert!(!html.contains(tag), "{tag} in {html}");
    }
    assert!(html.contains("![x](http://evil/a.png) &lt;img src=//evil&gt; `a`"));
    assert_eq!(html.matches("<pre>").count(), 1);
}
