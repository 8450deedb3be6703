
/* Outputs at phases of an orbit: what `periodic.orbit.extrema.outputs` does. It follows `linear.c` in one source. */

#define ITERATIONS 12 /* as in algebraic.py */
#define CLOSE 1e-10
#define LONGEST 5.0

typedef void rows_at(whole points, const double *rate, const double *state, const double *algebraic,
                     const double *phase, const double *parameter, double *residual, double *d_rate,
                     double *d_state, double *d_algebraic, double *d_phase, double *d_parameter);
typedef void outputs_at(whole points, const double *rate, const double *state, const double *algebraic,
                        const double *phase, const double *parameter, double *values);

/* As `periodic.orbit.native.outputs.Call` fills it. */
struct call {
    whole count, ncol, n, m, outputs, points;
    const double *left, *width, *nodes, *stages, *algebraic, *parameter, *tau; /* of the orbit */
    const double *places, *weights, *inner_weights, *derivatives; /* of the scheme: knots, barycentric weights */
    rows_at *rows;                                                 /* of the system */
    outputs_at *values_at;
    double *values;
    double period;
};

/* Lagrange polynomials of some knots at theta. */
static void lagrange(whole knots, const double *places, const double *weights, double theta, double *basis)
{
    for (whole l = 0; l < knots; l++) {
        basis[l] = weights[l];
        for (whole i = 0; i < knots; i++)
            if (i != l)
                basis[l] *= theta - places[i];
    }
}

/* The interval of a phase, and the place within it. */
static whole locate(const struct call *c, double tau, double *theta)
{
    const double begin = c->left[0], wrapped = fmod(tau - begin, c->period);
    const double place = begin + (wrapped < 0 ? wrapped + c->period : wrapped);
    whole low = 0, high = c->count; /* left[low] <= place < left[high] */
    while (high - low > 1) {
        const whole middle = (low + high) / 2;
        if (c->left[middle] <= place)
            low = middle;
        else
            high = middle;
    }
    *theta = fmin(1, fmax(0, (place - c->left[low]) / c->width[low]));
    return low;
}

/* Room for what is known at some points; the kernels write structural nonzeros only, so that derivatives begin as
   0. */
struct room {
    double *rate, *state, *algebraic, *derivatives, *both;
};

/* Lay it out in one piece of memory, which is returned; NULL where there is none. */
static double *lay_out(const struct call *c, whole points, struct room *r)
{
    const whole n = c->n, m = c->m, derived = m ? points * (n + m) * (2 + 2 * n + m) : 0;
    double *all = calloc(points * (2 * n + m) + derived + m * (m + 1) + 1, sizeof(double));
    r->rate = all;
    r->state = r->rate + points * n;
    r->algebraic = r->state + points * n;
    r->derivatives = r->algebraic + points * m;
    r->both = r->derivatives + derived;
    return all;
}

/* The state in an interval, from the values of the Lagrange polynomials there. */
static void state_in(const struct call *c, whole interval, const double *basis, double *state)
{
    const whole n = c->n, ncol = c->ncol;
    const double *begin = c->nodes + interval * n, *stage = c->stages + interval * ncol * n;
    for (whole i = 0; i < n; i++) {
        double sum = basis[0] * begin[i];
        for (whole l = 0; l < ncol; l++)
            sum += basis[l + 1] * stage[l * n + i];
        state[i] = sum;
    }
}

/* The rate in an interval, from the derivatives of the Lagrange polynomials there. From differences to the interval's
   begin, which are exact: rounding grows with 1 / width otherwise. */
static void rate_in(const struct call *c, whole interval, const double *slopes, double *rate)
{
    const whole n = c->n, ncol = c->ncol;
    const double *begin = c->nodes + interval * n, *stage = c->stages + interval * ncol * n;
    for (whole i = 0; i < n; i++) {
        double sum = 0;
        for (whole l = 0; l < ncol; l++)
            sum += slopes[l + 1] * (stage[l * n + i] - begin[i]);
        rate[i] = sum / c->width[interval];
    }
}

/* States, rates and a guess for the unknowns. */
static void interpolate(const struct call *c, const struct room *r, whole points, const double *tau)
{
    const whole knots = c->ncol + 1;
    double basis[16], slopes[16];
    for (whole i = 0; i < points; i++) {
        double theta;
        const whole at = locate(c, tau[i], &theta);
        lagrange(knots, c->places, c->weights, theta, basis);
        combine(knots, knots, basis, c->derivatives, slopes);
        state_in(c, at, basis, r->state + i * c->n);
        rate_in(c, at, slopes, r->rate + i * c->n);
        if (c->m) {
            lagrange(c->ncol, c->places + 1, c->inner_weights, theta, basis);
            combine(c->ncol, c->m, basis, c->algebraic + at * c->ncol * c->m, r->algebraic + i * c->m);
        }
    }
}

/* Solve for the unknowns. */
static int solve_unknowns(const struct call *c, const struct room *r, whole points, const double *tau)
{
    const whole n = c->n, m = c->m, rows = n + m;
    double *residual = r->derivatives, *d_rate = residual + points * rows, *d_state = d_rate + points * rows * n;
    double *d_algebraic = d_state + points * rows * n, *d_phase = d_algebraic + points * rows * m, *both = r->both;
    for (whole iteration = 0; iteration < ITERATIONS; iteration++) {
        double largest = 0;
        c->rows(points, r->rate, r->state, r->algebraic, tau, c->parameter, residual, d_rate, d_state, d_algebraic,
                d_phase, NULL);
        for (whole i = 0; i < points; i++) {
            if (!finite_all(rows, residual + i * rows) || !finite_all(rows * m, d_algebraic + i * rows * m))
                continue;
            for (whole row = 0; row < m; row++) {
                memcpy(both + row * (m + 1), d_algebraic + (i * rows + n + row) * m, m * sizeof(double));
                both[row * (m + 1) + m] = residual[i * rows + n + row];
            }
            if (solve(m, 1, both) != DONE)
                return SINGULAR;
            for (whole row = 0; row < m; row++) {
                const double change = both[row * (m + 1) + m];
                largest = fmax(largest, fabs(change));
                r->algebraic[i * m + row] -= fmin(LONGEST, fmax(-LONGEST, change));
            }
        }
        if (largest < CLOSE)
            break;
    }
    return DONE;
}

/* Outputs at some phases, (points, outputs). */
static int read_at(const struct call *c, const struct room *r, whole points, const double *tau, double *values)
{
    interpolate(c, r, points, tau);
    const int code = c->m ? solve_unknowns(c, r, points, tau) : DONE;
    if (code == DONE)
        c->values_at(points, r->rate, r->state, r->algebraic, tau, c->parameter, values);
    return code;
}

int outputs(const struct call *c)
{
    struct room room;
    double *all = lay_out(c, c->points, &room);
    const int code = all ? read_at(c, &room, c->points, c->tau, c->values) : SINGULAR;
    free(all);
    return code;
}
