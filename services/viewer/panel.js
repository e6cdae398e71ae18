// The words beside the picture.

const element = (id) => document.getElementById(id);
const number = (value, digits = 0) => (Number.isFinite(value) ? value.toFixed(digits) : '–');
const STATE_CLASS = { live: 'good', connecting: 'warn', lost: 'bad', refused: 'bad' };
const VERDICT_CLASS = { Good: 'good', Provisional: 'warn', Refused: 'bad', None: 'warn' };

/// Output rate over the last frames, by their own capture times.
const recent = [];
function rateOf(frame) {
  recent.push(Number(BigInt(frame.capturedNanoseconds) / 1000n) / 1e6);
  if (recent.length > 61) recent.shift();
  const span = recent.at(-1) - recent[0];
  return span > 0 ? (recent.length - 1) / span : NaN;
}

export function showFused(frame) {
  element('bodies').textContent = frame.bodies?.length ?? 0;
  element('rate').textContent = `${number(rateOf(frame), 1)} Hz`;
  element('age').textContent = `${number(Date.now() - Date.parse(frame.captured))} ms`;
  element('sequence').textContent = frame.sequence;
}

export function showLink(up, why = '') {
  const headline = element('headline');
  headline.textContent = up ? 'one virtual tracker, live' : `no answer from the fusion server: ${why}`;
  headline.className = up ? 'good' : 'bad';
}

function cell(row, text, className = '') {
  const td = row.insertCell();
  td.textContent = text;
  td.className = className;
  return td;
}

export function showSensors(all, colorOf) {
  const body = element('sensors');
  body.replaceChildren();
  for (const [id, sensor] of Object.entries(all)) {
    const row = body.insertRow();
    row.dataset.sensor = id;
    row.title = sensor.lastError ?? sensor.url ?? '';
    const swatch = document.createElement('span');
    swatch.className = 'swatch';
    swatch.style.background = `#${colorOf(id).toString(16).padStart(6, '0')}`;
    cell(row, '').append(swatch);
    cell(row, id);
    cell(row, sensor.state, STATE_CLASS[sensor.state] ?? '');
    cell(row, `${number(sensor.ageMilliseconds)} ms`);
    cell(row, `${number(sensor.rateHz, 1)}`);
    cell(row, sensor.bodies ?? '–');
    cell(row, number(sensor.weight, 2));
  }
}

export function showRegistration(registration) {
  const verdict = element('verdict');
  verdict.textContent = registration.verdict ?? '–';
  verdict.className = `verdict ${VERDICT_CLASS[registration.verdict] ?? ''}`;
  const session = registration.session;
  element('session').textContent =
    session?.state === 'collecting'
      ? `watching the walk: ${number(session.elapsedSeconds)} of ${number(session.targetSeconds)} s`
      : '';
  const items = (registration.reasons ?? []).map((reason) => {
    const li = document.createElement('li');
    li.textContent = reason;
    return li;
  });
  element('reasons').replaceChildren(...items);
}
