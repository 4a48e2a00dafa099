/** weft in a page: a cloth that is simulated here, and what may be changed of it. */

import { Box3, Sphere, Vector3 } from 'three';
import { Picture } from '../../viewer/source/picture.js';
import { Stage } from '../../viewer/source/stage.js';
import { Cloth, SCENES } from './cloth.js';
import { Hand } from './hand.js';

const byId = (id) => document.getElementById(id);
const DT = 1 / 60;
const OPTIONS = { heat: false, heatRange: 0.01, threads: 'none', bodies: true, pins: true, contacts: false };
/** What each scene begins with: only over the ball does the cloth fold far enough to meet itself. */
const BEGINNINGS = {
  sheet: { side: 40, selfContact: false },
  skirt: { side: 24, selfContact: false },
  drape: { side: 40, selfContact: true },
};
/** How many of the last frames the shown time is a mean of. */
const FRAMES = 30;

const address = new URLSearchParams(location.hash.slice(1));

function sphereOf(box) {
  const sphere = box.getBoundingSphere(new Sphere());
  sphere.radius = Math.max(sphere.radius, 1e-9);
  return sphere;
}

/** Around the cloth as it starts, its bodies, and the room that it falls into. */
function boxOf({ places: [places] }, scene) {
  const box = new Box3();
  const point = new Vector3();
  for (let i = 0; i < places.length; i += 3) box.expandByPoint(point.fromArray(places, i));
  if (scene === 'skirt') box.expandByPoint(point.set(0, 0.05, 0));
  if (scene === 'drape') box.expandByPoint(point.set(0, 0, 0));
  if (scene === 'sheet') box.expandByVector(point.set(0, 0, 0.3));
  return box;
}

class Page {
  constructor(module) {
    this.cloth = new Cloth(module);
    const scene = SCENES.includes(address.get('scene')) ? address.get('scene') : 'sheet';
    this.choices = { scene, material: 'cotton', tolerance: 0.01, substeps: 0, wind: 0, ...BEGINNINGS[scene] };
    if (Number(address.get('side')) > 0) this.choices.side = Number(address.get('side'));
    this.times = [];
    this.frame = 0;
    this.isPlaying = address.get('play') !== '0';
  }

  begin() {
    this.cloth.begin(this.choices, false);
    this.stage = this.makeStage();
    this.picture = new Picture(byId('picture'), [this.stage], sphereOf(this.box));
    this.hand = new Hand(this, byId('picture'));
    this.listen();
    this.setTheme(address.get('theme') ?? (matchMedia('(prefers-color-scheme: dark)').matches ? 'dark' : 'light'));
    this.setPanel(address.has('panel') ? address.get('panel') !== '0' : innerWidth > 760);
    this.setPlaying(this.isPlaying);
    this.showChoices();
    new ResizeObserver(() => this.resize()).observe(byId('picture'));
    this.resize();
    this.last = performance.now();
    requestAnimationFrame((now) => this.tick(now));
  }

  makeStage() {
    this.box = boxOf(this.cloth.motion, this.choices.scene);
    const stage = new Stage(this.cloth.motion, 0, this.box);
    stage.apply(OPTIONS);
    return stage;
  }

  /** A new cloth: of another scene or size from its start, else from where this one is. */
  restart(changes, goesOn) {
    const wanted = { ...this.choices, ...changes };
    try {
      this.cloth.begin(wanted, goesOn);
    } catch (error) {
      this.say(error.message);
      this.showChoices();
      return;
    }
    const isOtherScene = wanted.scene !== this.choices.scene;
    this.choices = wanted;
    if (!goesOn) this.hand.drop();
    const { environment } = this.stage.scene;
    this.stage.scene.traverse((object) => object.geometry?.dispose());
    this.stage = this.makeStage();
    this.stage.scene.environment = environment;
    this.stage.theme = this.theme;
    this.picture.stages = [this.stage];
    if (isOtherScene) {
      this.picture.sphere = sphereOf(this.box);
      this.picture.reset();
    }
    this.times = [];
    this.say('');
    this.showChoices();
    this.show();
  }

  listen() {
    const on = (id, work) => byId(id).addEventListener('click', work);
    for (const scene of SCENES) {
      on(`scene-${scene}`, () => this.restart({ scene, ...BEGINNINGS[scene] }, false));
    }
    on('play', () => this.setPlaying(!this.isPlaying));
    on('again', () => this.restart({}, false));
    on('self', () => this.restart({ selfContact: !this.choices.selfContact }, true));
    on('theme', () => this.setTheme(this.theme === 'dark' ? 'light' : 'dark'));
    on('home', () => this.picture.reset());
    on('panel-switch', () => this.setPanel(document.body.dataset.panel === 'closed'));
    const choose = (id, change, goesOn) =>
      byId(id).addEventListener('change', (event) => this.restart(change(event.target.value), goesOn));
    choose('material', (material) => ({ material }), true);
    choose('tolerance', (tolerance) => ({ tolerance: Number(tolerance) }), true);
    choose('substeps', (substeps) => ({ substeps: Number(substeps) }), true);
    choose('side', (side) => ({ side: Number(side) }), false);
    byId('wind').addEventListener('input', (event) => {
      this.choices.wind = Number(event.target.value);
      this.cloth.wind = this.choices.wind;
      this.showChoices();
    });
    addEventListener('keydown', (event) => this.key(event));
  }

