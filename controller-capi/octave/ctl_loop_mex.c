/*
 * ctl_loop_mex: the controller in Octave (and MATLAB), by its C interface in double precision.
 *
 *     cargo build -p controller-capi-staticlib --profile embedded
 *     mkoctfile --mex -Icontroller-capi/include controller-capi/octave/ctl_loop_mex.c target/embedded/libctl.a
 *
 *     out = ctl_loop_mex (config, record)
 *     [out, block] = ctl_loop_mex (config, record)
 *     [out, block] = ctl_loop_mex ([], record, block)
 *
 * `config` is a struct with fields of ctl_config (see ctl.h); what it does not have keeps its default. The lists of a model
 * are vectors, which also say how many factors there are; choices are the numbers of ctl.h (observer: compensator = 2).
 *
 * `record` is a struct with fields of ctl_f64_input: each a scalar, or a vector with one entry a sample; `r` and `y` are
 * needed. `u_applied` and `manual` count as given when they are there. A field `settle` = [r y u] starts the loop at rest
 * there; without it the first sample does, at rest at its own r and y.
 *
 * `out` is a struct with a column of each field of ctl_f64_output. `block` is the loop's memory after the record: with it, a
 * next call goes on, with the same parameters ([]) or with others that it adopts.
 */
#include <math.h>
#include <string.h>

#include "ctl.h"
#include "mex.h"

/* Which kind of number a field holds. */
enum kind { REAL, INTEGER, LIST };

struct field {
    const char *name;
    size_t offset;
    enum kind kind;
};

#define CONFIG(name, kind) { #name, offsetof(ctl_config, name), kind }
#define INPUT(name, kind) { #name, offsetof(ctl_f64_input, name), kind }
#define OUTPUT(name, kind) { #name, offsetof(ctl_f64_output, name), kind }

static const struct field config_fields[] = {
    CONFIG(ts, REAL), CONFIG(kp, REAL), CONFIG(ki, REAL), CONFIG(kd, REAL), CONFIG(tf, REAL), CONFIG(b, REAL),
    CONFIG(c, REAL), CONFIG(action, INTEGER), CONFIG(integral_rule, INTEGER), CONFIG(anti_windup, INTEGER),
    CONFIG(tt, REAL), CONFIG(deadband, REAL), CONFIG(setpoint_track, INTEGER), CONFIG(output_lo, REAL),
    CONFIG(output_hi, REAL), CONFIG(output_rate_up, REAL), CONFIG(output_rate_down, REAL), CONFIG(setpoint_lo, REAL),
    CONFIG(setpoint_hi, REAL), CONFIG(setpoint_rate_up, REAL), CONFIG(setpoint_rate_down, REAL),
    CONFIG(measurement_lo, REAL), CONFIG(measurement_hi, REAL), CONFIG(offset_lo, REAL), CONFIG(offset_hi, REAL),
    CONFIG(fallback_action, INTEGER), CONFIG(fallback_return, INTEGER), CONFIG(hold_samples, INTEGER),
    CONFIG(fallback_output, REAL), CONFIG(fallback_rate, REAL), CONFIG(alarm_hi_hi, REAL), CONFIG(alarm_hi, REAL),
    CONFIG(alarm_lo, REAL), CONFIG(alarm_lo_lo, REAL), CONFIG(alarm_deviation, REAL), CONFIG(alarm_hysteresis, REAL),
    CONFIG(off_output, REAL), CONFIG(initial_output, REAL), CONFIG(compensator, INTEGER), CONFIG(kfd, REAL),
    CONFIG(tfd, REAL), CONFIG(alpha, REAL), CONFIG(filter_order, INTEGER), CONFIG(latency, REAL),
    CONFIG(model_gain, REAL), CONFIG(model_dead_time, REAL), CONFIG(model_integrators, INTEGER),
    CONFIG(model_pole_a1, LIST), CONFIG(model_pole_a2, LIST), CONFIG(model_zero_a1, LIST), CONFIG(model_zero_a2, LIST),
};

static const struct field input_fields[] = {
    INPUT(r, REAL), INPUT(r_remote, REAL), INPUT(y, REAL), INPUT(u_applied, REAL), INPUT(manual, REAL),
    INPUT(track, REAL), INPUT(offset, REAL), INPUT(mode, INTEGER), INPUT(quality, INTEGER),
    INPUT(compensator_off, INTEGER), INPUT(inhibit_up, INTEGER), INPUT(inhibit_down, INTEGER),
    INPUT(acknowledge, INTEGER),
};

