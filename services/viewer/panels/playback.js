// The drawer "Look at a recording": timeline, speed, marks, and a part of it as a recording of its own.
import { Action, Said, html, useState } from './html.js';
import { request } from '../request.js';
import { timeText } from '../playback.js';

const SPEEDS = [0.25, 0.5, 1, 2, 4, 8];
const path = (resource, name, what) => resource(`recordings/${encodeURIComponent(name)}/${what}`);

/// Recordings that can be looked at, newest first.  Pure.
export function playable(recordings) {
  return (recordings ?? []).filter(({ state, files }) => state !== 'recording' && state !== 'stopping' && (files?.length ?? 1) > 0)
    .sort((a, b) => String(b.started ?? '').localeCompare(String(a.started ?? '')));
}

function Choose({ recordings, problem, onOpen }) {
  const all = playable(recordings);
  if (problem) return html`<p>${problem}</p>`;
  if (all.length === 0) return html`<p>There is no recording yet: make one under Record.</p>`;
  return html`<ul id="playable" class="row" aria-label="recordings, newest first">${all.slice(0, 20).map(({ name }) => html`<li key=${name}>
    <button type="button" aria-label=${`look at ${name}`} onClick=${() => onOpen(name)}>${name}</button></li>`)}</ul>`;
}

function Timeline({ shown, act }) {
  const { at, seconds, marks } = shown;
  return html`<div class="timeline">
    <svg viewBox="0 0 1000 10" preserveAspectRatio="none" aria-hidden="true">${marks.map(({ id, seconds: when }) => html`
      <rect key=${id} x=${(1000 * when) / Math.max(seconds, 0.001) - 1.5} y="0" width="3" height="10" />`)}</svg>
    <input id="scrub" type="range" min="0" max=${seconds} step="0.05" value=${at} aria-label="instant of the recording"
      aria-valuetext=${`${timeText(at)} of ${timeText(seconds)}`} onInput=${(event) => act.seek(Number(event.target.value))} />
  </div>`;
}

function Marks({ shown, resource, act, say }) {
  const [text, setText] = useState('');
  const send = async (event) => {
    event.preventDefault();
    const problem = await request(path(resource, shown.name, 'marks'), { seconds: shown.at, text: text.trim() });
    say(problem);
    if (!problem) setText('');
    act.again();
  };
  const remove = (id) => async () => {
    const problem = await request(path(resource, shown.name, `marks/${id}`), null, 'DELETE');
    act.again();
    return problem;
  };
  if (!shown.writable && shown.marks.length === 0) return null;
  return html`<section aria-labelledby="marks-title"><h3 id="marks-title">Marks</h3>
    ${shown.marks.length > 0 && html`<ul id="marks">${shown.marks.map((mark) => html`<li key=${mark.id}>
      <button type="button" onClick=${() => act.seek(mark.seconds)}>${timeText(mark.seconds)}</button> ${mark.text}
      ${shown.writable && html` <${Action} label="remove" ariaLabel=${`remove the mark ${mark.text}`} run=${remove(mark.id)} say=${say} />`}</li>`)}</ul>`}
    ${shown.writable && html`<form class="row" onSubmit=${send}>
      <label>mark ${timeText(shown.at)} as <input id="mark-text" maxlength="100" required autocomplete="off" value=${text} onInput=${(event) => setText(event.target.value)} /></label>
      <button id="mark">Mark</button></form>`}
  </section>`;
}

function Cut({ shown, resource, act, say }) {
  const [part, setPart] = useState({ from: 0, to: null, name: '' });
  const to = part.to ?? shown.seconds;
  const change = (facts) => setPart({ ...part, ...facts });
  const cut = async () => {
    const problem = await request(path(resource, shown.name, 'cut'), { from: part.from, to, name: part.name });
    act.again();
    return problem || `${part.name} is being made; it will be in the list.`;
  };
  return html`<section aria-labelledby="cut-title"><h3 id="cut-title">Cut</h3>
    <div class="row">
      <button type="button" id="cut-from" onClick=${() => change({ from: shown.at })}>from here</button> ${timeText(part.from)}
      <button type="button" id="cut-to" onClick=${() => change({ to: shown.at })}>to here</button> ${timeText(to)}
      <label>as <input id="cut-name" maxlength="64" pattern="[A-Za-z0-9_\\-]*" placeholder="name" value=${part.name} onInput=${(event) => change({ name: event.target.value })} /></label>
      <${Action} id="cut" label="Cut" run=${cut} say=${say} disabled=${!part.name || !(to > part.from)} />
    </div>
    ${shown.cut?.problem && html`<p class="bad">${shown.cut.name}: ${shown.cut.problem}</p>`}
  </section>`;
}

function Shown({ shown, resource, act }) {
  const [said, say] = useState('');
  return html`<div id="playback">
    <div class="row">
      <strong>${shown.name}</strong>
      <button type="button" id="play" class="primary" onClick=${act.toggle} title="space">${shown.playing ? 'Pause' : 'Play'}</button>
      <button type="button" aria-label="one second back" onClick=${() => act.seek(shown.at - 1)}>−1 s</button>
      <button type="button" aria-label="one second on" onClick=${() => act.seek(shown.at + 1)}>+1 s</button>
      <label>speed <select id="speed" value=${shown.speed} onChange=${(event) => act.speed(Number(event.target.value))}>
        ${SPEEDS.map((speed) => html`<option key=${speed} value=${speed}>${speed} ×</option>`)}</select></label>
      <span id="instant">${timeText(shown.at)} of ${timeText(shown.seconds)}</span>
      ${shown.waiting && html`<span class="faint" role="status">loading …</span>`}
      ${!act.only && html`<button type="button" id="close-playback" onClick=${act.close}>Back to the room as it is now</button>`}
    </div>
    <${Timeline} shown=${shown} act=${act} />
    ${shown.problem && html`<p class="bad" role="status">${shown.problem}</p>`}
    ${shown.notes.map((line) => html`<p class="warn" key=${line}>${line}</p>`)}
    <div class="columns"><${Marks} shown=${shown} resource=${resource} act=${act} say=${say} />
      ${shown.writable && html`<${Cut} shown=${shown} resource=${resource} act=${act} say=${say} />`}</div>
    <${Said} id="playback-said" text=${said} />
  </div>`;
}

/// `shown`: what is played, or null; `problem`: why nothing can be.
export function LookAt({ recordings, problem, shown, failed, resource, act }) {
  if (shown) return html`<${Shown} shown=${shown} resource=${resource} act=${act} />`;
  return html`<div><${Choose} recordings=${recordings} problem=${problem} onOpen=${act.open} />
    ${failed && html`<p class="bad" role="status">${failed}</p>`}</div>`;
}
