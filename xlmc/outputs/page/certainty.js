"use strict";
// Trials of one forecast, counted between two ends.

/**
 * From `values` (ascending, all different), `counts` (trials at each; null: 1) and `gaps` (trials between each and the
 * next; null: 0). A count is exact at every value, and everywhere where there are no gaps; `doubt` is by how many
 * trials it may be off at most.
 */
class Trials {
  constructor({ trials, values, counts, gaps }) {
    this.trials = trials;
    this.values = values;
    this.below = new Float64Array(values.length);
    this.upto = new Float64Array(values.length);
    let seen = 0;
    for (let i = 0; i < values.length; i++) {
      this.below[i] = seen;
      seen += counts ? counts[i] : 1;
      this.upto[i] = seen;
      seen += gaps && i < gaps.length ? gaps[i] : 0;
    }
  }

  /** Trials in [low, high]. */
  between(low, high) {
    const before = this.reached(low, false);
    const until = this.reached(high, true);
    return { count: Math.max(0, until.count - before.count), doubt: before.doubt + until.doubt };
  }

  /** Trials below an end, with those at it or without. */
  reached(end, including) {
    const i = lastUpTo(this.values, end);
    if (i < 0) return { count: 0, doubt: 0 };
    if (this.values[i] === end) return { count: including ? this.upto[i] : this.below[i], doubt: 0 };
    if (i === this.values.length - 1) return { count: this.trials, doubt: 0 };
    const gap = this.below[i + 1] - this.upto[i];
    const part = (end - this.values[i]) / (this.values[i + 1] - this.values[i]);
    return { count: this.upto[i] + gap * part, doubt: gap * Math.max(part, 1 - part) };
  }

  /** The value that a share of the trials do not exceed, as Excel's PERCENTILE.INC. */
  quantile(share) {
    const rank = share * (this.trials - 1);
    const low = Math.floor(rank);
    const left = this.ranked(low);
    const right = this.ranked(Math.min(low + 1, this.trials - 1));
    return left + (right - left) * (rank - low);
  }

  /** The trial of a rank, counted from 0; in a gap by a straight line. */
  ranked(rank) {
    const i = lastUpTo(this.below, rank);
    if (rank < this.upto[i] || i === this.values.length - 1) return this.values[i];
    const first = this.upto[i] - 1;
    const part = (rank - first) / (this.below[i + 1] - first);
    return this.values[i] + (this.values[i + 1] - this.values[i]) * part;
  }
}

/** The last index in an ascending list whose number is no larger; -1 where all are. */
function lastUpTo(list, number) {
  let low = 0;
  let high = list.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (list[middle] <= number) low = middle + 1;
    else high = middle;
  }
  return low - 1;
}

/**
 * A share of independent trials with its standard error and 95 % interval: `proportion` in xlmc.montecarlo.statistics. Wilson's
 * ends, no nearer than `lowered` puts them where a share rests on a few trials.
 */
function shareOf(count, trials, z) {
  const p = count / trials;
  const pull = (z * z) / trials;
  const least = z / (2 * (trials + z * z)); // a share of 0 is not known without error
  const centre = (p + pull / 2) / (1 + pull);
  const half = Math.sqrt(pull * (p * (1 - p) + pull / 4)) / (1 + pull);
  return {
    value: p,
    error: Math.max(Math.sqrt((p * (1 - p)) / trials), least),
    low: p === 0 ? 0 : Math.min(centre - half, lowered(count, trials)),
    high: p === 1 ? 1 : Math.max(centre + half, 1 - lowered(trials - count, trials)),
  };
}

const FEW = 10; // with more hits Wilson's end is the farther one for any number of trials
const TAILS = 0.05;

/** The share with which so many hits or more have the probability of both tails (Brown, Cai & DasGupta 2001). */
function lowered(count, trials) {
  const hits = Math.round(count);
  if (hits < 1 || hits > FEW) return 1;
  let low = 0;
  let high = 1;
  for (let step = 0; step < 100; step++) {
    const middle = (low + high) / 2;
    if (orMore(hits, trials, middle) < TAILS) low = middle;
    else high = middle;
  }
  return low;
}

/** The probability of so many hits or more in so many trials. */
function orMore(hits, trials, share) {
  let exactly = Math.exp(trials * Math.log1p(-share)); // no hit
  let fewer = 0;
  for (let k = 0; k < hits; k++) {
    fewer += exactly;
    exactly *= ((trials - k) / (k + 1)) * (share / (1 - share));
  }
  return 1 - fewer;
}
