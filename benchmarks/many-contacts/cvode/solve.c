/* A system of modes with contacts by SUNDIALS CVODE: solve PROBLEM adams|bdf TOLERANCE SECONDS
 *
 * The text PROBLEM is written by ../src/cvode.rs. State: amplitudes, then rates. In flight a contact has no force; in
 * contact it has that of its law; root finding stops at each change, and the integration begins anew. Prints the least
 * time of repeated runs, evaluations of the right-hand side, and the state at the end. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

typedef struct {
    int exponent_2; /* twice the exponent of the law */
    double stiffness, damping, gap;
    int first, count; /* modes that it sees */
    double *psi;
} Contact;

typedef struct {
    int modes, contacts, harmonics;
    double end, scale;
    double *omega_2, *damping, *start, *constant, *tolerance;
    Contact *contact;
    double *frequency, *phase, **amplitude;
    int *closed;
    long evaluations;
} System;

static double overlap(const Contact *c, const double *a) {
    double xi = -c->gap;
    for (int k = 0; k < c->count; k++) xi += c->psi[k] * a[c->first + k];
    return xi;
}

static double force(const Contact *c, const double *a, const double *b) {
    double xi = overlap(c, a);
    if (c->exponent_2 == 2) return c->stiffness * xi;
    double elastic = xi > 0 ? c->stiffness * xi * sqrt(xi) : 0;
    if (c->damping == 0) return elastic;
    double rate = 0;
    for (int k = 0; k < c->count; k++) rate += c->psi[k] * b[c->first + k];
    return elastic * (1 + c->damping * rate);
}

static int rates(double t, N_Vector y, N_Vector dy, void *data) {
    System *s = data;
    s->evaluations++;
    int n = s->modes;
    const double *a = NV_DATA_S(y), *b = a + n;
    double *da = NV_DATA_S(dy), *db = da + n;
    for (int k = 0; k < n; k++) {
        da[k] = b[k];
        db[k] = s->constant[k] - s->damping[k] * b[k] - s->omega_2[k] * a[k];
    }
    for (int h = 0; h < s->harmonics; h++) {
        double f = sin(s->frequency[h] * t + s->phase[h]);
        for (int k = 0; k < n; k++) db[k] += f * s->amplitude[h][k];
    }
    for (int i = 0; i < s->contacts; i++)
        if (s->closed[i]) {
            const Contact *c = &s->contact[i];
            double f = force(c, a, b);
            for (int k = 0; k < c->count; k++) db[c->first + k] -= c->psi[k] * f;
        }
    return 0;
}

static int overlaps(double t, N_Vector y, double *roots, void *data) {
    (void)t;
    System *s = data;
    for (int i = 0; i < s->contacts; i++) roots[i] = overlap(&s->contact[i], NV_DATA_S(y));
    return 0;
}

static double number(FILE *file) {
    double value;
    if (fscanf(file, "%lf", &value) != 1) exit(2);
    return value;
}

static double *numbers(FILE *file, int count) {
    double *values = malloc(sizeof(double) * (count ? count : 1));
    for (int i = 0; i < count; i++) values[i] = number(file);
    return values;
}

static System read_system(const char *path, double tolerance) {
    FILE *file = fopen(path, "r");
    if (!file) exit(2);
    System s = {0};
    s.modes = (int)number(file), s.contacts = (int)number(file), s.harmonics = (int)number(file);
    s.end = number(file), s.scale = number(file);
    int n = s.modes;
    s.omega_2 = numbers(file, n), s.damping = numbers(file, n), s.start = numbers(file, 2 * n);
    s.constant = numbers(file, n);
    s.contact = calloc(s.contacts, sizeof(Contact));
    s.closed = calloc(s.contacts, sizeof(int));
    for (int i = 0; i < s.contacts; i++) {
        Contact *c = &s.contact[i];
        c->exponent_2 = (int)number(file), c->stiffness = number(file), c->damping = number(file);
        c->gap = number(file), c->first = (int)number(file), c->count = (int)number(file);
        c->psi = numbers(file, c->count);
    }
    s.frequency = calloc(s.harmonics + 1, sizeof(double)), s.phase = calloc(s.harmonics + 1, sizeof(double));
    s.amplitude = calloc(s.harmonics + 1, sizeof(double *));
    for (int h = 0; h < s.harmonics; h++) {
        s.frequency[h] = number(file), s.phase[h] = number(file);
        s.amplitude[h] = numbers(file, n);
    }
    fclose(file);
    /* errors of all components weigh alike in the energy */
    s.tolerance = malloc(sizeof(double) * 2 * n);
    for (int k = 0; k < n; k++) {
        double omega = sqrt(s.omega_2[k]);
        s.tolerance[k] = tolerance * s.scale / (omega > 1 ? omega : 1);
        s.tolerance[n + k] = tolerance * s.scale;
    }
    return s;
}

