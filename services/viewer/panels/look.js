// The drawer "View": what is drawn, from where, and a picture of it.
import { html } from './html.js';

const SWITCHES = [
  ['raw', 'raw skeletons', ''],
  ['frusta', 'sensor frusta', ''],
  ['fused', 'fused skeletons', ''],
  ['trails', 'trails on the floor', 'where people went in the last ten seconds'],
  ['uncertainty', 'uncertainty', 'where each joint is with 95 % probability; point at a joint, or click it, to read its numbers, its age and each sensor’s share (key u)'],
];
const OF_JUDGED = [['axes', 'axes of judged limbs', 'where worn sensors judge the tracker: x red, y (along the bone) green, z blue; short and thick as the tracker has the limb turned, long with a knob as the sensor has it; of a limb whose twist is not seen the bone alone (key i)']];

export function Look({ switches, judged = false, onSwitch, onView, onPicture }) {
  return html`<div>
    <div id="switches" class="row">${[...SWITCHES, ...(judged ? OF_JUDGED : [])].map(([key, label, title]) => html`<label key=${key} title=${title}>
      <input type="checkbox" id="show-${key}" checked=${switches[key]} onChange=${(event) => onSwitch(key, event.target.checked)} /> ${label}</label>`)}</div>
    <div class="row">
      <button type="button" id="view-room" onClick=${() => onView('room')}>The room</button>
      <button type="button" id="view-above" onClick=${() => onView('above')}>From above</button>
      <button type="button" id="save-picture" onClick=${onPicture}>Save a picture</button>
    </div>
    <p class="faint">drag to turn, wheel to zoom, right button to move</p>
  </div>`;
}
