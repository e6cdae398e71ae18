// Requests that change something, with the token that they need.
let token = null; // as typed on this page; kept in no storage

/// Sends a POST; a server that asks for a token gets one that is typed.  Resolves to the problem, or to '' where all is well.
export async function request(url, body = null, ask = (text) => window.prompt(text)) {
  const send = () => fetch(url, {
    method: 'POST',
    headers: { ...(body ? { 'Content-Type': 'application/json' } : {}), ...(token ? { Authorization: `Bearer ${token}` } : {}) },
    body: body ? JSON.stringify(body) : undefined,
  });
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
