// Shows a recording in the scene, in the place of the room as it is now.
import { Playback, placesAt } from './playback.js';

const EVERY_MS = 33;
const TOLD_EVERY = 6; // the panel is told of each sixth step
const HEIGHT = 1.5; // where the only sensor of a recording without places is drawn [m]

const isOutline = (told) => Number.isFinite(told?.seconds) && Array.isArray(told.sensors);

export class Player {
  /// `io`: { fetchJson(path), onShown(playback | null), onFailed(words), onFrame(frame), onRaw(id, frame) }.
  constructor(room, io) {
    Object.assign(this, { room, io, playback: null, frame: null, placed: null, steps: 0, asked: 0 });
    setInterval(() => this.step(), EVERY_MS);
  }

  async open(name, at = 0) {
    this.asked += 1;
    const { asked } = this;
    const path = (what) => `recordings/${encodeURIComponent(name)}/${what}`;
    let outline;
    try {
      outline = await this.io.fetchJson(path('outline'));
    } catch (error) {
      if (asked === this.asked) this.io.onFailed(`${name} cannot be opened: ${error.message}`);
      return;
    }
    if (asked === this.asked && !isOutline(outline)) this.io.onFailed(`${name} cannot be opened: what the server says of it cannot be read`);
    if (asked !== this.asked || !isOutline(outline)) return; // another one was asked for, or none
    this.playback = new Playback(outline, ({ from, to, every }) => this.io.fetchJson(path(`stretch?from=${from}&to=${to}&every=${every}`)));
    [this.name, this.path, this.placed] = [name, path, null];
    this.io.onShown(this.told());
    this.clear();
    this.place(at);
    this.playback.seek(at);
  }

  close() {
    this.asked += 1;
    this.clear();
    this.playback = null;
    this.io.onShown(null);
  }

  async outlineAgain() {
    const { playback } = this;
    if (!playback) return;
    const outline = await this.io.fetchJson(this.path('outline')).catch(() => null);
    if (playback !== this.playback) return;
    if (outline) Object.assign(playback.outline, outline);
    this.io.onShown(this.told());
  }

  clear() {
    this.frame = null;
    this.io.onFrame({ bodies: [] });
    this.room.trails.clear();
    for (const id of this.room.sensors.keys()) this.io.onRaw(id, { bodies: [] });
  }

  /// Places the sensors as at this instant; `recorded`: the registration that was read with the frames.
  place(at, recorded) {
    const { registrations, single } = this.playback.outline;
    const alone = single && { sensors: { [single]: { x: 0, y: HEIGHT, z: 0, qx: 0, qy: 0, qz: 0, qw: 1 } } };
    const places = recorded ?? placesAt(registrations, at) ?? alone;
    const now = JSON.stringify(places?.sensors);
    if (now === this.placed || !places) return;
    this.placed = now;
    this.room.place(places);
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
    this.place(this.playback.at, now['/registration']);
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
