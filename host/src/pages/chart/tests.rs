//! Whatever is drawn is well-formed, finite and within its frame.

use proptest::collection::vec;
use proptest::prelude::*;

use super::*;

/// The values of an attribute wherever it stands.
fn attributes<'a>(svg: &'a str, name: &str) -> Vec<&'a str> {
    let key = format!(" {name}=\"");
    svg.split(key.as_str()).skip(1).filter_map(|rest| rest.split('"').next()).collect()
}

/// Every coordinate is a number within the frame; what stands before text may lie at its edge.
fn assert_sound(markup: Markup) -> Result<(), TestCaseError> {
    let svg = markup.into_string();
    let parsed = roxmltree::Document::parse(&svg);
    prop_assert!(parsed.is_ok(), "{parsed:?} in {svg}");
    let frame =
        attributes(&svg, "viewBox")[0].split(' ').map(|n| n.parse::<f64>().unwrap()).collect::<Vec<_>>();
    for (names, limit) in [(["x", "x1", "x2", "cx"], frame[2]), (["y", "y1", "y2", "cy"], frame[3])] {
        for value in names.iter().flat_map(|name| attributes(&svg, name)) {
            let number: f64 = value.parse().unwrap();
            prop_assert!((0.0..=limit).contains(&number), "{value} lies outside 0 … {limit}");
        }
    }
    for data in attributes(&svg, "d") {
        prop_assert!(!data.contains("NaN") && !data.contains("inf"), "{data}");
    }
    Ok(())
}

fn any_value() -> impl Strategy<Value = f64> {
    prop_oneof![0.0..=1.0_f64, Just(0.0), Just(1.0), Just(f64::NAN), Just(f64::INFINITY)]
}

fn any_series() -> impl Strategy<Value = Series> {
    let shape = prop_oneof![Just(Shape::Line), Just(Shape::Steps), Just(Shape::Level)];
    (
        ".{0,12}",
        0..9_usize,
        shape,
        vec((any_value(), any_value()), 0..20),
        vec((0.0..40.0_f64, 0.0..=1.0_f64), 0..3),
    )
        .prop_map(|(name, look, shape, values, strokes)| Series {
            name: name.chars().filter(|letter| !letter.is_control()).collect(),
            look: Look(look),
            shape,
            points: values
                .into_iter()
                .enumerate()
                .map(|(step, (y, spread))| Point { x: step as f64, y, spread })
                .collect(),
            strokes,
        })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn curves_are_sound(series in vec(any_series(), 0..5), lowest in 0.0..0.9_f64) {
        assert_sound(LineChart {
            title: "Curves <&>\"".to_owned(),
            description: "…".to_owned(),
            x_label: "questions".to_owned(),
            y_label: "accuracy".to_owned(),
            lowest,
            series: series.clone(),
        }.svg())?;
        let dots = vec![Dot { name: "a".to_owned(), look: Look(1), x: 3.0, y: lowest }];
        assert_sound(ScatterChart {
            title: "Points".to_owned(),
            description: "…".to_owned(),
            x_label: "questions".to_owned(),
            y_label: "accuracy".to_owned(),
            lowest,
            dots,
            paths: series,
        }.svg())?;
    }

    #[test]
    fn bars_and_intervals_are_sound(values in vec((any_value(), any_value()), 0..6)) {
        let bars = values.iter().map(|&(value, spread)| Bar {
            name: "bar".to_owned(),
            look: Look(2),
            value,
            spread,
            label: "0".to_owned(),
        });
        assert_sound(BarChart {
            title: "Bars".to_owned(),
            description: "…".to_owned(),
            label: "share".to_owned(),
            highest: 1.0,
            groups: vec![BarGroup { name: "group".to_owned(), bars: bars.collect() }],
        }.svg())?;
        let rows = values.iter().filter(|(low, high)| low.is_finite() && high.is_finite()).map(|&(low, high)| Interval {
            name: "row".to_owned(),
            share: (low + high) / 2.0,
            low: low.min(high),
            high: low.max(high),
            promised: 0.8,
        });
        assert_sound(IntervalChart {
            title: "Intervals".to_owned(),
            description: "…".to_owned(),
            label: "share".to_owned(),
            rows: rows.collect(),
        }.svg())?;
    }
}

#[test]
fn ticks_are_round() {
    let texts = |low, high| ticks(low, high).into_iter().map(|(_, text)| text).collect::<Vec<_>>();
    assert_eq!(texts(0.0, 1.0), ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
    assert_eq!(texts(0.0, 34.0), ["0", "10", "20", "30"]);
    assert_eq!(texts(0.7, 1.0), ["0.7", "0.8", "0.9", "1.0"]);
    assert_eq!(texts(0.0, 1.0e6), ["0", "200000", "400000", "600000", "800000", "1000000"]);
    assert_eq!(texts(2.0, 2.0), ["2"]);
    let fine = ticks(0.961, 1.0);
    assert!(fine.iter().all(|(value, text)| (text.parse::<f64>().unwrap() - value).abs() < 1e-9), "{fine:?}");
}

#[test]
fn names_let_no_markup_through() {
    let series = Series {
        name: "<script>alert(1)</script>".to_owned(),
        look: Look(0),
        shape: Shape::Line,
        points: Vec::new(),
        strokes: Vec::new(),
    };
    let chart = LineChart {
        title: "\"><script>".to_owned(),
        description: String::new(),
        x_label: String::new(),
        y_label: String::new(),
        lowest: 0.0,
        series: vec![series],
    };
    assert!(!chart.svg().into_string().contains("<script"));
}
