/* Many motions of one system, from event to event, as `symbolic.integration.follower` follows one.

   Explicit steps of Dormand and Prince's method of order 8 (Hairer, Norsett & Wanner 1993, II.10), or, where
   these are kept small by stability alone, of the extrapolated linearly implicit Euler method (Hairer & Wanner
   1996, IV.9). Guards are looked at after each step, with the cubic through their values and rates; where one
   falls, its root is found by steps from the same beginning. Beside a motion its tangents may be carried, which
   events map by their saltation matrix. What comes before this text: the system's numbers (N, STATES, SWITCHES,
   SURFACES, SIDES, ...), its tables and its routines. */

enum { KINK, JUMP, SLIDING, SLIDER, RELAY, IMPACT, MARKER };
enum { PLUS = 1, STUCK = 2 };
enum { FOLLOWED, SPENT, DIVERGED, PILED, LOST };
enum { STAGES = 12, ROWS = 6, PIVOTS = 1000, ROOTS = 60, GUARDS = 2 * SURFACES + 1, MARKS = 15, CLEAN = 6 };

static const double NOISE = 1e-12, SHARP = 1e-3, BESIDE = 1e-13, LOW = 0.1, TINY = 1e-14, ASIDE = 1e-9, CLOSE = 0.1;
static const double STABLE = 6.1; /* of the explicit steps, on the negative axis */

/* Changes of mode that are left to the caller. count < 0: the motion begins. */
typedef int (*Other)(double tau, double *y, int *mode, int count, const int *surface, const int *at,
                     const int *sign);

typedef struct {
    double tolerance, largest, longest;
    ptrdiff_t most_steps, most_events;
    int tangents, begun_here, simple;
    double kept_field[KEPT_FIELD + 1], kept_guards[KEPT_GUARDS + 1], kept_slope[KEPT_SLOPE + 1];
    double kept_gradient[KEPT_GRADIENT + 1], kept_reset[KEPT_RESET + 1], kept_reset_slope[KEPT_RESET_SLOPE + 1];
    double kept_constraint[KEPT_CONSTRAINT + 1];
    Other other;
} Given;

typedef struct {
    double tau, h, side[SIDES + 1];
    int mode[SURFACES + 1], count, surface[GUARDS], at[GUARDS], sign[GUARDS];
    double least[GUARDS], size[GUARDS], g[GUARDS], r[GUARDS];
    int stiff, marks, clean, fresh;
    ptrdiff_t steps, events;
    int changes[SURFACES + 1];
    double *y, *next, *inner, *k[STAGES + 1], *jacobian; /* y is followed by its tangents */
} Motion;

static double greater(double a, double b) { return a > b ? a : b; }

/* ---- rates, of the motion and of its tangents ---- */

/* A place at which derivatives are those of the sides that the kinks' modes tell: y, or y moved there from a
   surface on which, or hardly beyond which, it is. */
static const double *sided(const Given *o, const Motion *m, double tau, const double *y, double *moved) {
    double values[SWITCHES + 1], slopes[SWITCHES + 1], gradients[SWITCHES * N + 1], along[SWITCHES + 1];
    const double *at = y;
    int known = 0;
    for (int j = 0; j < m->count; j++) {
        const int i = m->surface[j];
        if (KIND[i] != KINK || COLUMN[i] >= 0) continue;
        if (!known++) guards(y, tau, m->side, o->kept_guards, values, slopes);
        const double inside = m->sign[j] * values[m->at[j]], least = ASIDE * (1 + m->size[j]);
        if (inside >= least) continue;
        if (at == y) {
            memcpy(moved, y, N * sizeof *y);
            gradient(y, tau, m->side, o->kept_gradient, gradients, along);
            at = moved;
        }
        const double *way = gradients + m->at[j] * N;
        double square = 0;
        for (int k = 0; k < N; k++) square += way[k] * way[k];
        for (int k = 0; k < N && square > 0; k++) moved[k] += m->sign[j] * (least - inside) * way[k] / square;
    }
    return at;
}

