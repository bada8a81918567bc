"""Ageing of what was measured, by the declared drift of position and heading: "Ageing" of docs/theory/rover.md."""

import numpy as np

SLOPE = 1.0  # of the ground at which a displacement in plan becomes an error of elevation


class Drift:
    def __init__(self, setup):
        known = setup["known_noise"]
        self.frame_time = 1.0 / setup["frame_rate"]
        scan = setup["scan"]
        self.scan_time = scan["steps"] * scan.get("step_time", 0.0) if scan else 0.0
        self.scans = []  # frames with a scan so far, in their order
        self.position, self.walk, self.heading = known["position_drift"], known["position_walk"], known["heading_drift"]
        self.fixes = known["fixes"]

    def paused(self, frame):
        """Time of all scans before a frame, seconds: the vehicle stands, and its sensors drift."""
        return self.scan_time * np.searchsorted(self.scans, frame, side="left")

    def seconds(self, start, end):
        return (end - start) * self.frame_time + (self.paused(end) - self.paused(start))

    def variance(self, then, now, way, away):
        """Of elevations measured in frames `then`: `way` driven since, `away` metres from the vehicle now."""
        then = np.asarray(then, float)
        since = self.seconds(then, now)

        def drifted(seconds):
            return (self.position * seconds) ** 2 + self.walk ** 2 * seconds

        moved = drifted(since)
        if self.fixes is not None:
            every, noise = self.fixes["every_frames"], self.fixes["noise"]
            own, last = np.floor(then / every), np.floor(now / every)
            fixed = 2 * noise ** 2 + drifted(self.seconds(own * every, then)) \
                + drifted(self.seconds(last * every, now))
            moved = np.where(own == last, moved, fixed)
        turned = self.heading * (way * self.seconds(0, then) + away * since)
        return SLOPE ** 2 * (moved + turned ** 2)
