// What happened: warnings and errors stay until somebody has seen them.
import { html, useState } from './html.js';

const MOST_LISTED = 100;
const KEPT = 500; // ids; the server keeps 2000 events of a day
const STORE = 'chorus.events.seen';

/// Events that stay: what is no calm news and was not seen.  Pure.
export const waiting = (events, seen) => (events ?? []).filter((event) => event.severity !== 'calm' && !seen.has(event.eventId));

/// Newest first, those that wait before all others, at most so many, but all that wait (of more than a hundred the newest).  Pure.
export function listed(events, seen, most = 12) {
  const newest = [...(events ?? [])].reverse();
  const urgent = waiting(newest, seen);
  return [...urgent, ...newest.filter((event) => !urgent.includes(event))].slice(0, Math.min(MOST_LISTED, Math.max(most, urgent.length)));
}

/// What was seen is remembered by this browser, if it lets us.
export function stored(storage = globalThis.localStorage) {
  try {
    return new Set(JSON.parse(storage.getItem(STORE) ?? '[]'));
  } catch {
    return new Set();
  }
}
function store(seen) {
  try {
    localStorage.setItem(STORE, JSON.stringify([...seen].slice(-KEPT)));
  } catch { /* then it is seen until the page is loaded again */ }
}

const clockTime = (iso) => (Number.isFinite(Date.parse(iso)) ? new Date(iso).toLocaleTimeString([], { hour: '2-digit', minute: '2-digit', second: '2-digit' }) : '–');
const TONES = { calm: 'faint', warning: 'warn', error: 'bad' };

function Row({ event, waits, onSeen }) {
  return html`<li class=${TONES[event.severity]}>
    <time datetime=${event.time}>${clockTime(event.time)}</time> <span class="what">${event.message}</span>
    ${waits && event.advice && html`<p>${event.advice}</p>`}
    ${waits && html`<button type="button" aria-label=${`seen: ${event.message}`} onClick=${() => onSeen([event.eventId])}>seen</button>`}</li>`;
}

export function Events({ events }) {
  const [seen, setSeen] = useState(stored);
  const onSeen = (ids) => {
    const next = new Set([...seen, ...ids]);
    setSeen(next);
    store(next);
  };
  const urgent = waiting(events, seen);
  return html`<section aria-labelledby="events-title">
    <h2 id="events-title">Events ${urgent.length > 0 && html`<strong id="unseen" class="warn">${urgent.length} unseen</strong>`}</h2>
    ${urgent.length > 1 && html`<button type="button" id="all-seen" onClick=${() => onSeen(urgent.map((event) => event.eventId))}>all seen</button>`}
    <div role="log" aria-label="what happened, what was not seen yet first"><ul id="events">
      ${listed(events, seen).map((event) => html`<${Row} key=${event.eventId} event=${event} waits=${urgent.includes(event)} onSeen=${onSeen} />`)}
    </ul></div>
    ${(events ?? []).length === 0 && html`<p class="faint">nothing has happened yet</p>`}
  </section>`;
}
