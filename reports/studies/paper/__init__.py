"""The report on Mehdigoli, Rahnejat & Gohar, Wear 139 (1990): every figure and number of it beside ours."""
