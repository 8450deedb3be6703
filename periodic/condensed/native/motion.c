
/* The modes' way from interval to interval, and its adjoint. */

/* What forces (b k, r) leave in the modes at the end of an interval, left (J, r). */
static void kicked(const struct response *r, whole u, whole columns, const double *forces, double *restrict left)
{
    const whole each = r->points * r->forces;
    for (whole j = 0; j < r->modes; j++) {
        const double *impulse = r->impulse + 2 * (u * r->modes + j) * each;
        for (whole c = 0; c < columns; c++)
            put(left, j * columns + c, weighted(each, impulse, forces + c, columns));
    }
}

/* to (J, r) = growth from (J, r) + more (J, r). */
static void carried(const struct response *r, whole u, whole columns, const double *from, const double *more,
                    double *to)
{
    for (whole j = 0; j < r->modes; j++) {
        const complex_ growth = at(r->growth, (u * r->modes + j + 1) * r->points - 1);
        for (whole c = 0; c < columns; c++) {
            const whole k = j * columns + c;
            put(to, k, plus(times(growth, at(from, k)), at(more, k)));
        }
    }
}

/* history (N+1, J, r) of what each interval leaves, kicks (N, J, r): z(0) is `begun` (J, r), or else
   closing (J) times what the whole period leaves in modes at rest. */
void closed(const struct response *r, whole columns, const double *kicks, const double *closing,
            const double *begun, double *restrict history)
{
    const whole size = r->modes * columns;
    if (begun)
        memcpy(history, begun, 2 * size * sizeof(double));
    else {
        memcpy(history, kicks, 2 * size * sizeof(double));
        for (whole i = 1; i < r->count; i++)
            carried(r, r->which[i], columns, history, kicks + 2 * i * size, history);
        for (whole k = 0; k < size; k++)
            put(history, k, times(at(closing, k / columns), at(history, k)));
    }
    for (whole i = 0; i < r->count; i++)
        carried(r, r->which[i], columns, history + 2 * i * size, kicks + 2 * i * size,
                history + 2 * (i + 1) * size);
}

/* History as `closed`, and states (N, a, s, r) at the points, of forces (N, b, k, r); kicks: room (N, J, r). */
int driven(const struct response *r, whole columns, const double *forces, const double *closing,
           const double *begun, double *restrict kicks, double *restrict history, double *restrict states)
{
    const whole rows = r->points * r->states, each = r->points * r->forces, size = r->modes * columns;
    for (whole i = 0; i < r->count; i++)
        kicked(r, r->which[i], columns, forces + i * each * columns, kicks + 2 * i * size);
    closed(r, columns, kicks, closing, begun, history);
    for (whole i = 0; states && i < r->count; i++) {
        const whole u = r->which[i];
        for (whole p = 0; p < rows; p++) {
            double *restrict state = states + (i * rows + p) * columns;
            const double *shown = r->shown + 2 * (u * rows + p) * r->modes;
            combine(each, columns, r->local + (u * rows + p) * each, forces + i * each * columns, state);
            for (whole c = 0; c < columns; c++)
                state[c] += real_sum(r->modes, shown, history + 2 * (i * size + c), columns);
        }
    }
    return DONE;
}

