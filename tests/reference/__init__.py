"""Independent answers: periodic orbits by shooting with other people's integrators (SciPy's, CVODES).

integration    motions by SciPy, and the limit cycles to which they settle
shooting       the map over a period with its variational equations, pieces between kinks, Newton, multipliers
discs          the discs without squeeze film as problems for it
squeeze        the discs with squeeze film, stiff, in variables of their own
confirmation   any compiled system by CVODES

All but the last are written from the equations and share no code with the packages that are tested.
"""
