// The strip above a drawer that leads somebody who starts afresh from step to step.
import { html } from './html.js';
import { STEPS, stepOf } from '../setup.js';

export function FirstRun({ known, onDrawer, onDone }) {
  if (!known.firstRun) return null;
  const now = stepOf(known);
  const at = STEPS.findIndex(([key]) => key === now);
  return html`<nav id="first-run" aria-label="first steps">
    <ol>${STEPS.map(([key, label], i) => html`<li key=${key} aria-current=${key === now ? 'step' : undefined}>
      <button type="button" class=${key === now ? 'primary' : ''} onClick=${() => onDrawer(key)}>${i + 1}. ${label}${at < 0 || i < at ? ' ✓' : ''}</button></li>`)}</ol>
    <button type="button" id="first-run-done" onClick=${onDone}>${now ? 'Skip the steps' : 'Done'}</button>
  </nav>`;
}
