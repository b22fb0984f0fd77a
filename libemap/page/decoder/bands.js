// What both coders share (docs/emap-format.md, "Bands").

// In the order in which they are coded: { row, column, rows, columns, level, kind }.
function wavelet_bands(columns, rows, levels) {
  const bands = [];
  for (let level = 1; level <= levels; ++level) {
    const low_columns = Math.ceil(columns / 2), low_rows = Math.ceil(rows / 2);
    const high_columns = columns - low_columns, high_rows = rows - low_rows;
    bands.push({ row: low_rows, column: low_columns, rows: high_rows, columns: high_columns, level, kind: 3 });
    bands.push({ row: low_rows, column: 0, rows: high_rows, columns: low_columns, level, kind: 2 });
    bands.push({ row: 0, column: low_columns, rows: low_rows, columns: high_columns, level, kind: 1 });
    columns = low_columns;
    rows = low_rows;
  }
  bands.push({ row: 0, column: 0, rows, columns, level: levels, kind: 0 });
  return bands.reverse().filter((band) => band.rows > 0 && band.columns > 0);
}

// The band's parent, three places before; undefined for none.
function parent_band(bands, index) {
  if (bands[index].kind === 0 || index < 4) return undefined;
  return bands[index - 3].kind === bands[index].kind ? bands[index - 3] : undefined;
}

// Columns and rows of the low-pass rectangle before each level, the finest first.
function sizes_of_levels(columns, rows, levels) {
  const sizes = [];
  for (let level = 0; level < levels; ++level) {
    sizes.push({ columns, rows });
    columns = Math.ceil(columns / 2);
    rows = Math.ceil(rows / 2);
  }
  return sizes;
}
