"""Ageing of what was measured, by the declared drift of position and heading: "Ageing" of docs/theory/rover.md."""

import numpy as np

SLOPE = 1.0  # of the ground at which a displacement in plan becomes an error of elevation


class Drift:
    def __init__(self, setup):
        known = setup["known_noise"]
        self.frame_time = 1.0 / setup["frame_rate"]
        self.position, self.walk, self.heading = known["position_drift"], known["position_walk"], known["heading_drift"]
        self.fixes = known["fixes"]

    def variance(self, then, now, way, away):
        """Of elevations measured in frames `then`: `way` driven since, `away` metres from the vehicle now."""
        then = np.asarray(then, float)
        since = (now - then) * self.frame_time

        def drifted(seconds):
            return (self.position * seconds) ** 2 + self.walk ** 2 * seconds

        moved = drifted(since)
        if self.fixes is not None:
            every, noise = self.fixes["every_frames"], self.fixes["noise"]
            own, last = np.floor(then / every), np.floor(now / every)
            fixed = 2 * noise ** 2 + drifted((then - own * every) * self.frame_time) \
                + drifted((now - last * every) * self.frame_time)
            moved = np.where(own == last, moved, fixed)
        turned = self.heading * (way * then * self.frame_time + away * since)
        return SLOPE ** 2 * (moved + turned ** 2)
