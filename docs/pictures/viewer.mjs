// Takes the picture of the viewer that the README shows:
//   deploy/demo.sh            (in another terminal; wait until the registration is good)
//   node docs/pictures/viewer.mjs http://127.0.0.1:8080/viewer/ docs/pictures/viewer.png
import { launch, openViewer } from '../../tests/viewer/browser.mjs';

const [url, file] = process.argv.slice(2);
if (!file) throw new Error('usage: node viewer.mjs URL FILE');
const browser = await launch();
const { page, complaints } = await openViewer(browser, url);
await page.waitForFunction(() => window.chorusViewer?.fusedFrames > 150, null, { timeout: 60000 });
await page.screenshot({ path: file });
await browser.close();
if (complaints.length > 0) throw new Error(complaints.join('\n'));
