// Dialogs: the token that allows changes, and what the keys do.
import { html, useEffect, useRef, useState } from './html.js';

export const KEYS = [['s', 'Sensors'], ['r', 'Register'], ['w', 'World'], ['e', 'Record'], ['l', 'Look at a recording'], ['space', 'play and pause'], ['p', 'Work'], ['c', 'Curves'], ['g', 'Hall, if this tracker is a cell of one'], ['v', 'View'], ['u', 'show the uncertainty'], ['i', 'show the axes of limbs that worn sensors judge'],
  ['a', 'from above'], ['h', 'the whole room'], ['t', 'light or dark'], ['?', 'this list'], ['Esc', 'close']];

export function Dialog({ label, onClose, children }) {
  const element = useRef(null);
  useEffect(() => { if (!element.current.open) element.current.showModal(); }, []);
  return html`<dialog ref=${element} aria-label=${label} onClose=${onClose}>${children}</dialog>`;
}

export function Keys({ onClose }) {
  return html`<${Dialog} label="keys" onClose=${onClose}>
    <h2>Keys</h2>
    <dl class="keys">${KEYS.map(([key, what]) => html`<div key=${key}><dt><kbd>${key}</kbd></dt><dd>${what}</dd></div>`)}</dl>
    <form method="dialog"><button>Close</button></form>
  </${Dialog}>`;
}

export function Token({ reason, onToken }) {
  const [token, setToken] = useState('');
  const answered = useRef(false);
  const answer = (value) => { if (!answered.current) { answered.current = true; onToken(value); } };
  return html`<${Dialog} label="token" onClose=${() => answer(null)}>
    <form method="dialog" onSubmit=${() => answer(token || null)}>
      <h2>The server asks for a token</h2>
      <p>${reason}</p>
      <label>token <input id="token" type="password" autocomplete="off" value=${token} onInput=${(event) => setToken(event.target.value)} /></label>
      <div class="row"><button id="token-send" class="primary">Send</button>
        <button type="button" id="token-cancel" onClick=${(event) => event.target.closest('dialog').close()}>Cancel</button></div>
    </form>
  </${Dialog}>`;
}
