// The page on a phone: its address as a QR code.
import qrcode from 'qrcode-generator';

import { Dialog } from './dialogs.js';
import { html } from './html.js';

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
