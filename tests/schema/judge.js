// Judges messages by the schemas of share/tessera: one JSON object a line comes in, and for each a line with what is
// wrong with it goes out (empty: nothing). The tests in C++ start it: judge.hpp.
import { readFileSync } from 'node:fs';
import { createInterface } from 'node:readline';
import { fileURLToPath } from 'node:url';
import Ajv2020 from 'ajv/dist/2020.js';

const folder = new URL('../../share/tessera/', import.meta.url);
export const schemas = Object.fromEntries(
  ['net', 'control_socket', 'studio', 'summary'].map((name) => [
    name,
    JSON.parse(readFileSync(new URL(`${name}.schema.json`, folder), 'utf8')),
  ]),
);
const ajv = new Ajv2020({ allErrors: false, strict: true, allowUnionTypes: true, strictRequired: false });
for (const schema of Object.values(schemas)) ajv.addSchema(schema);
const requests = Object.keys(schemas.studio.$defs.Requests.properties);

/** The mistake in the value; empty: there is none. `where`: names below the root of the schema. */
export function wrongWith(value, name, ...where) {
  const pointer = where.map((one) => encodeURIComponent(one.replaceAll('~', '~0').replaceAll('/', '~1'))).join('/');
  const validate = ajv.getSchema(`${schemas[name].$id}#/${pointer}`);
  if (!validate) return `${name}.schema.json has no ${where.join(' / ')}`;
  if (validate(value)) return '';
  return validate.errors.map((one) => `${one.instancePath || '/'} ${one.message} ${JSON.stringify(one.params)}`).join('; ');
}

/** "GET /api/runs/RUN" of "GET", "/api/runs/7". */
function requestNamed(method, path) {
  const matches = (known) => {
    const [knownMethod, knownPath] = known.split(' ');
    const form = knownPath.replace(/[A-Z]+/g, '[^/]+');
    return knownMethod === method && new RegExp(`^${form}$`).test(path);
  };
  return requests.find(matches);
}

const parsed = (text) => {
  try {
    return JSON.parse(text);
  } catch {
    return text;
  }
};

/** A request and its answer; the body of what is refused may be anything. */
function judgeExchange({ method, target, status, body, answer }) {
  const [path, query] = target.split('?');
  const name = requestNamed(method, path);
  if (status === 503 && answer === '') return ''; // too busy for words
  if (status >= 400) {
    const isConflict = name?.startsWith('PUT ') && status === 409;
    return wrongWith(parsed(answer), 'studio', '$defs', isConflict ? (name.endsWith('/notes') ? 'NotesConflict' : 'Conflict') : 'Refusal');
  }
  if (!name) return 'the schema does not know this request';
  const isText = 'contentMediaType' in schemas.studio.$defs.Requests.properties[name].properties.answer;
  const exchange = { status, answer: isText ? answer : parsed(answer) };
  if (body !== '') exchange.body = parsed(body);
  if (query) exchange.query = Object.fromEntries(new URLSearchParams(query));
  return wrongWith(exchange, 'studio', '$defs', 'Requests', 'properties', name);
}

const judges = {
  exchange: judgeExchange,
  event: ({ name, data }) => wrongWith(data, 'studio', '$defs', 'Events', 'properties', name),
  line: ({ data }) => wrongWith(data, 'control_socket', '$defs', 'Line'),
  command: ({ data }) => wrongWith(data, 'control_socket', '$defs', 'Command'),
  summary: ({ data }) => wrongWith(data, 'summary', '$defs', 'Summary'),
};

if (process.argv[1] === fileURLToPath(import.meta.url))
  for await (const line of createInterface({ input: process.stdin, crlfDelay: Infinity })) {
    const message = parsed(line);
    const wrong = typeof message === 'object' ? judges[message.kind](message) : 'this is no JSON';
    process.stdout.write(`${wrong.replaceAll('\n', ' ')}\n`);
  }
