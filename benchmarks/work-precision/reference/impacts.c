/* Reference solutions of the impacts in quadruple precision.
 *
 *     cargo run --release -p work-precision -- export problems
 *     gcc -O2 -o impacts impacts.c -lquadmath -lm && ./impacts problems/impact-*.txt > impacts.csv
 *
 * Contacts are integrated by Gragg's extrapolated midpoint rule with 16th-order columns and step control, free flight in
 * closed form with a search for sign changes at a sixtieth of the shortest period and for peaks between. Only the equations
 * are common to this program and the workspace: theta of the hysteretic law is a differential equation here.
 * Every problem is solved twice, with tolerances 1e-23 and 1e-20; the difference is stated as the error of the second,
 * and bounds that of the first. */
#include <quadmath.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef __float128 Real;
enum { MOST = 256, COLUMNS = 8 };

static int n, law, size; /* law: 0 Hertz, 1 viscous, 2 hysteretic */
static Real mass, speed, parameter[5], omega[MOST], zeta[MOST], phi[MOST];
static int loading;      /* branch of the hysteretic law */

/* state: z, z', a_1..a_n, a_1'..a_n', theta */
static void compression(const Real *y, Real *xi, Real *rate) {
    *xi = -y[0], *rate = -y[1];
    for (int k = 0; k < n; k++) *xi += phi[k] * y[2 + k], *rate += phi[k] * y[2 + n + k];
}

static Real force(const Real *y, Real xi, Real rate) {
    if (xi <= 0) return 0;
    Real hertz = parameter[0] * xi * sqrtq(xi);
    if (law == 1) return hertz * (1 + parameter[1] * rate);
    if (law == 2) return hertz * (1 + y[2 + 2 * n]);
    return hertz;
}

static void rates(const Real *y, Real *d) {
    Real xi, rate;
    compression(y, &xi, &rate);
    Real f = force(y, xi, rate);
    d[0] = y[1], d[1] = f / mass;
    for (int k = 0; k < n; k++) {
        Real a = y[2 + k], b = y[2 + n + k];
        d[2 + k] = b;
        d[2 + n + k] = -2 * zeta[k] * omega[k] * b - omega[k] * omega[k] * a - phi[k] * f;
    }
    if (law == 2) {
        Real sign = loading ? 1 : -1, up = xi > 0 ? xi : 0;
        d[2 + 2 * n] = parameter[3] * (parameter[1] + sign * parameter[2] - y[2 + 2 * n]) * sign * rate / (up + parameter[4]);
    } else {
        d[2 + 2 * n] = 0;
    }
}

/* One extrapolated step of length h; returns the error in units of the tolerance. */
static Real step(const Real *y, Real h, Real *out, Real tolerance) {
    static Real table[COLUMNS][2 * MOST + 3], u[2 * MOST + 3], v[2 * MOST + 3], d[2 * MOST + 3], before[2 * MOST + 3];
    for (int j = 0; j < COLUMNS; j++) {
        int m = 2 * (j + 1);
        Real s = h / m;
        rates(y, d);
        for (int i = 0; i < size; i++) u[i] = y[i], v[i] = y[i] + s * d[i];
        for (int l = 1; l < m; l++) {
            rates(v, d);
            for (int i = 0; i < size; i++) {
                Real w = u[i] + 2 * s * d[i];
                u[i] = v[i], v[i] = w;
            }
        }
        memcpy(table[j], v, sizeof(Real) * size);
        for (int l = j - 1; l >= 0; l--) {
            Real ratio = (Real)m / (2 * (l + 1));
            Real factor = 1 / (ratio * ratio - 1);
            if (l == 0 && j == COLUMNS - 1) memcpy(before, table[1], sizeof(Real) * size);
            for (int i = 0; i < size; i++) table[l][i] = table[l + 1][i] + (table[l + 1][i] - table[l][i]) * factor;
        }
    }
    /* table[0] is the last diagonal entry, table[1] now the one before it in the last row */
    Real error = 0;
    for (int i = 0; i < size; i++) {
        Real scale = i == 0 ? speed * 1e-5Q : i == 1 ? speed : i < 2 + n ? speed * sqrtq(mass) / omega[i - 2] : speed * sqrtq(mass);
        if (i == 2 + 2 * n) scale = 1;
        Real e = fabsq(table[0][i] - before[i]) / scale;
        if (e > error) error = e;
    }
    memcpy(out, table[0], sizeof(Real) * size);
    return error / tolerance;
}

