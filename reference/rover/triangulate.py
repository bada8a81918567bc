"""Points of the edge planes: the section "Triangulation" of docs/theory/rover.md."""

import numpy as np

from geometry import Pose


class Rig:
    """Camera and beams in the vehicle's frame; `panned` gives those of one position of a scan."""

    def __init__(self, setup):
        self.camera, self.beams = setup["camera"], setup["beams"]
        self.camera_pose = Pose.read(self.camera["vehicle_from_sensor"])
        self.beam_poses = [Pose.read(beam["vehicle_from_sensor"]) for beam in self.beams]

    def panned(self, angle, with_camera):
        other = object.__new__(Rig)
        other.camera, other.beams = self.camera, self.beams
        other.camera_pose = self.camera_pose.panned(angle) if with_camera else self.camera_pose
        other.beam_poses = [pose.panned(angle) for pose in self.beam_poses]
        return other

    def points(self, beam, column, row, in_the_middle):
        """Points in the vehicle's frame that the camera sees at (column + 1/2, row), and which of them are accepted.

        `in_the_middle`: the centroid of the light belongs to the middle plane of the sheet, not to its lower edge.
        """
        camera, laser = self.camera, self.beams[beam]
        f = camera["focal_length"]
        pitch, centre = camera["pixel_pitch"], camera["principal_point"]
        ray = np.column_stack([(column + 0.5 - centre[0]) * pitch[0] / f, (row - centre[1]) * pitch[1] / f,
                               np.ones(len(row))])  # in the camera's frame, for a depth of 1 m
        pose = self.beam_poses[beam]
        origin = pose.undo(self.camera_pose.position)
        direction = ray @ self.camera_pose.rotation.T @ pose.rotation
        plane = 0.0 if in_the_middle else laser["thickness"] / 2
        with np.errstate(divide="ignore", invalid="ignore"):
            depth = (plane - origin[1]) / direction[:, 1]
        depth = np.where(np.isfinite(depth), depth, -1.0)
        in_beam = origin + depth[:, None] * direction
        in_camera = depth[:, None] * ray
        in_vehicle = self.camera_pose.apply(in_camera)
        # "in the fan and in range, each within a pixel's size": the size of a pixel at that depth.
        size = depth * max(pitch) / f
        x, z = in_beam[:, 0], in_beam[:, 2]
        reach = laser["half_width"] / laser["grid_distance"]
        ok = (depth > f) & (z > 0) & (np.abs(x) <= reach * z + size)
        ok &= np.linalg.norm(in_beam, axis=1) <= laser["max_range"] + size
        ok &= np.linalg.norm(in_camera, axis=1) <= camera["max_range"] + size
        return in_vehicle, ok

    def height_error(self, beam, column, row, rows, in_the_middle):
        """How much z of the point changes, in the vehicle frame, if its row is off by `rows`: the larger of both ways."""
        middle, _ = self.points(beam, column, row, in_the_middle)
        largest = np.zeros(len(column))
        for off in (-rows, rows):
            place, ok = self.points(beam, column, row + off, in_the_middle)
            change = np.abs(place[:, 2] - middle[:, 2])
            # Past the end of the fan's range there is no point: the other way says as much.
            largest = np.where(ok, np.maximum(largest, np.where(ok, change, 0)), largest)
        return largest
