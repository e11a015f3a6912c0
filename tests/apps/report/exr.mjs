// Reads what `quell run --compression none --type half` writes: one part, scan lines, half floats.
import { readFileSync, writeFileSync } from "node:fs";

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

/** An image of half floats, not compressed; `bits` of row y are those of blue, then green, then red. */
export function writeExr(file, width, height, bits) {
  const text = (value) => Buffer.from(`${value}\0`, "latin1");
  const ints = (...values) => Buffer.from(Int32Array.from(values).buffer);
  const floats = (...values) => Buffer.from(Float32Array.from(values).buffer);
  const attribute = (name, type, value) => Buffer.concat([text(name), text(type), ints(value.length), value]);
  const window = ints(0, 0, width - 1, height - 1);
  const channel = (name) => Buffer.concat([text(name), ints(1), Buffer.alloc(4), ints(1, 1)]);
  const header = Buffer.concat([
    ints(20000630, 2),
    attribute("channels", "chlist", Buffer.concat([..."BGR"].map(channel).concat(Buffer.alloc(1)))),
    attribute("compression", "compression", Buffer.alloc(1)),
    attribute("dataWindow", "box2i", window),
    attribute("displayWindow", "box2i", window),
    attribute("lineOrder", "lineOrder", Buffer.alloc(1)),
    attribute("pixelAspectRatio", "float", floats(1)),
    attribute("screenWindowCenter", "v2f", floats(0, 0)),
    attribute("screenWindowWidth", "float", floats(1)),
    Buffer.alloc(1),
  ]);
  const bytes = 6 * width;
  const lines = Array.from({ length: height }, (_, y) => [ints(y, bytes), Buffer.from(bits(y).buffer)]);
  const size = 8 + bytes;
  const places = BigUint64Array.from({ length: height }, (_, y) => BigInt(header.length + 8 * height + y * size));
  writeFileSync(file, Buffer.concat([header, Buffer.from(places.buffer), ...lines.flat()]));
}
