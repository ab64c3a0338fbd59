/* References in quadruple precision: quad PROBLEM. See reference/run.sh.
 *
 * Gragg's midpoint rule, extrapolated in eight columns (16th order) with step control. A phase ends inside a step where one of
 * its event functions changes sign; that step is repeated with the length that leads to it, by the Illinois rule. No step is longer
 * than two radians of the fastest mode, so that event functions are sampled finely enough. Prints the final state for the
 * tolerances 1e-23 and 1e-20, whose difference bounds the error of the first. Only the equations are common to this program
 * and the workspace. */
#include <quadmath.h>
#define REAL __float128
#define SQRT sqrtq
#define POW powq
#define SIN sinq
#include "../codes/cvode/system.h"

enum { MOST = 512, COLUMNS = 8 };
static REAL weight[MOST]; /* of an error in a component */

/* One extrapolated step; returns its error. */
static REAL step(System *s, REAL t, const REAL *y, REAL h, REAL *out) {
    static REAL table[COLUMNS][MOST], u[MOST], v[MOST], first[MOST], d[MOST], before[MOST];
    int size = 2 * s->modes;
    rates(s, t, y, first);
    for (int j = 0; j < COLUMNS; j++) {
        int m = 2 * (j + 1);
        REAL part = h / m;
        for (int i = 0; i < size; i++) u[i] = y[i], v[i] = y[i] + part * first[i];
        for (int l = 1; l < m; l++) {
            rates(s, t + l * part, v, d);
            for (int i = 0; i < size; i++) {
                REAL w = u[i] + 2 * part * d[i];
                u[i] = v[i], v[i] = w;
            }
        }
        memcpy(table[j], v, sizeof(REAL) * size);
        for (int l = j - 1; l >= 0; l--) {
            REAL ratio = (REAL)m / (2 * (l + 1)), factor = 1 / (ratio * ratio - 1);
            if (l == 0 && j == COLUMNS - 1) memcpy(before, table[1], sizeof(REAL) * size);
            for (int i = 0; i < size; i++) table[l][i] = table[l + 1][i] + (table[l + 1][i] - table[l][i]) * factor;
        }
    }
    REAL error = 0;
    for (int i = 0; i < size; i++) {
        REAL e = fabsq(table[0][i] - before[i]) * weight[i];
        if (e > error) error = e;
    }
    memcpy(out, table[0], sizeof(REAL) * size);
    return error;
}

/* An event function, positive before the event. */
static REAL margin(const System *s, int i, int which, const REAL *y) {
    REAL values[2];
    int directions[2];
    boundaries(s, i, y, values, directions);
    return directions[which] == 0 ? 1 : -directions[which] * values[which];
}

/* Integrates a phase; returns 1 if an event ended it, after which the next phase begins. */
static int phase(System *s, REAL *y, REAL tolerance, REAL longest) {
    int size = 2 * s->modes, count = 2 * s->contacts;
    REAL t = 0, end = s->end - s->zero, next[MOST], tried[MOST];
    /* A force begins as a power of time, which cannot be extrapolated: steps grow from a very small one. */
    REAL h = 1e-13Q * s->end, least[2 * 64];
    for (int b = 0; b < count; b++) least[b] = fminq(margin(s, b / 2, b % 2, y), 0);
    while (t < end) {
        if (h > longest) h = longest;
        if (t + h > end) h = end - t;
        REAL error = step(s, t, y, h, next);
        REAL factor = error > 0 ? 0.8Q * powq(tolerance / error, 1.0Q / 15) : 4;
        factor = factor > 4 ? 4 : factor < 0.1Q ? 0.1Q : factor;
        if (error > tolerance) {
            h *= factor;
            continue;
        }
        int met = -1;
        REAL length = h;
        for (int b = 0; b < count; b++) {
            REAL low = 0, high = length, above, below = margin(s, b / 2, b % 2, met < 0 ? next : tried);
            if (below >= least[b] || margin(s, b / 2, b % 2, y) <= least[b]) continue;
            above = margin(s, b / 2, b % 2, y);
            /* The step is repeated with the length that ends at the event. */
            int side = 0;
            for (int trial = 0; trial < 200 && high - low > 1e-30Q * s->end; trial++) {
                REAL middle = (low * below - high * above) / (below - above);
                if (!(middle > low && middle < high)) middle = 0.5Q * (low + high);
                step(s, t, y, middle, tried);
                REAL there = margin(s, b / 2, b % 2, tried);
                if (there == 0) {
                    low = high = middle;
                } else if (there < 0) {
                    high = middle, below = there;
                    if (side == -1) above /= 2;
                    side = -1;
                } else {
                    low = middle, above = there;
                    if (side == 1) below /= 2;
                    side = 1;
                }
            }
            length = high, met = b;
            step(s, t, y, length, tried);
        }
        if (met >= 0) {
            memcpy(y, tried, sizeof(REAL) * size);
            s->zero += t + length;
            cross(s, met / 2, met % 2);
            return 1;
        }
        memcpy(y, next, sizeof(REAL) * size);
        t += h;
        h *= factor;
        /* The function of an event that has just occurred starts from zero. */
        for (int b = 0; b < count; b++)
            if (margin(s, b / 2, b % 2, y) > 0) least[b] = 0;
    }
    s->zero = s->end;
    return 0;
}

int main(int count, char **words) {
    if (count != 2) return 2;
    System s = read_system(words[1]);
    int size = 2 * s.modes;
    if (size > MOST || s.contacts > 64) return 2;
    REAL fastest = 0, speed = 0;
    for (int k = 0; k < s.modes; k++) {
        if (s.omega[k] > fastest) fastest = s.omega[k];
        speed += s.start[s.modes + k] * s.start[s.modes + k];
        REAL reach = s.omega[k] * s.end > 1 ? 1 / s.omega[k] : s.end;
        speed += s.constant[k] * s.constant[k] * reach * reach;
        for (int h = 0; h < s.harmonics; h++) speed += s.amplitude[h][k] * s.amplitude[h][k] * reach * reach;
    }
    speed = sqrtq(speed);
    for (int k = 0; k < s.modes; k++) {
        REAL omega = s.omega[k] * s.end > 100 ? s.omega[k] : 100 / s.end;
        weight[k] = omega / speed, weight[s.modes + k] = 1 / speed;
    }
    REAL longest = fastest * s.end > 200 ? 2 / fastest : s.end / 100, y[MOST];
    for (int fine = 1; fine >= 0; fine--) {
        begin(&s);
        memcpy(y, s.start, sizeof(REAL) * size);
        while (phase(&s, y, fine ? 1e-23Q : 1e-20Q, longest)) {}
        for (int i = 0; i < size; i++) {
            char text[64];
            quadmath_snprintf(text, sizeof text, "%.25Qg", y[i]);
            printf("%s ", text);
        }
        printf("\n");
    }
    return 0;
}
