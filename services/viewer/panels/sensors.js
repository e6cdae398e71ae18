// A card for each sensor: its picture, what it sees, how fast, how old, what is wrong in words, and what can be done about it.
import { Action, Said, html, number, useEffect, useState } from './html.js';
import { fetched, request } from '../request.js';
import { ageText } from '../state.js';

const STATE_CLASS = { live: 'good', connecting: 'warn', lost: 'bad', refused: 'bad' };
const PICTURE_EVERY_MS = 1000;
const REFUSED_EVERY_MS = 10000;

/// What stands on the card of one sensor.  Pure.
export function cardOf(id, sensor, registration) {
  const live = sensor.state === 'live';
  const moved = live && Boolean(sensor.alarm);
  const own = (all) => (Object.hasOwn(all ?? {}, id) ? all[id] : undefined); // a sensor may be called "constructor"
  const placed = Boolean(own(registration?.sensors));
  const place = own(registration?.sensors) ?? own(registration?.unplaced);
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
    words: [sensor.lastError, sensor.alarm, sensor.contested, ...(placed ? [] : place?.reasons ?? [])].filter(Boolean),
  };
}

const swatch = (color) => `#${color.toString(16).padStart(6, '0')}`;

/// The sensor's newest picture, once a second; or why there is none.
function Picture({ id, resource }) {
  const [seen, see] = useState({ address: null, words: 'asking for a picture …' });
  useEffect(() => {
    let open = true;
    let address = null;
    const ask = async () => {
      const next = await fetched(resource(`sensors/${encodeURIComponent(id)}/image`));
      if (!open) return;
      if (address) URL.revokeObjectURL(address);
      address = next.blob ? URL.createObjectURL(next.blob) : null;
      see({ address, words: next.problem });
      setTimeout(ask, next.blob || /being fetched/.test(next.problem) ? PICTURE_EVERY_MS : REFUSED_EVERY_MS);
    };
    ask();
    return () => {
      open = false;
      if (address) URL.revokeObjectURL(address);
    };
  }, [id]);
  if (!seen.address) return html`<p class="faint" role="status">${seen.words}</p>`;
  return html`<img class="picture" src=${seen.address} alt=${`what ${id} sees`} onError=${() => see({ address: null, words: 'what the server sends is no picture' })} />`;
}

function Doings({ id, known, resource }) {
  const [said, say] = useState('');
  const path = resource(`sensors/${encodeURIComponent(id)}`);
  const taken = () => request(path, null, 'DELETE');
  return html`<div class="row">
    <${Action} label="silence" ariaLabel=${`silence ${id}`} title="the tracker does without it until it is heard again" run=${() => request(path, { silenced: true }, 'PATCH')} say=${say} />
    <${Action} label="register again" ariaLabel=${`register ${id} again`} title="forget its place; the next walk finds it" run=${() => request(resource(`registration/sensors/${encodeURIComponent(id)}/again`))} say=${say} />
    ${known.setup?.added?.includes(id) && html`<${Action} label="take out" ariaLabel=${`take ${id} out`} confirm="take it out: sure?" run=${taken} say=${say} />`}
    <${Said} text=${said} /></div>`;
}

function Card({ id, sensor, known, act }) {
  const [shown, show] = useState({ picture: false, more: false });
  const card = cardOf(id, sensor, known.registration);
  const toggle = (what) => () => show({ ...shown, [what]: !shown[what] });
  return html`<article class="card ${sensor.state === 'live' ? '' : 'dead'}" data-sensor=${id} aria-label=${`sensor ${id}`} title=${sensor.url ?? ''}>
    <h3><svg class="swatch" viewBox="0 0 10 10" aria-hidden="true"><circle cx="5" cy="5" r="5" fill=${swatch(act.colorOf(id))} /></svg>
      <span class="id">${id}</span> <span class="state ${card.tone}">${card.state}</span></h3>
    ${shown.picture && html`<${Picture} id=${id} resource=${act.resource} />`}
    ${sensor.state !== 'recorded' && html`<dl>${card.facts.map(([name, value]) => html`<div key=${name} class=${name === 'place' ? 'whole' : ''}><dt>${name}</dt><dd data-fact=${name}>${value}</dd></div>`)}</dl>`}
    ${card.words.map((line) => html`<p class="bad" key=${line}>${line}</p>`)}
    <div class="row doings">
      <button type="button" title="look at the room from where it stands" aria-label=${`look from ${id}`} onClick=${() => act.onView('sensor', id)}>look</button>
      ${sensor.state !== 'recorded' && html`<button type="button" aria-pressed=${String(shown.picture)} aria-label=${`picture of ${id}`} onClick=${toggle('picture')}>picture</button>`}
      ${sensor.state !== 'recorded' && html`<button type="button" aria-expanded=${String(shown.more)} aria-label=${`more of ${id}`} onClick=${toggle('more')}>more</button>`}
    </div>
    ${shown.more && html`<${Doings} id=${id} known=${known} resource=${act.resource} />`}
  </article>`;
}

function Silenced({ id, url, resource }) {
  const [said, say] = useState('');
  return html`<article class="card dead" data-sensor=${id} aria-label=${`sensor ${id}`} title=${url}>
    <h3><span class="id">${id}</span> <span class="state warn">silenced</span></h3>
    <div class="row"><${Action} label="hear it again" ariaLabel=${`hear ${id} again`} run=${() => request(resource(`sensors/${encodeURIComponent(id)}`), { silenced: false }, 'PATCH')} say=${say} />
      <${Said} text=${said} /></div>
  </article>`;
}

export function Sensors({ known, act }) {
  const all = Object.entries(known.sensors ?? {});
  const silenced = Object.entries(known.setup?.silenced ?? {}).filter(([id]) => !Object.hasOwn(known.sensors ?? {}, id));
  return html`<section aria-labelledby="sensors-title" id="sensors">
    <h2 id="sensors-title">Sensors ${!act.playback.only && html`<button type="button" id="add" aria-label="add sensors" title="add sensors (key s)" onClick=${() => act.onDrawer('sensors')}>+</button>`}</h2>
    ${all.length === 0 && html`<p>none</p>`}
    ${all.map(([id, sensor]) => html`<${Card} key=${id} id=${id} sensor=${sensor} known=${known} act=${act} />`)}
    ${silenced.map(([id, url]) => html`<${Silenced} key=${id} id=${id} url=${url} resource=${act.resource} />`)}
  </section>`;
}
