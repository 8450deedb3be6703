"""
Design of a friction damper
===========================

The peak of the response over the slip limit of a Jenkins damper: a slider that never holds does not damp, one
that never slips does not either. The curve of peaks has its minimum between; it gets a point of its own.
"""

import periodic as per
import symbolic as sym

damper, swing = sym.scene("jenkins-damper"), per.PeakToPeak("x")
response = per.trace(damper, "Omega", (0.9, 1.4), values={"F_slider": 0.1})
highest = max(response, key=lambda point: point.peak_to_peak("x"))
resonance, watch = {"Omega": per.Peak(swing)}, per.Watch(peaks={"lowest peak": swing})
peaks = per.trace(damper, "F_slider", (0.09, 0.2), guess=highest.orbit, determined=resonance, watch=watch)
axes = per.plot(peaks)
(best,) = peaks.peaks["lowest peak"]
key = best.peak_to_peak("x")
print(f"lowest peak {key:.9f} at a limit of {best.parameter:.8f} N")