static void rates(const Given *o, Motion *m, double tau, const double *y, double *f) {
    field(y, tau, m->side, o->kept_field, f);
    if (!o->tangents) return;
    double moved[N];
    slope(KINKS ? sided(o, m, tau, y, moved) : y, tau, m->side, o->kept_slope, m->jacobian);
    for (int t = 1; t <= o->tangents; t++)
        for (int i = 0; i < N; i++) {
            double sum = 0;
            for (int j = 0; j < N; j++) sum += m->jacobian[i * N + j] * y[t * N + j];
            f[t * N + i] = sum;
        }
}

static void look(const Given *o, const Motion *m, double tau, const double *y, double *g, double *r) {
    double values[SWITCHES + 1], slopes[SWITCHES + 1];
    if (!m->count) return;
    guards(y, tau, m->side, o->kept_guards, values, slopes);
    for (int j = 0; j < m->count; j++) {
        g[j] = m->sign[j] * values[m->at[j]];
        r[j] = m->sign[j] * slopes[m->at[j]];
    }
}

/* ---- single steps: m->next from m->y, with the rates there in m->k[0]; the error in tolerances ---- */

static double scale_of(const Given *o, double a, double b) {
    return o->tolerance * (1 + greater(fabs(a), fabs(b)));
}

static double explicit_step(const Given *o, Motion *m, double h) {
    const int size = N * (1 + o->tangents);
    for (int s = 1; s <= STAGES; s++) {
        double *into = s < STAGES ? m->inner : m->next;
        const double *weight = s < STAGES ? A[s] : B;
        for (int i = 0; i < size; i++) {
            double sum = 0;
            for (int l = 0; l < s; l++) sum += weight[l] * m->k[l][i];
            into[i] = m->y[i] + h * sum;
        }
        rates(o, m, m->tau + (s < STAGES ? C[s] : 1.0) * h, into, m->k[s]);
    }
    double fifth = 0, third = 0, change = 0, apart = 0;
    for (int i = 0; i < N; i++) {
        double a = 0, b = 0, scale = scale_of(o, m->y[i], m->next[i]);
        for (int l = 0; l < STAGES; l++) {
            a += E5[l] * m->k[l][i];
            b += E3[l] * m->k[l][i];
        }
        fifth += (h * a / scale) * (h * a / scale);
        third += (h * b / scale) * (h * b / scale);
        change += pow(m->k[STAGES][i] - m->k[STAGES - 1][i], 2);
        apart += pow(m->next[i] - m->inner[i], 2);
    }
    if (apart > 0 && fabs(h) * sqrt(change / apart) > STABLE) {
        m->clean = 0;
        m->marks++;
    } else if (++m->clean == CLEAN)
        m->marks = 0;
    const double both = fifth + 0.01 * third;
    return both == 0 ? 0 : fifth / sqrt(both * N);
}

/* LU factors of a (n, n) with partial pivoting, whole rows exchanged; 0 where it is singular. */
static int factorised(double *a, int *order, int n) {
    for (int k = 0; k < n; k++) {
        int p = k;
        for (int i = k + 1; i < n; i++)
            if (fabs(a[i * n + k]) > fabs(a[p * n + k])) p = i;
        order[k] = p;
        if (!(fabs(a[p * n + k]) > 0)) return 0;
        for (int j = 0; j < n && p != k; j++) {
            double held = a[k * n + j];
            a[k * n + j] = a[p * n + j];
            a[p * n + j] = held;
        }
        for (int i = k + 1; i < n; i++) {
            const double part = a[i * n + k] /= a[k * n + k];
            if (part != 0)
                for (int j = k + 1; j < n; j++) a[i * n + j] -= part * a[k * n + j];
        }
    }
    return 1;
}

static void solved(const double *a, const int *order, double *b, int n) {
    for (int k = 0; k < n; k++) {
        double held = b[k];
        b[k] = b[order[k]];
        b[order[k]] = held;
    }
    for (int i = 0; i < n; i++)
        for (int j = 0; j < i; j++) b[i] -= a[i * n + j] * b[j];
    for (int i = n - 1; i >= 0; i--) {
        for (int j = i + 1; j < n; j++) b[i] -= a[i * n + j] * b[j];
        b[i] /= a[i * n + i];
    }
}

static void solved_once(double *a, double *b, int n) {
    int order[N];
    if (factorised(a, order, n)) solved(a, order, b, n);
}

