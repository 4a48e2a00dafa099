/** The pointer takes hold of the cloth; where it finds none, it turns the camera. */

import { Plane, Raycaster, Vector2, Vector3 } from 'three';

const FASTEST = 4; // m/s, of what is held

export class Hand {
  /** page: has cloth, picture and stage. */
  constructor(page, canvas) {
    this.page = page;
    this.canvas = canvas;
    this.ray = new Raycaster();
    this.plane = new Plane();
    this.held = null;
    canvas.addEventListener('pointerdown', (event) => this.down(event), { capture: true });
    canvas.addEventListener('pointermove', (event) => this.move(event));
    for (const kind of ['pointerup', 'pointercancel']) canvas.addEventListener(kind, (event) => this.up(event));
  }

  aim(event) {
    const box = this.canvas.getBoundingClientRect();
    const at = new Vector2((event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height);
    this.ray.setFromCamera(new Vector2(2 * at.x - 1, 1 - 2 * at.y), this.page.picture.camera);
  }

  /** The corner of what the ray meets that is nearest to where it does. */
  find() {
    const { mesh, places } = this.page.stage.cloth;
    mesh.geometry.computeBoundingSphere();
    const [hit] = this.ray.intersectObject(mesh);
    if (!hit) return null;
    const { a, b, c } = hit.face;
    const away = (particle) => new Vector3().fromArray(places, 3 * particle).distanceTo(hit.point);
    return [a, b, c].sort((one, other) => away(one) - away(other))[0];
  }

  down(event) {
    if (this.held || event.button !== 0) return;
    this.aim(event);
    const particle = this.find();
    if (particle === null) return;
    this.page.picture.controls.enabled = false;
    this.canvas.setPointerCapture(event.pointerId);
    const place = new Vector3(...this.page.cloth.place(particle));
    this.plane.setFromNormalAndCoplanarPoint(this.page.picture.camera.getWorldDirection(new Vector3()), place);
    this.page.cloth.hold(particle);
    this.held = { particle, pointer: event.pointerId, place, target: place.clone() };
    document.body.dataset.held = particle;
  }

  move(event) {
    if (this.held?.pointer !== event.pointerId) return;
    this.aim(event);
    const target = this.ray.ray.intersectPlane(this.plane, new Vector3());
    if (target) this.held.target.copy(target);
  }

  up(event) {
    if (this.held?.pointer !== event.pointerId) return;
    this.held = null;
    delete document.body.dataset.held;
    this.page.picture.controls.enabled = true;
    this.page.cloth.letGo();
  }

  /** Before a step: what is held follows the pointer. */
  lead(dt) {
    if (!this.held) return;
    const way = this.held.target.clone().sub(this.held.place).clampLength(0, FASTEST * dt);
    this.held.place.add(way);
    this.page.cloth.drag(this.held.place.toArray());
  }

  /** Another cloth has no hold. */
  drop() {
    this.held = null;
    delete document.body.dataset.held;
    this.page.picture.controls.enabled = true;
  }
}
