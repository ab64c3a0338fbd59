/* A system of modes with contacts by SUNDIALS CVODE: solve PROBLEM adams|bdf TOLERANCE SCALE SECONDS
 *
 * Root finding stops at the end of a phase, and the integration restarts. Prints the shortest time of repeated runs and the
 * final state. SCALE is the modal rate to which errors are relative. */
#define REAL double
#define SQRT sqrt
#define POW pow
#define SIN sin
#include <math.h>
#include "system.h"

#include <time.h>

#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

static int derivative(double t, N_Vector y, N_Vector dy, void *data) {
    rates(data, t, NV_DATA_S(y), NV_DATA_S(dy));
    return 0;
}

static int roots(double t, N_Vector y, double *values, void *data) {
    (void)t;
    System *s = data;
    int unused[2];
    for (int i = 0; i < s->contacts; i++) boundaries(s, i, NV_DATA_S(y), values + 2 * i, unused);
    return 0;
}

/* One run; y returns the final state. Returns 0 if the end was reached. */
static int run(System *s, SUNContext context, N_Vector y, N_Vector tolerances, int bdf) {
    int n = 2 * s->modes, status = 1;
    memcpy(NV_DATA_S(y), s->start, sizeof(double) * n);
    begin(s);
    void *cvode = CVodeCreate(bdf ? CV_BDF : CV_ADAMS, context);
    SUNMatrix matrix = NULL;
    SUNLinearSolver linear = NULL;
    SUNNonlinearSolver nonlinear = NULL;
    CVodeInit(cvode, derivative, 0, y);
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
    CVodeRootInit(cvode, 2 * s->contacts, roots);
    CVodeSetNoInactiveRootWarn(cvode);
    CVodeSetMaxNumSteps(cvode, 100000000);
    int *direction = calloc(2 * s->contacts, sizeof(int)), *found = calloc(2 * s->contacts, sizeof(int));
    double values[2];
    for (;;) {
        for (int i = 0; i < s->contacts; i++) boundaries(s, i, NV_DATA_S(y), values, direction + 2 * i);
        CVodeSetRootDirection(cvode, direction);
        /* Time is counted from the start of the phase. */
        double left = s->end - s->zero, t = 0;
        if (left <= 0) {
            status = 0;
            break;
        }
        CVodeSetStopTime(cvode, left);
        int flag = CVode(cvode, left, y, &t, CV_NORMAL);
        if (flag != CV_ROOT_RETURN) {
            status = flag == CV_TSTOP_RETURN || flag == CV_SUCCESS ? 0 : 1;
            break;
        }
        CVodeGetRootInfo(cvode, found);
        for (int i = 0; i < s->contacts; i++)
            for (int which = 0; which < 2; which++)
                if (found[2 * i + which] && direction[2 * i + which]) {
                    cross(s, i, which);
                    break;
                }
        s->zero += t;
        CVodeReInit(cvode, 0, y);
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
    if (count != 6) return 2;
    System s = read_system(words[1]);
    double tolerance = atof(words[3]) * atof(words[4]), budget = atof(words[5]);
    SUNContext context;
    SUNContext_Create(NULL, &context);
    N_Vector y = N_VNew_Serial(2 * s.modes, context), tolerances = N_VNew_Serial(2 * s.modes, context);
    for (int k = 0; k < s.modes; k++) {
        /* The scale of a rigid body is its distance in a hundredth of the time. */
        double slowest = 1 / (0.01 * s.end), omega = s.omega[k] > slowest ? s.omega[k] : slowest;
        NV_DATA_S(tolerances)[k] = tolerance / omega;
        NV_DATA_S(tolerances)[s.modes + k] = tolerance;
    }
    double begun = clock_s(), least = INFINITY;
    do {
        double start = clock_s();
        if (run(&s, context, y, tolerances, strcmp(words[2], "bdf") == 0)) return 1;
        least = fmin(least, clock_s() - start);
    } while (clock_s() - begun < budget);
    printf("%.9g", least);
    for (int k = 0; k < 2 * s.modes; k++) printf(" %.17g", NV_DATA_S(y)[k]);
    printf("\n");
    return 0;
}
