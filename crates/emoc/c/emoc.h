/* Net restitution without time integration, in C99: the law of the Rust crate emoc for one striker.
 *
 * A compact body of mass m meets a vibrating structure. Instead of the sub-impacts in between, the velocity after it and
 * the modal speeds are those of the least kinetic energy under the outward constraints
 *
 *     v - sum phi_k a_k'          >= ebar u                 u: speed of closing
 *     v - beta0 sum |phi_k a_k'|  >= beta1 ebar u
 *     |a_k' - a_k'(0)|            <= |phi_k| p              p: impulse on the striker
 *
 * The mathematics is stated in the documentation of the crate. There is no allocation and no shared state. Every function is
 * static; for input out of range it returns EMOC_INVALID and does not change its results.
 * emoc_ring and emoc_half_sine need <math.h>.
 *
 *     double phi[2] = {1.0, 0.6}, amplitudes[2] = {0.0, 0.0}, rates[2] = {0.0, 0.0};
 *     emoc_parameters law = {0.16, 9.0, 1.5, 1.0};
 *     emoc_coefficients of_location;
 *     emoc_rebound rebound;
 *     emoc_coefficients_at(&law, 0.2, phi, 2, &of_location);          // once for each location and striker
 *     emoc_meet(&of_location, 0.2, -1.0, phi, rates, 2, &rebound);    // rebound.velocity_m_s is the striker's
 *     for (k = 0; k < 2; k++)                                         // strike the structure, and let it vibrate
 *         rates[k] -= phi[k] * rebound.impulse_n_s * emoc_half_sine(omega[k], contact_s);
 *     emoc_ring(omega[k], damping_ratio[k], time_s, &amplitudes[k], &rates[k]);
 */
#ifndef EMOC_H
#define EMOC_H

#include <float.h>
#include <math.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Status that a function returns. */
typedef enum { EMOC_DONE = 0, EMOC_INVALID = 1 } emoc_status;

/* Fitted parameters of a structure. */
typedef struct {
    double mu0, alpha0, alpha1;
    double notional_restitution; /* without vibration, 0 to 1 */
} emoc_parameters;

/* The coefficients of the inequalities for a striker at a location. */
typedef struct {
    double ebar;  /* 0 to 1 */
    double beta0; /* not negative */
    double beta1; /* 0 to 1 */
} emoc_coefficients;

/* The result of an impact. */
typedef struct {
    double velocity_m_s; /* of the striker, positive away from the structure */
    double impulse_n_s;  /* on the striker; zero if the two were not closing */
    double level;        /* from which emoc_modal_rate gives the modal speeds */
    double share;        /* of the demands: 1 unless the energy would grow */
} emoc_rebound;

/* Largest number that is accepted, and largest impulse that is searched for. */
#define EMOC_LARGEST 1e60
#define EMOC_FARTHEST 1e200

static inline int emoc_bounded_(double value) { return fabs(value) <= EMOC_LARGEST; }

static inline int emoc_fraction_(double value) { return value >= 0.0 && value <= 1.0; }

static inline int emoc_not_negative_(double value) { return value >= 0.0 && value <= EMOC_LARGEST; }

static inline int emoc_valid_(const emoc_coefficients *c, double mass_kg) {
    return emoc_fraction_(c->ebar) && emoc_not_negative_(c->beta0) && emoc_fraction_(c->beta1)
        && mass_kg >= 1.0 / EMOC_LARGEST && mass_kg <= EMOC_LARGEST;
}

/* x/(1+x), without overflow. */
static inline double emoc_saturate_(double x) { return x <= 1.0 ? x / (1.0 + x) : 1.0 / (1.0 + 1.0 / x); }

