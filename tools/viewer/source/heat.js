/** The colours of stretch: blue is shorter, red is longer, white is as at rest. */

const STOPS = [
  [-1, [22, 66, 138]],
  [-0.5, [92, 152, 204]],
  [-0.1, [208, 226, 238]],
  [0, [246, 245, 240]],
  [0.1, [250, 225, 205]],
  [0.5, [232, 124, 80]],
  [1, [150, 20, 44]],
];

/** share: of the range, -1 to 1. Bytes of red, green and blue. */
export function colourOf(share) {
  const x = Math.min(1, Math.max(-1, share));
  const next = Math.max(1, STOPS.findIndex(([at]) => at >= x));
  const [from, low] = STOPS[next - 1];
  const [to, high] = STOPS[next];
  const part = (x - from) / (to - from);
  return low.map((c, i) => Math.round(c + part * (high[i] - c)));
}

/** Bytes of a texture of one row, from -1 to 1. */
export function heatBytes(width = 256) {
  const bytes = new Uint8Array(4 * width);
  for (let i = 0; i < width; ++i) bytes.set([...colourOf((2 * i) / (width - 1) - 1), 255], 4 * i);
  return bytes;
}

export function heatGradient() {
  const stops = STOPS.map(([at, [r, g, b]]) => `rgb(${r} ${g} ${b}) ${50 * (at + 1)}%`);
  return `linear-gradient(to right, ${stops.join(', ')})`;
}

/** A range that all but a hundredth of the samples of all motions keep to, rounded up to 1, 2 or 5. */
export function niceRange(motions) {
  const sizes = [];
  for (const motion of motions) {
    const total = motion.samples * motion.particles;
    const step = Math.max(1, Math.floor(total / 50000));
    for (let i = 0; i < total; i += step) {
      sizes.push(Math.abs(motion.stretch[Math.floor(i / motion.particles)][i % motion.particles]));
    }
  }
  sizes.sort((a, b) => a - b);
  return roundUp(sizes[Math.floor(0.99 * (sizes.length - 1))] || 1e-4);
}

function roundUp(x) {
  const power = 10 ** Math.floor(Math.log10(x));
  return [1, 2, 5, 10].map((d) => d * power).find((d) => d >= 0.999 * x);
}
