/* The case study and the skid sheet hand-written in C: draws, one fused loop over a chunk, accepted trials kept.
 *
 * Built by hand_c.py without -ffast-math. The loops are marked `omp simd`, and sin and cos are declared as having SIMD
 * versions where the C library is glibc for x86-64, whose libmvec has them (4 ulp at most); elsewhere they are the plain
 * ones. The equations are those of hand_written.py, term by term.
 */
#include "hand_draws.h"

#define G 32.174
#define DEGREE (3.14159265358979323846 / 180)
#define MPH (3600.0 / 5280.0)

/* `in`: 17 rows of `stride` doubles, `n` of each used. `work`: 6 rows of `n`. `out`: 4 rows of `capacity`, filled from
 * `kept` on. Returns how many trials of these are accepted. */
static long case_chunk(const double *restrict in, long stride, long n, double *restrict work, double *restrict out,
                       long capacity, long kept) {
    const double *w1 = in, *i1 = in + stride, *al1 = in + 2 * stride, *be1 = in + 3 * stride, *s1 = in + 4 * stride,
                 *f1 = in + 5 * stride, *w2 = in + 6 * stride, *i2 = in + 7 * stride, *al2 = in + 8 * stride,
                 *be2 = in + 9 * stride, *s2 = in + 10 * stride, *f2 = in + 11 * stride, *x1 = in + 12 * stride,
                 *y1 = in + 13 * stride, *x2 = in + 14 * stride, *y2 = in + 15 * stride, *ga = in + 16 * stride;
    double *o1 = work, *o2 = work + n, *o3 = work + 2 * n, *o4 = work + 3 * n, *en = work + 4 * n,
           *et = work + 5 * n;
#pragma omp simd
    for (long j = 0; j < n; j++) {
        double m1 = w1[j] / G, m2 = w2[j] / G;
        double v1f = sqrt(2 * G * f1[j] * s1[j]), v2f = sqrt(2 * G * f2[j] * s2[j]);
        double delta = al1[j] - al2[j], sin_delta = sin(delta * DEGREE);
        double p1 = m1 * v1f * sin((be1[j] - al1[j]) * DEGREE), p2 = m2 * v2f * sin((be2[j] - al2[j]) * DEGREE);
        double v1i = (v1f * sin((be1[j] - al2[j]) * DEGREE) + p2 / m1) / sin_delta;
        double v2i = -(v2f * sin((be2[j] - al1[j]) * DEGREE) + p1 / m2) / sin_delta;
        double half = delta * (DEGREE / 2), mean = (al1[j] + al2[j]) * (DEGREE / 2);
        double along = -(p1 + p2) / (2 * sin(half)), across = (p1 - p2) / (2 * cos(half));
        double sin_m = sin(mean), cos_m = cos(mean);
        double px = along * cos_m - across * sin_m, py = along * sin_m + across * cos_m;
        double sa1 = sin(al1[j] * DEGREE), ca1 = cos(al1[j] * DEGREE);
        double sa2 = sin(al2[j] * DEGREE), ca2 = cos(al2[j] * DEGREE);
        double a1 = -(x1[j] * ca1 + y1[j] * sa1) / 12, b1 = -(x1[j] * sa1 - y1[j] * ca1) / 12;
        double a2 = -(x2[j] * ca2 + y2[j] * sa2) / 12, b2 = -(x2[j] * sa2 - y2[j] * ca2) / 12;
        double om1 = (px * b1 - py * a1) / i1[j], om2 = (py * a2 - px * b2) / i2[j];
        double sep_x = v1f * cos(be1[j] * DEGREE) + b1 * om1 - v2f * cos(be2[j] * DEGREE) - b2 * om2;
        double sep_y = v2f * sin(be2[j] * DEGREE) - a2 * om2 - v1f * sin(be1[j] * DEGREE) + a1 * om1;
        double close_x = v2i * ca2 - v1i * ca1, close_y = v1i * sa1 - v2i * sa2;
        double sg = sin(ga[j] * DEGREE), cg = cos(ga[j] * DEGREE);
        double e_n = (sep_x * sg + sep_y * cg) / (close_x * sg + close_y * cg);
        double e_t = (sep_y * sg - sep_x * cg) / (close_y * sg - close_x * cg);
        double total = sqrt(along * along + across * across);
        o1[j] = total / m1 * MPH, o2[j] = total / m2 * MPH, o3[j] = v1i * MPH, o4[j] = v2i * MPH;
        en[j] = e_n, et[j] = e_t;
    }
    long found = 0;
    for (long j = 0; j < n; j++) {
        /* Asked in a loop of its own: gcc 12 does several trials at once only where nothing branches. */
        int ok = (en[j] >= 0) & (en[j] < 1) & (et[j] >= 0) & (et[j] <= 0.25) & (o4[j] > 0);
        if (ok && kept + found < capacity) {
            for (int k = 0; k < 4; k++) out[k * capacity + kept + found] = work[k * n + j];
            found++;
        }
    }
    return found;
}

static void skid_chunk(const double *restrict f, const double *restrict d, const double *restrict grade, long n,
                       double *restrict out) {
#pragma omp simd
    for (long j = 0; j < n; j++) {
        double t = grade[j] / 100;
        out[j] = sqrt(2 * G * d[j] * (f[j] + t) / sqrt(1 + t * t)) * MPH;
    }
}

/* Forecasts of accepted trials among `n` given ones, 17 rows of `n` -> 4 rows of `n`; how many. */
long case_evaluate(const double *in, long n, double *out) {
    double *work = malloc(6 * n * sizeof(double));
    long found = work ? case_chunk(in, n, n, work, out, n, 0) : -1;
    free(work);
    return found;
}

/* Forecasts of the accepted trials, 4 rows of `capacity`; how many, or -1 without memory. `chunk`: a multiple of 8. */
long case_simulate(long trials, uint64_t seed, long chunk, const double *low, const double *high, double *out,
                   long capacity) {
    Streams streams = seeded(seed);
    double *in = malloc(23 * chunk * sizeof(double));
    if (!in) return -1;
    long kept = 0;
    for (long start = 0; start < trials; start += chunk) {
        long n = trials - start < chunk ? trials - start : chunk;
        for (int k = 0; k < 17; k++) draw(&streams, low[k], high[k], chunk, in + k * chunk);
        kept += case_chunk(in, chunk, n, in + 17 * chunk, out, capacity, kept);
    }
    free(in);
    return kept;
}

/* Friction, distance, grade: 3 rows of `n` -> speeds. */
long skid_evaluate(const double *in, long n, double *out) {
    skid_chunk(in, in + n, in + 2 * n, n, out);
    return n;
}

long skid_simulate(long trials, uint64_t seed, long chunk, const double *low, const double *high, double *out,
                   long capacity) {
    Streams streams = seeded(seed);
    double *in = malloc(3 * chunk * sizeof(double));
    if (!in || capacity < trials) return -1;
    for (long start = 0; start < trials; start += chunk) {
        long n = trials - start < chunk ? trials - start : chunk;
        for (int k = 0; k < 3; k++) draw(&streams, low[k], high[k], chunk, in + k * chunk);
        skid_chunk(in, in + chunk, in + 2 * chunk, n, out + start);
    }
    free(in);
    return trials;
}
