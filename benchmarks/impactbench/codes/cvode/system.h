/* A problem as text, as template.py writes it, and its equations in numbers of the type REAL.
 *
 * State: amplitudes, then rates. A contact has the compression xi = psi a - gap and the force
 *
 *     k xi^n (1 + d xi') + c xi'
 *
 * which does not pull: it is OPEN, PUSHES, or is SLACK, pressed but without force. Within a phase the equations are smooth. */
#ifndef SYSTEM_H
#define SYSTEM_H

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { OPEN, PUSHING, SLACK, RESTING /* touches and does not move yet: pushes where it is pressed */ };

typedef struct {
    REAL exponent, stiffness, damping, dashpot, gap;
    int first, count; /* modes that it sees */
    REAL *psi;
} Contact;

typedef struct {
    int modes, contacts, harmonics;
    REAL end;
    REAL *omega, *damping, *start, *constant;
    Contact *contact;
    REAL *frequency, *phase, **amplitude;
    int *phases;
    REAL zero; /* of time: the start of the phase */
    long evaluations;
} System;

static REAL number(FILE *file) {
    double value;
    if (fscanf(file, "%lf", &value) != 1) exit(2);
    return value;
}

static REAL *numbers(FILE *file, int count) {
    REAL *values = malloc(sizeof(REAL) * (count ? count : 1));
    for (int i = 0; i < count; i++) values[i] = number(file);
    return values;
}

static System read_system(const char *path) {
    FILE *file = fopen(path, "r");
    if (!file) exit(2);
    System s = {0};
    s.modes = (int)number(file), s.contacts = (int)number(file), s.harmonics = (int)number(file);
    s.end = number(file);
    int n = s.modes;
    s.omega = numbers(file, n), s.damping = numbers(file, n), s.start = numbers(file, 2 * n);
    for (int k = 0; k < n; k++) s.damping[k] *= 2 * s.omega[k];
    s.constant = numbers(file, n);
    s.contact = calloc(s.contacts + 1, sizeof(Contact));
    s.phases = calloc(s.contacts + 1, sizeof(int));
    for (int i = 0; i < s.contacts; i++) {
        Contact *c = &s.contact[i];
        c->stiffness = number(file), c->exponent = number(file), c->damping = number(file), c->dashpot = number(file);
        c->gap = number(file);
        REAL *psi = numbers(file, n);
        c->first = 0, c->count = n;
        while (c->count > 0 && psi[c->count - 1] == 0) c->count--;
        while (c->first < c->count && psi[c->first] == 0) c->first++;
        c->count -= c->first;
        c->psi = psi + c->first;
    }
    s.frequency = calloc(s.harmonics + 1, sizeof(REAL)), s.phase = calloc(s.harmonics + 1, sizeof(REAL));
    s.amplitude = calloc(s.harmonics + 1, sizeof(REAL *));
    for (int h = 0; h < s.harmonics; h++) {
        s.frequency[h] = number(file), s.phase[h] = number(file);
        s.amplitude[h] = numbers(file, n);
    }
    fclose(file);
    return s;
}

static REAL compression(const System *s, int i, const REAL *y, REAL *rate) {
    const Contact *c = &s->contact[i];
    const REAL *a = y + c->first, *b = a + s->modes;
    REAL xi = -c->gap;
    *rate = 0;
    for (int k = 0; k < c->count; k++) xi += c->psi[k] * a[k], *rate += c->psi[k] * b[k];
    return xi;
}

/* The formula of the force. */
static REAL formula(const Contact *c, REAL xi, REAL rate) {
    REAL power = xi;
    if (c->exponent == 1.5) power = xi > 0 ? xi * SQRT(xi) : 0;
    else if (c->exponent != 1) power = xi > 0 ? POW(xi, c->exponent) : 0;
    return c->stiffness * power * (1 + c->damping * rate) + c->dashpot * rate;
}

/* Positive where a pressed contact pushes. */
static REAL pushes(const Contact *c, REAL xi, REAL rate) {
    return c->dashpot != 0 ? c->stiffness * xi + c->dashpot * rate : 1 + c->damping * rate;
}

static void rates(System *s, REAL t, const REAL *y, REAL *dy) {
    s->evaluations++;
    int n = s->modes;
    const REAL *a = y, *b = y + n;
    for (int k = 0; k < n; k++) {
        dy[k] = b[k];
        dy[n + k] = s->constant[k] - s->damping[k] * b[k] - s->omega[k] * s->omega[k] * a[k];
    }
    for (int h = 0; h < s->harmonics; h++) {
        REAL f = SIN(s->frequency[h] * (s->zero + t) + s->phase[h]);
        for (int k = 0; k < n; k++) dy[n + k] += f * s->amplitude[h][k];
    }
    for (int i = 0; i < s->contacts; i++) {
        if (s->phases[i] == OPEN || s->phases[i] == SLACK) continue;
        const Contact *c = &s->contact[i];
        REAL rate, xi = compression(s, i, y, &rate);
        if (s->phases[i] == RESTING && xi <= 0) continue;
        REAL f = formula(c, xi, rate);
        for (int k = 0; k < c->count; k++) dy[n + c->first + k] -= c->psi[k] * f;
    }
}

/* Two functions for each contact, of which the phase ends where one changes its sign in this direction; 0 if it does not. */
static void boundaries(const System *s, int i, const REAL *y, REAL *values, int *directions) {
    REAL rate, xi = compression(s, i, y, &rate);
    values[0] = xi;
    values[1] = pushes(&s->contact[i], xi, rate);
    directions[0] = s->phases[i] == OPEN ? 1 : -1;
    directions[1] = s->phases[i] == OPEN ? 0 : s->phases[i] == SLACK ? 1 : -1;
}

/* The phase after a boundary. */
static void cross(System *s, int i, int which) {
    if (which == 0) s->phases[i] = s->phases[i] == OPEN ? PUSHING : OPEN;
    else s->phases[i] = s->phases[i] == SLACK ? PUSHING : SLACK;
}

/* The phases at the start. */
static void begin(System *s) {
    s->zero = 0;
    s->evaluations = 0;
    for (int i = 0; i < s->contacts; i++) {
        REAL rate, xi = compression(s, i, s->start, &rate);
        s->phases[i] = xi < 0 || rate < 0 ? OPEN : rate > 0 ? PUSHING : RESTING;
    }
}

#endif
