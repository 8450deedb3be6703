
/* What modes answer to forces that are polynomials in an interval, as `periodic.condensed.modal` has it.

   Arrays are contiguous, row by row, complex numbers as pairs; names and shapes are those of the Python code,
   but that what belongs to an interval is kept once for each of the U distinct widths. */

struct response {
    whole count, points, modes, states, forces, widths, terms;
    const whole *which;                            /* (N) which width an interval has */
    const double *width;                           /* (U) */
    const double *place;                           /* (a) collocation points */
    const double *taylor;                          /* (terms, a, b) */
    const double *derivatives;                     /* (order, 1+a, b) */
    const double *exponents, *inputs, *outputs;    /* (J), (J, k), (s, J), complex */
    const double *direct, *direct_rate;            /* (s, k) */
    double *growth, *moment, *slope;               /* (U, J, a), (U, J, a, b) twice, complex */
    double *local, *impulse, *shown;               /* (U, a, s, b, k); (U, J, b, k), (U, a, s, J), complex */
    double near;                                   /* |x| up to which the series is taken */
};

typedef struct {
    double re, im;
} complex_;

static inline complex_ at(const double *values, whole k)
{
    const complex_ found = {values[2 * k], values[2 * k + 1]};
    return found;
}

static inline void put(double *values, whole k, complex_ z)
{
    values[2 * k] = z.re;
    values[2 * k + 1] = z.im;
}