static double implicit_step(const Given *o, Motion *m, double h) {
    double matrix[N * N], table[ROWS][N], y[N], f[N];
    int order[N];
    slope(m->y, m->tau, m->side, o->kept_slope, m->jacobian);
    double error = 0;
    for (int j = 0; j < ROWS; j++) {
        const double part = h / (j + 1);
        for (int i = 0; i < N * N; i++) matrix[i] = (i / N == i % N) - part * m->jacobian[i];
        if (!factorised(matrix, order, N)) return NAN;
        memcpy(y, m->y, sizeof y);
        for (int l = 0; l <= j; l++) {
            field(y, m->tau + (l + 1) * part, m->side, o->kept_field, f);
            for (int i = 0; i < N; i++) f[i] *= part;
            solved(matrix, order, f, N);
            for (int i = 0; i < N; i++) y[i] += f[i];
        }
        for (int i = 0; i < N; i++) {
            double value = y[i]; /* Aitken and Neville, along the row; table holds the row before */
            for (int l = 1; l <= j; l++) {
                const double held = value + (value - table[l - 1][i]) / ((double)(j + 1) / (j + 1 - l) - 1);
                if (j == ROWS - 1 && l == j) {
                    const double scale = scale_of(o, m->y[i], held);
                    error += pow((held - value) / scale, 2);
                    m->next[i] = held;
                }
                table[l - 1][i] = value;
                value = held;
            }
            table[j][i] = value;
        }
    }
    field(m->next, m->tau + h, m->side, o->kept_field, m->k[STAGES]);
    return sqrt(error / N);
}

static double step(const Given *o, Motion *m, double h) {
    return m->stiff ? implicit_step(o, m, h) : explicit_step(o, m, h);
}

/* ---- modes ---- */

static void entered(const Given *o, Motion *m) {
    m->count = 0;
    for (int i = 0; i < SURFACES; i++) {
        const int mode = m->mode[i];
        if (COLUMN[i] >= 0) m->side[COLUMN[i]] = mode;
        if (mode == STUCK && UP[i] >= 0) {
            const int each[2] = {UP[i], DOWN[i]}, signs[2] = {-1, 1};
            for (int l = 0; l < 2; l++, m->count++) {
                m->surface[m->count] = i;
                m->at[m->count] = each[l];
                m->sign[m->count] = signs[l];
            }
        } else if (mode) {
            const int rests = KIND[i] == IMPACT && mode == STUCK;
            m->surface[m->count] = i;
            m->at[m->count] = rests ? LEAVES[i] : SWITCH[i];
            m->sign[m->count++] = rests ? -1 : mode;
        }
    }
    rates(o, m, m->tau, m->y, m->k[0]);
    look(o, m, m->tau, m->y, m->g, m->r);
    for (int j = 0; j < m->count; j++) {
        m->size[j] = fabs(m->g[j]);
        m->least[j] = m->g[j] < 0 ? m->g[j] : 0;
    }
}

static void values_at(const Given *o, Motion *m, double *values) {
    double slopes[SWITCHES + 1];
    for (int i = 0; i < SURFACES; i++)
        if (COLUMN[i] >= 0) m->side[COLUMN[i]] = m->mode[i];
    guards(m->y, m->tau, m->side, o->kept_guards, values, slopes);
}

/* Relays whose threshold has been passed are switched, then joints at rest made consistent. */
static int consistent(const Given *o, Motion *m, const char *tossed) {
    double values[SWITCHES + 1];
    for (int i = 0; i < SURFACES; i++)
        if (KIND[i] == RELAY) {
            values_at(o, m, values);
            if (m->mode[i] * values[SWITCH[i]] < 0) m->mode[i] = -m->mode[i];
        }
    for (int pivot = 0; pivot < PIVOTS; pivot++) {
        int changed = 0;
        values_at(o, m, values);
        for (int i = 0; i < SURFACES && !changed; i++) {
            if (KIND[i] != SLIDING || tossed[i]) continue;
            if (m->mode[i] != STUCK && fabs(values[SWITCH[i]]) > o->tolerance) continue;
            const double up = values[UP[i]], down = values[DOWN[i]];
            int wanted = up >= 0 ? 1 : -1;
            if (up < 0 && down > 0) wanted = STUCK;
            else if ((m->mode[i] == 1 && up >= 0) || (m->mode[i] == -1 && down <= 0)) wanted = m->mode[i];
            if (wanted != m->mode[i]) {
                m->mode[i] = wanted;
                changed = 1;
            }
        }
        if (!changed) return 1;
    }
    return 0;
}