/* The event function of the branch, negative beyond its end. */
static Real margin(const Real *y) {
    Real xi, rate;
    compression(y, &xi, &rate);
    if (law == 2 && loading) return rate;
    return xi;
}

static Real second(const Real *y) {
    Real xi, rate;
    compression(y, &xi, &rate);
    return law == 2 && !loading ? -rate : 1;
}

static Real guess; /* length of step that suited last */

/* Integrates until the branch ends; returns 0 for its event function, 1 for a new loading. */
static int contact(Real *t, Real *y, Real tolerance) {
    Real h = guess, next[2 * MOST + 3];
    int fresh = 1;
    h = 1e-12Q;
    for (;;) {
        Real error = step(y, h, next, tolerance);
        Real factor = error > 0 ? powq(error, -1.0Q / 15) * 0.8Q : 4;
        if (factor > 4) factor = 4;
        if (factor < 0.1Q) factor = 0.1Q;
        if (error > 1) {
            h *= factor;
            continue;
        }
        int which = margin(next) < 0 ? 0 : second(next) < 0 && !fresh ? 1 : -1;
        if (which >= 0 && !(fresh && which == 0)) {
            Real low = 0, high = h, at_low = which ? second(y) : margin(y), at_high = which ? second(next) : margin(next);
            int side = 0;
            for (int i = 0; i < 200 && high - low > 1e-32Q * (*t + h); i++) {
                Real middle = (low * at_high - high * at_low) / (at_high - at_low);
                if (!(middle > low && middle < high)) middle = (low + high) / 2;
                step(y, middle, next, tolerance);
                Real value = which ? second(next) : margin(next);
                if (value < 0) {
                    high = middle, at_high = value;
                    if (side == 1) at_low /= 2;
                    side = 1;
                } else {
                    low = middle, at_low = value;
                    if (side == -1) at_high /= 2;
                    side = -1;
                }
                if (fabsq(value) < 1e-34Q * speed) break;
            }
            step(y, high, next, tolerance);
            memcpy(y, next, sizeof(Real) * size);
            *t += high;
            return which;
        }
        fresh = 0;
        memcpy(y, next, sizeof(Real) * size);
        *t += h;
        h *= factor;
        if (*t > 10) {
            fprintf(stderr, "no end of contact\n");
            exit(1);
        }
    }
}

static void propagate(const Real *y, Real time, Real *out) {
    out[0] = y[0] + y[1] * time, out[1] = y[1];
    for (int k = 0; k < n; k++) {
        Real decay = zeta[k] * omega[k], damped = omega[k] * sqrtq(1 - zeta[k] * zeta[k]);
        Real a = y[2 + k], b = y[2 + n + k], s, c;
        sincosq(damped * time, &s, &c);
        Real e = expq(-decay * time), q = (b + decay * a) / damped;
        out[2 + k] = e * (a * c + q * s);
        out[2 + n + k] = e * (b * c - (decay * q + damped * a) * s);
    }
    out[2 + 2 * n] = y[2 + 2 * n];
}