/* One run; the state is left in y. Returns 0 if it came to its end. */
static int run(System *s, SUNContext context, N_Vector y, N_Vector tolerances, int bdf) {
    int n = 2 * s->modes, status = 1;
    memcpy(NV_DATA_S(y), s->start, sizeof(double) * n);
    /* touching at the start, with an approach */
    for (int i = 0; i < s->contacts; i++) s->closed[i] = overlap(&s->contact[i], s->start) >= 0;
    s->evaluations = 0;
    void *cvode = CVodeCreate(bdf ? CV_BDF : CV_ADAMS, context);
    SUNMatrix matrix = NULL;
    SUNLinearSolver linear = NULL;
    SUNNonlinearSolver nonlinear = NULL;
    CVodeInit(cvode, rates, 0, y);
    CVodeSetUserData(cvode, s);
    CVodeSVtolerances(cvode, 1e-14, tolerances);
    if (bdf) {
        matrix = SUNDenseMatrix(n, n, context);
        linear = SUNLinSol_Dense(y, matrix, context);
        CVodeSetLinearSolver(cvode, linear, matrix);
    } else {
        nonlinear = SUNNonlinSol_FixedPoint(y, 0, context);
        CVodeSetNonlinearSolver(cvode, nonlinear);
    }
    CVodeRootInit(cvode, s->contacts, overlaps);
    CVodeSetMaxNumSteps(cvode, 100000000);
    CVodeSetStopTime(cvode, s->end);
    int *direction = calloc(s->contacts, sizeof(int)), *found = calloc(s->contacts, sizeof(int));
    double t = 0;
    for (;;) {
        for (int i = 0; i < s->contacts; i++) direction[i] = s->closed[i] ? -1 : 1;
        CVodeSetRootDirection(cvode, direction);
        int flag = CVode(cvode, s->end, y, &t, CV_NORMAL);
        if (flag == CV_ROOT_RETURN) {
            CVodeGetRootInfo(cvode, found);
            for (int i = 0; i < s->contacts; i++)
                if (found[i]) s->closed[i] = !s->closed[i];
            CVodeReInit(cvode, t, y);
            CVodeSetStopTime(cvode, s->end);
            continue;
        }
        status = flag == CV_TSTOP_RETURN || flag == CV_SUCCESS ? 0 : 1;
        break;
    }
    free(direction), free(found);
    CVodeFree(&cvode);
    if (bdf) SUNLinSolFree(linear), SUNMatDestroy(matrix);
    else SUNNonlinSolFree(nonlinear);
    return status;
}

static double clock_s(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return now.tv_sec + 1e-9 * now.tv_nsec;
}

int main(int count, char **words) {
    if (count != 5) return 2;
    System s = read_system(words[1], atof(words[3]));
    double budget = atof(words[4]);
    SUNContext context;
    SUNContext_Create(NULL, &context);
    N_Vector y = N_VNew_Serial(2 * s.modes, context), tolerances = N_VMake_Serial(2 * s.modes, s.tolerance, context);
    double begin = clock_s(), least = INFINITY;
    do {
        double start = clock_s();
        if (run(&s, context, y, tolerances, strcmp(words[2], "bdf") == 0)) return 1;
        least = fmin(least, clock_s() - start);
    } while (clock_s() - begin < budget);
    printf("%.9g %ld", least, s.evaluations);
    for (int k = 0; k < 2 * s.modes; k++) printf(" %.17g", NV_DATA_S(y)[k]);
    printf("\n");
    return 0;
}
