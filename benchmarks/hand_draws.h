/* What the programs in C share: sines, cosines and exponentials of several numbers at once, and draws. */
#ifndef HAND_DRAWS_H
#define HAND_DRAWS_H

#include <math.h>
#include <stdint.h>
#include <stdlib.h>

#if defined(__x86_64__) && defined(__GLIBC__)
#pragma omp declare simd notinbranch
extern double sin(double);
#pragma omp declare simd notinbranch
extern double cos(double);
#pragma omp declare simd notinbranch
extern double exp(double);
#endif

#define LANES 8

/* Eight interleaved SFC64 generators, stepped together so that a compiler can keep them in vector registers. */
typedef struct { uint64_t a[LANES], b[LANES], c[LANES], w[LANES]; } Streams;

static void step(Streams *s, uint64_t *out) {
#pragma omp simd
    for (int i = 0; i < LANES; i++) {
        uint64_t t = s->a[i] + s->b[i] + s->w[i]++;
        s->a[i] = s->b[i] ^ (s->b[i] >> 11);
        s->b[i] = s->c[i] + (s->c[i] << 3);
        s->c[i] = ((s->c[i] << 24) | (s->c[i] >> 40)) + t;
        out[i] = t;
    }
}

static uint64_t splitmix(uint64_t *state) {
    uint64_t z = (*state += 0x9E3779B97F4A7C15u);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return z ^ (z >> 31);
}

static Streams seeded(uint64_t seed) {
    Streams s;
    uint64_t unused[LANES];
    for (int i = 0; i < LANES; i++) {
        s.a[i] = splitmix(&seed), s.b[i] = splitmix(&seed), s.c[i] = splitmix(&seed), s.w[i] = 1;
    }
    for (int i = 0; i < 16; i++) step(&s, unused);
    return s;
}

/* `n` draws, a multiple of LANES, uniform in [low, high). */
static void draw(Streams *s, double low, double high, long n, double *restrict out) {
    double scale = (high - low) * 0x1p-53;
    for (long j = 0; j < n; j += LANES) {
        uint64_t bits[LANES];
        step(s, bits);
#pragma omp simd
        for (int i = 0; i < LANES; i++) out[j + i] = low + (double)(bits[i] >> 11) * scale;
    }
}

#endif