/* Slipping joints may turn at an impact, held ones be torn off. */
static void turned(const Given *o, Motion *m) {
    double values[SWITCHES + 1];
    values_at(o, m, values);
    for (int i = 0; i < SURFACES; i++) {
        const double rate = values[SWITCH[i]];
        if (KIND[i] == SLIDING) m->mode[i] = fabs(rate) > o->tolerance ? (rate > 0 ? 1 : -1) : STUCK;
        if (KIND[i] == SLIDER && m->mode[i] != STUCK && m->mode[i] * rate < 0) m->mode[i] = STUCK;
    }
}

/* Whether the bounce after an impact is negligible, so that what has struck rests on the wall. */
static int settles(const Given *o, Motion *m, int i) {
    double values[SWITCHES + 1], slopes[SWITCHES * N + 1], along[SWITCHES + 1];
    if (LEAVES[i] < 0) return 0;
    values_at(o, m, values);
    const double pressed = values[LEAVES[i]];
    if (pressed >= 0) return 0;
    gradient(m->y, m->tau, m->side, o->kept_gradient, slopes, along);
    const double speed = slopes[SWITCH[i] * N + POSITION[i]] * m->y[VELOCITY[i]];
    return values[SWITCH[i]] + speed * speed / (-2 * pressed) <= LOW * o->tolerance;
}

static int changed_here(const Given *o, Motion *m, int count, const int *fallen) {
    char tossed[SURFACES + 1] = {0};
    double mapped[N];
    for (int l = 0; l < count; l++) {
        const int j = fallen[l], i = m->surface[j], mode = m->mode[i];
        if (KIND[i] == IMPACT && mode == STUCK) m->mode[i] = PLUS;
        else if (KIND[i] == IMPACT) {
            reset(SWITCH[i], m->y, m->tau, m->side, o->kept_reset, mapped);
            memcpy(m->y, mapped, sizeof mapped);
            turned(o, m);
        } else if (KIND[i] == KINK || KIND[i] == JUMP || KIND[i] == RELAY) m->mode[i] = -mode;
        else {
            tossed[i] = mode == STUCK;
            m->mode[i] = mode == STUCK ? -m->sign[j] : STUCK;
        }
    }
    return consistent(o, m, tossed);
}

static int passed_on(const Given *o, Motion *m, int count, const int *fallen) {
    int surface[GUARDS], at[GUARDS], sign[GUARDS];
    for (int l = 0; l < count; l++) {
        surface[l] = m->surface[fallen[l]];
        at[l] = m->at[fallen[l]];
        sign[l] = m->sign[fallen[l]];
    }
    return o->other(m->tau, m->y, m->mode, count, surface, at, sign);
}

/* What only the caller can do: systems that are not simple, and what comes to rest on a wall. */
static int left_over(const Given *o, Motion *m, int count, const int *fallen) {
    if (!o->simple) return 1;
    for (int l = 0; l < count; l++) {
        const int i = m->surface[fallen[l]];
        if (KIND[i] != IMPACT || m->mode[i] == STUCK) continue;
        Motion after = *m;
        double mapped[N];
        reset(SWITCH[i], m->y, m->tau, m->side, o->kept_reset, mapped);
        after.y = mapped;
        if (settles(o, &after, i)) return 1;
    }
    return 0;
}

