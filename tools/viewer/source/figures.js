/** The figures of a sample, as the page words them. Values are those of the file. */

const percent = (x) => `${digits(100 * x, 3)} %`;
const unit = (name) => (x) => `${digits(x, 4)} ${name}`;
const plain = (x) => `${x}`;

export function digits(x, count) {
  if (x === 0) return '0';
  const size = Math.abs(x);
  if (size >= 1e5 || size < 1e-4) return x.toExponential(count - 1);
  return Number(x.toPrecision(count)).toString();
}

/** name: of the report (engine/weft/cloth.h), or of a figure that motion.cpp adds. */
export const FIGURES = [
  { name: 'status', label: 'Status', text: (x) => x.replaceAll('_', ' '), title: 'of the frame’s report' },
  { name: 'max_strain', label: 'Strain, largest', text: percent, title: 'of all constraints and triangles' },
  { name: 'rms_strain', label: 'Strain, r.m.s.', text: percent },
  { name: 'max_shear', label: 'Shear, largest', text: unit('rad'), hideZero: true },
  { name: 'energy', label: 'Energy', text: unit('J'), title: 'kinetic, potential and elastic' },
  { name: 'kinetic', label: 'kinetic', text: unit('J'), sub: true },
  { name: 'potential', label: 'potential', text: unit('J'), sub: true },
  { name: 'elastic', label: 'elastic', text: unit('J'), sub: true },
  { name: 'motion_error', label: 'Error of motion', text: unit('m/s'), title: 'an estimate' },
  { name: 'body_contacts', label: 'Contacts', text: plain, hideZero: true },
  { name: 'self_contacts', label: 'Self-contacts', text: plain, hideZero: true },
  { name: 'max_penetration', label: 'Penetration', text: (x) => `${digits(1e3 * x, 3)} mm`, hideZero: true },
  { name: 'intersecting', label: 'Crossing a body', text: plain, hideZero: true },
  { name: 'tangled', label: 'Crossing itself', text: plain, hideZero: true },
  { name: 'substeps', label: 'Substeps', text: plain },
  { name: 'iterations', label: 'Iterations', text: plain },
  { name: 'ms', label: 'Time to compute', text: unit('ms') },
];

/** Null at the start, which no step led to. */
export function figureAt(motion, name, sample) {
  return motion.figures[name]?.[sample] ?? null;
}

export function isShown(figure, motions) {
  const lists = motions.map((m) => m.figures[figure.name]).filter(Boolean);
  if (lists.length === 0) return false;
  return !figure.hideZero || lists.some((list) => list.some((x) => x !== null && x !== 0));
}
