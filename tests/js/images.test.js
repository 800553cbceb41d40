import assert from "node:assert/strict";
import { test } from "node:test";
import { Images } from "../../static/views/images.js";

test("a picture that has no address is not asked for, not even when tried again", () => {
  const asked = [];
  const api = { blob: async (address) => asked.push(address) };
  const images = new Images(api, { frames: [{ number: 0, images: [] }], cameras: [{ width: 100, height: 50 }] });
  assert.equal(images.get(0, 0, "light").status, "error");
  images.want([0]);
  images.retry(0, 0);
  images.retryAll();
  assert.deepEqual(asked, []);
  assert.equal(images.get(0, 0, "light").status, "error");
});