/* The tangents w across an event: R w + (f+ - R f- - R') (grad s w) / s', s the first guard that fell. */
static void salted(const Given *o, Motion *m, const double *before, const double *slopes, double along,
                   const double *mapping, const double *drift) {
    double image[N], jump[N];
    field(m->y, m->tau, m->side, o->kept_field, jump);
    for (int i = 0; i < N; i++) {
        double sum = drift[i];
        for (int j = 0; j < N; j++) sum += mapping[i * N + j] * before[j];
        jump[i] -= sum;
    }
    for (int t = 1; t <= o->tangents; t++) {
        double *w = m->y + t * N, fall = 0;
        for (int j = 0; j < N; j++) fall += slopes[j] * w[j];
        for (int i = 0; i < N; i++) {
            image[i] = along ? jump[i] * fall / along : 0;
            for (int j = 0; j < N; j++) image[i] += mapping[i * N + j] * w[j];
        }
        memcpy(w, image, sizeof image);
        for (int i = 0; i < SURFACES; i++)
            if (KIND[i] == IMPACT && m->mode[i] == STUCK) w[POSITION[i]] = w[VELOCITY[i]] = 0;
    }
}

static int event(const Given *o, Motion *m, int first, int count, const int *fallen) {
    double before[N], slopes[SWITCHES * N + 1], along[SWITCHES + 1], rate = 0, mapping[N * N], drift[N];
    const int surface = m->surface[first], at = m->at[first];
    int modes[SURFACES + 1];
    memcpy(modes, m->mode, sizeof modes);
    if (o->tangents) {
        memcpy(before, m->k[0], sizeof before);
        gradient(m->y, m->tau, m->side, o->kept_gradient, slopes, along);
        rate = along[at];
        for (int j = 0; j < N; j++) rate += slopes[at * N + j] * before[j];
        for (int i = 0; i < N * N; i++) mapping[i] = i / N == i % N;
        memset(drift, 0, sizeof drift);
        if (KIND[surface] == IMPACT && m->mode[surface] != STUCK)
            reset_slope(at, m->y, m->tau, m->side, o->kept_reset_slope, mapping, drift);
    }
    const int done = left_over(o, m, count, fallen) ? passed_on(o, m, count, fallen)
                                                    : changed_here(o, m, count, fallen);
    if (!done) return 0;
    for (int i = 0; i < SURFACES; i++) {
        m->changes[i] += modes[i] != m->mode[i];
        if (COLUMN[i] >= 0) m->side[COLUMN[i]] = m->mode[i];
    }
    if (o->tangents) salted(o, m, before, slopes + at * N, rate, mapping, drift);
    entered(o, m);
    return 1;
}

/* ---- where guards fall ---- */

/* The first phase within (0, 1) at which the cubic through two values and rates is at a minimum below a floor;
   0 where there is none. */
static double dip(double a, double ra, double b, double rb, double low) {
    const double c = 3 * (b - a) - 2 * ra - rb, d = ra + rb - 2 * (b - a); /* a + ra t + c t^2 + d t^3 */
    if (greater(fabs(ra), fabs(rb)) < 1e-300 || !(ra < 0 && rb > 0)) return 0;
    const double root = c * c - 3 * d * ra;
    if (root < 0) return 0;
    const double t = -ra / (c + sqrt(root));
    if (!(t > 1e-3 && t < 1 - 1e-3)) return 0;
    return a + t * (ra + t * (c + t * d)) < low ? t : 0;
}

static double floor_of(const Given *o, const Motion *m, int j) {
    return m->least[j] - NOISE * m->size[j] - SHARP * o->tolerance;
}

/* Shorten a step to where the first guard falls: which one, and how far it is. -1: none falls. */
static int fallen_first(const Given *o, Motion *m, double *h, double *g, double *r) {
    double low = 0, from[GUARDS];
    int target = -1;
    for (int j = 0; j < m->count; j++) from[j] = m->g[j];
    for (;;) {
        int later = target;
        double best = 2;
        for (int j = 0; j < m->count; j++)
            if (g[j] < floor_of(o, m, j) && j != target) {
                const double part = from[j] > 0 ? from[j] / (from[j] - g[j]) : 0;
                if (part < best) {
                    best = part;
                    later = j;
                }
            }
        if (later == target) return target;
        target = later;
        double high = *h, level = from[target] > 0 ? 0 : floor_of(o, m, target), at = *h;
        double low_g = from[target] - level, high_g = g[target] - level, now = high_g, rate = r[target];
        low = 0;
        for (int i = 0; i < ROOTS; i++) {
            double guess = i == 0 ? high * low_g / (low_g - high_g) : rate ? at - now / rate : low;
            if (!(guess > low && guess < high)) guess = (low + high) / 2;
            at = guess;
            step(o, m, at);
            look(o, m, m->tau + at, m->next, g, r);
            now = g[target] - level;
            rate = r[target];
            if (now < 0) high = at;
            else low = at;
            if (fabs(now) <= BESIDE * m->size[target] || high - low <= TINY * (1 + fabs(m->tau))) break;
        }
        *h = at;
    }
}

