//! The file of visual features: a NumPy array.

use std::io::{BufReader, Read};

use coin_schemas::episode::{EpisodeObject, FEATURE_DIMENSIONS};
use npyz::{DType, NpyHeader, Order};

use super::error::EpisodeError;
use super::files::{Folder, unreadable};
use super::{EPISODE_FILE, Feature};

const COMPONENT_BYTES: usize = size_of::<f32>();
const ROW_BYTES: usize = FEATURE_DIMENSIONS * COMPONENT_BYTES;

/// Reads one row for each object.
pub(super) fn read(
    folder: &Folder,
    name: &str,
    objects: &[EpisodeObject],
) -> Result<Vec<Feature>, EpisodeError> {
    let mut file = BufReader::new(folder.file(name)?);
    let header = NpyHeader::from_reader(&mut file)
        .map_err(|source| EpisodeError::in_file(name, format!("this is no NumPy file ({source})")))?;
    check_header(name, &header, objects.len())?;
    let mut features = Vec::with_capacity(objects.len());
    for (row, object) in objects.iter().enumerate() {
        let feature = read_row(&mut file).map_err(|source| match source.kind() {
            std::io::ErrorKind::UnexpectedEof => EpisodeError::in_file(
                name,
                format!(
                    "the file ends in row {row}; its header promises {} rows of {FEATURE_DIMENSIONS}",
                    objects.len()
                ),
            ),
            _ => unreadable(name, &source),
        })?;
        if let Some(column) = feature.iter().position(|component| !component.is_finite()) {
            return Err(EpisodeError::at_key(
                name,
                format!("[{row}, {column}]"),
                format!(
                    "{} is no finite number; it belongs to object {:?} of {EPISODE_FILE}",
                    feature[column],
                    object.id.as_str()
                ),
            ));
        }
        features.push(feature);
    }
    if file.read(&mut [0]).map_err(|source| unreadable(name, &source))? > 0 {
        return Err(EpisodeError::in_file(
            name,
            format!("more bytes follow the {} rows that the header promises", objects.len()),
        ));
    }
    Ok(features)
}

fn check_header(name: &str, header: &NpyHeader, objects: usize) -> Result<(), EpisodeError> {
    let kind = header.dtype();
    if !matches!(&kind, DType::Plain(plain) if plain.to_string() == "<f4") {
        return Err(EpisodeError::at_key(
            name,
            "descr",
            format!(
                "the numbers are {}; expected '<f4' (little-endian float32): array.astype('<f4')",
                kind.descr()
            ),
        ));
    }
    if header.order() == Order::Fortran && header.shape().len() > 1 {
        return Err(EpisodeError::at_key(
            name,
            "fortran_order",
            "the array is in Fortran order; expected C order: numpy.ascontiguousarray(array)",
        ));
    }
    let expected = [objects as u64, FEATURE_DIMENSIONS as u64];
    if header.shape() != expected {
        return Err(EpisodeError::at_key(
            name,
            "shape",
            format!(
                "the array has shape {:?}; expected {expected:?}: one row of {FEATURE_DIMENSIONS} for each of the {objects} objects of {EPISODE_FILE}",
                header.shape()
            ),
        ));
    }
    Ok(())
}

fn read_row(file: &mut impl Read) -> std::io::Result<Feature> {
    let mut bytes = [0; ROW_BYTES];
    file.read_exact(&mut bytes)?;
    let mut feature = [0.0; FEATURE_DIMENSIONS];
    for (component, bytes) in feature.iter_mut().zip(bytes.as_chunks::<COMPONENT_BYTES>().0) {
        *component = f32::from_le_bytes(*bytes);
    }
    Ok(feature)
}
