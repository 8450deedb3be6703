
/* Time steps of the motion of a split system, as `condensed/timestepping.py` takes it; names are those of Python. */

enum { INCONSISTENT = SINGULAR + 1, FULL };

typedef void rows_at(whole points, const double *rate, const double *state, const double *algebraic,
                     const double *phase, const double *parameter, double *residual, double *d_rate,
                     double *d_state, double *d_algebraic, double *d_phase, double *d_parameter);
typedef void rows_beside(whole points, const double *rate, const double *state, const double *algebraic,
                         const double *phase, const double *parameter, const double *side, double *residual,
                         double *d_rate, double *d_state, double *d_algebraic, double *d_phase,
                         double *d_parameter);
typedef void move_to(whole points, const double *algebraic, const double *increment, double *moved);
typedef void switch_at(whole points, const double *state, const double *phase, const double *parameter,
                       double *value);
typedef void guard_at(whole points, const double *state, const double *phase, const double *parameter,
                      const double *side, double *value);
typedef void slope_at(whole points, const double *state, const double *phase, const double *parameter,
                      double *d_state, double *d_phase, double *d_parameter);
typedef void guard_slope_at(whole points, const double *state, const double *phase, const double *parameter,
                            const double *side, double *d_state, double *d_phase, double *d_parameter);

struct motion {
    whole n, m, s, f, o, modes, columns, switches, parameters, joints, sets, most, pivots;
    const whole *places, *forces, *own;                               /* (s), (f) of the unknowns, (o) */
    const whole *slides, *guard, *up, *down, *column, *row, *place;   /* of the joints; row and place of sliders */
    const whole *stopping;                                            /* (joints, sets): whether friction stops them */
    rows_at *rows;
    rows_beside *beside;
    move_to *move;
    switch_at *switch_values;
    slope_at *switch_slopes;
    guard_at *guards;
    guard_slope_at *guard_slopes;
    const double *parameter, *outputs;                                /* (p); (s, J) complex */
    double *state, *unknown, *side, *z;                               /* where a step begins, then where it ends */
    double *parts;                                                    /* NaN where no joint sticks */
    const double *grown, *kicked, *local;                             /* of a width: (J), (J, f) complex; (s, f) */
    double *work;
    double width, converged;
};

/* A period: steps of the first width, divided into so many parts of the next one where a mode changes. */
struct period {
    whole steps, levels, divided, room;
    const double *widths, *grown, *kicked, *local;                    /* by levels (L) */
    double *phases, *states, *unknowns, *sides, *kept;                /* (room + 1, ...); (L, what a step moves) */
    double begin, length, before;                                     /* before: width of the step before */
    whole count;
};

/* Room for the equations of a step. */
struct room {
    double *residual, *d_rate, *d_state, *d_algebraic, *d_phase, *few;
    double *halves, *side, *value, *slope, *by_phase, *by_parameter;
    double *x, *next, *amid, *rate, *shown, *change, *moved, *sum, *both;
};

static double *taken(double **from, whole size)
{
    double *found = *from;
    *from += size;
    return found;
}

static void lay_out(const struct motion *p, struct room *r)
{
    const whole n = p->n, m = p->m, rows = n + m, most = rows + p->columns;
    double *next = p->work;
    r->residual = taken(&next, rows);
    r->d_rate = taken(&next, rows * n);
    r->d_state = taken(&next, rows * n);
    r->d_algebraic = taken(&next, rows * m);
    r->d_phase = taken(&next, rows);
    r->few = taken(&next, rows);
    r->halves = taken(&next, rows * p->columns);
    r->side = taken(&next, p->columns);
    r->value = taken(&next, p->switches);
    r->slope = taken(&next, p->switches * n);
    r->by_phase = taken(&next, p->switches);
    r->by_parameter = taken(&next, p->switches * p->parameters);
    r->x = taken(&next, n);
    r->next = taken(&next, m);
    r->amid = taken(&next, n);
    r->rate = taken(&next, n);
    r->shown = taken(&next, p->s);
    r->change = taken(&next, most);
    r->moved = taken(&next, m);
    r->sum = taken(&next, most);
    r->both = taken(&next, most * (most + 1));
}

/* Guards at a state in the modes of the motion. */
static void values(const struct motion *p, struct room *r, const double *state, double tau)
{
    if (p->guards)
        p->guards(1, state, &tau, p->parameter, p->side, r->value);
    else
        p->switch_values(1, state, &tau, p->parameter, r->value);
}

static void slopes(const struct motion *p, struct room *r, const double *state, double tau)
{
    memset(r->slope, 0, p->switches * p->n * sizeof(double));
    if (p->guard_slopes)
        p->guard_slopes(1, state, &tau, p->parameter, p->side, r->slope, r->by_phase, r->by_parameter);
    else
        p->switch_slopes(1, state, &tau, p->parameter, r->slope, r->by_phase, r->by_parameter);
}

