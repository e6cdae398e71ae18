// Dialogs: the token that allows changes, what the keys do, the page on a phone.
import qrcode from 'qrcode-generator';

import { html, useEffect, useRef, useState } from './html.js';

export const KEYS = [['s', 'Sensors'], ['r', 'Register'], ['w', 'World'], ['e', 'Record'], ['l', 'Look at a recording'], ['space', 'play and pause'], ['p', 'Work'], ['v', 'View'], ['u', 'show the uncertainty'],
  ['a', 'from above'], ['h', 'the whole room'], ['t', 'light or dark'], ['?', 'this list'], ['Esc', 'close']];

function Dialog({ label, onClose, children }) {
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

/// The address for a phone: this page, the token behind the '#', which no server and no log sees.  Pure.
export function phoneAddress(href, token) {
  const address = new URL(href);
  address.hash = token ? `token=${encodeURIComponent(token)}` : '';
  return address.href;
}

/// The path of a QR code's dark squares, and its size.  Pure.
export function squaresOf(text) {
  const code = qrcode(0, 'M');
  code.addData(text);
  code.make();
  const count = code.getModuleCount();
  let path = '';
  for (let row = 0; row < count; row += 1)
    for (let column = 0; column < count; column += 1) if (code.isDark(row, column)) path += `M${column} ${row}h1v1h-1z`;
  return { path, count };
}

export function Phone({ href, token, onClose }) {
  const address = phoneAddress(href, token);
  const { path, count } = squaresOf(address);
  const local = ['127.0.0.1', 'localhost', '[::1]'].includes(new URL(href).hostname);
  return html`<${Dialog} label="phone" onClose=${onClose}>
    <h2>This page on a phone</h2>
    <svg class="qr" role="img" aria-label="QR code of this page’s address" viewBox="-2 -2 ${count + 4} ${count + 4}"><path d=${path} /></svg>
    <p>${local ? 'This address is reachable only on this computer. Open the page by the server’s own address (http.bind), then ask again.' : new URL(href).host}</p>
    <form method="dialog"><button>Close</button></form>
  </${Dialog}>`;
}
