"""Two-parameter curves of special points: the points of codimension two on them."""
