/** Curves over time, one row for each figure, with a playhead through all of them. */

import { digits } from './figures.js';

const ROWS = [
  {
    title: 'Strain', unit: '%', scale: 100, fromZero: true,
    curves: [{ name: 'max_strain', label: 'largest' }, { name: 'rms_strain', label: 'r.m.s.', faint: true }],
    limit: (motion) => motion.settings.tolerance,
  },
  {
    title: 'Energy', unit: 'J', scale: 1,
    curves: [
      { name: 'energy', label: 'total' },
      { name: 'kinetic', label: 'kinetic', faint: true },
      { name: 'elastic', label: 'elastic', faint: true, dotted: true },
    ],
  },
  {
    title: 'Error of motion', unit: 'm/s', scale: 1, fromZero: true,
    curves: [{ name: 'motion_error', label: 'estimate' }],
  },
];

const MARGIN = { left: 12, right: 12, top: 17, bottom: 5 };

function rangeOf(row, motions) {
  let least = row.fromZero ? 0 : Infinity;
  let most = -Infinity;
  for (const motion of motions) {
    for (const { name } of row.curves) {
      for (const value of motion.figures[name] ?? []) {
        if (value === null) continue;
        least = Math.min(least, value);
        most = Math.max(most, value);
      }
    }
    if (row.limit && row.limit(motion) < 1.6 * most) most = Math.max(most, 1.05 * row.limit(motion));
  }
  if (!(most > -Infinity)) return null;
  if (most <= least) most = least + (Math.abs(least) || 1);
  return [least, most];
}

export class Chart {
  /** onSeek gets a time. */
  constructor(canvas, motions, duration, onSeek) {
    this.canvas = canvas;
    this.motions = motions;
    this.duration = duration || 1;
    this.ranges = ROWS.map((row) => rangeOf(row, motions));
    this.base = document.createElement('canvas');
    this.time = 0;
    const seek = (event) => {
      const box = canvas.getBoundingClientRect();
      const x = event.clientX - box.left - MARGIN.left;
      const width = box.width - MARGIN.left - MARGIN.right;
      onSeek(this.duration * Math.min(1, Math.max(0, x / width)));
    };
    canvas.addEventListener('pointerdown', (event) => {
      canvas.setPointerCapture(event.pointerId);
      seek(event);
    });
    canvas.addEventListener('pointermove', (event) => {
      if (canvas.hasPointerCapture(event.pointerId)) seek(event);
    });
  }

  get style() {
    const css = getComputedStyle(document.documentElement);
    const get = (name) => css.getPropertyValue(name).trim();
    return { ink: get('--ink'), faint: get('--faint'), line: get('--line'), head: get('--accent'), curves: [get('--first'), get('--second')] };
  }

  /** To the size that the page gives it. */
  resize() {
    const ratio = window.devicePixelRatio || 1;
    const { width, height } = this.canvas.getBoundingClientRect();
    for (const canvas of [this.canvas, this.base]) {
      canvas.width = Math.max(1, Math.round(ratio * width));
      canvas.height = Math.max(1, Math.round(ratio * height));
    }
    this.width = width;
    this.height = height;
    this.ratio = ratio;
    this.drawBase();
    this.draw(this.time);
  }

  x(time) {
    return MARGIN.left + (time / this.duration) * (this.width - MARGIN.left - MARGIN.right);
  }

  y(row, value) {
    const [least, most] = this.ranges[row];
    const height = this.height / ROWS.length;
    const inner = height - MARGIN.top - MARGIN.bottom;
    return height * row + MARGIN.top + inner * (1 - (value - least) / (most - least));
  }

  drawBase() {
    const context = this.base.getContext('2d');
    context.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
    context.clearRect(0, 0, this.width, this.height);
    context.font = '11px system-ui, sans-serif';
    context.textBaseline = 'top';
    ROWS.forEach((row, index) => this.drawRow(context, row, index));
  }

