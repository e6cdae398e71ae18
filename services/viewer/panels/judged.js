// Which limbs worn sensors contradict; nothing at all where nobody judges the tracker.
import { html } from './html.js';
import { judgedLines } from '../judged.js';

export function Judged({ evaluation }) {
  if (!evaluation) return null;
  return html`<section aria-labelledby="judged-title">
    <h2 id="judged-title">Judged by worn sensors</h2>
    <div role="status"><ul id="judged" aria-label="limbs and what the sensors on them say">
      ${judgedLines(evaluation).map(({ tone, text }) => html`<li key=${text} class=${tone}>${text}</li>`)}
    </ul></div>
  </section>`;
}
