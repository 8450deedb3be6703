
/* What `periodic.collocation.elimination` and `periodic.linear.bordering` do, point by point and interval by interval.

   Arrays are contiguous, row by row; the names and shapes are those of the Python code. Of k phases e at the most
   move an interval: ties (count, e) says which. w1 = 1 + 2n + e + p columns of a point's rows, w = 1 + n + e + p of
   an interval's stages, 1 + n + k + p of its step. */

/* Rows c (w1) of a point: residual, d rate, d state, dy; without the unknowns, which `algebraic` has.
   local is room for m (m + w1) numbers. */
static int eliminate(whole n, whole m, whole w1, const double *unknown, double *columns,
                     double *restrict algebraic, double *local)
{
    for (whole r = 0; r < m; r++) {
        memcpy(local + r * (m + w1), unknown + (n + r) * m, m * sizeof(double));
        memcpy(local + r * (m + w1) + m, columns + (n + r) * w1, w1 * sizeof(double));
    }
    if (solve(m, w1, local) != DONE)
        return SINGULAR;
    for (whole i = 0; i < m; i++) {
        double *found = algebraic + i * w1;
        memcpy(found, local + i * (m + w1) + m, w1 * sizeof(double));
        for (whole r = 0; r < n; r++) {
            const double factor = unknown[r * m + i];
            if (factor != 0)
                for (whole s = 0; s < w1; s++)
                    columns[r * w1 + s] -= factor * found[s];
        }
    }
    return DONE;
}

/* Rows of an interval that have the rate of one state and no more of it: a dq' + sum of b dv = .. Row r has that of
   position[r], -1 for other rows, and the states v of the row of `state` (n, n), count[r] of them.
   role: of each state, whether it follows from others (GONE), or others from it (KEPT). */
struct kinematic {
    whole *position, *count, *state, *role;
};

enum { GONE = 1, KEPT = 2 };

/* Whether row r of an interval's columns (ncol, n, w1) is such a row with so many states at the most. */
static int is_kinematic(whole ncol, whole n, whole w1, const double *columns, whole r, whole most,
                        const struct kinematic *found)
{
    whole rate = -1, count = 0;
    for (whole s = 0; s < n; s++) {
        whole moves = 0, acts = 0;
        for (whole l = 0; l < ncol; l++) {
            const double *c = columns + (l * n + r) * w1 + 1;
            moves += c[s] != 0;
            acts += c[n + s] != 0;
        }
        if (moves && (rate >= 0 || moves < ncol || acts || found->role[s]))
            return 0;
        if (acts && (count == most || found->role[s] == GONE))
            return 0;
        if (moves)
            rate = s;
        if (acts)
            found->state[r * n + count++] = s;
    }
    for (whole i = 0; rate >= 0 && i < ncol * n; i++)
        if (i % n != r && columns[i * w1 + 1 + rate] != 0)
            return 0;
    found->position[r] = rate;
    found->count[r] = count;
    return rate >= 0;
}

/* Kinematic rows of an interval's columns: as in `kinematic.py`, with one state, then those with others,
   as sliders between two places have. */
static void find_kinematic(whole ncol, whole n, whole w1, const double *columns, const struct kinematic *found)
{
    for (whole s = 0; s < n; s++) {
        found->position[s] = -1;
        found->role[s] = 0;
    }
    for (whole pass = 0; pass < 2; pass++)
        for (whole r = 0; r < n; r++)
            if (found->position[r] < 0 && is_kinematic(ncol, n, w1, columns, r, pass ? n : 1, found)) {
                found->role[found->position[r]] = GONE;
                for (whole i = 0; i < found->count[r]; i++)
                    found->role[found->state[r * n + i]] = KEPT;
            }
}

/* Stages (ncol, n, w) of an interval of width h from its columns (ncol, n, w1). integral (ncol, ncol)
   is the inverse of the stages' part of stage_rates. `both`: room for ncol n (ncol n + w + 1) numbers,
   marks: for n (n + 4). */