/* Put the limits of sliders that are carried along in the place of their rows. */
static void carry(const struct motion *p, struct room *r, double tau)
{
    const whole n = p->n;
    for (whole j = 0; j < p->joints; j++) {
        const double mode = p->side[p->column[j]];
        if (p->slides[j] || (mode != 1 && mode != -1))
            continue;
        const whole row = p->row[j], guard = mode > 0 ? p->up[j] : p->down[j];
        values(p, r, r->x, tau);
        slopes(p, r, r->x, tau);
        r->residual[row] = r->value[guard];
        memset(r->d_rate + row * n, 0, n * sizeof(double));
        memset(r->d_algebraic + row * p->m, 0, p->m * sizeof(double));
        memcpy(r->d_state + row * n, r->slope + guard * n, n * sizeof(double));
    }
}

/* The equations amid a step, in modes `side`. */
static void evaluate(const struct motion *p, struct room *r, double tau)
{
    const whole n = p->n, m = p->m, rows = n + m;
    const double middle = tau - p->width / 2;
    int any = 0;
    for (whole c = 0; c < p->columns; c++)
        any |= r->side[c] != 0;
    memset(r->residual, 0, (rows * (2 + 2 * n + m)) * sizeof(double));
    if (any)
        p->beside(1, r->rate, r->amid, r->next, &middle, p->parameter, r->side, r->residual, r->d_rate, r->d_state,
                  r->d_algebraic, r->d_phase, r->few);
    else
        p->rows(1, r->rate, r->amid, r->next, &middle, p->parameter, r->residual, r->d_rate, r->d_state,
                r->d_algebraic, r->d_phase, r->few);
    for (whole i = 0; i < rows * n; i++)
        r->d_state[i] /= 2;
    carry(p, r, tau);
}

/* Whether a sliding joint sticks. */
static int stuck(const struct motion *p, whole j)
{
    return p->slides[j] && p->side[p->column[j]] == 2;
}

/* Whether a row depends on the states or their rates. */
static int filled(const struct motion *p, const struct room *r, whole row)
{
    for (whole i = 0; i < p->n; i++)
        if (r->d_rate[row * p->n + i] != 0 || r->d_state[row * p->n + i] != 0)
            return 1;
    return 0;
}

/* A row in the states, and in unknowns or NULL, as one in own states and unknowns, which act on the others. */
static void laid(const struct motion *p, const double *states, const double *unknowns, double *restrict row)
{
    for (whole i = 0; i < p->o; i++)
        row[i] = states[p->own[i]];
    for (whole i = 0; i < p->m; i++)
        row[p->o + i] = unknowns ? unknowns[i] : 0;
    for (whole i = 0; i < p->s; i++) {
        const double factor = states[p->places[i]];
        if (factor != 0)
            for (whole k = 0; k < p->f; k++)
                row[p->o + p->forces[k]] += factor * p->local[i * p->f + k];
    }
}

/* Rows and residual, (. | residual), in own states, unknowns and fractions of jumps; their number. */
static whole equations(const struct motion *p, struct room *r, double tau)
{
    const whole n = p->n, m = p->m, rows = n + m;
    whole held = 0, last = 0;
    for (whole i = 0; i < n; i++) {
        r->rate[i] = (r->x[i] - p->state[i]) / p->width;
        r->amid[i] = (r->x[i] + p->state[i]) / 2;
    }
    for (whole c = 0; c < p->columns; c++)
        r->side[c] = p->side[c];
    for (whole j = 0; j < p->joints; j++)
        if (stuck(p, j))
            r->side[p->column[j]] = 1;
    for (whole j = 0; j < p->joints; j++) {
        if (!stuck(p, j))
            continue;
        r->side[p->column[j]] = -1;
        evaluate(p, r, tau);
        memcpy(r->halves + held++ * rows, r->residual, rows * sizeof(double));
        r->side[p->column[j]] = 1;
    }
    evaluate(p, r, tau);
    for (whole h = 0; h < held; h++)
        for (whole i = 0; i < rows; i++)
            r->halves[h * rows + i] = (r->residual[i] - r->halves[h * rows + i]) / 2;
    whole given = m;
    for (whole i = 0; i < n; i++)
        given += filled(p, r, i);
    const whole size = p->o + m + held;
    if (given + held != size)
        return -1;
    for (whole i = 0; i < rows; i++) {
        if (i < n && !filled(p, r, i))
            continue;
        double *row = r->both + last++ * (size + 1), sum = r->residual[i];
        for (whole h = 0, j = 0; j < p->joints; j++)
            if (stuck(p, j))
                sum += r->halves[h++ * rows + i] * (p->parts[p->column[j]] - 1);
        for (whole c = 0; c < n; c++)
            r->sum[c] = r->d_state[i * n + c] + r->d_rate[i * n + c] / p->width;
        laid(p, r->sum, r->d_algebraic + i * m, row);
        for (whole h = 0; h < held; h++)
            row[p->o + m + h] = r->halves[h * rows + i];
        row[size] = sum;
    }
    if (held) {
        values(p, r, r->x, tau);
        slopes(p, r, r->x, tau);
    }
    for (whole j = 0; j < p->joints; j++) {
        if (!stuck(p, j))
            continue;
        double *row = r->both + last++ * (size + 1);
        laid(p, r->slope + p->guard[j] * n, NULL, row);
        memset(row + p->o + m, 0, held * sizeof(double));
        row[size] = r->value[p->guard[j]];
    }
    return size;
}

