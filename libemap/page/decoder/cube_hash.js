// Whole numbers by the cubes of a regular grid in space that they touch; cubes are made as they are needed.

class CubeHash {
  // least: no coordinate is much less than these.
  constructor(side, least) {
    this.side = side;
    this.least = least;
    this.clear_table(1 << 12);
    this.items = new Int32Array(1 << 12);
    this.next = new Int32Array(1 << 12);
    this.count = 0;
  }

  clear_table(size) {
    this.keys = new Float64Array(size).fill(-1);
    this.first = new Int32Array(size);
    this.used = 0;
  }

  index(coordinate, axis) {
    return Math.floor((coordinate - this.least[axis]) / this.side) + 64;
  }

  // Calls visit(key) for the cubes that a box { low, high } touches, until it returns true; whether it did.
  some_cube({ low, high }, visit) {
    const end_x = this.index(high[0], 0), end_y = this.index(high[1], 1), end_z = this.index(high[2], 2);
    for (let z = this.index(low[2], 2); z <= end_z; ++z)
      for (let y = this.index(low[1], 1); y <= end_y; ++y)
        for (let x = this.index(low[0], 0); x <= end_x; ++x) if (visit((z * 131072 + y) * 131072 + x)) return true;
    return false;
  }

  slot_of(key) {
    let slot = (Math.imul(key % 4294967296, 0x9e3779b1) ^ Math.imul(Math.floor(key / 131072), 0x85ebca6b)) >>> 0;
    const mask = this.keys.length - 1;
    slot = (slot ^ (slot >>> 15)) & mask;
    while (this.keys[slot] !== -1 && this.keys[slot] !== key) slot = (slot + 1) & mask;
    return slot;
  }

  has(key) {
    return this.keys[this.slot_of(key)] === key;
  }

  add_to(key, item) {
    let slot = this.slot_of(key);
    if (this.keys[slot] === -1) {
      if (2 * ++this.used > this.keys.length) this.grow_table();
      slot = this.slot_of(key);
      this.keys[slot] = key;
      this.first[slot] = -1;
    }
    if (this.count === this.items.length) this.grow_items();
    this.items[this.count] = item;
    this.next[this.count] = this.first[slot];
    this.first[slot] = this.count++;
  }

  grow_table() {
    const { keys, first } = this;
    this.clear_table(2 * keys.length);
    keys.forEach((key, i) => {
      if (key === -1) return;
      const slot = this.slot_of(key);
      this.keys[slot] = key;
      this.first[slot] = first[i];
      ++this.used;
    });
    ++this.used;
  }

  grow_items() {
    for (const name of ["items", "next"]) {
      const grown = new Int32Array(2 * this.count);
      grown.set(this[name]);
      this[name] = grown;
    }
  }

  add(item, box) {
    this.some_cube(box, (key) => void this.add_to(key, item));
  }

  // The same, but only under cubes that are in `where`.
  add_where(where, item, box) {
    this.some_cube(box, (key) => void (where.has(key) && this.add_to(key, item)));
  }

  // Makes the cubes of the box hold something.
  mark(box) {
    this.some_cube(box, (key) => void (this.has(key) || this.add_to(key, 0)));
  }

  // Whether each cube that the box touches holds something.
  covers(box) {
    return !this.some_cube(box, (key) => !this.has(key));
  }

  // Calls visit(item) for the items under the cubes that the box touches, once for each such cube, until it returns true;
  // whether it did.
  some(box, visit) {
    return this.some_cube(box, (key) => {
      const slot = this.slot_of(key);
      if (this.keys[slot] !== key) return false;
      for (let entry = this.first[slot]; entry !== -1; entry = this.next[entry]) if (visit(this.items[entry])) return true;
      return false;
    });
  }
}
