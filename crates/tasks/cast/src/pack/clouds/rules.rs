//! Which rule lays the points of a cloud on its rays, and which other rules a mistake may have followed.

use glam::DVec3;
use raypencil_mesh_io::Cloud;
use raypencil_scene::CastRay;

use super::assign::{Asked, Assigned, Order};
use super::keys::{Keys, Ring};
use crate::cloud::CloudFrame;
use crate::pack::scan::Scan;

/// What the number of a channel may stand for in place of what it should.
pub(super) fn rings(usual: Ring) -> Vec<(&'static str, Ring)> {
    if usual == Ring::Channel {
        return vec![
            (
                "the numbers of channels count elevations from below: they are in the order of the manual",
                Ring::FromBelow,
            ),
            (
                "the numbers of channels count elevations from above: they are in the order of the manual",
                Ring::FromAbove,
            ),
            ("the numbers of channels are in the opposite order of the manual", Ring::ChannelReversed),
        ];
    }
    let from_below =
        "the field ring counts channels from below: beside Ouster's field t its 0 is the highest";
    let others = [
        ("the field ring counts channels from above: its 0 is the lowest", Ring::FromAbove),
        (from_below, Ring::FromBelow),
        ("the field ring is the channel in the order of the manual: it counts elevations", Ring::Channel),
        (
            "the field ring counts channels in the opposite order of the manual: it counts elevations",
            Ring::ChannelReversed,
        ),
    ];
    others.into_iter().filter(|(_, ring)| *ring != usual).collect()
}

/// The other order of rows and columns, in words.
pub(super) fn swapped(right: Order) -> (&'static str, Order) {
    let words = match right.is_of_channels {
        true => {
            "points are in the order of the rays, channel by channel in each sequence: WIDTH and HEIGHT are swapped"
        }
        false => "points are in rows of one channel: WIDTH and HEIGHT are swapped",
    };
    (words, Order { is_of_channels: !right.is_of_channels, ..right })
}

/// Orders that run backwards, in words.
pub(super) fn backwards(right: Order) -> [(&'static str, Order); 3] {
    let back = |rows, points| Order { backwards: [rows, points], ..right };
    [
        ("rows of points run from the last to the first", back(true, false)),
        ("the points of each row run from the last to the first", back(false, true)),
        ("all points run from the last to the first", back(true, true)),
    ]
}

/// What the places of points say of their rays.
pub(super) struct Places<'a> {
    /// Each point on the ray that is nearest in angle; `None` where directions do not tell rays apart.
    pub(super) by_direction: &'a dyn Fn() -> Option<Assigned>,
    /// Angle between a ray and the way from its origin to a point, by the indices of the point and of the ray.
    pub(super) angle: &'a dyn Fn(usize, usize) -> f64,
}

/// The first rule that lays nearly all points on rays of their own, and the order if it is by order.
///
/// Points that are as many as the rays are in the order of the rays, if the cloud is organised or has places for rays without a hit.
/// Where channels and firing sequences have the same number, a row is that on whose rays most points lie nearer. A plain list of
/// points that all hit has no order to be held to: there the direction of the points tells their rays.
pub(super) fn assigned(
    asked: &Asked<'_>,
    cloud: &Cloud,
    is_point: &[bool],
    usual: Ring,
    places: Places<'_>,
) -> Option<(Assigned, Option<Order>)> {
    let real = is_point.iter().filter(|&&is_point| is_point).count();
    let clear = |assigned: &Assigned| assigned.is_clear(real);
    if let Some(found) = asked.by_keys(cloud, is_point, Keys::of(usual)).filter(clear) {
        return Some((found, None));
    }
    let of_rows = |is_of_channels: bool| {
        let order = Order { is_of_channels, ..Order::default() };
        Some((asked.by_order(cloud, is_point, order)?, order))
    };
    let of_order = match asked.has_rows_of_channels(cloud) {
        Some(is_of_channels) => of_rows(is_of_channels),
        None => of_rows(false).zip(of_rows(true)).map(|(rows, turned)| {
            let angles = |order: &Assigned| -> Vec<(usize, f64)> {
                let of = |(ray, point): (usize, &Option<usize>)| {
                    let point = point.filter(|&point| is_point[point])?;
                    Some((point, (places.angle)(point, ray)))
                };
                let mut angles: Vec<_> = order.point_of.iter().enumerate().filter_map(of).collect();
                angles.sort_by_key(|(point, _)| *point);
                angles
            };
            let (of_rows, of_turned) = (angles(&rows.0), angles(&turned.0));
            let pairs = || of_rows.iter().zip(&of_turned).map(|((_, a), (_, b))| a.total_cmp(b));
            let is_turned =
                pairs().filter(|order| order.is_gt()).count() > pairs().filter(|order| order.is_lt()).count();
            if is_turned { turned } else { rows }
        }),
    };
    let states_order = cloud.height > 1 || real < cloud.len();
    let Some((found, order)) = of_order else { return (places.by_direction)().map(|found| (found, None)) };
    let is_otherwise = |directed: &Assigned| clear(directed) && !found.is_like(directed, real);
    match (!states_order).then(places.by_direction).flatten().filter(is_otherwise) {
        Some(directed) => Some((directed, None)),
        None => Some((found, Some(order))),
    }
}

/// The points on the rays that are nearest in angle; `None` where a direction does not tell rays apart.
pub(super) fn by_direction(
    asked: &Asked<'_>,
    rays: &[CastRay],
    (points, cloud, is_point): (&[DVec3], &Cloud, &[bool]),
    frame: CloudFrame,
) -> Option<Assigned> {
    // A direction tells rays apart in the sensor's own frame. Of one that moves, points in another frame have lost it.
    let is_moving = asked.scan.is_some_and(Scan::is_moving);
    if is_moving && frame != CloudFrame::Sensor {
        return None;
    }
    let of_sensor = |(index, ray): (usize, &CastRay)| {
        let ray = asked.scan.map_or(*ray, |scan| scan.in_pattern(index, ray));
        (ray.origin, ray.direction.normalize())
    };
    let rays: Vec<(DVec3, DVec3)> = rays.iter().enumerate().map(of_sensor).collect();
    // A sensor that stands still has one pose for all points.
    let to_sensor =
        asked.scan.filter(|_| frame == CloudFrame::Mesh).map(|scan| scan.mounting.first().inverse());
    let points: Vec<DVec3> =
        points.iter().map(|&point| to_sensor.map_or(point, |pose| pose * point)).collect();
    Some(asked.by_direction(&rays, &points, (cloud, is_point)))
}
