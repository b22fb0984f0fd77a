// Masks of the maps (docs/emap-format.md, "Masks").

const MASK_BLOCK = 8;
const BLOCK_EMPTY = 0, BLOCK_FULL = 1, BLOCK_MIXED = 2;
const MASK_MARGIN = 4;  // more than the farthest sample that a context looks at

class MaskDecoding {
  constructor() {
    this.block_is_mixed = new SimpleBits(81);
    this.block_is_full = new SimpleBits(81);
    this.sample = new MixedBits([1 << 10, 1 << 16, 81 * 64, 9 << 10], 9);
  }

  // One byte for each sample of the map: 1 where it is supported.
  decode(decoder, columns, rows) {
    const mask = new Uint8Array(columns * rows);
    if (mask.length === 0) return mask;
    const stride = columns + 2 * MASK_MARGIN;
    const known = new Uint8Array(stride * (rows + MASK_MARGIN));
    const place = (row, column) => (row + MASK_MARGIN) * stride + MASK_MARGIN + column;
    const blocks = this.decode_blocks(decoder, Math.ceil(columns / MASK_BLOCK), Math.ceil(rows / MASK_BLOCK));
    for (let row = 0; row < rows; ++row)
      for (let block = 0; block < blocks.columns; ++block)
        if (blocks.at(row >> 3, block) === BLOCK_FULL)
          known.fill(1, place(row, block * MASK_BLOCK), place(row, Math.min(columns, (block + 1) * MASK_BLOCK)));
    for (let row = 0; row < rows && !decoder.exhausted(); ++row)
      for (let block = 0; block < blocks.columns; ++block)
        if (blocks.at(row >> 3, block) === BLOCK_MIXED)
          this.decode_run(decoder, known, stride, place(row, 0), row, block, blocks,
            Math.min(columns, (block + 1) * MASK_BLOCK));
    for (let row = 0; row < rows; ++row)
      mask.set(known.subarray(place(row, 0), place(row, columns)), row * columns);
    return mask;
  }

  decode_blocks(decoder, columns, rows) {
    const stride = columns + 2;
    const states = new Uint8Array(stride * (rows + 2));  // with one empty block all around
    for (let row = 0; row < rows; ++row)
      for (let column = 0; column < columns; ++column) {
        const here = (row + 1) * stride + column + 1, above = here - stride;
        const context = ((states[here - 1] * 3 + states[above - 1]) * 3 + states[above]) * 3 + states[above + 1];
        if (this.block_is_mixed.decode(decoder, context)) states[here] = BLOCK_MIXED;
        else states[here] = this.block_is_full.decode(decoder, context) ? BLOCK_FULL : BLOCK_EMPTY;
      }
    return { columns, rows, at: (row, column) => states[(row + 1) * stride + column + 1] };
  }

  // The samples of one row of a mixed block. first: place of the row's first sample in `known`.
  decode_run(decoder, known, stride, first, row, block, blocks, end) {
    const right_block = blocks.at(row >> 3, block + 1);
    const below = outlook(blocks.at((row >> 3) + 1, block), MASK_BLOCK - 1 - (row & 7));
    const contexts = this.sample.contexts;
    for (let x = block * MASK_BLOCK; x < end; ++x) {
      const here = first + x, above = here - stride, second = above - stride, third = second - stride;
      const right = outlook(right_block, MASK_BLOCK - 1 - (x & 7));
      const left4 = bits_of(known, here - 4, 4);
      const above7 = bits_of(known, above - 3, 7), above5 = (above7 >> 1) & 31;
      const second5 = bits_of(known, second - 2, 5), second3 = (second5 >> 1) & 7;
      const small = (left4 & 3) | (((above5 >> 1) & 7) << 2) | (((second5 >> 2) & 1) << 5);
      const medium = (left4 & 3) | (above5 << 2) | (second3 << 7);
      const thirds = 3 * third_of(right) + third_of(below);
      contexts[0] = medium ^ (known[third] << 9);
      contexts[1] = left4 | (above7 << 4) | (second5 << 11);
      contexts[2] = (9 * right + below) * 64 + small;
      contexts[3] = thirds * 1024 + medium;
      known[here] = this.sample.decode(decoder, thirds);
    }
  }
}

function bits_of(samples, first, count) {
  let bits = 0;
  for (let i = first; i < first + count; ++i) bits = (bits << 1) | samples[i];
  return bits;
}

// How far off the next uniform block is, and what is in it.
function outlook(state, distance) {
  if (state === BLOCK_MIXED) return 0;
  const distance_class = distance < 2 ? distance : distance < 4 ? 2 : 3;
  return 1 + 2 * distance_class + (state === BLOCK_FULL ? 1 : 0);
}

function third_of(outlook_class) {
  return outlook_class === 0 ? 0 : 1 + ((outlook_class - 1) % 2);
}
