/** Bodies: their shapes as meshes, and their poses at a moment. */

import {
  BoxGeometry, BufferAttribute, BufferGeometry, CircleGeometry, DoubleSide, FrontSide, Group, Mesh,
  MeshStandardMaterial, Quaternion, SphereGeometry, Vector3,
} from 'three';
import { ConvexGeometry } from 'three/addons/geometries/ConvexGeometry.js';
import { blend, dynamic, smoothNormals } from './cloth.js';

// How much smaller than they are round bodies are drawn, and how far behind their place, in edges of the cloth.
const SMALLER_EDGES = 0.125;
const PUSHED_EDGES = 0.25;

const UP = new Vector3(0, 1, 0);

/** The surface of all balls between two, turned about the axis from a to b. */
function capsuleGeometry(a, b, radiusA, radiusB) {
  const axis = b.clone().sub(a);
  const length = axis.length();
  if (length <= Math.abs(radiusA - radiusB)) {
    const ball = new SphereGeometry(Math.max(radiusA, radiusB), 48, 32);
    return ball.translate(...(radiusA >= radiusB ? a : b).toArray());
  }
  // The cone touches both balls where the normal has this sine along the axis.
  const tilt = Math.asin((radiusA - radiusB) / length);
  const rings = 14;
  const profile = []; // along the axis, radius, and the normal's angle
  for (let i = 0; i <= rings; ++i) profile.push([0, radiusA, -Math.PI / 2 + (i / rings) * (Math.PI / 2 + tilt)]);
  for (let i = 0; i <= rings; ++i) profile.push([length, radiusB, tilt + (i / rings) * (Math.PI / 2 - tilt)]);
  const around = 48;
  const places = [];
  const normals = [];
  const triangles = [];
  for (const [at, radius, angle] of profile) {
    for (let k = 0; k <= around; ++k) {
      const turn = (2 * Math.PI * k) / around;
      const normal = [Math.cos(angle) * Math.cos(turn), Math.sin(angle), Math.cos(angle) * Math.sin(turn)];
      normals.push(...normal);
      places.push(radius * normal[0], at + radius * normal[1], radius * normal[2]);
    }
  }
  for (let i = 0; i + 1 < profile.length; ++i) {
    for (let k = 0; k < around; ++k) {
      const p = i * (around + 1) + k;
      const q = p + around + 1;
      triangles.push(p, q, p + 1, p + 1, q, q + 1);
    }
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(new Float32Array(places), 3));
  geometry.setAttribute('normal', new BufferAttribute(new Float32Array(normals), 3));
  geometry.setIndex(triangles);
  geometry.applyQuaternion(new Quaternion().setFromUnitVectors(UP, axis.normalize()));
  return geometry.translate(...a.toArray());
}

/** A disc, where the plane is nearest to the middle of what is shown. */
function planeGeometry(body, sphere) {
  const normal = new Vector3(...body.normal);
  const offset = body.offset / normal.length();
  normal.normalize();
  const centre = sphere.center.clone().addScaledVector(normal, offset - normal.dot(sphere.center));
  const disc = new CircleGeometry(3 * sphere.radius, 96);
  disc.applyQuaternion(new Quaternion().setFromUnitVectors(new Vector3(0, 0, 1), normal));
  return disc.translate(...centre.toArray());
}

/** Moves the vertices along their normals, inwards. */
function shrink(triangles, places, normals, by) {
  smoothNormals(triangles, places, normals);
  for (let i = 0; i < places.length; ++i) places[i] -= by * normals[i];
}

function meshGeometry(body, smaller) {
  const geometry = new BufferGeometry();
  const places = new Float32Array(body.vertices);
  const normals = new Float32Array(places.length);
  shrink(body.triangles, places, normals, body.two_sided ? 0 : smaller);
  geometry.setAttribute('position', dynamic(places, 3));
  geometry.setAttribute('normal', dynamic(normals, 3));
  geometry.setIndex(new BufferAttribute(new Uint32Array(body.triangles), 1));
  return geometry;
}

