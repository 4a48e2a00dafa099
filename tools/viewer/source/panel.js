/** Switches and figures beside the picture. */

import { FIGURES, digits, figureAt, isShown } from './figures.js';
import { heatGradient } from './heat.js';

const byId = (id) => document.getElementById(id);

export function element(tag, properties = {}, ...children) {
  const made = Object.assign(document.createElement(tag), properties);
  made.append(...children);
  return made;
}

/** The table of figures: a row for each, a column for each motion. */
export class Figures {
  constructor(motions) {
    this.motions = motions;
    this.cells = [];
    const body = byId('figures');
    if (motions.length > 1) {
      const names = motions.map((_, i) => element('th', { className: `result-${i}`, textContent: 'AB'[i], scope: 'col' }));
      body.append(element('tr', {}, element('td'), ...names));
    }
    for (const figure of FIGURES.filter((f) => isShown(f, motions))) {
      const cells = motions.map((_, result) => {
        const cell = element('td');
        Object.assign(cell.dataset, { figure: figure.name, result });
        return cell;
      });
      const head = element('th', { textContent: figure.label, scope: 'row', title: figure.title ?? '' });
      body.append(element('tr', { className: figure.sub ? 'sub' : '' }, head, ...cells));
      this.cells.push({ figure, cells });
    }
  }

  show(samples) {
    for (const { figure, cells } of this.cells) {
      cells.forEach((cell, result) => {
        const value = figureAt(this.motions[result], figure.name, samples[result]);
        cell.textContent = value === null ? '–' : figure.text(value);
        cell.dataset.value = value ?? '';
        if (figure.name === 'status') cell.className = value === 'converged' || value === null ? '' : 'missed';
      });
    }
  }
}

export class Legend {
  constructor(onRange) {
    byId('heat-bar').style.background = heatGradient();
    for (const [id, factor] of [['heat-finer', 0.5], ['heat-coarser', 2]]) {
      byId(id).addEventListener('click', () => onRange(factor));
    }
  }
  show(range, on) {
    byId('legend').hidden = !on;
    const text = (x) => `${x > 0 ? '+' : ''}${digits(100 * x, 2)} %`;
    byId('heat-low').textContent = text(-range).replace('-', '−');
    byId('heat-high').textContent = text(range);
  }
}

/** What the run was: for the table at the end of the panel. */
export function describe(motion) {
  const { settings: s } = motion;
  const rows = [
    ['Scene', motion.scene],
    ['Particles', motion.particles],
    ['Constraints', motion.links.yarns.length || null],
    ['Triangles of fabric', motion.fabric.colours.length || null],
    ['Bodies', motion.bodies.length || null],
    ['Frames', `${motion.samples - 1} of ${digits(1e3 * motion.dt, 4)} ms`],
    ['Solver', s.solver.replaceAll('_', ' ')],
    ['Tolerance', `${digits(100 * s.tolerance, 3)} %`],
    ['Places are within', `${digits(0.5e6 * motion.quantum, 2)} µm`],
    ['Stretch is within', `${digits(50 * motion.stretch_quantum, 2)} %`],
  ];
  return rows.filter(([, value]) => value !== null);
}

export function showRuns(motions) {
  const body = byId('run');
  const lists = motions.map(describe);
  const labels = [...new Set(lists.flatMap((list) => list.map(([label]) => label)))];
  for (const label of labels) {
    const cells = lists.map((list) =>
      element('td', { textContent: list.find(([name]) => name === label)?.[1] ?? '–' }));
    body.append(element('tr', {}, element('th', { textContent: label, scope: 'row' }), ...cells));
  }
}
