//! Converts Markdown into a page that needs no other file.

use pulldown_cmark::{CowStr, Event, Options, Parser, Tag, TagEnd};
use std::collections::BTreeMap;

const STYLE: &str = "
body { font: 16px/1.5 Georgia, 'Times New Roman', serif; color: #222; max-width: 60rem; margin: 2rem auto; padding: 0 1rem }
h1, h2, h3, table { font-family: Helvetica, Arial, sans-serif }
h1 { font-size: 1.7rem; text-wrap: balance } h2 { font-size: 1.25rem; margin-top: 2.2rem; border-bottom: 1px solid #ccc }
table { border-collapse: collapse; font-size: 0.85rem; margin: 1rem 0; display: block; overflow-x: auto }
th, td { padding: 0.25rem 0.6rem; border-bottom: 1px solid #ddd; text-align: left; vertical-align: top }
th { border-bottom: 2px solid #888 }
td:last-child { min-width: 5.5rem }
svg { display: block; max-width: 100%; height: auto; margin: 1rem auto 0 }
pre { background: #f4f4f4; padding: 0.7rem 1rem; overflow-x: auto; font-size: 0.85rem; line-height: 1.35 }
pre code { background: none; padding: 0 }
code { font-size: 0.9em; background: #f4f4f4; padding: 0 0.2em }
";

/// The page. Images whose target is among `figures` are drawn in place.
pub(super) fn page(title: &str, markdown: &str, figures: &BTreeMap<String, String>) -> String {
    let mut inside_figure = false;
    let events = Parser::new_ext(markdown, Options::ENABLE_TABLES).filter_map(|event| match event {
        Event::Start(Tag::Image { ref dest_url, .. }) => match figures.get(dest_url.as_ref()) {
            Some(svg) => {
                inside_figure = true;
                Some(Event::InlineHtml(CowStr::from(svg.clone())))
            }
            None => Some(event),
        },
        Event::End(TagEnd::Image) if inside_figure => {
            inside_figure = false;
            None
        }
        // the figure has its own title
        _ if inside_figure => None,
        Event::Html(raw) | Event::InlineHtml(raw) => Some(Event::Text(raw)),
        other => Some(other),
    });
    let mut body = String::new();
    pulldown_cmark::html::push_html(&mut body, events);
    let mut name = String::new();
    pulldown_cmark::html::push_html(&mut name, std::iter::once(Event::Text(CowStr::from(title))));
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>{name}</title>\n<style>{STYLE}</style>\n</head>\n<body>\n{body}</body>\n</html>\n"
    )
}
