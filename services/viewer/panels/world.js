// The drawer "World": where it begins and which way it looks.
import { Action, Said, html, useState } from './html.js';
import { showOrigin } from '../origin.js';
import { request } from '../request.js';

const finite = (text) => (Number.isFinite(Number(text)) ? Number(text) : 0);

export function World({ resource, onShown = () => {} }) {
  const [said, say] = useState('');
  const [place, setPlace] = useState({ x: 0, z: 0, yawDegrees: 0 });
  const shown = (problem) => {
    if (!problem) onShown();
    return problem;
  };
  const move = (by) => request(resource('registration/origin'), by).then(shown);
  const here = async () => {
    const told = await showOrigin(resource, say);
    if (told.startsWith('The world begins')) onShown();
    return told;
  };
  const field = (name, label) => html`<label>${label} <input type="number" step="any" id="origin-${name}" value=${place[name]}
    onInput=${(event) => setPlace({ ...place, [name]: event.target.value })} /></label>`;
  return html`<div>
    <p>One person stands where the world shall begin, facing its front. Scenes and marks move with it.</p>
    <div class="row">
      <${Action} id="origin" kind="primary" label="Origin here" run=${here} say=${say} />
      <${Action} id="turn-left" label="Turn by 90°" run=${() => move({ yawDegrees: 90 })} say=${say} />
      <${Action} id="turn-right" label="Turn by −90°" run=${() => move({ yawDegrees: -90 })} say=${say} />
    </div>
    <div class="row">
      ${field('x', 'x [m]')} ${field('z', 'z [m]')} ${field('yawDegrees', 'turn [°]')}
      <${Action} id="origin-move" label="Move the origin there"
        run=${() => move({ x: finite(place.x), z: finite(place.z), yawDegrees: finite(place.yawDegrees) })} say=${say} />
    </div>
    <${Said} id="origin-said" text=${said} />
  </div>`;
}