/* Coefficients of a striker at a location, from the mass-normalised shapes (kg^-1/2) of n modes there, slowest first. */
static inline emoc_status emoc_coefficients_at(
    const emoc_parameters *law, double mass_kg, const double *phi, size_t n, emoc_coefficients *result) {
    double z = 0.0, t, x, y;
    size_t k;
    for (k = 0; k < n; k++) {
        if (!emoc_bounded_(phi[k])) return EMOC_INVALID;
        z += phi[k] * phi[k];
    }
    z *= mass_kg;
    if (!emoc_not_negative_(law->mu0) || !emoc_not_negative_(law->alpha0) || !emoc_not_negative_(law->alpha1)
        || !emoc_fraction_(law->notional_restitution)
        || !(mass_kg >= 1.0 / EMOC_LARGEST && mass_kg <= EMOC_LARGEST)) {
        return EMOC_INVALID;
    }
    t = law->mu0 * z;
    x = n > 0 ? law->alpha0 * z / (double)n : 0.0;
    y = n > 0 ? law->alpha1 * mass_kg * phi[0] * phi[0] : 0.0;
    /* ebar = (t^2 + 1)/(t^2 + t + 1), written so that neither end overflows */
    result->ebar = law->notional_restitution * (1.0 - (t <= 1.0 ? t / (t * t + t + 1.0) : 1.0 / (t + 1.0 + 1.0 / t)));
    result->beta0 = emoc_saturate_(x);
    result->beta1 = emoc_saturate_(y);
    return EMOC_DONE;
}

/* The closed form: restitution of an impact on a structure at rest, for Z = m sum phi_k^2. */
static inline emoc_status emoc_restitution(const emoc_coefficients *c, double z, double *result) {
    double basic = 1.0 / (1.0 + z), outward = (c->beta0 + c->beta1) / (1.0 + c->beta0);
    if (!emoc_valid_(c, 1.0) || !(z >= 0.0 && z <= DBL_MAX)) return EMOC_INVALID;
    *result = c->ebar * (basic >= outward ? basic : outward);
    return EMOC_DONE;
}

/* An impact: the common data of the functions below. */
typedef struct {
    const emoc_coefficients *c;
    double mass_kg, velocity_m_s;
    const double *phi, *rates;
    size_t n;
} emoc_meeting_;

/* Change of the speed of a mode. */
static inline double emoc_change_(double impulse, double level, double phi, double rate) {
    double range = fabs(phi) * impulse, wanted = -level * phi - rate;
    if (wanted < -range) return -range;
    if (wanted > range) return range;
    return wanted;
}

static inline double emoc_rate_(double impulse, double level, double phi, double rate) {
    return rate + emoc_change_(impulse, level, phi, rate);
}

static inline double emoc_velocity_(const emoc_meeting_ *m, double impulse) {
    return m->velocity_m_s + impulse / m->mass_kg;
}

/* Whether the energy does not grow beyond rounding of what the bodies exchange: a light striker has only a small share of the
 * energy of a structure that moves. It is false if numbers overflow. */
static inline int emoc_keeps_energy_(const emoc_meeting_ *m, double impulse, double level) {
    double by_velocity = impulse * m->velocity_m_s, by_impulse = 0.5 * impulse * (impulse / m->mass_kg);
    double gain = by_velocity + by_impulse, size = fabs(by_velocity) + by_impulse, change;
    size_t k;
    for (k = 0; k < m->n; k++) {
        change = emoc_change_(impulse, level, m->phi[k], m->rates[k]);
        gain += change * m->rates[k];
        gain += 0.5 * change * change;
        size += fabs(change * m->rates[k]) + 0.5 * change * change;
    }
    return gain <= 1e-10 * size;
}

/* Speed at which the contact opens. */
static inline double emoc_opening_(const emoc_meeting_ *m, double impulse, double level) {
    double sum = 0.0;
    size_t k;
    for (k = 0; k < m->n; k++) sum += m->phi[k] * emoc_rate_(impulse, level, m->phi[k], m->rates[k]);
    return emoc_velocity_(m, impulse) - sum;
}

