// The drawer "Work": things in hands, posture scores, and the upright stance from which angles count.
import { Action, Said, html, useEffect, useState } from './html.js';
import { request } from '../request.js';
import { ergonomicsBase, scoreText, stanceText } from '../work.js';

const EVERY_MS = 500;

const listed = (value) => (Array.isArray(value) ? value : Object.values(value ?? {}));

/// The document at `url`, again and again while the drawer is open; null: there is none.
function useDocument(url) {
  const [told, tell] = useState(null);
  useEffect(() => {
    let open = true;
    const ask = async () => {
      const answer = await fetch(url, { headers: { Accept: 'application/json' } }).catch(() => null);
      const found = answer?.ok ? await answer.json().catch(() => null) : null;
      if (open) tell(found);
      if (open) setTimeout(ask, EVERY_MS);
    };
    ask();
    return () => { open = false; };
  }, [url]);
  return told;
}

function Thing({ prop, people, resource, say }) {
  const path = (what) => resource(`props/${encodeURIComponent(prop.propName)}/${what}`);
  if (prop.heldBy !== undefined)
    return html`<div class="row"><span><strong>${prop.propName}</strong>: held by ${prop.heldBy}${prop.propTracked ? '' : ', who is not seen'}</span>
      <${Action} id=${`put-${prop.propName}`} label="Put down" run=${() => request(path('put-down'))} say=${say} /></div>`;
  return html`<div class="row"><span><strong>${prop.propName}</strong>: nobody holds it</span>
    ${people.map((person) => html`<${Action} key=${person} id=${`take-${prop.propName}-${person}`} label=${`Person ${person} takes it up`}
      run=${() => request(path('take-up'), { person })} say=${say} />`)}</div>`;
}

function Scored({ person, base, say }) {
  const stance = new URL(`ergonomics/${person.bodyId}/stance`, base).href;
  return html`<div class="row"><span><strong>Person ${person.bodyId}</strong>
      ${person.unscored ? `not scored: ${person.unscored}` : listed(person.scores).map(scoreText).join(', ')}; ${stanceText(person)}</span>
    <${Action} id=${`stance-${person.bodyId}`} label="Upright stance" title="stand upright, arms down, for two seconds"
      run=${() => request(stance)} say=${say} /></div>`;
}

export function Work({ frame, resource }) {
  const [said, say] = useState('');
  const base = ergonomicsBase(location.href, resource(''));
  const props = listed(useDocument(resource('props/'))?.props);
  const scores = useDocument(new URL('ergonomics/', base).href);
  const people = (frame?.bodies ?? []).map(({ bodyId }) => bodyId);
  return html`<div id="work">
    ${props.map((prop) => html`<${Thing} key=${prop.propName} prop=${prop} people=${people} resource=${resource} say=${say} />`)}
    ${props.length === 0 && html`<p>No things: the configuration names none (props).</p>`}
    ${scores ? listed(scores.persons).map((person) => html`<${Scored} key=${person.bodyId} person=${person} base=${base} say=${say} />`)
      : html`<p>No posture scores at ${base} (chorus-ergonomics; ?ergonomics=URL names another address).</p>`}
    <${Said} id="work-said" text=${said} />
  </div>`;
}
