// Bags of Tessera read by the libraries of Foxglove, and the reverse. BAGS names the program of bags.cpp.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, test } from "node:test";
import { parse } from "@foxglove/rosmsg";
import { MessageReader, MessageWriter } from "@foxglove/rosmsg2-serialization";
import { McapIndexedReader, McapStreamReader, McapWriter } from "@mcap/core";
import Ajv from "ajv";
import { decompress } from "fzstd";

const folder = mkdtempSync(join(tmpdir(), "bags-"));
after(() => rmSync(folder, { recursive: true }));
const bags = (...words) => execFileSync(process.env.BAGS, words, { encoding: "utf8" });
const decompressHandlers = { zstd: (bytes, size) => decompress(bytes, new Uint8Array(Number(size))) };

/** Bytes as the readers of @mcap/core want them. */
const readable = (bytes) => ({
  size: async () => BigInt(bytes.length),
  read: async (offset, size) => bytes.subarray(Number(offset), Number(offset + size)),
});

const file = join(folder, "run.mcap");
bags("write", file);
const bytes = new Uint8Array(readFileSync(file));

/** Topic -> messages: time and value. */
async function contents() {
  const reader = await McapIndexedReader.Initialize({ readable: readable(bytes), decompressHandlers });
  const topics = new Map();
  for await (const message of reader.readMessages()) {
    const channel = reader.channelsById.get(message.channelId);
    const schema = reader.schemasById.get(channel.schemaId);
    const text = new TextDecoder();
    let value = message.data;
    if (channel.messageEncoding === "json") value = JSON.parse(text.decode(message.data));
    if (channel.messageEncoding === "cdr")
      value = new MessageReader(parse(text.decode(schema.data), { ros2: true })).readMessage(message.data);
    if (!topics.has(channel.topic)) topics.set(channel.topic, []);
    topics.get(channel.topic).push({ time: Number(message.logTime), published: Number(message.publishTime), value });
  }
  return { reader, topics };
}

test("the indexed reader finds every value of the run", async () => {
  const { topics } = await contents();
  const numbers = [0, 1, 2, 3, 4, 5, 6, 7];
  const plain = (value) => JSON.parse(JSON.stringify(value));
  const at = (topic) => topics.get(topic).map((one) => plain(one.value));
  const zero = { x: 0, y: 0, z: 0 };
  assert.deepEqual(
    at("/cmd_vel"),
    numbers.map((n) => ({ linear: { ...zero, x: 0.25 * n }, angular: { ...zero, z: -1 } })),
  );
  assert.deepEqual(at("/robot/base/count"), numbers.flatMap((n) => [{ value: n }, { value: n }]));
  const scans = topics.get("/scan");
  assert.equal(scans.length, 8);
  scans.forEach(({ time, value }, n) => {
    const rays = Array.from({ length: n % 5 }, (_, ray) => Math.fround(Math.fround(0.1) * ray));
    assert.deepEqual([...value.ranges], rays);
    assert.equal(value.name, "ab");
    assert.equal(value.on, n % 2 === 0);
    assert.equal(value.header.frame_id, "laser");
    assert.deepEqual({ ...value.header.stamp }, { sec: 0, nanosec: time });
  });
  const poses = topics.get("/tf");
  assert.equal(poses.length, 8);
  assert.deepEqual(poses[0].value.transforms.map((one) => one.child_frame_id), ["robot", "box"]);
  assert.deepEqual(plain(poses[0].value.transforms[1].transform.translation), { x: 1, y: 2, z: 3 });
  assert.deepEqual(plain(poses[0].value.transforms[1].transform.rotation), { x: 0, y: 0, z: 1, w: 0 });
  assert.equal(poses[3].value.transforms[0].transform.translation.x, 1.5);
  assert.deepEqual(topics.get("/rosout").map(({ value }) => [value.level, value.name, value.msg]),
    numbers.map((n) => [30, "robot.base", `iteration ${n}`]));
  const events = at("/tessera/events");
  assert.deepEqual(events.map((one) => one.kind), numbers.flatMap(() => ["call", "firing", "log"]));
  assert.deepEqual(events[1], { kind: "firing", subsystem: "robot.base", sequence: 4, transition: "robot.base.t0",
    step: "begin_sending", behaviour: "drive", channel: "a->b", version: 1 });
});

test("the index, the statistics and the check sums are right", async () => {
  const { reader, topics } = await contents();
  const count = [...topics.values()].reduce((sum, messages) => sum + messages.length, 0);
  assert.equal(Number(reader.statistics.messageCount), count);
  assert.equal(reader.statistics.chunkCount, reader.chunkIndexes.length);
  assert.equal(reader.statistics.channelCount, reader.channelsById.size);
  const names = [];
  for await (const attachment of reader.readAttachments({ validateCrc: true })) names.push(attachment.name);
  assert.deepEqual(names, ["recording_header.json", "spec.yaml"]);
  const metadata = new Map();
  for await (const one of reader.readMetadata()) metadata.set(one.name, one.metadata);
  assert.equal(metadata.get("tessera").get("clock"), "simulated");
  assert.equal(metadata.get("tessera.verdicts").get("safe"), "holds (circuits)");
  const range = [];
  for await (const message of reader.readMessages({ topics: ["/cmd_vel"], startTime: 20_000_000n, endTime: 40_000_000n }))
    range.push(Number(message.logTime));
  assert.deepEqual(range, topics.get("/cmd_vel").map((one) => one.time).filter((time) => time >= 20e6 && time <= 40e6));
  assert.ok(range.length > 0);
});

