import assert from "node:assert/strict";
import { createServer } from "node:http";
import { after, before, mock, test } from "node:test";
import { Api, ApiError, NetworkError } from "../../static/base/api.js";

let answer = () => {};
let server;
let api;

before(async () => {
  server = createServer((request, response) => answer(response));
  await new Promise((listening) => server.listen(0, "127.0.0.1", listening));
  api = new Api({ base: `http://127.0.0.1:${server.address().port}/`, token: "", mode: "layer", csrf: "" });
});
after(() => {
  server.closeAllConnections();
  server.close();
});

/** What asking ends with. */
async function failure(asked) {
  try {
    await asked();
  } catch (error) {
    return error;
  }
  throw new assert.AssertionError({ message: "no failure" });
}

test("a page of something on the way is an answer that cannot be read", async () => {
  answer = (response) => response.setHeader("Content-Type", "text/html").end("<h1>Welcome to the hotel</h1>");
  const error = await failure(() => api.saveFrame(0, {}));
  assert.ok(error instanceof ApiError);
  assert.equal(error.code, "unreadable");
});

test("an answer that breaks off is a lost connection", async () => {
  answer = (response) => {
    response.setHeader("Content-Length", "100");
    response.write("{");
    setTimeout(() => response.destroy(), 20);
  };
  for (const asked of [() => api.frames(), () => api.blob(`${api.base}picture`)]) {
    assert.ok((await failure(asked)) instanceof NetworkError);
  }
});

test("a refusal that is not the server's own has no code", async () => {
  for (const text of ["null", "[]", "<h1>Not found</h1>"]) {
    answer = (response) => response.writeHead(404).end(text);
    const error = await failure(() => api.frames());
    assert.deepEqual([error.status, error.code], [404, "unknown"]);
  }
});

for (const keepalive of [false, true]) {
  test(`a save ${keepalive ? "on leaving" : ""} that nobody answers ends in time`, async () => {
    mock.method(AbortSignal, "timeout", () => {
      const soon = new AbortController();
      setTimeout(() => soon.abort(new DOMException("too late", "TimeoutError")), 50);
      return soon.signal;
    });
    answer = () => {};
    const asked = failure(() => api.saveFrame(0, {}, { keepalive }));
    const error = await Promise.race([asked, new Promise((done) => setTimeout(() => done("waits for ever"), 1000))]);
    mock.restoreAll();
    assert.ok(error instanceof NetworkError, String(error));
  });
}
