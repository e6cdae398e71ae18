// The drawer "Hall": the cells of the site from above, and people as they walk from one into the next.
import { html, useEffect, useState } from './html.js';
import { colourOf } from '../certainty.js';
import { boxOf, cellsOf, connectionOf, peopleOf, toneOf, trailsAfter, wordsOf } from '../hall.js';

const EVERY_MS = 200;

const jsonAt = (url) => fetch(url, { headers: { Accept: 'application/json' }, cache: 'no-store' }).then((answer) => (answer.ok ? answer.json() : null), () => null);

/// Cells, people and trails, again and again while the drawer is open.
function useHall(resource) {
  const [hall, tell] = useState({ told: null, people: [], trails: new Map() });
  useEffect(() => {
    let open = true;
    let trails = new Map();
    const ask = async () => {
      const [told, there] = await Promise.all([jsonAt(resource('site/cells/')), jsonAt(resource('site/people/'))]);
      if (!open) return;
      const people = peopleOf(there);
      trails = trailsAfter(trails, people, performance.now());
      tell({ told, people, trails });
      setTimeout(ask, EVERY_MS);
    };
    ask();
    return () => { open = false; };
  }, []);
  return hall;
}

function Cell({ cell }) {
  if (!Number.isFinite(cell.x)) return null;
  const turn = (-180 * 2 * Math.atan2(cell.qy ?? 0, cell.qw ?? 1)) / Math.PI;
  return html`<g transform="translate(${cell.x} ${cell.z})" class="cell ${toneOf(cell)}">
    <rect x="-2.5" y="-2.5" width="5" height="5" transform="rotate(${turn})" /><text y="-2.7" text-anchor="middle">${cell.id}</text></g>`;
}

function Person({ person, trail }) {
  const path = trail.map(({ x, z }, i) => `${i === 0 ? 'M' : 'L'}${x} ${z}`).join('');
  const colour = colourOf(person.bodyId ?? 0);
  return html`<g>${path && html`<path d=${path} stroke=${colour} />`}
    <circle cx=${person.x} cy=${person.z} r="0.25" fill=${colour} /><text x=${person.x + 0.4} y=${person.z + 0.15}>${person.id}</text></g>`;
}

export function Hall({ resource }) {
  const { told, people, trails } = useHall(resource);
  const cells = cellsOf(told);
  const seen = people.filter(({ x, z }) => Number.isFinite(x) && Number.isFinite(z));
  const { tone, words } = connectionOf(told);
  return html`<div id="hall-drawer" class="columns">
    <svg id="hall" role="img" aria-label="the hall from above: cells, people, and where they went" viewBox=${boxOf([...cells, ...seen]).join(' ')}>
      ${cells.map((cell) => html`<${Cell} key=${cell.id} cell=${cell} />`)}
      ${seen.map((person) => html`<${Person} key=${person.id} person=${person} trail=${trails.get(person.id) ?? []} />`)}
    </svg>
    <section aria-labelledby="hall-title"><h3 id="hall-title">Cells</h3>
      <p class=${tone} role="status">${words}</p>
      <ul id="cells">${cells.map((cell) => html`<li key=${cell.id}><strong class=${toneOf(cell)}>${cell.id}</strong> ${cell.state}: ${wordsOf(cell, told.cell)}
        ${/^https?:/.test(cell.address ?? '') && cell.state !== 'own' && html` <a href=${new URL('viewer/', cell.address).href}>its page</a>`}</li>`)}</ul>
      ${seen.length > 0 && html`<h3>People</h3><ul id="hall-people">${seen.map((person) => html`<li key=${person.id}>${person.id} in ${person.cell}${
        person.siteCertainty < 0.95 ? `, ${Math.round(100 * person.siteCertainty)} % certain who it is` : ''}</li>`)}</ul>`}
    </section></div>`;
}
