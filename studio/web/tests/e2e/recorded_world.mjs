// A recording of robots in a world, made by this file, so no controller is built for it.
import { writeFileSync } from "node:fs";
import { join } from "node:path";

const firing = 1;
const poses = 11;
const end = 15;
const systemInstance = 0xffffff;

function varint(number) {
  const bytes = [];
  for (; number >= 128; number = Math.floor(number / 128)) bytes.push((number % 128) | 128);
  return [...bytes, number];
}
const zigzag = (number) => (number < 0 ? -2 * number - 1 : 2 * number);

/** A whole frame (tessera/poses.hpp): x, y, z in metres, and the quaternion. */
function frameOf(number, bodies) {
  const bytes = [1, number & 255, number >> 8];
  for (const body of bodies) {
    const steps = body.map((one, at) => Math.round(one * (at < 3 ? 10_000 : 8191)));
    bytes.push(
      0,
      steps.reduce((mask, one, at) => mask | (one === 0 ? 0 : 1 << at), 0),
    );
    for (const one of steps) if (one !== 0) bytes.push(...varint(zigzag(one)));
  }
  return Buffer.from(bytes);
}

function event(time, kind, { subject = 0, sequence = 0, instance = systemInstance, text = Buffer.alloc(0) }) {
  const bytes = Buffer.alloc(24 + Math.ceil(text.length / 24) * 24);
  bytes.writeBigInt64LE(BigInt(Math.round(time * 1e9)), 0);
  bytes.writeUInt32LE(text.length || subject, 8);
  bytes.writeUInt32LE(sequence, 16);
  bytes.writeUInt32LE(instance * 256 + kind, 20);
  text.copy(bytes, 24);
  return bytes;
}

function padded(bytes, filler) {
  return Buffer.concat([bytes, Buffer.alloc((4 - (bytes.length % 4)) % 4, filler)]);
}

/** Floor, and per robot one box as its body and `parts - 1` on it, as the world's library writes them. */
export function glbOf(robots, parts) {
  const corners = [];
  const normals = [];
  const indices = [];
  for (const axis of [0, 1, 2])
    for (const side of [-1, 1]) {
      const first = corners.length / 3;
      for (const [u, v] of [
        [-1, -1],
        [1, -1],
        [1, 1],
        [-1, 1],
      ]) {
        // prettier-ignore
        const corner = [0, 0, 0];
        const normal = [0, 0, 0];
        [corner[axis], corner[(axis + 1) % 3], corner[(axis + 2) % 3], normal[axis]] = [side, u * side, v, side];
        corners.push(...corner);
        normals.push(...normal);
      }
      indices.push(first, first + 1, first + 2, first, first + 2, first + 3);
    }
  const data = Buffer.concat([
    Buffer.from(new Float32Array(corners).buffer),
    Buffer.from(new Float32Array(normals).buffer),
    Buffer.from(new Uint16Array(indices).buffer),
  ]);
  const nodes = [{ rotation: [-Math.SQRT1_2, 0, 0, Math.SQRT1_2], children: [1] }];
  nodes.push({ name: "world", children: [2] }, { name: "floor", mesh: 0, scale: [4, 4, 0.01], translation: [2, 2, -0.02] });
  for (let body = 0; body < robots; body += 1) {
    nodes[0].children.push(nodes.length);
    const children = Array.from({ length: parts }, (_, at) => nodes.length + 1 + at);
    nodes.push({ name: `robot[${body}]/base`, extras: { body }, children });
    for (let at = 0; at < parts; at += 1)
      nodes.push({
        mesh: 1 + at,
        scale: at ? [0.03, 0.03, 0.03] : [0.12, 0.08, 0.05],
        translation: [0.03 * at, 0, at ? 0.13 : 0.07],
      });
  }
  const attributes = { POSITION: 0, NORMAL: 1 };
  const colour = (baseColorFactor) => ({ pbrMetallicRoughness: { baseColorFactor, metallicFactor: 0 } });
  const json = {
    asset: { version: "2.0" },
    scene: 0,
    scenes: [{ nodes: [0] }],
    nodes,
    meshes: Array.from({ length: parts + 1 }, (_, at) => ({
      primitives: [{ attributes, indices: 2, material: Math.min(at, 2) }],
    })),
    materials: [colour([0.8, 0.8, 0.8, 1]), colour([0.05, 0.2, 0.6, 1]), colour([0.7, 0.1, 0.1, 1])],
    accessors: [
      { bufferView: 0, componentType: 5126, count: 24, type: "VEC3", min: [-1, -1, -1], max: [1, 1, 1] },
      { bufferView: 1, componentType: 5126, count: 24, type: "VEC3" },
      { bufferView: 2, componentType: 5123, count: 36, type: "SCALAR" },
    ],
    bufferViews: [
      { buffer: 0, byteOffset: 0, byteLength: 288, target: 34962 },
      { buffer: 0, byteOffset: 288, byteLength: 288, target: 34962 },
      { buffer: 0, byteOffset: 576, byteLength: 72, target: 34963 },
    ],
    buffers: [{ byteLength: data.length }],
  };
  const chunk = (type, bytes) => {
    const head = Buffer.alloc(8);
    head.writeUInt32LE(bytes.length, 0);
    head.write(type, 4, "latin1");
    return Buffer.concat([head, bytes]);
  };
  const chunks = Buffer.concat([chunk("JSON", padded(Buffer.from(JSON.stringify(json)), " ")), chunk("BIN\0", padded(data, 0))]);
  const head = Buffer.alloc(12);
  head.write("glTF", 0, "latin1");
  head.writeUInt32LE(2, 4);
  head.writeUInt32LE(12 + chunks.length, 8);
  return Buffer.concat([head, chunks]);
}

