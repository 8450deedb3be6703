"""Linear systems, or with cubic springs, between joints: followed event by event, exact to rounding.

model    matrices, joints, and what a mode of the joints makes of them
series   pieces of a motion by Taylor's series, and the first zero of what stays positive in a mode
modes    which mode follows an event, several joints at once where they turn together
period   the map over a period with its monodromy matrix; its fixed points; where motions settle
judging  points of branches against them; the others share nothing with `symbolic` and `periodic`
"""

from __future__ import annotations

from reference.joints.model import Coulomb, Cubic, Jointed, Slider, Stop
from reference.joints.period import Follower, Period, peak_to_peak, periodic, settled

__all__ = [
    "Coulomb",
    "Cubic",
    "Follower",
    "Jointed",
    "Period",
    "Slider",
    "Stop",
    "peak_to_peak",
    "periodic",
    "settled",
]