static int solve_stages(whole ncol, whole n, whole w, double h, const double *columns,
                        const double *stage_rates, const double *integral, double *restrict stages,
                        double *restrict both, whole *marks)
{
    const whole w1 = w + n;
    const struct kinematic rows = {marks, marks + n, marks + 2 * n, marks + (n + 2) * n};
    const whole *position = rows.position;
    find_kinematic(ncol, n, w1, columns, &rows);
    whole *place = marks + (n + 3) * n, kept = 0;
    for (whole s = 0; s < n; s++)
        place[s] = rows.role[s] == GONE ? -1 : kept++;
    const whole size = ncol * kept, width = size + w;
    double *ratios = both + size * width, *ratio = ratios; /* (ncol): b / a of kinematic rows, state by state */
    for (whole r = 0; r < n; r++)
        for (whole v = 0; position[r] >= 0 && v < rows.count[r]; v++, ratio += ncol)
            for (whole l = 0; l < ncol; l++) {
                const double *c = columns + (l * n + r) * w1 + 1;
                ratio[l] = h * (c[n + rows.state[r * n + v]] / c[position[r]]);
            }
    const double inverse = 1 / h;

    /* Stages of positions but for their velocities' part: h integral (given rates). */
    memset(stages, 0, ncol * n * w * sizeof(double));
    for (whole r = 0; r < n; r++)
        for (whole k = 0; position[r] >= 0 && k < ncol; k++) {
            const double *c = columns + (k * n + r) * w1;
            const double slope = c[1 + position[r]], length = h / slope;
            for (whole l = 0; l < ncol; l++) {
                const double factor = integral[l * ncol + k] * length;
                double *x = stages + (l * n + position[r]) * w;
                x[0] -= factor * c[0];
                for (whole j = 1 + n; j < w; j++)
                    x[j] -= factor * c[n + j];
                x[1 + position[r]] -= factor * slope * (stage_rates[k * (ncol + 1)] * inverse);
            }
        }

    /* The stages of a state side by side: what is coupled to its neighbours alone stays banded. */
    double *row = both;
    for (whole r = 0; r < n; r++) {
        if (position[r] >= 0)
            continue;
        for (whole l = 0; l < ncol; l++) {
            const double *weights = stage_rates + l * (ncol + 1);
            const double *c = columns + (l * n + r) * w1;
            double *right = row + size;
            memset(row, 0, size * sizeof(double));
            for (whole i = 0; i < ncol; i++)
                for (whole s = 0; s < n; s++)
                    if (place[s] >= 0)
                        row[place[s] * ncol + i] = c[1 + s] * (weights[1 + i] * inverse);
            for (whole s = 0; s < n; s++)
                if (place[s] >= 0)
                    row[place[s] * ncol + l] += c[1 + n + s];
            right[0] = -c[0];
            for (whole s = 0; s < n; s++)
                right[1 + s] = -c[1 + s] * (weights[0] * inverse);
            for (whole j = 1 + n; j < w; j++)
                right[j] = -c[n + j];
            ratio = ratios;
            for (whole k = 0; k < n; k++) {
                const whole q = position[k], count = q < 0 ? 0 : rows.count[k];
                if (q >= 0 && c[1 + n + q] != 0) {
                    const double factor = c[1 + n + q], *x = stages + (l * n + q) * w;
                    for (whole j = 0; j < w; j++)
                        right[j] -= factor * x[j];
                    for (whole v = 0; v < count; v++)
                        for (whole i = 0; i < ncol; i++)
                            row[place[rows.state[k * n + v]] * ncol + i] -=
                                factor * integral[l * ncol + i] * ratio[v * ncol + i];
                }
                ratio += count * ncol;
            }
            row += width;
        }
    }
    if (solve(size, w, both) != DONE)
        return SINGULAR;
    for (whole l = 0; l < ncol; l++)
        for (whole s = 0; s < n; s++)
            if (place[s] >= 0)
                memcpy(stages + (l * n + s) * w, both + (place[s] * ncol + l) * width + size,
                       w * sizeof(double));
    ratio = ratios;
    for (whole r = 0; r < n; r++)
        for (whole i = 0; position[r] >= 0 && i < rows.count[r]; i++, ratio += ncol)
            for (whole k = 0; k < ncol; k++) {
                const double *v = stages + (k * n + rows.state[r * n + i]) * w;
                for (whole l = 0; l < ncol; l++) {
                    const double factor = integral[l * ncol + k] * ratio[k];
                    double *x = stages + (l * n + position[r]) * w;
                    for (whole j = 0; j < w; j++)
                        x[j] -= factor * v[j];
                }
            }
    return DONE;
}