/* The set of joints with friction that stick. */
static whole holding(const struct motion *p)
{
    whole held = 0;
    for (whole j = 0, bit = 1; j < p->joints; j++)
        if (p->slides[j]) {
            held += stuck(p, j) ? bit : 0;
            bit *= 2;
        }
    return held;
}

/* States of the linear part at the end of a step. */
static void show(const struct motion *p, struct room *r)
{
    for (whole i = 0; i < p->s; i++) {
        double sum = r->shown[i];
        for (whole k = 0; k < p->f; k++)
            sum += p->local[i * p->f + k] * r->next[p->forces[k]];
        r->x[p->places[i]] = sum;
    }
}

/* States and unknowns at the end of a step in the modes of the motion, and fractions of jumps. */
static int solved(const struct motion *p, struct room *r, double tau)
{
    memcpy(r->x, p->state, p->n * sizeof(double));
    memcpy(r->next, p->unknown, p->m * sizeof(double));
    memset(p->parts, 0, p->columns * sizeof(double));
    for (whole i = 0; i < p->s; i++) {
        r->shown[i] = 0;
        for (whole j = 0; j < p->modes; j++) {
            const double *out = p->outputs + 2 * (i * p->modes + j), *g = p->grown + 2 * j, *z = p->z + 2 * j;
            r->shown[i] += out[0] * (g[0] * z[0] - g[1] * z[1]) - out[1] * (g[0] * z[1] + g[1] * z[0]);
        }
    }
    for (whole iteration = 0; iteration < p->most; iteration++) {
        show(p, r);
        const whole size = equations(p, r, tau);
        if (size < 0 || solve(size, 1, r->both))
            return SINGULAR;
        double largest = 0, scale = 0;
        for (whole i = 0; i < size; i++) {
            r->change[i] = -r->both[i * (size + 1) + size];
            largest = fmax(largest, fabs(r->change[i]));
            if (!(fabs(r->change[i]) <= DBL_MAX))
                return NOT_FINITE;
        }
        for (whole i = 0; i < p->o; i++)
            r->x[p->own[i]] += r->change[i];
        if (p->m) {
            p->move(1, r->next, r->change + p->o, r->moved);
            memcpy(r->next, r->moved, p->m * sizeof(double));
        }
        for (whole h = 0, j = 0; j < p->joints; j++)
            if (stuck(p, j))
                p->parts[p->column[j]] += r->change[p->o + p->m + h++];
        for (whole i = 0; i < p->m; i++)
            scale = fmax(scale, fabs(r->next[i]));
        if (largest < p->converged * (1 + scale))
            break;
    }
    show(p, r);
    return DONE;
}

/* The first joint whose mode is not that at the end of a step; the mode that it should have. */
static whole wrong(const struct motion *p, struct room *r, double tau, double *mode)
{
    const whole held = holding(p);
    values(p, r, r->x, tau);
    for (whole j = 0; j < p->joints; j++) {
        const double own = p->side[p->column[j]], up = r->value[p->up[j]], down = r->value[p->down[j]];
        const double part = p->parts[p->column[j]];
        double ahead = r->value[p->guard[j]] * own;
        if (!p->slides[j] && p->stopping[j * p->sets + held])
            continue;
        if (!p->slides[j])
            ahead = (r->x[p->place[j]] - p->state[p->place[j]]) * own;
        *mode = 2;
        if (own != 2 && (ahead < 0 || own == 0))
            return j;
        *mode = part > 0 ? 1 : -1;
        if (own == 2 && p->slides[j] && fabs(part) > 1)
            return j;
        *mode = up > 0 ? 1 : -1;
        if (own == 2 && !p->slides[j] && !(up <= 0 && 0 <= down))
            return j;
    }
    return -1;
}

