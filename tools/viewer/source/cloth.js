/** The cloth of a motion: its surface, with smooth normals, and the places of a moment. */

import {
  BufferAttribute, BufferGeometry, Color, DataTexture, DoubleSide, DynamicDrawUsage, LinearFilter,
  LineBasicMaterial, LineSegments, Mesh, MeshPhysicalMaterial, SRGBColorSpace,
} from 'three';
import { heatBytes } from './heat.js';
import { Seams, average, meanSide, piecesOf, shadeOf } from './pieces.js';

export function dynamic(array, size) {
  return new BufferAttribute(array, size).setUsage(DynamicDrawUsage);
}

/** The normals of vertices are the sums of those of their triangles, weighted by area. Those of a list are one. */
export function smoothNormals(triangles, places, normals, lists = []) {
  normals.fill(0);
  for (let t = 0; t < triangles.length; t += 3) {
    const a = 3 * triangles[t];
    const b = 3 * triangles[t + 1];
    const c = 3 * triangles[t + 2];
    const ux = places[b] - places[a], uy = places[b + 1] - places[a + 1], uz = places[b + 2] - places[a + 2];
    const vx = places[c] - places[a], vy = places[c + 1] - places[a + 1], vz = places[c + 2] - places[a + 2];
    const nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
    for (const p of [a, b, c]) {
      normals[p] += nx;
      normals[p + 1] += ny;
      normals[p + 2] += nz;
    }
  }
  average(lists, normals);
  for (let i = 0; i < normals.length; i += 3) {
    const length = Math.hypot(normals[i], normals[i + 1], normals[i + 2]) || 1;
    normals[i] /= length;
    normals[i + 1] /= length;
    normals[i + 2] /= length;
  }
}

const SHEEN = 0.25;
/** Ends of a seam that are nearer than this share of a side are drawn as one. */
const CLOSED = 0.1;

function heatTexture() {
  const bytes = heatBytes();
  const texture = new DataTexture(bytes, bytes.length / 4, 1);
  texture.colorSpace = SRGBColorSpace;
  texture.magFilter = texture.minFilter = LinearFilter;
  texture.needsUpdate = true;
  return texture;
}

/** Front and back have their own colour, and each piece its shade; with heat all have that of the stretch. */
function fabricMaterial(fabric) {
  const uniforms = {
    backColour: { value: new Color(fabric.back) },
    heatMap: { value: heatTexture() },
    heatRange: { value: 0.01 },
    heatShare: { value: 0 },
  };
  const material = new MeshPhysicalMaterial({
    color: fabric.front, side: DoubleSide, roughness: 0.82, sheen: SHEEN, sheenRoughness: 0.5,
    sheenColor: new Color(fabric.front).lerp(new Color(0xffffff), 0.5),
    polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1,
  });
  material.onBeforeCompile = (shader) => {
    Object.assign(shader.uniforms, uniforms);
    shader.vertexShader = shader.vertexShader
      .replace('#include <common>', `attribute float stretch, shade;
        varying float vStretch, vShade;
        #include <common>`)
      .replace('#include <begin_vertex>', 'vStretch = stretch;\nvShade = shade;\n#include <begin_vertex>');
    shader.fragmentShader = shader.fragmentShader
      .replace('#include <common>', `varying float vStretch, vShade;
        uniform vec3 backColour;
        uniform sampler2D heatMap;
        uniform float heatRange, heatShare;
        #include <common>`)
      .replace('#include <color_fragment>', `#include <color_fragment>
        if (!gl_FrontFacing) diffuseColor.rgb = backColour;
        diffuseColor.rgb *= vShade;
        vec3 heat = texture2D(heatMap, vec2(0.5 + 0.498 * clamp(vStretch / heatRange, -1.0, 1.0), 0.5)).rgb;
        diffuseColor.rgb = mix(diffuseColor.rgb, heat, heatShare);`);
  };
  material.userData.uniforms = uniforms;
  return material;
}