/* ---- one motion ---- */

static void taken(Motion *m, double h) {
    double *held = m->y;
    m->y = m->next;
    m->next = held;
    held = m->k[0];
    m->k[0] = m->k[STAGES];
    m->k[STAGES] = held;
    m->tau += h;
}

static int sound(const Given *o, const double *y) {
    double largest = 0;
    for (int i = 0; i < STATES; i++) {
        if (!isfinite(y[i])) return 0;
        largest = greater(largest, fabs(y[i]));
    }
    return largest <= o->largest;
}

/* Whether a guard has fallen after a step. */
static int falling(const Given *o, Motion *m, double h, double *g, double *r) {
    if (!m->count) return 0;
    look(o, m, m->tau + h, m->next, g, r);
    for (int j = 0; j < m->count; j++)
        if (g[j] < floor_of(o, m, j)) return 1;
    return 0;
}

/* Follow a motion to a phase. */
static int followed(const Given *o, Motion *m, double end) {
    const ptrdiff_t begun_steps = m->steps, begun_events = m->events;
    double g[GUARDS], r[GUARDS];
    while (end - m->tau > TINY * (1 + fabs(end))) {
        if (m->steps++ - begun_steps > o->most_steps) return SPENT;
        double h = m->h;
        if (m->count && h > o->longest) h = o->longest;
        if (m->tau + 1.01 * h > end) h = end - m->tau;
        if (m->fresh) {
            entered(o, m);
            m->fresh = 0;
        }
        double error = step(o, m, h);
        const double order = m->stiff ? 1.0 / ROWS : 1.0 / 8;
        int first = -1;
        if (error > 1 && isfinite(error) && falling(o, m, h, g, r)) {
            /* Beyond a kink the step cannot do. Its inner stages must not be there either: near it, then to it. */
            double at = h;
            first = fallen_first(o, m, &at, g, r);
            if (at > CLOSE * h) {
                first = -1;
                at *= 1 - CLOSE;
            }
            h = at;
            error = step(o, m, h);
        }
        if (!(error <= 1)) {
            m->h = h * (isfinite(error) ? greater(0.2, 0.9 * pow(error, -order)) : 0.1);
            if (m->h < TINY * (1 + fabs(m->tau))) return LOST;
            continue;
        }
        if (!sound(o, m->next)) return DIVERGED;
        if (m->marks >= MARKS && !m->stiff && !o->tangents) m->stiff = 1;
        const double factor = error > 0 ? 0.9 * pow(error, -order) : 5;
        const double wanted = h * (factor > 5 ? 5 : factor);
        if (!m->count) {
            taken(m, h);
            if (wanted > m->h || h >= m->h) m->h = wanted;
            continue;
        }
        look(o, m, m->tau + h, m->next, g, r);
        double cut = 0;
        int falls = first >= 0;
        for (int j = 0; j < m->count && first < 0; j++) {
            if (g[j] < floor_of(o, m, j)) falls = 1;
            else {
                const double t = dip(m->g[j], h * m->r[j], g[j], h * r[j], floor_of(o, m, j));
                if (t > 0 && (cut == 0 || t < cut)) cut = t;
            }
        }
        if (cut > 0 && cut * h > 1e-9) {
            h *= cut;
            step(o, m, h);
            look(o, m, m->tau + h, m->next, g, r);
            falls = 0;
            for (int j = 0; j < m->count; j++) falls |= g[j] < floor_of(o, m, j);
        }
        if (falls) {
            double at = h;
            int fallen[GUARDS], count = 0;
            if (first < 0) first = fallen_first(o, m, &at, g, r);
            if (m->events++ - begun_events > o->most_events) return PILED;
            for (int j = 0; j < m->count; j++)
                if (j == first || (g[j] <= BESIDE * m->size[j] && r[j] < 0 && m->g[j] > BESIDE * m->size[j]))
                    fallen[count++] = j;
            taken(m, at);
            if (!event(o, m, first, count, fallen)) return LOST;
            if (wanted > m->h) m->h = wanted;
            continue;
        }
        taken(m, h);
        for (int j = 0; j < m->count; j++) {
            m->g[j] = g[j];
            m->r[j] = r[j];
            m->size[j] = greater(m->size[j], fabs(g[j]));
        }
        if (wanted > m->h || h >= m->h) m->h = wanted;
    }
    return FOLLOWED;
}

