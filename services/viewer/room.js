// The scene: floor, sensors with their raw skeletons, fused bodies, trails; and where it is looked at from.
import * as THREE from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';

import { framing, roomOf } from './framing.js';
import { EllipsoidView, FusedView, RawView, TrailView, frustum } from './skeleton_view.js';

const COLORS = [0x4cc9f0, 0xf2b84b, 0x80ed99, 0xf28482, 0xb892ff, 0xffd6a5, 0x2ec4b6, 0xff9f1c, 0xa0c4ff, 0xcaffbf];
const MOVED = 0x7d3b38; // a sensor that does not stand where it was registered
const DEAD = 0x4a5260;
const GROUNDS = { dark: [0x0d1117, 0x55606e, 0x262d36], light: [0xf2f4f7, 0x8a96a3, 0xd4dae1] };
const SHARPEST = 2; // most pixels of the scene for one of the page
const SLOW_MS = 60; // a picture that takes longer is drawn coarser

const NO_WEBGL = 'This browser draws nothing in three dimensions (WebGL): the room stays empty, everything else works.';
const LOST_WEBGL = 'The graphics of this browser are gone: the room is not drawn until they are back.';

/// Draws nothing, in a browser that cannot.
class NoRenderer {
  setPixelRatio() {}
  setSize() {}
  render() {}
  setAnimationLoop(draw) {
    const next = () => {
      draw();
      requestAnimationFrame(next);
    };
    next();
  }
}

/// Without a graphics card, smooth edges take half of the time of a picture.
function drawnByProcessor() {
  const gl = document.createElement('canvas').getContext('webgl');
  const info = gl?.getExtension('WEBGL_debug_renderer_info');
  const name = info ? gl.getParameter(info.UNMASKED_RENDERER_WEBGL) : '';
  gl?.getExtension('WEBGL_lose_context')?.loseContext();
  return /swiftshader|llvmpipe|software/i.test(name);
}

export class Room {
  /// `trouble`: why the room is not drawn, or ''.  `coarsens`: whether a slow machine draws with fewer pixels.
  constructor(canvas, { coarsens = true } = {}) {
    Object.assign(this, { canvas, coarsens, trouble: '' });
    this.renderer = this.rendererOf(canvas);
    this.ratio = Math.min(window.devicePixelRatio, SHARPEST);
    this.renderer.setPixelRatio(this.ratio);
    this.scene = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(45, 1, 0.05, 60);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = !window.matchMedia('(prefers-reduced-motion: reduce)').matches;
    this.sensors = new Map();
    this.fused = new FusedView();
    this.trails = new TrailView();
    this.ellipsoids = new EllipsoidView();
    this.places = [];
    this.followed = null;
    this.light();
    this.scene.add(this.fused.object, this.trails.object, this.ellipsoids.object);
    this.paintGround('dark');
    this.view('room');
  }

  rendererOf(canvas) {
    canvas.addEventListener('webglcontextlost', () => { this.trouble = LOST_WEBGL; });
    canvas.addEventListener('webglcontextrestored', () => { this.trouble = ''; });
    try {
      return new THREE.WebGLRenderer({ canvas, antialias: !drawnByProcessor(), preserveDrawingBuffer: true });
    } catch {
      this.trouble = NO_WEBGL;
      return new NoRenderer();
    }
  }

  light() {
    this.scene.add(new THREE.HemisphereLight(0xffffff, 0x30363d, 1.6));
    const sun = new THREE.DirectionalLight(0xffffff, 1.8);
    sun.position.set(2, 5, 3);
    this.scene.add(sun, new THREE.AxesHelper(0.4));
  }

  /// `theme`: 'dark' or 'light'.
  paintGround(theme) {
    const [ground, line, thin] = GROUNDS[theme];
    this.scene.background = new THREE.Color(ground);
    this.scene.fog = new THREE.Fog(ground, 9, 22);
    if (this.grid) this.scene.remove(this.grid);
    this.grid = new THREE.GridHelper(12, 12, line, thin);
    const { centre } = roomOf(this.places);
    this.grid.position.set(Math.round(centre.x), 0, Math.round(centre.z));
    this.scene.add(this.grid);
    this.fused.theme(theme);
  }

  colorOf(id) { return this.sensor(id).color; }

