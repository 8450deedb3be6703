
/* What `periodic.correction.newton` does with the equations of collocation and one arclength constraint: the whole
   iteration in one call. It follows `elimination.c` in one source.

   Whatever else happens (a singular matrix, event nodes that cross) ends it with a code of its own: NumPy then begins
   anew and says what is wrong. */

enum { CROSSED = SINGULAR + 1, GROWS, TOO_MANY, NO_ROOM }; /* TOO_MANY is 5 */

#define BEFORE 1e-9 /* as in residual.py */

typedef void rows_at(whole points, const double *rate, const double *state, const double *algebraic,
                     const double *phase, const double *parameter, double *residual, double *d_rate,
                     double *d_state, double *d_algebraic, double *d_phase, double *d_parameter);
typedef void move_to(whole points, const double *algebraic, const double *increment, double *moved);
typedef void switch_at(whole points, const double *state, const double *phase, const double *parameter,
                       double *value);
typedef void rows_beside(whole points, const double *rate, const double *state, const double *algebraic,
                         const double *phase, const double *parameter, const double *side, double *residual,
                         double *d_rate, double *d_state, double *d_algebraic, double *d_phase,
                         double *d_parameter);
typedef void guard_at(whole points, const double *state, const double *phase, const double *parameter,
                      const double *side, double *value);
typedef void guard_slope_at(whole points, const double *state, const double *phase, const double *parameter,
                            const double *side, double *d_state, double *d_phase, double *d_parameter);
typedef void slope_at(whole points, const double *state, const double *phase, const double *parameter,
                      double *d_state, double *d_phase, double *d_parameter);

/* A change of an orbit; outer (k + 1) holds the event nodes' phases and the free parameter. */
struct change {
    double *nodes, *stages, *algebraic, *outer;
};

/* As `periodic.collocation.native.call.Call` is filled. */
struct call {
    whole count, ncol, n, m, k, e, parameters, switches, exact;     /* sizes; exact: intervals before kinks */
    whole free, most;                                               /* the free parameter, iterations allowed */
    const whole *segment, *starts, *switch_of, *ends, *ties;        /* of the mesh */
    const double *left, *width, *left_gradient, *width_gradient, *tied_left, *tied_width, *levels;
    const double *points, *differentiation, *end, *weights;         /* of the scheme */
    rows_at *rows;                                                  /* of the system; those on given sides are */
    rows_beside *beside;                                            /* NULL where the state decides */
    move_to *move;
    switch_at *switch_values;
    slope_at *switch_slopes;
    guard_at *guards;
    guard_slope_at *guard_slopes;
    const double *side;                                             /* modes at the points, (points, columns) */
    const double *weighted, *origin_nodes, *origin_node_rates;      /* of the arclength constraint */
    const double *origin_knots, *origin_knot_rates, *origin_phases, *origin_left, *origin_width, *lengths;
    double *nodes, *stages, *algebraic, *phases, *parameter;        /* the orbit: the guess, then what is found */
    double *maps, *steps;                                           /* of the last linearisation */
    struct change increment, kernel;
    double period, nominal, tolerance, close, max_change, shortest, narrow, negligible, growth;
    double origin_parameter, slope, distance;
    double residual, size, length, stretch, depth;
    double growing;
    whole iterations, columns, jumping, gentle; /* whether no perturbation can grow by more than growing in an interval */
};

/* Room for one linearisation; the kernels write structural nonzeros only, so that derivatives begin as 0. */
struct room {
    double *residual, *d_rate, *d_state, *d_algebraic, *d_phase, *d_parameter;
    double *value, *by_state, *by_phase, *by_parameter; /* of switches at one mesh point */
    double *left, *width, *knots, *rates, *tau, *rate, *state, *moved, *shift;
    double *origin, *origin_rate, *step, *stage_map, *algebraic_map, *bordered, *work, *few, *kept;
    whole *marks;
};

static double *taken(double **from, whole size)
{
    double *found = *from;
    *from += size;
    return found;
}

