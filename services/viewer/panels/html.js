// The view library: Preact with htm, which needs no build step.
import { h, render } from 'preact';
import { useEffect, useErrorBoundary, useRef, useState } from 'preact/hooks';
import htm from 'htm';

export const html = htm.bind(h);
export { render, useEffect, useRef, useState };

export const number = (value, digits = 0) => (Number.isFinite(value) ? value.toFixed(digits) : '–');
export const millimetres = (value) => (Number.isFinite(value) ? `${(1000 * value).toFixed(0)} mm` : '–');
export const degrees = (value) => (Number.isFinite(value) ? `${value.toFixed(1)}°` : '–');

/// Bytes as people read them.
export function size(bytes) {
  if (!Number.isFinite(bytes)) return '–';
  const units = ['B', 'kB', 'MB', 'GB', 'TB'];
  const step = Math.min(units.length - 1, Math.max(0, Math.floor(Math.log10(Math.max(bytes, 1)) / 3)));
  return `${(bytes / 1000 ** step).toFixed(step === 0 ? 0 : 1)} ${units[step]}`;
}

/// A part of the page that is loaded when it is first shown.  `load`: resolves to the component.
export function Later({ load, ...own }) {
  const [view, show] = useState(null);
  useEffect(() => {
    let wanted = true;
    load().then((View) => wanted && show(() => View), () => wanted && show(() => Missing));
    return () => { wanted = false; };
  }, [load]);
  return view && html`<${view} ...${own} />`;
}
const Missing = () => html`<p class="bad" role="status">This part of the page cannot be loaded: the server does not answer.</p>`;

const AGAIN_MS = 2000;

/// A part of the page that may fail alone: it says so, and tries again.
export function Guarded({ children }) {
  const [error, again] = useErrorBoundary();
  useEffect(() => {
    if (!error) return undefined;
    const timer = setTimeout(again, AGAIN_MS);
    return () => clearTimeout(timer);
  }, [error]);
  return error ? html`<p class="bad" role="alert">This part of the page cannot show what the server says (${String(error.message ?? error)}). It tries again.</p>` : children;
}

/// A list of sentences; nothing at all when there are none.
export function Lines({ id, lines, label, kind = '' }) {
  if (!lines?.length) return null;
  return html`<ul id=${id} class=${kind} aria-label=${label}>${lines.map((line) => html`<li key=${line}>${line}</li>`)}</ul>`;
}

/// A button that sends something: disabled while it runs; says what went wrong through `say`.
export function Action({ id, label, ariaLabel, run, say, kind = '', confirm = null, title = '', disabled = false }) {
  const [busy, setBusy] = useState(false);
  const [asked, setAsked] = useState(false);
  const press = async () => {
    if (confirm && !asked) return setAsked(true);
    setAsked(false);
    setBusy(true);
    say('');
    try {
      say((await run()) || '');
    } catch (error) {
      say(String(error?.message ?? error));
    }
    return setBusy(false);
  };
  const text = asked ? confirm : label;
  return html`<button id=${id} type="button" aria-label=${asked ? undefined : ariaLabel} class=${asked ? 'bad' : kind} title=${title} disabled=${busy || disabled}
    onClick=${press} onBlur=${() => setAsked(false)}>${text}</button>`;
}

/// What the last action said, for eyes and screen readers.
export function Said({ id, text }) {
  return html`<p id=${id} role="status" class="said">${text}</p>`;
}
