// The hall from above: cells and people of /site/cells/ and /site/people/ as shapes.  Pure.

const MARGIN = 2; // [m]
const TRAIL_MS = 10000;
const ROOM = 2.5; // drawn half width of a cell [m]

/// A JSON container whose members are an object by id, or a list.
const membersOf = (value, key) => (Array.isArray(value) ? value.map((one) => [one[key], one]) : Object.entries(value ?? {}));

export const cellsOf = (told) => membersOf(told?.siteCells, 'cellId').map(([id, cell]) => ({ id: String(id).replace(/^#/, ''), ...cell }));
export const peopleOf = (told) => membersOf(told?.sitePeople, 'siteId').map(([id, person]) => ({ id: String(id).replace(/^#/, ''), ...person }));

/// The part of the floor that holds all of them, as an SVG viewBox; x to the right, z down.
export function boxOf(places) {
  const known = places.filter(({ x, z }) => Number.isFinite(x) && Number.isFinite(z));
  if (known.length === 0) return [-5, -5, 10, 10];
  const [xs, zs] = [known.map(({ x }) => x), known.map(({ z }) => z)];
  const [left, top] = [Math.min(...xs) - ROOM - MARGIN, Math.min(...zs) - ROOM - MARGIN];
  return [left, top, Math.max(...xs) + ROOM + MARGIN - left, Math.max(...zs) + ROOM + MARGIN - top];
}

/// Where people went in the last ten seconds, by site id; `now` [ms] of a steady clock.
export function trailsAfter(trails, people, now) {
  const next = new Map();
  for (const { id, x, z } of people) {
    const kept = (trails.get(id) ?? []).filter((point) => now - point.now <= TRAIL_MS);
    next.set(id, Number.isFinite(x) ? [...kept, { x, z, now }] : kept);
  }
  return next;
}

const TONES = { own: 'good', heard: 'good', silent: 'warn', mistrusted: 'bad' };
export const toneOf = (cell) => (cell.placed === false && cell.state !== 'own' ? 'warn' : TONES[cell.state] ?? '');

/// What is to be said of one cell, and what it needs.
export function wordsOf(cell, own) {
  const people = `${cell.people ?? 0} ${cell.people === 1 ? 'person' : 'people'}`;
  if (cell.state === 'silent') return 'has said nothing for two seconds: is its server running, and does it reach the broker?';
  if (cell.state === 'mistrusted') return `${people}; what it tells does not fit what others see: register it again`;
  if (cell.state !== 'own' && !cell.placed) return `${people}; nobody has walked from ${own} to ${cell.id} yet, so where it is is not known`;
  return people;
}

/// The address of another cell's page, or null.
export function pageOf({ address, state }) {
  return state !== 'own' && /^https?:/.test(address ?? '') && URL.canParse('viewer/', address) ? new URL('viewer/', address).href : null;
}

/// One sentence about the connection; `problem`: why this server does not tell of the hall, or ''.
export function connectionOf(told, problem = '') {
  if (problem) return { tone: 'bad', words: `This server tells nothing of the hall: ${problem}` };
  if (!told) return { tone: 'warn', words: 'Waiting for the hall …' };
  if (told.connected === false) return { tone: 'bad', words: `The broker is not reached: ${told.trouble ?? 'no reason is known'}. This cell goes on alone.` };
  const dropped = told.dropped > 0 ? ` ${told.dropped} messages were dropped.` : '';
  return { tone: 'good', words: `${told.siteName}: ${cellsOf(told).length} cells.${dropped}` };
}
