
/* What `periodic.correction.error.deferred` does on the mesh with every interval halved, in one call. It follows
   `newton.c` in one source. */

/* As `periodic.collocation.native.estimate.Estimate` fills it. */
struct estimate {
    const double *nodes, *stages, *algebraic, *phases, *parameter; /* the orbit, on its own mesh */
    const double *profile;                                         /* of its branch's direction, (count / 2 + 1, n) */
    const double *stages_of, *unknowns_of, *middle;                /* the scheme's halves */
    double *fundamental, *steps;                                   /* matrices of the halved mesh, (count + 1, n, n) */
    double *monodromy, *better_steps;                              /* that of the better orbit, (n, n) */
    double *better_nodes, *better_stages, *better_algebraic, *better_phases, *better_parameter; /* that itself */
    double along, scale, unit; /* the direction's parameter, the units of arclength in parameter and states */
    double reach, straight, steep, rounding, digits, fast;         /* limits: see estimate.py */
    double apart, shift;                                           /* errors of the states and of the parameter */
    whole unresolved;                                              /* whether a vibration is too fast for the mesh */
};

/* Room for the orbit on the halved mesh, its maps, increment and kernel, and for what it is held against; it is
   returned, NULL where there is none. */
static double *own_room(struct call *c, double **next)
{
    const whole n = c->n, k = c->k, points = c->count * c->ncol, ends = (c->count + 1) * n;
    const whole orbit = ends + points * (n + c->m) + k + c->parameters;
    const whole held = 3 * ends + 2 * c->count * (c->ncol + 1) * n + 3 * c->count + 1 + 3 * k;
    double *all = malloc((3 * orbit + 2 + ends * (2 + n + k) + held) * sizeof(double));
    if (!all)
        return NULL;
    *next = all;
    c->nodes = taken(next, ends);
    c->stages = taken(next, points * n);
    c->algebraic = taken(next, points * c->m);
    c->phases = taken(next, k);
    c->parameter = taken(next, c->parameters);
    c->maps = taken(next, ends * (2 + n + k));
    struct change *changes[] = {&c->increment, &c->kernel};
    for (whole i = 0; i < 2; i++) {
        changes[i]->nodes = taken(next, ends);
        changes[i]->stages = taken(next, points * n);
        changes[i]->algebraic = taken(next, points * c->m);
        changes[i]->outer = taken(next, k + 1);
    }
    return all;
}

/* The orbit on the halved mesh: the same polynomials. values: room for (ncol + 1) n numbers. */
static void halve(struct call *c, const struct estimate *e, double *values)
{
    const whole n = c->n, m = c->m, ncol = c->ncol, coarse = c->count / 2;
    for (whole j = 0; j < coarse; j++) {
        memcpy(values, e->nodes + j * n, n * sizeof(double));
        memcpy(values + n, e->stages + j * ncol * n, ncol * n * sizeof(double));
        memcpy(c->nodes + 2 * j * n, values, n * sizeof(double));
        combine(ncol + 1, n, e->middle, values, c->nodes + (2 * j + 1) * n);
        for (whole l = 0; l < 2 * ncol; l++)
            combine(ncol + 1, n, e->stages_of + l * (ncol + 1), values, c->stages + (2 * j * ncol + l) * n);
        for (whole l = 0; m && l < 2 * ncol; l++)
            combine(ncol, m, e->unknowns_of + l * ncol, e->algebraic + j * ncol * m,
                    c->algebraic + (2 * j * ncol + l) * m);
    }
    memcpy(c->nodes + c->count * n, e->nodes + coarse * n, n * sizeof(double));
    memcpy(c->phases, e->phases, c->k * sizeof(double));
    memcpy(c->parameter, e->parameter, c->parameters * sizeof(double));
}

/* Weights of the mesh points in the metric, (count + 1): see `periodic.linear.unknowns.metric_weights`. */
static double *metric(const struct call *c, const struct estimate *e, const struct room *r, double **next)
{
    const whole n = c->n, each = (c->ncol + 1) * n;
    double *weights = taken(next, c->count + 1), whole_width = 0;
    for (whole j = 0; j < c->count; j++)
        whole_width += r->width[j];
    for (whole j = 0; j <= c->count; j++) {
        const double before = j ? r->width[j - 1] : 0, after = j < c->count ? r->width[j] : 0;
        const double steep = largest(n, r->rates + (j < c->count ? j : 0) * each, 0) / (e->steep * e->unit);
        weights[j] = (before + after) / (2 * whole_width);
        if (c->exact)
            weights[j] /= 1 + steep * steep * steep * steep;
    }
    return weights;
}

static const double *copied(whole size, const double *values, double **next)
{
    return memcpy(taken(next, size), values, size * sizeof(double));
}