static inline complex_ times(complex_ a, complex_ b)
{
    const complex_ found = {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
    return found;
}

static inline complex_ scaled(complex_ a, double factor)
{
    const complex_ found = {a.re * factor, a.im * factor};
    return found;
}

static inline complex_ plus(complex_ a, complex_ b)
{
    const complex_ found = {a.re + b.re, a.im + b.im};
    return found;
}

/* The real part of the sum of so many products, right ones `step` apart: partial sums, of which none waits for
   another. */
static inline double real_sum(whole count, const double *left, const double *right, whole step)
{
    double a = 0, b = 0, c = 0, d = 0;
    whole k = 0;
    for (; k + 1 < count; k += 2, left += 4, right += 4 * step) {
        a += left[0] * right[0];
        b += left[1] * right[1];
        c += left[2] * right[2 * step];
        d += left[3] * right[2 * step + 1];
    }
    if (k < count) {
        a += left[0] * right[0];
        b += left[1] * right[1];
    }
    return (a + c) - (b + d);
}

/* The sum of so many complex numbers times real ones, which lie `step` apart. */
static inline complex_ weighted(whole count, const double *left, const double *right, whole step)
{
    complex_ sum = {0, 0};
    for (whole k = 0; k < count; k++)
        sum = plus(sum, scaled(at(left, k), right[k * step]));
    return sum;
}

static inline complex_ exponential(complex_ x)
{
    const double size = exp(x.re);
    const complex_ found = {size * cos(x.im), size * sin(x.im)};
    return found;
}

/* moment and slope (a, b) at x by their Taylor series, whose terms are added until they no longer count. */
static void series(const struct response *r, complex_ x, double *restrict moment, double *restrict slope)
{
    const whole each = r->points * r->points;
    const double size = hypot(x.re, x.im);
    complex_ power = {1, 0};
    double bound = 1;
    memset(moment, 0, 2 * each * sizeof(double));
    memset(slope, 0, 2 * each * sizeof(double));
    for (whole m = 0; m < r->terms && bound > 0x1p-70; m++) {
        const double *c = r->taylor + m * each, *next = c + each;
        const double more = m + 1 < r->terms ? (double)(m + 1) : 0;
        for (whole i = 0; i < each; i++) {
            moment[2 * i] += c[i] * power.re;
            moment[2 * i + 1] += c[i] * power.im;
        }
        if (more != 0)
            for (whole i = 0; i < each; i++) {
                slope[2 * i] += more * next[i] * power.re;
                slope[2 * i + 1] += more * next[i] * power.im;
            }
        power = times(power, x);
        bound *= size / (double)(m + 1);
    }
}

/* The same in closed form by the derivatives of l_b; growth (a). */
static void closed_form(const struct response *r, complex_ x, const double *growth, double *restrict moment,
                        double *restrict slope)
{
    const whole points = r->points, row = points, order = (1 + points) * points;
    const double size = x.re * x.re + x.im * x.im;
    const complex_ inverse = {x.re / size, -x.im / size};
    complex_ power[17], steep[17];
    power[0] = inverse;
    for (whole p = 0; p < points; p++) {
        power[p + 1] = times(power[p], inverse);
        steep[p] = scaled(power[p + 1], -(double)(p + 1));
    }
    for (whole b = 0; b < points; b++) {
        complex_ value[16], change[16];
        for (whole e = 0; e <= points; e++) {
            value[e] = change[e] = (complex_){0, 0};
            for (whole p = 0; p < points; p++) {
                const double c = r->derivatives[p * order + e * row + b];
                value[e] = plus(value[e], scaled(power[p], c));
                change[e] = plus(change[e], scaled(steep[p], c));
            }
        }
        for (whole a = 0; a < points; a++) {
            const complex_ grown = at(growth, a);
            const complex_ begun = plus(scaled(value[0], r->place[a]), change[0]);
            put(moment, a * points + b, plus(times(grown, value[0]), scaled(value[1 + a], -1)));
            put(slope, a * points + b, plus(times(grown, begun), scaled(change[1 + a], -1)));
        }
    }
}

/* States at the points by the forces of an interval of a width. */
static void lay_local(const struct response *r, whole u)
{
    const whole points = r->points, s = r->states, k = r->forces, J = r->modes;
    const double h = r->width[u], *moment = r->moment + 2 * u * J * points * points;
    double *local = r->local + u * points * s * points * k;
    const double *rates = r->derivatives + (1 + points) * points + points; /* first derivatives at the points */
    memset(local, 0, points * s * points * k * sizeof(double));
    for (whole j = 0; j < J; j++)
        for (whole i = 0; i < s; i++) {
            const complex_ out = at(r->outputs, i * J + j);
            for (whole l = 0; l < k; l++) {
                const complex_ weight = times(out, at(r->inputs, j * k + l));
                const double *m = moment + 2 * j * points * points;
                if (weight.re == 0 && weight.im == 0)
                    continue;
                for (whole a = 0; a < points; a++)
                    for (whole b = 0; b < points; b++, m += 2)
                        local[((a * s + i) * points + b) * k + l] += h * (m[0] * weight.re - m[1] * weight.im);
            }
        }
    for (whole a = 0; a < points; a++)
        for (whole i = 0; i < s; i++)
            for (whole l = 0; l < k; l++) {
                double *row = local + (a * s + i) * points * k + l;
                row[a * k] += r->direct[i * k + l];
                for (whole b = 0; b < points; b++)
                    row[b * k] += rates[a * points + b] / h * r->direct_rate[i * k + l];
            }
}

/* All tables of a response. */
int lay_out(const struct response *r)
{
    const whole points = r->points, s = r->states, k = r->forces, J = r->modes, each = points * points;
    for (whole u = 0; u < r->widths; u++) {
        const double h = r->width[u];
        for (whole j = 0; j < J; j++) {
            const whole here = u * J + j;
            const complex_ x = scaled(at(r->exponents, j), h);
            double *growth = r->growth + 2 * here * points;
            double *moment = r->moment + 2 * here * each, *slope = r->slope + 2 * here * each;
            for (whole a = 0; a < points; a++)
                put(growth, a, exponential(scaled(x, r->place[a])));
            if (hypot(x.re, x.im) <= r->near)
                series(r, x, moment, slope);
            else
                closed_form(r, x, growth, moment, slope);
            const double *last = moment + 2 * (points - 1) * points;
            for (whole b = 0; b < points; b++)
                for (whole l = 0; l < k; l++)
                    put(r->impulse, (here * points + b) * k + l,
                        scaled(times(at(last, b), at(r->inputs, j * k + l)), h));
            for (whole a = 0; a < points; a++)
                for (whole i = 0; i < s; i++)
                    put(r->shown, ((u * points + a) * s + i) * J + j,
                        times(at(growth, a), at(r->outputs, i * J + j)));
        }
        lay_local(r, u);
    }
    return DONE;
}