/**
 * Writes NAME.tsr and its scene beside the specification: robots that drive in circles for ten seconds, side by side.
 * net: as the server analyses it; agent: the one that has all bodies.
 */
export function writeWorld(folder, name, { hash, net_hash, transitions, agent, robots, parts = 6, shift = 0, prefix = "robot" }) {
  const bodies = Array.from({ length: robots }, (_, at) => [`${prefix}[${at}]/base`, agent]);
  const header = Buffer.from(
    JSON.stringify({
      system: "line_follower",
      net_hash,
      verification_hash: "",
      seed: 1,
      clock: "simulated",
      instances: [],
      channels: [],
      transitions: transitions.map((one) => [one, systemInstance, "other"]),
      scene: { hash, bodies },
    }),
  );
  const length = Buffer.alloc(4);
  length.writeUInt32LE(header.length, 0);
  const start = Buffer.concat([Buffer.from("TESSREC1"), length, header]);
  const events = [event(0, firing, {})];
  const across = Math.ceil(Math.sqrt(robots));
  for (let frame = 0; frame < 250; frame += 1) {
    const angle = frame * 0.05;
    const now = bodies.map((_, at) => [
      0.4 + 0.55 * (at % across) + 0.2 * Math.cos(angle + at) + shift,
      0.4 + 0.55 * Math.floor(at / across) + 0.2 * Math.sin(angle + at),
      0,
      ...[Math.cos((angle + at + Math.PI / 2) / 2), 0, 0, Math.sin((angle + at + Math.PI / 2) / 2)],
    ]);
    events.push(event(frame * 0.04, poses, { text: frameOf(frame, now) }));
  }
  events.push(event(10, firing, { sequence: 1 }), event(10, end, {}));
  const filler = Buffer.alloc((8 - (start.length % 8)) % 8);
  writeFileSync(join(folder, `${name}.tsr`), Buffer.concat([start, filler, ...events]));
  writeFileSync(join(folder, `${hash}.glb`), glbOf(robots, parts));
}
