// First run: which step somebody who has just started the server is at.  Pure.

export const STEPS = [['sensors', 'Add the sensors'], ['register', 'Walk'], ['world', 'Say where the world begins']];

/// The step that is next: the name of its drawer, or null when all is done.
/// `known`: sensors and registration as served; `originShown`: whether somebody has shown the origin.
export function stepOf({ sensors, registration, originShown }) {
  if (Object.keys(sensors ?? {}).length === 0) return 'sensors';
  const walks = ['collecting', 'solving'].includes(registration?.session?.state); // until then no origin can be shown
  if (registration?.verdict !== 'Good' || walks) return 'register';
  return originShown ? null : 'world';
}

/// An id that nobody has yet: what the sensor calls itself, else "sensor-1", "sensor-2" ...
export function freeId(wanted, taken) {
  if (wanted && !taken.includes(wanted)) return wanted;
  const stem = wanted || 'sensor';
  let number = wanted ? 2 : 1;
  while (taken.includes(`${stem}-${number}`)) number += 1;
  return `${stem}-${number}`;
}

/// An address as people type it, as a URL: "10.0.0.3", "kitchen:8081" and "http://kitchen:8081/" are one.
export function addressOf(typed) {
  const text = typed.trim();
  if (!text) return '';
  const whole = /^https?:\/\//i.test(text) ? text : `http://${text}`;
  try {
    const url = new URL(whole);
    if (!/:\d+(\/|$)/.test(whole.replace(/^https?:\/\//i, '')) && !/^https?:\/\//i.test(text)) url.port = '8081';
    return url.href;
  } catch {
    return whole; // the server says what is wrong with it
  }
}

/// What the server is asked to add.
export const wishOf = (chosen) => ({ sensors: chosen.map(({ id, url, token }) => ({ id, url, ...(token ? { token } : {}) })) });
