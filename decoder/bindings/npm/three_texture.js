// Planes of a file as textures.
import {
  ClampToEdgeWrapping, DataTexture, DataUtils, HalfFloatType, LinearFilter, LinearMipmapLinearFilter, NoColorSpace,
  ObjectSpaceNormalMap, RGBAFormat, SRGBColorSpace, UnsignedByteType,
} from "three";
import { GimDecoder } from "gim/decoder";

const toByte = (value) => Math.round(255 * Math.min(Math.max(value, 0), 1));

// How the three numbers of a sample become those of a texel.
const kinds = {
  colors: { type: UnsignedByteType, space: SRGBColorSpace, makeArray: (n) => new Uint8Array(n).fill(255), convert: toByte },
  normals: {
    type: HalfFloatType, space: NoColorSpace, makeArray: (n) => new Uint16Array(n),
    convert: (value) => DataUtils.toHalfFloat(0.5 + 0.5 * value),
  },
  displacements: { type: HalfFloatType, space: NoColorSpace, makeArray: (n) => new Uint16Array(n), convert: DataUtils.toHalfFloat },
};

// A texture of a plane. options: plane, image, level, and limits.
export function planeTexture(bytes, options) {
  return textureOf(GimDecoder.decodePlane(bytes, options), options.plane, GimDecoder.info(bytes, options).layout);
}

export function textureOf({ width, height, values }, plane, layout) {
  const { type, space, makeArray, convert } = kinds[plane];
  const texels = makeArray(width * height * 4);
  for (let i = 0; i < width * height; ++i) {
    for (let k = 0; k < 3; ++k) texels[4 * i + k] = convert(values[3 * i + k]);
  }
  const texture = new DataTexture(texels, width, height, RGBAFormat, type);
  texture.colorSpace = space;
  texture.wrapS = texture.wrapT = ClampToEdgeWrapping;
  texture.magFilter = LinearFilter;
  // Neighbours in the grid of tiles or charts need not be neighbours on the surface.
  texture.generateMipmaps = layout === "gim" && plane === "colors";
  texture.minFilter = texture.generateMipmaps ? LinearMipmapLinearFilter : LinearFilter;
  // uv 0 and 1 are the centres of the first and the last texel.
  texture.repeat.set((width - 1) / width, (height - 1) / height);
  texture.offset.set(0.5 / width, 0.5 / height);
  texture.needsUpdate = true;
  return texture;
}

// Decodes the planes that a file has. Returns for each image {colors, normals}; null if there are none.
export async function decodeTextures(bytes, info, chunks, { signal, ...limits }) {
  const planes = planesOf(chunks);
  if (planes.length === 0) return null;
  const textures = [];
  for (let image = 0; image < info.imageCount; ++image) {
    const own = {};
    for (const plane of planes) {
      const values = await GimDecoder.decodeAsync("plane", bytes, { ...limits, image, plane, signal });
      own[plane] = textureOf(values, plane, info.layout);
    }
    textures.push(own);
  }
  return textures;
}

// Those that a material can show.
export function planesOf(chunks) {
  const has = (name) => chunks.some((chunk) => chunk.name === name);
  return [...(has("COLR") ? ["colors"] : []), ...(has("NRML") ? ["normals"] : [])];
}

// Copies of a material with the textures; an array of them if there are several images.
export function texturedMaterial(textures, material) {
  const made = textures.map(({ colors, normals }) => {
    const own = material.clone();
    if (colors) own.map = colors;
    if (normals) {
      own.normalMap = normals;
      own.normalMapType = ObjectSpaceNormalMap;
    }
    return own;
  });
  return made.length === 1 ? made[0] : made;
}

export function disposeTextures(textures) {
  for (const own of textures ?? []) Object.values(own).forEach((texture) => texture.dispose());
}
export function bytesOfTextures(textures) {
  const sizes = (textures ?? []).flatMap((own) => Object.values(own).map((texture) => texture.image.data.byteLength));
  return sizes.reduce((sum, size) => sum + size, 0);
}
