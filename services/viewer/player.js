// Shows a recording in the scene, in the place of the room as it is now.
import { Playback } from './playback.js';

const EVERY_MS = 33;
const TOLD_EVERY = 6; // the panel is told of each sixth step
const HEIGHT = 1.5; // where the only sensor of a recording without places is drawn [m]

export class Player {
  /// `io`: { fetchJson(path), onShown(playback | null), onFailed(words), onFrame(frame), onRaw(id, frame) }.
  constructor(room, io) {
    Object.assign(this, { room, io, playback: null, frame: null, placed: null, steps: 0 });
    setInterval(() => this.step(), EVERY_MS);
  }

  path(what) { return `recordings/${encodeURIComponent(this.name)}/${what}`; }

  async open(name, at = 0) {
    this.name = name;
    let outline;
    try {
      outline = await this.io.fetchJson(this.path('outline'));
    } catch (error) {
      return this.io.onFailed(`${name} cannot be opened: ${error.message}`);
    }
    this.playback = new Playback(outline, ({ from, to, every }) => this.io.fetchJson(this.path(`stretch?from=${from}&to=${to}&every=${every}`)));
    this.placed = null;
    this.clear();
    this.io.onShown(this.told());
    if (outline.registration) this.place(outline.registration);
    else if (outline.single) this.place({ sensors: { [outline.single]: { x: 0, y: HEIGHT, z: 0, qx: 0, qy: 0, qz: 0, qw: 1 } } });
    return this.playback.seek(at);
  }

  close() {
    this.clear();
    this.playback = null;
    this.io.onShown(null);
  }

  async outlineAgain() {
    if (!this.playback) return;
    const outline = await this.io.fetchJson(this.path('outline')).catch(() => null);
    if (outline && this.playback) Object.assign(this.playback.outline, outline);
    this.io.onShown(this.told());
  }

  clear() {
    this.frame = null;
    this.io.onFrame({ bodies: [] });
    this.room.trails.clear();
    for (const id of this.playback?.outline.sensors ?? []) this.io.onRaw(id, { bodies: [] });
  }

  place(registration) {
    if (JSON.stringify(registration.sensors) === this.placed) return;
    this.placed = JSON.stringify(registration.sensors);
    this.room.place(registration);
  }

  step() {
    const { playback } = this;
    if (!playback) return;
    const now = playback.tick();
    if (!playback.waiting) this.show(now);
    this.steps += 1;
    if (this.steps % TOLD_EVERY === 0) this.io.onShown(this.told());
  }

  show(now) {
    const { single, sensors } = this.playback.outline;
    if (now['/registration']) this.place(now['/registration']);
    const own = now['/frame'];
    if (single) this.io.onRaw(single, own ?? { bodies: [] });
    else {
      for (const id of sensors) this.io.onRaw(id, now[`/sensors/${id}/frame`] ?? { bodies: [] });
      const frame = own ?? { bodies: [] };
      if (frame !== this.frame) this.io.onFrame(frame);
      this.frame = frame;
    }
  }

  /// What the panel shows.
  told() {
    const { outline, at, playing, speed, waiting, problem } = this.playback;
    return { name: this.name, seconds: outline.seconds, marks: outline.marks ?? [], writable: Boolean(outline.writable), notes: outline.notes ?? [],
      cut: outline.cut, sensors: outline.sensors.map(String), at, playing, speed, waiting, problem };
  }
}
