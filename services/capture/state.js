// One sentence for what the page is doing, and what to do about it.  Pure.

const many = (number, one, more) => (number === 1 ? `one ${one}` : `${number} ${more}`);

const CAMERA = {
  insecure: ['The browser gives no camera to this page.', 'It needs an address that begins with https://, or localhost. Give the sensor a certificate (chorus init certificate).'],
  asking: ['Waiting for the camera …', 'Allow this page to use it when the browser asks.'],
  denied: ['The camera is not allowed for this page.', 'Allow it in the browser’s settings for this address (the sign beside the address), and in those of the system. If this page does not go on by itself then, press Stop and Start.'],
  none: ['There is no camera.', 'Plug one in: it is taken as soon as it is there.'],
  absent: ['The chosen camera is not there.', 'Plug it in, or choose another one below.'],
  busy: ['The camera cannot be opened.', 'Does another program or another tab use it? End that; this page tries again.'],
  lost: ['The camera is gone.', 'Plug it in again: this page goes on by itself.'],
  silent: ['The camera gives no more pictures.', 'This page opens it anew. If that does not help: does another program use it, or is it covered by a privacy switch?'],
};

export const LINK = {
  unreachable: ['The sensor does not answer.', 'Is it running, and is this device in its network? This page tries again every second.'],
  token: ['The sensor wants a token.', 'Enter one of role “control” below: it stands in the configuration of the sensor, under http.tokens.'],
  wrong: ['The token is wrong.', 'Enter one of role “control” of this sensor: it stands in its configuration, under http.tokens.'],
  role: ['The token allows only reading.', 'Enter one of role “control” of this sensor: it stands in its configuration, under http.tokens.'],
  unset: ['The sensor takes frames from its own host only.', 'It has no token: give it one (chorus init writes a configuration with tokens), and enter that below.'],
  tries: ['Too many wrong tokens came from this device.', 'Wait ten seconds, then press Stop and Start.'],
  shut: ['The sensor does not take the connection.', 'Other programs may hold all places, or a proxy in between lets no WebSockets pass; this page tries again every second.'],
  connecting: ['Connecting to the sensor …', ''],
};

const said = (tone, [sentence, next], detail) => ({ tone, sentence, next: detail || next });

function ofTheLink({ state, detail }) {
  if (state === 'welcomed') return null;
  if (state === 'busy') {
    const next = 'One camera at a time holds a sensor. This one takes over as soon as the other has left or been silent for two seconds.';
    return { tone: 'warn', sentence: 'Another program holds this sensor.', next: detail ? `${detail}. ${next}` : next };
  }
  if (state === 'bye') return { tone: 'bad', sentence: 'The sensor has ended the connection.', next: `${detail}. This page tries again every second.` };
  return said(state === 'connecting' ? 'warn' : 'bad', LINK[state] ?? LINK.connecting, '');
}

/// known: {running, hidden, camera: {state, detail}, model: {state, detail}, lens, link: {state, detail}, people, rate, complaint, slept}
/// Returns {tone: 'good' | 'calm' | 'warn' | 'bad', sentence, next}.
export function stateOf(known) {
  const { camera, model, link } = known;
  if (camera.state === 'insecure') return said('bad', CAMERA.insecure);
  if (!known.running) return { tone: 'calm', sentence: 'Ready.', next: 'Press Start. Pictures stay on this device: it sends where joints are, and nothing else.' };
  if (CAMERA[camera.state]) return said(camera.state === 'asking' ? 'warn' : 'bad', CAMERA[camera.state], '');
  if (model.state === 'failed') return { tone: 'bad', sentence: 'The model cannot be loaded.', next: model.detail };
  if (known.lens) return { tone: 'bad', sentence: 'The calibration is for another picture.', next: known.lens };
  if (known.hidden && camera.state === 'off') return { tone: 'warn', sentence: 'Asleep: this page is hidden, its camera closed.', next: 'After five minutes nothing keeps the camera open. Come back to this page and it goes on.' };
  if (known.hidden) return { tone: 'warn', sentence: 'Asleep: this page is hidden.', next: 'Browsers give no pictures to hidden pages. Come back to it and it goes on.' };
  const gate = ofTheLink(link);
  if (gate?.tone === 'bad') return gate;
  if (model.state !== 'ready') return { tone: 'warn', sentence: 'Loading the model …', next: model.detail };
  if (gate) return gate;
  if (known.complaint) return { tone: 'warn', sentence: 'The sensor refuses frames.', next: known.complaint };
  const next = known.slept > 0 ? `This device was asleep for ${Math.round(known.slept)} s: let its screen stay on.` : '';
  if (known.people === null) return { tone: 'warn', sentence: 'Looking at the first picture …', next };
  if (known.people === 0) return { tone: 'calm', sentence: 'Live: nobody is in sight.', next: next || 'Whole bodies are found best, not against a window.' };
  return { tone: 'good', sentence: `Live: ${many(known.people, 'person', 'people')}, ${known.rate.toFixed(1)} Hz.`, next };
}

/// What getUserMedia's failure means.
export function cameraStateOf(error) {
  if (['NotAllowedError', 'SecurityError', 'PermissionDeniedError'].includes(error?.name)) return 'denied';
  if (['NotFoundError', 'OverconstrainedError', 'DevicesNotFoundError'].includes(error?.name)) return 'none';
  return 'busy';
}

/// Rate [1/s] and median age [ms] of what was sent within the last seconds.
export class Pace {
  constructor(span = 4000) {
    this.span = span;
    this.sent = [];
  }

  note(now, age) {
    this.sent.push({ now, age });
  }

  at(now) {
    this.sent = this.sent.filter((one) => now - one.now <= this.span);
    const { sent } = this;
    if (sent.length < 2) return { rate: 0, age: NaN };
    const ages = sent.map((one) => one.age).sort((a, b) => a - b);
    return { rate: ((sent.length - 1) * 1000) / Math.max(1, now - sent[0].now), age: ages[Math.floor(ages.length / 2)] };
  }
}
