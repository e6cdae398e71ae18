// Who is there, each in the colour of the scene, and the figures of the tracker.
import { html, number, Said, useState } from './html.js';
import { colourOf, personLine } from '../certainty.js';
import { request } from '../request.js';
import { ageText, sidesOf } from '../state.js';

function Naming({ id, name, resource, onDone }) {
  const [text, setText] = useState(name ?? '');
  const [said, say] = useState('');
  const send = async (event) => {
    event.preventDefault();
    const problem = await request(resource(`people/${id}`), { name: text.trim() || null }, 'PATCH').catch((error) => String(error?.message ?? error));
    if (problem) say(problem);
    else onDone();
  };
  return html`<form class="row" onSubmit=${send} onKeyDown=${(event) => event.key === 'Escape' && onDone()}>
    <label>name <input class="person-name" maxlength="40" autocomplete="off" value=${text} ref=${(element) => element?.focus()}
      onInput=${(event) => setText(event.target.value)} /></label>
    <button class="primary">Save</button><button type="button" onClick=${onDone}>Cancel</button>
    <${Said} text=${said} /></form>`;
}

function Person({ body, known, recorded, resource, onLook }) {
  const [naming, setNaming] = useState(false);
  const name = known?.name;
  return html`<li>
    <button type="button" class="person" title="follow this person with the view" onClick=${() => onLook(body.bodyId)}>
      <svg class="swatch" viewBox="0 0 10 10" aria-hidden="true"><circle cx="5" cy="5" r="5" fill=${colourOf(body.bodyId)} /></svg>
      <span>${name && html`<strong class="name">${name}</strong>${', '}`}${personLine(body)}</span></button>
    ${!naming && !recorded && html`<button type="button" class="rename" aria-label=${`name ${name ?? `person ${body.bodyId}`}`} title="give this person a name" onClick=${() => setNaming(true)}>✎</button>`}
    ${naming && !recorded && html`<${Naming} id=${body.bodyId} name=${name} resource=${resource} onDone=${() => setNaming(false)} />`}</li>`;
}

/// `known`: /people/ by id; without it nobody has a name.  `recorded`: the bodies are of a recording, and their ids are those of others now.
export function People({ frame, known, recorded, resource, onLook }) {
  const bodies = frame?.bodies ?? [];
  return html`<section aria-labelledby="people-title">
    <h2 id="people-title">People</h2>
    <ul id="people" aria-label="people: seen or expected, and how sure left and right are">
      ${bodies.map((body) => html`<${Person} key=${body.bodyId} body=${body} known=${recorded ? null : known?.[body.bodyId]} recorded=${recorded} resource=${resource} onLook=${onLook} />`)}
    </ul>
    ${frame?.leftOut > 0 && html`<p class="warn">and ${frame.leftOut} more, who are not shown</p>`}
    ${bodies.length === 0 && html`<p>nobody</p>`}
  </section>`;
}

const WHOLE = ['sides', 'sequence']; // facts that need a line of their own

export function Tracker({ frame, rate, age }) {
  const facts = [
    ['sides', sidesOf(frame), 'probability that left and right are not exchanged; of several people the least certain one'],
    ['bodies', frame?.bodies?.length ?? '–', ''],
    ['rate', `${number(rate, 1)} Hz`, ''],
    ['age', ageText(age), 'of the newest fused frame'],
    ['sequence', frame?.sequence ?? '–', 'number of the frame'],
  ];
  return html`<section aria-labelledby="tracker-title">
    <h2 id="tracker-title">Fused tracker</h2>
    <dl>${facts.map(([id, value, title]) => html`<div key=${id} class=${WHOLE.includes(id) ? 'whole' : ''} title=${title}><dt>${id}</dt><dd id=${id}>${value}</dd></div>`)}</dl>
  </section>`;
}
