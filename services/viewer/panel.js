// The text next to the picture.
import { personLine } from './certainty.js';
import { ageText, sidesOf } from './state.js';

const element = (id) => document.getElementById(id);
const number = (value, digits = 0) => (Number.isFinite(value) ? value.toFixed(digits) : '–');
const STATE_CLASS = { live: 'good', connecting: 'warn', lost: 'bad', refused: 'bad' };
const VERDICT_CLASS = { Good: 'good', Provisional: 'warn', Refused: 'bad', None: 'warn' };

export function showFused(frame, rate, age) {
  element('bodies').textContent = frame?.bodies?.length ?? '–';
  element('sides').textContent = sidesOf(frame);
  element('rate').textContent = `${number(rate, 1)} Hz`;
  element('age').textContent = ageText(age);
  element('sequence').textContent = frame?.sequence ?? '–';
}

/// `fresh`: 'live', 'stale' or 'gone'; the page loses its colours unless it is 'live'.
export function showState({ tone, sentence, next }, fresh) {
  const headline = element('headline');
  headline.textContent = sentence;
  headline.className = tone;
  element('next').textContent = next;
  document.body.dataset.fresh = fresh;
  document.title = tone === 'good' || tone === 'calm' ? 'Chorus viewer' : `${sentence} – Chorus viewer`;
}

function cell(row, text, className = '') {
  const td = row.insertCell();
  td.textContent = text;
  td.className = className;
  return td;
}

function showLines(id, lines) {
  const list = element(id);
  if (list.childElementCount === lines.length && lines.every((line, i) => list.children[i].textContent === line)) return;
  list.replaceChildren(...lines.map((line) => {
    const li = document.createElement('li');
    li.textContent = line;
    return li;
  }));
}

export function showSensors(all, colorOf) {
  const body = element('sensors');
  body.replaceChildren();
  for (const [id, sensor] of Object.entries(all)) {
    const live = sensor.state === 'live';
    const row = body.insertRow();
    row.dataset.sensor = id;
    row.className = live ? '' : 'dead';
    if (live && sensor.alarm) row.className = 'moved';
    row.title = sensor.url ?? '';
    const swatch = document.createElement('span');
    swatch.className = 'swatch';
    swatch.style.background = `#${colorOf(id).toString(16).padStart(6, '0')}`;
    cell(row, '').append(swatch);
    cell(row, id);
    cell(row, live && sensor.alarm ? 'moved' : sensor.state, live && sensor.alarm ? 'bad' : STATE_CLASS[sensor.state] ?? '');
    cell(row, ageText(sensor.ageMilliseconds));
    cell(row, live ? number(sensor.rateHz, 1) : '–');
    cell(row, live ? sensor.bodies ?? '–' : '–');
    cell(row, live ? number(sensor.share, 2) : '–');
  }
  showLines('errors', Object.entries(all)
    .filter(([, sensor]) => sensor.lastError)
    .map(([id, sensor]) => `${id}: ${sensor.lastError}`));
}

/// One line for each person.
export function showPeople(bodies) {
  showLines('people', bodies.map(personLine));
}

function sessionLine(session) {
  if (session?.state === 'solving') return 'the walk is over: solving';
  if (session?.state !== 'collecting') return '';
  return `watching the walk: ${number(session.elapsedSeconds)} of ${number(session.targetSeconds)} s`;
}

export function showRegistration(registration) {
  const verdict = element('verdict');
  verdict.textContent = registration.verdict ?? '–';
  verdict.className = `verdict ${VERDICT_CLASS[registration.verdict] ?? ''}`;
  element('session').textContent = sessionLine(registration.session);
  const reasons = registration.reasons ?? [];
  const last = (registration.session?.reasons ?? []).filter((reason) => !reasons.includes(reason));
  const of = registration.session?.state === 'collecting' ? 'so far' : 'last walk';
  showLines('reasons', [...reasons, ...last.map((reason) => `${of}: ${reason}`)]);
  showLines('alarms', registration.alarms ?? []);
  showLines('awaits', registration.awaits ?? []);
  const problem = registration.storeProblem ?? '';
  element('stored').textContent = problem && !registration.stored ? `not stored: ${problem}` : problem;
}
