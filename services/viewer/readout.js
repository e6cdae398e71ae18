// The read-out beside a joint: of the one under the pointer, or of the one that was clicked, until the next click or Escape.
import * as THREE from 'three';

const NEAR_PX = 16;
const STILL_PX = 4; // a click that moved further has turned the view

/// The joint nearest to a place on the screen: {bodyId, name, x, y}, or null when none is within NEAR_PX.
export function jointAt(bodies, toScreen, x, y) {
  let best = null;
  for (const body of bodies) {
    for (const [name, joint] of Object.entries(body.joints ?? {})) {
      if (joint.state === 'NotTracked' || !Number.isFinite(joint.x)) continue;
      const on = toScreen(joint);
      const distance = on ? Math.hypot(on.x - x, on.y - y) : Infinity;
      if (distance <= (best?.distance ?? NEAR_PX)) best = { bodyId: body.bodyId, name, distance, ...on };
    }
  }
  return best;
}

export class Readout {
  /// `box`: the element with the lines; `linesOf(body, name)`: what to say of a joint.
  constructor(canvas, camera, box, linesOf) {
    Object.assign(this, { canvas, camera, box, linesOf, pointer: null, pressed: null, chosen: null });
    canvas.addEventListener('pointermove', (event) => { this.pointer = [event.clientX, event.clientY]; });
    canvas.addEventListener('pointerleave', () => { this.pointer = null; });
    canvas.addEventListener('pointerdown', (event) => { this.pressed = [event.clientX, event.clientY]; });
    canvas.addEventListener('pointerup', (event) => this.click(event.clientX, event.clientY));
    window.addEventListener('keydown', (event) => { if (event.key === 'Escape') this.chosen = null; });
  }

  click(x, y) {
    const [fromX, fromY] = this.pressed ?? [Infinity, Infinity];
    if (Math.hypot(x - fromX, y - fromY) <= STILL_PX) this.chosen = jointAt(this.bodies ?? [], (joint) => this.toScreen(joint), x, y);
  }

  /// Where a place in the world is on the screen [px]; null behind the camera.
  toScreen({ x, y, z }) {
    const seen = new THREE.Vector3(x, y, z).project(this.camera);
    if (seen.z > 1) return null;
    return { x: ((seen.x + 1) / 2) * this.canvas.clientWidth, y: ((1 - seen.y) / 2) * this.canvas.clientHeight };
  }

  /// Called for each picture; `bodies` is empty while nothing is to be read out.
  show(bodies) {
    this.bodies = bodies;
    const toScreen = (joint) => this.toScreen(joint);
    const at = this.chosen ?? (this.pointer && jointAt(bodies, toScreen, ...this.pointer));
    const body = at && bodies.find(({ bodyId }) => bodyId === at.bodyId);
    const place = body && Number.isFinite(body.joints?.[at.name]?.x) ? toScreen(body.joints[at.name]) : null;
    this.box.hidden = !place;
    if (!place) return;
    this.box.textContent = this.linesOf(body, at.name).join('\n');
    this.box.style.left = `${place.x + 14}px`;
    this.box.style.top = `${place.y + 10}px`;
  }
}
