// The models that come with Chorus: what each says about itself, its files, and how it is made.
import * as blazepose from './blazepose.js';
import * as hands from './hands.js';
import * as movenet from './movenet.js';

export const MODELS = {
  movenet: { hello: movenet.HELLO, files: movenet.FILES, make: (tf, models) => new movenet.MoveNet(tf, models) },
  'blazepose-lite': ofBlazePose('lite'),
  'blazepose-full': ofBlazePose('full'),
  hands: { hello: hands.HELLO, files: hands.FILES, make: (tf, models) => new hands.Hands(tf, models) },
};

function ofBlazePose(size) {
  return {
    hello: { name: `BlazePose ${size}`, ...blazepose.HELLO },
    files: blazepose.FILES[size],
    make: (tf, models) => new blazepose.BlazePose(tf, models, size),
  };
}

/// The first pass takes longer than all others, because the engine prepares itself.
export async function warmUp(network) {
  const side = 64;
  const image = { width: side, height: side, pixels: new Uint8Array(side * side * 3) };
  await network.bodies(image, 0);
  await network.hands?.(image);
}
