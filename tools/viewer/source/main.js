/** Puts the page together: reads the results that stand in it, and joins the parts. */

import { Box3, Sphere, Vector3 } from 'three';
import { Chart } from './chart.js';
import { niceRange } from './heat.js';
import { bytesOfBase64, readMotion } from './motion.js';
import { Figures, Legend, element, showRuns } from './panel.js';
import { Picture } from './picture.js';
import { Player, sampleAt } from './player.js';
import { Stage, boxOf } from './stage.js';

const byId = (id) => document.getElementById(id);
const SPEEDS = [0.05, 0.1, 0.25, 0.5, 1, 2, 4];
const THREADS = ['none', 'mesh', 'yarns', 'colours'];
const SWITCHES = ['heat', 'bodies', 'pins', 'contacts'];

/** #time=1.5&theme=dark&threads=yarns&heat=1&play=0&panel=0 */
const asked = new URLSearchParams(location.hash.slice(1));
const isAsked = (name, otherwise) => (asked.has(name) ? asked.get(name) !== '0' : otherwise);

function fail(message) {
  byId('notice').hidden = false;
  byId('notice').textContent = message;
  document.body.dataset.state = 'failed';
}

async function readResults() {
  const scripts = [...document.querySelectorAll('script.result')];
  const motions = [];
  for (const [index, script] of scripts.entries()) {
    const bytes = bytesOfBase64(script.textContent);
    motions.push(await readMotion(bytes, (share) => {
      byId('progress').value = (index + share) / scripts.length;
    }));
    script.remove(); // its text would stay in memory
  }
  return motions;
}

/** Of all motions and their bodies, but for what is far larger than the cloth. */
function wholeSphere(stages, boxes) {
  const box = boxes.reduce((all, next) => all.union(next), new Box3());
  const cloth = box.getBoundingSphere(new Sphere());
  for (const stage of stages) {
    for (const view of stage.bodies.views) {
      if (view.body.shape === 'plane') continue;
      view.show(0, 0);
      const around = new Box3().setFromObject(view.mesh).getBoundingSphere(new Sphere());
      if (around.radius < 2 * cloth.radius) box.union(new Box3().setFromObject(view.mesh));
    }
  }
  const size = box.getSize(new Vector3());
  return new Sphere(box.getCenter(new Vector3()), 0.5 * Math.max(size.length(), 1e-9));
}

class Page {
  constructor(motions) {
    this.motions = motions;
    const duration = Math.max(...motions.map((m) => m.duration));
    this.player = new Player(duration, Math.min(...motions.map((m) => m.dt)));
    const boxes = motions.map(boxOf);
    const box = boxes.reduce((all, next) => all.clone().union(next), new Box3());
    this.stages = motions.map((motion, index) => new Stage(motion, index, box));
    this.picture = new Picture(byId('picture'), this.stages, wholeSphere(this.stages, boxes));
    this.chart = new Chart(byId('chart'), motions, duration, (time) => this.player.pauseAt(time));
    this.figures = new Figures(motions);
    this.legend = new Legend((factor) => this.set({ heatRange: this.options.heatRange * factor }));
    const threads = THREADS.includes(asked.get('threads')) ? asked.get('threads') : 'none';
    this.options = { heatRange: niceRange(motions), threads };
    for (const name of SWITCHES) this.options[name] = isAsked(name, name !== 'heat' && name !== 'contacts');
    this.isDirty = true;
  }

  begin() {
    showRuns(this.motions);
    this.describe();
    this.listen();
    this.setTheme(asked.get('theme') ?? (matchMedia('(prefers-color-scheme: dark)').matches ? 'dark' : 'light'));
    this.setPanel(isAsked('panel', innerWidth > 760));
    this.set({});
    this.player.onChange = () => this.changed();
    new ResizeObserver(() => this.resize()).observe(byId('picture'));
    new ResizeObserver(() => this.resize()).observe(byId('chart'));
    this.resize();
    this.player.pauseAt(Number(asked.get('time') ?? 0));
    if (isAsked('play', !matchMedia('(prefers-reduced-motion: reduce)').matches)) this.player.play();
    this.last = performance.now();
    requestAnimationFrame((now) => this.tick(now));
    document.body.dataset.state = 'ready';
  }

