/** Pieces of a cloth, each with a shade of its own, and seams, whose sides are drawn as one surface. */

/** Per particle: the number of its piece, of particles that triangles join; pieces in the order of their particles. */
export function piecesOf(particles, triangles) {
  const first = Int32Array.from({ length: particles }, (_, i) => i);
  const root = (i) => {
    while (first[i] !== i) i = first[i] = first[first[i]];
    return i;
  };
  for (let t = 0; t < triangles.length; t += 3) {
    const roots = [root(triangles[t]), root(triangles[t + 1]), root(triangles[t + 2])];
    const least = Math.min(...roots);
    for (const r of roots) first[r] = least;
  }
  const isCloth = new Uint8Array(particles);
  for (const corner of triangles) isCloth[corner] = 1;
  const numbers = new Map();
  return Int32Array.from({ length: particles }, (_, i) => {
    if (!isCloth[i]) return 0;
    if (!numbers.has(root(i))) numbers.set(root(i), numbers.size);
    return numbers.get(root(i));
  });
}

/** By which the colour of a piece is multiplied: 1 for the first, and far apart for neighbours in the list. */
export function shadeOf(piece) {
  const place = (0.5 + piece * 0.618033988749895) % 1;
  return 2 ** (1.2 * (place - 0.5));
}

/** Seams of a motion. Particles of a closed one are drawn at one place with one normal: the surface has no crack there. */
export class Seams {
  /** ends: pairs of particles. reach: m, as far apart may the ends of a closed seam be. */
  constructor(ends, reach) {
    this.ends = ends;
    this.square = reach * reach;
    this.group = new Map(); // particle -> list that it shares with others
  }

  /** Of closed seams, lists of particles that are at one place. */
  closed(places) {
    const groups = this.group;
    groups.clear();
    for (let s = 0; s < this.ends.length; s += 2) {
      const [a, b] = [this.ends[s], this.ends[s + 1]];
      const x = places[3 * a] - places[3 * b];
      const y = places[3 * a + 1] - places[3 * b + 1];
      const z = places[3 * a + 2] - places[3 * b + 2];
      if (x * x + y * y + z * z > this.square) continue;
      const one = groups.get(a) ?? [a];
      const other = groups.get(b) ?? [b];
      if (one === other) continue;
      const both = one.concat(other);
      for (const particle of both) groups.set(particle, both);
    }
    return new Set(groups.values());
  }
}

/** Gives all particles of each list the mean of their vectors. */
export function average(lists, vectors) {
  for (const list of lists) {
    const mean = [0, 0, 0];
    for (const particle of list) {
      for (let axis = 0; axis < 3; ++axis) mean[axis] += vectors[3 * particle + axis] / list.length;
    }
    for (const particle of list) vectors.set(mean, 3 * particle);
  }
}

/** m, the mean side of triangles. */
export function meanSide(triangles, places) {
  let sum = 0;
  for (let t = 0; t < triangles.length; t += 3) {
    const a = 3 * triangles[t];
    const b = 3 * triangles[t + 1];
    sum += Math.hypot(places[b] - places[a], places[b + 1] - places[a + 1], places[b + 2] - places[a + 2]);
  }
  return triangles.length > 0 ? sum / (triangles.length / 3) : 0;
}
