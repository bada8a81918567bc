# mypy: ignore-errors
"""The kernel of Warp's adapter for any hit, apart from that for first hits: only later versions have its call."""

import warp as wp


@wp.kernel
def any_hit(
    mesh: wp.uint64,
    origins: wp.array(dtype=wp.vec3),
    directions: wp.array(dtype=wp.vec3),
    ends: wp.array(dtype=wp.float32),
    is_hit: wp.array(dtype=wp.int32),
):
    """One ray for each thread."""
    k = wp.tid()
    if wp.mesh_query_ray_anyhit(mesh, origins[k], directions[k], ends[k]):
        is_hit[k] = 1
