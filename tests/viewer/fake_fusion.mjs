// The public JSON of a fake fusion server: one standing person who sways, two sensors. Tests the viewer alone; the system test shows it the
// real server. Its clock is an hour ahead of the browser's.
import { createServer } from 'node:http';
import { readFile } from 'node:fs/promises';
import { extname, join, normalize } from 'node:path';

const TYPES = { '.html': 'text/html', '.js': 'text/javascript', '.mjs': 'text/javascript', '.css': 'text/css' };
// Left is +x: the person looks along +z, away from sensor s1 and towards s2.
const STANDING = {
  SpineBase: [0, 0.95, 0], SpineMid: [0, 1.2, 0], SpineShoulder: [0, 1.42, 0], Neck: [0, 1.5, 0], Head: [0, 1.66, 0],
  ShoulderLeft: [0.18, 1.4, 0], ElbowLeft: [0.24, 1.12, 0], WristLeft: [0.26, 0.88, 0.05], HandLeft: [0.26, 0.82, 0.06],
  HandTipLeft: [0.26, 0.76, 0.07], ThumbLeft: [0.23, 0.82, 0.1], ShoulderRight: [-0.18, 1.4, 0],
  ElbowRight: [-0.24, 1.12, 0], WristRight: [-0.26, 0.88, 0.05], HandRight: [-0.26, 0.82, 0.06],
  HandTipRight: [-0.26, 0.76, 0.07], ThumbRight: [-0.23, 0.82, 0.1], HipLeft: [0.09, 0.92, 0], KneeLeft: [0.1, 0.5, 0.02],
  AnkleLeft: [0.1, 0.09, 0], FootLeft: [0.1, 0.03, 0.12], HipRight: [-0.09, 0.92, 0], KneeRight: [-0.1, 0.5, 0.02],
  AnkleRight: [-0.1, 0.09, 0], FootRight: [-0.1, 0.03, 0.12],
};

export const SENSORS = {
  s1: { x: 0, y: 1.2, z: -2.5, qx: 0, qy: 0, qz: 0, qw: 1 },
  s2: { x: 0, y: 1.2, z: 2.5, qx: 0, qy: 1, qz: 0, qw: 0 },
};

function toSensor(place, [x, y, z]) {
  const [dx, dy, dz] = [x - place.x, y - place.y, z - place.z];
  return place.qy === 1 ? [-dx, dy, -dz] : [dx, dy, dz];
}

/// 20 mm to the side, 10 mm up and 5 mm ahead, and no terms between: 95 % are within 56, 28 and 14 mm.
const COVARIANCE = { cxx: 0.0004, cxy: 0, cxz: 0, cyy: 0.0001, cyz: 0, czz: 0.000025 };

export const CLOCK_AHEAD_MS = 3600000;
const serverNow = () => Date.now() + CLOCK_AHEAD_MS;

function frame(sequence, place, about = {}, still = false, now = serverNow()) {
  const sway = still ? 0 : 0.4 * Math.sin(sequence / 20);
  const joints = Object.fromEntries(Object.entries(STANDING).map(([name, [x, y, z]]) => {
    const [jx, jy, jz] = place ? toSensor(place, [x + sway, y, z]) : [x + sway, y, z];
    const from = about.carriedFor === undefined ? { contributors: ['s1', 's2'], shares: [0.8, 0.2] } : { contributors: [], age: about.carriedFor };
    const fused = place ? {} : { ...COVARIANCE, ...from };
    return [name, { '@id': `skeletons/1#${name}`, x: jx, y: jy, z: jz, ...fused, state: name === 'FootLeft' ? 'Inferred' : 'Tracked' }];
  }));
  joints.ThumbRight = { '@id': 'skeletons/1#ThumbRight', state: 'NotTracked' };
  const times = { captured: new Date(now).toISOString(), capturedNanoseconds: `${now}000000` };
  return { '@id': 'frame', sequence, ...times, bodies: [{ '@id': 'skeletons/1', bodyId: 1, ...about, ...times, joints }] };
}