/* INTEGER: of 32 bits, with a sign or without. */
static const struct field output_fields[] = {
    OUTPUT(u, REAL), OUTPUT(v, REAL), OUTPUT(i, REAL), OUTPUT(pd, REAL), OUTPUT(u_f, REAL), OUTPUT(d_hat, REAL),
    OUTPUT(r, REAL), OUTPUT(mode, INTEGER), OUTPUT(status, INTEGER), OUTPUT(blocked_up, INTEGER),
    OUTPUT(blocked_down, INTEGER),
};

#define COUNT(list) (sizeof(list) / sizeof((list)[0]))

static void refuse(const char *what, const char *why)
{
    mexErrMsgIdAndTxt("ctl:argument", "%s: %s", what, why);
}

static void check(int32_t code, const ctl_faults *faults)
{
    if (code == CTL_OK) {
        return;
    }
    if (faults && faults->count > 0) {
        const ctl_fault *fault = &faults->list[0];
        mexErrMsgIdAndTxt("ctl:config", "%s: %s = %g %s (faults: %u)", ctl_error_text(code),
                          ctl_param_name(fault->param), fault->value, ctl_reason_text(fault->reason),
                          (unsigned)faults->total);
    }
    mexErrMsgIdAndTxt("ctl:call", "%s", ctl_error_text(code));
}

/* A real array of doubles or of truth values; gives how many. */
static size_t numbers(const mxArray *array, const char *name)
{
    if (!(mxIsDouble(array) || mxIsLogical(array)) || mxIsComplex(array) || mxIsSparse(array)) {
        refuse(name, "not real numbers (double or logical)");
    }
    return mxGetNumberOfElements(array);
}

static double number_at(const mxArray *array, size_t at)
{
    return mxIsLogical(array) ? (double)mxGetLogicals(array)[at] : mxGetPr(array)[at];
}

static int32_t integer(double x, const char *name)
{
    if (!(x >= -2147483648.0 && x <= 2147483647.0) || x != floor(x)) {
        refuse(name, "not a whole number of 32 bits");
    }
    return (int32_t)x;
}

static void put(void *structure, const struct field *field, double x)
{
    char *at = (char *)structure + field->offset;
    if (field->kind == INTEGER) {
        *(int32_t *)(void *)at = integer(x, field->name);
    } else {
        *(double *)(void *)at = x;
    }
}

static const struct field *find(const struct field *list, size_t count, const char *name)
{
    for (size_t i = 0; i < count; i++) {
        if (strcmp(list[i].name, name) == 0) {
            return &list[i];
        }
    }
    return NULL;
}

static size_t put_list(ctl_config *config, const struct field *field, const mxArray *array)
{
    size_t count = numbers(array, field->name);
    if (count > CTL_MAX_FACTORS) {
        refuse(field->name, "more factors than a model can have");
    }
    for (size_t i = 0; i < count; i++) {
        ((double *)(void *)((char *)config + field->offset))[i] = number_at(array, i);
    }
    return count;
}

static void read_config(const mxArray *from, ctl_config *config)
{
    if (!mxIsStruct(from) || mxGetNumberOfElements(from) != 1) {
        refuse("config", "not a struct");
    }
    check(ctl_config_default(config, sizeof *config), NULL);
    size_t poles = 0, zeros = 0;
    for (int i = 0; i < mxGetNumberOfFields(from); i++) {
        const char *name = mxGetFieldNameByNumber(from, i);
        const struct field *field = find(config_fields, COUNT(config_fields), name);
        const mxArray *array = mxGetFieldByNumber(from, 0, i);
        if (!field) {
            refuse(name, "not a field of ctl_config");
        } else if (field->kind == LIST) {
            size_t count = put_list(config, field, array);
            size_t *most = strncmp(name, "model_pole", 10) == 0 ? &poles : &zeros;
            *most = count > *most ? count : *most;
        } else if (numbers(array, name) != 1) {
            refuse(name, "not one number");
        } else {
            put(config, field, number_at(array, 0));
        }
    }
    config->model_pole_count = (int32_t)poles;
    config->model_zero_count = (int32_t)zeros;
}

/* A record's columns, in the order of input_fields; NULL: not there. */
struct record {
    const mxArray *columns[COUNT(input_fields)];
    const mxArray *settle;
    size_t samples;
};