function edgesOf(triangles) {
  const seen = new Set();
  const ends = [];
  for (let t = 0; t < triangles.length; t += 3) {
    for (let k = 0; k < 3; ++k) {
      const a = triangles[t + k];
      const b = triangles[t + ((k + 1) % 3)];
      const key = Math.min(a, b) * 0x4000000 + Math.max(a, b);
      if (seen.has(key)) continue;
      seen.add(key);
      ends.push(a, b);
    }
  }
  return ends;
}

/** Where constraints make the cloth they are its edges, but for diagonals of cells, else the triangles. */
function wireOf(motion) {
  const { ends, yarns } = motion.links;
  if (ends.length === 0) return edgesOf(motion.triangles);
  const wire = [];
  for (let i = 0; i < yarns.length; ++i) if (yarns[i] >= 0) wire.push(ends[2 * i], ends[2 * i + 1]);
  return wire;
}

export class ClothView {
  constructor(motion, fabric) {
    this.motion = motion;
    this.seams = new Seams(motion.seams, CLOSED * meanSide(motion.triangles, motion.places[0]));
    const count = 3 * motion.particles;
    this.places = new Float32Array(count);
    this.normals = new Float32Array(count);
    this.stretch = new Float32Array(motion.particles);
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', dynamic(this.places, 3));
    geometry.setAttribute('normal', dynamic(this.normals, 3));
    geometry.setAttribute('stretch', dynamic(this.stretch, 1));
    const shades = Float32Array.from(piecesOf(motion.particles, motion.triangles), shadeOf);
    geometry.setAttribute('shade', new BufferAttribute(shades, 1));
    geometry.setIndex(new BufferAttribute(new Uint32Array(motion.triangles), 1));
    this.material = fabricMaterial(fabric);
    this.mesh = new Mesh(geometry, this.material);
    this.mesh.frustumCulled = false;
    this.mesh.castShadow = this.mesh.receiveShadow = true;

    this.wire = this.linesOf(wireOf(motion), new LineBasicMaterial({ transparent: true, opacity: 0.55 }));
    this.wire.visible = false;
    this.threads = this.linesOf(motion.lines, new LineBasicMaterial({ color: fabric.front }));
    this.objects = [this.mesh, this.wire, this.threads];
  }

  /** Between particles, whose places they share. */
  linesOf(ends, material) {
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', this.mesh.geometry.getAttribute('position'));
    geometry.setIndex(new BufferAttribute(new Uint32Array(ends), 1));
    const lines = new LineSegments(geometry, material);
    lines.frustumCulled = false;
    return lines;
  }

  /** Between two samples, in a straight line. */
  show(sample, share) {
    blend(this.motion.places, sample, share, this.places);
    blend(this.motion.stretch, sample, share, this.stretch);
    const lists = this.seams.closed(this.places);
    average(lists, this.places);
    smoothNormals(this.motion.triangles, this.places, this.normals, lists);
    for (const name of ['position', 'normal', 'stretch']) {
      this.mesh.geometry.getAttribute(name).needsUpdate = true;
    }
  }

  /** By its stretch, or in the colour of no stretch where coloured threads lie on it. */
  colourBy({ heat, heatRange, threads }) {
    const isPlain = heat || threads === 'yarns' || threads === 'colours';
    const { uniforms } = this.material.userData;
    uniforms.heatShare.value = isPlain ? 1 : 0;
    uniforms.heatRange.value = heat ? heatRange : 1e9;
    this.material.sheen = isPlain ? 0 : SHEEN;
  }
}

export function blend(samples, sample, share, into) {
  const from = samples[sample];
  if (share === 0) {
    into.set(from);
    return;
  }
  const to = samples[sample + 1];
  for (let i = 0; i < into.length; ++i) into[i] = from[i] + share * (to[i] - from[i]);
}
