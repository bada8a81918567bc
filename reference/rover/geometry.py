"""Rotations and poses, after the section "Frames of reference" of docs/formats/recording.md."""

import numpy as np


def rotation_of_quaternion(q):
    """Matrix of the unit quaternion x, y, z, w: it turns vectors of B into vectors of A."""
    x, y, z, w = q
    return np.array([
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ])


def rotation_about_y(angle):
    """Turns x ahead towards z down: with y to the left a positive angle lowers the nose."""
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])


def attitude(heading, pitch_down, roll_right):
    """R = R_z(heading) R_y(pitch_down) R_x(roll_right)."""
    c, s = np.cos(heading), np.sin(heading)
    about_z = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
    c, s = np.cos(roll_right), np.sin(roll_right)
    about_x = np.array([[1, 0, 0], [0, c, -s], [0, s, c]])
    return about_z @ rotation_about_y(pitch_down) @ about_x


def quaternion_of_rotation(r):
    """The unit quaternion x, y, z, w with w >= 0; used only where w is far from 0."""
    w = np.sqrt(max(0.0, 1 + r[0, 0] + r[1, 1] + r[2, 2])) / 2
    if w > 1e-3:
        return np.array([r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1], 4 * w * w]) / (4 * w)
    values, vectors = np.linalg.eigh(np.array([
        [r[0, 0] - r[1, 1] - r[2, 2], r[0, 1] + r[1, 0], r[0, 2] + r[2, 0], r[2, 1] - r[1, 2]],
        [r[0, 1] + r[1, 0], r[1, 1] - r[0, 0] - r[2, 2], r[1, 2] + r[2, 1], r[0, 2] - r[2, 0]],
        [r[0, 2] + r[2, 0], r[1, 2] + r[2, 1], r[2, 2] - r[0, 0] - r[1, 1], r[1, 0] - r[0, 1]],
        [r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1], r[0, 0] + r[1, 1] + r[2, 2]],
    ]))
    return vectors[:, np.argmax(values)]


def slopes_of_plane(rotation):
    """dz/dx and dz/dy, in the global frame, of the plane of the wheels: the normal is the vehicle's z axis."""
    normal = rotation[:, 2]
    return -normal[:2] / normal[2]


class Pose:
    """A_from_B: position of B's origin in A, and the matrix that turns vectors of B into vectors of A."""

    def __init__(self, position, rotation):
        self.position = np.asarray(position, float)
        self.rotation = np.asarray(rotation, float)

    @classmethod
    def read(cls, tree):
        return cls(tree["position"], rotation_of_quaternion(tree["quaternion"]))

    def apply(self, points):
        return points @ self.rotation.T + self.position

    def undo(self, points):
        return (points - self.position) @ self.rotation

    def panned(self, angle):
        """Turned by `angle` downwards about its own origin and an axis parallel to the outer frame's y."""
        return Pose(self.position, rotation_about_y(angle) @ self.rotation)
