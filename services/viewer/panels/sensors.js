// A card for each sensor: what it sees, how fast, how old, and what is wrong in words.
import { html, number } from './html.js';
import { ageText } from '../state.js';

const STATE_CLASS = { live: 'good', connecting: 'warn', lost: 'bad', refused: 'bad' };

/// What stands on the card of one sensor.  Pure.
export function cardOf(id, sensor, registration) {
  const live = sensor.state === 'live';
  const moved = live && Boolean(sensor.alarm);
  const place = registration?.sensors?.[id] ?? registration?.unplaced?.[id];
  const placed = Boolean(registration?.sensors?.[id]);
  const radius = placed && Number.isFinite(place.presentRadius) ? `±${Math.round(1000 * place.presentRadius)} mm` : '';
  return {
    state: moved ? 'moved' : sensor.state ?? 'unknown',
    tone: moved ? 'bad' : STATE_CLASS[sensor.state] ?? '',
    facts: [
      ['sees', live ? sensor.bodies ?? '–' : '–'],
      ['rate', live ? `${number(sensor.rateHz, 1)} Hz` : '–'],
      ['age', ageText(sensor.ageMilliseconds)],
      ['share', live ? number(sensor.share, 2) : '–'],
      ['place', placed ? [place.verdict ?? 'known', radius].filter(Boolean).join(' ') : 'none'],
    ],
    words: [sensor.lastError, sensor.alarm, ...(placed ? [] : place?.reasons ?? [])].filter(Boolean),
  };
}

const swatch = (color) => `#${color.toString(16).padStart(6, '0')}`;

export function Sensors({ sensors, registration, colorOf, onLook }) {
  const all = Object.entries(sensors ?? {});
  return html`<section aria-labelledby="sensors-title" id="sensors">
    <h2 id="sensors-title">Sensors</h2>
    ${all.length === 0 && html`<p>none</p>`}
    ${all.map(([id, sensor]) => {
      const card = cardOf(id, sensor, registration);
      return html`<article key=${id} class="card ${sensor.state === 'live' ? '' : 'dead'}" data-sensor=${id} title=${sensor.url ?? ''}>
        <h3><svg class="swatch" viewBox="0 0 10 10" aria-hidden="true"><circle cx="5" cy="5" r="5" fill=${swatch(colorOf(id))} /></svg>
          <span class="id">${id}</span> <span class="state ${card.tone}">${card.state}</span>
          <button type="button" title="look at the room from where it stands" onClick=${() => onLook(id)}>look</button></h3>
        <dl>${card.facts.map(([name, value]) => html`<div key=${name}><dt>${name}</dt><dd data-fact=${name}>${value}</dd></div>`)}</dl>
        ${card.words.map((line) => html`<p class="bad" key=${line}>${line}</p>`)}
      </article>`;
    })}
  </section>`;
}
