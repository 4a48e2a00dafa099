/** Integers as tools/program/viewer/integers.h writes them. */

const BLOCK = 256;
const MOST_ONES = 24;

export class IntegerReader {
  constructor(bytes) {
    this.bytes = bytes;
    this.at = 0; // a byte
  }

  /** The next list, of a number of integers that the caller knows. */
  read(count, into = new Int32Array(count)) {
    for (let first = 0; first < count; first += BLOCK) {
      this.readBlock(into, first, Math.min(count, first + BLOCK));
    }
    return into;
  }

  readDifferences(count) {
    const list = this.read(count);
    for (let i = 1; i < count; ++i) list[i] += list[i - 1];
    return list;
  }

  readBlock(into, first, last) {
    const lowBits = this.bytes[this.at++];
    const mask = (1 << lowBits) - 1;
    let bit = 8 * this.at;
    for (let i = first; i < last; ++i) {
      const notOnes = ~this.peek(bit);
      const ones = Math.min(notOnes === 0 ? 32 : 31 - Math.clz32(notOnes & -notOnes), MOST_ONES);
      let value;
      if (ones === MOST_ONES) {
        value = this.peek(bit + ones);
        bit += ones + 32;
      } else {
        value = (ones << lowBits) | (this.peek(bit + ones + 1) & mask);
        bit += ones + 1 + lowBits;
      }
      into[i] = (value >>> 1) ^ -(value & 1);
    }
    this.at = (bit + 7) >>> 3;
  }

  /** 32 bits; those behind the end are 0. */
  peek(bit) {
    const b = this.bytes;
    const i = bit >>> 3;
    const shift = bit & 7;
    const low = b[i] | (b[i + 1] << 8) | (b[i + 2] << 16) | (b[i + 3] << 24);
    return shift === 0 ? low : (low >>> shift) | (b[i + 4] << (32 - shift));
  }
}
