/** A motion as tools/program/viewer/motion.h writes it: decoded, with a list of floats for each sample. */

import { IntegerReader } from './bits.js';

const SEAL = 28; // bytes: mark, version, size, checksum
const MARK = 'weft mov';

export function bytesOfBase64(text) {
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(text);
  const letters = atob(text);
  const bytes = new Uint8Array(letters.length);
  for (let i = 0; i < letters.length; ++i) bytes[i] = letters.charCodeAt(i);
  return bytes;
}

/** Gives the browser time to draw, about every 30 ms. */
class Pauses {
  constructor() {
    this.last = performance.now();
  }
  async take() {
    if (performance.now() - this.last < 30) return;
    await new Promise((resolve) => setTimeout(resolve));
    this.last = performance.now();
  }
}

class Sections {
  constructor(table, bytes) {
    this.table = table;
    this.bytes = bytes;
  }
  has(name) {
    return name in this.table;
  }
  count(name) {
    return this.table[name].count;
  }
  reader(name) {
    return new IntegerReader(this.bytes.subarray(this.table[name].at));
  }
  numbers(name) {
    return this.reader(name).readDifferences(this.count(name));
  }
  floats(name) {
    const { at, count } = this.table[name];
    return new Float32Array(this.bytes.slice(at, at + 4 * count).buffer);
  }
}

/** Samples of points, as moving_points.h says. */
async function movingPoints(reader, count, samples, origin, quantum, pauses, onSample) {
  const last = [0, 1, 2].map(() => new Int32Array(count));
  const before = [0, 1, 2].map(() => new Int32Array(count));
  const rest = new Int32Array(count);
  const all = [];
  for (let sample = 0; sample < samples; ++sample) {
    const places = new Float32Array(3 * count);
    for (let axis = 0; axis < 3; ++axis) {
      const x = last[axis];
      const y = before[axis];
      if (sample === 0) {
        reader.read(count, x);
        for (let i = 1; i < count; ++i) x[i] += x[i - 1];
      } else {
        reader.read(count, rest);
        for (let i = 0; i < count; ++i) {
          const next = rest[i] + (sample === 1 ? x[i] : 2 * x[i] - y[i]);
          y[i] = x[i];
          x[i] = next;
        }
      }
      for (let i = 0; i < count; ++i) places[3 * i + axis] = origin[axis] + quantum * x[i];
    }
    all.push(places);
    if (onSample) onSample(sample);
    await pauses.take();
  }
  return all;
}

async function stretches(reader, count, samples, quantum, pauses) {
  const sum = new Int32Array(count);
  const change = new Int32Array(count);
  const all = [];
  for (let sample = 0; sample < samples; ++sample) {
    reader.read(count, change);
    const stretch = new Float32Array(count);
    for (let i = 0; i < count; ++i) stretch[i] = quantum * (sum[i] += change[i]);
    all.push(stretch);
    await pauses.take();
  }
  return all;
}

function contacts(reader, samples) {
  const all = [];
  for (let sample = 0; sample < samples; ++sample) {
    const [count] = reader.read(1);
    all.push(reader.readDifferences(count));
  }
  return all;
}

async function bodyOf(shape, index, header, sections, pauses) {
  const name = `body ${index}`;
  const body = { ...shape, poses: sections.floats(`${name} poses`) };
  if (shape.shape === 'mesh') {
    body.triangles = sections.numbers(`${name} triangles`);
    body.vertices = sections.floats(`${name} vertices`);
    if (sections.has(`${name} motion`)) {
      body.samples = await movingPoints(
        sections.reader(`${name} motion`), body.vertices.length / 3, header.samples, [0, 0, 0],
        header.quantum, pauses);
    }
  }
  return body;
}

/** onProgress gets a share, 0 to 1. */
export async function readMotion(file, onProgress = () => {}) {
  if (String.fromCharCode(...file.subarray(0, 8)) !== MARK) throw new Error('no motion of weft');
  const content = file.subarray(SEAL);
  const textSize = new DataView(content.buffer, content.byteOffset).getUint32(0, true);
  const header = JSON.parse(new TextDecoder().decode(content.subarray(4, 4 + textSize)));
  const sections = new Sections(header.sections, content.subarray(4 + textSize));
  const { particles, samples } = header;
  const pauses = new Pauses();
  const places = await movingPoints(
    sections.reader('places'), particles, samples, header.origin, header.quantum, pauses,
    (sample) => onProgress((0.8 * (sample + 1)) / samples));
  const bodies = [];
  for (const [index, shape] of header.bodies.entries()) {
    bodies.push(await bodyOf(shape, index, header, sections, pauses));
  }
  const motion = {
    ...header,
    places,
    stretch: await stretches(
      sections.reader('stretch'), particles, samples, header.stretch_quantum, pauses),
    contacts: contacts(sections.reader('contacts'), samples),
    triangles: sections.numbers('triangles'),
    lines: sections.numbers('lines'),
    pins: sections.numbers('pins'),
    seams: sections.numbers('seams'),
    links: {
      ends: sections.numbers('link ends'),
      colours: sections.numbers('link colours'),
      yarns: sections.numbers('link yarns'),
      families: sections.numbers('link families'),
    },
    fabric: {
      triangles: sections.numbers('fabric triangles'),
      colours: sections.numbers('fabric colours'),
    },
    bodies,
    duration: (samples - 1) * header.dt,
  };
  onProgress(1);
  return motion;
}
