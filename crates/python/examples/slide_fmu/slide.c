/* A drive and a load on a coupling, as an FMU of FMI 2.0 for co-simulation: just what the example needs.
 *
 * m1 x1'' = u - k0 x1 - c0 x1' - k (x1 - x2) - c (x1' - x2')
 * m2 x2'' = f + k (x1 - x2) + c (x1' - x2') - d x2'
 */
#include <stdlib.h>
#include <string.h>

#include "fmi2Functions.h"

enum { M1, M2, K0, C0, K, C, D, U, F, X1, V1, X2, V2, COUNT };

static const double START[COUNT] = {3.0, 5.0, 900.0, 12.0, 9000.0, 15.0, 8.0, 0, 0, 0, 0, 0, 0};
static const double STEP = 2e-4;

typedef struct { double value[COUNT]; } Slide;

static void rate(const double *p, const double *s, double *r) {
    double coupling = p[K] * (s[0] - s[2]) + p[C] * (s[1] - s[3]);
    r[0] = s[1];
    r[1] = (p[U] - p[K0] * s[0] - p[C0] * s[1] - coupling) / p[M1];
    r[2] = s[3];
    r[3] = (p[F] + coupling - p[D] * s[3]) / p[M2];
}

static void advance(double *p, double h) {
    double *s = p + X1, k[4][4], at[4];
    static const double PART[4] = {0.0, 0.5, 0.5, 1.0}, WEIGHT[4] = {1.0, 2.0, 2.0, 1.0};
    for (int stage = 0; stage < 4; stage++) {
        for (int i = 0; i < 4; i++) at[i] = s[i] + (stage ? PART[stage] * h * k[stage - 1][i] : 0.0);
        rate(p, at, k[stage]);
    }
    for (int i = 0; i < 4; i++)
        for (int stage = 0; stage < 4; stage++) s[i] += h / 6.0 * WEIGHT[stage] * k[stage][i];
}

const char *fmi2GetTypesPlatform(void) { return fmi2TypesPlatform; }
const char *fmi2GetVersion(void) { return fmi2Version; }

fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid, fmi2String where,
                              const fmi2CallbackFunctions *functions, fmi2Boolean visible, fmi2Boolean logging) {
    Slide *slide = malloc(sizeof(Slide));
    if (slide) memcpy(slide->value, START, sizeof START);
    return slide;
}

void fmi2FreeInstance(fmi2Component c) { free(c); }

fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean has_tolerance, fmi2Real tolerance, fmi2Real start,
                               fmi2Boolean has_stop, fmi2Real stop) { return fmi2OK; }
fmi2Status fmi2EnterInitializationMode(fmi2Component c) { return fmi2OK; }
fmi2Status fmi2ExitInitializationMode(fmi2Component c) { return fmi2OK; }
fmi2Status fmi2Terminate(fmi2Component c) { return fmi2OK; }

fmi2Status fmi2Reset(fmi2Component c) {
    memcpy(((Slide *)c)->value, START, sizeof START);
    return fmi2OK;
}

fmi2Status fmi2GetReal(fmi2Component c, const fmi2ValueReference vr[], size_t n, fmi2Real value[]) {
    for (size_t i = 0; i < n; i++) {
        if (vr[i] >= COUNT) return fmi2Error;
        value[i] = ((Slide *)c)->value[vr[i]];
    }
    return fmi2OK;
}

fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference vr[], size_t n, const fmi2Real value[]) {
    for (size_t i = 0; i < n; i++) {
        if (vr[i] >= COUNT) return fmi2Error;
        ((Slide *)c)->value[vr[i]] = value[i];
    }
    return fmi2OK;
}

fmi2Status fmi2DoStep(fmi2Component c, fmi2Real time, fmi2Real step, fmi2Boolean keep) {
    int count = (int)(step / STEP + 0.5);
    if (count < 1) count = 1;
    for (int i = 0; i < count; i++) advance(((Slide *)c)->value, step / count);
    return fmi2OK;
}

/* What FMI asks for and this model has not. */
#define NONE { return fmi2Error; }
fmi2Status fmi2SetDebugLogging(fmi2Component c, fmi2Boolean on, size_t n, const fmi2String categories[]) { return fmi2OK; }
fmi2Status fmi2GetInteger(fmi2Component c, const fmi2ValueReference vr[], size_t n, fmi2Integer value[]) NONE
fmi2Status fmi2GetBoolean(fmi2Component c, const fmi2ValueReference vr[], size_t n, fmi2Boolean value[]) NONE
fmi2Status fmi2GetString(fmi2Component c, const fmi2ValueReference vr[], size_t n, fmi2String value[]) NONE
fmi2Status fmi2SetInteger(fmi2Component c, const fmi2ValueReference vr[], size_t n, const fmi2Integer value[]) NONE
fmi2Status fmi2SetBoolean(fmi2Component c, const fmi2ValueReference vr[], size_t n, const fmi2Boolean value[]) NONE
fmi2Status fmi2SetString(fmi2Component c, const fmi2ValueReference vr[], size_t n, const fmi2String value[]) NONE
fmi2Status fmi2GetFMUstate(fmi2Component c, fmi2FMUstate *state) NONE
fmi2Status fmi2SetFMUstate(fmi2Component c, fmi2FMUstate state) NONE
fmi2Status fmi2FreeFMUstate(fmi2Component c, fmi2FMUstate *state) NONE
fmi2Status fmi2SerializedFMUstateSize(fmi2Component c, fmi2FMUstate state, size_t *size) NONE
fmi2Status fmi2SerializeFMUstate(fmi2Component c, fmi2FMUstate state, fmi2Byte bytes[], size_t size) NONE
fmi2Status fmi2DeSerializeFMUstate(fmi2Component c, const fmi2Byte bytes[], size_t size, fmi2FMUstate *state) NONE
fmi2Status fmi2GetDirectionalDerivative(fmi2Component c, const fmi2ValueReference unknown[], size_t unknowns,
                                        const fmi2ValueReference known[], size_t knowns, const fmi2Real by[],
                                        fmi2Real value[]) NONE
fmi2Status fmi2SetRealInputDerivatives(fmi2Component c, const fmi2ValueReference vr[], size_t n, const fmi2Integer order[],
                                       const fmi2Real value[]) NONE
fmi2Status fmi2GetRealOutputDerivatives(fmi2Component c, const fmi2ValueReference vr[], size_t n,
                                        const fmi2Integer order[], fmi2Real value[]) NONE
fmi2Status fmi2CancelStep(fmi2Component c) NONE
fmi2Status fmi2GetStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Status *value) NONE
fmi2Status fmi2GetRealStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Real *value) NONE
fmi2Status fmi2GetIntegerStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Integer *value) NONE
fmi2Status fmi2GetBooleanStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Boolean *value) NONE
fmi2Status fmi2GetStringStatus(fmi2Component c, const fmi2StatusKind kind, fmi2String *value) NONE