  key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey || /SELECT|INPUT|BUTTON/.test(event.target.tagName)) return;
    const work = {
      ' ': () => this.setPlaying(!this.isPlaying),
      a: () => this.restart({}, false),
      d: () => this.setTheme(this.theme === 'dark' ? 'light' : 'dark'),
      i: () => this.setPanel(document.body.dataset.panel === 'closed'),
      r: () => this.picture.reset(),
    }[event.key];
    if (!work) return;
    event.preventDefault();
    work();
  }

  showChoices() {
    const { scene, material, tolerance, substeps, side, wind, selfContact } = this.choices;
    for (const name of SCENES) byId(`scene-${name}`).setAttribute('aria-pressed', name === scene);
    byId('self').setAttribute('aria-pressed', selfContact);
    for (const [id, value] of Object.entries({ material, tolerance, substeps, side, wind })) byId(id).value = value;
    byId('wind-speed').textContent = `${wind} m/s`;
    byId('title').textContent = `weft: ${byId(`scene-${scene}`).textContent.toLowerCase()}`;
    byId('particles').textContent = this.cloth.motion.particles;
  }

  say(text) {
    byId('notice').hidden = text === '';
    byId('notice').textContent = text;
  }

  setPlaying(on) {
    this.isPlaying = on;
    byId('play').dataset.playing = on;
    byId('play').setAttribute('aria-label', on ? 'Pause' : 'Play');
  }

  setTheme(name) {
    this.theme = name === 'dark' ? 'dark' : 'light';
    document.documentElement.dataset.theme = this.theme;
    this.stage.theme = this.theme;
  }

  setPanel(isOpen) {
    document.body.dataset.panel = isOpen ? 'open' : 'closed';
    byId('panel-switch').setAttribute('aria-expanded', isOpen);
  }

  resize() {
    this.picture.resize();
    this.show();
  }

  /** One step of 1/60 s at most for each picture. */
  tick(now) {
    requestAnimationFrame((next) => this.tick(next));
    const isDue = now - this.last > 0.75e3 * DT;
    if (this.isPlaying && isDue) {
      this.last = now;
      this.step();
    }
    this.picture.controls.update();
    this.show();
  }

  step() {
    this.hand.lead(DT);
    const begin = performance.now();
    try {
      this.cloth.step(DT);
    } catch (error) {
      this.say(error.message);
      this.setPlaying(false);
      return;
    }
    this.times = [...this.times.slice(1 - FRAMES), performance.now() - begin];
    ++this.frame;
    this.showFigures();
  }

  showFigures() {
    const figures = this.cloth.figures();
    const ms = this.times.reduce((sum, time) => sum + time, 0) / this.times.length;
    const percent = (x) => `${(100 * x).toPrecision(3)} %`;
    const texts = {
      ms: `${ms.toPrecision(3)} ms`, strain: percent(figures.strain), error: percent(figures.error),
      substepsDone: figures.substeps,
      contacts: figures.bodyContacts, selfContacts: figures.selfContacts, status: figures.status.replaceAll('_', ' '),
    };
    for (const [id, text] of Object.entries(texts)) byId(`shown-${id}`).textContent = text;
    byId('shown-status').className = figures.status === 'converged' ? '' : 'missed';
    byId('summary').textContent = `${texts.ms} a frame, ${texts.strain}, ${texts.status}`;
    Object.assign(document.body.dataset, { frame: this.frame, status: figures.status });
  }

  show() {
    this.stage.show(0, 0);
    this.picture.draw();
  }

  /** Where a particle is in the window, in CSS pixels. */
  project(particle) {
    const at = new Vector3(...this.cloth.place(particle)).project(this.picture.camera);
    const box = byId('picture').getBoundingClientRect();
    return [box.left + ((at.x + 1) / 2) * box.width, box.top + ((1 - at.y) / 2) * box.height];
  }
}

async function main() {
  const page = new Page(await globalThis.makeWeft());
  page.begin();
  byId('notice').hidden = true;
  document.body.dataset.state = 'ready';
  window.weft = page;
}

main().catch((error) => {
  const text = /webgl|context/i.test(error.message)
    ? 'This page needs WebGL, which the browser does not offer.'
    : `This page cannot be shown: ${error.message}`;
  byId('notice').hidden = false;
  byId('notice').textContent = text;
  document.body.dataset.state = 'failed';
});
