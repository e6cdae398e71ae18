// How well the places of the sensors are known, in one word.
import { html } from './html.js';

export const VERDICT_CLASS = { Good: 'good', Provisional: 'warn', Refused: 'bad', None: 'warn' };

export function Verdict({ registration }) {
  return html`<span id="verdict" class="verdict ${VERDICT_CLASS[registration?.verdict] ?? ''}">${registration?.verdict ?? '–'}</span>`;
}
