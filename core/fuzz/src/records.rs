//! Records as the host hands them over, drawn by a table of their fields and read through the same door as the host's.

use std::any::type_name;
use std::collections::HashMap;
use std::sync::{LazyLock, Mutex, PoisonError};

use ciborium::Value;
use serde::de::DeserializeOwned;

use crate::draw::Draw;

/// What a field holds.
#[derive(Clone, Copy, Debug)]
pub enum Kind {
    /// A number.
    Number,
    /// So many numbers.
    Numbers(usize),
    /// Up to so many numbers.
    Row(usize),
    /// So many rows of so many numbers.
    Rows(usize, usize),
    /// A table of up to so many rows of four numbers.
    Table(usize),
    /// Rows of a transform.
    Matrix,
    /// True or false.
    Flag,
    /// A whole number below this.
    Below(u32),
    /// A whole number below this, or any of 32 bits.
    Whole(u32),
    /// Any whole number of 32 bits, negative ones too.
    Signed,
    /// A variant of an enum.
    Word(fn() -> &'static [String]),
    /// A register of a program.
    Register,
    /// Up to so many registers.
    Registers(usize),
    /// A texture.
    Texture,
    /// One of several records, told apart by a tag.
    One(&'static str, &'static [(&'static str, Fields)]),
    /// A record.
    Record(Fields),
    /// Up to so many records.
    List(usize, Fields),
    /// A record, or none.
    Maybe(Fields),
    /// A whole number below this, or none.
    MaybeWhole(u32),
    /// A short name.
    Name,
}

/// Names and contents of a record's fields.
pub type Fields = &'static [(&'static str, Kind)];

/// What indices refer to.
#[derive(Clone, Copy, Debug, Default)]
pub struct Known {
    /// Instructions before this one.
    pub registers: usize,
    /// Textures of the scene.
    pub textures: usize,
}

/// The names of an enum's variants, as serde knows them.
///
/// # Panics
/// It is no enum of two names or more.
pub fn words<T: DeserializeOwned>() -> &'static [String] {
    static FOUND: LazyLock<Mutex<HashMap<&str, &[String]>>> = LazyLock::new(Mutex::default);
    let mut found = FOUND.lock().unwrap_or_else(PoisonError::into_inner);
    found.entry(type_name::<T>()).or_insert_with(|| {
        let refused = Value::from("").deserialized::<T>().err().map(|error| error.to_string());
        let names: Vec<_> = refused.iter().flat_map(|text| text.split('`').skip(3).step_by(2)).collect();
        assert!(names.len() > 1, "{} is no enum of names: {refused:?}", type_name::<T>());
        names.into_iter().map(str::to_owned).collect::<Vec<_>>().leak()
    })
}

/// Reads a drawn record.
///
/// # Panics
/// The table of its fields is not that of the renderer any more.
pub fn read<T: DeserializeOwned>(value: &Value) -> T {
    value.deserialized().unwrap_or_else(|fault| panic!("the table of {} is old: {fault}", type_name::<T>()))
}

/// A record of these fields.
pub fn record(draw: &mut Draw<'_>, fields: Fields, known: Known) -> Value {
    Value::Map(entries(draw, fields, known))
}

fn entries(draw: &mut Draw<'_>, fields: Fields, known: Known) -> Vec<(Value, Value)> {
    fields.iter().map(|&(name, kind)| (name.into(), value(draw, kind, known))).collect()
}

/// What a field of this kind holds.
pub fn value(draw: &mut Draw<'_>, kind: Kind, known: Known) -> Value {
    match kind {
        Kind::Number => Value::Float(draw.number()),
        Kind::Numbers(count) => numbers(draw, count),
        Kind::Row(most) => {
            let count = draw.below(most + 1);
            numbers(draw, count)
        }
        Kind::Rows(rows, columns) => Value::Array((0..rows).map(|_| numbers(draw, columns)).collect()),
        Kind::Table(most) => Value::Array(draw.list(most, |draw| numbers(draw, 4))),
        Kind::Matrix => matrix(draw),
        Kind::Flag => draw.flag().into(),
        Kind::Below(count) => Value::from(draw.below(count as usize) as u64),
        Kind::Whole(count) => whole(draw, count),
        Kind::Signed if draw.flag() => Value::from(i32::from_le_bytes(draw.bytes())),
        Kind::Signed => Value::from(i8::from_le_bytes(draw.bytes())),
        Kind::Word(words) => draw.choice(words()).as_str().into(),
        Kind::Register => index(draw, known.registers),
        Kind::Registers(most) => Value::Array(draw.list(most, |draw| index(draw, known.registers))),
        Kind::Texture => index(draw, known.textures),
        Kind::One(tag, variants) => {
            let &(name, fields) = draw.choice(variants);
            let mut all = vec![(tag.into(), name.into())];
            all.extend(entries(draw, fields, known));
            Value::Map(all)
        }
        Kind::Record(fields) => record(draw, fields, known),
        Kind::List(most, fields) => Value::Array(draw.list(most, |draw| record(draw, fields, known))),
        Kind::Maybe(fields) if draw.flag() => record(draw, fields, known),
        Kind::MaybeWhole(count) if draw.flag() => whole(draw, count),
        Kind::Maybe(_) | Kind::MaybeWhole(_) => Value::Null,
        Kind::Name => ["", "Name", "Ünder 'line'\n"][draw.below(3)].into(),
    }
}

fn numbers(draw: &mut Draw<'_>, count: usize) -> Value {
    Value::Array((0..count).map(|_| Value::Float(draw.number())).collect())
}

fn index(draw: &mut Draw<'_>, count: usize) -> Value {
    Value::from(draw.index(count) as u64)
}

fn whole(draw: &mut Draw<'_>, count: u32) -> Value {
    let any = |draw: &mut Draw<'_>| u32::from_le_bytes(draw.bytes());
    Value::from(if draw.byte() < 240 { u32::from(draw.byte()) % count } else { any(draw) })
}

/// Rows of a transform: nothing, a place and a size, or anything.
fn matrix(draw: &mut Draw<'_>) -> Value {
    let kind = draw.below(4);
    let rows = (0..4).map(|row| {
        let number = |column: usize, draw: &mut Draw<'_>| match kind {
            1 if column == 3 && row < 3 => draw.number(),
            2 if column == row && row < 3 || column == 3 && row < 3 => draw.number(),
            3 => draw.number(),
            _ => f64::from(u8::from(row == column)),
        };
        Value::Array((0..4).map(|column| Value::Float(number(column, draw))).collect())
    });
    Value::Array(rows.collect())
}