/* Hold the orbit on the arclength constraint across its branch, which it is on. */
static void hold(struct call *c, const struct estimate *e, struct room *r, const double *weights, double **next)
{
    const whole n = c->n, each = (c->ncol + 1) * n, ends = (c->count + 1) * n;
    double *weighted = taken(next, ends), *rates = taken(next, ends);
    for (whole j = 0; j <= c->count; j++)
        for (whole s = 0; s < n; s++) {
            const double *before = e->profile + j / 2 * n + s, *after = e->profile + (j + 1) / 2 * n + s;
            weighted[j * n + s] = weights[j] / (e->unit * e->unit) * (*before + *after) / 2;
            rates[j * n + s] = r->rates[(j < c->count ? j : 0) * each + s];
        }
    c->weighted = weighted;
    c->origin_node_rates = rates;
    c->origin_nodes = copied(ends, c->nodes, next);
    c->origin_knots = copied(c->count * each, r->knots, next);
    c->origin_knot_rates = copied(c->count * each, r->rates, next);
    c->origin_left = copied(c->count, r->left, next);
    c->origin_width = copied(c->count, r->width, next);
    c->origin_phases = copied(c->k, c->phases, next);
    c->origin_parameter = c->parameter[c->free];
    c->slope = e->along / (e->scale * e->scale);
    c->distance = 0;
    c->lengths = memset(taken(next, c->k), 0, c->k * sizeof(double));
}

/* Linearise with event nodes as far beside their levels as rounding may leave them: see rounding.py. */
static int linearised_beside(struct call *c, const struct estimate *e, struct room *r, const double *levels,
                             double *beside)
{
    const whole n = c->n;
    for (whole a = 0; a < c->k; a++) {
        const double *state = c->nodes + c->starts[a] * n, *slope = r->by_state + c->switch_of[a] * n;
        double terms = 0;
        slopes(c, r, a);
        for (whole s = 0; s < n; s++)
            terms += fabs(slope[s] * state[s]);
        beside[a] = levels[a] - e->rounding * terms;
    }
    c->levels = beside;
    return linearised(c, r);
}

/* The largest change of the states at fixed tau, at mesh points and at collocation points. */
static double moved_by(const struct call *c, const struct change *d)
{
    const whole n = c->n, k = c->k, knots = c->ncol + 1;
    double most = 0;
    for (whole j = 0; j <= c->count; j++)
        for (whole l = 0; l < (j < c->count ? knots : 1); l++) {
            const whole at = j < c->count ? j : 0;
            const double *change = l ? d->stages + (j * c->ncol + l - 1) * n : d->nodes + j * n;
            const double *rates = c->origin_knot_rates + (at * knots + l) * n;
            double later = 0;
            for (whole a = 0; a < k; a++)
                later += d->outer[a] * (c->left_gradient[at * k + a]
                                        + (l ? c->points[l - 1] * c->width_gradient[at * k + a] : 0));
            for (whole s = 0; s < n; s++)
                most = fmax(most, fabs(change[s] - rates[s] * later));
        }
    return most;
}

/* Arclength of the kernel. */
static double kernel_length(const struct call *c, const struct estimate *e, const double *weights)
{
    const whole n = c->n, k = c->k, each = (c->ncol + 1) * n;
    const double own = c->kernel.outer[k] / e->scale;
    double states = 0;
    for (whole j = 0; j <= c->count; j++) {
        const whole at = j < c->count ? j : 0;
        double later = 0;
        for (whole a = 0; a < k; a++)
            later += c->kernel.outer[a] * c->left_gradient[at * k + a];
        for (whole s = 0; s < n; s++) {
            const double change = c->kernel.nodes[j * n + s] - c->origin_knot_rates[at * each + s] * later;
            states += weights[j] * change * change;
        }
    }
    return sqrt(states / (e->unit * e->unit) + own * own);
}

/* Go to the orbit that the increment kept leads to, so many kernels further than before. */
static void go(struct call *c, struct room *r, double further)
{
    const whole ends = (c->count + 1) * c->n, points = c->count * c->ncol;
    const whole sizes[] = {ends, points * c->n, points * c->m, c->k + 1};
    const double *const by[] = {c->kernel.nodes, c->kernel.stages, c->kernel.algebraic, c->kernel.outer};
    double *to = r->kept + ends + points * (c->n + c->m) + c->k + 1;
    for (whole part = 0; part < 4; part++)
        for (whole i = 0; i < sizes[part]; i++)
            *to++ += further * by[part][i];
    move(c, r, 1);
}

/* The largest change of a segment's length, relative where it is shorter than 1 rad, on the way of so many
   increments and kernels: see `periodic.correction.newton.stretched`. */
static double stretched(const struct call *c, double increments, double kernels)
{
    const double *one = c->increment.outer, *other = c->kernel.outer;
    double most = 0;
    for (whole a = 0; a < c->k; a++) {
        const whole next = a + 1 < c->k ? a + 1 : 0;
        const double own = (next ? c->phases[next] : c->phases[0] + c->period) - c->phases[a];
        const double change = increments * (one[next] - one[a]) + kernels * (other[next] - other[a]);
        most = fmax(most, fabs(change) / fmin(own, 1));
    }
    return most;
}

/* Linearise at the orbit of the same parameter, which is known to its last digits, where the branch is straight
   on the way, else at the nearest one: see error.py. */
