// The parser says what it makes of these files in tests/spec; here the schema is asked. A wrong specification says in
// its first line whether its mistake is one that a schema can see.
import assert from 'node:assert/strict';
import { readdirSync, readFileSync } from 'node:fs';
import { test } from 'node:test';
import { fileURLToPath } from 'node:url';
import Ajv2020 from 'ajv/dist/2020.js';
import { parseDocument, parseAllDocuments } from 'yaml';

const root = new URL('../../', import.meta.url);
const schema = JSON.parse(readFileSync(new URL('share/tessera/spec.schema.json', root), 'utf8'));
const validate = new Ajv2020({ allErrors: true, strict: true, allowUnionTypes: true, strictRequired: false }).compile(schema);

/** Whether an editor with the schema would leave the text without any underline. */
function accepts(text) {
  if (parseAllDocuments(text).length !== 1) return false;
  const document = parseDocument(text);
  if (document.errors.length > 0) return false;
  try {
    return validate(document.toJS());
  } catch (problem) {
    if (problem instanceof ReferenceError) return false; // an alias without anchor
    throw problem;
  }
}

function specifications(folder) {
  const url = new URL(`tests/golden/spec/${folder}/`, root);
  return readdirSync(fileURLToPath(url)).filter((name) => name.endsWith('.yaml')).map((name) => ({
    name,
    text: readFileSync(new URL(name, url), 'utf8'),
  }));
}

for (const { name, text } of specifications('valid')) {
  test(`valid/${name} is accepted`, () => {
    assert.ok(accepts(text), JSON.stringify(validate.errors, null, 2));
  });
}

for (const { name, text } of specifications('wrong')) {
  const verdict = /^(?:#|<!--) schema: (accepts|rejects)(?: -->)?$/m.exec(text.split('\n', 1)[0])?.[1];
  test(`wrong/${name}: the schema ${verdict} it`, () => {
    assert.ok(verdict, 'the first line must be "# schema: accepts" or "# schema: rejects"');
    assert.equal(accepts(text) ? 'accepts' : 'rejects', verdict, JSON.stringify(validate.errors, null, 2));
  });
}
