"""An orbit: mesh, collocation points, the piecewise polynomial on them, and how it is measured."""
