//! Labelled vectors of the navigator map as GeoJSON (RFC 7946, but in metres, not degrees) and as CSV (RFC 4180).

use serde_json::json;

/// Labelled vector, in global x and y, metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VectorOnMap {
    /// Start.
    pub from: [f64; 2],
    /// End.
    pub to: [f64; 2],
    /// Label: "obstacle", "unknown" or "visibility".
    pub label: &'static str,
}

/// `FeatureCollection` with one `LineString` per vector; `frame` is the frame of the map. The coordinates are metres of
/// the global frame, not degrees, because the ground has no place on a globe; the member `unit` says so.
///
/// ```
/// use raypencil_drive::{VectorOnMap, vectors_geojson};
///
/// let vectors = [VectorOnMap { from: [1.0, -0.5], to: [1.25, 0.0], label: "obstacle" }];
/// let json: serde_json::Value = serde_json::from_str(&vectors_geojson(&vectors, 30))?;
/// let feature = &json["features"][0];
/// // The vector as it is, in metres, and the frame that it is of.
/// assert_eq!(feature["geometry"]["coordinates"], serde_json::json!([[1.0, -0.5], [1.25, 0.0]]));
/// assert_eq!(feature["properties"]["frame"], 30);
/// # Ok::<(), serde_json::Error>(())
/// ```
pub fn vectors_geojson(vectors: &[VectorOnMap], frame: u64) -> String {
    let feature = |(index, vector): (usize, &VectorOnMap)| {
        json!({
            "type": "Feature",
            "geometry": { "type": "LineString", "coordinates": [vector.from, vector.to] },
            "properties": { "label": vector.label, "index": index, "frame": frame },
        })
    };
    let features: Vec<_> = vectors.iter().enumerate().map(feature).collect();
    let all = json!({
        "type": "FeatureCollection",
        "unit": "metres of the global frame: x, y",
        "features": features,
    });
    format!("{all:#}\n")
}

/// CSV text: a header with the units, then one line per vector.
pub fn vectors_csv(vectors: &[VectorOnMap]) -> String {
    let mut text = String::from("index,from_x_m,from_y_m,to_x_m,to_y_m,label\r\n");
    for (index, VectorOnMap { from, to, label }) in vectors.iter().enumerate() {
        text += &format!("{index},{},{},{},{},{label}\r\n", from[0], from[1], to[0], to[1]);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    const VECTORS: [VectorOnMap; 2] = [
        VectorOnMap { from: [1.0, -0.5], to: [1.25, 0.0], label: "obstacle" },
        VectorOnMap { from: [1.25, 0.0], to: [5.0, 0.5], label: "unknown" },
    ];

    #[test]
    fn every_vector_is_a_line_with_its_label() {
        let read: serde_json::Value = serde_json::from_str(&vectors_geojson(&VECTORS, 30)).unwrap();
        assert_eq!(read["type"], "FeatureCollection");
        let features = read["features"].as_array().unwrap();
        assert_eq!(features.len(), 2);
        assert_eq!(features[0]["geometry"]["type"], "LineString");
        assert_eq!(features[0]["geometry"]["coordinates"], json!([[1.0, -0.5], [1.25, 0.0]]));
        assert_eq!(features[1]["properties"], json!({ "label": "unknown", "index": 1, "frame": 30 }));
    }

    #[test]
    fn csv_has_names_and_units_in_its_first_line() {
        let text = vectors_csv(&VECTORS);
        let lines: Vec<&str> = text.split("\r\n").collect();
        assert_eq!(lines[0], "index,from_x_m,from_y_m,to_x_m,to_y_m,label");
        assert_eq!(lines[2], "1,1.25,0,5,0.5,unknown");
        assert_eq!(lines.len(), 4);
    }
}