/* Lay out the room in one piece of memory, which is returned; NULL where there is none. */
static double *lay_out(const struct call *c, struct room *r)
{
    const whole n = c->n, m = c->m, k = c->k, rows = n + m, points = c->count * c->ncol;
    const whole wide = 2 + n + k, w = 2 + n + c->e, w1 = w + n, ends = (c->count + 1) * n, last = n + k + 1;
    const whole zeroed = points * rows * (2 * n + m + 3) + c->switches * (2 + n + c->parameters);
    const whole room = (c->ncol * n + m) * w1 + m * (m + w1) + c->ncol * n * (c->ncol * n + w + 1)
                       + 3 * c->ncol * c->ncol;
    const whole other = 2 * c->count + 2 * c->count * (c->ncol + 1) * n + points * (1 + 2 * n + 2 * m) + 2 * ends
                        + c->count * n * wide + points * (n * w + m * w1) + last * (last + 2) + room + n + c->ncol + 1 + 2 * wide + 2 * (ends + points * rows + k + 1) + n * (n + 4);
    double *all = malloc((zeroed + other) * sizeof(double)), *next = all;
    if (!all)
        return NULL;
    memset(all, 0, zeroed * sizeof(double));
    r->residual = taken(&next, points * rows);
    r->d_rate = taken(&next, points * rows * n);
    r->d_state = taken(&next, points * rows * n);
    r->d_algebraic = taken(&next, points * rows * m);
    r->d_phase = taken(&next, points * rows);
    r->d_parameter = taken(&next, points * rows);
    r->value = taken(&next, c->switches);
    r->by_state = taken(&next, c->switches * n);
    r->by_phase = taken(&next, c->switches);
    r->by_parameter = taken(&next, c->switches * c->parameters);
    r->left = taken(&next, c->count);
    r->width = taken(&next, c->count);
    r->knots = taken(&next, c->count * (c->ncol + 1) * n);
    r->rates = taken(&next, c->count * (c->ncol + 1) * n);
    r->tau = taken(&next, points);
    r->rate = taken(&next, points * n);
    r->state = taken(&next, points * n);
    r->moved = taken(&next, points * m);
    r->shift = taken(&next, points * m);
    r->origin = taken(&next, ends);
    r->origin_rate = taken(&next, ends);
    r->step = taken(&next, c->count * n * wide);
    r->stage_map = taken(&next, points * n * w);
    r->algebraic_map = taken(&next, points * m * w1);
    r->bordered = taken(&next, last * (last + 2));
    r->work = taken(&next, room);
    r->few = taken(&next, n + c->ncol + 1 + 2 * wide);
    r->kept = taken(&next, 2 * (ends + points * rows + k + 1));
    r->marks = (whole *)taken(&next, n * (n + 4));
    return all;
}

/* Intervals, knots and rates of the orbit. */
static int unfold(const struct call *c, struct room *r)
{
    const whole knots = c->ncol + 1, n = c->n;
    for (whole s = 0; s < c->k; s++) {
        const double next = s + 1 < c->k ? c->phases[s + 1] : c->phases[0] + c->period;
        if (!(next - c->phases[s] > 0))
            return CROSSED;
    }
    for (whole j = 0; j < c->count; j++) {
        const whole s = c->segment[j];
        double begin = 0, length = c->period;
        if (c->k) {
            begin = c->phases[s];
            length = (s + 1 < c->k ? c->phases[s + 1] : c->phases[0] + c->period) - begin;
        }
        r->left[j] = begin + length * c->left[j];
        r->width[j] = length * c->width[j];
        double *own = r->knots + j * knots * n, *rates = r->rates + j * knots * n;
        memcpy(own, c->nodes + j * n, n * sizeof(double));
        memcpy(own + n, c->stages + j * c->ncol * n, c->ncol * n * sizeof(double));
        for (whole l = 0; l < knots; l++)
            for (whole s = 0; s < n; s++) {
                double sum = 0;
                for (whole i = 1; i < knots; i++) /* differences are exact */
                    sum += c->differentiation[l * knots + i] * (own[i * n + s] - own[s]);
                rates[l * n + s] = sum / r->width[j];
            }
    }
    return DONE;
}

