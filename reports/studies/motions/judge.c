/* Oscillators x'' + c x' + k x + k3 x^3 + kg (max(x - g, 0) + min(x + h, 0)) = F cos(omega t), integrated by the
   classical method of Runge and Kutta with steps that are too small to matter, LANES motions side by side; for
   judge.py. Motions side by side end early where all of them have come back after up to MOST periods, for as
   long as is kept. */
#include <math.h>

enum { LANES = 16, MOST = 6, KEPT = 48 };
static const double BACK = 1e-8, FAR = 1e6;

static inline double acceleration(const double *p, double force, double x, double v) {
    const double above = x - p[4] > 0 ? x - p[4] : 0, below = x + p[5] < 0 ? x + p[5] : 0;
    return force - p[0] * v - p[1] * x - p[2] * x * x * x - p[3] * (above + below);
}

/* One period; force: at the beginnings and middles of the steps. */
static void period(long steps, double h, const double *p, const double *force, double *x, double *v) {
    for (long i = 0; i < steps; i++) {
        const double f0 = force[2 * i], f1 = force[2 * i + 1], f2 = force[2 * i + 2];
        for (int l = 0; l < LANES; l++) {
            const double a1 = acceleration(p, f0, x[l], v[l]), x1 = x[l] + h / 2 * v[l], v1 = v[l] + h / 2 * a1;
            const double a2 = acceleration(p, f1, x1, v1), x2 = x[l] + h / 2 * v1, v2 = v[l] + h / 2 * a2;
            const double a3 = acceleration(p, f1, x2, v2), x3 = x[l] + h * v2, v3 = v[l] + h * a3;
            const double a4 = acceleration(p, f2, x3, v3);
            x[l] += h / 6 * (v[l] + 2 * v1 + 2 * v2 + v3);
            v[l] += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
        }
    }
}

/* Whether a motion has come back after some periods in all of the last sections, or is far away. */
static int back(const double (*ring)[LANES][2], int l) {
    if (isnan(ring[0][l][0]))
        return 1;
    for (int periods = 1; periods <= MOST; periods++) {
        double apart = 0;
        for (int k = periods; k < KEPT; k++)
            for (int j = 0; j < 2; j++)
                apart = fmax(apart, fabs(ring[k][l][j] - ring[k - periods][l][j]));
        if (apart < BACK)
            return 1;
    }
    return 0;
}

/* y (motions, 2): where motions begin; sections (motions, KEPT, 2): the last ones; force (2 steps + 1). */
void settle(long motions, long periods, long steps, const double *p, const double *force, const double *y,
            double *sections) {
    const double h = 2 * 3.141592653589793238 / p[7] / steps;
    for (long s = 0; s < motions; s += LANES) {
        double x[LANES], v[LANES], ring[KEPT][LANES][2];
        for (int l = 0; l < LANES; l++) {
            const long from = s + l < motions ? s + l : motions - 1;
            x[l] = y[2 * from], v[l] = y[2 * from + 1];
        }
        for (long k = 0; k < periods; k++) {
            period(steps, h, p, force, x, v);
            int ended = k % KEPT == KEPT - 1;
            for (int l = 0; l < LANES; l++) {
                if (!(fabs(x[l]) < FAR))
                    x[l] = v[l] = NAN;
                ring[k % KEPT][l][0] = x[l], ring[k % KEPT][l][1] = v[l];
                ended = ended && back(ring, l);
            }
            if (ended || k == periods - 1)
                for (int l = 0; l < LANES && s + l < motions; l++)
                    for (int i = 0; i < KEPT; i++)
                        for (int j = 0; j < 2; j++)
                            sections[2 * ((s + l) * KEPT + i) + j] = ring[(k + 1 + i) % KEPT][l][j];
            if (ended)
                break;
        }
    }
}
