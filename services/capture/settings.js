// What the page remembers: everything on this device for good, but the token only until the page is closed.

const KEY = 'chorus.capture';
const TOKEN_KEY = 'chorus.token';

/// A browser may forbid its storage; then nothing is remembered.
function kept(read) {
  try {
    return read();
  } catch {
    return null;
  }
}

/// {camera, model, rate, lenses: {CAMERA: {fov, sigma} or {calibration}}}
export function load(store = () => localStorage) {
  const known = kept(() => JSON.parse(store().getItem(KEY)));
  return { camera: '', model: 'movenet', rate: 30, ...known, lenses: { ...known?.lenses } };
}

/// A lens that was told before any camera was open, kept under '', belongs to the first one that opens.  True when there was one.
export function adoptLens(lenses, device) {
  const found = device !== '' && Object.hasOwn(lenses, '');
  if (found) {
    lenses[device] = lenses[''];
    delete lenses[''];
  }
  return found;
}

export function save(settings, store = () => localStorage) {
  kept(() => store().setItem(KEY, JSON.stringify(settings)));
}

export const loadToken = (store = () => sessionStorage) => kept(() => store().getItem(TOKEN_KEY)) ?? '';
export const saveToken = (token, store = () => sessionStorage) => kept(() => store().setItem(TOKEN_KEY, token));

/// "#token=abc&start&rate=5": what a link may bring along.  The part of an address after # never leaves the browser.
export function fromLink(hash) {
  const words = new URLSearchParams(hash.replace(/^#/, ''));
  const link = Object.fromEntries(['token', 'model'].filter((key) => words.has(key)).map((key) => [key, words.get(key)]));
  if (Number(words.get('rate')) > 0) link.rate = Number(words.get('rate'));
  return { ...link, start: words.has('start') };
}