static void read_record(const mxArray *from, struct record *record)
{
    if (!mxIsStruct(from) || mxGetNumberOfElements(from) != 1) {
        refuse("record", "not a struct");
    }
    memset(record, 0, sizeof *record);
    for (int i = 0; i < mxGetNumberOfFields(from); i++) {
        const char *name = mxGetFieldNameByNumber(from, i);
        const mxArray *array = mxGetFieldByNumber(from, 0, i);
        size_t count = numbers(array, name);
        if (strcmp(name, "settle") == 0) {
            if (count != 3) {
                refuse(name, "not [r y u]");
            }
            record->settle = array;
            continue;
        }
        const struct field *field = find(input_fields, COUNT(input_fields), name);
        if (!field) {
            refuse(name, "not a field of ctl_f64_input");
        }
        record->columns[field - input_fields] = array;
    }
    if (!record->columns[0] || !record->columns[2]) {
        refuse("record", "r and y are needed");
    }
    /* A scalar stands for all samples; all others are as long as the first of them. */
    record->samples = 1;
    for (size_t i = 0; i < COUNT(input_fields); i++) {
        size_t count = record->columns[i] ? mxGetNumberOfElements(record->columns[i]) : 1;
        if (count != 1 && record->samples == 1) {
            record->samples = count;
        }
        if (count != 1 && count != record->samples) {
            refuse(input_fields[i].name, "as long neither as the others nor one number");
        }
    }
}

static void read_sample(const struct record *record, size_t at, ctl_f64_input *in)
{
    memset(in, 0, sizeof *in);
    for (size_t i = 0; i < COUNT(input_fields); i++) {
        const mxArray *column = record->columns[i];
        if (column) {
            put(in, &input_fields[i], number_at(column, mxGetNumberOfElements(column) == 1 ? 0 : at));
        }
    }
    in->has_u_applied = record->columns[3] != NULL;
    in->has_manual = record->columns[4] != NULL;
}

static mxArray *new_block(size_t words)
{
    return mxCreateNumericMatrix((mwSize)words, 1, mxUINT64_CLASS, mxREAL);
}

/* The loop's memory: a copy of the one given, or a new one with room for the configuration. */
static mxArray *make_block(const ctl_config *config, const mxArray *given)
{
    ctl_faults faults = {0};
    if (given) {
        if (!mxIsUint64(given)) {
            refuse("block", "not what an earlier call gave");
        }
        mxArray *block = mxDuplicateArray(given);
        if (config) {
            check(ctl_f64_adopt(mxGetData(block), mxGetNumberOfElements(block) * 8, config, &faults), &faults);
        }
        return block;
    }
    if (!config) {
        refuse("config", "needed without a block");
    }
    uint32_t delay = 0;
    check(ctl_f64_check(config, &faults), &faults);
    check(ctl_f64_delay_samples(config, &delay), NULL);
    size_t words = CTL_F64_WORDS((size_t)delay);
    mxArray *block = new_block(words);
    check(ctl_f64_init(mxGetData(block), words * 8, config, &faults), &faults);
    return block;
}

void mexFunction(int outputs, mxArray *out[], int inputs, const mxArray *in[])
{
    if (inputs < 2 || inputs > 3 || outputs > 2) {
        mexErrMsgIdAndTxt("ctl:usage", "[out, block] = ctl_loop_mex (config, record) or ([] or config, record, block)");
    }
    if (ctl_abi_version() != CTL_ABI_VERSION) {
        refuse("ctl_loop_mex", "header and archive are of different versions");
    }
    ctl_config config;
    int has_config = !mxIsEmpty(in[0]);
    if (has_config) {
        read_config(in[0], &config);
    }
    struct record record;
    read_record(in[1], &record);
    mxArray *block = make_block(has_config ? &config : NULL, inputs == 3 ? in[2] : NULL);
    void *loop = mxGetData(block);
    size_t size = mxGetNumberOfElements(block) * 8;
    if (record.settle) {
        const mxArray *to = record.settle;
        check(ctl_f64_settle(loop, size, number_at(to, 0), number_at(to, 1), number_at(to, 2)), NULL);
    }

    const char *names[COUNT(output_fields)];
    double *columns[COUNT(output_fields)];
    for (size_t i = 0; i < COUNT(output_fields); i++) {
        names[i] = output_fields[i].name;
    }
    out[0] = mxCreateStructMatrix(1, 1, (int)COUNT(output_fields), names);
    for (size_t i = 0; i < COUNT(output_fields); i++) {
        mxArray *column = mxCreateDoubleMatrix((mwSize)record.samples, 1, mxREAL);
        columns[i] = mxGetPr(column);
        mxSetFieldByNumber(out[0], 0, (int)i, column);
    }
    for (size_t k = 0; k < record.samples; k++) {
        ctl_f64_input sample;
        ctl_f64_output given;
        read_sample(&record, k, &sample);
        check(ctl_f64_step(loop, size, &sample, &given), NULL);
        for (size_t i = 0; i < COUNT(output_fields); i++) {
            const void *at = (const char *)&given + output_fields[i].offset;
            columns[i][k] = output_fields[i].kind == REAL ? *(const double *)at : (double)*(const uint32_t *)at;
        }
    }
    if (outputs == 2) {
        out[1] = block;
    }
}