/* The left side of the outward inequality. */
static inline double emoc_outward_(const emoc_meeting_ *m, double impulse, double level) {
    double sum = 0.0;
    size_t k;
    for (k = 0; k < m->n; k++) sum += fabs(m->phi[k] * emoc_rate_(impulse, level, m->phi[k], m->rates[k]));
    return emoc_velocity_(m, impulse) - m->c->beta0 * sum;
}

/* Derivative of the least energy with respect to the impulse. */
static inline double emoc_slope_(const emoc_meeting_ *m, double impulse, double level) {
    double sum = 0.0;
    size_t k;
    for (k = 0; k < m->n; k++) {
        double a = emoc_rate_(impulse, level, m->phi[k], m->rates[k]);
        sum += fabs(m->phi[k]) * fabs(a + level * m->phi[k]);
    }
    return emoc_velocity_(m, impulse) - level / m->mass_kg - sum;
}

/* The smallest level at which the contact opens as fast as demanded; 0 if there is none. */
static inline int emoc_level_(const emoc_meeting_ *m, double impulse, double opening, double *level) {
    double low = 0.0, high = 0.0, below, above, tried[2];
    size_t k;
    int i, j;
    if (emoc_opening_(m, impulse, 0.0) >= opening) {
        *level = 0.0;
        return 1;
    }
    for (k = 0; k < m->n; k++) {
        double end = m->phi[k] == 0.0 ? 0.0 : impulse - m->rates[k] / m->phi[k];
        if (end > high) high = end;
    }
    if (!(emoc_opening_(m, impulse, high) >= opening)) return 0;
    for (i = 0; i < 2200 && high - low > DBL_EPSILON * high; i++) {
        below = emoc_opening_(m, impulse, low) - opening;
        above = emoc_opening_(m, impulse, high) - opening;
        /* Between the ends of the modes' ranges the secant is exact. */
        tried[0] = low - below * ((high - low) / (above - below));
        tried[1] = 0.5 * (low + high);
        for (j = 0; j < 2; j++) {
            if (tried[j] > low && tried[j] < high) {
                if (emoc_opening_(m, impulse, tried[j]) >= opening) high = tried[j];
                else low = tried[j];
            }
        }
    }
    *level = high;
    return 1;
}

static inline int emoc_enough_(
    const emoc_meeting_ *m, double impulse, double opening, double outward, double *level) {
    return emoc_level_(m, impulse, opening, level) && emoc_outward_(m, impulse, *level) >= outward
        && emoc_slope_(m, impulse, *level) >= 0.0;
}

/* The least energy for these demands; 0 if numbers overflow or the energy would grow. */
static inline int emoc_solve_(const emoc_meeting_ *m, double opening, double outward, double found[2]) {
    double low = 0.0, high = m->mass_kg * fabs(opening - m->velocity_m_s), level = 0.0, trial, middle;
    int i, met = 0;
    for (i = 0; i < 2200; i++) {
        met = emoc_enough_(m, high, opening, outward, &level);
        if (met || !(high > 0.0 && high < EMOC_FARTHEST)) break;
        high *= 2.0;
    }
    if (!met) return 0;
    for (i = 0; i < 2200; i++) {
        middle = 0.5 * (low + high);
        if (middle <= low || middle >= high) break;
        if (emoc_enough_(m, middle, opening, outward, &trial)) {
            high = middle;
            level = trial;
        } else {
            low = middle;
        }
    }
    if (!emoc_keeps_energy_(m, high, level)) return 0;
    found[0] = high;
    found[1] = level;
    return 1;
}

/* The impact of a striker (velocity positive away from the structure) on a structure with these modal speeds
 * (kg^1/2 m/s). If the contact is not closing, nothing happens. */