/* ---- tangents at the end of a stretch: orthonormal again (modified Gram and Schmidt), their growth ---- */

/* The unknowns' part of the tangents as the constraints ask: rounding leaves them, and nothing draws it back. */
static void admitted(const Given *o, Motion *m) {
    enum { UNKNOWNS = N - STATES };
    double slopes[UNKNOWNS * N + 1], matrix[UNKNOWNS * UNKNOWNS + 1], right[UNKNOWNS + 1];
    if (!UNKNOWNS || !o->tangents) return;
    constraint(m->y, m->tau, m->side, o->kept_constraint, slopes);
    for (int t = 1; t <= o->tangents; t++) {
        double *w = m->y + t * N;
        for (int i = 0; i < UNKNOWNS; i++) {
            right[i] = 0;
            for (int j = 0; j < STATES; j++) right[i] -= slopes[i * N + j] * w[j];
            for (int j = 0; j < UNKNOWNS; j++)
                matrix[i * UNKNOWNS + j] = slopes[i * N + STATES + j] + (i == j) * SENSITIVITY;
        }
        solved_once(matrix, right, UNKNOWNS);
        for (int i = 0; i < UNKNOWNS; i++) w[STATES + i] = right[i];
    }
}

static void orthonormal(const Given *o, Motion *m, double *growth) {
    admitted(o, m);
    for (int t = 0; t < o->tangents; t++) {
        double *w = m->y + (t + 1) * N, norm = 0, whole = 0;
        for (int i = 0; i < STATES; i++) whole += w[i] * w[i];
        for (int again = 0; again < 2; again++)
            for (int s = 0; s < t; s++) {
                const double *v = m->y + (s + 1) * N;
                double dot = 0;
                for (int i = 0; i < STATES; i++) dot += v[i] * w[i];
                for (int i = 0; i < N; i++) w[i] -= dot * v[i];
            }
        for (int i = 0; i < STATES; i++) norm += w[i] * w[i];
        growth[t] = norm > 1e-28 * whole ? 0.5 * log(norm) : -INFINITY;
        for (int i = 0; i < N; i++) w[i] = isfinite(growth[t]) ? w[i] / sqrt(norm) : 0;
    }
    m->fresh = 1;
}

static void begun(const Given *o, Motion *m) {
    double values[SWITCHES + 1], slopes[SWITCHES + 1];
    for (int i = 0; i < SIDES; i++) m->side[i] = 0;
    if (!o->begun_here) return;
    guards(m->y, m->tau, m->side, o->kept_guards, values, slopes);
    for (int i = 0; i < SURFACES; i++)
        m->mode[i] = KIND[i] == MARKER ? 0 : KIND[i] == IMPACT ? PLUS : values[SWITCH[i]] >= 0 ? 1 : -1;
}

/* A motion's known end: within `radius` of a target at two ends of stretches one after the other. */
static ptrdiff_t arrived(const double *y, ptrdiff_t targets, const double *target, const double *unit, double radius) {
    for (ptrdiff_t a = 0; a < targets; a++) {
        double apart = 0;
        for (int i = 0; i < STATES; i++) apart = greater(apart, fabs(y[i] - target[a * STATES + i]) / unit[i]);
        if (apart <= radius) return a;
    }
    return -1;
}

/* Follow `motions` motions over `count` stretches of `width`, each from phase 0.

   y (motions, N): in and out. modes (motions, SURFACES): in, where `given_modes`, and out. sections: (motions,
   count + 1, N) where not NULL, NaN what is not reached. growth: (motions, count, tangents), tangents (motions,
   tangents, N) where there are any. changes (motions, SURFACES): of modes in the last stretch. A motion stops
   early where it arrives at one of `targets` places (targets, STATES), in units (STATES,); `label` says whose
   place that is, -1 of motions that arrive nowhere. outcome: of each. Returns 1 where there is no memory. */