/* The equations at the collocation points, before kinks that they fall on. */
static void evaluate(const struct call *c, struct room *r)
{
    const whole n = c->n, ncol = c->ncol, points = c->count * ncol, rows = n + c->m;
    for (whole j = 0; j < c->count; j++) {
        memcpy(r->rate + j * ncol * n, r->rates + (j * (ncol + 1) + 1) * n, ncol * n * sizeof(double));
        for (whole l = 0; l < ncol; l++)
            r->tau[j * ncol + l] = r->left[j] + r->width[j] * c->points[l];
    }
    memcpy(r->state, c->stages, points * n * sizeof(double));
    const int beside = c->points[ncol - 1] == 1.0;
    for (whole e = 0; beside && e < c->exact; e++) {
        const whole at = c->ends[e] * ncol + ncol - 1;
        r->tau[at] -= BEFORE;
        for (whole s = 0; s < n; s++)
            r->state[at * n + s] -= BEFORE * r->rate[at * n + s];
    }
    if (c->beside)
        c->beside(points, r->rate, r->state, c->algebraic, r->tau, c->parameter, c->side, r->residual, r->d_rate,
                  r->d_state, r->d_algebraic, r->d_phase, r->d_parameter);
    else
        c->rows(points, r->rate, r->state, c->algebraic, r->tau, c->parameter, r->residual, r->d_rate,
                r->d_state, r->d_algebraic, r->d_phase, r->d_parameter);
    for (whole e = 0; beside && e < c->exact; e++) {
        const whole at = c->ends[e] * ncol + ncol - 1;
        for (whole i = at * rows; i < (at + 1) * rows; i++) {
            double late = r->d_phase[i];
            for (whole s = 0; s < n; s++)
                late += r->d_state[i * n + s] * r->rate[at * n + s];
            r->residual[i] += BEFORE * late;
        }
    }
}

/* The end of a segment of the constraint's origin. */
static double origin_end(const struct call *c, whole segment)
{
    return segment + 1 < c->k ? c->origin_phases[segment + 1] : c->origin_phases[0] + c->period;
}

/* States and rates of the constraint's origin at the orbit's mesh points, where these have moved: within their
   own segments, beyond them on the tangents at their ends, of equations that jump on its own: see arclength.py. */
static void origin_at(const struct call *c, struct room *r, const double **states, const double **rates)
{
    const whole knots = c->ncol + 1, n = c->n;
    int moved = 0;
    for (whole a = 0; a < c->k; a++)
        moved |= c->phases[a] != c->origin_phases[a];
    *states = moved ? r->origin : c->origin_nodes;
    *rates = moved && !c->jumping ? r->origin_rate : c->origin_node_rates;
    if (c->jumping) { /* on its tangents */
        for (whole i = 0; moved && i < (c->count + 1) * n; i++) {
            const double *gradient = c->left_gradient + i / n % c->count * c->k;
            double way = 0;
            for (whole a = 0; a < c->k; a++)
                way += gradient[a] * (c->phases[a] - c->origin_phases[a]);
            r->origin[i] = c->origin_nodes[i] + way * c->origin_node_rates[i];
        }
        return;
    }
    for (whole j = 0; moved && j < c->count; j++) {
        whole segment = c->segment[j];
        double tau = r->left[j];
        if (j == c->starts[segment]) { /* an event node is in the longer of its two segments */
            const whole before = segment ? segment - 1 : c->k - 1;
            const double own = origin_end(c, segment) - c->origin_phases[segment];
            if (origin_end(c, before) - c->origin_phases[before] > own) {
                tau += before > segment ? c->period : 0;
                segment = before;
            }
        }
        const double place = fmin(origin_end(c, segment), fmax(c->origin_phases[segment], tau));
        whole low = c->starts[segment], high = segment + 1 < c->k ? c->starts[segment + 1] : c->count;
        while (high - low > 1) { /* left[low] <= place */
            const whole middle = (low + high) / 2;
            if (c->origin_left[middle] <= place)
                low = middle;
            else
                high = middle;
        }
        const double theta = (place - c->origin_left[low]) / c->origin_width[low];
        double *state = r->origin + j * n, *rate = r->origin_rate + j * n;
        memset(state, 0, n * sizeof(double));
        memset(rate, 0, n * sizeof(double));
        for (whole l = 0; l < knots; l++) {
            double basis = c->weights[l];
            for (whole i = 0; i < knots; i++)
                if (i != l)
                    basis *= theta - (i ? c->points[i - 1] : 0.0);
            for (whole s = 0; s < n; s++) {
                state[s] += basis * c->origin_knots[(low * knots + l) * n + s];
                rate[s] += basis * c->origin_knot_rates[(low * knots + l) * n + s];
            }
        }
        for (whole s = 0; s < n; s++)
            state[s] += (tau - place) * rate[s];
    }
    if (moved) {
        memcpy(r->origin + c->count * n, r->origin, n * sizeof(double));
        memcpy(r->origin_rate + c->count * n, r->origin_rate, n * sizeof(double));
    }
}