const LIVE = { state: 'live', ageMilliseconds: 12, rateHz: 30, bodies: 1, weight: 0.8, share: 0.97 };
const LOST = { state: 'lost', ageMilliseconds: 61000, rateHz: 30, bodies: 1, weight: 0, share: 0, lastError: 'connection refused' };

/// The same body several times, side by side.
function crowd(body, count) {
  return Array.from({ length: count }, (_, i) => ({ ...body, '@id': `skeletons/${i + 1}`, bodyId: i + 1,
    joints: Object.fromEntries(Object.entries(body.joints).map(([name, joint]) =>
      [name, Number.isFinite(joint.x) ? { ...joint, x: joint.x + 0.8 * (i - (count - 1) / 2), z: joint.z + 0.6 * (i % 2) } : joint])) }));
}

/// What one sensor sees.
function rawFrame(sequence, place, world) {
  const seen = frame(sequence, place);
  return world.crowded ? { ...seen, bodies: crowd(seen.bodies[0], world.people) } : seen;
}

/// The answers of the fake server; tests change them while it runs.
export function usualWorld() {
  return {
    people: 1,
    frozen: false,
    person: { sidesConfidence: 0.987 }, // what /frame says of the person beside the joints
    sensors: { s1: { ...LIVE, url: 'http://127.0.0.1/s1' }, s2: { ...LOST, url: 'http://127.0.0.1/s2' } },
    registration: { version: 1, verdict: 'Good', reasons: ['a reason with <b>markup</b>'], awaits: [], session: { state: 'idle', reasons: [] }, sensors: SENSORS },
  };
}
export const live = (extra) => ({ ...LIVE, ...extra });
export const lost = (extra) => ({ ...LOST, ...extra });

const RECORDED_HZ = 30;

/// What a recording of the swaying person holds between two instants.
function stretchOf({ seconds }, asked) {
  const [from, to, every] = ['from', 'to', 'every'].map((key) => Number(asked.get(key)));
  const messages = [];
  const step = Math.max(every, 1 / RECORDED_HZ);
  for (let at = Math.ceil(from / step) * step; at <= Math.min(to, seconds); at += step) {
    messages.push({ seconds: at, topic: '/sensors/s1/frame', message: frame(Math.round(RECORDED_HZ * at), SENSORS.s1) });
    messages.push({ seconds: at, topic: '/frame', message: frame(Math.round(RECORDED_HZ * at), null) });
  }
  return { from, to, messages };
}

