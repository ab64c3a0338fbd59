/* Answers the cases on standard input with emoc.h, one line each. */
#include "emoc.h"

#include <stdio.h>

#define MOST 64

int main(void) {
    emoc_parameters law;
    double mass, velocity, phi[MOST], rates[MOST];
    size_t n, k;
    while (scanf("%lf %lf %lf %lf %lf %lf %zu", &law.mu0, &law.alpha0, &law.alpha1, &law.notional_restitution, &mass,
                 &velocity, &n) == 7 && n <= MOST) {
        emoc_coefficients c = {0.0, 0.0, 0.0};
        emoc_rebound r = {0.0, 0.0, 0.0, 0.0};
        double z = 0.0, restitution = 0.0, sum = 0.0, amplitude = 0.3, rate = -2.0;
        int status = 0;
        for (k = 0; k < n; k++) {
            if (scanf("%lf %lf", &phi[k], &rates[k]) != 2) return 1;
            z += phi[k] * phi[k];
        }
        status |= emoc_coefficients_at(&law, mass, phi, n, &c);
        status |= emoc_restitution(&c, mass * z, &restitution);
        status |= emoc_meet(&c, mass, velocity, phi, rates, n, &r);
        for (k = 0; k < n; k++) sum += (double)(k + 1) * emoc_modal_rate(&r, phi[k], rates[k]);
        status |= emoc_ring(30.0 * mass, 0.1, 0.07, &amplitude, &rate);
        printf("%d %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g\n", status, restitution, r.velocity_m_s,
               r.impulse_n_s, r.share, sum, amplitude, rate, emoc_half_sine(30.0 * mass, 0.07));
    }
    return 0;
}