  describe() {
    const names = this.motions.map((m) => m.scene);
    byId('title').textContent = names.length > 1 && names[0] === names[1] ? names[0] : names.join(' | ');
    document.title = `${names.join(' | ')} – weft`;
    document.body.dataset.results = names.length;
    this.labels = this.motions.length < 2 ? [] : this.motions.map((motion, index) => {
      const { solver, tolerance } = motion.settings;
      const text = `${'AB'[index]}  ${motion.scene}, ${solver.replaceAll('_', ' ')}, ${100 * tolerance} %`;
      const label = element('div', { className: `label result-${index}`, textContent: text });
      byId('stage').append(label);
      return label;
    });
    const hasBodies = this.motions.some((m) => m.bodies.length > 0);
    byId('bodies').hidden = !hasBodies;
    byId('contacts').hidden = !this.motions.some((m) => m.contacts.some((list) => list.length > 0));
    byId('pins').hidden = !this.motions.some((m) => m.pins.length > 0);
    const hasLinks = this.motions.some((m) => m.links.yarns.length > 0);
    byId('threads-yarns').hidden = !hasLinks;
  }

  listen() {
    const on = (id, work) => byId(id).addEventListener('click', work);
    on('play', () => this.player.play(!this.player.isPlaying));
    on('to-start', () => this.player.pauseAt(0));
    on('back', () => this.player.stepBy(-1));
    on('forward', () => this.player.stepBy(1));
    on('loop', () => this.setLoop(!this.player.loops));
    on('slower', () => this.changeSpeed(-1));
    on('faster', () => this.changeSpeed(1));
    on('theme', () => this.setTheme(this.theme === 'dark' ? 'light' : 'dark'));
    on('panel-switch', () => this.setPanel(document.body.dataset.panel === 'closed'));
    on('home', () => this.resetCamera());
    on('help-switch', () => this.setHelp(byId('help').hidden));
    on('help', () => this.setHelp(false));
    for (const name of SWITCHES) on(name, () => this.set({ [name]: !this.options[name] }));
    for (const name of THREADS) on(`threads-${name}`, () => this.set({ threads: name }));
    byId('chart').addEventListener('keydown', (event) => this.chartKey(event));
    addEventListener('keydown', (event) => this.key(event));
    this.picture.controls.addEventListener('change', () => { this.isDirty = true; });
    byId('picture').addEventListener('webglcontextrestored', () => { this.isDirty = true; });
  }

  chartKey(event) {
    const pages = { PageUp: -10, PageDown: 10 }[event.key];
    if (pages) this.player.stepBy(pages);
  }

