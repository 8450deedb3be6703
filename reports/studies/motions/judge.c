/* Oscillators m x'' + c x' + k x + k3 x^3 + kg (max(x - g, 0) + min(x + h, 0)) = F cos(omega t), integrated by
   the classical method of Runge and Kutta with steps that are too small to matter; for judge.py. */
#include <math.h>

static double acceleration(const double *p, double t, double x, double v) {
    const double above = x - p[4] > 0 ? x - p[4] : 0, below = x + p[5] < 0 ? x + p[5] : 0;
    return -p[0] * v - p[1] * x - p[2] * x * x * x - p[3] * (above + below) + p[6] * cos(p[7] * t);
}

void settle(long motions, long periods, long steps, long kept, const double *p, double *y, double *sections) {
    const double h = 2 * 3.141592653589793238 / p[7] / steps;
    for (long s = 0; s < motions; s++) {
        double x = y[2 * s], v = y[2 * s + 1];
        for (long k = 0; k < periods; k++) {
            for (long i = 0; i < steps; i++) {
                const double t = i * h;
                const double a1 = acceleration(p, t, x, v), x1 = x + h / 2 * v, v1 = v + h / 2 * a1;
                const double a2 = acceleration(p, t + h / 2, x1, v1), x2 = x + h / 2 * v1, v2 = v + h / 2 * a2;
                const double a3 = acceleration(p, t + h / 2, x2, v2), x3 = x + h * v2, v3 = v + h * a3;
                const double a4 = acceleration(p, t + h, x3, v3);
                x += h / 6 * (v + 2 * v1 + 2 * v2 + v3);
                v += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
                if (!(fabs(x) < 1e6)) x = v = NAN;
            }
            if (k >= periods - kept) {
                double *at = sections + 2 * (s * kept + k - (periods - kept));
                at[0] = x;
                at[1] = v;
            }
        }
        y[2 * s] = x;
        y[2 * s + 1] = v;
    }
}