/* The arclength constraint as a row (w) in (1, dx_0, dy). */
static void constrain(const struct call *c, struct room *r, double *row)
{
    const whole n = c->n, k = c->k, w = 1 + n + k + 1;
    const double *states, *rates;
    origin_at(c, r, &states, &rates);
    memset(row, 0, w * sizeof(double));
    double value = 0;
    for (whole j = 0; j <= c->count; j++) {
        const double *gradient = c->left_gradient + (j < c->count ? j : 0) * k;
        double along = 0;
        for (whole s = 0; s < n; s++) {
            const double weight = c->weighted[j * n + s], *map = c->maps + (j * n + s) * w;
            value += weight * (c->nodes[j * n + s] - states[j * n + s]);
            if (k)
                along += weight * rates[j * n + s];
            for (whole i = 0; i < w; i++)
                row[i] += weight * map[i];
        }
        for (whole a = 0; a < k; a++)
            row[1 + n + a] -= along * gradient[a];
    }
    for (whole a = 0; a < k; a++) {
        row[1 + n + a] += c->lengths[a];
        value += c->lengths[a] * (c->phases[a] - c->origin_phases[a]);
    }
    row[0] += value + c->slope * (c->parameter[c->free] - c->origin_parameter) - c->distance;
    row[1 + n + k] += c->slope;
}

/* The modes in the interval before an event node. */
static const double *modes_before(const struct call *c, whole event)
{
    const whole node = c->starts[event];
    return c->side + ((node ? node : c->count) - 1) * c->ncol * c->columns;
}

/* The derivatives of the switches at an event node, in the modes that lead there. */
static void slopes(const struct call *c, struct room *r, whole event)
{
    const double *state = c->nodes + c->starts[event] * c->n, *phase = c->phases + event;
    if (c->guard_slopes)
        c->guard_slopes(1, state, phase, c->parameter, modes_before(c, event), r->by_state, r->by_phase,
                        r->by_parameter);
    else
        c->switch_slopes(1, state, phase, c->parameter, r->by_state, r->by_phase, r->by_parameter);
}

/* The condition of an event node as a row (w) in (1, dx_0, dy). */
static void tie(const struct call *c, struct room *r, whole event, double *row)
{
    const whole n = c->n, k = c->k, w = 1 + n + k + 1, node = c->starts[event], own = c->switch_of[event];
    const double *state = c->nodes + node * n, *phase = c->phases + event;
    if (c->guards)
        c->guards(1, state, phase, c->parameter, modes_before(c, event), r->value);
    else
        c->switch_values(1, state, phase, c->parameter, r->value);
    slopes(c, r, event);
    memset(row, 0, w * sizeof(double));
    for (whole s = 0; s < n; s++)
        for (whole i = 0; i < w; i++)
            row[i] += r->by_state[own * n + s] * c->maps[(node * n + s) * w + i];
    row[0] += r->value[own] - c->levels[event];
    row[1 + n + event] += r->by_phase[own];
    row[1 + n + k] += r->by_parameter[own * c->parameters + c->free];
}

