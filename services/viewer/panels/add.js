// The drawer "Sensors": those that announce themselves, an address that is tried, and the file before it is saved.
import { Action, Said, html, useEffect, useState } from './html.js';
import { addressOf, freeId, wishOf } from '../setup.js';
import { requested } from '../request.js';

const TONES = { good: 'good', bad: 'bad', trying: 'faint' };

function Found({ setup, taken, say, resource, onTry }) {
  const search = () => requested(resource('setup/search')).then(({ problem }) => problem);
  return html`<section aria-labelledby="found-title">
    <h3 id="found-title">In this network</h3>
    <div class="row"><${Action} id="search" label="Search the network" disabled=${setup?.searching} run=${search} say=${say} />
      ${setup?.searching && html`<span role="status">searching …</span>`}</div>
    ${setup?.searchProblem && html`<p class="warn" id="search-problem">${setup.searchProblem}</p>`}
    ${(setup?.found ?? []).length > 0 ? html`<ul id="found" aria-label="sensors that announce themselves">
      ${setup.found.map(({ id, url, host }) => html`<li key=${url}><strong>${id}</strong> on ${host}
        ${taken.urls.includes(url) ? html` <span class="faint">is here already</span>`
    : html` <button type="button" aria-label=${`try ${id} at ${url}`} onClick=${() => onTry(url, id)}>Try</button>`}</li>`)}</ul>`
    : !setup?.searching && !setup?.searchProblem && html`<p class="faint">No sensor has announced itself. Type its address instead.</p>`}
  </section>`;
}

function Address({ tried, trial, taken, onTry, onChoose }) {
  const [typed, setTyped] = useState('');
  const [token, setToken] = useState('');
  const [id, setId] = useState('');
  const wanted = freeId(trial?.sensorId || tried?.id, taken.ids);
  useEffect(() => { if (tried?.url) setTyped(tried.url); }, [tried?.url]);
  useEffect(() => { setId(wanted); }, [wanted, tried?.url]);
  const send = (event) => {
    event.preventDefault();
    const url = addressOf(typed);
    if (url) onTry(url, null, token);
  };
  const choose = (event) => {
    event.preventDefault();
    onChoose({ id, url: tried.url, token });
    setTyped('');
    setToken('');
  };
  return html`<section aria-labelledby="address-title">
    <h3 id="address-title">By its address</h3>
    <form class="row" onSubmit=${send}>
      <label>address <input id="sensor-address" autocomplete="off" placeholder="192.168.1.20:8081" value=${typed} onInput=${(event) => setTyped(event.target.value)} /></label>
      <label>token, if it asks for one <input id="sensor-token" type="password" autocomplete="off" value=${token} onInput=${(event) => setToken(event.target.value)} /></label>
      <button id="try" disabled=${trial?.state === 'trying'}>Try</button>
    </form>
    <p id="trial" role="status" class=${TONES[trial?.state] ?? ''}>${trial?.state === 'trying' ? `Trying ${tried.url} …` : trial?.words ?? ''}</p>
    ${trial?.state === 'good' && !taken.urls.includes(tried.url) && html`<form class="row" onSubmit=${choose}>
      <label>its name here <input id="sensor-id" maxlength="64" pattern="[A-Za-z0-9_\\-]+" required value=${id} onInput=${(event) => setId(event.target.value)} /></label>
      <button id="choose" class="primary">Take it</button></form>`}
  </section>`;
}

function Chosen({ chosen, preview, onLeave, onSave, say }) {
  if (chosen.length === 0) return null;
  return html`<div class="columns"><section aria-labelledby="chosen-title">
    <h3 id="chosen-title">To be added</h3>
    <ul id="chosen">${chosen.map(({ id, url }) => html`<li key=${id}><strong>${id}</strong> ${url}${' '}
      <button type="button" aria-label=${`leave ${id} out`} onClick=${() => onLeave(id)}>leave out</button></li>`)}</ul>
    <${Action} id="save-sensors" kind="primary" label=${chosen.length === 1 ? 'Save and follow it' : `Save and follow these ${chosen.length}`} run=${onSave} say=${say} />
  </section>
    ${preview?.text && html`<section aria-labelledby="file-title"><h3 id="file-title">The file</h3><p>${preview.file ? html`This is what <code id="config-file">${preview.file}</code> will hold:`
    : 'The server keeps no state (state_dir): it follows them until it ends. It would write:'}</p>
      <pre id="preview" tabindex="0" aria-label="the configuration file as it will be">${preview.text}</pre></section>`}</div>`;
}

/// `setup`: /setup as served, or null.
export function AddSensors({ setup, sensors, resource }) {
  const [tried, setTried] = useState(null);
  const [chosen, setChosen] = useState([]);
  const [preview, setPreview] = useState(null);
  const [said, say] = useState('');
  const here = Object.entries(sensors ?? {});
  const taken = {
    ids: [...here.map(([id]) => id), ...Object.keys(setup?.silenced ?? {}), ...chosen.map(({ id }) => id)],
    urls: [...here.map(([, { url }]) => url), ...chosen.map(({ url }) => url)],
  };
  const attempt = async (url, id, token) => {
    say('');
    setTried({ url, id });
    const { problem } = await requested(resource('setup/try'), { url, ...(token ? { token } : {}) });
    if (problem) say(problem);
  };
  const show = async (next) => {
    setChosen(next);
    setPreview(null);
    if (next.length === 0) return;
    const { problem, body } = await requested(resource('setup/preview'), wishOf(next));
    if (problem) say(problem);
    setPreview(body);
  };
  const save = async () => {
    const { problem } = await requested(resource('sensors/'), wishOf(chosen));
    if (problem) return problem;
    setChosen([]);
    setPreview(null);
    setTried(null);
    return chosen.length === 1 ? `${chosen[0].id} is followed now.` : `${chosen.length} sensors are followed now.`;
  };
  const trial = tried && setup?.trials?.[tried.url];
  return html`<div id="add-sensors">
    <div class="columns">
      <${Found} setup=${setup} taken=${taken} say=${say} resource=${resource} onTry=${attempt} />
      <${Address} tried=${tried} trial=${trial} taken=${taken} onTry=${attempt} onChoose=${(one) => show([...chosen, one])} />
    </div>
    <${Chosen} chosen=${chosen} preview=${preview} say=${say} onSave=${save} onLeave=${(id) => show(chosen.filter((one) => one.id !== id))} />
    <${Said} id="setup-said" text=${said} />
  </div>`;
}