test("a file that was cut off is read as far as it goes", () => {
  const reader = new McapStreamReader({ decompressHandlers });
  reader.append(bytes.subarray(0, Math.floor(bytes.length / 2)));
  let messages = 0;
  for (let record; (record = reader.nextRecord()); ) messages += record.type === "Message" ? 1 : 0;
  assert.ok(messages > 10, `${messages}`);
});

test("values in JSON are as their schema says", async () => {
  const { reader, topics } = await contents();
  const ajv = new Ajv({ strict: true });
  let values = 0;
  for (const channel of reader.channelsById.values()) {
    if (channel.messageEncoding !== "json") continue;
    const schema = reader.schemasById.get(channel.schemaId);
    const isRight = ajv.compile(JSON.parse(new TextDecoder().decode(schema.data)));
    for (const { value } of topics.get(channel.topic)) {
      assert.ok(isRight(value), `${channel.topic} ${JSON.stringify(isRight.errors)}`);
      values += 1;
    }
  }
  assert.equal(values, 40);
});

/** A writer of another program, and the bytes that it has written. */
async function otherWriter() {
  const parts = [];
  let position = 0n;
  const writer = new McapWriter({
    writable: {
      position: () => position,
      write: async (part) => {
        parts.push(Uint8Array.from(part));
        position += BigInt(part.length);
      },
    },
    chunkSize: 300,
  });
  await writer.start({ profile: "ros2", library: "a test" });
  const add = async (topic, name, definition) => {
    const schemaId = await writer.registerSchema({ name, encoding: definition === "" ? "" : "ros2msg",
      data: new TextEncoder().encode(definition) });
    return await writer.registerChannel({ schemaId, topic, messageEncoding: "cdr", metadata: new Map() });
  };
  return { writer, add, bytes: () => Buffer.concat(parts) };
}

test("bags of another program are read as they were written", async () => {
  const { writer, add, bytes: written } = await otherWriter();
  const definition = "float64 x\nstring name\nint16[] list\n";
  const encoder = new MessageWriter(parse(definition, { ros2: true }));
  const channelId = await add("/some", "test_msgs/msg/Some", definition);
  const wanted = [];
  for (let n = 0; n < 20; ++n) {
    const data = encoder.writeMessage({ x: n / 3, name: "n".repeat(n), list: [n, -n] });
    await writer.addMessage({ channelId, sequence: n, logTime: BigInt(n), publishTime: BigInt(n), data });
    wanted.push(`/some cdr test_msgs/msg/Some ${n} ${Buffer.from(data).toString("hex")}`);
  }
  await writer.end();
  const other = join(folder, "other.mcap");
  writeFileSync(other, written());
  assert.deepEqual(bags("read", other).trim().split("\n"), wanted);
});

test("goals in a bag of another program are the calls of an action", async () => {
  const line = `\n${"=".repeat(80)}\nMSG: `;
  const uuid = `${line}unique_identifier_msgs/UUID\nuint8[16] uuid`;
  const statusText = `GoalStatus[] status_list${line}action_msgs/GoalStatus\nGoalInfo goal_info\nint8 status` +
    `${line}action_msgs/GoalInfo\nunique_identifier_msgs/UUID goal_id\nbuiltin_interfaces/Time stamp${uuid}` +
    `${line}builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n`;
  const feedbackText = `unique_identifier_msgs/UUID goal_id\nGo_Feedback feedback${uuid}${line}demo/Go_Feedback\nfloat32 left\n`;
  const statuses = new MessageWriter(parse(statusText, { ros2: true }));
  const feedbacks = new MessageWriter(parse(feedbackText.replace("\nGo_", "\ndemo/Go_"), { ros2: true }));
  for (const isDefined of [true, false]) {
    const { writer, add, bytes: written } = await otherWriter();
    const feedback = await add("/go/_action/feedback", "demo/action/Go_FeedbackMessage", isDefined ? feedbackText : "");
    const status = await add("/go/_action/status", "action_msgs/msg/GoalStatusArray", statusText);
    const put = (channelId, time, data) =>
      writer.addMessage({ channelId, sequence: 0, logTime: 1_700_000_000_000_000_000n + time, publishTime: 0n, data });
    const goal = (id) => ({ uuid: Array(16).fill(id) });
    const list = (...all) => statuses.writeMessage({ status_list: all.map(([id, state]) => ({ goal_info: { goal_id: goal(id) }, status: state })) });
    await put(status, 0n, list([9, 4]));
    await put(status, 10n, list([9, 4], [1, 2]));
    await put(feedback, 20n, feedbacks.writeMessage({ goal_id: goal(1), feedback: { left: 1 } }));
    await put(status, 30n, list([9, 4], [1, 6], [2, 1]));
    await writer.end();
    const other = join(folder, "goals.mcap");
    writeFileSync(other, written());
    assert.deepEqual(bags("inputs", other).trim().split("\n"), [
      "10 010000000100000000",
      "10 010000000200000000",
      "20 01000000020000803f",
      "30 01000000060000803f",
      "30 020000000100000000",
      "robot.eyes.seen takes the 2 goals of /go for its calls 1 to 2; results and rejections are in no topic",
    ]);
  }
});