static inline emoc_status emoc_meet(
    const emoc_coefficients *c,
    double mass_kg,
    double velocity_m_s,
    const double *phi,
    const double *rates,
    size_t n,
    emoc_rebound *result) {
    emoc_meeting_ m;
    double inverse, closing, demanded[2], attained[2], lowered[2], best[2], trial[2];
    double share, met = 0.0, too_much = 1.0;
    size_t k;
    int i, j;
    if (!emoc_valid_(c, mass_kg) || !emoc_bounded_(velocity_m_s)) return EMOC_INVALID;
    inverse = 1.0 / mass_kg;
    closing = -velocity_m_s;
    for (k = 0; k < n; k++) {
        if (!emoc_bounded_(phi[k]) || !emoc_bounded_(rates[k])) return EMOC_INVALID;
        inverse += phi[k] * phi[k];
        closing += phi[k] * rates[k];
    }
    m.c = c;
    m.mass_kg = mass_kg;
    m.velocity_m_s = velocity_m_s;
    m.phi = phi;
    m.rates = rates;
    m.n = n;
    result->velocity_m_s = velocity_m_s;
    result->impulse_n_s = result->level = 0.0;
    result->share = 1.0;
    if (closing <= 0.0) return EMOC_DONE;
    /* The impact without demands, in which every mode takes up the whole impulse. */
    best[0] = closing / inverse;
    best[1] = DBL_MAX;
    demanded[0] = c->ebar * closing;
    demanded[1] = c->beta1 * c->ebar * closing;
    attained[0] = 0.0;
    attained[1] = emoc_outward_(&m, best[0], best[1]);
    share = 1.0;
    for (i = 0; i <= 20; i++) {
        for (j = 0; j < 2; j++) {
            lowered[j] = attained[j] + share * (demanded[j] - attained[j]);
            if (lowered[j] < attained[j]) lowered[j] = attained[j];
            if (lowered[j] > demanded[j]) lowered[j] = demanded[j];
        }
        if (emoc_solve_(&m, lowered[0], lowered[1], trial)) {
            best[0] = trial[0];
            best[1] = trial[1];
            met = share;
            if (i == 0) break;
        } else {
            too_much = share;
        }
        share = 0.5 * (met + too_much);
    }
    result->velocity_m_s = emoc_velocity_(&m, best[0]);
    result->impulse_n_s = best[0];
    result->level = best[1];
    result->share = met;
    return EMOC_DONE;
}

/* Modal speed of least energy after the impact, for a mode with this shape and this initial speed. */
static inline double emoc_modal_rate(const emoc_rebound *rebound, double phi, double rate) {
    return emoc_rate_(rebound->impulse_n_s, rebound->level, phi, rate);
}

/* Share of the impulse that a mode takes up from a half-sine force of this duration. */
static inline double emoc_half_sine(double omega_rad_s, double duration_s) {
    const double pi = 3.14159265358979323846;
    double q = omega_rad_s * duration_s / pi;
    return fabs(q - 1.0) < 1e-6 ? pi / 4.0 : cos(0.5 * pi * q) / (1.0 - q * q);
}

/* Free vibration of a mode: its exact motion. The damping ratio is from 0 to below 1; a mode with omega 0 drifts. */
static inline emoc_status emoc_ring(
    double omega_rad_s, double damping_ratio, double time_s, double *amplitude, double *rate) {
    double decay = damping_ratio * omega_rad_s, a = *amplitude, b = *rate, damped, along, shrunk, s, c;
    if (!(omega_rad_s >= 0.0 && damping_ratio >= 0.0 && damping_ratio < 1.0 && time_s >= 0.0)
        || !emoc_bounded_(omega_rad_s) || !emoc_bounded_(time_s)) {
        return EMOC_INVALID;
    }
    if (omega_rad_s == 0.0) {
        *amplitude = a + b * time_s;
        return EMOC_DONE;
    }
    damped = omega_rad_s * sqrt(1.0 - damping_ratio * damping_ratio);
    s = sin(damped * time_s);
    c = cos(damped * time_s);
    shrunk = exp(-decay * time_s);
    along = (b + decay * a) / damped;
    *amplitude = shrunk * (a * c + along * s);
    *rate = shrunk * (b * c - (decay * along + damped * a) * s);
    return EMOC_DONE;
}

#ifdef __cplusplus
}
#endif

#endif
