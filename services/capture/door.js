// Why the sensor does not let us in.  A WebSocket that is refused does not say; a POST without content does, and pushes nothing.

const ANSWER_WITHIN_MS = 5000;

/// {open, state, detail}: `state` is 'open', 'unreachable', 'token' (a token is needed, or this one is wrong), 'role' (the token
/// is right and allows too little) or 'tries' (too many wrong tokens).  `detail`: the sensor's own words.
export async function knock(url, token, ask = fetch) {
  let answer;
  try {
    const headers = token ? { Authorization: `Bearer ${token}` } : {};
    answer = await ask(url, { method: 'POST', body: '', headers, cache: 'no-store', credentials: 'omit', signal: AbortSignal.timeout(ANSWER_WITHIN_MS) });
  } catch {
    return { open: false, state: 'unreachable', detail: '' };
  }
  const state = { 401: 'token', 403: 'role', 429: 'tries' }[answer.status] ?? 'open';
  const problem = await answer.json().catch(() => ({}));
  return state === 'open' ? { open: true, state, detail: '' } : { open: false, state, detail: problem.detail ?? '' };
}
