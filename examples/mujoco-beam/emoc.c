/* The rebound law as a library that a simulator in another language loads. */
#include "../../crates/emoc/c/emoc.h"

/* Restitution of a striker that meets a structure which moves with these modal rates; strikes the modes, each with the share
 * of the impulse that a half sine of this duration gives it. Negative for input out of range. */
double emoc_strike(
    const double *law, double mass_kg, double velocity_m_s, const double *phi, const double *omega_rad_s, double *rates,
    size_t modes, double contact_s) {
    emoc_parameters parameters = {law[0], law[1], law[2], 1.0};
    emoc_coefficients of_location;
    emoc_rebound rebound;
    size_t k;
    if (emoc_coefficients_at(&parameters, mass_kg, phi, modes, &of_location)
        || emoc_meet(&of_location, mass_kg, velocity_m_s, phi, rates, modes, &rebound)) {
        return -1.0;
    }
    for (k = 0; k < modes; k++) {
        rates[k] -= phi[k] * rebound.impulse_n_s * emoc_half_sine(omega_rad_s[k], contact_s);
    }
    return -rebound.velocity_m_s / velocity_m_s;
}

/* Lets the modes ring freely. */
int emoc_ring_all(
    const double *omega_rad_s, double damping_ratio, double time_s, double *amplitudes, double *rates, size_t modes) {
    int status = 0;
    size_t k;
    for (k = 0; k < modes; k++) {
        status |= emoc_ring(omega_rad_s[k], damping_ratio, time_s, &amplitudes[k], &rates[k]);
    }
    return status;
}