/* Weights of forces (N, b, k, r) from those of the states, (N, a, s, r). seen (N, J, r), after (J, r): room. */
int pulled(const struct response *r, whole columns, const double *weights, const double *closing,
           double *restrict seen, double *restrict after, double *restrict found)
{
    const whole rows = r->points * r->states, each = r->points * r->forces, size = r->modes * columns;
    memset(seen, 0, 2 * r->count * size * sizeof(double));
    for (whole i = 0; i < r->count; i++)
        for (whole p = 0; p < rows; p++) {
            const double *shown = r->shown + 2 * (r->which[i] * rows + p) * r->modes;
            const double *weight = weights + (i * rows + p) * columns;
            double *restrict to = seen + 2 * i * size;
            for (whole j = 0; j < r->modes; j++, shown += 2, to += 2 * columns)
                for (whole c = 0; c < columns; c++) {
                    to[2 * c] += shown[0] * weight[c];
                    to[2 * c + 1] += shown[1] * weight[c];
                }
        }
    /* the period before takes what all of this one asks for at its beginning */
    memcpy(after, seen + 2 * (r->count - 1) * size, 2 * size * sizeof(double));
    for (whole i = r->count - 2; i >= 0; i--)
        carried(r, r->which[i], columns, after, seen + 2 * i * size, after);
    for (whole k = 0; k < size; k++)
        put(after, k, times(at(closing, k / columns), at(after, k)));
    memset(found, 0, r->count * each * columns * sizeof(double));
    for (whole i = r->count - 1; i >= 0; i--) {
        const whole u = r->which[i];
        double *restrict own = found + i * each * columns;
        for (whole p = 0; p < rows; p++)
            for (whole f = 0; f < each; f++) {
                const double factor = r->local[(u * rows + p) * each + f];
                for (whole c = 0; c < columns; c++)
                    own[f * columns + c] += factor * weights[(i * rows + p) * columns + c];
            }
        for (whole j = 0; j < r->modes; j++)
            for (whole f = 0; f < each; f++) {
                const complex_ impulse = at(r->impulse, (u * r->modes + j) * each + f);
                const double *z = after + 2 * j * columns;
                for (whole c = 0; c < columns; c++)
                    own[f * columns + c] += impulse.re * z[2 * c] - impulse.im * z[2 * c + 1];
            }
        carried(r, u, columns, after, seen + 2 * i * size, after);
    }
    return DONE;
}

/* On a uniform mesh, what some forces (k, of all F) do to some states (s) everywhere, (N, a, s, N, b, k): at
   indices `acting` and `coupled`. closing is null for motion from rest. passed (J, b, k), later (N, a, s, b, k): room. */
int circulant(const struct response *r, const double *closing, whole s, const whole *coupled, whole k,
              const whole *acting, double *restrict passed, double *restrict later, double *restrict found)
{
    const whole count = r->count, J = r->modes, points = r->points, all = points * r->forces;
    const whole rows = points * s, each = points * k;
    memset(later, 0, count * rows * each * sizeof(double));
    for (whole j = 0; j < J; j++)
        for (whole f = 0; f < each; f++) {
            const complex_ impulse = at(r->impulse, j * all + f / k * r->forces + acting[f % k]);
            put(passed, j * each + f, closing ? times(at(closing, j), impulse) : impulse);
        }
    for (whole d = 0; d < count; d++)
        for (whole j = 0; j < J; j++) {
            const complex_ growth = at(r->growth, (j + 1) * points - 1);
            double *way = passed + 2 * j * each;
            for (whole p = 0; p < rows; p++) {
                const complex_ shown = at(r->shown, (p / s * r->states + coupled[p % s]) * J + j);
                double *restrict to = later + (d * rows + p) * each;
                for (whole f = 0; f < each; f++)
                    to[f] += shown.re * way[2 * f] - shown.im * way[2 * f + 1];
            }
            for (whole f = 0; f < each; f++)
                put(way, f, times(growth, at(way, f)));
        }
    for (whole i = 0; i < count; i++)
        for (whole p = 0; p < rows; p++) {
            const double *local = r->local + (p / s * r->states + coupled[p % s]) * all;
            for (whole l = 0; l < count; l++) {
                double *to = found + ((i * rows + p) * count + l) * each;
                if (closing || l < i)
                    memcpy(to, later + (((i - l - 1 + count) % count) * rows + p) * each, each * sizeof(double));
                else
                    memset(to, 0, each * sizeof(double));
                for (whole f = 0; i == l && f < each; f++)
                    to[f] += local[f / k * r->forces + acting[f % k]];
            }
        }
    return DONE;
}
