//! Settings of any shape are refused with a message, or every one of them is in its range and means what it says.
#![no_main]

use libfuzzer_sys::fuzz_target;
use rgp_fuzz::draw::Draw;
use rgp_fuzz::scenes::scene;
use rgp_renderer::film::Film;
use rgp_renderer::render::check_memory;
use rgp_renderer::settings::{KNOBS, Kind, Knob, RenderSettings, parse_bins};
use serde_json::{Map, Value, json};

const WORDS: &[&str] =
    &["", "auto", "ON", "8x16", "32x64", "33x1", "0x0", "-1x1", "+1x1", "1x1x1", "x", "54", "１x１"];

fuzz_target!(|bytes: &[u8]| {
    let mut draw = Draw(bytes);
    let mut groups = Map::new();
    for _ in 0..draw.below(8) {
        let knob = draw.choice(KNOBS);
        let group = if draw.byte() < 250 { knob.group } else { *draw.choice(&["", "gather", "Film"]) };
        let name = if draw.byte() < 250 { knob.name } else { *draw.choice(&["", "rays", "seed "]) };
        let value = value(&mut draw, knob);
        match groups.entry(group).or_insert_with(|| json!({})) {
            Value::Object(names) if draw.byte() < 250 => drop(names.insert(name.into(), value)),
            whole => *whole = value,
        }
    }
    let Ok(settings) = RenderSettings::from_json(&Value::Object(groups)) else { return };
    let accepted = serde_json::to_value(&settings).expect("settings can be written");
    for knob in KNOBS {
        assert!(
            is_allowed(knob, &accepted[knob.group][knob.name]),
            "{}.{} in {accepted}",
            knob.group,
            knob.name
        );
    }
    assert_eq!(RenderSettings::from_json(&accepted).expect("what was accepted is accepted again"), settings);
    let film = Film::new(3, 2, &settings.film);
    assert_eq!(film.combined().len(), 3 * 2 * 4);
    if let Ok(scene) = scene(&mut draw) {
        let _ = check_memory(&scene, &settings);
    }
});

/// A value in the knob's range or about its edges, or anything.
fn value(draw: &mut Draw<'_>, knob: &Knob) -> Value {
    match (draw.below(4), knob.kind) {
        (0 | 1, Kind::Int { minimum, maximum }) => {
            let near = i8::from_le_bytes(draw.bytes());
            json!(draw.choice(&[minimum, maximum, 1]).saturating_add_signed(near.into()))
        }
        (0 | 1, Kind::Float { minimum, maximum }) => json!(minimum + (maximum - minimum) * draw.number()),
        (0, Kind::Enum { choices }) => json!(draw.choice(choices)),
        (0 | 1, Kind::Bins) => json!(format!("{}x{}", draw.below(40), draw.below(70))),
        (2, _) => anything(draw, 3),
        _ => json!(draw.choice(WORDS)),
    }
}

fn anything(draw: &mut Draw<'_>, depth: usize) -> Value {
    match draw.below(if depth > 0 { 8 } else { 6 }) {
        0 => json!(draw.number()),
        1 => json!(u64::from_le_bytes(draw.bytes())),
        2 => json!(i64::from_le_bytes(draw.bytes())),
        3 => json!(draw.choice(WORDS)),
        4 => json!(draw.flag()),
        5 => Value::Null,
        6 => Value::Array(draw.list(3, |draw| anything(draw, depth - 1))),
        _ => Value::Object(
            draw.list(3, |draw| ((*draw.choice(WORDS)).into(), anything(draw, depth - 1)))
                .into_iter()
                .collect(),
        ),
    }
}

fn is_allowed(knob: &Knob, value: &Value) -> bool {
    match knob.kind {
        Kind::Int { minimum, maximum } => value.as_u64().is_some_and(|v| (minimum..=maximum).contains(&v)),
        // Kept as f32 or f64: the edge of a range rounds.
        Kind::Float { minimum, maximum } => {
            let slack = f64::from(f32::EPSILON) * maximum;
            value.as_f64().is_some_and(|v| (minimum - slack..=maximum + slack).contains(&v))
        }
        Kind::Enum { choices } => value.as_str().is_some_and(|v| choices.contains(&v)),
        Kind::Bins => value.as_str().is_some_and(|v| parse_bins(v).is_ok()),
    }
}