/* The inverse (ncol, ncol) of the stages' part of stage_rates. */
static void integrate(whole ncol, const double *stage_rates, double *integral, double *both)
{
    for (whole l = 0; l < ncol; l++)
        for (whole i = 0; i < ncol; i++) {
            both[l * 2 * ncol + i] = stage_rates[l * (ncol + 1) + 1 + i];
            both[l * 2 * ncol + ncol + i] = l == i;
        }
    solve(ncol, ncol, both);
    for (whole l = 0; l < ncol; l++)
        memcpy(integral + l * ncol, both + l * 2 * ncol + ncol, ncol * sizeof(double));
}

/* The columns of a row in (1, dx_j, dy): those of the phases are where they belong. */
static void place(whole n, whole e, whole k, whole p, const whole *ties, const double *own, double *row)
{
    memcpy(row, own, (1 + n) * sizeof(double));
    memset(row + 1 + n, 0, k * sizeof(double));
    for (whole a = 0; a < e; a++)
        row[1 + n + ties[a]] = own[1 + n + a];
    memcpy(row + 1 + n + k, own + 1 + n + e, p * sizeof(double));
}

/* work holds ncol (n+m) w1 + m (m + w1) + ncol n (ncol n + w + 1) + 3 ncol ncol numbers, marks n (n + 4). */
int eliminate_stages(whole count, whole ncol, whole n, whole m, whole k, whole e, whole p, const whole *ties,
                     const double *line_residual, const double *d_rate, const double *d_state,
                     const double *d_algebraic, const double *d_phase, const double *d_parameter,
                     const double *width, const double *left_gradient, const double *width_gradient,
                     const double *points, const double *stage_rates, const double *end,
                     const double *knots, const double *knot_rates, const double *nodes,
                     double *step, double *stages, double *algebraic, double *residual, double *work,
                     whole *marks)
{
    const whole rows = n + m, w1 = 1 + 2 * n + e + p, w = 1 + n + e + p, wide = 1 + n + k + p;
    double *columns = work, *integral = columns + ncol * n * w1 + m * w1;
    double *local = integral + ncol * ncol, *both = local + m * (m + w1);
    double largest = 0;
    integrate(ncol, stage_rates, integral, both);
    for (whole j = 0; j < count; j++) {
        for (whole l = 0; l < ncol; l++) {
            const whole point = j * ncol + l;
            const double *rate = knot_rates + (j * (ncol + 1) + l + 1) * n;
            const double *unknown = d_algebraic + point * rows * m;
            double *own = columns + l * n * w1; /* the algebraic rows lie where the next point's will */
            for (whole r = 0; r < rows; r++) {
                const whole row = point * rows + r;
                double *c = own + r * w1, along = 0;
                c[0] = line_residual[row];
                largest = fmax(largest, fabs(c[0]));
                memcpy(c + 1, d_rate + row * n, n * sizeof(double));
                memcpy(c + 1 + n, d_state + row * n, n * sizeof(double));
                for (whole s = 0; s < n; s++)
                    along += c[1 + s] * rate[s];
                for (whole a = 0; a < e; a++) {
                    const double stretch = width_gradient[j * e + a];
                    const double shift = left_gradient[j * e + a] + stretch * points[l];
                    c[1 + 2 * n + a] = d_phase[row] * shift - along * (stretch / width[j]);
                }
                memcpy(c + 1 + 2 * n + e, d_parameter + row * p, p * sizeof(double));
            }
            if (!finite_all(rows * w1, own) || !finite_all(rows * m, unknown))
                return NOT_FINITE;
            if (m && eliminate(n, m, w1, unknown, own, algebraic + point * m * w1, local) != DONE)
                return SINGULAR;
        }
        double *inside = stages + j * ncol * n * w;
        if (solve_stages(ncol, n, w, width[j], columns, stage_rates, integral, inside, both, marks) != DONE)
            return SINGULAR;
        for (whole r = 0; r < n; r++) {
            const double *own = knots + j * (ncol + 1) * n + r; /* differences are exact */
            double *s = columns, gap = own[0] - nodes[(j + 1) * n + r];
            memset(s, 0, w * sizeof(double));
            for (whole l = 0; l < ncol; l++)
                if (end[1 + l] != 0)
                    for (whole i = 0; i < w; i++)
                        s[i] += end[1 + l] * inside[(l * n + r) * w + i];
            for (whole l = 1; l <= ncol; l++)
                gap += end[l] * (own[l * n] - own[0]);
            s[1 + r] += end[0];
            s[0] += gap;
            place(n, e, k, p, ties + j * e, s, step + (j * n + r) * wide);
        }
    }
    *residual = largest;
    return DONE;
}

