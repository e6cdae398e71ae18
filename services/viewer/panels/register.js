// The drawer "Register": start a walk, see what it still needs, end or cancel it, decide, go back.
import { Action, Lines, Said, degrees, html, millimetres, number, useEffect, useRef, useState } from './html.js';
import { request } from '../request.js';
import { showCoverage } from '../coverage.js';
import { VERDICT_CLASS } from './verdict.js';

/// One row of the table of a proposal for each sensor.  Pure.
export function rowsOf(proposal) {
  return (proposal.changes ?? []).map((change) => [change.sensorId, millimetres(change.presentRadius),
    millimetres(change.expectedRadius), millimetres(change.moves), degrees(change.turnsDegrees)]);
}

/// What is against a better verdict: reasons of the registration, then those of the last walk.  Pure.
export function reasonsOf(registration) {
  const reasons = registration.reasons ?? [];
  const last = (registration.session?.reasons ?? []).filter((reason) => !reasons.includes(reason));
  const of = registration.session?.state === 'collecting' ? 'so far' : 'last walk';
  return [...reasons, ...last.map((reason) => `${of}: ${reason}`)];
}

/// What keeps the registration from surviving a restart, or ''.  Pure.
export function storeLine({ storeProblem = '', stored }) {
  return storeProblem && !stored ? `not stored: ${storeProblem}` : storeProblem;
}

const runs = (session) => session?.state === 'collecting' || session?.state === 'solving';

function Walk({ session, told, places }) {
  const map = useRef(null);
  const pairs = useRef(null);
  useEffect(() => { if (told && map.current) showCoverage(map.current, pairs.current, told, places); }, [told, places]);
  const line = session.state === 'solving' ? 'the walk is over: solving'
    : `watching the walk: ${number(session.elapsedSeconds)} of ${number(session.targetSeconds)} s`;
  return html`<div>
    <p id="session">${line}</p>
    <progress aria-label="how much of the walk is seen" max=${session.targetSeconds} value=${session.elapsedSeconds}></progress>
    <svg id="coverage" ref=${map} hidden role="img" aria-label="the walk from above: where it was seen, by how many sensors, and how the sensors are linked"></svg>
    <ul id="pairs" ref=${pairs} aria-label="what pairs of sensors saw together"></ul>
  </div>`;
}

function Start({ resource, say }) {
  const [seconds, setSeconds] = useState(30);
  const [adopt, setAdopt] = useState('at-once');
  const start = () => request(resource('registration'), { seconds: Number(seconds), adopt });
  return html`<div class="row">
    <label>seconds <input id="walk-seconds" type="number" min="5" max="600" value=${seconds} onInput=${(event) => setSeconds(event.target.value)} /></label>
    <label>result <select id="walk-adopt" value=${adopt} onChange=${(event) => setAdopt(event.target.value)}>
      <option value="at-once">is used at once</option><option value="when-accepted">waits for a decision</option></select></label>
    <${Action} id="walk" kind="primary" label="Start a walk" run=${start} say=${say} />
  </div>`;
}

function Proposal({ proposal, resource, say }) {
  return html`<div id="proposal">
    <p>The last walk gives new places. <span class="verdict ${VERDICT_CLASS[proposal.verdict] ?? ''}">${proposal.verdict}</span></p>
    <table>
      <thead><tr><th>sensor</th><th title="radius on the floor that holds its place with 95 %, as it is in use">now</th><th title="the same of the new place">new</th><th>moves</th><th>turns</th></tr></thead>
      <tbody id="changes">${rowsOf(proposal).map((cells) => html`<tr key=${cells[0]}>${cells.map((text) => html`<td>${text}</td>`)}</tr>`)}</tbody>
    </table>
    <${Lines} id="to-check" lines=${proposal.reasons} label="what speaks against them, or should be checked" />
    <${Action} id="accept" kind="primary" label="Accept" run=${() => request(resource('registration/accept'))} say=${say} />
    <${Action} id="decline" label="Keep the old" run=${() => request(resource('registration/decline'))} say=${say} />
  </div>`;
}

function Changes({ registration, resource, say }) {
  const placed = Object.keys(registration.sensors ?? {}).length > 0;
  return html`<div class="row">
    <${Action} id="undo" label="Undo" title="back to the registration before the last change; twice changes nothing" run=${() => request(resource('registration/undo'))} say=${say}
      disabled=${!registration.earlier} />
    <${Action} id="forget" label="Forget all places" confirm="Forget them: are you sure?" disabled=${!placed}
      run=${() => request(resource('registration'), null, 'DELETE')} say=${say} />
  </div>`;
}

export function Register({ registration, told, resource }) {
  const [said, say] = useState('');
  const session = registration?.session;
  if (!registration) return html`<p>Nothing is known of the registration yet.</p>`;
  return html`<div>
    <${Lines} id="awaits" lines=${registration.awaits} label="what is awaited" />
    ${registration.proposal && html`<${Proposal} proposal=${registration.proposal} resource=${resource} say=${say} />`}
    ${runs(session) ? html`<${Walk} session=${session} told=${told} places=${registration.sensors} />
      <${Action} id="cancel" label="Cancel the walk" run=${() => request(resource(session.progress.slice(1)), null, 'DELETE')} say=${say} />`
    : html`<${Start} resource=${resource} say=${say} />`}
    ${!runs(session) && html`<${Changes} registration=${registration} resource=${resource} say=${say} />`}
    <${Said} id="decision" text=${said} />
    <${Lines} id="reasons" lines=${reasonsOf(registration)} label="reasons" />
    <p id="stored">${storeLine(registration)}</p>
  </div>`;
}
