// docs/reference/studio.md lists the requests and events of share/tessera/studio.schema.json.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { test } from 'node:test';
import { schemas, wrongWith } from './judge.js';

const documentation = readFileSync(new URL('../../docs/reference/studio.md', import.meta.url), 'utf8');
const { Requests, Events, RunState, ControlRequest, Diagnostic } = schemas.studio.$defs;

/** The first column of the table with that head. */
function firstColumn(head) {
  const [, rows] = documentation.split(`\n| ${head} |`);
  assert.ok(rows, `docs/reference/studio.md has no table | ${head} |`);
  return rows.split('\n\n')[0].split('\n').flatMap((row) => /^\| `([^`]+)`/.exec(row)?.[1] ?? []);
}

/** With the names of its query: "GET /api/events?token=". */
function withQuery([name, { properties }]) {
  const names = Object.keys(properties.query?.properties ?? {});
  return name + (names.length > 0 ? `?${names.map((one) => `${one}=`).join('&')}` : '');
}

test('docs/reference/studio.md lists every request', () => {
  assert.deepEqual(firstColumn('Request | Body → answer').sort(), Object.entries(Requests.properties).map(withQuery).sort());
});

test('docs/reference/studio.md lists every event', () => {
  assert.deepEqual(firstColumn('Event | Data').sort(), Object.keys(Events.properties).sort());
});

test('docs/reference/studio.md names every state, command and severity', () => {
  for (const name of [...RunState.enum, ...ControlRequest.properties.command.enum, ...Diagnostic.properties.severity.enum])
    assert.ok(documentation.includes(`"${name}"`), name);
});

test('a message with a member that the schema does not know is refused', () => {
  const pose = { run: '1', t: 0, x: 0, y: 0, heading: 0 };
  assert.equal(wrongWith(pose, 'studio', '$defs', 'PoseEvent'), '');
  assert.match(wrongWith({ ...pose, speed: 1 }, 'studio', '$defs', 'PoseEvent'), /additional properties/);
  assert.match(wrongWith({ ended: true, why: '' }, 'control_socket', '$defs', 'Line'), /additional properties/);
  assert.match(wrongWith(pose, 'studio', '$defs', 'Events', 'properties', 'position'), /has no/);
});

test('the net that the tests of the page draw is one', () => {
  const net = new URL('../../studio/web/tests/model/line_follower.json', import.meta.url);
  assert.equal(wrongWith(JSON.parse(readFileSync(net, 'utf8')), 'net', '$defs', 'FoldedNet'), '');
});

test('every part of the schemas can be compiled', () => {
  for (const [name, { $defs }] of Object.entries(schemas))
    for (const one of Object.keys($defs)) assert.doesNotThrow(() => wrongWith(null, name, '$defs', one), `${name} ${one}`);
});