int follow(ptrdiff_t motions, ptrdiff_t count, double width, const double *parameter,
           double tolerance, double largest, double longest, ptrdiff_t most_steps, ptrdiff_t most_events,
           ptrdiff_t tangents, ptrdiff_t raw, ptrdiff_t begun_here, ptrdiff_t simple, ptrdiff_t given_modes,
           Other other, double *y, int *modes, double *sections, double *growth, double *tangent,
           ptrdiff_t targets, const double *target, const ptrdiff_t *of_target, const double *unit, double radius,
           int *label, int *outcome, int *changes) {
    const size_t size = N * (1 + tangents);
    Given *o = calloc(1, sizeof *o);
    double *room = malloc(((STAGES + 4) * size + N * N + 1) * sizeof *room);
    if (!o || !room) {
        free(o);
        free(room);
        return 1;
    }
    o->tolerance = tolerance;
    o->largest = largest;
    o->longest = longest;
    o->most_steps = most_steps;
    o->most_events = most_events;
    o->tangents = (int)tangents;
    o->begun_here = (int)begun_here;
    o->simple = (int)simple;
    o->other = other;
    field_once(parameter, o->kept_field);
    guards_once(parameter, o->kept_guards);
    slope_once(parameter, o->kept_slope);
    gradient_once(parameter, o->kept_gradient);
    constraint_once(parameter, o->kept_constraint);
    reset_once(parameter, o->kept_reset);
    reset_slope_once(parameter, o->kept_reset_slope);
    for (ptrdiff_t s = 0; s < motions; s++) {
        Motion motion = {.tau = 0, .h = 0.01}, *m = &motion;
        double *each = room;
        m->y = each;
        m->next = each += size;
        m->inner = each += size;
        for (int l = 0; l <= STAGES; l++) m->k[l] = each += size;
        m->jacobian = each += size;
        memcpy(m->y, y + s * N, N * sizeof *y);
        if (tangents) memcpy(m->y + N, tangent + s * tangents * N, tangents * N * sizeof *y);
        begun(o, m);
        int done = FOLLOWED, before = -1;
        if (given_modes) memcpy(m->mode, modes + s * SURFACES, SURFACES * sizeof *modes);
        else if (!begun_here && !other(0, m->y, m->mode, -1, NULL, NULL, NULL)) done = LOST;
        m->fresh = 1;
        label[s] = -1;
        if (sections) memcpy(sections + s * (count + 1) * N, m->y, N * sizeof *y);
        ptrdiff_t reached = 0;
        while (reached < count && done == FOLLOWED) {
            const ptrdiff_t c = reached;
            memset(m->changes, 0, sizeof m->changes);
            done = followed(o, m, (c + 1) * width);
            if (done != FOLLOWED) break;
            reached++;
            if (m->fresh) entered(o, m);
            if (tangents && !raw) orthonormal(o, m, growth + (s * count + c) * tangents);
            if (sections) memcpy(sections + (s * (count + 1) + c + 1) * N, m->y, N * sizeof *y);
            const ptrdiff_t near = targets ? arrived(m->y, targets, target, unit, radius) : -1;
            const int which = near < 0 ? -1 : (int)of_target[near];
            if (near >= 0 && which == before) {
                label[s] = which;
                break;
            }
            before = which;
        }
        for (ptrdiff_t i = (reached + 1) * N; sections && i < (count + 1) * N; i++)
            sections[s * (count + 1) * N + i] = NAN;
        memcpy(y + s * N, m->y, N * sizeof *y);
        memcpy(modes + s * SURFACES, m->mode, SURFACES * sizeof *modes);
        if (tangents) memcpy(tangent + s * tangents * N, m->y + N, tangents * N * sizeof *y);
        outcome[s] = done;
        for (int i = 0; i < SURFACES; i++) changes[s * SURFACES + i] = m->changes[i];
    }
    free(o);
    free(room);
    return 0;
}
