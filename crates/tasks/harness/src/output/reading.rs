//! What the words of a page mean.

/// A paragraph each.
pub(super) const HOW_TO_READ: [&str; 7] = [
    "A rover's camera and laser beams look at a terrain. Each camera pixel and each ray pencil of a beam is one ray. Every \
     renderer computes, by an algorithm of its own, where each ray first meets the terrain; this page compares their answers \
     ray by ray. No ray is skipped, and no wrong hit or miss is tolerated.",
    "Range is the distance along the ray, not depth. Depth is the distance along the sensor's axis. Point, normal and \
     incidence (the cosine between ray and normal) belong to the face that is hit. Values exist only where both sides hit, \
     so their counts are smaller than the count of hit/miss.",
    "Visible is whether the camera sees a pencil's hit, pixel where it lands on the image. cos(phi) and cos(theta) are the \
     cosines between the camera's axis, the direction to the point and the face's normal. A pencil's flux is the light of \
     that pencil that the camera receives; a pixel's flux is the sum over its pencils, and is judged by them.",
    "Agree: both sides hit the same face, or neither hits, and each value differs by no more than its bound. The bound is \
     not a chosen tolerance: it is derived for each ray from the rounding errors of both sides' arithmetic and from the \
     shape of the face. A worst error / bound of 1 would just pass.",
    "Tie: the ray meets several faces at exactly the same point, as on the edge between two triangles, and each side names \
     one of them. Both are right. Rounding: an answer is not exact, but it is the exact answer of a ray that is displaced by \
     no more than the renderer's rounding errors; the referee has found that ray. Approximation: one side makes an error of \
     the paper. The same algorithm without the named approximations gives an exact answer, and the referee confirms that \
     they lose or add the faces in question. Defect: anything else. The referee, in exact arithmetic, rules on every ray \
     whose answers differ and on a sample of those that agree. A ray counts under the worst of its quantities.",
    "Difference maps show the second range minus the first. Blue is nearer, red is farther, near white is no difference. The \
     scale is symmetric and ends at the largest difference of that map, so strong colours alone mean nothing: read the \
     numbers on the bar. Colours have even steps of the square root of the difference, so that small differences are visible \
     beside large ones.",
    "Each raypencil probe command prints every renderer's complete answer to that ray.",
];