  /// The views of a sensor; made when it is first asked for.
  sensor(id) {
    if (this.sensors.has(id)) return this.sensors.get(id);
    const color = COLORS[this.sensors.size % COLORS.length];
    const view = { id, color, raw: new RawView(color), place: new THREE.Group(), wedge: frustum(color), live: false };
    view.place.visible = false;
    view.place.add(view.wedge, view.raw.object);
    this.scene.add(view.place);
    this.sensors.set(id, view);
    return view;
  }

  /// A sensor that delivers nothing is drawn in grey.
  paint(view, { state, alarm }) {
    const color = state === 'live' ? view.color : DEAD;
    view.wedge.traverse((part) => part.material?.color?.setHex(alarm ? MOVED : color));
  }

  place(registration) {
    const known = (pose) => pose && ['x', 'y', 'z', 'qx', 'qy', 'qz', 'qw'].every((key) => Number.isFinite(pose[key]));
    const places = Object.entries(registration.sensors ?? {}).filter(([, sensor]) => known(sensor) && sensor.polled !== false);
    for (const view of this.sensors.values()) view.place.visible = false; // one that lost its place is drawn nowhere
    for (const [id, pose] of places) {
      const view = this.sensor(id);
      view.place.position.set(pose.x, pose.y, pose.z);
      view.place.quaternion.set(pose.qx, pose.qy, pose.qz, pose.qw);
      view.place.visible = true;
    }
    const first = this.places.length === 0 && places.length > 0;
    this.places = places.map(([, pose]) => pose);
    if (first) this.view('room');
  }

  /// Looks at the room, from above, from a sensor's place, or follows a person; people may turn the view afterwards.
  view(from, which = null) {
    const { centre, reach } = roomOf(this.places);
    this.followed = from === 'person' ? which : null;
    if (from === 'sensor') return this.viewFrom(this.sensors.get(which));
    this.controls.target.set(centre.x, from === 'above' ? 0 : 0.9, centre.z);
    if (from === 'above') this.camera.position.set(centre.x, reach * 2.9, centre.z + 0.001);
    else this.camera.position.set(centre.x + reach * 1.15, 2.3 + reach * 0.45, centre.z + reach * 1.65);
    this.grid?.position.set(Math.round(centre.x), 0, Math.round(centre.z));
    return undefined;
  }

  viewFrom(sensor) {
    if (!sensor?.place.visible) return;
    const ahead = new THREE.Vector3(0, 0, 2.5).applyQuaternion(sensor.place.quaternion);
    this.camera.position.copy(sensor.place.position).addScaledVector(ahead, -0.06);
    this.controls.target.copy(sensor.place.position).add(ahead);
  }

  /// Keeps a followed person in the middle.
  follow(bodies) {
    const joint = bodies.find(({ bodyId }) => bodyId === this.followed)?.joints?.SpineBase;
    if (!joint || !Number.isFinite(joint.x)) return;
    const moved = new THREE.Vector3(joint.x, joint.y, joint.z).sub(this.controls.target);
    this.controls.target.add(moved);
    this.camera.position.add(moved);
  }

  /// `margins`: what the panels cover at each side of the canvas [px].
  fit(margins) {
    const [width, height] = [this.canvas.clientWidth, this.canvas.clientHeight];
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    const { fov, left, top } = framing(width, height, margins);
    this.camera.fov = fov;
    this.camera.setViewOffset(width, height, -left, -top, width, height);
    this.camera.updateProjectionMatrix();
  }

  /// A machine that draws slowly gets fewer pixels, so that the panels stay quick.  Returns whether the scene is drawn coarser.
  draw(switches) {
    for (const view of this.sensors.values()) {
      view.raw.object.visible = switches.raw;
      view.wedge.visible = switches.frusta;
    }
    this.fused.object.visible = switches.fused;
    this.trails.object.visible = switches.trails;
    this.controls.update();
    const begun = performance.now();
    this.renderer.render(this.scene, this.camera);
    this.took = 0.9 * (this.took ?? 0) + 0.1 * (performance.now() - begun);
    if (this.coarsens && this.took > SLOW_MS && this.ratio > 0.5) {
      this.ratio /= 2;
      this.took = 0;
      this.renderer.setPixelRatio(this.ratio);
    }
    return this.ratio < Math.min(window.devicePixelRatio, SHARPEST);
  }

  /// The scene as a PNG, as a data address.
  picture() {
    this.renderer.render(this.scene, this.camera);
    return this.canvas.toDataURL('image/png');
  }
}