/* The change of the orbit that goes with dx_0 and dy; constant is 1 for a Newton step, 0 along the branch. */
static void spread(const struct call *c, struct room *r, double constant, const double *found, whole stride,
                   struct change *to)
{
    const whole n = c->n, k = c->k, w = 1 + n + k + 1;
    double *given = r->few;
    given[0] = constant;
    for (whole i = 1; i < w; i++)
        given[i] = found[(i - 1) * stride];
    for (whole i = 0; i < (c->count + 1) * n; i++) {
        double sum = 0;
        for (whole s = 0; s < w; s++)
            sum += c->maps[i * w + s] * given[s];
        to->nodes[i] = sum;
    }
    memcpy(to->outer, given + 1 + n, (k + 1) * sizeof(double));
    recover(c->count, c->ncol, n, c->m, k, c->e, 1, constant, c->ties, r->stage_map, r->algebraic_map,
            c->differentiation + c->ncol + 1, r->width, to->nodes, to->outer, to->stages, to->algebraic,
            given + w, given + w + n);
}

static double largest(whole count, const double *values, double so_far)
{
    for (whole i = 0; i < count; i++)
        so_far = fmax(so_far, fabs(values[i]));
    return so_far;
}

/* Size and length of the increment, see `periodic.correction.newton.sizes`. */
static int measure(struct call *c, struct room *r)
{
    const whole n = c->n, m = c->m, k = c->k, w = 1 + n + k + 1, points = c->count * c->ncol;
    double span = 1, effect = 0, left = 0, felt = 0;
    for (whole s = 0; s < n; s++) {
        double low = r->knots[s], high = low;
        for (whole i = 1; i < c->count * (c->ncol + 1); i++) {
            low = fmin(low, r->knots[i * n + s]);
            high = fmax(high, r->knots[i * n + s]);
        }
        span = fmax(span, high - low);
    }
    const struct change *d = &c->increment;
    double regular = largest(points * n, d->stages, largest((c->count + 1) * n, d->nodes, 0)) / span;
    regular = largest(k, d->outer, regular);
    for (whole i = 0; i < c->count * n; i++)
        effect = fmax(effect, fabs(r->step[i * w + 1 + n + k]));
    const double least = fmin(c->negligible / fmax(c->count * effect, 1e-300), c->nominal);
    regular = fmax(regular, fabs(d->outer[k]) / fmax(fabs(c->parameter[c->free]), least));
    if (m)
        c->move(points, c->algebraic, d->algebraic, r->moved);
    for (whole j = 0; m && j < c->count; j++) {
        double unknowns = 0;
        for (whole i = j * c->ncol * m; i < (j + 1) * c->ncol * m; i++)
            unknowns = fmax(unknowns, fabs(r->moved[i] - c->algebraic[i]) / (1 + fabs(c->algebraic[i])));
        left = fmax(left, unknowns * unknowns);
        felt = fmax(felt, fmin(1, r->width[j] / c->narrow) * unknowns);
    }
    double briefest = 1;
    c->stretch = 0;
    for (whole a = 0; a < k; a++) { /* of segments, relative where they are shorter than 1 rad */
        const whole next = a + 1 < k ? a + 1 : 0;
        const double own = (next ? c->phases[next] : c->phases[0] + c->period) - c->phases[a];
        c->stretch = fmax(c->stretch, fabs(d->outer[next] - d->outer[a]) / fmin(own, 1));
        briefest = fmin(briefest, fabs(own));
    }
    c->depth = k ? fmax(regular, left) / (briefest * briefest) : 0;
    c->size = fmax(fmax(regular, left), c->stretch * c->stretch);
    c->length = fmax(regular, felt);
    const int finite = finite_all((c->count + 1) * n, d->nodes) && finite_all(points * n, d->stages)
                       && finite_all(k + 1, d->outer) && (!m || finite_all(points * m, r->moved));
    return finite ? DONE : NOT_FINITE;
}

