// The drawer "Hall": the cells of the site from above, and people as they walk from one into the next.
import { html, useEffect, useState } from './html.js';
import { colourOf } from '../certainty.js';
import { boxOf, cellsOf, connectionOf, pageOf, peopleOf, toneOf, trailsAfter, wordsOf } from '../hall.js';
import { Resource } from '../poll.js';

const EVERY_MS = 200;
const EVERY_AFTER_FAILURE_MS = 1000;

/// Cells, people and trails, again and again while the drawer is open.
function useHall(resource) {
  const [hall, tell] = useState({ told: null, cells: [], people: [], trails: new Map(), problem: '' });
  useEffect(() => {
    let open = true;
    const [cellsNow, peopleNow] = ['site/cells/', 'site/people/'].map((path) => new Resource(resource(path)));
    let [told, there, trails] = [null, null, new Map()];
    const ask = async () => {
      let problem = '';
      try {
        await Promise.all([cellsNow.next().then((next) => { told = next ?? told; }), peopleNow.next().then((next) => { there = next ?? there; })]);
        trails = trailsAfter(trails, peopleOf(there), performance.now());
        if (open) tell({ told, cells: cellsOf(told), people: peopleOf(there), trails, problem });
      } catch (error) {
        problem = String(error?.message ?? error);
        if (open) tell({ told: null, cells: [], people: [], trails, problem });
      }
      if (open) setTimeout(ask, problem ? EVERY_AFTER_FAILURE_MS : EVERY_MS);
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
  const { told, cells, people, trails, problem } = useHall(resource);
  const seen = people.filter(({ x, z }) => Number.isFinite(x) && Number.isFinite(z));
  const { tone, words } = connectionOf(told, problem);
  return html`<div id="hall-drawer" class="columns">
    <svg id="hall" role="img" aria-label="the hall from above: cells, people, and where they went" viewBox=${boxOf([...cells, ...seen]).join(' ')}>
      ${cells.map((cell) => html`<${Cell} key=${cell.id} cell=${cell} />`)}
      ${seen.map((person) => html`<${Person} key=${person.id} person=${person} trail=${trails.get(person.id) ?? []} />`)}
    </svg>
    <section aria-labelledby="hall-title"><h3 id="hall-title">Cells</h3>
      <p class=${tone} role="status">${words}</p>
      <ul id="cells">${cells.map((cell) => html`<li key=${cell.id}><strong class=${toneOf(cell)}>${cell.id}</strong> ${cell.state}: ${wordsOf(cell, told.cell)}
        ${pageOf(cell) && html` <a href=${pageOf(cell)}>its page</a>`}</li>`)}</ul>
      ${seen.length > 0 && html`<h3>People</h3><ul id="hall-people">${seen.map((person) => html`<li key=${person.id}>${person.id} in ${person.cell}${
        person.siteCertainty < 0.95 ? `, ${Math.round(100 * person.siteCertainty)} % certain who it is` : ''}</li>`)}</ul>`}
    </section></div>`;
}
