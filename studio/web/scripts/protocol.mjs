#!/usr/bin/env node
// Writes the types of the page from the JSON Schemas: model/protocol.ts and model/net/net_json.ts. `--check` compares instead.
import { readFileSync, writeFileSync } from "node:fs";
import { fileURLToPath } from "node:url";
import { compile } from "json-schema-to-typescript";
import { format, resolveConfig } from "prettier";

const web = fileURLToPath(new URL("..", import.meta.url));
const read = (name) => JSON.parse(readFileSync(`${web}../../share/tessera/${name}`, "utf8"));
const net = "net.schema.json";

/**
 * The schema alone: parts of other schemas that it names become its own, except for the net, which has its
 * own file.
 */
function whole(name) {
  const { $schema, $id, ...schema } = read(name);
  const others = {};
  const convert = (node, from) => {
    if (Array.isArray(node)) return node.map((one) => convert(one, from));
    if (typeof node !== "object" || node === null) return node;
    if (Object.keys(node).join() === "description") return { ...node, tsType: "unknown" };
    const [, file, definition] = /^(.*)#\/\$defs\/(\w+)$/.exec(node.$ref ?? "") ?? [];
    const owner = file || from;
    if (owner === net && name !== net) return { tsType: definition };
    if (definition && owner !== name && !(definition in others)) {
      others[definition] = {};
      others[definition] = convert(read(owner).$defs[definition], owner);
    }
    if (definition) return { $ref: `#/$defs/${definition}` };
    const { prefixItems, ...rest } = node; // the generator knows the name of draft 7
    return Object.fromEntries(
      Object.entries(prefixItems ? { ...rest, items: prefixItems } : rest).map(([key, one]) => [key, convert(one, from)]),
    );
  };
  const own = convert(schema, name);
  for (const definition of Object.keys(others)) if (definition in own.$defs) throw new Error(`${definition} is in two schemas`);
  return { ...own, $defs: { ...own.$defs, ...others } };
}

/** Comments without the generator's notes on itself and on lengths, in lines that are not too long. */
function tidy(types) {
  const noise = /^(This interface was referenced by .*|via the `definition` .*|@m(in|ax)Items \d+)$/;
  return types.replace(/^( *)\/\*\*\n([^]*?)\*\/\n/gm, (_, indent, inside) => {
    const said = inside.split("\n").map((line) => line.replace(/^ *\* ?/, "").trim());
    const text = said.filter((line) => line !== "" && !noise.test(line)).join(" ");
    if (text === "") return "";
    const lines = text.match(/.{1,110}(?= |$)/g).map((line) => line.trim());
    return lines.length === 1
      ? `${indent}/** ${text} */\n`
      : `${indent}/**\n${lines.map((line) => `${indent} * ${line}\n`).join("")}${indent} */\n`;
  });
}

async function typesOf(schema, imports = "") {
  const types = await compile(whole(schema), "Root", {
    additionalProperties: false,
    bannerComment: `// Made by scripts/protocol.mjs of share/tessera/${schema}: change that, and run \`npm run protocol\`.\n${imports}`,
    unreachableDefinitions: true,
    format: false,
    cwd: web,
  });
  return format(tidy(types), { ...(await resolveConfig(`${web}package.json`)), parser: "typescript", objectWrap: "collapse" });
}

const outputs = {
  "model/protocol.ts": () => typesOf("studio.schema.json", 'import type { FoldedNet } from "./net/net_json";\n'),
  "model/net/net_json.ts": () => typesOf(net),
};

for (const [file, make] of Object.entries(outputs)) {
  const made = await make();
  if (!process.argv.includes("--check")) writeFileSync(web + file, made);
  else if (readFileSync(web + file, "utf8") !== made) {
    console.error(`studio/web/${file} is not what its schema says: run \`npm run protocol\` in studio/web`);
    process.exitCode = 1;
  }
}