/* Closed form up to the next touch (returns 1), or until it is certain that there is none (returns 0). */
static int flight(Real *t, Real *y) {
    Real shortest = 0, here[2 * MOST + 3], there[2 * MOST + 3], probe[2 * MOST + 3];
    for (int k = 0; k < n; k++) if (omega[k] > shortest) shortest = omega[k];
    Real h = 2 * M_PIq / shortest / 60, time = 0, xi, rate, next_xi, next_rate;
    memcpy(here, y, sizeof(Real) * size);
    compression(here, &xi, &rate);
    for (long i = 1;; i++) {
        if (i % 64 == 0) {
            Real reach = 0;
            for (int k = 0; k < n; k++) reach += fabsq(phi[k]) * sqrtq(here[2 + k] * here[2 + k] + here[2 + n + k] * here[2 + n + k] / omega[k] / omega[k]);
            if (here[1] > 0 && here[0] > 1.05Q * reach) return 0;
        }
        propagate(y, i * h, there);
        compression(there, &next_xi, &next_rate);
        Real left = (i - 1) * h, right = i * h;
        int touch = next_xi >= 0;
        if (!touch && rate > 0 && next_rate < 0) {
            /* There is a peak in between: bisect the rate, and check whether it reaches the surface. */
            Real low = left, high = right;
            for (int j = 0; j < 110; j++) {
                Real middle = (low + high) / 2, x, r;
                propagate(y, middle, probe);
                compression(probe, &x, &r);
                if (r > 0) low = middle; else high = middle;
                if (x >= 0) { touch = 1; break; }
            }
            if (touch) right = (low + high) / 2;
        }
        if (touch) {
            Real low = left, high = right;
            for (int j = 0; j < 112; j++) {
                Real middle = (low + high) / 2, x, r;
                propagate(y, middle, probe);
                compression(probe, &x, &r);
                if (x >= 0) high = middle; else low = middle;
            }
            propagate(y, high, probe);
            memcpy(y, probe, sizeof(Real) * size);
            *t += high;
            return 1;
        }
        memcpy(here, there, sizeof(Real) * size);
        xi = next_xi, rate = next_rate;
        time = i * h;
        if (time > 100) return 0;
    }
}

static void print(const char *name, const char *kind, Real a, Real b, Real c) {
    char text[3][64];
    quadmath_snprintf(text[0], 64, "%.25Qe", a);
    quadmath_snprintf(text[1], 64, "%.25Qe", b);
    quadmath_snprintf(text[2], 64, "%.25Qe", c);
    printf("%s,%s,%s,%s,%s\n", name, kind, text[0], text[1], text[2]);
}

static Real solve(Real tolerance, int *contacts, Real (*found)[3]) {
    Real y[2 * MOST + 3] = {0}, t = 0;
    size = 2 * n + 3;
    y[1] = -speed;
    *contacts = 0;
    do {
        Real before = y[1];
        found[*contacts][0] = t;
        loading = 1;
        y[2 + 2 * n] = law == 2 ? parameter[1] + parameter[2] : 0;
        for (;;) {
            int which = contact(&t, y, tolerance);
            if (law == 2 && (loading || which == 1)) {
                loading = !loading;
                continue;
            }
            break;
        }
        found[*contacts][1] = t;
        found[*contacts][2] = mass * (y[1] - before);
        ++*contacts;
    } while (flight(&t, y) && *contacts < 1000);
    return y[1] / speed;
}

int main(int argc, char **argv) {
    static Real found[1000][3], other[1000][3];
    printf("problem,kind,restitution_or_start_s,error_or_end_s,impulse_n_s\n");
    for (int f = 1; f < argc; f++) {
        FILE *file = fopen(argv[f], "r");
        char name[64], kind[64];
        double m, v, p[5] = {0};
        if (!file || fscanf(file, "name %63s mass_kg %lf speed_m_s %lf law %63s %lf %lf %lf %lf %lf modes %d", name, &m, &v, kind, p, p + 1, p + 2, p + 3, p + 4, &n) != 10 || n > MOST) {
            fprintf(stderr, "cannot read %s\n", argv[f]);
            return 1;
        }
        law = !strcmp(kind, "viscous") ? 1 : !strcmp(kind, "hysteretic") ? 2 : 0;
        mass = m, speed = v;
        for (int i = 0; i < 5; i++) parameter[i] = p[i];
        for (int k = 0; k < n; k++) {
            double o, z, s;
            if (fscanf(file, "%lf %lf %lf", &o, &z, &s) != 3) return 1;
            omega[k] = o, zeta[k] = z, phi[k] = s;
        }
        fclose(file);
        int contacts, others;
        Real coarse = solve(1e-20Q, &others, other), fine = solve(1e-23Q, &contacts, found);
        if (contacts != others) fprintf(stderr, "%s: %d and %d contacts\n", name, contacts, others);
        print(name, "net", fine, fabsq(fine - coarse), 0);
        for (int i = 0; i < contacts; i++) print(name, "contact", found[i][0], found[i][1], found[i][2]);
        fflush(stdout);
        fprintf(stderr, "%s done\n", name);
    }
    return 0;
}