/* Linearise at the orbit and solve for increment and kernel. */
static int linearised(struct call *c, struct room *r)
{
    const whole n = c->n, k = c->k, w = 1 + n + k + 1, last = n + k + 1, wide = last + 2;
    int code = unfold(c, r);
    if (code != DONE)
        return code;
    evaluate(c, r);
    code = eliminate_stages(c->count, c->ncol, n, c->m, k, c->e, 1, c->ties, r->residual, r->d_rate, r->d_state,
                            r->d_algebraic, r->d_phase, r->d_parameter, r->width, c->tied_left, c->tied_width,
                            c->points, c->differentiation + c->ncol + 1, c->end, r->knots,
                            r->rates, c->nodes, r->step, r->stage_map, r->algebraic_map, &c->residual, r->work,
                            r->marks);
    if (code != DONE)
        return code;
    chain(c->count, n, w, r->step, c->maps);
    for (whole i = 0; i < (c->count + 1) * n; i++)
        if (!(largest(n, c->maps + i * w + 1, 0) <= c->growth))
            return GROWS;
    /* rows (dx_0, dy | increment, kernel): periodicity, event nodes, the constraint */
    for (whole i = 0; i < last; i++) {
        double *row = r->bordered + i * wide, *whole_row = r->few;
        if (i < n) {
            memcpy(whole_row, c->maps + (c->count * n + i) * w, w * sizeof(double));
            whole_row[1 + i] -= 1;
            whole_row[0] += c->nodes[c->count * n + i] - c->nodes[i];
        } else if (i < n + k)
            tie(c, r, i - n, whole_row);
        else
            constrain(c, r, whole_row);
        memcpy(row, whole_row + 1, last * sizeof(double));
        row[last] = -whole_row[0];
        row[last + 1] = i == last - 1;
    }
    code = solve(last, 2, r->bordered);
    if (code != DONE)
        return code;
    spread(c, r, 1, r->bordered + last, wide, &c->increment);
    return measure(c, r);
}

/* Remember the orbit and the increment from it. */
static void keep(const struct call *c, struct room *r)
{
    const struct change *d = &c->increment;
    const whole nodes = (c->count + 1) * c->n, stages = c->count * c->ncol * c->n, unknowns = c->count * c->ncol * c->m;
    const double *parts[] = {c->nodes, c->stages, c->algebraic, c->phases, c->parameter + c->free,
                             d->nodes, d->stages, d->algebraic, d->outer};
    const whole sizes[] = {nodes, stages, unknowns, c->k, 1, nodes, stages, unknowns, c->k + 1};
    double *next = r->kept;
    for (whole i = 0; i < 9; i++) {
        memcpy(next, parts[i], sizes[i] * sizeof(double));
        next += sizes[i];
    }
}

/* Move the orbit to where a part of the increment leads from the one that was kept. */
static void move(struct call *c, struct room *r, double part)
{
    const whole nodes = (c->count + 1) * c->n, stages = c->count * c->ncol * c->n, unknowns = c->count * c->ncol * c->m;
    const double *from = r->kept, *algebraic = from + nodes + stages, *outer = algebraic + unknowns;
    const double *change = outer + c->k + 1, *shift = change + nodes + stages, *further = shift + unknowns;
    for (whole i = 0; i < nodes; i++)
        c->nodes[i] = from[i] + part * change[i];
    for (whole i = 0; i < stages; i++)
        c->stages[i] = from[nodes + i] + part * change[nodes + i];
    for (whole i = 0; i < c->k; i++)
        c->phases[i] = outer[i] + part * further[i];
    c->parameter[c->free] = outer[c->k] + part * further[c->k];
    for (whole i = 0; i < unknowns; i++)
        r->shift[i] = part * shift[i];
    if (unknowns)
        c->move(c->count * c->ncol, algebraic, r->shift, c->algebraic);
}

