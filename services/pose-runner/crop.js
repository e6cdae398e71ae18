// A square part of an image, rotated and scaled to a model's input size.  It is black outside the image.

/// A square of `size` pixels of the image around (x, y), turned by `angle` [rad, clockwise in the image].
export const wholeImage = (width, height) => ({ x: width / 2, y: height / 2, size: Math.max(width, height), angle: 0 });

/// Maps a place in the square (0 to 1 each way) to the image's pixels.
export function toImage(square, u, v) {
  const [cos, sin] = [Math.cos(square.angle), Math.sin(square.angle)];
  const [du, dv] = [(u - 0.5) * square.size, (v - 0.5) * square.size];
  return [square.x + du * cos - dv * sin, square.y + du * sin + dv * cos];
}

/// The square scaled to `side` x `side` pixels: 3 values each, bilinear, times `scale`, in an array of type `Output`.
export function cropped({ width, height, pixels }, square, side, Output = Float32Array, scale = 1 / 255) {
  const out = new Output(side * side * 3);
  const step = square.size / side;
  const [dx, dy] = [step * Math.cos(square.angle), step * Math.sin(square.angle)];
  const [left, top] = toImage(square, 0.5 / side, 0.5 / side);
  for (let row = 0, at = 0; row < side; ++row) {
    // A pixel's value stands for its middle, half a pixel from its corner.
    let x = left - row * dy - 0.5;
    let y = top + row * dx - 0.5;
    for (let column = 0; column < side; ++column, at += 3, x += dx, y += dy) {
      if (x < -0.5 || y < -0.5 || x > width - 0.5 || y > height - 0.5) continue;
      sample(pixels, width, height, x, y, out, at, scale);
    }
  }
  return out;
}

function sample(pixels, width, height, x, y, out, at, scale) {
  const [x0, y0] = [Math.max(0, Math.floor(x)), Math.max(0, Math.floor(y))];
  const [x1, y1] = [Math.min(width - 1, x0 + 1), Math.min(height - 1, y0 + 1)];
  const [fx, fy] = [Math.max(0, x - x0), Math.max(0, y - y0)];
  const [a, b] = [(y0 * width + x0) * 3, (y0 * width + x1) * 3];
  const [c, d] = [(y1 * width + x0) * 3, (y1 * width + x1) * 3];
  for (let i = 0; i < 3; ++i) {
    const upper = pixels[a + i] + (pixels[b + i] - pixels[a + i]) * fx;
    const lower = pixels[c + i] + (pixels[d + i] - pixels[c + i]) * fx;
    out[at + i] = (upper + (lower - upper) * fy) * scale;
  }
}