/** A box by its eight corners has sharp edges that a hull of them has not. */
function hullGeometry(points) {
  const least = new Vector3(Infinity, Infinity, Infinity);
  const most = least.clone().negate();
  for (const p of points) {
    least.min(p);
    most.max(p);
  }
  const isCorner = (p) => ['x', 'y', 'z'].every((axis) => p[axis] === least[axis] || p[axis] === most[axis]);
  if (points.length !== 8 || !points.every(isCorner)) return new ConvexGeometry(points);
  const size = most.clone().sub(least);
  return new BoxGeometry(size.x, size.y, size.z).translate(...least.add(most).multiplyScalar(0.5).toArray());
}

/** smaller: m, so that the straight edges of cloth around what is round do not cut into it. */
function geometryOf(body, sphere, smaller) {
  const point = (p) => new Vector3(...p);
  const less = (radius) => Math.max(radius - smaller, 0.8 * radius);
  switch (body.shape) {
    case 'plane':
      return planeGeometry(body, sphere);
    case 'ball':
      return new SphereGeometry(less(body.radius), 64, 40).translate(...body.centre);
    case 'capsule':
      return capsuleGeometry(point(body.a), point(body.b), less(body.radius_a), less(body.radius_b));
    case 'hull':
      return hullGeometry(body.points.map(point));
    default:
      return meshGeometry(body, smaller);
  }
}

/**
 * Farther from the eye, along the line of sight: outlines stay, and cloth that lies on a body hides it,
 * though its straight edges cut into it.
 */
function pushBack(material, distance) {
  material.onBeforeCompile = (shader) => {
    shader.uniforms.pushedBy = { value: distance };
    shader.vertexShader = shader.vertexShader
      .replace('#include <common>', 'uniform float pushedBy;\n#include <common>')
      .replace('#include <project_vertex>', `#include <project_vertex>
        vec4 pushed = mvPosition;
        pushed.xyz *= 1.0 + pushedBy / length(mvPosition.xyz);
        gl_Position = projectionMatrix * pushed;`);
  };
  return material;
}

class BodyView {
  constructor(body, material, sphere, smaller) {
    this.body = body;
    this.smaller = body.two_sided ? 0 : smaller;
    this.mesh = new Mesh(geometryOf(body, sphere, smaller), material);
    this.mesh.castShadow = body.shape !== 'plane';
    this.mesh.receiveShadow = true;
    this.mesh.frustumCulled = false;
  }

  show(sample, share) {
    const { poses, samples, triangles } = this.body;
    const read = (at) => ({
      position: new Vector3().fromArray(poses, 7 * at),
      rotation: new Quaternion().fromArray(poses, 7 * at + 3),
    });
    const from = read(sample);
    if (share > 0) {
      const to = read(sample + 1);
      from.position.lerp(to.position, share);
      from.rotation.slerp(to.rotation, share);
    }
    this.mesh.position.copy(from.position);
    this.mesh.quaternion.copy(from.rotation);
    if (!samples) return;
    const { position, normal } = this.mesh.geometry.attributes;
    blend(samples, sample, share, position.array);
    shrink(triangles, position.array, normal.array, this.smaller);
    position.needsUpdate = normal.needsUpdate = true;
  }
}

export class BodyViews {
  /** sphere: around all that the cloth does. edge: m, the mean length of one of the cloth. */
  constructor(bodies, sphere, edge) {
    const pushedBy = PUSHED_EDGES * edge;
    // The offset is larger than that of the cloth, which would go through a floor that is seen at a flat angle.
    const offset = { polygonOffset: true, polygonOffsetFactor: 2, polygonOffsetUnits: 2 };
    const material = (side) => pushBack(new MeshStandardMaterial({ roughness: 0.6, metalness: 0, side, ...offset }), pushedBy);
    this.material = material(FrontSide);
    this.twoSided = material(DoubleSide);
    this.views = bodies.map(
      (body) => new BodyView(body, body.two_sided || body.shape === 'plane' ? this.twoSided : this.material, sphere,
        SMALLER_EDGES * edge));
    this.group = new Group();
    for (const view of this.views) this.group.add(view.mesh);
  }
  show(sample, share) {
    for (const view of this.views) view.show(sample, share);
  }
  set colour(hex) {
    this.material.color.set(hex);
    this.twoSided.color.set(hex);
  }
}
