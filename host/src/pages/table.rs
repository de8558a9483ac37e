//! A table that is the same on a page and in Markdown.

use maud::{Markup, html};

/// A cell.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Cell {
    /// What stands there.
    pub text: String,
    /// Whether it stands out, as the best of its column.
    pub emphasised: bool,
}

/// A table; the first cell of a row names it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Table {
    /// What it shows.
    pub title: String,
    /// How to read it.
    pub note: String,
    /// The names of the columns.
    pub header: Vec<String>,
    /// The rows, each as long as the header.
    pub rows: Vec<Vec<Cell>>,
}

impl Table {
    /// The table in GitHub's Markdown, its columns aligned for whoever reads the source.
    pub fn to_markdown(&self) -> String {
        let escaped = |text: &str| text.replace('\\', "\\\\").replace('|', "\\|").replace(['\n', '\r'], " ");
        let cell = |cell: &Cell| match cell.emphasised {
            true => format!("**{}**", escaped(&cell.text)),
            false => escaped(&cell.text),
        };
        let header: Vec<String> = self.header.iter().map(|name| escaped(name)).collect();
        let rows: Vec<Vec<String>> = self.rows.iter().map(|row| row.iter().map(cell).collect()).collect();
        let width = |column: usize| {
            let cells = rows.iter().filter_map(|row| row.get(column)).chain(header.get(column));
            cells.map(|text| text.chars().count()).max().unwrap_or(0).max(3)
        };
        let widths: Vec<usize> = (0..header.len()).map(width).collect();
        let line = |cells: &[String]| {
            let padded = cells.iter().zip(&widths).map(|(text, &width)| format!(" {text:<width$} |"));
            format!("|{}\n", padded.collect::<String>())
        };
        let rule: String = widths.iter().map(|width| format!(" {} |", "-".repeat(*width))).collect();
        let body: String = rows.iter().map(|row| line(row)).collect();
        format!("## {}\n\n{}|{rule}\n{body}\n{}\n", self.title, line(&header), self.note)
    }

    /// The table on a page.
    pub fn to_html(&self) -> Markup {
        html! {
            h3 { (self.title) }
            // A box that scrolls must be reachable by keyboard.
            div.scroll role="region" aria-label=(self.title) tabindex="0" {
                table {
                    thead { tr { @for name in &self.header { th scope="col" { (name) } } } }
                    tbody {
                        @for row in &self.rows {
                            tr {
                                @for (place, cell) in row.iter().enumerate() {
                                    @if place == 0 { th scope="row" { (cell.text) } }
                                    @else if cell.emphasised { td { strong { (cell.text) } } }
                                    @else { td { (cell.text) } }
                                }
                            }
                        }
                    }
                }
            }
            p.note { (self.note) }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table() -> Table {
        let cell = |text: &str, emphasised| Cell { text: text.to_owned(), emphasised };
        Table {
            title: "Figures".to_owned(),
            note: "Read it <so>.".to_owned(),
            header: vec!["Method".to_owned(), "Accuracy".to_owned()],
            rows: vec![
                vec![cell("a|b", false), cell("1.000", true)],
                vec![cell("<script>", false), cell("0.5", false)],
            ],
        }
    }

    #[test]
    fn markdown_is_aligned_and_escaped() {
        insta::assert_snapshot!(table().to_markdown(), @r"
        ## Figures

        | Method   | Accuracy  |
        | -------- | --------- |
        | a\|b     | **1.000** |
        | <script> | 0.5       |

        Read it <so>.
        ");
    }

    #[test]
    fn html_lets_no_markup_through() {
        let html = table().to_html().into_string();
        assert!(html.contains("&lt;script&gt;") && !html.contains("<script>"), "{html}");
        assert!(html.contains("<strong>1.000</strong>"));
    }
}
