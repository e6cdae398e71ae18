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

const ANSWER_WITHIN_MS = 30000;

const send = (url, body, method) => fetch(url, {
  method,
  signal: AbortSignal.timeout(ANSWER_WITHIN_MS),
  headers: { ...(body ? { 'Content-Type': 'application/json' } : {}), ...(token ? { Authorization: `Bearer ${token}` } : {}) },
  body: body ? JSON.stringify(body) : undefined,
});

/// Sends it; a server that asks for a token gets one that is typed.  Resolves to { problem, body }: problem is '' where all is well.
export async function requested(...asked) {
  try {
    return await exchanged(...asked);
  } catch (error) {
    const slow = error?.name === 'TimeoutError';
    return { problem: slow ? `the server did not answer within ${ANSWER_WITHIN_MS / 1000} s` : 'the server does not answer', body: null };
  }
}

async function exchanged(url, body = null, method = 'POST') {
  let answer = await send(url, body, method);
  if (answer.status === 401 || answer.status === 403) {
    const { detail } = (await answer.clone().json().catch(() => null)) ?? {};
    const typed = await ask(detail ?? 'It allows changes.');
    if (typed) {
      token = typed;
      answer = await send(url, body, method);
    }
  }
  const said = await answer.json().catch(() => null);
  if (answer.ok) return { problem: '', body: said };
  if (answer.status === 401) token = null;
  return { problem: said?.detail ?? `the server answered ${answer.status}`, body: null };
}

/// The same, of which only the problem is of interest.
export const request = (...asked) => requested(...asked).then(({ problem }) => problem);

/// Reads something that is no JSON, with the token that is in use: { blob } or { problem }.
export async function fetched(url) {
  const answer = await fetch(url, { cache: 'no-store', headers: token ? { Authorization: `Bearer ${token}` } : {} }).catch(() => null);
  if (!answer) return { problem: 'the server does not answer' };
  if (answer.ok) return answer.blob().then((blob) => ({ blob }), () => ({ problem: 'the answer broke off' }));
  const { detail } = (await answer.json().catch(() => null)) ?? {};
  return { problem: detail ?? `the server answered ${answer.status}` };
}
