"""Pictures beside `periodic.plot`: of orbits, multipliers and spectra, of curves in two parameters."""

from periodic.results.plots.campbell import plot_campbell as campbell
from periodic.results.plots.multipliers import plot_multipliers as multipliers
from periodic.results.plots.orbitplots import plot_orbit as orbit
from periodic.results.plots.orbitplots import plot_phase as phase
from periodic.results.plots.orbitplots import plot_spectrum as spectrum
from periodic.results.plots.regions import plot_regions as regions
from periodic.results.plots.waterfall import plot_waterfall as waterfall

__all__ = ["campbell", "multipliers", "orbit", "phase", "regions", "spectrum", "waterfall"]
