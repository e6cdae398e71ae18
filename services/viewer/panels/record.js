// The drawer "Record": start, stop, and what there is.
import { Action, Said, html, size, useState } from './html.js';
import { request } from '../request.js';

/// Newest first, at most so many.  Pure.
export function newest(recordings, most = 20) {
  return [...(recordings ?? [])].sort((a, b) => String(b.started ?? '').localeCompare(String(a.started ?? ''))).slice(0, most);
}

/// What is asked of the server, without what was left empty.  Pure.
export function wish({ name, seconds, raw, fused }) {
  return { ...(name ? { name } : {}), ...(Number(seconds) > 0 ? { seconds: Number(seconds) } : {}), raw, fused };
}

function Start({ resource, say }) {
  const [asked, setAsked] = useState({ name: '', seconds: '', raw: true, fused: true });
  const change = (key) => (event) => setAsked({ ...asked, [key]: event.target.type === 'checkbox' ? event.target.checked : event.target.value });
  return html`<div class="row">
    <label>name <input id="record-name" maxlength="64" pattern="[A-Za-z0-9_\\-]*" placeholder="the time" value=${asked.name} onInput=${change('name')} /></label>
    <label>seconds <input id="record-seconds" type="number" min="1" placeholder="until stopped" value=${asked.seconds} onInput=${change('seconds')} /></label>
    <label><input type="checkbox" checked=${asked.raw} onChange=${change('raw')} /> sensors</label>
    <label><input type="checkbox" checked=${asked.fused} onChange=${change('fused')} /> fused</label>
    <${Action} id="record" kind="primary" label="Record" run=${() => request(resource('recordings/'), wish(asked))} say=${say} />
  </div>`;
}

/// Names the present, for the phases of a task (`chorus score --task`).
function MarkNow({ path, say }) {
  const [text, setText] = useState('');
  return html`<label>now <input id="mark-text" maxlength="60" placeholder="takes the drill" value=${text} onInput=${(event) => setText(event.target.value)} /></label>
    <${Action} id="mark-now" label="Mark" disabled=${text.trim() === ''} run=${() => request(`${path}/marks`, { text: text.trim() })} say=${say} />`;
}

function Running({ recording, resource, say }) {
  const path = resource(`recordings/${encodeURIComponent(recording.name)}`);
  return html`<div class="row">
    <p class="bad">● recording <strong>${recording.name}</strong>: ${recording.frames} frames, ${size(recording.bytes)}${recording.dropped > 0 ? `, ${recording.dropped} dropped` : ''}</p>
    <${Action} id="stop" kind="primary" label="Stop" run=${() => request(path, null, 'DELETE')} say=${say} />
    <${MarkNow} path=${path} say=${say} />
  </div>`;
}

function Row({ recording, onLook }) {
  const files = recording.download ? [recording.download] : recording.files ?? [];
  const state = [recording.state, ...(recording.reasons ?? [])].join(': ');
  return html`<tr>
    <td>${recording.name} ${recording.state !== 'recording' && recording.state !== 'stopping' && html`<button type="button" aria-label=${`look at ${recording.name}`} onClick=${() => onLook(recording.name)}>look</button>`}</td><td class=${recording.state === 'failed' || recording.state === 'interrupted' ? 'bad' : ''}>${state}</td>
    <td>${recording.frames}</td><td>${size(recording.bytes)}</td>
    <td>${recording.state === 'stopping' ? 'being written' : files.map((file, i) => html`<a key=${file} href=${`..${file}`} download>${files.length > 1 ? `part ${i + 1}` : 'download'}</a> `)}</td>
  </tr>`;
}

export function Record({ recordings, problem, resource, onLook }) {
  const [said, say] = useState('');
  if (problem) return html`<p>${problem}</p>`;
  const running = (recordings ?? []).find(({ state }) => state === 'recording');
  return html`<div>
    ${running ? html`<${Running} recording=${running} resource=${resource} say=${say} />` : html`<${Start} resource=${resource} say=${say} />`}
    <${Said} id="record-said" text=${said} />
    ${(recordings ?? []).length > 0 && html`<table aria-label="recordings, newest first">
      <thead><tr><th>name</th><th>state</th><th>frames</th><th>size</th><th>file</th></tr></thead>
      <tbody id="recordings">${newest(recordings).map((recording) => html`<${Row} key=${recording.name} recording=${recording} onLook=${onLook} />`)}</tbody>
    </table>`}
  </div>`;
}