/// Starts on a free port; `files` is the viewer's folder.
export async function startFakeFusion(files, world = usualWorld()) {
  let sequence = 1;
  let fused = null;
  const timer = setInterval(() => { sequence += world.frozen ? 0 : 1; }, 33);
  const current = () => {
    if (!world.frozen || !fused) fused = frame(sequence, null, world.person, world.still, serverNow() - (world.clockSetBack ?? 0));
    return { ...fused, bodies: world.people > 1 ? crowd(fused.bodies[0], world.people) : world.people > 0 ? fused.bodies : [] };
  };
  const answers = {
    '/frame': current,
    '/sensors/': () => ({ sensors: world.sensors }),
    '/registration': () => world.registration,
    '/': () => (world.evaluation ? { evaluation: 'evaluation' } : {}),
    '/evaluation': () => world.evaluation,
    '/healthz': () => world.health ?? { status: 'ok' },
    '/registration/sessions/7': () => world.session ?? {},
    '/people/': () => ({ people: world.known ?? {} }),
    '/events': () => ({ events: world.events ?? [] }),
    '/recordings/': () => ({ recordings: world.recordings ?? [] }),
    '/configuration': () => ({ inForce: world.site ? { site: { name: world.site.siteName } } : {} }),
    '/site/cells/': () => world.site ?? {},
    '/site/people/': () => ({ sitePeople: world.sitePeople ?? {} }),
    '/setup': () => ({ text: '', searching: false, found: [], trials: {}, added: [], silenced: {}, ...world.setup }),
  };
  const server = createServer(async (request, response) => {
    if (world.silent && !request.url.startsWith('/viewer/')) return; // it takes its time
    if (!request.url.startsWith('/viewer/') && await world.fault?.(request, response)) return; // it has answered, or never will
    const { pathname, searchParams } = new URL(request.url, 'http://localhost');
    if (['POST', 'PATCH', 'DELETE'].includes(request.method)) {
      let text = '';
      for await (const part of request) text += part;
      world.bodies = [...(world.bodies ?? []), text];
      const allowed = !world.token || request.headers.authorization === `Bearer ${world.token}`;
      const asked = request.method === 'POST' ? pathname : `${request.method} ${pathname}`;
      world.posted = [...(world.posted ?? []), `${asked} ${allowed ? 200 : 401}`];
      if (allowed) world.after?.(asked, text);
      if (allowed) delete world.registration.proposal;
      const refused = allowed && world.refuse?.(asked, text);
      response.writeHead(!allowed ? 401 : refused ? 409 : 200, { 'Content-Type': 'application/json' });
      const answer = world.answers?.[asked] ?? world.registration;
      return response.end(JSON.stringify(!allowed ? { detail: 'a token is needed' } : refused ? { detail: refused } : answer));
    }
    const recorded = /^\/recordings\/([^/]+)\/(outline|stretch)$/.exec(pathname);
    if (recorded) {
      const known = world.outlines?.[recorded[1]];
      if (world.recordingToken && request.headers.authorization !== `Bearer ${world.recordingToken}`) {
        response.writeHead(401, { 'Content-Type': 'application/json' });
        return response.end(JSON.stringify({ detail: 'a token of role images is needed' }));
      }
      response.writeHead(known ? 200 : 404, { 'Content-Type': 'application/json' });
      if (!known) return response.end(JSON.stringify({ detail: 'there is no recording of this name' }));
      world.stretches = (world.stretches ?? 0) + (recorded[2] === 'stretch');
      return response.end(JSON.stringify(recorded[2] === 'outline' ? known : stretchOf(known, searchParams)));
    }
    if (/^\/sensors\/[^/]+\/image$/.test(pathname)) {
      const picture = world.pictures?.[pathname.split('/')[2]];
      response.writeHead(picture ? 200 : 404, { 'Content-Type': picture ? 'image/svg+xml' : 'application/json' });
      return response.end(picture ?? JSON.stringify({ detail: 'images are switched off; set images: true' }));
    }
    if (world.pages?.[pathname]) {
      response.writeHead(200, { 'Content-Type': 'text/html' });
      return response.end(world.pages[pathname]);
    }
    const clock = `${serverNow() - (world.clockSetBack ?? 0)}000000`;
    const raw = /^\/sensors\/([^/]+)\/frame$/.exec(pathname)?.[1];
    if (raw && SENSORS[raw]) answers[pathname] = () => rawFrame(sequence, SENSORS[raw], world);
    else if (raw && world.sensors[raw]) answers[pathname] = () => rawFrame(sequence, SENSORS.s1, world);
    if (answers[pathname]) {
      const tag = pathname === '/frame' ? `"${sequence}"` : `"${Date.now()}"`;
      const unchanged = request.headers['if-none-match'] === tag;
      response.writeHead(unchanged ? 304 : 200, { 'Content-Type': 'application/json', ETag: tag, ...(world.noClock ? {} : { 'Chorus-Clock': `${clock} ${clock}` }) });
      const usual = answers[pathname]();
      const told = world.told?.[pathname] ? world.told[pathname](usual) : usual; // a text is sent as it is
      return response.end(unchanged ? '' : typeof told === 'string' ? told : JSON.stringify(told));
    }
    const inside = normalize(pathname.replace(/^\/viewer\//, '') || 'index.html');
    try {
      const body = await readFile(join(files, inside));
      response.writeHead(200, { 'Content-Type': TYPES[extname(inside)] ?? 'application/octet-stream' });
      response.end(body);
    } catch {
      response.writeHead(404).end();
    }
  });
  await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
  const { port } = server.address();
  return { port, world, current, url: `http://127.0.0.1:${port}/viewer/`, stop: () => { clearInterval(timer); server.closeAllConnections(); server.close(); } };
}
