// The arithmetic code (docs/emap-format.md, "Arithmetic code"). Whole numbers up to 2^53 are exact in JavaScript's
// doubles, so that products of 64 bits are written as divisions and Math.floor.
"use strict";

const SIGMOID = [
  3, 5, 8, 13, 22, 36, 60, 98, 162, 267, 439, 720, 1179, 1921, 3108, 4971, 7812, 11955, 17625, 24743, 32768, 40793,
  47911, 53581, 57724, 60565, 62428, 63615, 64357, 64816, 65097, 65269, 65374, 65438, 65476, 65500, 65514, 65523, 65528,
  65531, 65533,
];
const LARGEST_LOGIT = 2559;
const LEAST_PROBABILITY = 24;
const MOST_PROBABILITY = 65536 - LEAST_PROBABILITY;
const SIMPLE_LIMIT = 160;
const MIXED_LIMIT = 500;
const RECIPROCALS = Int32Array.from({ length: MIXED_LIMIT + 1 }, (_, k) => Math.floor(131072 / (2 * k + 3)));

function squash_uncached(logit) {
  const cell = (logit + 2560) >> 7, part = (logit + 2560) & 127;
  return (SIGMOID[cell] * (128 - part) + SIGMOID[cell + 1] * part + 64) >> 7;
}

// By logit + LARGEST_LOGIT.
const SQUASHED = Int32Array.from({ length: 2 * LARGEST_LOGIT + 1 }, (_, i) => squash_uncached(i - LARGEST_LOGIT));

// By the probability's upper 12 bits.
const STRETCHED = (() => {
  const table = new Int32Array(4096);
  let logit = -LARGEST_LOGIT;
  for (let v = 0; v < 4096; ++v) {
    while (logit < LARGEST_LOGIT && SQUASHED[logit + LARGEST_LOGIT] < 16 * v + 8) ++logit;
    table[v] = logit;
  }
  return table;
})();

// A stream that cannot be decoded: its message is for the visitor.
class StreamError extends Error {}

class RangeDecoder {
  constructor(bytes, first) {
    this.bytes = bytes;
    this.next = first;
    this.bytes_past_end = 0;
    this.range = 0xffffffff;
    this.code = 0;
    for (let i = 0; i < 4; ++i) this.code = this.code * 256 + this.next_byte();
  }

  next_byte() {
    if (this.next < this.bytes.length) return this.bytes[this.next++];
    ++this.bytes_past_end;
    return 0;
  }

  // More was read than a whole stream can ask for.
  exhausted() {
    return this.bytes_past_end > 4;
  }

  // probability: of a one, in 1/65536.
  bit(probability) {
    const bound = (this.range >>> 16) * probability + (((this.range & 0xffff) * probability) >>> 16);
    let bit = 0;
    if (this.code < bound) {
      bit = 1;
      this.range = bound;
    } else {
      this.code -= bound;
      this.range -= bound;
    }
    while (this.range < 0x1000000) {
      this.range *= 256;
      this.code = ((this.code << 8) | this.next_byte()) >>> 0;
    }
    return bit;
  }

  uniform(bit_count) {
    let value = 0;
    for (let i = 0; i < bit_count; ++i) value = value * 2 + this.bit(32768);
    return value;
  }
}

// Estimates of the probability of a one, 22 bits each, with counts.
class Estimates {
  constructor(count) {
    this.probability = new Int32Array(count).fill(1 << 21);
    this.seen = new Uint16Array(count);
  }

  learn(index, bit, limit) {
    const probability = this.probability[index], seen = this.seen[index];
    const error = (bit ? 4194303 : 0) - probability;
    this.probability[index] = probability + Math.floor((error * RECIPROCALS[seen]) / 65536);
    if (seen < limit) this.seen[index] = seen + 1;
  }
}

class SimpleBits {
  constructor(context_count) {
    this.estimates = new Estimates(context_count);
  }

  decode(decoder, context) {
    const probability = this.estimates.probability[context] >> 6;
    const bit = decoder.bit(Math.min(Math.max(probability, LEAST_PROBABILITY), MOST_PROBABILITY));
    this.estimates.learn(context, bit, SIMPLE_LIMIT);
    return bit;
  }
}

// The caller writes the bit's contexts to `contexts`, one for each of the tables.
class MixedBits {
  constructor(context_counts, weight_sets) {
    this.inputs = context_counts.length;
    this.contexts = new Int32Array(this.inputs);
    this.first_of_table = new Int32Array(this.inputs);
    for (let i = 1; i < this.inputs; ++i) this.first_of_table[i] = this.first_of_table[i - 1] + context_counts[i - 1];
    this.estimates = new Estimates(context_counts.reduce((sum, count) => sum + count));
    this.weights = new Int32Array(weight_sets * (this.inputs + 1)).fill(Math.floor(70000 / this.inputs));
    for (let set = 0; set < weight_sets; ++set) this.weights[set * (this.inputs + 1) + this.inputs] = 0;
    this.bits_of_set = new Int32Array(weight_sets);
    this.stretched = new Int32Array(this.inputs + 1);
    this.stretched[this.inputs] = 256;
  }

  decode(decoder, weight_set) {
    const { inputs, contexts, first_of_table, estimates, weights, stretched } = this;
    const first_weight = weight_set * (inputs + 1);
    let sum = weights[first_weight + inputs] * 256;
    for (let i = 0; i < inputs; ++i) {
      stretched[i] = STRETCHED[estimates.probability[first_of_table[i] + contexts[i]] >> 10];
      sum += weights[first_weight + i] * stretched[i];
    }
    const logit = Math.min(Math.max(Math.floor(sum / 65536), -LARGEST_LOGIT), LARGEST_LOGIT);
    const probability = Math.min(Math.max(SQUASHED[logit + LARGEST_LOGIT], LEAST_PROBABILITY), MOST_PROBABILITY);
    const bit = decoder.bit(probability);

    const rate = 16 + Math.floor(3000 / (this.bits_of_set[weight_set]++ + 40));
    const step = ((bit ? 65536 : 0) - probability) * rate;
    for (let i = 0; i <= inputs; ++i) {
      const moved = weights[first_weight + i] + Math.floor((step * stretched[i] + 524288) / 1048576);
      weights[first_weight + i] = Math.min(Math.max(moved, -4194304), 4194304);
    }
    for (let i = 0; i < inputs; ++i) estimates.learn(first_of_table[i] + contexts[i], bit, MIXED_LIMIT);
    return bit;
  }
}
