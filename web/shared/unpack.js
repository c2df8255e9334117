/**
 * Undoes report/packed.hpp: base64, zlib, byte planes, differences of bit patterns.
 * @param {string} text
 * @param {number} count of numbers
 * @returns {Promise<Float32Array>}
 */
export async function unpack(text, count) {
  return new Float32Array((await unpackBits(text, count)).buffer);
}

/**
 * The same before it is read as floats.
 * @returns {Promise<Uint32Array>}
 */
export async function unpackBits(text, count) {
  if (count === 0) return new Uint32Array(0);
  const deflated = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  const stream = new Blob([deflated]).stream().pipeThrough(new DecompressionStream('deflate'));
  const planes = new Uint8Array(await new Response(stream).arrayBuffer());
  if (planes.length !== 4 * count) throw new Error(`${planes.length} bytes of curves; expected ${4 * count}`);
  const bits = new Uint32Array(count);
  let before = 0;
  for (let i = 0; i < count; ++i) {
    const difference =
      planes[i] | (planes[count + i] << 8) | (planes[2 * count + i] << 16) | (planes[3 * count + i] << 24);
    before = (before + difference) >>> 0;
    bits[i] = before;
  }
  return bits;
}
