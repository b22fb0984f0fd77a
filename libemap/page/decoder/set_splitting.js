// Bit planes of coder 1 by set splitting (docs/emap-format.md, "Coder 1", "Bit planes").

// Models of the bits, kept from map to map.
class SetSplittingModels {
  constructor() {
    this.significance = new MixedBits([270, 400, 512], 10);
    this.refinement = new SimpleBits(12);
  }
}

// One map being decoded. A set is { row, column, rows, columns, band }, band being the number in `bands`.
class SetSplitting {
  constructor(models, decoder, columns, rows, bands, support, top_plane) {
    Object.assign(this, { models, decoder, columns, rows, bands, support, top_plane });
    this.halves = new Int32Array(support.length);  // values, in halves of the finest step
    this.found_at = new Uint8Array(support.length);  // 1 + the plane at which a coefficient was found; 0 for not yet
    this.found = [];                                 // coefficients in the order in which they were found
    this.waiting = [];                               // insignificant sets by depth
    bands.forEach((band, index) => {
      const set = this.shrunk({
        row: band.row, column: band.column, rows: band.rows, columns: band.columns, band: index,
      });
      if (set) this.wait(set, 0);
    });
  }

  decode(passes) {
    for (let pass = 0; pass < passes && !this.decoder.exhausted(); ++pass) {
      this.plane = this.top_plane - (pass >> 1);
      if (pass % 2 === 0) this.significance_pass();
      else this.refinement_pass();
    }
    return this.halves;
  }

  significance_pass() {
    this.found_before = this.found.length;
    for (let depth = this.waiting.length - 1; depth >= 0; --depth) {
      const sets = this.waiting[depth];
      this.waiting[depth] = [];
      for (const set of sets) {
        if (this.decoder.exhausted()) return;
        if (this.is_significant(set)) this.split_or_find(set, depth);
        else this.waiting[depth].push(set);
      }
    }
  }

  refinement_pass() {
    const { found, found_at, halves, plane } = this;
    for (let i = 0; i < this.found_before; ++i) {
      const index = found[i];
      const age = Math.min(found_at[index] - 1 - plane, 3);
      const context = (age - 1) * 4 + Math.min(this.found_neighbours(index), 3);
      const is_larger = this.models.refinement.decode(this.decoder, context) === 1;
      halves[index] += halves[index] > 0 === is_larger ? 1 << plane : -(1 << plane);
    }
  }

  wait(set, depth) {
    while (this.waiting.length <= depth) this.waiting.push([]);
    this.waiting[depth].push(set);
  }

  split_or_find(set, depth) {
    if (set.rows === 1 && set.columns === 1) return this.find(set);
    const [first, second] = halves_of(set).map((half) => this.shrunk(half));
    // One of the two is significant: where the first is not, the second must be.
    let must_be_second = !first;
    if (first) {
      if (!second || this.is_significant(first)) {
        this.split_or_find(first, depth + 1);
      } else {
        this.wait(first, depth + 1);
        must_be_second = true;
      }
    }
    if (!second) return;
    if (must_be_second || this.is_significant(second)) this.split_or_find(second, depth + 1);
    else this.wait(second, depth + 1);
  }

  find(set) {
    const index = set.row * this.columns + set.column;
    const is_negative = this.decoder.bit(32768) === 1;
    this.found_at[index] = this.plane + 1;
    this.found.push(index);
    this.halves[index] = is_negative ? -(3 << this.plane) : 3 << this.plane;
  }

  // The smallest rectangle with all the supported coefficients of the set; null where there are none.
  shrunk({ row, column, rows, columns, band }) {
    while (rows > 0 && !this.any_in_row(row, column, columns)) ++row, --rows;
    if (rows === 0) return null;
    while (!this.any_in_row(row + rows - 1, column, columns)) --rows;
    while (!this.any_in_column(column, row, rows)) ++column, --columns;
    while (!this.any_in_column(column + columns - 1, row, rows)) --columns;
    return { row, column, rows, columns, band };
  }

  any_in_row(row, column, count) {
    for (let i = row * this.columns + column, end = i + count; i < end; ++i) if (this.support[i]) return true;
    return false;
  }

  any_in_column(column, row, count) {
    for (let r = row; r < row + count; ++r) if (this.support[r * this.columns + column]) return true;
    return false;
  }

  is_significant(set) {
    const band = this.bands[set.band], contexts = this.models.significance.contexts;
    const size = Math.min(bit_length(set.rows * set.columns) - 1, 9);
    const around = this.surroundings(set, band);
    const since = Math.min(this.top_plane - this.plane, 7), is_single = set.rows === 1 && set.columns === 1 ? 1 : 0;
    contexts[0] = ((size * 3 + around.beside) * 3 + around.above_below) * 3 + around.corners;
    contexts[1] = (size * 10 + around.energy) * 4 + this.parent_height(set, band);
    contexts[2] = ((band.kind * 8 + Math.min(band.level, 7)) * 8 + since) * 2 + is_single;
    return this.models.significance.decode(this.decoder, size) === 1;
  }

  // 0 where the coefficient is not found, else how far above the plane it was, 1 to 3.
  height(index) {
    return this.found_at[index] === 0 ? 0 : Math.min(this.found_at[index] - this.plane, 3);
  }

  surroundings(set, band) {
    const bottom = set.row + set.rows, end = set.column + set.columns;
    const middle_row = set.row + (set.rows >> 1), middle_column = set.column + (set.columns >> 1);
    const height = (row, column) => {
      const is_inside = row >= band.row && row < band.row + band.rows && column >= band.column &&
        column < band.column + band.columns;
      return is_inside ? this.height(row * this.columns + column) : 0;
    };
    const left = height(middle_row, set.column - 1), right = height(middle_row, end);
    const above = height(set.row - 1, middle_column), below = height(bottom, middle_column);
    const corners = [
      height(set.row - 1, set.column - 1), height(set.row - 1, end), height(bottom, set.column - 1), height(bottom, end),
    ];
    const corner_heights = corners[0] + corners[1] + corners[2] + corners[3];
    return {
      beside: (left > 0) + (right > 0),
      above_below: (above > 0) + (below > 0),
      corners: Math.min(corners.filter((corner) => corner > 0).length, 2),
      energy: Math.min((2 * (left + right + above + below) + corner_heights + 1) >> 1, 9),
    };
  }

  parent_height(set, band) {
    const parent = parent_band(this.bands, set.band);
    if (!parent) return 0;
    const row = Math.min((set.row + (set.rows >> 1) - band.row) >> 1, parent.rows - 1);
    const column = Math.min((set.column + (set.columns >> 1) - band.column) >> 1, parent.columns - 1);
    return this.height((parent.row + row) * this.columns + parent.column + column);
  }

  found_neighbours(index) {
    const { columns, rows, found_at } = this;
    const row = Math.floor(index / columns), column = index % columns;
    return (column > 0 && found_at[index - 1] > 0) + (column + 1 < columns && found_at[index + 1] > 0) +
      (row > 0 && found_at[index - columns] > 0) + (row + 1 < rows && found_at[index + columns] > 0);
  }
}

function halves_of(set) {
  if (set.columns >= set.rows) {
    const columns = (set.columns + 1) >> 1;
    return [{ ...set, columns }, { ...set, column: set.column + columns, columns: set.columns - columns }];
  }
  const rows = (set.rows + 1) >> 1;
  return [{ ...set, rows }, { ...set, row: set.row + rows, rows: set.rows - rows }];
}
