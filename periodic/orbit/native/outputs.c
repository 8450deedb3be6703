
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
    const double *left, *width, *knots, *knot_rates, *algebraic, *parameter, *tau; /* of the orbit */
    const double *places, *weights, *inner_weights; /* of the scheme: knots, barycentric weights */
    rows_at *rows;                                   /* of the system */
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

static void combine(whole knots, whole n, const double *basis, const double *values, double *restrict sum)
{
    memset(sum, 0, n * sizeof(double));
    for (whole l = 0; l < knots; l++)
        for (whole s = 0; s < n; s++)
            sum[s] += basis[l] * values[l * n + s];
}

/* States, rates and a guess for the unknowns. */
static void interpolate(const struct call *c, double *rate, double *state, double *algebraic)
{
    const whole knots = c->ncol + 1;
    double basis[16];
    for (whole i = 0; i < c->points; i++) {
        const double begin = c->left[0];
        double place = fmod(c->tau[i] - begin, c->period);
        place = begin + (place < 0 ? place + c->period : place);
        whole low = 0, high = c->count; /* left[low] <= place < left[high] */
        while (high - low > 1) {
            const whole middle = (low + high) / 2;
            if (c->left[middle] <= place)
                low = middle;
            else
                high = middle;
        }
        const double theta = fmin(1, fmax(0, (place - c->left[low]) / c->width[low]));
        lagrange(knots, c->places, c->weights, theta, basis);
        combine(knots, c->n, basis, c->knots + low * knots * c->n, state + i * c->n);
        combine(knots, c->n, basis, c->knot_rates + low * knots * c->n, rate + i * c->n);
        if (c->m) {
            lagrange(c->ncol, c->places + 1, c->inner_weights, theta, basis);
            combine(c->ncol, c->m, basis, c->algebraic + low * c->ncol * c->m, algebraic + i * c->m);
        }
    }
}

/* Solve for the unknowns; derivatives hold room for the kernel's results, `both` for m (m + 1) numbers. */
static int solve_unknowns(const struct call *c, const double *rate, const double *state, double *algebraic,
                          double *derivatives, double *both)
{
    const whole n = c->n, m = c->m, rows = n + m;
    double *residual = derivatives, *d_rate = residual + c->points * rows, *d_state = d_rate + c->points * rows * n;
    double *d_algebraic = d_state + c->points * rows * n, *d_phase = d_algebraic + c->points * rows * m;
    for (whole iteration = 0; iteration < ITERATIONS; iteration++) {
        double largest = 0;
        c->rows(c->points, rate, state, algebraic, c->tau, c->parameter, residual, d_rate, d_state, d_algebraic,
                d_phase, NULL);
        for (whole i = 0; i < c->points; i++) {
            if (!finite_all(rows, residual + i * rows) || !finite_all(rows * m, d_algebraic + i * rows * m))
                continue;
            for (whole r = 0; r < m; r++) {
                memcpy(both + r * (m + 1), d_algebraic + (i * rows + n + r) * m, m * sizeof(double));
                both[r * (m + 1) + m] = residual[i * rows + n + r];
            }
            if (solve(m, 1, both) != DONE)
                return SINGULAR;
            for (whole r = 0; r < m; r++) {
                const double change = both[r * (m + 1) + m];
                largest = fmax(largest, fabs(change));
                algebraic[i * m + r] -= fmin(LONGEST, fmax(-LONGEST, change));
            }
        }
        if (largest < CLOSE)
            break;
    }
    return DONE;
}

int outputs(const struct call *c)
{
    const whole n = c->n, m = c->m, rows = n + m, derived = m ? c->points * rows * (2 + 2 * n + m) : 0;
    double *all = calloc(c->points * (2 * n + m) + derived + m * (m + 1) + 1, sizeof(double));
    if (!all)
        return SINGULAR;
    double *rate = all, *state = rate + c->points * n, *algebraic = state + c->points * n;
    double *derivatives = algebraic + c->points * m;
    interpolate(c, rate, state, algebraic);
    const int code = m ? solve_unknowns(c, rate, state, algebraic, derivatives, derivatives + derived) : DONE;
    if (code == DONE)
        c->values_at(c->points, rate, state, algebraic, c->tau, c->parameter, c->values);
    free(all);
    return code;
}
