"""
Design of a friction damper
===========================

The peak of the response over the slip limit of a Jenkins damper: a slider that never holds does not damp, one
that never slips does not either. The curve of peaks has its minimum between.
"""

from scipy.interpolate import CubicHermiteSpline

import periodic as per
import symbolic as sym

damper, swing = sym.scene("jenkins-damper"), per.PeakToPeak("x")
response = per.trace(damper, "Omega", (0.9, 1.4), values={"F_slider": 0.1})
highest = max(response, key=lambda point: point.peak_to_peak("x"))
resonance, finely = {"Omega": per.Peak(swing)}, per.ArclengthControl(ds_max=0.05)
peaks = per.trace(damper, "F_slider", (0.09, 0.2), guess=highest.orbit, determined=resonance, control=finely)
axes = per.plot(peaks)
slopes = [per.sensitivities(damper, point.orbit, {"x": swing})["x"]["F_slider"] for point in peaks]
curve = CubicHermiteSpline(peaks.values, peaks.peak_to_peak("x"), slopes)
(best,) = curve.derivative().roots(extrapolate=False)  # N
key = float(curve(best))
print(f"lowest peak {key:.6f} at a limit of {best:.5f} N")
