/* The time-stepped books of books.py hand-written in C, for any number of steps.
 *
 * A group of GROUP trials goes through all steps while its numbers stay in the first cache; each loop over its trials is
 * marked `omp simd`. hand_c.py builds this file with -fno-signed-zeros and -ffinite-math-only too, without which gcc 12
 * makes no vector code of the minima and maxima; no number here is infinite or none. The equations are those of
 * hand_written_march.py, term by term.
 */
#include "hand_draws.h"

#define G 32.174
#define GROUP 32
#define AVERAGED 5
#define INPUTS 12
/* Searched by halves: as many places as a power of two, of which those after the road's end are never reached. */
#define PLACES 64

typedef struct { double begins[PLACES], factor[PLACES], cosine[PLACES], sine[PLACES]; long rows; double step; } Road;

static Road road_of(const double *columns, long rows, double step) {
    Road road = {.rows = rows, .step = step};
    for (long i = 0; i < PLACES; i++) {
        road.begins[i] = i < rows ? columns[i] : 1e300;
        road.factor[i] = i < rows ? columns[rows + i] : 0;
        road.cosine[i] = i < rows ? columns[2 * rows + i] : 0;
        road.sine[i] = i < rows ? columns[3 * rows + i] : 0;
    }
    return road;
}

/* The forecast of GROUP trials: `in` has INPUTS rows of `stride` doubles. `guess`: the road's rows are `step` apart. */
static inline __attribute__((always_inline)) void march_group(const double *restrict in, long stride, long steps,
                                                              double dt, const Road *restrict road, int guess,
                                                              double *restrict out) {
    const double *v0 = in, *friction = in + stride, *reaction = in + 2 * stride, *rise = in + 3 * stride,
                 *fade_speed = in + 4 * stride, *fade = in + 5 * stride, *steer = in + 6 * stride,
                 *decay = in + 7 * stride, *wheelbase = in + 8 * stride, *understeer = in + 9 * stride,
                 *weight = in + 10 * stride, *heading_0 = in + 11 * stride;
    double speed[GROUP], square[GROUP], distance[GROUP], heading[GROUP], x[GROUP], y[GROUP], energy[GROUP], work[GROUP],
        turn[GROUP], slower[GROUP], demands[AVERAGED][GROUP];
    double wanted[GROUP], drag[GROUP], moved[GROUP], yaw[GROUP];
    long row[GROUP];
#pragma omp simd
    for (int j = 0; j < GROUP; j++) {
        speed[j] = v0[j], square[j] = v0[j] * v0[j], heading[j] = heading_0[j];
        distance[j] = x[j] = y[j] = energy[j] = work[j] = 0;
        turn[j] = steer[j] / wheelbase[j], slower[j] = -1 / decay[j];
        for (int k = 0; k < AVERAGED; k++) demands[k][j] = 0;
    }
    double time = 0, last = (double)(road->rows - 1);
    for (long step = 0; step < steps; step++) {
        time += dt;
        double *demand = demands[step % AVERAGED];
        double share = 1.0 / (step + 1 < AVERAGED ? step + 1 : AVERAGED);
        if (guess) {
#pragma omp simd
            for (int j = 0; j < GROUP; j++) {
                double place = distance[j] / road->step;
                row[j] = (long)(place < last ? place : last);
            }
        } else {
#pragma omp simd
            for (int j = 0; j < GROUP; j++) row[j] = 0;
            for (long half = PLACES / 2; half; half /= 2) {
#pragma omp simd
                for (int j = 0; j < GROUP; j++) row[j] += road->begins[row[j] + half] <= distance[j] ? half : 0;
            }
        }
#pragma omp simd
        for (int j = 0; j < GROUP; j++) {
            double above = speed[j] - fade_speed[j], braking = (time - reaction[j]) / rise[j];
            above = above > 0 ? above : 0;
            braking = braking > 0 ? braking : 0;
            braking = braking < 1 ? braking : 1;
            double hold = friction[j] * road->factor[row[j]] * (1 - fade[j] * above);
            double d = braking * hold * road->cosine[row[j]] + road->sine[row[j]];
            double now = speed[j] - G * dt * d;
            now = now > 0.1 ? now : 0.1;
            double step_moved = (now + speed[j]) * (dt / 2), now_square = now * now;
            double lost = (square[j] - now_square) * weight[j] * (0.5 / G);
            wanted[j] = hold, drag[j] = d, moved[j] = step_moved;
            distance[j] += step_moved, energy[j] += lost, work[j] += lost;
            speed[j] = now, square[j] = now_square;
        }
#pragma omp simd
        for (int j = 0; j < GROUP; j++) yaw[j] = exp(slower[j] * time);
#pragma omp simd
        for (int j = 0; j < GROUP; j++) {
            yaw[j] *= turn[j] * speed[j] / (1 + understeer[j] * square[j]);
            double lateral = yaw[j] * speed[j] * (1 / G);
            demand[j] = sqrt(lateral * lateral + drag[j] * drag[j]);
            heading[j] += yaw[j] * dt;
            double sliding = (demands[0][j] + demands[1][j] + demands[2][j] + demands[3][j] + demands[4][j]) * share;
            sliding -= wanted[j];
            sliding = sliding > 0 ? sliding : 0;
            work[j] += sliding * weight[j] * moved[j];
        }
#pragma omp simd
        for (int j = 0; j < GROUP; j++) x[j] += speed[j] * cos(heading[j]);
#pragma omp simd
        for (int j = 0; j < GROUP; j++) y[j] += speed[j] * sin(heading[j]);
    }
#pragma omp simd
    for (int j = 0; j < GROUP; j++)
        out[j] = (energy[j] + work[j]) / weight[j] + sqrt(x[j] * x[j] + y[j] * y[j]) * dt;
}

static void march_chunk(const double *in, long stride, long steps, double dt, const Road *road, int guess,
                        double *out) {
    for (long j = 0; j < stride; j += GROUP) {
        if (guess) march_group(in + j, stride, steps, dt, road, 1, out + j);
        else march_group(in + j, stride, steps, dt, road, 0, out + j);
    }
}

/* Forecasts of `n` given trials, a multiple of GROUP: 12 rows of `n` -> one row. `columns`: 4 rows of `rows`. */
void march_evaluate(const double *in, long n, long steps, double dt, const double *columns, long rows, double step,
                    int guess, double *out) {
    Road road = road_of(columns, rows, step);
    march_chunk(in, n, steps, dt, &road, guess, out);
}

/* Forecasts of `trials` drawn trials, room for a chunk more; 0, or -1 without memory. `chunk`: a multiple of GROUP. */
long march_simulate(long trials, uint64_t seed, long chunk, const double *low, const double *high, long steps,
                    double dt, const double *columns, long rows, double step, int guess, double *out) {
    Road road = road_of(columns, rows, step);
    Streams streams = seeded(seed);
    double *in = malloc(INPUTS * chunk * sizeof(double));
    if (!in) return -1;
    for (long start = 0; start < trials; start += chunk) {
        for (int k = 0; k < INPUTS; k++) draw(&streams, low[k], high[k], chunk, in + k * chunk);
        march_chunk(in, chunk, steps, dt, &road, guess, out + start);
    }
    free(in);
    return 0;
}
