/* What every C source begins with: sizes, outcomes, linear combinations and equations. */

#include <float.h>
#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC optimize("O3") /* vectors along rows; no sum is reordered */
#endif

typedef ptrdiff_t whole;

enum { DONE, NOT_FINITE, SINGULAR };

/* Solve A X = B with partial pivoting; rows of `both` are those of (A | B), B becomes X. */
static int solve(whole size, whole right, double *restrict both)
{
    const whole width = size + right;
    for (whole k = 0; k < size; k++) {
        whole best = k;
        for (whole i = k + 1; i < size; i++)
            if (fabs(both[i * width + k]) > fabs(both[best * width + k]))
                best = i;
        double *restrict row = both + k * width, *other = both + best * width;
        if (best != k)
            for (whole j = k; j < width; j++) {
                const double held = row[j];
                row[j] = other[j];
                other[j] = held;
            }
        if (row[k] == 0)
            return SINGULAR;
        const double inverse = 1 / row[k];
        for (whole i = k + 1; i < size; i++) {
            double *restrict below = both + i * width;
            const double factor = below[k] * inverse;
            if (factor != 0)
                for (whole j = k + 1; j < width; j++)
                    below[j] -= factor * row[j];
        }
    }
    for (whole k = size - 1; k >= 0; k--) {
        double *restrict row = both + k * width;
        for (whole i = k + 1; i < size; i++) {
            const double factor = row[i], *other = both + i * width;
            if (factor != 0)
                for (whole j = size; j < width; j++)
                    row[j] -= factor * other[j];
        }
        const double inverse = 1 / row[k];
        for (whole j = size; j < width; j++)
            row[j] *= inverse;
    }
    return DONE;
}

static int finite_all(whole count, const double *values)
{
    for (whole i = 0; i < count; i++)
        if (!(fabs(values[i]) <= DBL_MAX))
            return 0;
    return 1;
}

/* The sum of rows (few, n) with weights (few). */
static void combine(whole few, whole n, const double *weights, const double *values, double *restrict sum)
{
    memset(sum, 0, n * sizeof(double));
    for (whole l = 0; l < few; l++)
        for (whole s = 0; s < n; s++)
            sum[s] += weights[l] * values[l * n + s];
}
