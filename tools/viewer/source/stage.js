/** A scene that shows one motion: light, ground, the cloth and its bodies. */

import {
  Box3, CircleGeometry, Color, DirectionalLight, HemisphereLight, Mesh, MeshStandardMaterial, Scene, Sphere, Vector3,
} from 'three';
import { BodyViews } from './bodies.js';
import { ClothView } from './cloth.js';
import { FABRICS, THEMES } from './colours.js';
import { Contacts, Pins, Structure } from './marks.js';

/** Around the cloth in all samples. */
export function boxOf(motion) {
  const box = new Box3();
  const point = new Vector3();
  const used = [...new Set([...motion.triangles, ...motion.lines])];
  const step = Math.max(1, Math.floor(used.length / 2000));
  for (const places of motion.places) {
    for (let i = 0; i < used.length; i += step) box.expandByPoint(point.fromArray(places, 3 * used[i]));
  }
  return box;
}

/** The mean length of an edge as the cloth starts. */
function edgeOf({ triangles, places: [places] }) {
  let sum = 0;
  for (let i = 0; i + 2 < triangles.length; i += 3) {
    const a = 3 * triangles[i];
    const b = 3 * triangles[i + 1];
    sum += Math.hypot(places[a] - places[b], places[a + 1] - places[b + 1], places[a + 2] - places[b + 2]);
  }
  return triangles.length > 0 ? (3 * sum) / triangles.length : 0;
}

export class Stage {
  constructor(motion, index, box) {
    this.motion = motion;
    this.up = new Vector3(0, motion.up === 'z' ? 0 : 1, motion.up === 'z' ? 1 : 0);
    this.sphere = box.getBoundingSphere(new Sphere());
    const { radius } = this.sphere;
    this.scene = new Scene();
    this.cloth = new ClothView(motion, FABRICS[index % FABRICS.length]);
    this.bodies = new BodyViews(motion.bodies, this.sphere, edgeOf(motion));
    this.pins = new Pins(motion, 0.008 * radius);
    this.contacts = new Contacts(motion);
    this.structures = {};
    this.scene.add(...this.cloth.objects, this.bodies.group, this.pins.object, this.contacts.object);
    this.addLight();
    this.addGround(box);
    this.options = {};
  }

  addLight() {
    const { center, radius } = this.sphere;
    const side = new Vector3(1, 0, 0);
    const front = new Vector3().crossVectors(side, this.up);
    const towards = (x, y, z) =>
      center.clone().addScaledVector(side, x * radius).addScaledVector(this.up, y * radius).addScaledVector(front, z * radius);
    this.sun = new DirectionalLight(0xfff4e6, 2.6);
    this.sun.position.copy(towards(-1.9, 3.2, 1.6));
    this.sun.target.position.copy(center);
    this.sun.castShadow = true;
    this.sun.shadow.mapSize.set(2048, 2048);
    Object.assign(this.sun.shadow.camera, {
      left: -1.5 * radius, right: 1.5 * radius, top: 1.5 * radius, bottom: -1.5 * radius,
      near: 0.2 * radius, far: 8 * radius,
    });
    this.sun.shadow.bias = -0.0004;
    this.sun.shadow.normalBias = 0.006 * radius;
    this.sun.shadow.radius = 5;
    this.rim = new DirectionalLight(0xcfe0ff, 0.9);
    this.rim.position.copy(towards(2.2, 1.0, -2.4));
    this.rim.target.position.copy(center);
    this.sky = new HemisphereLight(0xffffff, 0x8d8378, 0.55);
    this.sky.position.copy(this.up);
    this.lamp = new DirectionalLight(0xffffff, 0.55); // beside the eye
    this.lamp.target.position.copy(center);
    this.scene.add(this.lamp, this.lamp.target, this.sun, this.sun.target, this.rim, this.rim.target, this.sky);
  }

  /** Below all that moves, unless a plane of the scene is there. It fades into the background. */
  addGround(box) {
    const isLevel = (body) =>
      body.shape === 'plane' && new Vector3(...body.normal).normalize().dot(this.up) > 0.99;
    if (this.motion.bodies.some(isLevel)) return;
    const { radius, center } = this.sphere;
    const all = box.clone();
    for (const view of this.bodies.views) {
      view.show(0, 0);
      if (view.body.shape !== 'plane') all.expandByObject(view.mesh);
    }
    const lowest = this.up.dot(all.min) - 0.03 * radius;
    const material = new MeshStandardMaterial({ roughness: 1, transparent: true });
    material.onBeforeCompile = (shader) => {
      shader.vertexShader = shader.vertexShader
        .replace('#include <common>', 'varying vec2 vGround;\n#include <common>')
        .replace('#include <begin_vertex>', 'vGround = uv - 0.5;\n#include <begin_vertex>');
      shader.fragmentShader = shader.fragmentShader
        .replace('#include <common>', 'varying vec2 vGround;\n#include <common>')
        .replace('#include <color_fragment>',
          '#include <color_fragment>\n  diffuseColor.a = 1.0 - smoothstep(0.12, 0.5, length(vGround));');
    };
    this.ground = new Mesh(new CircleGeometry(5 * radius, 96), material);
    this.ground.quaternion.setFromUnitVectors(new Vector3(0, 0, 1), this.up);
    this.ground.position.copy(center).addScaledVector(this.up, lowest - this.up.dot(center));
    this.ground.receiveShadow = true;
    this.scene.add(this.ground);
  }

  set theme(name) {
    const theme = THEMES[name];
    this.bodies.colour = theme.body;
    this.pins.object.material.color.set(theme.pin);
    this.contacts.object.material.color.set(theme.contact);
    this.cloth.wire.material.color.set(theme.wire);
    if (this.ground) this.ground.material.color.set(theme.floor);
    this.scene.background = null;
    this.scene.environmentIntensity = 0.34 * theme.ambient;
    this.sky.intensity = 0.55 * theme.ambient;
    this.sun.intensity = 2.9 * theme.exposure;
    this.sky.groundColor = new Color(name === 'dark' ? 0x3a3632 : 0x9a9088);
  }

  structure(mode) {
    if (mode !== 'yarns' && mode !== 'colours') return null;
    if (!this.structures[mode]) {
      const made = new Structure(this.motion, mode);
      this.structures[mode] = made;
      if (!made.isEmpty) this.scene.add(...made.objects);
    }
    return this.structures[mode];
  }

  /** options: heat, heatRange, threads (none, mesh, yarns, colours), bodies, pins, contacts. */
  apply(options) {
    this.options = options;
    this.cloth.colourBy(options);
    this.cloth.wire.visible = options.threads === 'mesh';
    this.bodies.group.visible = options.bodies;
    this.pins.object.visible = options.pins;
    this.contacts.object.visible = options.contacts;
    const shown = this.structure(options.threads);
    for (const made of Object.values(this.structures)) {
      for (const object of made.objects) object.visible = made === shown;
    }
    this.cloth.mesh.visible = !shown?.hidesCloth;
  }

  show(sample, share) {
    this.cloth.show(sample, share);
    this.bodies.show(sample, share);
    if (this.pins.object.visible) this.pins.show(this.cloth.places);
    if (this.contacts.object.visible) this.contacts.show(sample, this.cloth.places);
    this.structure(this.options.threads)?.show(this.cloth.places);
  }
}
