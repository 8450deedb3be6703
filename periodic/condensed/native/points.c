
/* The rows of a split system at the collocation points, unknowns eliminated: as `condensed/linearised.py` does. */

struct points {
    whole count, ncol, n, m, e, q, linear, acting, own; /* sizes; linear: states of the linear part; own: rows at most */
    const double *residual, *d_rate, *d_state, *d_algebraic, *d_phase, *d_parameter; /* (P, n+m, ...) */
    const double *rates, *place, *width, *left_gradient, *width_gradient;
    const whole *states, *forces;                   /* (linear); (acting) of the unknowns, forces on them */
    double *unknowns, *rows, *work;                 /* (P, m, w), (P, own, w); (n+m, w) and (m, m+w) */
    whole *filled;                                  /* (n): differential rows that are not 0 */
    double largest;
    whole found, accelerations;
};

/* Whether a row is not 0 at a point. */
static int filled(const struct points *p, whole k, whole r)
{
    const whole n = p->n, m = p->m, at = k * (n + m) + r;
    if (p->residual[at] != 0 || p->d_phase[at] != 0)
        return 1;
    for (whole i = 0; i < n; i++)
        if (p->d_rate[at * n + i] != 0 || p->d_state[at * n + i] != 0)
            return 1;
    for (whole i = 0; i < m; i++)
        if (p->d_algebraic[at * m + i] != 0)
            return 1;
    for (whole i = 0; i < p->q; i++)
        if (p->d_parameter[at * p->q + i] != 0)
            return 1;
    return 0;
}

/* Differential rows that any point fills: `filled` lists them; their number. Where the points of one interval fill
   as many as there are to be, the others are not read. */
static whole fill(const struct points *p)
{
    whole found = 0;
    for (whole points = p->ncol; points <= p->count * p->ncol; points = p->count * p->ncol) {
        found = 0;
        for (whole r = 0; r < p->n; r++) {
            whole k = 0;
            while (k < points && !filled(p, k, r))
                k++;
            if (k < points)
                p->filled[found++] = r;
        }
        if (found == p->own || points == p->count * p->ncol)
            break;
    }
    return found;
}

/* A row in (1, d rate, d state, dphi, dp); what is not finite makes `lost` NaN. */
static void laid(const struct points *p, whole k, whole r, double *restrict row, double *lost)
{
    const whole n = p->n, e = p->e, at = k * (n + p->m) + r, i = k / p->ncol;
    const double *by_rate = p->d_rate + at * n, *rate = p->rates + k * n;
    double along = 0, sum = 0;
    row[0] = p->residual[at];
    memcpy(row + 1, by_rate, n * sizeof(double));
    memcpy(row + 1 + n, p->d_state + at * n, n * sizeof(double));
    for (whole s = 0; s < n; s++)
        along += by_rate[s] * rate[s];
    for (whole c = 0; c < e; c++) {
        const double stretch = p->width_gradient[i * e + c];
        const double shift = p->left_gradient[i * e + c] + stretch * p->place[k % p->ncol];
        row[1 + 2 * n + c] = p->d_phase[at] * shift - along * (stretch / p->width[i]);
    }
    memcpy(row + 1 + 2 * n + e, p->d_parameter + at * p->q, p->q * sizeof(double));
    for (whole c = 0; c < 1 + 2 * n + e + p->q; c++)
        sum += row[c] * 0.0;
    for (whole l = 0; l < p->m; l++)
        sum += p->d_algebraic[at * p->m + l] * 0.0;
    *lost += sum;
}

/* Whether a row depends on rates of the linear part's states. */
static int depends(const struct points *p, const double *row)
{
    for (whole s = 0; s < p->linear; s++)
        if (row[1 + p->states[s]] != 0)
            return 1;
    return 0;
}

/* All points. */
int eliminate_points(struct points *p)
{
    const whole n = p->n, m = p->m, w = 1 + 2 * n + p->e + p->q, points = p->count * p->ncol;
    double *both = p->work, lost = 0;
    p->found = fill(p);
    p->accelerations = 0;
    p->largest = 0;
    if (p->found > p->own)
        return DONE;
    for (whole k = 0; k < points; k++) {
        double *restrict unknowns = p->unknowns + k * m * w;
        for (whole l = 0; l < m; l++) {
            double *row = both + l * (m + w);
            memcpy(row, p->d_algebraic + (k * (n + m) + n + l) * m, m * sizeof(double));
            laid(p, k, n + l, row + m, &lost);
            p->largest = fmax(p->largest, fabs(row[m]));
        }
        if (!(lost == 0))
            return NOT_FINITE;
        if (solve(m, w, both))
            return SINGULAR;
        for (whole l = 0; l < m; l++)
            for (whole c = 0; c < w; c++)
                unknowns[l * w + c] = -both[l * (m + w) + m + c];
        for (whole f = 0; f < p->acting; f++)
            p->accelerations |= depends(p, unknowns + p->forces[f] * w);
        for (whole f = 0; f < p->found; f++) {
            double *row = p->rows + (k * p->own + f) * w;
            const double *by = p->d_algebraic + (k * (n + m) + p->filled[f]) * m;
            laid(p, k, p->filled[f], row, &lost);
            p->largest = fmax(p->largest, fabs(row[0]));
            for (whole l = 0; l < m; l++)
                if (by[l] != 0)
                    for (whole c = 0; c < w; c++)
                        row[c] += by[l] * unknowns[l * w + c];
            p->accelerations |= depends(p, row);
        }
        if (!(lost == 0))
            return NOT_FINITE;
    }
    return DONE;
}
