// Who is there, each in the colour of the scene, and the figures of the tracker.
import { html, number } from './html.js';
import { colourOf, personLine } from '../certainty.js';
import { ageText, sidesOf } from '../state.js';

export function People({ frame, onLook }) {
  const bodies = frame?.bodies ?? [];
  return html`<section aria-labelledby="people-title">
    <h2 id="people-title">People</h2>
    <ul id="people" aria-label="people: seen or expected, and how sure left and right are">
      ${bodies.map((body) => html`<li key=${body.bodyId}>
        <button type="button" class="person" title="follow this person with the view" onClick=${() => onLook(body.bodyId)}>
          <svg class="swatch" viewBox="0 0 10 10" aria-hidden="true"><circle cx="5" cy="5" r="5" fill=${colourOf(body.bodyId)} /></svg>
          <span>${personLine(body)}</span></button></li>`)}
    </ul>
    ${bodies.length === 0 && html`<p>nobody</p>`}
  </section>`;
}

export function Tracker({ frame, rate, age }) {
  const facts = [
    ['bodies', frame?.bodies?.length ?? '–', ''],
    ['sides', sidesOf(frame), 'probability that left and right are not exchanged; of several people the least certain one'],
    ['rate', `${number(rate, 1)} Hz`, ''],
    ['age', ageText(age), 'of the newest fused frame'],
    ['sequence', frame?.sequence ?? '–', 'number of the frame'],
  ];
  return html`<section aria-labelledby="tracker-title">
    <h2 id="tracker-title">Fused tracker</h2>
    <dl>${facts.map(([id, value, title]) => html`<div key=${id} title=${title}><dt>${id}</dt><dd id=${id}>${value}</dd></div>`)}</dl>
  </section>`;
}