/* maps (count + 1, n, w): affine maps of (1, dx_0, dy), from step (count, n, w). */
void chain(whole count, whole n, whole w, const double *step, double *restrict maps)
{
    memset(maps, 0, n * w * sizeof(double));
    for (whole r = 0; r < n; r++)
        maps[r * w + 1 + r] = 1;
    for (whole j = 0; j < count; j++)
        for (whole r = 0; r < n; r++) {
            const double *s = step + (j * n + r) * w, *before = maps + j * n * w;
            double *restrict after = maps + ((j + 1) * n + r) * w;
            memcpy(after, s, w * sizeof(double));
            memset(after + 1, 0, n * sizeof(double));
            for (whole i = 0; i < n; i++)
                for (whole c = 0; c < w; c++)
                    after[c] += s[1 + i] * before[i * w + c];
        }
}

/* Increments of stages (count, ncol, n) and unknowns (count, ncol, m) from those of mesh points and y.

   rate is room for n numbers, own for e + p. */
void recover(whole count, whole ncol, whole n, whole m, whole k, whole e, whole p, double constant, const whole *ties,
             const double *stage_map, const double *algebraic_map, const double *stage_rates,
             const double *width, const double *nodes, const double *outer,
             double *restrict stages, double *restrict algebraic, double *restrict rate, double *restrict own)
{
    const whole q = e + p, w = 1 + n + q, w1 = w + n;
    memcpy(own + e, outer + k, p * sizeof(double));
    for (whole j = 0; j < count; j++) {
        const double *start = nodes + j * n;
        double *inside = stages + j * ncol * n;
        for (whole a = 0; a < e; a++)
            own[a] = outer[ties[j * e + a]];
        for (whole i = 0; i < ncol * n; i++) {
            const double *row = stage_map + (j * ncol * n + i) * w;
            double sum = row[0] * constant;
            for (whole s = 0; s < n; s++)
                sum += row[1 + s] * start[s];
            for (whole s = 0; s < q; s++)
                sum += row[1 + n + s] * own[s];
            inside[i] = sum;
        }
        for (whole l = 0; m && l < ncol; l++) {
            const double *weights = stage_rates + l * (ncol + 1), *state = inside + l * n;
            for (whole s = 0; s < n; s++) {
                rate[s] = weights[0] * start[s];
                for (whole i = 0; i < ncol; i++)
                    rate[s] += weights[1 + i] * inside[i * n + s];
                rate[s] /= width[j];
            }
            for (whole i = 0; i < m; i++) {
                const double *row = algebraic_map + ((j * ncol + l) * m + i) * w1;
                double sum = row[0] * constant;
                for (whole s = 0; s < n; s++)
                    sum += row[1 + s] * rate[s] + row[1 + n + s] * state[s];
                for (whole s = 0; s < q; s++)
                    sum += row[1 + 2 * n + s] * own[s];
                algebraic[(j * ncol + l) * m + i] = -sum;
            }
        }
    }
}