static int at_same_parameter(struct call *c, const struct estimate *e, struct room *r, const double *levels,
                             double *beside, const double *weights)
{
    const whole k = c->k, last = c->n + k + 1;
    const double rate = c->kernel.outer[k], length = kernel_length(c, e, weights), shift = c->increment.outer[k];
    const double least = copysign(e->digits * fabs(c->parameter[c->free]), shift), far[] = {shift, 0};
    double ways[2] = {0, 0}, gone = 0;
    for (whole i = 0; i < 2; i++) { /* to the side on which lengths change more */
        double most = -1;
        for (whole side = 1; side >= -1; side -= 2) {
            const double way = far[i] + side * least, kernels = -way / rate;
            if (rate == 0 || !(length * fabs(way) <= e->reach * fabs(rate)) || !(stretched(c, 0, kernels) <= 1))
                continue;
            const double both = stretched(c, 1, kernels);
            if (both > most) {
                most = both;
                ways[i] = kernels;
            }
        }
    }
    keep(c, r);
    for (whole i = 0; i < 2; i++) {
        if (ways[i] == 0)
            continue;
        go(c, r, ways[i] - gone);
        gone = ways[i];
        if (linearised_beside(c, e, r, levels, beside) != DONE)
            continue;
        const double changed = r->bordered[(last - 1) * (last + 2) + last + 1] / rate;
        if (1 / e->straight < changed && changed < e->straight)
            return DONE;
    }
    go(c, r, -gone);
    return linearised_beside(c, e, r, levels, beside);
}

/* Whether J J of dx' = J dx, at the end of each interval's first half, says that a vibration turns too far in
   the interval; work: room for (n + m) (2 n + m) + n numbers. */
static int unresolved(const struct call *c, const struct estimate *e, const struct room *r, double *work)
{
    const whole n = c->n, rows = n + c->m, wide = rows + n;
    for (whole j = 0; j < c->count; j += 2) {
        if (by_states(c, r, j * c->ncol + c->ncol - 1, work) != DONE)
            return 1;
        const double width = r->width[j] + r->width[j + 1];
        for (whole i = 0; i < n; i++) {
            double sum = 0, *square = work + rows * wide;
            memset(square, 0, n * sizeof(double));
            for (whole l = 0; l < n; l++)
                for (whole s = 0; s < n; s++)
                    square[s] += work[i * wide + rows + l] * work[l * wide + rows + s];
            for (whole s = 0; s < n; s++)
                sum += fabs(square[s]);
            if (!(sum * width * width <= e->fast * e->fast))
                return 1;
        }
    }
    return 0;
}

/* Give the better orbit. */
static void hand_over(const struct call *c, struct estimate *e)
{
    const whole points = c->count * c->ncol;
    memcpy(e->better_nodes, c->nodes, (c->count + 1) * c->n * sizeof(double));
    memcpy(e->better_stages, c->stages, points * c->n * sizeof(double));
    memcpy(e->better_algebraic, c->algebraic, points * c->m * sizeof(double));
    memcpy(e->better_phases, c->phases, c->k * sizeof(double));
    memcpy(e->better_parameter, c->parameter, c->parameters * sizeof(double));
}

static int estimated(struct call *c, struct estimate *e, struct room *r, double *next)
{
    const whole n = c->n, k = c->k, w = 1 + n + k + 1, last = n + k + 1;
    const double *levels = c->levels;
    double *beside = taken(&next, k);
    halve(c, e, r->knots);
    int code = unfold(c, r);
    if (code != DONE)
        return code;
    const double *weights = metric(c, e, r, &next);
    hold(c, e, r, weights, &next);
    code = linearised_beside(c, e, r, levels, beside);
    if (code != DONE)
        return code;
    for (whole i = 0; i < (c->count + 1) * n; i++)
        memcpy(e->fundamental + i * n, c->maps + i * w + 1, n * sizeof(double));
    hand_steps(c, r, e->steps);
    e->unresolved = unresolved(c, e, r, r->work);
    e->apart = moved_by(c, &c->increment);
    e->shift = fabs(c->increment.outer[k]);
    if (c->exact) { /* multipliers depend on when the equations change: those of the better orbit */
        spread(c, r, 0, r->bordered + last + 1, last + 2, &c->kernel);
        code = at_same_parameter(c, e, r, levels, beside, weights);
    } else {
        keep(c, r);
        move(c, r, 1);
    }
    hand_over(c, e);
    hand_steps(c, r, e->better_steps);
    for (whole i = 0; i < n; i++)
        memcpy(e->monodromy + i * n, c->maps + (c->count * n + i) * w + 1, n * sizeof(double));
    return code;
}

/* Estimate the error of an orbit; the call is that of the halved mesh. */
int estimate(struct call *c, struct estimate *e)
{
    struct room room;
    double *next, *own = own_room(c, &next), *all = lay_out(c, &room);
    const int code = own && all ? estimated(c, e, &room, next) : NO_ROOM;
    free(own);
    free(all);
    return code;
}
