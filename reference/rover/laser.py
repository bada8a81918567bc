"""Light of a laser sheet: its energy for each metre of way, and its class by IEC 60825-1:2014."""

import math

# Exposures of the presets of cameras (docs/theory/sensor.md); fan and wavelength of the default rig's sheets.
EXPOSURE_S = {"cmos": 0.4e-3, "ideal": 2e-3, "ccd_1989": 2e-3}
FAN_DEG = 60.0
WAVELENGTH_NM = 810.0
SHEETS = 2
# Condition 3 of the standard, for the naked eye: a pupil of 7 mm, 100 mm from the source. Here the source is the focal axis.
APERTURE_M = 0.007
DISTANCE_M = 0.1


def energy_per_metre(power_w, camera, stripes, way_m):
    """Light of all stripes over the way [J/m]. `stripes` counts images in which one sheet of this power is lit."""
    return power_w * EXPOSURE_S[camera] * stripes / way_m


def laser_class(power_w, camera):
    """Class of one pulse of a sheet, as long as an exposure and seen as a point source (C6 = 1), which is the strictest reading.

    Limits for 700 to 1050 nm and pulses between 18 microseconds and 10 s: 7e-4 t^0.75 C4 J for class 1, five times that for 3R;
    class 3B ends at 0.03 C4 J for pulses shorter than 0.06 C4 s. Pulses are not added up: 30 in 10 s stay below the limit of
    10 s wherever one stays below its own. Nobody stands nearer to the mast than 100 mm.
    """
    line_m = 2 * DISTANCE_M * math.tan(math.radians(FAN_DEG / 2))
    pulse_j = power_w * EXPOSURE_S[camera] * APERTURE_M / line_m
    c4 = 10 ** (0.002 * (WAVELENGTH_NM - 700))
    first = 7e-4 * EXPOSURE_S[camera]**0.75 * c4
    for name, limit_j in [("1", first), ("3R", 5 * first), ("3B", 0.03 * c4)]:
        if pulse_j <= limit_j:
            return name
    return "4"
