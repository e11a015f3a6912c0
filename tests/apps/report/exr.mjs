// Reads what `quell run --compression none --type half` writes: one part, scan lines, half floats.
import { readFileSync } from "node:fs";

export function halfValue(bits) {
  const exponent = (bits >> 10) & 31;
  const fraction = bits & 1023;
  const size = exponent === 0 ? fraction * 2 ** -24 : (1 + fraction / 1024) * 2 ** (exponent - 15);
  return bits & 32768 ? -size : size;
}

/** A function of x, y and the channel's name. */
export function readExr(file) {
  const data = readFileSync(file);
  let at = 8;
  const text = () => {
    const end = data.indexOf(0, at);
    const found = data.toString("latin1", at, end);
    at = end + 1;
    return found;
  };
  const attributes = {};
  for (let name = text(); name; name = text()) {
    const type = text();
    const size = data.readInt32LE(at);
    attributes[name] = { type, start: at + 4, size };
    at += 4 + size;
  }
  const headerEnd = at;
  if (data[attributes.compression.start] !== 0) throw new Error(`${file} is compressed`);
  const window = [0, 4, 8, 12].map((offset) => data.readInt32LE(attributes.dataWindow.start + offset));
  const width = window[2] - window[0] + 1;
  const height = window[3] - window[1] + 1;
  const channels = [];
  at = attributes.channels.start;
  for (let name = text(); name; name = text()) {
    if (data.readInt32LE(at) !== 1) throw new Error(`${file}: the channel ${name} is not half`);
    channels.push(name);
    at += 16;
  }
  return (x, y, channel) => {
    const line = Number(data.readBigUInt64LE(headerEnd + 8 * y)) + 8; // behind the line's number and size
    return halfValue(data.readUInt16LE(line + 2 * (channels.indexOf(channel) * width + x)));
  };
}