  drawRow(context, row, index) {
    const style = this.style;
    const top = (this.height / ROWS.length) * index;
    context.fillStyle = style.line;
    if (index > 0) context.fillRect(0, Math.round(top), this.width, 1);
    context.fillStyle = style.ink;
    context.textAlign = 'left';
    context.fillText(row.title, MARGIN.left, top + 4);
    const range = this.ranges[index];
    if (!range || (range[0] === 0 && this.motions.every((m) => (m.figures[row.curves[0].name] ?? []).every((v) => !v)))) {
      context.fillStyle = style.faint;
      context.fillText('not estimated by this solver', MARGIN.left + context.measureText(row.title).width + 8, top + 4);
      return;
    }
    context.fillStyle = style.faint;
    const text = range.map((v) => digits(row.scale * v, 3)).join(' – ') + ` ${row.unit}`;
    context.fillText(text, MARGIN.left + context.measureText(row.title).width + 8, top + 4);
    this.drawKey(context, row, top, style);
    this.motions.forEach((motion, which) => {
      if (row.limit) this.drawLimit(context, index, row.limit(motion), style, which);
      for (const curve of row.curves) this.drawCurve(context, index, motion, curve, style.curves[which]);
    });
  }

  drawKey(context, row, top, style) {
    if (row.curves.length < 2 || this.width < 420) return;
    context.textAlign = 'right';
    let x = this.width - MARGIN.right;
    for (const curve of [...row.curves].reverse()) {
      context.fillStyle = style.faint;
      context.fillText(curve.label, x, top + 4);
      x -= context.measureText(curve.label).width + 5;
      this.stroke(context, curve, style.ink, () => {
        context.moveTo(x - 16, top + 10);
        context.lineTo(x, top + 10);
      });
      x -= 26;
    }
  }

  drawLimit(context, row, value, style, which) {
    const [least, most] = this.ranges[row];
    if (value > most || value < least) return;
    context.save();
    context.strokeStyle = which === 0 ? style.faint : style.curves[1];
    context.setLineDash([5, 4]);
    context.beginPath();
    context.moveTo(MARGIN.left, this.y(row, value));
    context.lineTo(this.width - MARGIN.right, this.y(row, value));
    context.stroke();
    context.restore();
  }

  stroke(context, curve, colour, path) {
    context.save();
    context.strokeStyle = colour;
    context.lineWidth = curve.faint ? 1 : 1.6;
    context.globalAlpha = curve.faint ? 0.6 : 1;
    if (curve.dotted) context.setLineDash([2, 2]);
    context.lineJoin = 'round';
    context.beginPath();
    path();
    context.stroke();
    context.restore();
  }

  drawCurve(context, row, motion, curve, colour) {
    const values = motion.figures[curve.name] ?? [];
    this.stroke(context, curve, colour, () => {
      values.forEach((value, sample) => {
        if (value !== null) context.lineTo(this.x(sample * motion.dt), this.y(row, value));
      });
    });
  }

  /** The playhead, and a dot on each curve. samples: the one of each motion. */
  draw(time, samples = []) {
    this.time = time;
    const context = this.canvas.getContext('2d');
    const style = this.style;
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.clearRect(0, 0, this.canvas.width, this.canvas.height);
    context.drawImage(this.base, 0, 0);
    context.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
    const x = this.x(Math.min(time, this.duration));
    context.fillStyle = style.head;
    context.fillRect(x - 0.75, 0, 1.5, this.height);
    ROWS.forEach((row, index) => {
      this.motions.forEach((motion, which) => {
        const value = motion.figures[row.curves[0].name]?.[samples[which]];
        if (value === null || value === undefined || !this.ranges[index]) return;
        context.fillStyle = style.curves[which];
        context.beginPath();
        context.arc(this.x(samples[which] * motion.dt), this.y(index, value), 3.5, 0, 7);
        context.fill();
      });
    });
  }
}
