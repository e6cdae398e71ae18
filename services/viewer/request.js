// Requests that change something, with the token that they need.
let token = null; // as typed on this page, or from its address; kept in no storage
let ask = async () => null;

/// `how`: resolves to the token that somebody types after `reason` was shown, or to null.
export function askFor(how) { ask = how; }
export const tokenInUse = () => token;

/// The token in the address of a page (#token=...), which is then taken out of the address.
export function takeToken(location, history) {
  const given = new URLSearchParams(location.hash.slice(1)).get('token');
  if (!given) return;
  token = given;
  history.replaceState(null, '', location.pathname + location.search);
}

const send = (url, body, method) => fetch(url, {
  method,
  headers: { ...(body ? { 'Content-Type': 'application/json' } : {}), ...(token ? { Authorization: `Bearer ${token}` } : {}) },
  body: body ? JSON.stringify(body) : undefined,
});

/// Sends it; a server that asks for a token gets one that is typed.  Resolves to the problem, or to '' where all is well.
export async function request(url, body = null, method = 'POST') {
  let answer = await send(url, body, method);
  if (answer.status === 401 || answer.status === 403) {
    const { detail } = await answer.clone().json().catch(() => ({}));
    const typed = await ask(detail ?? 'It allows changes.');
    if (typed) {
      token = typed;
      answer = await send(url, body, method);
    }
  }
  if (answer.ok) return '';
  if (answer.status === 401) token = null;
  const problem = await answer.json().catch(() => ({}));
  return problem.detail ?? `the server answered ${answer.status}`;
}
