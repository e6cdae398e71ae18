// A registration that waits to be accepted: what it would change for each sensor, and the two answers.
import { request } from './request.js';

const element = (id) => document.getElementById(id);
const millimetres = (value) => (Number.isFinite(value) ? `${(1000 * value).toFixed(0)} mm` : '–');
const degrees = (value) => (Number.isFinite(value) ? `${value.toFixed(1)}°` : '–');

/// Pure: one row of the table for each sensor.
export function rowsOf(proposal) {
  return (proposal.changes ?? []).map((change) => [change.sensorId, millimetres(change.presentRadius),
    millimetres(change.expectedRadius), millimetres(change.moves), degrees(change.turnsDegrees)]);
}

export function showProposal(proposal) {
  element('proposal').hidden = !proposal;
  if (!proposal) return;
  element('proposal-verdict').textContent = proposal.verdict ?? '';
  element('changes').replaceChildren(...rowsOf(proposal).map((cells) => {
    const row = document.createElement('tr');
    for (const text of cells) row.insertCell().textContent = text;
    return row;
  }));
}

/// `resource`: the URL of a resource by its path.  Who has answered sees what came of it with the next /registration.
export function offerDecision(resource) {
  for (const answer of ['accept', 'decline']) {
    element(answer).addEventListener('click', async () => {
      element('decision').textContent = await request(resource(`registration/${answer}`)).catch((error) => String(error.message));
    });
  }
}
