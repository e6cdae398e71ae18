// A registration that waits to be accepted: what it would change for each sensor, and the two answers.
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

let token = null; // as typed on this page; kept in no storage

/// Sends the answer; a server that asks for a token gets one that is typed.
async function decide(url, ask) {
  const send = () => fetch(url, { method: 'POST', headers: token ? { Authorization: `Bearer ${token}` } : {} });
  let answer = await send();
  if (answer.status === 401 || answer.status === 403) {
    token = ask('The token that allows changes:');
    if (token) answer = await send();
  }
  if (answer.ok) return '';
  token = null;
  const problem = await answer.json().catch(() => ({}));
  return problem.detail ?? `the server answered ${answer.status}`;
}

/// `resource`: the URL of a resource by its path.  Who has answered sees what came of it with the next /registration.
export function offerDecision(resource, ask = (text) => window.prompt(text)) {
  for (const answer of ['accept', 'decline']) {
    element(answer).addEventListener('click', async () => {
      element('decision').textContent = await decide(resource(`registration/${answer}`), ask).catch((error) => String(error.message));
    });
  }
}
