/** The canvas: one view, or two beside each other that one camera looks at. */

import {
  NeutralToneMapping, PCFShadowMap, PMREMGenerator, PerspectiveCamera, Vector3, WebGLRenderer,
} from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { RoomEnvironment } from 'three/addons/environments/RoomEnvironment.js';

const FIELD = 32; // degrees, of the narrower side

export class Picture {
  constructor(canvas, stages, sphere) {
    this.canvas = canvas;
    this.stages = stages;
    this.sphere = sphere;
    this.renderer = new WebGLRenderer({ canvas, antialias: true, alpha: true, preserveDrawingBuffer: true });
    this.renderer.toneMapping = NeutralToneMapping;
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.type = PCFShadowMap;
    this.renderer.setClearColor(0, 0);
    const room = new PMREMGenerator(this.renderer).fromScene(new RoomEnvironment(), 0.04).texture;
    for (const { scene } of stages) scene.environment = room;

    const { radius } = sphere;
    this.camera = new PerspectiveCamera(FIELD, 1, 0.02 * radius, 60 * radius);
    this.camera.up.copy(stages[0].up);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = true;
    this.controls.dampingFactor = 0.12;
    this.controls.minDistance = 0.2 * radius;
    this.controls.maxDistance = 20 * radius;
    this.reset();
  }

  /** The views, as boxes of the canvas in CSS pixels from its lower left corner. */
  get views() {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (this.stages.length === 1) return [[0, 0, width, height]];
    if (width >= height) {
      const half = Math.floor(width / 2);
      return [[0, 0, half, height], [width - half, 0, half, height]];
    }
    const half = Math.floor(height / 2);
    return [[0, height - half, width, half], [0, 0, width, half]];
  }

  reset() {
    const { center, radius } = this.sphere;
    const up = this.camera.up;
    const front = new Vector3().crossVectors(new Vector3(1, 0, 0), up);
    const towards = new Vector3(0.62, 0, 0).addScaledVector(up, 0.38).addScaledVector(front, 1).normalize();
    const distance = radius / Math.sin((FIELD / 2) * (Math.PI / 180));
    this.camera.position.copy(center).addScaledVector(towards, (this.stages.length > 1 ? 0.88 : 0.8) * distance);
    this.controls.target.copy(center);
    this.controls.update();
  }

  orbit(across, upward) {
    const offset = this.camera.position.clone().sub(this.controls.target);
    const side = new Vector3().crossVectors(this.camera.up, offset).normalize();
    offset.applyAxisAngle(this.camera.up, across);
    const lifted = offset.clone().applyAxisAngle(side, -upward);
    if (Math.abs(lifted.clone().normalize().dot(this.camera.up)) < 0.985) offset.copy(lifted);
    this.camera.position.copy(this.controls.target).add(offset);
    this.controls.update();
  }

  zoom(factor) {
    const offset = this.camera.position.clone().sub(this.controls.target);
    this.camera.position.copy(this.controls.target).addScaledVector(offset, factor);
    this.controls.update();
  }

  resize() {
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio || 1, 2));
    this.renderer.setSize(this.canvas.clientWidth, this.canvas.clientHeight, false);
  }

  draw() {
    const views = this.views;
    this.renderer.setScissorTest(views.length > 1);
    views.forEach(([x, y, width, height], index) => {
      if (width < 1 || height < 1) return;
      const aspect = width / height;
      this.camera.aspect = aspect;
      // The field is that of the narrower side.
      const half = Math.tan((FIELD / 2) * (Math.PI / 180)) / Math.min(1, aspect);
      this.camera.fov = (360 / Math.PI) * Math.atan(half);
      this.camera.updateProjectionMatrix();
      const { scene, lamp } = this.stages[index];
      lamp.position.copy(this.camera.position);
      this.renderer.setViewport(x, y, width, height);
      this.renderer.setScissor(x, y, width, height);
      this.renderer.render(scene, this.camera);
    });
  }
}
