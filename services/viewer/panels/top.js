// One sentence of state, the next step, and alarms that stay until seen.
import { html, useState } from './html.js';

/// Alarms that were not acknowledged yet.  `seen`: texts that somebody has clicked away.
export function unseen(alarms, seen) {
  return (alarms ?? []).filter((alarm) => !seen.has(alarm));
}

export function Top({ state, alarms, warning, sceneTrouble, onKeys, onTheme, onPhone }) {
  const [seen, setSeen] = useState(new Set());
  const waiting = unseen(alarms, seen);
  return html`<header>
    <h1>Chorus</h1>
    <div class="sentence">
      <p id="headline" role="status" class=${state.tone}>${state.sentence}</p>
      <p id="next">${state.next}</p>
      ${sceneTrouble && html`<p id="scene-trouble" class="warn" role="status">${sceneTrouble}</p>`}
      ${warning && html`<p id="warning" class="warn" role="status">${warning}</p>`}
    </div>
    <nav aria-label="page">
      <button type="button" id="phone" title="open this page on a phone" onClick=${onPhone}>phone</button>
      <button type="button" id="theme" title="light or dark (key t)" onClick=${onTheme}>theme</button>
      <button type="button" id="keys" title="what the keys do (key ?)" onClick=${onKeys}>keys</button>
    </nav>
    ${waiting.length > 0 && html`<div id="alarms" role="alert"><ul aria-label="alarms">${waiting.map((alarm) => html`
      <li key=${alarm}>${alarm} <button type="button" onClick=${() => setSeen(new Set([...seen, alarm]))}>seen</button></li>`)}</ul></div>`}
  </header>`;
}
