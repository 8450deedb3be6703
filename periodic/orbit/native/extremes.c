
/* Extremes of the outputs over an orbit: what `periodic.orbit.extrema.extrema` does. It follows `outputs.c` in one
   source. */

#define CANDIDATES 3 /* as in extrema.py */
#define RISE 2.0
#define ZOOMS 2
#define SAMPLES 9
#define SHORT 1e-5

/* What is looked through: an output at the collocation points, with a sign. */
struct samples {
    const struct call *orbit;
    const struct room *room;
    const double *tau, *values; /* (count), (count, outputs) */
    double *read;               /* room for (SAMPLES, outputs) */
    whole count, output;
    double sign, shortest; /* the width of intervals below which they do not count */
};

/* The highest value that has been found, and where. */
struct peak {
    double value, phase;
};

/* The value of a sample, counted round the period. */
static double at(const struct samples *s, whole i)
{
    const whole place = i < 0 ? i + s->count : i < s->count ? i : i - s->count;
    if (s->orbit->width[place / s->orbit->ncol] < s->shortest)
        return -DBL_MAX;
    return s->sign * s->values[place * s->orbit->outputs + s->output];
}

/* The highest samples that are no lower than their neighbours, the highest first; returns how many. */
static whole candidates(const struct samples *s, whole *found)
{
    whole count = 0;
    for (whole i = 0; i < s->count; i++) {
        const double own = at(s, i);
        if (!(own >= at(s, i - 1) && own >= at(s, i + 1)))
            continue;
        whole place = count;
        while (place && own > at(s, found[place - 1]))
            place--;
        if (place == CANDIDATES)
            continue;
        count += count < CANDIDATES;
        for (whole later = count - 1; later > place; later--)
            found[later] = found[later - 1];
        found[place] = i;
    }
    return count;
}

/* Place of the vertex of the parabola through the highest of some values and its neighbours, relative to it. */
static double vertex(const double *values, whole highest)
{
    if (highest == 0 || highest == SAMPLES - 1)
        return 0;
    const double low = values[highest - 1], high = values[highest + 1], bend = low - 2 * values[highest] + high;
    return bend < 0 ? (low - high) / (2 * bend) : 0;
}

/* Look for the maximum about a sample, on finer and finer windows. */
static int zoom(const struct samples *s, double centre, double radius, struct peak *best)
{
    const struct call *c = s->orbit;
    double tau[SAMPLES], own[SAMPLES], theta;
    for (whole step = 0; step <= ZOOMS; step++) {
        const whole count = step < ZOOMS ? SAMPLES : 1;
        whole highest = 0;
        for (whole i = 0; i < count; i++)
            tau[i] = count > 1 ? centre + radius * (2.0 * i / (SAMPLES - 1) - 1) : centre;
        if (read_at(c, s->room, count, tau, s->read) != DONE)
            return SINGULAR;
        for (whole i = 0; i < count; i++) {
            const double width = c->width[locate(c, tau[i], &theta)];
            own[i] = width < s->shortest ? -DBL_MAX : s->sign * s->read[i * c->outputs + s->output];
            if (own[i] > own[highest])
                highest = i;
        }
        if (own[highest] > best->value)
            *best = (struct peak){own[highest], tau[highest]};
        radius *= 2.0 / (SAMPLES - 1);
        centre = tau[highest] + (count > 1 ? radius * vertex(own, highest) : 0);
    }
    return DONE;
}

/* The maximum of sign times an output. */
static int highest(const struct samples *s, struct peak *found)
{
    whole places[CANDIDATES];
    const whole count = candidates(s, places);
    *found = (struct peak){NAN, s->tau[0]};
    for (whole i = 0; i < count; i++) {
        const whole p = places[i], last = s->count - 1;
        const double own = at(s, p), rise = own - fmin(at(s, p - 1), at(s, p + 1));
        if (!(own + RISE * rise >= at(s, places[0])))
            continue;
        const double before = p ? s->tau[p - 1] : s->tau[last] - s->orbit->period;
        const double after = p < last ? s->tau[p + 1] : s->tau[0] + s->orbit->period;
        struct peak best = {own, s->tau[p]};
        if (zoom(s, s->tau[p], fmax(s->tau[p] - before, after - s->tau[p]), &best) != DONE)
            return SINGULAR;
        if (i == 0 || best.value > found->value)
            *found = best;
    }
    return DONE;
}

/* The outputs at the collocation points, and their phases. */
static void sample(const struct call *c, double *rate, double *state, double *tau, double *values)
{
    const whole n = c->n, ncol = c->ncol;
    memcpy(state, c->stages, c->count * ncol * n * sizeof(double));
    for (whole j = 0, point = 0; j < c->count; j++)
        for (whole l = 1; l <= ncol; l++, point++) {
            rate_in(c, j, c->derivatives + l * (ncol + 1), rate + point * n);
            tau[point] = c->left[j] + c->width[j] * c->places[l];
        }
    c->values_at(c->count * ncol, rate, state, c->algebraic, tau, c->parameter, values);
}

static int searched(const struct call *c, struct samples *s)
{
    double widest = 0;
    for (whole j = 0; j < c->count; j++)
        widest = fmax(widest, c->width[j]);
    s->shortest = widest < SHORT ? 0 : SHORT;
    for (whole i = 0; i < 2 * c->outputs; i++) {
        struct peak found;
        s->output = i % c->outputs;
        s->sign = i < c->outputs ? -1 : 1;
        if (highest(s, &found) != DONE)
            return SINGULAR;
        c->values[i] = s->sign * found.value;
        c->values[2 * c->outputs + i] = found.phase;
    }
    return DONE;
}

/* Minima and maxima of the outputs, then the phases of both, into values (4, outputs). */
int extremes(const struct call *c)
{
    const whole points = c->count * c->ncol;
    struct room room;
    double *all = lay_out(c, SAMPLES, &room);
    double *own = calloc(points * (2 * c->n + 1 + c->outputs) + SAMPLES * c->outputs, sizeof(double));
    int code = SINGULAR;
    if (all && own) {
        double *state = own + points * c->n, *tau = state + points * c->n, *values = tau + points;
        sample(c, own, state, tau, values);
        code = searched(c, &(struct samples){c, &room, tau, values, values + points * c->outputs, points});
    }
    free(all);
    free(own);
    return code;
}
