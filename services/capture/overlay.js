// Draws what was found over the picture that it was found in.

const COLORS = ['#4cc9f0', '#f2b84b', '#80ed99', '#f28482', '#b892ff', '#ffd6a5'];
const LEAST = 0.3; // confidence of a landmark that is drawn strongly
// Pairs of landmarks, by layout (common/layout).
const BONES = {
  coco_17: [[5, 6], [5, 7], [7, 9], [6, 8], [8, 10], [5, 11], [6, 12], [11, 12], [11, 13], [13, 15], [12, 14], [14, 16], [0, 5], [0, 6]],
  mediapipe_33: [[11, 12], [11, 13], [13, 15], [12, 14], [14, 16], [11, 23], [12, 24], [23, 24], [23, 25], [25, 27], [24, 26], [26, 28],
    [27, 31], [28, 32], [27, 29], [28, 30], [15, 19], [16, 20], [0, 11], [0, 12]],
};

/// How the picture lies in a box of the same shape as `object-fit: contain` shows it.
export function fitted(box, picture) {
  const scale = Math.min(box.width / picture.width, box.height / picture.height);
  return { scale, x: (box.width - picture.width * scale) / 2, y: (box.height - picture.height * scale) / 2 };
}

export function bonesOf(layout) {
  return BONES[layout] ?? [];
}

export class Overlay {
  constructor(canvas) {
    this.canvas = canvas;
    this.context = canvas.getContext('2d');
  }

  /// `bodies` in pixels of `picture` {width, height}; none of both clears it.
  show(bodies = [], picture = { width: 1, height: 1 }, layout = '') {
    const { canvas, context } = this;
    const box = { width: canvas.clientWidth, height: canvas.clientHeight };
    const dense = Math.min(window.devicePixelRatio, 2);
    if (canvas.width !== Math.round(box.width * dense)) canvas.width = Math.round(box.width * dense);
    if (canvas.height !== Math.round(box.height * dense)) canvas.height = Math.round(box.height * dense);
    context.setTransform(dense, 0, 0, dense, 0, 0);
    context.clearRect(0, 0, box.width, box.height);
    const fit = fitted(box, picture);
    for (const body of bodies) this.#body(body, fit, bonesOf(layout));
  }

  #body({ id, pixels }, { scale, x, y }, bones) {
    const { context } = this;
    const at = ([u, v]) => [x + u * scale, y + v * scale];
    context.strokeStyle = context.fillStyle = COLORS[(id - 1) % COLORS.length];
    context.lineCap = 'round';
    context.lineWidth = 3;
    for (const [a, b] of bones) {
      if (!pixels[a] || !pixels[b]) continue;
      context.globalAlpha = Math.min(pixels[a][2], pixels[b][2]) >= LEAST ? 0.9 : 0.25;
      context.beginPath();
      context.moveTo(...at(pixels[a]));
      context.lineTo(...at(pixels[b]));
      context.stroke();
    }
    for (const pixel of pixels.filter(Boolean)) {
      context.globalAlpha = pixel[2] >= LEAST ? 1 : 0.25;
      context.beginPath();
      context.arc(...at(pixel), 3.5, 0, 2 * Math.PI);
      context.fill();
    }
    context.globalAlpha = 1;
  }
}
