//! What lies around a thing, found by the index of places without reading all things.

use coin::space::Neighbourhood;
use coin_schemas::household::Position;

use super::map::{ObjectKey, StoredObject};
use super::{Reader, StoreError};

/// Up to so many things, reading all of them is as quick as searching the index.
const FEW: u32 = 256;

/// The radius that is searched first where many things are within reach, in metres.
const FIRST_RADIUS: f64 = 0.1;

/// Where no neighbours are found so far away, in metres, all things are looked at.
const FAR: f64 = 1e5;

/// Where the index has things that are farther from the origin, in metres; see `05-indexes.sql`.
const EDGE: f64 = 3e38;

/// A thing as the index knows it, and between which distances it is.
struct Place {
    object: ObjectKey,
    least: f64,
    greatest: f64,
}

impl Reader<'_> {
    /// Whether there are so few things that it is quickest to read all of them.
    ///
    /// # Errors
    /// Failures of the database.
    pub(crate) fn has_few_objects(&self) -> Result<bool, StoreError> {
        let mut statement =
            self.connection.prepare_cached("SELECT EXISTS (SELECT 1 FROM objects LIMIT 1 OFFSET ?1)")?;
        let has_more: bool = statement.query_row([FEW], |row| row.get(0))?;
        Ok(!has_more)
    }

    /// Other things among which the neighbours of a thing certainly are, by id.
    ///
    /// # Errors
    /// Failures of the database.
    pub(crate) fn around(
        &self,
        object: &StoredObject,
        reach: &Neighbourhood,
    ) -> Result<Vec<StoredObject>, StoreError> {
        let limit = reach.radius();
        let mut radius = limit.min(FIRST_RADIUS);
        loop {
            let mut places = self.places_within(object, radius, reach.gamma.abs())?;
            let certain = places.iter().filter(|place| place.greatest <= radius).count();
            if certain >= reach.k || radius >= limit {
                keep_nearest(&mut places, reach.k);
                let mut objects = places
                    .into_iter()
                    .map(|place| self.stored(place.object))
                    .collect::<Result<Vec<_>, StoreError>>()?;
                objects.sort_by(|left, right| left.id.cmp(&right.id));
                return Ok(objects);
            }
            radius = if radius < FAR { (2.0 * radius).min(limit) } else { limit };
        }
    }

    /// All other things that are at most so far away, and some more.
    fn places_within(
        &self,
        object: &StoredObject,
        radius: f64,
        gamma: f64,
    ) -> Result<Vec<Place>, StoreError> {
        let bounds = Bounds::around(object.position, radius, gamma);
        let mut statement = self.connection.prepare_cached(
            "SELECT object_key, least_x, greatest_x, least_y, greatest_y, least_z, greatest_z FROM places
             WHERE greatest_x >= ?1 AND least_x <= ?2 AND greatest_y >= ?3 AND least_y <= ?4
                 AND greatest_z >= ?5 AND least_z <= ?6",
        )?;
        let [(west, east), (south, north), (down, up)] = bounds.axes;
        let mut rows = statement.query((west, east, south, north, down, up))?;
        let mut places = Vec::new();
        while let Some(row) = rows.next()? {
            let key = ObjectKey(row.get(0)?);
            if key == object.key {
                continue;
            }
            let axes = [(row.get(1)?, row.get(2)?), (row.get(3)?, row.get(4)?), (row.get(5)?, row.get(6)?)];
            let (least, greatest) = distances(object.position, &Bounds { axes }, gamma);
            places.push(Place { object: key, least, greatest });
        }
        Ok(places)
    }
}

/// A box: the least and the greatest coordinate on each axis.
struct Bounds {
    axes: [(f64, f64); 3],
}

impl Bounds {
    /// What holds everything that is at most so far away, the vertical axis scaled by γ.
    fn around(centre: Position, radius: f64, gamma: f64) -> Self {
        let [x, y, z] = centre.metres();
        let axis = |coordinate: f64, extent: f64| {
            // Distances and the ends of the box are rounded; the box is a little larger than that.
            let extent = extent * (1.0 + 1e-9) + coordinate.abs() * 1e-15;
            ((coordinate - extent).clamp(-EDGE, EDGE), (coordinate + extent).clamp(-EDGE, EDGE))
        };
        // Without a γ, height does not count.
        let height = if gamma > 0.0 { radius / gamma } else { f64::INFINITY };
        Self { axes: [axis(x, radius), axis(y, radius), axis(z, height)] }
    }
}

/// Between which distances from a position something in a box is.
fn distances(from: Position, bounds: &Bounds, gamma: f64) -> (f64, f64) {
    let mut squares = (0.0, 0.0);
    let mut at_the_edge = false;
    let scales = [1.0, 1.0, gamma];
    for ((coordinate, (least, greatest)), scale) in from.metres().into_iter().zip(bounds.axes).zip(scales) {
        at_the_edge |= coordinate.abs() > EDGE || least <= -EDGE || greatest >= EDGE;
        // Moving both to the edge of the index brings them no farther apart.
        let coordinate = coordinate.clamp(-EDGE, EDGE);
        let nearest = scale * (least - coordinate).max(coordinate - greatest).max(0.0);
        let farthest = scale * (greatest - coordinate).max(coordinate - least);
        squares = (squares.0 + nearest * nearest, squares.1 + farthest * farthest);
    }
    let greatest = if at_the_edge { f64::INFINITY } else { squares.1.sqrt() };
    (squares.0.sqrt(), greatest)
}

/// Leaves those that may be among the `k` nearest.
fn keep_nearest(places: &mut Vec<Place>, k: usize) {
    if k == 0 {
        places.clear();
    } else if places.len() > k {
        let by_greatest = |left: &Place, right: &Place| left.greatest.total_cmp(&right.greatest);
        let (_, last, _) = places.select_nth_unstable_by(k - 1, by_greatest);
        // Distances are rounded, and weights too: what is hardly farther may still weigh as much.
        let farthest = last.greatest * (1.0 + 1e-6) + 1e-9;
        places.retain(|place| place.least <= farthest);
    }
}
