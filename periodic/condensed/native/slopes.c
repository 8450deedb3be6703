
/* How states at the points change where intervals are wider and the modes are others, forces held. */

struct change {
    whole wider, others;                        /* q1 directions of widths, then q2 of modes */
    const double *stretch;                      /* (N, q1) */
    const double *exponents, *inputs, *outputs; /* (q2, J), (q2, J, k), (q2, s, J), complex */
    const double *direct, *direct_rate;         /* (q2, s, k) */
    double *begun, *found;                      /* (J, q) complex, (N, a, s, q) */
    double *history, *inner, *kicks, *moved;    /* room: (N+1, J); (N, a, J, q); (N, J, q); (N+1, J, q) */
};

/* Within an interval: moved modes at its points from those at its beginning, inner (a, J, q), and the modes
   there, stages (a, J). */
static void within(const struct response *r, const struct change *q, whole i, const double *forces,
                   double *restrict inner, double *restrict stages)
{
    const whole points = r->points, k = r->forces, J = r->modes, u = r->which[i], all = q->wider + q->others;
    const double h = r->width[u];
    for (whole j = 0; j < J; j++) {
        const complex_ lambda = at(r->exponents, j), z = at(q->history, i * J + j);
        const double *growth = r->growth + 2 * (u * J + j) * points;
        for (whole a = 0; a < points; a++) {
            const whole row = ((u * J + j) * points + a) * points;
            double *to = inner + 2 * (a * J + j) * all;
            complex_ answer = {0, 0}, steeper = {0, 0};
            memset(to + 2 * q->wider, 0, 2 * q->others * sizeof(double));
            for (whole l = 0; l < k; l++) {
                const complex_ input = at(r->inputs, j * k + l);
                const complex_ moved = weighted(points, r->moment + 2 * row, forces + l, k);
                const complex_ steep = weighted(points, r->slope + 2 * row, forces + l, k);
                answer = plus(answer, times(moved, input));
                steeper = plus(steeper, times(steep, input));
                for (whole c = 0; c < q->others; c++) {
                    const complex_ other = times(moved, at(q->inputs, (c * J + j) * k + l));
                    put(to, q->wider + c, plus(at(to, q->wider + c), scaled(other, h)));
                }
            }
            const complex_ grown = times(at(growth, a), z);
            const complex_ turned = plus(scaled(steeper, h), scaled(grown, r->place[a]));
            put(stages, a * J + j, plus(grown, scaled(answer, h)));
            for (whole c = 0; c < q->wider; c++) {
                const double wider = q->stretch[i * q->wider + c];
                put(to, c, plus(scaled(answer, wider), times(turned, scaled(lambda, wider))));
            }
            for (whole c = 0; c < q->others; c++) {
                const complex_ faster = scaled(at(q->exponents, c * J + j), h);
                put(to, q->wider + c, plus(times(turned, faster), at(to, q->wider + c)));
            }
        }
    }
}

/* Add what is not the modes' own motion: other outputs, and forces that act at once. */
static void at_once(const struct response *r, const struct change *q, whole i, const double *forces,
                    const double *stages)
{
    const whole points = r->points, s = r->states, k = r->forces, J = r->modes, all = q->wider + q->others;
    const double h = r->width[r->which[i]];
    const double *first = r->derivatives + (1 + points) * points + points;
    for (whole a = 0; a < points; a++)
        for (whole n = 0; n < s; n++) {
            double *to = q->found + ((i * points + a) * s + n) * all;
            for (whole c = 0; c < q->others; c++)
                to[q->wider + c] += real_sum(J, q->outputs + 2 * (c * s + n) * J, stages + 2 * a * J, 1);
            for (whole l = 0; l < k; l++) {
                double rate = 0;
                for (whole b = 0; b < points; b++)
                    rate += first[a * points + b] * forces[b * k + l];
                rate /= h;
                for (whole c = 0; c < q->wider; c++)
                    to[c] -= rate * r->direct_rate[n * k + l] * q->stretch[i * q->wider + c] / h;
                for (whole c = 0; c < q->others; c++)
                    to[q->wider + c] += forces[a * k + l] * q->direct[(c * s + n) * k + l]
                                        + rate * q->direct_rate[(c * s + n) * k + l];
            }
        }
}

/* All of it, for forces (N, b, k) in periodic motion, history of which is given; stages (N, J, a): room. Without
   `closing` the modes at the beginning of each interval are held; kicks are then those at its end. */
int sloped(const struct response *r, const struct change *q, const double *forces, const double *closing,
           double *restrict stages)
{
    const whole points = r->points, s = r->states, J = r->modes, all = q->wider + q->others;
    const whole each = points * r->forces;
    for (whole i = 0; i < r->count; i++) {
        double *inner = q->inner + 2 * i * J * points * all;
        within(r, q, i, forces + i * each, inner, stages + 2 * i * J * points);
        memcpy(q->kicks + 2 * i * J * all, inner + 2 * (points - 1) * J * all, 2 * J * all * sizeof(double));
    }
    if (closing) {
        closed(r, all, q->kicks, closing, NULL, q->moved);
        memcpy(q->begun, q->moved, 2 * J * all * sizeof(double));
    }
    for (whole i = 0; i < r->count; i++) {
        const double *moved = q->moved + 2 * i * J * all;
        const double *growth = r->growth + 2 * r->which[i] * J * points;
        for (whole a = 0; a < points; a++) {
            double *inner = q->inner + 2 * (i * points + a) * J * all;
            for (whole j = 0; closing && j < J; j++)
                for (whole c = 0; c < all; c++) {
                    const complex_ grown = times(at(growth, j * points + a), at(moved, j * all + c));
                    put(inner, j * all + c, plus(at(inner, j * all + c), grown));
                }
            for (whole n = 0; n < s; n++)
                for (whole c = 0; c < all; c++)
                    q->found[((i * points + a) * s + n) * all + c] =
                        real_sum(J, r->outputs + 2 * n * J, inner + 2 * c, all);
        }
        at_once(r, q, i, forces + i * each, stages + 2 * i * J * points);
    }
    return DONE;
}
