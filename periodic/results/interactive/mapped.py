"""What a page shows of a map: a number over one or two parameters."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from periodic.orbit.scheme import Array

if TYPE_CHECKING:
    import xarray as xr


def map_content(data: xr.Dataset) -> dict[str, Any]:
    """Return all that the page of a map is made of. Raises ValueError for more than two parameters."""
    numbers = {
        str(name): item
        for name, item in data.data_vars.items()
        if item.dtype.kind in "fiub" and item.ndim and set(item.dims) <= set(data.coords)
    }
    axes = list(dict.fromkeys(str(dim) for item in numbers.values() for dim in item.dims))
    full = {name: item for name, item in numbers.items() if set(item.dims) == set(axes)}
    if not 1 <= len(axes) <= 2 or not full:
        raise ValueError(
            f"the map has the axes {', '.join(map(str, data.sizes))}; a page shows numbers over one or two "
            f"parameters: choose the others by .sel or .isel"
        )
    return {
        "axes": [
            {
                "name": name,
                "unit": str(data[name].attrs.get("units", "")),
                "values": _plain(data[name].values),
            }
            for name in axes
        ],
        "numbers": [
            {
                "name": name,
                "unit": str(item.attrs.get("units", "")),
                "values": _plain(item.transpose(*reversed(axes)).values),
            }
            for name, item in full.items()
        ],
    }


def _plain(values: Array) -> list[Any]:
    """Nested lists of six digits, None for what is no number."""
    if values.ndim > 1:
        return [_plain(row) for row in values]
    return [float(f"{float(v):.6g}") if np.isfinite(float(v)) else None for v in values]