/* One step, to a phase. */
static int step(const struct motion *p, struct room *r, double tau)
{
    whole j = 0;
    for (whole pivot = 0; pivot < p->pivots && j >= 0; pivot++) {
        double mode;
        const int failed = solved(p, r, tau);
        if (failed)
            return failed;
        j = wrong(p, r, tau, &mode);
        if (j >= 0)
            p->side[p->column[j]] = mode;
    }
    if (j >= 0 || !finite_all(p->n, r->x))
        return INCONSISTENT;
    for (whole k = 0; k < p->modes; k++) {
        const double *g = p->grown + 2 * k;
        const double re = p->z[2 * k], im = p->z[2 * k + 1];
        p->z[2 * k] = g[0] * re - g[1] * im;
        p->z[2 * k + 1] = g[0] * im + g[1] * re;
        for (whole l = 0; l < p->f; l++) {
            p->z[2 * k] += p->kicked[2 * (k * p->f + l)] * r->next[p->forces[l]];
            p->z[2 * k + 1] += p->kicked[2 * (k * p->f + l) + 1] * r->next[p->forces[l]];
        }
    }
    for (whole c = 0; c < p->columns; c++)
        r->side[c] = NAN;
    for (whole i = 0; i < p->joints; i++)
        if (stuck(p, i))
            r->side[p->column[i]] = p->parts[p->column[i]];
    memcpy(p->parts, r->side, p->columns * sizeof(double));
    memcpy(p->state, r->x, p->n * sizeof(double));
    memcpy(p->unknown, r->next, p->m * sizeof(double));
    return DONE;
}

/* Copy what a step moves to `kept`, or back. */
static void keep(const struct motion *p, double *kept, int back)
{
    double *const from[] = {p->state, p->unknown, p->side, p->z, p->parts};
    const whole sizes[] = {p->n, p->m, p->columns, 2 * p->modes, p->columns};
    for (int k = 0; k < 5; kept += sizes[k++])
        memcpy(back ? from[k] : kept, back ? kept : from[k], sizes[k] * sizeof(double));
}

/* Whether modes changed in a step, or a fraction, extrapolated from the step before, exceeds 1 after it. */
static int changing(const struct motion *p, const struct period *q, const double *kept)
{
    const double *side = kept + p->n + p->m, *parts = side + p->columns + 2 * p->modes;
    int found = 0;
    for (whole c = 0; c < p->columns; c++) {
        const double rate = (p->parts[c] - parts[c]) / (p->width + q->before);
        found |= side[c] != p->side[c] || fabs(p->parts[c] + rate * p->width) > 1;
    }
    return found;
}

/* Keep the end of a step; sliders that friction stops count as held. */
static void note(const struct motion *p, struct period *q, double tau)
{
    const whole k = ++q->count, held = holding(p);
    q->phases[k] = tau;
    memcpy(q->states + k * p->n, p->state, p->n * sizeof(double));
    memcpy(q->unknowns + k * p->m, p->unknown, p->m * sizeof(double));
    double *side = q->sides + k * p->columns;
    memcpy(side, p->side, p->columns * sizeof(double));
    for (whole j = 0; j < p->joints; j++)
        if (!p->slides[j] && p->stopping[j * p->sets + held])
            side[p->column[j]] = 2;
}

/* A step, or several shorter ones where a mode changes. */
static int advance(struct motion *p, struct period *q, struct room *r, double begin, double end, whole level)
{
    const whole size = p->n + p->m + 2 * p->columns + 2 * p->modes;
    double *kept = q->kept + level * size;
    const double before = q->before;
    keep(p, kept, 0);
    p->width = q->widths[level];
    p->grown = q->grown + level * 2 * p->modes;
    p->kicked = q->kicked + level * 2 * p->modes * p->f;
    p->local = q->local + level * p->s * p->f;
    const int failed = step(p, r, end);
    if (failed)
        return failed;
    if (level + 1 == q->levels || !changing(p, q, kept)) {
        q->before = p->width;
        if (q->count == q->room)
            return FULL;
        note(p, q, end);
        return DONE;
    }
    keep(p, kept, 1);
    q->before = before;
    for (whole k = 0; k < q->divided; k++) {
        const double part = (end - begin) / (double)q->divided;
        const double next = k + 1 < q->divided ? begin + (double)(k + 1) * part : end;
        const int stopped = advance(p, q, r, begin + (double)k * part, next, level + 1);
        if (stopped)
            return stopped;
    }
    return DONE;
}

/* A period of steps from a phase; FULL where there is no room for them. */
int period(struct motion *p, struct period *q)
{
    struct room r;
    lay_out(p, &r);
    q->count = -1;
    note(p, q, q->begin);
    for (whole k = 0; k < q->steps; k++) {
        const double first = q->begin + q->length * (double)k / (double)q->steps;
        const int failed = advance(p, q, &r, first, q->begin + q->length * (double)(k + 1) / (double)q->steps, 0);
        if (failed)
            return failed;
    }
    return DONE;
}
