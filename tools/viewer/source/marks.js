/** What is marked on a cloth: pins, contacts, and how its constraints are ordered. */

import {
  BufferAttribute, BufferGeometry, Color, DoubleSide, InstancedMesh, LineBasicMaterial, LineSegments, Matrix4,
  Mesh, MeshBasicMaterial, MeshLambertMaterial, Points, PointsMaterial, SphereGeometry,
} from 'three';
import { hueOf } from './colours.js';
import { dynamic } from './cloth.js';

export class Pins {
  constructor(motion, radius) {
    this.numbers = motion.pins;
    this.object = new InstancedMesh(
      new SphereGeometry(radius, 16, 12), new MeshBasicMaterial(), Math.max(1, motion.pins.length));
    this.object.count = motion.pins.length;
    this.object.frustumCulled = false;
    this.place = new Matrix4();
  }
  show(places) {
    for (let i = 0; i < this.numbers.length; ++i) {
      const p = 3 * this.numbers[i];
      this.object.setMatrixAt(i, this.place.makeTranslation(places[p], places[p + 1], places[p + 2]));
    }
    this.object.instanceMatrix.needsUpdate = true;
  }
}

function isNearer(shader) {
  shader.vertexShader = shader.vertexShader.replace(
    '#include <project_vertex>', '#include <project_vertex>\n  gl_Position.z -= 0.004 * gl_Position.w;');
  shader.fragmentShader = shader.fragmentShader.replace(
    '#include <color_fragment>',
    '#include <color_fragment>\n  if (length(gl_PointCoord - 0.5) > 0.5) discard;');
}

const DOT = 5; // pixels

/** A dot at each particle that touches a body. */
export class Contacts {
  constructor(motion) {
    this.contacts = motion.contacts;
    const most = motion.contacts.reduce((count, list) => Math.max(count, list.length), 1);
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', dynamic(new Float32Array(3 * most), 3));
    const material = new PointsMaterial({ size: DOT, sizeAttenuation: false });
    material.onBeforeCompile = isNearer;
    this.object = new Points(geometry, material);
    this.object.frustumCulled = false;
  }
  show(sample, places) {
    const list = this.contacts[sample];
    const attribute = this.object.geometry.getAttribute('position');
    for (let i = 0; i < list.length; ++i) {
      for (let k = 0; k < 3; ++k) attribute.array[3 * i + k] = places[3 * list[i] + k];
    }
    attribute.needsUpdate = true;
    this.object.geometry.setDrawRange(0, list.length);
  }
}

/** Corners that have places of their own, so that each constraint and each triangle has its colour. */
class Gathered {
  constructor(corners, cornersOfOne, colours) {
    this.corners = corners;
    this.geometry = new BufferGeometry();
    this.geometry.setAttribute('position', dynamic(new Float32Array(3 * corners.length), 3));
    const bytes = new Uint8Array(3 * corners.length);
    for (let i = 0; i < corners.length; ++i) {
      const colour = colours[Math.floor(i / cornersOfOne)];
      bytes.set([255 * colour.r, 255 * colour.g, 255 * colour.b], 3 * i);
    }
    this.geometry.setAttribute('color', new BufferAttribute(bytes, 3, true));
  }
  show(places) {
    const attribute = this.geometry.getAttribute('position');
    for (let i = 0; i < this.corners.length; ++i) {
      const p = 3 * this.corners[i];
      attribute.array[3 * i] = places[p];
      attribute.array[3 * i + 1] = places[p + 1];
      attribute.array[3 * i + 2] = places[p + 2];
    }
    attribute.needsUpdate = true;
    if (this.geometry.getAttribute('normal')) this.geometry.computeVertexNormals();
  }
}

function coloursOf(numbers, lightness, saturation = 0.75) {
  return Array.from(numbers, (n, i) => {
    const [number, family] = Array.isArray(n) ? n : [n, 0];
    if (number < 0) return new Color(0x808080);
    return new Color().setHSL(hueOf(number), saturation, family % 2 === 0 ? lightness : 0.75 * lightness);
  });
}

/** Yarns alternate within a family, so that one is told from the next; families differ in hue. */
function yarnColours(links) {
  return Array.from(links.yarns, (yarn, i) => {
    if (yarn < 0) return new Color(0x8a8f95);
    const family = links.families[i];
    const hue = [0.03, 0.58, 0.33, 0.8, 0.14, 0.47][family % 6];
    return new Color().setHSL(hue, 0.8, 0.36 + 0.24 * (yarn % 2));
  });
}

/** One way to look at how the cloth is made; `mode` is yarns or colours. */
export class Structure {
  constructor(motion, mode) {
    const { links, fabric } = motion;
    this.parts = [];
    this.objects = [];
    if (links.yarns.length > 0) {
      const colours = mode === 'yarns' ? yarnColours(links) : coloursOf(links.colours, 0.5);
      const part = new Gathered(links.ends, 2, colours);
      this.add(part, new LineSegments(part.geometry, new LineBasicMaterial({ vertexColors: true })));
    }
    if (mode === 'colours' && fabric.colours.length > 0) {
      const part = new Gathered(fabric.triangles, 3, coloursOf(fabric.colours, 0.55, 0.6));
      part.geometry.setAttribute('normal', dynamic(new Float32Array(3 * part.corners.length), 3));
      const mesh = new Mesh(
        part.geometry, new MeshLambertMaterial({ vertexColors: true, side: DoubleSide, flatShading: true }));
      mesh.castShadow = mesh.receiveShadow = true;
      this.hidesCloth = true;
      this.add(part, mesh);
    }
  }
  add(part, object) {
    object.frustumCulled = false;
    this.parts.push(part);
    this.objects.push(object);
  }
  show(places) {
    for (const part of this.parts) part.show(places);
  }
  get isEmpty() {
    return this.parts.length === 0;
  }
}
