// SPDX-License-Identifier: Apache-2.0
// An MCAP file as Foxglove's own readers see it, as JSON: each record's facts, each message's fields.
// Numbers of 64 bits are texts; NaN is the text "NaN".
//
//     node tests/tools/mcap/mcap_read.mjs FILE
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { fileURLToPath } from "node:url";

const from_page = createRequire(fileURLToPath(new URL("../../../host/web/package.json", import.meta.url)));
const { McapIndexedReader, McapStreamReader } = from_page("@mcap/core");
const { parse } = from_page("@foxglove/rosmsg");
const { MessageReader } = from_page("@foxglove/rosmsg2-serialization");

const bytes = readFileSync(process.argv[2]);
const plain = (key, value) =>
  typeof value === "bigint"
    ? String(value)
    : Number.isNaN(value)
      ? "NaN"
      : value instanceof Map
        ? Object.fromEntries(value)
        : value;
const say = (kind, fact) => console.log(JSON.stringify({ kind, ...fact }, plain));

// From the start to the end, with every checksum of a chunk.
const stream = new McapStreamReader({ validateCrcs: true });
stream.append(bytes);
const counts = {};
for (let record; (record = stream.nextRecord());) {
  counts[record.type] = (counts[record.type] ?? 0) + 1;
  if (record.type === "DataEnd") say("data_end", { crc: record.dataSectionCrc });
}
say("stream", { done: stream.done(), counts });

// By the index, as a player seeks; it checks the checksum of the summary.
const file = {
  size: async () => BigInt(bytes.byteLength),
  read: async (offset, length) => new Uint8Array(bytes.subarray(Number(offset), Number(offset + length))),
};
const indexed = await McapIndexedReader.Initialize({ readable: file });
say("header", indexed.header);
say("statistics", indexed.statistics);
for (const schema of indexed.schemasById.values()) say("schema", { name: schema.name, encoding: schema.encoding });
for await (const record of indexed.readMetadata()) say("metadata", { name: record.name, facts: record.metadata });
const readers = new Map();
for await (const message of indexed.readMessages()) {
  const channel = indexed.channelsById.get(message.channelId);
  if (!readers.has(channel.schemaId)) {
    const text = new TextDecoder().decode(indexed.schemasById.get(channel.schemaId).data);
    readers.set(channel.schemaId, new MessageReader(parse(text, { ros2: true })));
  }
  const said = readers.get(channel.schemaId).readMessage(message.data);
  say("message", {
    topic: channel.topic,
    encoding: channel.messageEncoding,
    sequence: message.sequence,
    log_time: message.logTime,
    publish_time: message.publishTime,
    bytes: message.data.byteLength,
    said,
  });
}
