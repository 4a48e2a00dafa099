/** The cloth of WebAssembly (page.cpp), and the motion of one sample that the viewer's stage shows of it. */

export const SCENES = ['sheet', 'skirt', 'drape'];

/** As page.cpp has them. */
const BODIES = {
  sheet: [],
  skirt: [0, 1].map(() => ({ shape: 'capsule', a: [0, 0, 0], b: [0, -0.8, 0], radius_a: 0.07, radius_b: 0.05 })),
  drape: [{ shape: 'ball', centre: [0, 0.28, 0], radius: 0.28 }, { shape: 'plane', normal: [0, 1, 0], offset: 0 }],
};

const FIGURES = ['strain', 'error', 'substeps', 'bodyContacts', 'selfContacts'];

export class Cloth {
  constructor(module) {
    this.module = module;
  }

  /** Throws what the library says. */
  check(failed) {
    if (failed) throw new Error(this.module.UTF8ToString(this.module._page_message()));
  }

  /** goesOn: the cloth stays where it is, if the scene and its size are the same. */
  begin({ scene, side, material, tolerance, substeps, wind, selfContact }, goesOn) {
    this.check(this.module.ccall(
      'page_begin', 'number', ['number', 'number', 'string', 'number', 'number', 'number', 'number', 'number'],
      [SCENES.indexOf(scene), side, material, tolerance, substeps, wind, Number(selfContact), Number(goesOn)]));
    const particles = this.module._page_particles();
    this.motion = {
      up: 'y', particles,
      triangles: this.numbers(this.module._page_triangles(), this.module._page_corners()),
      pins: this.numbers(this.module._page_pin_list(), this.module._page_pins()),
      places: [new Float32Array(3 * particles)],
      stretch: [new Float32Array(particles)],
      contacts: [[]], lines: [], seams: [],
      links: { ends: [], yarns: [], colours: [], families: [] },
      fabric: { triangles: [], colours: [] },
      bodies: BODIES[scene].map((body) => ({ ...body, poses: new Float32Array(7) })),
    };
    this.read();
  }

  numbers(at, count) {
    return new Uint32Array(this.module.HEAPU8.buffer, at, count).slice();
  }

  read() {
    const { places, bodies } = this.motion;
    places[0].set(new Float32Array(this.module.HEAPU8.buffer, this.module._page_places(), places[0].length));
    bodies.forEach((body, id) => {
      for (let i = 0; i < 7; ++i) body.poses[i] = this.module._page_pose(id, i);
    });
  }

  step(dt) {
    this.check(this.module._page_advance(dt));
    this.read();
  }

  figures() {
    const all = Object.fromEntries(FIGURES.map((name, i) => [name, this.module._page_figure(i)]));
    return { ...all, status: this.module.UTF8ToString(this.module._page_status()) };
  }

  place(particle) {
    return Array.from(this.motion.places[0].subarray(3 * particle, 3 * particle + 3));
  }
  hold(particle) {
    this.check(this.module._page_hold(particle));
  }
  drag(to) {
    this.module._page_drag(...to);
  }
  letGo() {
    this.check(this.module._page_let_go());
  }
  set wind(speed) {
    this.check(this.module._page_set_wind(speed));
  }
}