  key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const isButton = event.target instanceof HTMLButtonElement;
    if (isButton && (event.key === ' ' || event.key === 'Enter')) return;
    const act = {
      ' ': () => this.player.play(!this.player.isPlaying),
      ArrowLeft: () => this.player.stepBy(event.shiftKey ? -10 : -1),
      ArrowRight: () => this.player.stepBy(event.shiftKey ? 10 : 1),
      Home: () => this.player.pauseAt(0),
      End: () => this.player.pauseAt(this.player.duration),
      '-': () => this.changeSpeed(-1),
      '+': () => this.changeSpeed(1),
      '=': () => this.changeSpeed(1),
      l: () => this.setLoop(!this.player.loops),
      h: () => this.set({ heat: !this.options.heat }),
      '[': () => this.set({ heatRange: this.options.heatRange / 2 }),
      ']': () => this.set({ heatRange: this.options.heatRange * 2 }),
      w: () => this.toggleThreads('mesh'),
      y: () => this.toggleThreads('yarns'),
      c: () => this.toggleThreads('colours'),
      b: () => this.set({ bodies: !this.options.bodies }),
      p: () => this.set({ pins: !this.options.pins }),
      t: () => this.set({ contacts: !this.options.contacts }),
      d: () => this.setTheme(this.theme === 'dark' ? 'light' : 'dark'),
      i: () => this.setPanel(document.body.dataset.panel === 'closed'),
      r: () => this.resetCamera(),
      ArrowUp: () => this.turn(0, 0.08),
      ArrowDown: () => this.turn(0, -0.08),
      ',': () => this.turn(-0.08, 0),
      '.': () => this.turn(0.08, 0),
      o: () => this.zoom(1.1),
      k: () => this.zoom(1 / 1.1),
      '?': () => this.setHelp(byId('help').hidden),
      Escape: () => this.setHelp(false),
    }[event.key];
    if (!act) return;
    event.preventDefault();
    act();
  }

  turn(across, upward) {
    this.picture.orbit(across, upward);
    this.isDirty = true;
  }
  zoom(factor) {
    this.picture.zoom(factor);
    this.isDirty = true;
  }
  resetCamera() {
    this.picture.reset();
    this.isDirty = true;
  }
  toggleThreads(mode) {
    this.set({ threads: this.options.threads === mode ? 'none' : mode });
  }
  setHelp(on) {
    byId('help').hidden = !on;
  }

  /** Changes some options. */
  set(options) {
    Object.assign(this.options, options);
    for (const name of SWITCHES) byId(name).setAttribute('aria-pressed', this.options[name]);
    for (const name of THREADS) byId(`threads-${name}`).setAttribute('aria-pressed', this.options.threads === name);
    for (const stage of this.stages) stage.apply(this.options);
    this.legend.show(this.options.heatRange, this.options.heat);
    this.changed();
  }

  setTheme(name) {
    this.theme = name === 'dark' ? 'dark' : 'light';
    document.documentElement.dataset.theme = this.theme;
    for (const stage of this.stages) stage.theme = this.theme;
    this.chart.drawBase();
    this.changed();
  }

  setPanel(on) {
    document.body.dataset.panel = on ? 'open' : 'closed';
    byId('panel-switch').setAttribute('aria-expanded', on);
  }

  setLoop(on) {
    this.player.loops = on;
    this.changed();
  }

  changeSpeed(steps) {
    const at = SPEEDS.indexOf(this.player.speed) + steps;
    this.player.speed = SPEEDS[Math.min(SPEEDS.length - 1, Math.max(0, at))];
    this.changed();
  }

  changed() {
    this.isDirty = true;
    const { player } = this;
    byId('play').dataset.playing = player.isPlaying;
    byId('play').setAttribute('aria-label', player.isPlaying ? 'Pause' : 'Play');
    byId('loop').setAttribute('aria-pressed', player.loops);
    byId('speed').textContent = `${player.speed}×`;
  }

  resize() {
    this.picture.resize();
    this.chart.resize();
    const views = this.picture.views;
    const height = byId('picture').clientHeight;
    this.labels.forEach((label, index) => {
      const [x, y, , viewHeight] = views[index];
      label.style.left = `${x + 14}px`;
      label.style.top = `${height - y - viewHeight + (index > 0 && x === 0 ? 10 : 52)}px`;
    });
    byId('stage').dataset.split = views.length < 2 ? 'none' : views[1][0] > 0 ? 'columns' : 'rows';
    this.show();
  }

  tick(now) {
    requestAnimationFrame((next) => this.tick(next));
    const seconds = Math.min(0.1, (now - this.last) / 1000);
    this.last = now;
    this.player.advance(seconds);
    const moved = this.picture.controls.update();
    if (!this.isDirty && !moved && !this.player.isPlaying) return;
    this.isDirty = false;
    this.show();
  }

  /** The moment, in the picture, the figures and the chart. */
  show() {
    const { time, isPlaying, step } = this.player;
    const at = this.motions.map((motion) => sampleAt(motion, time, isPlaying));
    at.forEach(({ sample, share }, index) => this.stages[index].show(sample, share));
    this.picture.draw();
    const samples = at.map(({ sample }) => sample);
    this.figures.show(samples);
    this.chart.draw(time, samples);
    byId('clock').textContent = `${time.toFixed(2)} s`;
    byId('frame').textContent = innerWidth > 430 ? `frame ${samples[0]} / ${this.motions[0].samples - 1}` : `frame ${samples[0]}`;
    const slider = byId('chart');
    slider.setAttribute('aria-valuenow', Math.round(time / step));
    slider.setAttribute('aria-valuetext', `${time.toFixed(2)} seconds`);
    slider.setAttribute('aria-valuemax', Math.round(this.player.duration / step));
    document.body.dataset.sample = samples.join(' ');
  }
}

async function begin() {
  const motions = await readResults();
  if (motions.length === 0) return fail('This page has no result in it.');
  const page = new Page(motions);
  page.begin();
  byId('notice').hidden = true;
  window.weft = { page, motions }; // for tests, and for whoever opens the console
}

begin().catch((error) => {
  const isWebGl = /webgl|context/i.test(error.message);
  fail(isWebGl ? 'This page needs WebGL, which the browser does not offer.' : `This page cannot be shown: ${error.message}`);
});
