// Looks at a kept run of a mechanism that falls along x, and of which a part leaves the picture:
// node upright.mjs CHROMIUM MIXLOOP RESULT_DIR. Prints "held", or throws.
import assert from 'node:assert/strict';
import { opened, webgl } from './browser.mjs';
import { endAll, ended, viewing } from './viewer.mjs';

const [executable, mixloop, result] = process.argv.slice(2);

/** How far from the middle of the picture the farthest frame is: 1 at its edge. */
const farthest = () => {
  const { drawing } = window.mixloop;
  const { camera, shown } = drawing;
  camera.updateMatrixWorld();
  const places = drawing.mechanism.frames.map((_, i) => camera.position.clone().set(...shown.frames.slice(7 * i, 7 * i + 3)).project(camera));
  return Math.max(...places.flatMap(({ x, y }) => [Math.abs(x), Math.abs(y)]));
};

try {
  const view = await viewing(mixloop, result, '--port', '0');
  await opened(executable, async (_, tab, complaints) => {
    await tab.setViewportSize({ width: 800, height: 600 });
    await tab.goto(view.url);
    await tab.waitForFunction(() => window.mixloop?.pose);
    assert.deepEqual(await tab.evaluate(() => window.mixloop.drawing.camera.up.toArray().map((x) => x + 0)), [-1, 0, 0]);
    for (const from of ['space', 'front', 'side']) {
      await tab.click(`[data-camera=${from}]`);
      const rises = await tab.evaluate(() => {
        const { camera } = window.mixloop.drawing;
        camera.updateMatrixWorld();
        const target = window.mixloop.drawing.eye.controls.target;
        return target.clone().add({ x: -0.1, y: 0, z: 0 }).project(camera).y - target.clone().project(camera).y;
      });
      assert.ok(rises > 0, `${from}: what is up is up in the picture`);
    }
    await tab.waitForFunction(() => window.mixloop.drawing.shown?.t >= 0.5);
    assert.ok((await tab.evaluate(farthest)) <= 1, 'it is followed');
    complaints.splice(0, complaints.length, ...complaints.filter((text) => !/WebSocket|net::ERR_CONNECTION/.test(text)));
  }, webgl);
  await ended(view);
} finally {
  endAll();
}
console.log('held');
