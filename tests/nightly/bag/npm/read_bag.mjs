/* Copyright 2026 DDCT team
 * SPDX-License-Identifier: Apache-2.0 */
// Reads an MCAP file with Foxglove's libraries and prints one JSON line per message.

import { readFileSync } from 'node:fs';

import { parse } from '@foxglove/rosmsg';
import { MessageReader } from '@foxglove/rosmsg2-serialization';
import { decompress, isLoaded } from '@foxglove/wasm-zstd';
import { McapIndexedReader } from '@mcap/core';

class BufferReadable {
  constructor(buffer) {
    this.buffer = buffer;
  }

  async size() {
    return BigInt(this.buffer.length);
  }

  async read(offset, length) {
    return new Uint8Array(this.buffer.subarray(Number(offset), Number(offset + length)));
  }
}

const plain = (_key, value) => (ArrayBuffer.isView(value) ? Array.from(value) : value);

await isLoaded;
const reader = await McapIndexedReader.Initialize({
  readable: new BufferReadable(readFileSync(process.argv[2])),
  decompressHandlers: { zstd: (data, size) => decompress(data, Number(size)) },
});
const decoders = new Map();
for (const channel of reader.channelsById.values()) {
  const schema = reader.schemasById.get(channel.schemaId);
  const definitions = parse(new TextDecoder().decode(schema.data), { ros2: true });
  decoders.set(channel.id, { topic: channel.topic, reader: new MessageReader(definitions) });
}
for await (const record of reader.readMessages({ validateCrcs: true })) {
  const { topic, reader: decoder } = decoders.get(record.channelId);
  const message = decoder.readMessage(record.data);
  const line = { topic, logTime: record.logTime.toString(), message };
  process.stdout.write(`${JSON.stringify(line, plain)}\n`);
}