/* Newton steps, those that make things worse cut to a quarter again and again. */
static int iterate(struct call *c, struct room *r)
{
    double before = INFINITY, factor = 1;
    int found = 0;
    for (c->iterations = 0; !found && c->iterations < c->most; c->iterations++) {
        const int code = linearised(c, r), worse = code != DONE || c->length > 2 * before;
        if (worse && before < INFINITY && factor > c->shortest) {
            factor /= 4;
            move(c, r, factor);
            continue;
        }
        if (code != DONE)
            return code;
        before = c->length;
        factor = c->max_change / fmax(c->length, c->max_change);
        keep(c, r);
        move(c, r, factor);
        found = c->size < c->tolerance;
    }
    return found ? DONE : TOO_MANY;
}

/* By how much lengths of contacts may be off, relative. */
static double unknown(const struct call *c) { return fmax(c->stretch, c->depth); }

/* Linearise at the orbit found, or at one still closer where a contact is so short that its length is not known
   well enough. */
static int closer(struct call *c, struct room *r)
{
    const double close = c->close * c->tolerance;
    if (c->length <= close && unknown(c) <= close)
        return DONE;
    double last = unknown(c);
    int code = linearised(c, r);
    while (code == DONE && close < unknown(c) && unknown(c) < last / 4) {
        last = unknown(c);
        keep(c, r);
        move(c, r, 1);
        code = linearised(c, r);
    }
    return code;
}

/* J of dx' = J dx at a collocation point, last columns of rows of rows + n numbers: its first n; work: room
   for (n + m) (2 n + m) numbers. */
static int by_states(const struct call *c, const struct room *r, whole point, double *work)
{
    const whole n = c->n, m = c->m, rows = n + m, wide = rows + n, at = point * rows;
    for (whole i = 0; i < rows; i++) {
        memcpy(work + i * wide, r->d_rate + (at + i) * n, n * sizeof(double));
        memcpy(work + i * wide + n, r->d_algebraic + (at + i) * m, m * sizeof(double));
        memcpy(work + i * wide + rows, r->d_state + (at + i) * n, n * sizeof(double));
    }
    return solve(rows, n, work);
}

/* Whether J about the middle of each interval leaves perturbations no room to grow fast. */
static int gentle(const struct call *c, const struct room *r)
{
    const whole n = c->n, rows = n + c->m, wide = rows + n;
    for (whole j = 0; j < c->count; j++) {
        if (by_states(c, r, j * c->ncol + c->ncol / 2, r->work) != DONE)
            return 0;
        for (whole i = 0; i < n; i++) {
            double sum = 0;
            for (whole s = 0; s < n; s++)
                sum += fabs(r->work[i * wide + rows + s]);
            if (!(sum * r->width[j] <= c->growing))
                return 0;
        }
    }
    return 1;
}

/* Give how the states follow from mesh point to mesh point, (count, n, n). */
static void hand_steps(const struct call *c, const struct room *r, double *steps)
{
    const whole n = c->n, w = 2 + n + c->k;
    for (whole i = 0; steps && i < c->count * n; i++)
        memcpy(steps + i * n, r->step + i * w + 1, n * sizeof(double));
}

static int solved(struct call *c, struct room *r)
{
    int code = iterate(c, r);
    const double size = c->size;
    if (code == DONE)
        code = closer(c, r);
    if (code != DONE)
        return code;
    c->size = size;
    c->gentle = !c->beside && gentle(c, r);
    hand_steps(c, r, c->steps);
    const whole last = c->n + c->k + 1;
    spread(c, r, 0, r->bordered + last + 1, last + 2, &c->kernel);
    return unfold(c, r);
}

/* Iterate to convergence, at most `most` times. */
int newton(struct call *c)
{
    struct room room;
    double *all = lay_out(c, &room);
    if (!all)
        return NO_ROOM;
    const int code = solved(c, &room);
    free(all);
    return code;
}
