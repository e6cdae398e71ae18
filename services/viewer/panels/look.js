// The drawer "View": what is drawn, from where, and a picture of it.
import { html } from './html.js';

const SWITCHES = [
  ['raw', 'raw skeletons', ''],
  ['frusta', 'sensor frusta', ''],
  ['fused', 'fused skeletons', ''],
  ['trails', 'trails on the floor', 'where people went in the last ten seconds'],
  ['uncertainty', 'uncertainty', 'where each joint is with 95 % probability; point at a joint, or click it, to read its numbers, its age and each sensor’s share (key u)'],
];

export function Look({ switches, onSwitch, onView, onPicture }) {
  return html`<div>
    <div id="switches" class="row">${SWITCHES.map(([key, label, title]) => html`<label key=${key} title=${title}>
      <input type="checkbox" id="show-${key}" checked=${switches[key]} onChange=${(event) => onSwitch(key, event.target.checked)} /> ${label}</label>`)}</div>
    <div class="row">
      <button type="button" id="view-room" onClick=${() => onView('room')}>The room</button>
      <button type="button" id="view-above" onClick=${() => onView('above')}>From above</button>
      <button type="button" id="save-picture" onClick=${onPicture}>Save a picture</button>
    </div>
    <p class="faint">drag to turn, wheel to zoom, right button to move</p>
  </div>`;
}
