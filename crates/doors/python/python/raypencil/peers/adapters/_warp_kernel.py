# mypy: ignore-errors
"""The kernel of Warp's adapter. Warp reads its source and its annotations, so it stands alone and has no future import."""

import warp as wp


@wp.kernel
def first(
    mesh: wp.uint64,
    origins: wp.array(dtype=wp.vec3),
    directions: wp.array(dtype=wp.vec3),
    ends: wp.array(dtype=wp.float32),
    face: wp.array(dtype=wp.int32),
    t: wp.array(dtype=wp.float32),
):
    """One ray for each thread."""
    k = wp.tid()
    query = wp.mesh_query_ray(mesh, origins[k], directions[k], ends[k])
    if query.result:
        face[k] = query.face
        t[k] = query.t
