"""Complete chatter: from which bounces on a wall a motion comes to rest before the wall lets go of it."""

from __future__ import annotations

import pytest

from periodic.events.resting import longest


def test_longest_bounce_by_hand() -> None:
    """Assert that at e = 5/16 sigma is 1/2: (3 - 1/2) (1/2)^2 = 5/8 = 5/16 (3 - 1)."""
    assert longest(5 / 16) == pytest.approx(1 / 2 - 1 / 12, abs=1e-14)


@pytest.mark.parametrize("ratio", [0.05, 0.5, 0.9, 0.99])
@pytest.mark.parametrize(("part", "rests"), [(0.999, True), (1.001, False)])
def test_bounces_end_before_the_rest(ratio: float, part: float, rests: bool) -> None:
    """Assert that bounces under a force that falls to 0 end while it presses where the first is shorter."""
    assert _comes_to_rest(ratio, part * longest(ratio)) == rests


def _comes_to_rest(ratio: float, first: float) -> bool:
    """Whether bounces under s'' = t - 1 end before t = 1; the first would last `first` under s'' = -1."""
    t, speed = 0.0, first / 2
    while speed > 1e-12:
        # s = w u - (1 - t) u^2/2 + u^3/6 is 0 at the smaller root u of u^2/6 - (1 - t) u/2 + w.
        square = (1 - t) ** 2 / 4 - 2 * speed / 3
        if square < 0:
            return False
        length = 3 * ((1 - t) / 2 - square**0.5)
        speed = -ratio * (speed - (1 - t) * length + length**2 / 2)
        t += length
    return t < 1
